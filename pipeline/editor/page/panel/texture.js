import { PenByKeys } from "./pen.js";
import { choice, help, slider } from "./rows.js";

/** @typedef {import("../stage.js").Stage} Stage */

/** Width and height of a drawing [px]. */
const SIDE = 256;
/** What leaves colours as they are. */
const MIDDLE = 128;
const DRAWN = "drawn here";
/** The triangle that the drawing fills: its base edge is that along which strokes lie. */
const OUTLINE = '<svg viewBox="0 0 256 256" aria-hidden="true"><path d="M128 1 1 255M128 1l127 254"/><path class="base" d="M1 254h254"/></svg>';

/** A canvas on which a texture is drawn, and shown on all triangles meanwhile. */
export class TexturePanel {
  /**
   * @param {Stage} stage
   * @param {import("./style.js").StylePanel} style
   */
  constructor(stage, style) {
    this.stage = stage;
    this.style = style;
    this.values = { name: DRAWN, strength: 1, opacity: 1, pen: 16, shade: 0.1 };
    this.isShown = false;
    this.isSending = false;
    this.isWanted = false;
    /** @type {Promise<string> | null} the drawing as it is now, as edits hold it */
    this.kept = null;
    /** @type {{x: number, y: number} | null} */
    this.last = null;
    this.canvas = document.createElement("canvas");
    Object.assign(this.canvas, { id: "texture", width: SIDE, height: SIDE });
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "application");
    this.canvas.setAttribute("aria-label", "Drawing of the texture. Arrows move the pen (Shift: by a pixel), Space or Enter puts it down and lifts it; a picture can be loaded in its place");
    this.context = /** @type {CanvasRenderingContext2D} */ (this.canvas.getContext("2d", { willReadFrequently: true }));
    this.context.lineCap = this.context.lineJoin = "round";
    this.element = document.createElement("details");
    this.element.id = "texture-panel";
    this.element.append(...this.rows());
    this.clear();
    this.canvas.addEventListener("pointerdown", (event) => this.down(event));
    this.canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel"]) this.canvas.addEventListener(name, () => (this.last = null));
    stage.marks.texture = () => this.told("edits");
    new PenByKeys(this.canvas, SIDE, (to) => this.stroke(to), () => (this.last = null));
  }

  rows() {
    const title = document.createElement("summary");
    title.innerHTML = "<h2>Texture</h2>";
    const sheet = document.createElement("div");
    sheet.className = "sheet";
    sheet.innerHTML = OUTLINE;
    sheet.prepend(this.canvas);
    const { values } = this;
    /** @type {(name: "pen" | "shade" | "strength" | "opacity", label: string, title: string, span: [number, number, number], sends?: boolean) => Node} */
    const row = (name, label, about, [least, most, step], sends = false) => {
      const changed = (/** @type {number} */ value) => {
        values[name] = value;
        if (sends && this.isShown) this.send();
      };
      return slider({ name: `texture-${name}`, label, title: about, least, most, step, value: values[name], changed }).row;
    };
    const which = choice({ name: "texture-name", label: "Texture", title: "Your drawing, or one that there is", choices: [DRAWN, "cushion", "triangle"], value: values.name, changed: (value) => this.choose(value) });
    this.sheet = sheet;
    this.show = this.button("texture-show", "Show on all triangles", "See it everywhere, before it is anywhere", () => this.setShown(!this.isShown));
    return [
      title, which.row, sheet,
      row("pen", "Pen", "Width of the pen", [2, 96, 1]),
      row("shade", "Shade", "0 draws black, 1 white; 0.5 leaves colours as they are", [0, 1, 0.05]),
      this.buttons(this.button("texture-clear", "Clear", "Leave all colours as they are", () => this.clear()), this.loader()),
      row("strength", "Contrast", "How dark and bright it makes colours", [0, 4, 0.05], true),
      row("opacity", "Opacity", "How much of it is seen", [0, 1, 0.01], true),
      this.buttons(this.show, this.button("texture-use", "Lay over the whole film", "As a style on top of the others", () => this.lay())),
      help("The lower side is the base edge (turn it: Shift + left). Paint it onto triangles with T, or into a region with R."),
    ];
  }

  /** @param {...Node} made */
  buttons(...made) {
    const row = document.createElement("div");
    row.className = "buttons";
    row.append(...made);
    return row;
  }

  /**
   * @param {string} id
   * @param {string} text
   * @param {string} title
   * @param {() => void} pressed
   */
  button(id, text, title, pressed) {
    const made = document.createElement("button");
    Object.assign(made, { id, textContent: text, title });
    made.addEventListener("click", pressed);
    return made;
  }

  /** What takes a picture in. */
  loader() {
    const made = document.createElement("input");
    Object.assign(made, { id: "texture-file", type: "file", accept: "image/*", hidden: true, ariaLabel: "Picture to load" });
    made.addEventListener("change", async () => {
      const [file] = made.files ?? [];
      made.value = "";
      try {
        if (file) this.load(await createImageBitmap(file));
      } catch {
        this.stage.told.problem(`${file.name} is no picture that this browser reads; choose a PNG or a JPEG`);
      }
    });
    return this.buttons(this.button("texture-load", "Load a picture…", "Use a picture as the texture", () => made.click()), made);
  }

  /** @param {ImageBitmap} picture */
  load(picture) {
    this.context.filter = "grayscale(1)";
    this.context.drawImage(picture, 0, 0, SIDE, SIDE);
    this.context.filter = "none";
    this.drawn();
  }

  clear() {
    this.context.fillStyle = `rgb(${MIDDLE} ${MIDDLE} ${MIDDLE})`;
    this.context.fillRect(0, 0, SIDE, SIDE);
    this.kept = null;
    if (this.isShown) this.send();
  }

  /** @param {string} name */
  choose(name) {
    this.values.name = name;
    /** @type {HTMLElement} */ (this.sheet).hidden = name !== DRAWN;
    this.setShown(true);
  }

  /** @param {PointerEvent} event */
  down(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.last = this.place(event);
    this.stroke(this.last);
  }

  /** @param {PointerEvent} event */
  move(event) {
    if (this.last) this.stroke(this.place(event));
  }

  /** @param {PointerEvent} event */
  place(event) {
    const box = this.canvas.getBoundingClientRect();
    return { x: ((event.clientX - box.left) / box.width) * SIDE, y: ((event.clientY - box.top) / box.height) * SIDE };
  }

  /** @param {{x: number, y: number}} to */
  stroke(to) {
    const { context: c, values } = this;
    const gray = Math.round(255 * values.shade);
    const from = this.last ?? to;
    c.strokeStyle = `rgb(${gray} ${gray} ${gray})`;
    c.lineWidth = values.pen;
    c.beginPath();
    c.moveTo(from.x, from.y);
    c.lineTo(to.x + 0.01, to.y);
    c.stroke();
    this.last = to;
    this.drawn();
  }

  /** The drawing has changed: it is shown. */
  drawn() {
    this.kept = null;
    this.setShown(true);
  }

  /** @param {boolean} isShown */
  setShown(isShown) {
    this.isShown = isShown;
    this.show?.setAttribute("aria-pressed", String(isShown));
    this.send();
  }

  /** Have the newest drawing shown; of those between the last counts. */
  async send() {
    this.isWanted = true;
    if (this.isSending) return;
    this.isSending = true;
    while (this.isWanted) {
      this.isWanted = false;
      const { name, strength, opacity } = this.values;
      const what = name === DRAWN ? { drawing: this.base64() } : { file: name };
      await this.stage.connection
        .ask("sketch", this.isShown ? { ...what, strength, opacity } : {})
        .catch((/** @type {Error} */ error) => this.stage.told.problem(error.message));
    }
    this.isSending = false;
  }

  /** The drawing as it is sent. */
  base64() {
    const { data } = this.context.getImageData(0, 0, SIDE, SIDE);
    let text = "";
    for (let i = 0; i < data.length; i += 4) text += String.fromCharCode(data[i]);
    return btoa(text);
  }

  /**
   * The texture as it is named.
   * @param {"edits" | "styles"} by edits hold a drawing themselves, styles name a file beside the track
   */
  async told(by) {
    const { name, strength, opacity } = this.values;
    if (this.isShown) this.setShown(false); // what is painted shall be seen
    if (name !== DRAWN) return { file: name, strength, opacity };
    const keep = () => this.stage.connection.ask("keep", { drawing: this.base64(), for: by }).then(({ file }) => file);
    if (by === "styles") return { file: await keep(), strength, opacity };
    this.kept ??= keep();
    try {
      return { file: await this.kept, strength, opacity };
    } catch (error) {
      this.kept = null;
      throw error;
    }
  }

  async lay() {
    try {
      this.style.lay("texture", await this.told("styles"));
    } catch (error) {
      this.stage.told.problem(/** @type {Error} */ (error).message);
    }
  }
}
