/**
 * The preview of the brush: where vertices would come to be, and which would go.
 * @typedef {import("../stage.js").Stage} Stage
 * @typedef {import("../stage.js").Point} Point
 * @typedef {{fresh: Point[], gone: Point[], removes: boolean}} Ghost
 */

/** How long the pointer rests before it is asked for [ms]. */
const REST = 40;
/** How often it is renewed while the optimiser moves the mesh [ms]. */
const AGAIN = 200;

export class Ghosts {
  /** @param {Stage} stage */
  constructor(stage) {
    this.stage = stage;
    /** @type {Ghost | null} */
    this.now = null;
    this.timer = 0;
    this.at = 0;
    this.isAsked = false;
  }

  /** What was known is no more; it is asked for once the pointer rests. */
  renew() {
    this.now = null;
    clearTimeout(this.timer);
    if (this.stage.tool === "brush" && this.stage.pointer) this.timer = setTimeout(() => this.ask(), REST);
  }

  /** The mesh moves by itself. */
  renewNowAndThen() {
    const now = performance.now();
    if (this.stage.tool !== "brush" || !this.stage.pointer || now - this.at < AGAIN) return;
    this.at = now;
    this.ask();
  }

  async ask() {
    const { stage } = this;
    if (this.isAsked || !stage.pointer || !stage.connection.isOpen) return;
    const at = stage.pointer;
    const removes = stage.shift;
    this.isAsked = true;
    try {
      const { fresh, gone } = await stage.connection.ask("ghost", { edits: [stage.stroke(at, removes)] });
      const points = (/** @type {number[][]} */ rows) => rows.map(([x, y]) => ({ x, y }));
      if (stage.pointer === at) this.now = { fresh: points(fresh), gone: points(gone), removes };
      stage.repaint();
    } catch {
      this.now = null; // where nothing can be put nothing is shown
    } finally {
      this.isAsked = false;
      if (stage.pointer !== at || stage.shift !== removes) stage.hover(); // it has moved on meanwhile
    }
  }
}
