import { help, section, slider } from "./rows.js";

/**
 * @typedef {import("../stage.js").Stage} Stage
 * @typedef {{triangles: number, error: number, regularity: number, trust_region: number}} Course
 */

/** Steps that the curve shows. */
const MOST = 600;

/** The optimiser at work: play, pause, step, what it aims at, how far it is. */
export class OptimiserPanel {
  /** @param {Stage} stage */
  constructor(stage) {
    this.stage = stage;
    /** @type {Course} */
    this.course = { triangles: 1500, error: 0, regularity: 1e-3, trust_region: 0.5 };
    /** @type {number[]} rmse after every step */
    this.curve = [];
    this.isOn = false;
    this.times = /** @type {number[]} */ ([]);
    const buttons = document.createElement("div");
    buttons.className = "buttons";
    this.play = this.button("optimise", "Play", "Watch the optimiser at work on this frame (L)", () => this.toggle());
    this.single = this.button("optimise-step", "Step", "One step of every vertex (;)", () => this.ask("step"));
    buttons.append(this.play, this.single);
    this.plot = document.createElement("canvas");
    this.plot.id = "curve";
    this.plot.setAttribute("role", "img");
    this.plot.setAttribute("aria-label", "Error over steps");
    this.told = help("");
    this.told.id = "optimiser-told";
    this.sliders = document.createElement("div");
    this.element = section("Optimiser", buttons, this.sliders, this.plot, this.told,
      help("A preview: what is saved are your edits, and the film is solved with the options of its command."));
    stage.watch(() => this.renew());
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

  /** @param {Course} course as the clip was solved */
  fill(course) {
    if (this.sliders.childElementCount) return;
    this.course = { ...course };
    /** @type {[keyof Course, string, string, number, number, number][]} */
    const told = [
      ["triangles", "Triangles", "How many there shall be", 50, Math.max(4000, 2 * course.triangles), 10],
      ["error", "τ", "Triangles are split while their error exceeds this [code values]; 0 for no threshold", 0, 60, 0.5],
      ["regularity", "λ", "Pull of every vertex towards the centre of its ring", 0, 0.05, 0.0005],
      ["trust_region", "Trust region", "Longest step of a vertex [px]", 0.05, 3, 0.05],
    ];
    for (const [name, label, title, least, most, step] of told) {
      const changed = (/** @type {number} */ value) => {
        this.course[name] = value;
        if (this.isOn) this.ask("play");
      };
      this.sliders.append(slider({ name: `course-${name}`, label, title, least, most, step, value: course[name], changed }).row);
    }
  }

  toggle() {
    this.ask(this.isOn ? "pause" : "play");
  }

  /** @param {"play" | "pause" | "step"} what */
  async ask(what) {
    const { stage } = this;
    if (stage.view !== "live") {
      this.curve = [];
      stage.view = "live";
    }
    stage.pause();
    this.isOn = what === "play";
    this.renew();
    stage.changed();
    try {
      await stage.connection.ask("optimise", { do: what, ...this.course });
    } catch (error) {
      this.isOn = false;
      stage.told.problem(/** @type {Error} */ (error).message);
    }
  }

  /** @param {{view: string, steps?: number, rmse?: number} & Record<string, any>} head of a mesh that came */
  take(head) {
    if (head.view !== "live" || head.rmse === undefined) return;
    this.curve.push(head.rmse);
    if (this.curve.length > MOST) this.curve.shift();
    const now = performance.now();
    this.times = [...this.times.filter((time) => now - time < 1000), now];
    const rate = this.isOn ? `, ${this.times.length} steps a second` : "";
    this.told.textContent = `step ${head.steps}: rmse ${head.rmse.toFixed(2)}${rate}`;
    this.paint();
  }

  renew() {
    if (this.stage.view !== "live") this.isOn = false;
    this.play.textContent = this.isOn ? "Pause" : "Play";
  }

  /** Error over steps, as in the paper's Fig. 12. */
  paint() {
    const scale = devicePixelRatio || 1;
    const [across, down] = [this.plot.clientWidth, this.plot.clientHeight];
    if (!across) return;
    Object.assign(this.plot, { width: across * scale, height: down * scale });
    const c = /** @type {CanvasRenderingContext2D} */ (this.plot.getContext("2d"));
    c.scale(scale, scale);
    const [least, most] = [Math.min(...this.curve), Math.max(...this.curve)];
    c.strokeStyle = "#f2b45c";
    c.lineWidth = 1.5;
    c.beginPath();
    this.curve.forEach((value, i) => {
      const share = most > least ? (value - least) / (most - least) : 0.5;
      c.lineTo((i / Math.max(1, this.curve.length - 1)) * (across - 2) + 1, down - 4 - share * (down - 8));
    });
    c.stroke();
    this.plot.setAttribute("aria-label", `Error over ${this.curve.length} steps, from ${this.curve[0]?.toFixed(2)} to ${this.curve.at(-1)?.toFixed(2)}`);
  }
}
