import { Mesh } from "./mesh/mesh.js";
import { pick } from "./mesh/pick.js";
import { Ghosts } from "./tools/ghosts.js";
import { Hand } from "./tools/hand.js";
import { Marks } from "./tools/marks.js";
import { planned } from "./tools/plans.js";
import { Underway } from "./tools/underway.js";
import { Player } from "./time/player.js";
import { Camera } from "./view/camera.js";
import { focusSheet } from "./view/focus.js";
import { Overlay } from "./view/overlay.js";
import { Painter } from "./view/painter.js";

/**
 * @typedef {{x: number, y: number}} Point
 * @typedef {{radius: number, count: number, spread: string}} Brush
 * @typedef {{number: number, edits: number, edited: number[], pending: number[], canUndo: boolean,
 *   canRedo: boolean, hasGround: boolean}} State
 * @typedef {"edited" | "solved" | "before" | "live"} View
 */

/** Radii of the brush [px of the picture]. */
const RADII = [3, 400];

/** What is on the screen, and what a hand does to it. */
export class Stage {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {HTMLCanvasElement} overlay
   * @param {import("./net/connection.js").Connection} connection
   * @param {{problem: (text: string) => void, say: (text: string) => void}} told
   */
  constructor(canvas, overlay, connection, told) {
    this.canvas = canvas;
    this.connection = connection;
    this.told = told;
    this.painter = new Painter(canvas);
    this.overlay = new Overlay(overlay);
    this.camera = new Camera();
    this.size = { width: 1, height: 1 };
    this.hasRoom = { across: 0, down: 0 };
    this.frame = 0;
    this.tool = "edit";
    /** @type {"all" | "vertex" | "edge" | "face"} */
    this.mode = "all";
    this.opacities = { picture: 1, drawn: 1, errors: 0, painted: 0.6, mesh: 0.6 };
    this.hiddenMesh = 0.6;
    this.isVeiled = false;
    /** @type {Brush} */
    this.brush = { radius: 40, count: 10, spread: "uniform" };
    /** @type {State} */
    this.state = { number: 0, edits: 0, edited: [], pending: [], canUndo: false, canRedo: false, hasGround: true };
    /** @type {number[]} */
    this.frames = [0];
    /** @type {[number, number][]} */
    this.shots = [[0, 0]];
    /** @type {number | null} */
    this.rate = null;
    this.stem = "frame";
    this.track = "";
    /** @type {View} */
    this.view = "edited";
    this.player = new Player(this);
    this.marks = new Marks(this);
    this.ghosts = new Ghosts(this);
    this.hand = new Hand(this);
    this.strokes = "[]";
    this.isLooking = false;
    this.isLookWanted = false;
    /** @type {Mesh | null} */
    this.mesh = null;
    /** @type {Point | null} */
    this.pointer = null;
    this.isByKeys = false;
    this.shift = false;
    /** @type {{vertex: number, from: Point, to: Point} | null} */
    this.moving = null;
    /** @type {Point[]} */
    this.polygon = [];
    this.underway = new Underway(this);
    /** @type {(() => void)[]} */
    this.watchers = [];
    /** @type {((lines: string[]) => void)[]} */
    this.commandWatchers = [];
    this.isDirty = false;
    this.painted = () => {};
    new ResizeObserver(() => this.refit()).observe(canvas);
  }

  /** @param {() => void} watcher told of every change of what is chosen */
  watch(watcher) {
    this.watchers.push(watcher);
  }

  /** @param {(lines: string[]) => void} watcher */
  watchCommands(watcher) {
    this.commandWatchers.push(watcher);
  }

  changed() {
    for (const watcher of this.watchers) watcher();
    this.repaint();
  }

  async renewCommands() {
    const { lines } = await this.connection.ask("commands");
    for (const watcher of this.commandWatchers) watcher(lines);
  }

  /** @param {string} tool */
  setTool(tool) {
    this.letGo();
    this.tool = tool;
    this.changed();
    this.hover();
  }

  /** @param {"all" | "vertex" | "edge" | "face"} mode */
  setMode(mode) {
    this.mode = this.mode === mode ? "all" : mode;
    this.changed();
  }

  /**
   * @param {"picture" | "drawn" | "errors" | "painted" | "mesh"} layer
   * @param {number} value
   */
  setOpacity(layer, value) {
    this.opacities[layer] = value;
    this.changed();
  }

  /**
   * Hide the mesh until a hand is over the picture again: one looks at what a style does.
   * @param {boolean} isVeiled
   */
  veil(isVeiled) {
    if (this.isVeiled === isVeiled) return;
    this.isVeiled = isVeiled;
    this.repaint();
  }

  toggleMesh() {
    if (this.opacities.mesh) this.hiddenMesh = this.opacities.mesh;
    this.setOpacity("mesh", this.opacities.mesh ? 0 : this.hiddenMesh);
  }

  /** @param {Partial<Brush>} values */
  setBrush(values) {
    Object.assign(this.brush, values);
    this.brush.radius = Math.min(RADII[1], Math.max(RADII[0], this.brush.radius));
    this.changed();
    this.hover();
  }

  /** @param {State} state */
  setState(state) {
    this.state = state;
    this.changed();
    this.hover();
  }

  /** @param {import("./net/packed.js").Packed} packed */
  show(packed) {
    const isNext = this.isPlaying && packed.head.kind === "drawn" && packed.head.frame !== this.frame;
    if (isNext) this.frame = packed.head.frame;
    if (packed.head.frame !== this.frame && !this.isPlaying) return;
    if (packed.head.view === "live" && this.view !== "live") return; // a step that came too late
    if (packed.head.kind === "mesh") {
      const before = this.mesh;
      this.mesh = new Mesh(packed);
      this.underway.place();
      if (before && this.moving) this.moving = before.carriedOn(this.moving, this.mesh);
      if (packed.head.view === "live") this.ghosts.renewNowAndThen();
      else this.hover();
    } else if (packed.head.kind === "picture" || packed.head.kind === "drawn") {
      this.painter.setPicture(packed.head.kind, packed);
    }
    if (isNext) this.changed();
    else this.repaint();
  }

  /** @param {{frame: number, strokes: import("./view/focus.js").Stroke[]}} painted where errors count more */
  setFocus({ frame, strokes }) {
    if (frame !== this.frame) return;
    const spelled = JSON.stringify(strokes);
    if (spelled === this.strokes) return;
    this.strokes = spelled;
    this.painter.setSheet(focusSheet(strokes, this.size));
    this.repaint();
  }

  get isPlaying() {
    return this.player.isOn;
  }

  /**
   * Go to a frame.
   * @param {number} frame
   */
  async seek(frame) {
    this.frame = frame;
    if (this.view === "live") this.view = "edited";
    this.letGo();
    this.changed();
    this.isLookWanted = true;
    if (this.isLooking) return;
    this.isLooking = true;
    try {
      while (this.isLookWanted) {
        this.isLookWanted = false;
        await this.connection.ask("look", { frame: this.frame, view: this.view });
      }
    } catch (error) {
      this.told.problem(/** @type {Error} */ (error).message);
    } finally {
      this.isLooking = false;
    }
  }

  /** @param {number} by frames */
  step(by) {
    const place = this.frames.indexOf(this.frame) + by;
    this.seek(this.frames[Math.min(this.frames.length - 1, Math.max(0, place))]);
  }

  pause() {
    this.player.pause();
  }

  togglePlay() {
    if (this.isPlaying) this.pause();
    else this.player.play();
  }

  /** @param {View} view */
  setView(view) {
    this.view = view;
    this.seek(this.frame);
  }

  /**
   * @param {number} width
   * @param {number} height
   */
  setSize(width, height) {
    this.size = { width, height };
    if (!this.camera.isFitted) this.refit();
  }

  /** The stage has another size: what was seen whole stays so, and what was in its middle stays there. */
  refit() {
    const { camera, canvas, hasRoom } = this;
    const [across, down] = [canvas.clientWidth, canvas.clientHeight];
    if (this.size.width <= 1 || !across) return;
    if (camera.isFitted || !hasRoom.across) this.fit();
    else camera.pan((across - hasRoom.across) / 2, (down - hasRoom.down) / 2);
    this.hasRoom = { across, down };
    this.repaint();
  }

  fit() {
    this.camera.fit(this.size.width, this.size.height, this.canvas.clientWidth, this.canvas.clientHeight);
    this.repaint();
  }

  repaint() {
    if (this.isDirty) return;
    this.isDirty = true;
    requestAnimationFrame(() => {
      this.isDirty = false;
      if (!this.isPaintable()) return;
      const { mesh, painted } = this.opacities;
      const over = this.isVeiled ? { mesh: 0, painted: 0 } : { mesh, painted };
      this.painter.paint(this.camera, this.size, { ...this.opacities, ...over });
      this.overlay.paint(this.camera, this.mesh, this.shown());
      this.painted();
    });
  }

  /** Whether there is what is painted with; else it is looked again soon. */
  isPaintable() {
    try {
      if (!this.painter.isReady) this.repaint();
      return this.painter.isReady;
    } catch (error) {
      this.told.problem(/** @type {Error} */ (error).message);
      return false;
    }
  }

  /** What is at the pointer. */
  picked() {
    if (!this.mesh || !this.pointer) return null;
    return pick(this.mesh, this.pointer, this.camera.zoom, this.mode);
  }

  /** What a left click would do, or what it is that a right one alone would. */
  plan() {
    const picked = this.picked();
    if (!picked) return "";
    if (this.tool === "pin") return this.isHeld(picked) ? "unlock" : picked.kind === "face" ? "" : "lock";
    return planned(picked, "left", this.shift);
  }

  /** @param {import("./mesh/pick.js").Picked} picked */
  isHeld(picked) {
    if (picked.kind === "vertex") return Boolean(this.mesh?.held[picked.vertex]);
    return picked.kind === "edge" && Boolean(this.mesh?.heldEdges[picked.edge]);
  }

  /** @returns {import("./view/overlay.js").Shown} */
  shown() {
    const isPicking = this.tool === "edit" || this.tool === "pin";
    const { ghost, pointer } = this;
    const brush = (this.tool === "brush" || this.tool === "paint") && pointer
      ? { at: pointer, radius: this.brush.radius, fresh: ghost?.fresh ?? [], gone: ghost?.gone ?? [], removes: this.shift && this.tool === "brush" }
      : null;
    return {
      picked: isPicking ? this.picked() : null,
      plan: this.plan(),
      brush,
      moving: this.moving,
      polygon: this.polygon,
      cursor: this.isByKeys ? pointer : null,
    };
  }

  /** What a touch of the brush would do here, as far as that is known. */
  get ghost() {
    return this.ghosts.now;
  }

  /** The pointer has moved, or what lies under it has changed. */
  hover() {
    this.ghosts.renew();
    this.repaint();
  }

  /**
   * A touch of the brush.
   * @param {Point} at
   * @param {boolean} removes
   * @returns {import("./tools/plans.js").Edit}
   */
  stroke(at, removes) {
    const kind = removes ? "remove" : "insert";
    // the same chance until the next edit: what the preview shows is what comes
    return { edit: kind, frame: this.frame, at: [at.x, at.y], ...this.brush, seed: this.state.number };
  }

  /** @param {...import("./tools/plans.js").Edit} edits made one after the other */
  make(...edits) {
    return this.underway.make(edits);
  }

  /** Let go of what was begun. */
  letGo() {
    this.moving = null;
    this.polygon = [];
    this.repaint();
  }
}
