/** Frames a second where the source has no times. */
const USUAL = 25;
/** Frames that are asked for before the one before them is here. */
const AHEAD = 3;

/** Plays the film, as it is drawn, in its own time. */
export class Player {
  /** @param {import("../stage.js").Stage} stage */
  constructor(stage) {
    this.stage = stage;
    this.isOn = false;
  }

  async play() {
    const { stage } = this;
    if (stage.frames.length < 2 || this.isOn) return;
    this.isOn = true;
    if (stage.view === "live") stage.view = "edited";
    stage.changed();
    const rate = stage.rate ?? USUAL;
    const start = stage.frames.indexOf(stage.frame);
    const from = start + 1 < stage.frames.length ? start : 0;
    const begun = performance.now();
    let asked = stage.frame;
    let ahead = 0;
    while (this.isOn) {
      const due = from + Math.floor(((performance.now() - begun) * rate) / 1000);
      if (due >= stage.frames.length) break;
      const frame = stage.frames[due];
      if (frame !== asked && ahead < AHEAD) {
        asked = frame;
        ahead += 1;
        const parts = stage.opacities.mesh > 0 ? ["drawn", "mesh"] : ["drawn"];
        stage.connection
          .ask("look", { frame, view: stage.view, parts })
          .catch(() => (this.isOn = false))
          .finally(() => (ahead -= 1));
      }
      await new Promise((done) => requestAnimationFrame(done));
    }
    const isOver = this.isOn; // and nobody paused it
    this.isOn = false;
    await stage.seek(isOver ? stage.frames[stage.frames.length - 1] : stage.frame);
  }

  pause() {
    this.isOn = false;
  }
}
