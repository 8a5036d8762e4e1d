/**
 * The triangles of a frame, with the edges between them.
 * @typedef {{x: number, y: number}} Point
 */
export class Mesh {
  /** @param {import("../net/packed.js").Packed} packed */
  constructor({ head, arrays }) {
    /** @type {number} */ this.frame = head.frame;
    /** @type {number} */ this.width = head.width;
    /** @type {number} */ this.height = head.height;
    /** @type {number} */ this.rmse = head.rmse;
    /** @type {Float64Array} */ this.given = arrays.vertices;
    this.vertices = this.given;
    /** @type {Uint32Array} */ this.triangles = arrays.triangles;
    /** @type {Float64Array} */ this.ids = arrays.ids;
    /** @type {Uint8Array} */ this.held = arrays.held;
    /** @type {Uint8Array} */ this.bare = arrays.bare;
    /** @type {Float32Array} */ this.energies = arrays.energies;
    const halfEdges = this.triangles.length;
    this.edges = new Uint32Array(2 * halfEdges);
    this.beside = new Int32Array(2 * halfEdges).fill(-1);
    this.heldEdges = new Uint8Array(halfEdges);
    this.findEdges(arrays.heldEdges);
    /** @type {number[][]} */
    this.neighbours = Array.from({ length: this.vertexCount }, () => []);
    for (let edge = 0; edge < this.edgeCount; edge++) {
      const [a, b] = this.ends(edge);
      this.neighbours[a].push(b);
      this.neighbours[b].push(a);
    }
  }

  get vertexCount() {
    return this.vertices.length / 2;
  }

  get triangleCount() {
    return this.triangles.length / 3;
  }

  get edgeCount() {
    return this.edges.length / 2;
  }

  /**
   * Where a vertex is.
   * @param {number} vertex
   * @returns {Point}
   */
  at(vertex) {
    return { x: this.vertices[2 * vertex], y: this.vertices[2 * vertex + 1] };
  }

  /**
   * Corners of a triangle.
   * @param {number} triangle
   */
  corners(triangle) {
    return [0, 1, 2].map((i) => this.triangles[3 * triangle + i]);
  }

  /**
   * The ends of an edge.
   * @param {number} edge
   * @returns {[number, number]}
   */
  ends(edge) {
    return [this.edges[2 * edge], this.edges[2 * edge + 1]];
  }

  /**
   * The corners that face an edge: one on the border, else two.
   * @param {number} edge
   */
  opposite(edge) {
    const [a, b] = this.ends(edge);
    const beside = [this.beside[2 * edge], this.beside[2 * edge + 1]].filter((t) => t >= 0);
    return beside.map((t) => this.corners(t).find((v) => v !== a && v !== b) ?? a);
  }

  /** @param {Uint32Array} held half-edges that are held */
  findEdges(held) {
    const count = this.triangles.length;
    const heldOnes = new Set(held);
    /** @type {Map<number, number>} */
    const known = new Map();
    let edges = 0;
    for (let half = 0; half < count; half++) {
      const a = this.triangles[half];
      const b = this.triangles[half % 3 === 2 ? half - 2 : half + 1];
      const key = Math.min(a, b) * this.vertexCount + Math.max(a, b);
      let edge = known.get(key);
      if (edge === undefined) {
        edge = edges++;
        known.set(key, edge);
        this.edges[2 * edge] = a;
        this.edges[2 * edge + 1] = b;
        this.beside[2 * edge] = Math.floor(half / 3);
      } else {
        this.beside[2 * edge + 1] = Math.floor(half / 3);
      }
      if (heldOnes.has(half)) this.heldEdges[edge] = 1;
    }
    this.edges = this.edges.subarray(0, 2 * edges);
    this.heldEdges = this.heldEdges.subarray(0, edges);
  }

  /**
   * The neighbour that is nearest to a vertex: it goes there when it is collapsed.
   * @param {number} vertex
   */
  nearestNeighbour(vertex) {
    const from = this.at(vertex);
    const away = (/** @type {number} */ other) => {
      const to = this.at(other);
      return (to.x - from.x) ** 2 + (to.y - from.y) ** 2;
    };
    return this.neighbours[vertex].reduce((best, other) => (away(other) < away(best) ? other : best));
  }
  /**
   * Put a vertex elsewhere; on the border it slides along that. Triangles keep their colours.
   * @param {number} id
   * @param {Point} to
   */
  put(id, to) {
    const vertex = this.ids.indexOf(id);
    if (vertex < 0) return;
    if (this.vertices === this.given) this.vertices = this.given.slice();
    const { x, y } = this.at(vertex);
    if (x > 0 && x < this.width) this.vertices[2 * vertex] = to.x;
    if (y > 0 && y < this.height) this.vertices[2 * vertex + 1] = to.y;
  }

  /** All vertices lie where they came. */
  putBack() {
    this.vertices = this.given;
  }

  /**
   * A vertex that is carried while another mesh comes, which may have lost it.
   * @param {{vertex: number, from: Point, to: Point}} moving
   * @param {Mesh} mesh the other one
   */
  carriedOn({ vertex, from, to }, mesh) {
    const now = mesh.ids.indexOf(this.ids[vertex]);
    if (now < 0) return null;
    const isMoved = to.x !== from.x || to.y !== from.y;
    return { vertex: now, from: mesh.at(now), to: isMoved ? to : mesh.at(now) };
  }
}
