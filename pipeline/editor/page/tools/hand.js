import { pick } from "../mesh/pick.js";
import { editOf, planned } from "./plans.js";

/** What a hand does to the mesh: clicks, and vertices that it carries. */
export class Hand {
  /** @param {import("../stage.js").Stage} stage */
  constructor(stage) {
    this.stage = stage;
  }

  /**
   * Do what a click does.
   * @param {"left" | "right"} button
   */
  click(button) {
    const { stage } = this;
    const { mesh, pointer, tool } = stage;
    const picked = stage.picked();
    if (!mesh || !pointer) return;
    if (tool === "paint") stage.marks.dab();
    else if (tool === "region") stage.marks.corner();
    else if (tool === "brush") {
      stage.make(stage.stroke(pointer, button === "right" || stage.shift));
    } else if (picked && tool === "pin") {
      const plan = button === "right" || stage.isHeld(picked) ? "unlock" : "lock";
      if (picked.kind !== "face") stage.make(editOf(mesh, picked, plan));
    } else if (picked && tool === "edit") {
      const plan = planned(picked, button, stage.shift);
      if (plan && plan !== "move_vertex") stage.make(editOf(mesh, picked, plan));
    }
  }

  /**
   * Do something to the nearest of a kind.
   * @param {"vertex" | "edge"} kind
   * @param {string} plan
   */
  act(kind, plan) {
    const { mesh, pointer, camera } = this.stage;
    if (!mesh || !pointer) return;
    const picked = pick(mesh, pointer, camera.zoom, kind);
    if (picked) this.stage.make(editOf(mesh, picked, plan));
  }

  /** Take up the vertex at the pointer. */
  grab() {
    const { stage } = this;
    if (!stage.mesh || !stage.pointer) return;
    const picked = pick(stage.mesh, stage.pointer, stage.camera.zoom, "vertex");
    if (picked?.kind === "vertex") stage.moving = { vertex: picked.vertex, from: picked.at, to: picked.at };
    stage.repaint();
  }

  /** Put the vertex that was taken up where it is now. */
  drop() {
    const { stage } = this;
    const { mesh, moving } = stage;
    stage.moving = null;
    if (mesh && moving && (moving.to.x !== moving.from.x || moving.to.y !== moving.from.y)) {
      const { vertex, from, to } = moving;
      const edit = { edit: "move_vertex", at: /** @type {[number, number]} */ ([from.x, from.y]), to: [to.x, to.y] };
      const around = [from, to, ...mesh.neighbours[vertex].map((other) => mesh.at(other))];
      stage.underway.make([edit], { id: mesh.ids[vertex], to, around });
    }
    stage.repaint();
  }
}
