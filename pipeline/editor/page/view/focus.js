/**
 * Where a person painted that errors count more.
 * @typedef {{at: [number, number] | null, radius: number, polygon: [number, number][], strength: number}} Stroke
 */

/** How wide a sheet is at most, and how much finer than the picture [px]. */
const ACROSS = 1024;
const FINEST = 8;
/** Fills and rims; what is stronger is denser. */
const HUE = "143 168 255";

/**
 * Draw strokes on a sheet over the whole picture: no line is seen where they overlap.
 * @param {Stroke[]} strokes
 * @param {{width: number, height: number}} size of the picture [px]
 * @returns {HTMLCanvasElement | null} null if there is none
 */
export function focusSheet(strokes, size) {
  if (!strokes.length) return null;
  const scale = Math.min(FINEST, ACROSS / Math.max(size.width, size.height));
  const sheet = document.createElement("canvas");
  Object.assign(sheet, { width: Math.ceil(size.width * scale), height: Math.ceil(size.height * scale) });
  const c = /** @type {CanvasRenderingContext2D} */ (sheet.getContext("2d"));
  c.scale(sheet.width / size.width, sheet.height / size.height);
  const strengths = [...new Set(strokes.map((one) => one.strength))].sort((a, b) => a - b);
  for (const strength of strengths) {
    const paths = strokes.filter((one) => one.strength === strength).map(outline);
    c.globalCompositeOperation = "source-over";
    c.strokeStyle = `rgb(${HUE})`;
    c.lineWidth = 4 / scale; // of which the inner half is wiped out
    for (const path of paths) c.stroke(path);
    c.globalCompositeOperation = "destination-out";
    for (const path of paths) c.fill(path, "evenodd");
    c.globalCompositeOperation = "destination-over";
    c.fillStyle = `rgb(${HUE} / ${0.25 + 0.1 * Math.min(4, strength)})`;
    const whole = document.createElement("canvas"); // at once: a fill over a fill would be denser
    Object.assign(whole, { width: sheet.width, height: sheet.height });
    const w = /** @type {CanvasRenderingContext2D} */ (whole.getContext("2d"));
    w.setTransform(c.getTransform());
    for (const path of paths) w.fill(path, "evenodd");
    w.globalCompositeOperation = "source-in";
    w.fillStyle = c.fillStyle;
    w.fillRect(0, 0, size.width, size.height);
    c.drawImage(whole, 0, 0, size.width, size.height);
  }
  return sheet;
}

/** @param {Stroke} stroke */
function outline({ at, radius, polygon }) {
  const path = new Path2D();
  if (at) path.arc(at[0], at[1], radius, 0, 2 * Math.PI);
  for (const [x, y] of polygon) path.lineTo(x, y);
  path.closePath();
  return path;
}
