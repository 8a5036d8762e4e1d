/** How far an arrow moves the pen, and with Shift [px of the sheet]. */
const STEP = 8;
const PRECISE = 1;
/** @type {Record<string, [number, number]>} */
const WAYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** A pen that is led by keys over a sheet: a ring shows where it is, filled while it draws. */
export class PenByKeys {
  /**
   * @param {HTMLCanvasElement} sheet
   * @param {number} side of the sheet [px]
   * @param {(to: {x: number, y: number}) => void} draw a line to there, from where the last one ended
   * @param {() => void} lift the pen: the next line begins anew
   */
  constructor(sheet, side, draw, lift) {
    this.side = side;
    this.draw = draw;
    this.lift = lift;
    this.at = { x: side / 2, y: side / 2 };
    this.isDown = false;
    this.ring = document.createElement("span");
    this.ring.className = "pen";
    this.ring.hidden = true;
    sheet.addEventListener("keydown", (event) => this.key(event));
    sheet.addEventListener("focus", () => this.show(sheet.matches(":focus-visible")));
    sheet.addEventListener("blur", () => this.rest());
    sheet.addEventListener("pointerdown", () => this.rest());
    sheet.after(this.ring);
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const way = WAYS[event.key];
    if (way) this.move(way, event.shiftKey ? PRECISE : STEP);
    else if (event.key === " " || event.key === "Enter") this.set(!this.isDown);
    else if (event.key === "Escape") this.set(false);
    else return;
    event.preventDefault();
    event.stopPropagation(); // arrows move the picture's cursor elsewhere
    this.show(true);
  }

  /**
   * @param {[number, number]} way
   * @param {number} step
   */
  move([x, y], step) {
    const within = (/** @type {number} */ value) => Math.min(this.side, Math.max(0, value));
    this.at = { x: within(this.at.x + step * x), y: within(this.at.y + step * y) };
    if (this.isDown) this.draw(this.at);
  }

  /** @param {boolean} isDown */
  set(isDown) {
    this.isDown = isDown;
    this.lift();
    if (isDown) this.draw(this.at);
  }

  rest() {
    if (this.isDown) this.set(false);
    this.show(false);
  }

  /** @param {boolean} is */
  show(is) {
    this.ring.hidden = !is;
    this.ring.classList.toggle("down", this.isDown);
    this.ring.style.left = `${(100 * this.at.x) / this.side}%`;
    this.ring.style.top = `${(100 * this.at.y) / this.side}%`;
  }
}
