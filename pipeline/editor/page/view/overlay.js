/**
 * @typedef {import("../mesh/mesh.js").Mesh} Mesh
 * @typedef {import("../mesh/pick.js").Picked} Picked
 * @typedef {{x: number, y: number}} Point
 * @typedef {{at: Point, radius: number, fresh: Point[], gone: Point[], removes: boolean}} Brush
 * @typedef {{picked: Picked | null, plan: string, brush: Brush | null, moving: {from: Point, to: Point, vertex: number} | null,
 *   polygon: Point[], cursor: Point | null}} Shown
 */

const ACCENT = "#f2b45c";
const BAD = "#ef7a68";
const GOOD = "#79c79b";

/** Draws what a click would do. */
export class Overlay {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.isBare = false;
    this.context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  }

  /**
   * @param {import("./camera.js").Camera} camera
   * @param {Mesh | null} mesh
   * @param {Shown} shown
   */
  paint(camera, mesh, shown) {
    const { canvas, context: c } = this;
    const isBare = !(shown.picked || shown.moving || shown.brush || shown.polygon.length || shown.cursor);
    if (isBare && this.isBare) return;
    this.isBare = isBare;
    const scale = devicePixelRatio || 1;
    const [across, down] = [Math.round(canvas.clientWidth * scale), Math.round(canvas.clientHeight * scale)];
    if (canvas.width !== across || canvas.height !== down) [canvas.width, canvas.height] = [across, down];
    c.setTransform(scale, 0, 0, scale, 0, 0);
    c.clearRect(0, 0, across, down);
    c.lineCap = c.lineJoin = "round";
    /** @param {Point} at */
    const on = (at) => camera.toScreen(at);
    if (mesh && shown.picked && !shown.moving) this.paintPlan(mesh, shown.picked, shown.plan, on);
    if (mesh && shown.moving) this.paintMove(mesh, shown.moving, on);
    if (shown.brush) this.paintBrush(shown.brush, camera.zoom, on);
    if (shown.polygon.length) this.paintPolygon(shown.polygon, on);
    if (shown.cursor) this.paintCursor(on(shown.cursor));
  }

  /**
   * @param {Mesh} mesh
   * @param {Picked} picked
   * @param {string} plan
   * @param {(at: Point) => Point} on
   */
  paintPlan(mesh, picked, plan, on) {
    if (picked.kind === "vertex") {
      const at = on(mesh.at(picked.vertex));
      if (plan === "collapse_vertex") {
        this.line(at, on(mesh.at(mesh.nearestNeighbour(picked.vertex))), BAD, 2.5, true);
        this.cross(at, BAD);
      } else this.ring(at, 7, plan === "unlock" ? BAD : ACCENT);
    } else if (picked.kind === "edge") {
      const [a, b] = mesh.ends(picked.edge);
      this.line(on(mesh.at(a)), on(mesh.at(b)), plan === "flip_edge" ? BAD : ACCENT, 3, plan === "flip_edge");
      const opposite = mesh.opposite(picked.edge).map((v) => on(mesh.at(v)));
      if (plan === "flip_edge" && opposite.length === 2) this.line(opposite[0], opposite[1], GOOD, 2.5);
      if (plan === "split_edge") {
        for (const end of opposite) this.line(on(picked.at), end, GOOD, 1.5, true);
        this.dot(on(picked.at), GOOD);
      }
    } else {
      const corners = mesh.corners(picked.triangle).map((v) => on(mesh.at(v)));
      this.area(corners, plan === "turn_base_edge" ? "#79c79b33" : "#f2b45c33");
      if (plan === "turn_base_edge") this.line(corners[1], corners[2], GOOD, 3);
      if (plan === "turn_base_edge") this.line(corners[0], corners[1], ACCENT, 3, true);
      if (plan === "split_triangle") {
        for (const corner of corners) this.line(on(picked.at), corner, GOOD, 1.5, true);
        this.dot(on(picked.at), GOOD);
      }
    }
  }

  /**
   * @param {Mesh} mesh
   * @param {{from: Point, to: Point, vertex: number}} moving
   * @param {(at: Point) => Point} on
   */
  paintMove(mesh, moving, on) {
    for (const other of mesh.neighbours[moving.vertex]) this.line(on(moving.to), on(mesh.at(other)), GOOD, 1.5);
    this.line(on(moving.from), on(moving.to), ACCENT, 1, true);
    this.dot(on(moving.to), GOOD);
  }

  /**
   * @param {Brush} brush
   * @param {number} zoom
   * @param {(at: Point) => Point} on
   */
  paintBrush(brush, zoom, on) {
    const c = this.context;
    this.ring(on(brush.at), brush.radius * zoom, brush.removes ? BAD : ACCENT, 1.5);
    for (const at of brush.fresh) this.dot(on(at), GOOD, 3);
    for (const at of brush.gone) this.cross(on(at), BAD);
    c.globalAlpha = 1;
  }

  /**
   * @param {Point[]} polygon
   * @param {(at: Point) => Point} on
   */
  paintPolygon(polygon, on) {
    const corners = polygon.map(on);
    this.area(corners, "#f2b45c22");
    corners.forEach((corner, i) => this.line(corner, corners[(i + 1) % corners.length], ACCENT, 1.5, i === corners.length - 1));
  }

  /** @param {Point} at */
  paintCursor(at) {
    const arm = 11;
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      const from = { x: at.x + dx * 4, y: at.y + dy * 4 };
      this.line(from, { x: at.x + dx * arm, y: at.y + dy * arm }, "#fff", 1.5);
    }
  }

  /**
   * @param {Point} a
   * @param {Point} b
   * @param {string} color
   * @param {number} width
   * @param {boolean} [dashed]
   */
  line(a, b, color, width, dashed = false) {
    const c = this.context;
    for (const [hue, wide] of /** @type {[string, number][]} */ ([["#000a", width + 2], [color, width]])) {
      c.setLineDash(dashed ? [5, 5] : []);
      c.strokeStyle = hue;
      c.lineWidth = wide;
      c.beginPath();
      c.moveTo(a.x, a.y);
      c.lineTo(b.x, b.y);
      c.stroke();
    }
    c.setLineDash([]);
  }

  /**
   * @param {Point} at
   * @param {number} radius
   * @param {string} color
   * @param {number} [width]
   */
  ring(at, radius, color, width = 2) {
    const c = this.context;
    for (const [hue, wide] of /** @type {[string, number][]} */ ([["#000a", width + 2], [color, width]])) {
      c.strokeStyle = hue;
      c.lineWidth = wide;
      c.beginPath();
      c.arc(at.x, at.y, radius, 0, 2 * Math.PI);
      c.stroke();
    }
  }

  /**
   * @param {Point} at
   * @param {string} color
   * @param {number} [radius]
   */
  dot(at, color, radius = 4.5) {
    const c = this.context;
    c.fillStyle = color;
    c.strokeStyle = "#000c";
    c.lineWidth = 1.5;
    c.beginPath();
    c.arc(at.x, at.y, radius, 0, 2 * Math.PI);
    c.fill();
    c.stroke();
  }

  /**
   * @param {Point} at
   * @param {string} color
   */
  cross(at, color) {
    this.line({ x: at.x - 5, y: at.y - 5 }, { x: at.x + 5, y: at.y + 5 }, color, 2);
    this.line({ x: at.x - 5, y: at.y + 5 }, { x: at.x + 5, y: at.y - 5 }, color, 2);
  }

  /**
   * @param {Point[]} corners
   * @param {string} color
   */
  area(corners, color) {
    const c = this.context;
    c.fillStyle = color;
    c.beginPath();
    for (const corner of corners) c.lineTo(corner.x, corner.y);
    c.fill();
  }
}
