/** @typedef {{x: number, y: number}} Point */

/** Least and most screen pixels per pixel of the picture. */
const LEAST = 0.05;
const MOST = 60;

/** Where the picture lies on the screen [CSS px]. */
export class Camera {
  constructor() {
    this.zoom = 1;
    this.x = 0;
    this.y = 0;
    this.isFitted = false; // and neither moved nor zoomed since
  }

  /**
   * Show all of a picture.
   * @param {number} width
   * @param {number} height
   * @param {number} across of the screen
   * @param {number} down of the screen
   */
  fit(width, height, across, down) {
    const room = 24;
    this.zoom = Math.max(LEAST, Math.min((across - room) / width, (down - room) / height));
    this.x = (across - width * this.zoom) / 2;
    this.y = (down - height * this.zoom) / 2;
    this.isFitted = true;
  }

  /**
   * Come nearer, and leave what is under a point there.
   * @param {number} factor
   * @param {Point} under on the screen
   */
  near(factor, under) {
    const zoom = Math.min(MOST, Math.max(LEAST, this.zoom * factor));
    this.x = under.x - ((under.x - this.x) * zoom) / this.zoom;
    this.y = under.y - ((under.y - this.y) * zoom) / this.zoom;
    this.zoom = zoom;
    this.isFitted = false;
  }

  /**
   * @param {number} dx
   * @param {number} dy
   */
  pan(dx, dy) {
    this.x += dx;
    this.y += dy;
    this.isFitted = false;
  }

  /** @param {Point} at of the picture; @returns {Point} */
  toScreen(at) {
    return { x: at.x * this.zoom + this.x, y: at.y * this.zoom + this.y };
  }

  /** @param {Point} at of the screen; @returns {Point} */
  toPicture(at) {
    return { x: (at.x - this.x) / this.zoom, y: (at.y - this.y) / this.zoom };
  }
}
