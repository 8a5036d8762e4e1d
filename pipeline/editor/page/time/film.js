import { help, section } from "../panel/rows.js";

/** @typedef {import("../stage.js").Stage} Stage */

/**
 * @param {string} id
 * @param {string} text
 * @param {string} title
 * @param {() => void} pressed
 */
function button(id, text, title, pressed) {
  const made = document.createElement("button");
  Object.assign(made, { id, textContent: text, title });
  made.addEventListener("click", pressed);
  return made;
}

/** What is done with the whole film: edits reach through shots, frames and films are written. */
export class FilmPanel {
  /** @param {Stage} stage */
  constructor(stage) {
    this.stage = stage;
    this.output = ""; // what is being rendered
    this.apply = button("apply", "", "Solve what was edited again: the film follows (Ctrl+Enter)", () => this.begin());
    this.apply.className = "main";
    this.render = button("render", "Render film", "Draw the film in this style, to a file beside the track", () => this.draw());
    this.export = button("export", "Export frame", "Write this frame as a PNG beside the track", () => this.write());
    this.cancel = button("cancel", "Cancel", "Nothing is changed then", () => stage.connection.ask("cancel"));
    this.bar = document.createElement("progress");
    this.title = help("");
    this.work = document.createElement("div");
    this.work.className = "work";
    this.work.hidden = true;
    this.work.append(this.title, this.bar, this.cancel);
    this.note = help("");
    this.note.id = "film-note";
    this.written = help("");
    this.written.id = "written";
    const buttons = document.createElement("div");
    buttons.className = "buttons";
    buttons.append(this.apply, this.render, this.export);
    this.element = section("Film", this.note, buttons, this.work, this.written);
    stage.watch(() => this.renew());
  }

  get isStill() {
    return this.stage.frames.length < 2;
  }

  renew() {
    const { stage } = this;
    const { pending } = stage.state;
    const shot = stage.shots.find(([first, last]) => first <= stage.frame && stage.frame <= last);
    const isHere = Boolean(shot && pending.includes(shot[0]));
    this.apply.disabled = !pending.length || !this.work.hidden;
    this.apply.textContent = this.isStill ? "Solve with the edits" : isHere || pending.length < 2 ? "Apply to the shot" : `Apply to ${pending.length} shots`;
    this.render.textContent = this.isStill ? "Render picture" : "Render film";
    this.export.hidden = this.isStill;
    this.note.textContent = pending.length
      ? this.isStill ? "The optimiser has not seen your edits yet." : "Your edits are saved, and do not reach through their shots yet."
      : stage.state.edits ? "The film follows all of your edits." : "Click into the picture: whatever you edit, the film will follow.";
  }

  /** Let the edits reach through their shots. */
  async begin() {
    const { stage } = this;
    const shot = stage.shots.find(([first, last]) => first <= stage.frame && stage.frame <= last);
    const isHere = shot && stage.state.pending.includes(shot[0]);
    await this.try(() => stage.connection.ask("apply", isHere ? { frame: stage.frame } : {}));
  }

  async draw() {
    const { stage } = this;
    const ending = this.isStill ? "png" : "mp4";
    await this.try(async () => {
      const { path } = await stage.connection.ask("render", { name: `${stage.stem}.${stamp()}.${ending}` });
      this.output = path;
    });
  }

  async write() {
    const { stage } = this;
    await this.try(async () => {
      const { path } = await stage.connection.ask("export", { name: `${stage.stem}.frame${stage.frame}.${stamp()}.png` });
      this.tellWritten(path);
    });
  }

  /** @param {() => Promise<any>} asked */
  async try(asked) {
    try {
      await asked();
    } catch (error) {
      this.stage.told.problem(/** @type {Error} */ (error).message);
    }
  }

  /** @param {string} path of a file, which stays to be seen: one looks for it afterwards */
  tellWritten(path) {
    this.written.textContent = `Written: ${path}`;
  }

  /** @param {any} words of long work */
  tell(words) {
    const isOver = words.tell !== "work";
    this.work.hidden = isOver;
    if (!isOver) {
      this.title.textContent = words.total ? `${words.title}: ${words.done} of ${words.total}` : `${words.title}…`;
      if (words.total) Object.assign(this.bar, { max: words.total, value: words.done });
      else this.bar.removeAttribute("value");
    }
    if (words.tell === "done") {
      this.stage.told.say([`${words.title}: done.`, ...words.notes].join(" "));
      if (this.output && words.title.startsWith("Rendering")) this.tellWritten(this.output);
    }
    if (words.tell === "failed") this.stage.told.problem(words.text);
    this.renew();
  }
}

/** A part of a name that no earlier file has. */
function stamp() {
  return new Date().toISOString().slice(0, 19).replace(/[-:]/g, "").replace("T", "-");
}
