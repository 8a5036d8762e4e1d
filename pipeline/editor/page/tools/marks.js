/**
 * What the paint tool and the region tool give to a part of the picture.
 * @typedef {import("../stage.js").Stage} Stage
 * @typedef {import("../stage.js").Point} Point
 */

/** What a brush paints: kinds, and how they are called. */
export const PAINTS = /** @type {[string, string][]} */ ([
  ["style", "a style"],
  ["texture", "a texture"],
  ["focus", "focus (finer)"],
]);
/** What a region gets. */
export const REGIONS = /** @type {[string, string][]} */ ([
  ["retriangulate", "other vertices"],
  ["style", "a style"],
  ["texture", "a texture"],
  ["focus", "focus (finer)"],
  ["lock vertices", "pins on vertices"],
  ["lock edges", "pins on edges"],
  ["unlock vertices", "no pins on vertices"],
  ["unlock edges", "no pins on edges"],
]);

/** How near to the first corner a click closes a region [px of the screen]. */
const NEAR = 10;

export class Marks {
  /** @param {Stage} stage */
  constructor(stage) {
    this.stage = stage;
    this.paints = "style";
    this.gives = "retriangulate";
    this.style = "hatching";
    this.focus = 1;
    /** @type {() => Promise<{file: string, strength: number, opacity: number}>} */
    this.texture = async () => ({ file: "cushion", strength: 1, opacity: 1 });
  }

  /** Paint where the pointer is. */
  dab() {
    const { pointer, brush } = this.stage;
    if (pointer) this.give(this.paints, { at: [pointer.x, pointer.y], radius: brush.radius });
  }

  /** A corner of a region; near the first one the region is closed. */
  corner() {
    const { stage } = this;
    const { pointer, polygon, camera } = stage;
    if (!pointer) return;
    const first = polygon[0];
    const isNear = first && Math.hypot(pointer.x - first.x, pointer.y - first.y) * camera.zoom < NEAR;
    if (isNear && polygon.length > 2) this.close();
    else if (!isNear) polygon.push(pointer);
    stage.repaint();
  }

  /** The region that was drawn is whole. */
  close() {
    const { stage } = this;
    const polygon = stage.polygon.map(({ x, y }) => [x, y]);
    stage.polygon = [];
    if (polygon.length > 2) this.give(this.gives, { polygon });
    stage.repaint();
  }

  /**
   * @param {string} what
   * @param {{at: [number, number], radius: number} | {polygon: number[][]}} where
   */
  async give(what, where) {
    const { stage } = this;
    const [kind, held] = what.split(" ");
    /** @type {Record<string, any>} */
    let values = { style: this.style };
    if (kind === "focus") values = { strength: this.focus };
    if (kind === "retriangulate") values = { count: stage.brush.count, seed: stage.state.number };
    if (held) values = { what: held };
    const { frame } = stage;
    try {
      if (kind === "texture") values = await this.texture();
    } catch (error) {
      stage.told.problem(/** @type {Error} */ (error).message);
      return;
    }
    const name = { style: "style_region", texture: "texture_region", focus: "set_focus" }[kind] ?? kind;
    stage.make(/** @type {any} */ ({ edit: name, frame, ...where, ...values }));
  }
}
