/** @typedef {import("../stage.js").Stage} Stage */

const ACCENT = "#f2b45c";
const MARKS = 12;

/** The film as a strip: thumbnails, shots, edited frames, and where one is. */
export class Scrubber {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {Stage} stage
   */
  constructor(canvas, stage) {
    this.canvas = canvas;
    this.stage = stage;
    this.context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    /** @type {Map<number, ImageBitmap | null>} null while it is on its way */
    this.thumbs = new Map();
    /** @type {number[]} */
    this.wanted = [];
    this.isAsking = false;
    stage.watch(() => this.paint());
    canvas.addEventListener("pointerdown", (event) => this.point(event));
    canvas.addEventListener("pointermove", (event) => event.buttons && this.point(event));
    canvas.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.paint()).observe(canvas);
  }

  /** @param {number} x [px]; @returns {number} the frame there */
  frameAt(x) {
    const { frames } = this.stage;
    const place = Math.floor((x / this.canvas.clientWidth) * frames.length);
    return frames[Math.min(frames.length - 1, Math.max(0, place))];
  }

  /** @param {number} frame; @returns {number} its middle [px] */
  placeOf(frame) {
    const { frames } = this.stage;
    return ((frames.indexOf(frame) + 0.5) / frames.length) * this.canvas.clientWidth;
  }

  /** @param {PointerEvent} event */
  point(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.stage.pause();
    this.stage.seek(this.frameAt(event.clientX - this.canvas.getBoundingClientRect().left));
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    const { stage } = this;
    /** @type {Record<string, number>} */
    const steps = { ArrowLeft: -1, ArrowRight: 1, PageUp: -10, PageDown: 10, Home: -1e9, End: 1e9 };
    if (event.key in steps) {
      event.preventDefault();
      event.stopPropagation();
      stage.pause();
      stage.step(steps[event.key]);
    }
  }

  /** @param {import("../net/packed.js").Packed} packed a thumbnail */
  async show({ head, arrays }) {
    const pixels = new Uint8ClampedArray(4 * head.columns * head.rows).fill(255);
    for (let i = 0; i < head.columns * head.rows; i++) pixels.set(arrays.pixels.subarray(head.channels * i, head.channels * i + 3), 4 * i);
    this.thumbs.set(head.frame, await createImageBitmap(new ImageData(pixels, head.columns, head.rows)));
    this.paint();
  }

  /** Forget all thumbnails: the film has changed. */
  renew() {
    this.thumbs.clear();
    this.paint();
  }

  paint() {
    const { canvas, context: c, stage } = this;
    const scale = devicePixelRatio || 1;
    const [across, down] = [canvas.clientWidth, canvas.clientHeight];
    if (!across || stage.frames.length < 2) return;
    const [columns, rows] = [Math.round(across * scale), Math.round(down * scale)];
    if (canvas.width !== columns || canvas.height !== rows) [canvas.width, canvas.height] = [columns, rows];
    c.setTransform(scale, 0, 0, scale, 0, 0);
    c.clearRect(0, 0, across, down);
    this.paintThumbs(across, down - MARKS);
    this.paintShots(across, down);
    for (const frame of stage.state.edited) this.paintEdited(this.placeOf(frame), down - MARKS / 2);
    const here = this.placeOf(stage.frame);
    c.fillStyle = "#000a";
    c.fillRect(here - 2.5, 0, 5, down);
    c.fillStyle = "#fff";
    c.fillRect(here - 1, 0, 2, down);
    canvas.setAttribute("aria-valuenow", String(stage.frame));
    canvas.setAttribute("aria-valuetext", `frame ${stage.frame}`);
  }

  /**
   * @param {number} across
   * @param {number} height
   */
  paintThumbs(across, height) {
    const { stage, context: c } = this;
    const count = Math.max(1, Math.min(stage.frames.length, Math.round(across / (height * (stage.size.width / stage.size.height)))));
    const wide = across / count;
    this.wanted = [];
    for (let i = 0; i < count; i++) {
      const frame = this.frameAt((i + 0.5) * wide);
      const thumb = this.thumbs.get(frame);
      c.fillStyle = "#20242a";
      c.fillRect(i * wide, 0, wide, height);
      if (thumb) c.drawImage(thumb, i * wide, 0, wide, height);
      else if (thumb === undefined) this.wanted.push(frame);
    }
    this.askNext();
  }

  async askNext() {
    const frame = this.wanted.shift();
    if (this.isAsking || frame === undefined || !this.stage.connection.isOpen || this.stage.isPlaying) return;
    this.isAsking = true;
    this.thumbs.set(frame, null);
    try {
      await this.stage.connection.ask("thumbnail", { frame });
    } catch {
      this.thumbs.delete(frame); // it is asked for again once there is a connection
    } finally {
      this.isAsking = false;
      this.askNext();
    }
  }

  /**
   * @param {number} across
   * @param {number} down
   */
  paintShots(across, down) {
    const { stage, context: c } = this;
    const width = across / stage.frames.length;
    for (const [first, last] of stage.shots) {
      const left = this.placeOf(first) - width / 2;
      const right = this.placeOf(last) + width / 2;
      c.fillStyle = stage.state.pending.includes(first) ? ACCENT : "#3a404a";
      c.fillRect(left + 1, down - 2, right - left - 2, 2);
      c.fillStyle = "#000";
      if (left > 1) c.fillRect(left - 1, 0, 2, down);
    }
  }

  /**
   * @param {number} x
   * @param {number} y
   */
  paintEdited(x, y) {
    const c = this.context;
    c.fillStyle = ACCENT;
    c.beginPath();
    for (const [dx, dy] of [[0, -4.5], [4.5, 0], [0, 4.5], [-4.5, 0]]) c.lineTo(x + dx, y - 1 + dy);
    c.fill();
  }
}
