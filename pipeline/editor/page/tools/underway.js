/**
 * Edits on their way to the program.
 * @typedef {import("../stage.js").Stage} Stage
 * @typedef {import("../stage.js").Point} Point
 * @typedef {import("./plans.js").Edit} Edit
 * @typedef {{id: number, to: Point, around: Point[]}} Move a vertex that was dropped, by its id, and between which
 *   places the mesh looks otherwise
 * @typedef {{move: Move | null, refusal: string}} Errand
 */

/** So near to where it looks otherwise an edit is made there [px of the picture]. */
const CLOSE = 1;

/** Edits and undos go one after the other; vertices that were dropped lie there at once. */
export class Underway {
  /** @param {Stage} stage */
  constructor(stage) {
    this.stage = stage;
    /** @type {Errand[]} */
    this.errands = [];
    this.done = Promise.resolve();
  }

  /**
   * Make edits, one after the other.
   * @param {Edit[]} edits
   * @param {Move | null} [move] the vertex that they drop
   */
  make(edits, move = null) {
    const { stage } = this;
    stage.pause();
    if (stage.view !== "edited" && stage.view !== "live") {
      stage.told.say("Now the frame is shown as your edits leave it: make the edit again.");
      stage.setView("edited");
      return this.done;
    }
    const framed = edits.map(({ edit, ...rest }) => ({ edit, frame: stage.frame, ...rest }));
    // a hand pointed at a mesh in which these lie where they were dropped
    const seen = this.errands.filter(({ move }) => move && edits.some((edit) => isNear(edit, move)));
    /** @type {Errand} */
    const errand = { move, refusal: "" };
    this.errands.push(errand);
    if (move) this.renew();
    this.done = this.done.then(async () => {
      try {
        errand.refusal = seen.find((one) => one.refusal)?.refusal ?? "";
        if (errand.refusal) throw new Error(`${errand.refusal}; what followed was not made either`);
        const { number } = await stage.connection.ask("edit", { edits: framed, after: stage.state.number });
        stage.state.number = number;
      } catch (error) {
        const { message } = /** @type {Error} */ (error);
        errand.refusal ||= message;
        stage.told.problem(message);
      }
      this.errands.shift();
      if (errand.refusal && move) this.renew();
    });
    return this.done;
  }

  /** @param {"undo" | "redo"} what */
  turn(what) {
    const { stage } = this;
    const last = this.errands.at(-1);
    this.done = this.done.then(async () => {
      if (last?.refusal) return; // it is as if it was never made: what came before it stays
      try {
        const { frame } = await stage.connection.ask(what);
        stage.told.say(frame === null ? `There is nothing to ${what}` : `${what === "undo" ? "Undone" : "Done again"}, frame ${frame}`);
      } catch (error) {
        stage.told.problem(/** @type {Error} */ (error).message);
      }
    });
    return this.done;
  }

  /** Vertices that were dropped lie where a hand put them, all others where the program has them. */
  place() {
    const { mesh, painter } = this.stage;
    if (!mesh) return;
    mesh.putBack();
    for (const { move, refusal } of this.errands) {
      if (move && !refusal) mesh.put(move.id, move.to);
    }
    painter.setMesh(mesh);
  }

  /** A vertex is dropped, or has to go back. */
  renew() {
    const { stage } = this;
    this.place();
    if (stage.mesh && stage.moving) stage.moving = stage.mesh.carriedOn(stage.moving, stage.mesh);
    stage.hover();
  }
}

/**
 * Whether an edit is made where the mesh looks otherwise if a vertex does not move.
 * @param {Edit} edit
 * @param {Move} move
 */
function isNear({ at, radius = 0 }, { around }) {
  if (!at) return true; // a region: it may be anywhere
  return [0, 1].every((axis) => {
    const sides = around.map(({ x, y }) => (axis ? y : x));
    return Math.min(...sides) - radius - CLOSE <= at[axis] && at[axis] <= Math.max(...sides) + radius + CLOSE;
  });
}
