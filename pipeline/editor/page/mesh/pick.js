/**
 * What the pointer is at.
 * @typedef {import("./mesh.js").Mesh} Mesh
 * @typedef {{x: number, y: number}} Point
 * @typedef {{kind: "vertex", vertex: number, at: Point}
 *   | {kind: "edge", edge: number, at: Point}
 *   | {kind: "face", triangle: number, at: Point}} Picked
 */

/** How near one must be to a vertex and to an edge [px of the screen]. */
const VERTEX_REACH = 9;
const EDGE_REACH = 6;

/**
 * Find what is meant by a place.
 * @param {Mesh} mesh
 * @param {Point} at [px of the picture]
 * @param {number} zoom screen pixels per pixel of the picture
 * @param {"all" | "vertex" | "edge" | "face"} wanted
 * @returns {Picked | null}
 */
export function pick(mesh, at, zoom, wanted = "all") {
  if (at.x < 0 || at.y < 0 || at.x > mesh.width || at.y > mesh.height) return null;
  const only = wanted !== "all";
  if (wanted === "all" || wanted === "vertex") {
    const [vertex, away] = nearestVertex(mesh, at);
    if (only || away * zoom < VERTEX_REACH) return { kind: "vertex", vertex, at: mesh.at(vertex) };
  }
  if (wanted === "all" || wanted === "edge") {
    const [edge, place, away] = nearestEdge(mesh, at);
    if (only || away * zoom < EDGE_REACH) return { kind: "edge", edge, at: place };
  }
  const triangle = triangleAt(mesh, at);
  return triangle < 0 ? null : { kind: "face", triangle, at };
}

/**
 * @param {Mesh} mesh
 * @param {Point} at
 * @returns {[number, number]} the vertex, and how far it is
 */
function nearestVertex(mesh, at) {
  let best = 0;
  let least = Infinity;
  for (let v = 0; v < mesh.vertexCount; v++) {
    const away = (mesh.vertices[2 * v] - at.x) ** 2 + (mesh.vertices[2 * v + 1] - at.y) ** 2;
    if (away < least) [best, least] = [v, away];
  }
  return [best, Math.sqrt(least)];
}

/**
 * @param {Mesh} mesh
 * @param {Point} at
 * @returns {[number, Point, number]} the edge, the place on it, and how far that is
 */
function nearestEdge(mesh, at) {
  let best = 0;
  let least = Infinity;
  let place = at;
  const { vertices, edges } = mesh;
  for (let e = 0; e < mesh.edgeCount; e++) {
    const a = 2 * edges[2 * e];
    const b = 2 * edges[2 * e + 1];
    const dx = vertices[b] - vertices[a];
    const dy = vertices[b + 1] - vertices[a + 1];
    const along = ((at.x - vertices[a]) * dx + (at.y - vertices[a + 1]) * dy) / (dx * dx + dy * dy);
    const share = Math.min(1, Math.max(0, along));
    const x = vertices[a] + share * dx;
    const y = vertices[a + 1] + share * dy;
    const away = (x - at.x) ** 2 + (y - at.y) ** 2;
    if (away < least) [best, least, place] = [e, away, { x, y }];
  }
  return [best, place, Math.sqrt(least)];
}

/**
 * @param {Mesh} mesh
 * @param {Point} at
 * @returns {number} the triangle, -1 if there is none
 */
export function triangleAt(mesh, at) {
  const { vertices, triangles } = mesh;
  for (let t = 0; t < mesh.triangleCount; t++) {
    const [a, b, c] = [0, 1, 2].map((i) => 2 * triangles[3 * t + i]);
    const side = (/** @type {number} */ i, /** @type {number} */ j) =>
      (vertices[j] - vertices[i]) * (at.y - vertices[i + 1]) -
      (vertices[j + 1] - vertices[i + 1]) * (at.x - vertices[i]);
    if (side(a, b) >= 0 && side(b, c) >= 0 && side(c, a) >= 0) return t;
  }
  return -1;
}
