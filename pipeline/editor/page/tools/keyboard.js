/** @typedef {import("../stage.js").Stage} Stage */

/** How far an arrow moves the cursor [px of the screen]. */
const STEP = 12;
/** @type {Record<string, [number, number]>} */
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** Keys: those of Blender where it has one for the same. */
export class Keyboard {
  /**
   * @param {Stage} stage
   * @param {HTMLDialogElement} help
   */
  constructor(stage, help) {
    this.stage = stage;
    this.help = help;
    this.typed = "";
    /** @type {Record<string, (() => void) | undefined>} */
    this.keys = {
      a: () => stage.setTool("edit"),
      b: () => stage.setTool("brush"),
      r: () => stage.setTool("region"),
      t: () => stage.setTool("paint"),
      p: () => this.pin(),
      v: () => stage.setMode("vertex"),
      e: () => stage.setMode("edge"),
      f: () => stage.setMode("face"),
      g: () => stage.hand.grab(),
      x: () => stage.hand.act("vertex", "collapse_vertex"),
      Delete: () => stage.hand.act("vertex", "collapse_vertex"),
      j: () => stage.hand.act("edge", "flip_edge"),
      o: () => stage.setBrush({ spread: stage.brush.spread === "normal" ? "uniform" : "normal" }),
      "[": () => stage.setBrush({ radius: Math.round(stage.brush.radius / 1.15) }),
      "]": () => stage.setBrush({ radius: Math.round(stage.brush.radius * 1.15) + 1 }),
      Home: () => stage.fit(),
      "+": () => this.zoom(1.25),
      "=": () => this.zoom(1.25),
      "-": () => this.zoom(0.8),
      Enter: () => stage.hand.click("left"),
      Escape: () => stage.letGo(),
      "?": () => help.showModal(),
      " ": () => stage.togglePlay(),
      ",": () => stage.step(-1),
      ".": () => stage.step(1),
    };
    addEventListener("keydown", (event) => this.down(event));
    addEventListener("keyup", (event) => this.shift(event.shiftKey));
  }

  /** @param {boolean} isDown */
  shift(isDown) {
    if (this.stage.shift !== isDown) {
      this.stage.shift = isDown;
      this.stage.hover();
    }
  }

  /** @param {KeyboardEvent} event */
  down(event) {
    this.shift(event.shiftKey);
    if (this.help.open) return;
    const { target } = event;
    const isOnStage = target === this.stage.canvas || target === document.body;
    const turned = (event.ctrlKey || event.metaKey) && event.key.toLowerCase();
    if (turned === "z" || turned === "y") {
      event.preventDefault();
      this.stage.underway.turn(turned === "y" || event.shiftKey ? "redo" : "undo");
      return;
    }
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (target instanceof HTMLSelectElement || isText(target)) return;
    if (target instanceof HTMLInputElement && event.key.length > 1) return;
    if (!isOnStage && (event.key === "Enter" || event.key === "Tab")) return;
    if (target instanceof HTMLButtonElement && event.key === " ") return;
    if (this.stage.moving && this.type(event)) return;
    if (isOnStage && event.key === "Tab" && !event.shiftKey) {
      event.preventDefault();
      this.stage.toggleMesh();
    } else if (isOnStage && event.key in ARROWS) {
      event.preventDefault();
      this.step(ARROWS[event.key], event.shiftKey ? 1 : STEP);
    } else {
      const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
      const action = this.keys[key];
      if (action) event.preventDefault();
      action?.();
    }
  }

  pin() {
    const { stage } = this;
    const picked = stage.picked();
    if (stage.tool === "pin" && picked) stage.hand.click("left");
    else stage.setTool("pin");
  }

  /** @param {number} factor */
  zoom(factor) {
    const { canvas, camera, pointer } = this.stage;
    const middle = { x: canvas.clientWidth / 2, y: canvas.clientHeight / 2 };
    camera.near(factor, pointer ? camera.toScreen(pointer) : middle);
    this.stage.hover();
  }

  /**
   * Move the cursor, and what is carried.
   * @param {[number, number]} way
   * @param {number} length [px of the screen]
   */
  step([dx, dy], length) {
    const { stage } = this;
    const { camera, canvas } = stage;
    const from = stage.pointer ?? camera.toPicture({ x: canvas.clientWidth / 2, y: canvas.clientHeight / 2 });
    const by = length / camera.zoom;
    stage.pointer = { x: from.x + dx * by, y: from.y + dy * by };
    stage.isByKeys = true;
    if (stage.moving) {
      const { to } = stage.moving;
      stage.moving.to = { x: to.x + dx * by, y: to.y + dy * by };
    }
    stage.hover();
  }

  /**
   * Numbers typed while a vertex is carried: how far it goes, as x and y.
   * @param {KeyboardEvent} event
   * @returns {boolean} whether the key was one of them
   */
  type(event) {
    const { stage } = this;
    if (event.key === "Enter") {
      stage.hand.drop();
      this.typed = "";
    } else if (event.key === "Escape") {
      stage.letGo();
      this.typed = "";
    } else if (event.key === "Backspace" || /^[-0-9., ]$/.test(event.key)) {
      this.typed = event.key === "Backspace" ? this.typed.slice(0, -1) : this.typed + event.key;
      const [x = 0, y = 0] = this.typed.split(/[, ]+/).map((text) => Number.parseFloat(text) || 0);
      if (stage.moving) stage.moving.to = { x: stage.moving.from.x + x, y: stage.moving.from.y + y };
      stage.told.say(`move by ${this.typed}`);
      stage.repaint();
    } else return false;
    event.preventDefault();
    return true;
  }
}

/** @param {EventTarget | null} target */
function isText(target) {
  return target instanceof HTMLInputElement && target.type !== "range";
}
