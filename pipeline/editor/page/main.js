import { Connection } from "./net/connection.js";
import { fillPanel } from "./panel/panel.js";
import { fillRail } from "./panel/rail.js";
import { Scrubber } from "./time/scrubber.js";
import { Stage } from "./stage.js";
import { Keyboard } from "./tools/keyboard.js";
import { fillHelp } from "./tools/keys.js";
import { NAMES, planned } from "./tools/plans.js";
import { Pointer } from "./tools/pointer.js";
import { TOOLS } from "./tools/tools.js";

/**
 * @template {HTMLElement} T
 * @param {string} id
 * @returns {T}
 */
const element = (id) => /** @type {T} */ (document.getElementById(id));

/** How long a message stays [ms]. */
const STAYS = 6000;

let toastTimer = 0;

/**
 * Show one line.
 * @param {string} text
 * @param {boolean} [isNote]
 */
function toast(text, isNote = false) {
  const box = element("toast");
  box.textContent = text;
  box.classList.toggle("note", isNote);
  box.hidden = false;
  clearTimeout(toastTimer);
  toastTimer = setTimeout(() => (box.hidden = true), STAYS);
}

/** @param {Stage} stage */
function tellState(stage) {
  const { state } = stage;
  const edits = state.edits === 1 ? "1 edit" : `${state.edits} edits`;
  write("saved", state.edits ? `${edits}, all saved` : "no edits yet");
  /** @type {HTMLButtonElement} */ (element("undo")).disabled = !state.canUndo;
  /** @type {HTMLButtonElement} */ (element("redo")).disabled = !state.canRedo;
}

/** @param {Stage} stage */
function tellTime(stage) {
  write("clock", String(stage.frame));
  element("play-icon").setAttribute("d", stage.isPlaying ? "M6 5h4v14H6zM14 5h4v14h-4z" : "M7 5l12 7-12 7z");
}

/**
 * Write a line, if it says something else: the browser would lay out and draw the page again.
 * @param {string} id
 * @param {string} text
 */
function write(id, text) {
  if (element(id).textContent !== text) element(id).textContent = text;
}

/** @param {Stage} stage */
function tellHint(stage) {
  const picked = stage.picked();
  const tool = TOOLS.find((one) => one.name === stage.tool);
  let text = tool?.hint ?? "";
  if (stage.moving) text = "Let go or Enter: put the vertex here · Shift: a tenth of the way · Esc: leave it";
  else if (stage.tool === "edit" && picked) {
    const left = NAMES[planned(picked, "left", stage.shift)];
    const right = NAMES[planned(picked, "right", stage.shift)];
    text = [left && `Left: ${left}`, right && `Right: ${right}`].filter(Boolean).join(" · ");
    if (picked.kind === "vertex") text = `Drag: move the vertex · Right: ${NAMES.collapse_vertex}`;
  }
  write("hint", text);
}

/** @param {Stage} stage */
function tellFacts(stage) {
  const { mesh, pointer } = stage;
  if (!mesh) return;
  const where = pointer ? `${pointer.x.toFixed(1)}, ${pointer.y.toFixed(1)} px · ` : "";
  write("facts", `${where}${mesh.triangleCount} triangles · rmse ${mesh.rmse.toFixed(2)}`);
}

/** Start. */
function main() {
  let isLost = false;
  const connection = new Connection({
    tell: (words) => {
      if (words.tell === "state") stage.setState(words);
      else if (words.tell === "focus") stage.setFocus(words);
      else if (words.tell === "problem") toast(words.text);
      else if (words.tell === "preparing") element("preparing").hidden = !words.is;
      else film.tell(words);
      if (words.tell === "done") scrubber.renew();
    },
    show: (packed) => {
      if (packed.head.kind === "thumb") scrubber.show(packed);
      else stage.show(packed);
      if (packed.head.kind === "mesh") optimiser.take(/** @type {any} */ (packed.head));
      if (packed.head.kind === "mesh") element("loading").hidden = true; // the drawn one may take a while
    },
    lost: () => {
      isLost = true;
      element("lost").hidden = false;
      const seen = stage.state.edits ? `What you see is the job with its ${stage.state.edits} edits; all of them are saved. ` : "";
      element("lost").children[1].textContent = `${seen}Looking for the program… If it has ended, start it again and go on in the window that it opens: trimotion edit ${stage.track}`;
    },
    found: () => begin(isLost),
  });
  const stage = new Stage(element("stage"), element("overlay"), connection, {
    problem: toast,
    say: (text) => toast(text, true),
  });

  /** @param {boolean} isAgain */
  async function begin(isAgain) {
    element("lost").hidden = true;
    isLost = false;
    const { facts, state } = await connection.ask("hello");
    document.title = `${facts.name} · trimotion`;
    element("name").textContent = facts.name;
    stage.frame = isAgain ? stage.frame : facts.frames[0];
    Object.assign(stage, { frames: facts.frames, shots: facts.shots, rate: facts.rate, stem: facts.stem, track: facts.track });
    style.fill(facts.styles, facts.model === "constant" ? "flat" : "gradient");
    optimiser.fill(facts.course);
    if (isAgain) await style.send();
    element("time").hidden = facts.frames.length < 2;
    element("strip").setAttribute("aria-valuemin", String(facts.frames[0]));
    element("strip").setAttribute("aria-valuemax", String(facts.frames.at(-1)));
    stage.setSize(facts.width, facts.height);
    stage.setState(state);
    element("where").textContent = `${facts.width} × ${facts.height}`;
    await stage.seek(stage.frame);
    await stage.renewCommands();
  }

  fillRail(element("tools"), stage);
  const { film, style, optimiser } = fillPanel(element("panel"), stage);
  const scrubber = new Scrubber(element("strip"), stage);
  fillHelp(element("keys"));
  new Pointer(stage);
  new Keyboard(stage, element("keys"));
  addEventListener("keydown", (event) => {
    const isText = event.target instanceof HTMLInputElement && event.target.type === "text";
    if (isText || event.ctrlKey || event.metaKey) return;
    if (event.key === "l") optimiser.toggle();
    if (event.key === ";") optimiser.ask("step");
  });
  addEventListener("keydown", (event) => event.ctrlKey && event.key === "Enter" && film.begin());
  element("play").addEventListener("click", () => stage.togglePlay());
  for (const button of /** @type {NodeListOf<HTMLButtonElement>} */ (document.querySelectorAll("#views button"))) {
    button.addEventListener("click", () => stage.setView(/** @type {any} */ (button.dataset.view)));
    stage.watch(() => button.setAttribute("aria-pressed", String(button.dataset.view === stage.view)));
  }
  element("undo").addEventListener("click", () => stage.underway.turn("undo"));
  element("redo").addEventListener("click", () => stage.underway.turn("redo"));
  element("help").addEventListener("click", () => /** @type {HTMLDialogElement} */ (element("keys")).showModal());
  stage.watch(() => tellState(stage));
  stage.watch(() => tellTime(stage));
  // who clicks with a hand goes on with keys of the picture, not of the button
  addEventListener("click", (event) => {
    const button = /** @type {Element} */ (event.target).closest?.("button");
    if (event.detail && button instanceof HTMLElement) button.blur();
  });
  stage.painted = () => {
    tellHint(stage);
    tellFacts(stage);
  };
  stage.repaint();
  Object.assign(globalThis, { trimotion: stage }); // for whoever looks into it, tests among them
}

try {
  main();
} catch (error) {
  element("loading").textContent = /** @type {Error} */ (error).message;
}
