/**
 * Hands: mouse, pen and fingers.
 * @typedef {import("../stage.js").Stage} Stage
 * @typedef {{x: number, y: number}} Point
 */

/** How far one may slip and still click [px of the screen]. */
const SLIP = 4;
/** How long a finger rests for what the right button does [ms]. */
const LONG = 550;

export class Pointer {
  /** @param {Stage} stage */
  constructor(stage) {
    this.stage = stage;
    const { canvas } = stage;
    /** @type {Map<number, Point>} */
    this.fingers = new Map();
    /** @type {{at: Point, button: number, isDragged: boolean, isFirst: boolean, kind: "click" | "pan" | "move" | "paint" | "region", last: Point} | null} */
    this.press = null;
    this.longTimer = 0;
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.up(event));
    canvas.addEventListener("pointercancel", (event) => this.cancel(event));
    canvas.addEventListener("pointerleave", () => this.leave());
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
  }

  /**
   * @param {MouseEvent} event
   * @returns {Point} on the stage
   */
  place(event) {
    const box = this.stage.canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  /** @param {PointerEvent} event */
  down(event) {
    const { stage } = this;
    const at = this.place(event);
    stage.canvas.focus({ preventScroll: true });
    stage.canvas.setPointerCapture(event.pointerId);
    this.fingers.set(event.pointerId, at);
    stage.isByKeys = false;
    stage.shift = event.shiftKey;
    stage.pointer = stage.camera.toPicture(at);
    clearTimeout(this.longTimer);
    if (this.fingers.size > 1) {
      this.press = null;
      stage.letGo();
      return;
    }
    if (stage.moving) {
      stage.hand.drop();
      return;
    }
    this.press = { at, last: at, button: event.button, isDragged: false, isFirst: true, kind: this.kind(event) };
    this.press.isFirst = !stage.polygon.length;
    if (this.press.kind === "region" && this.press.isFirst) stage.polygon = [stage.pointer];
    if (this.press.kind === "paint") this.paint(at);
    if (event.pointerType === "touch") this.longTimer = setTimeout(() => this.long(), LONG);
  }

  /** @param {PointerEvent} event */
  kind(event) {
    const { stage } = this;
    if (event.button === 1 || event.altKey) return "pan";
    if (stage.tool === "brush" || stage.tool === "paint") return "paint";
    if (stage.tool === "region") return "region";
    return event.button === 0 && stage.tool === "edit" && stage.picked()?.kind === "vertex" ? "move" : "click";
  }

  /** A finger rested: it means the right button. */
  long() {
    if (this.press && !this.press.isDragged && this.press.kind !== "region") {
      this.press = null;
      this.stage.letGo();
      this.stage.hand.click("right");
    }
  }

  /** @param {PointerEvent} event */
  move(event) {
    const { stage } = this;
    const at = this.place(event);
    if (this.fingers.size > 1 && this.fingers.has(event.pointerId)) {
      this.pinch(event.pointerId, at);
      return;
    }
    const before = stage.pointer;
    stage.veil(false);
    stage.isByKeys = false;
    stage.shift = event.shiftKey;
    stage.pointer = stage.camera.toPicture(at);
    if (this.press) this.drag(at, event.shiftKey);
    else if (stage.moving && before) this.carry(before, event.shiftKey);
    if (!this.press || this.press.kind !== "pan") stage.hover();
  }

  /**
   * @param {Point} at
   * @param {boolean} precise
   */
  drag(at, precise) {
    const { stage, press } = this;
    if (!press) return;
    const isFar = Math.hypot(at.x - press.at.x, at.y - press.at.y) > SLIP;
    if (isFar && !press.isDragged) {
      press.isDragged = true;
      clearTimeout(this.longTimer);
      if (press.kind === "move") {
        stage.pointer = stage.camera.toPicture(press.at);
        stage.hand.grab();
      }
    }
    if (!press.isDragged) return;
    if (press.kind === "pan") stage.camera.pan(at.x - press.last.x, at.y - press.last.y);
    if (press.kind === "move") this.carry(stage.camera.toPicture(press.last), precise, at);
    if (press.kind === "region" && stage.pointer) stage.polygon.push(stage.pointer);
    if (press.kind === "paint") this.paint(at);
    press.last = at;
    stage.repaint();
  }

  /**
   * Carry a vertex along with the pointer.
   * @param {Point} before where the pointer was, in the picture
   * @param {boolean} precise
   * @param {Point | null} at where it is on the stage, if not where the stage knows
   */
  carry(before, precise, at = null) {
    const { stage } = this;
    const now = at ? stage.camera.toPicture(at) : stage.pointer;
    if (!stage.moving || !now) return;
    const share = precise ? 0.1 : 1;
    const { to } = stage.moving;
    stage.moving.to = { x: to.x + share * (now.x - before.x), y: to.y + share * (now.y - before.y) };
    stage.repaint();
  }

  /**
   * Paint where the brush has gone on by half of its radius.
   * @param {Point} at
   */
  paint(at) {
    const { stage, press } = this;
    if (!press) return;
    const away = Math.hypot(at.x - press.at.x, at.y - press.at.y) / stage.camera.zoom;
    if (press.isDragged && away < stage.brush.radius) return;
    press.at = at;
    stage.pointer = stage.camera.toPicture(at);
    stage.hand.click(press.button === 2 ? "right" : "left");
  }

  /** @param {PointerEvent} event */
  up(event) {
    const { stage, press } = this;
    clearTimeout(this.longTimer);
    this.fingers.delete(event.pointerId);
    this.press = null;
    if (!press) return;
    stage.shift = event.shiftKey;
    if (press.kind === "move" && press.isDragged) stage.hand.drop();
    else if (press.kind === "region") this.outline(press.isDragged, press.isFirst);
    else if ((press.kind === "click" || press.kind === "move") && !press.isDragged) {
      stage.hand.click(press.button === 2 ? "right" : "left");
    }
    stage.repaint();
  }

  /**
   * A region is dragged in one go, or gets a corner by every click.
   * @param {boolean} isDragged
   * @param {boolean} isFirst
   */
  outline(isDragged, isFirst) {
    const { marks } = this.stage;
    if (isDragged && isFirst) marks.close();
    else if (!isDragged && !isFirst) marks.corner();
  }

  /** @param {PointerEvent} event */
  cancel(event) {
    this.fingers.delete(event.pointerId);
    this.press = null;
    this.stage.letGo();
  }

  leave() {
    if (this.press || this.stage.moving) return;
    this.stage.pointer = null;
    this.stage.hover();
  }

  /**
   * Two fingers: pan and zoom.
   * @param {number} id
   * @param {Point} at
   */
  pinch(id, at) {
    const { camera } = this.stage;
    const other = [...this.fingers].find(([key]) => key !== id)?.[1];
    const before = this.fingers.get(id);
    if (!other || !before) return;
    const [was, is] = [before, at].map((one) => Math.hypot(one.x - other.x, one.y - other.y));
    camera.near(is / Math.max(1, was), other);
    camera.pan((at.x - before.x) / 2, (at.y - before.y) / 2);
    this.fingers.set(id, at);
    this.stage.repaint();
  }

  /** @param {WheelEvent} event */
  wheel(event) {
    event.preventDefault();
    const { stage } = this;
    const turn = Math.max(-60, Math.min(60, event.deltaMode ? 30 * event.deltaY : event.deltaY));
    if ((stage.tool === "brush" || stage.tool === "paint") && !event.ctrlKey) {
      stage.setBrush({ radius: Math.round(stage.brush.radius * Math.exp(-turn / 400)) + (turn < 0 ? 1 : 0) });
      return;
    }
    const at = this.place(event);
    stage.camera.near(Math.exp(-turn / 250), at);
    stage.pointer = stage.camera.toPicture(at);
    stage.hover();
  }
}
