/**
 * What a click does: the mouse of the paper, and the modes of the tools.
 * @typedef {import("../mesh/mesh.js").Mesh} Mesh
 * @typedef {import("../mesh/pick.js").Picked} Picked
 * @typedef {"left" | "right"} Button
 * @typedef {{edit: string, at: [number, number], [name: string]: any}} Edit
 */

/** What every plan is called in the line below the picture. */
export const NAMES = /** @type {Record<string, string>} */ ({
  split_edge: "split the edge",
  split_triangle: "split the triangle",
  collapse_vertex: "collapse the vertex into its nearest neighbour",
  flip_edge: "flip the edge",
  turn_base_edge: "turn the triangle's base edge (vertex order)",
  move_vertex: "drag to move the vertex",
  lock: "pin",
  unlock: "unpin",
});

/**
 * What a button would do to what the pointer is at.
 * @param {Picked} picked
 * @param {Button} button
 * @param {boolean} shift
 * @returns {string} the kind of edit, "" for nothing
 */
export function planned(picked, button, shift) {
  if (picked.kind === "vertex") return button === "left" ? "move_vertex" : "collapse_vertex";
  if (picked.kind === "edge") return button === "left" ? (shift ? "" : "split_edge") : "flip_edge";
  if (button === "right") return "";
  return shift ? "turn_base_edge" : "split_triangle";
}

/**
 * The edit of a plan.
 * @param {Mesh} mesh
 * @param {Picked} picked
 * @param {string} plan
 * @returns {Edit}
 */
export function editOf(mesh, picked, plan) {
  const place = placeOf(mesh, picked, plan);
  /** @type {Edit} */
  const edit = { edit: plan, at: place };
  if ((plan === "lock" || plan === "unlock") && picked.kind === "edge") edit.what = "edges";
  return edit;
}

/**
 * The place by which an edit finds what is meant again: the middle where all of it will do.
 * @param {Mesh} mesh
 * @param {Picked} picked
 * @param {string} plan
 * @returns {[number, number]}
 */
function placeOf(mesh, picked, plan) {
  if (picked.kind === "edge" && plan !== "split_edge") {
    const [a, b] = mesh.ends(picked.edge).map((end) => mesh.at(end));
    return [(a.x + b.x) / 2, (a.y + b.y) / 2];
  }
  if (picked.kind === "face" && plan !== "split_triangle") {
    const corners = mesh.corners(picked.triangle).map((corner) => mesh.at(corner));
    const mean = (/** @type {"x" | "y"} */ axis) => corners.reduce((sum, one) => sum + one[axis], 0) / 3;
    return [mean("x"), mean("y")];
  }
  return [picked.at.x, picked.at.y];
}
