import { Program } from "./program.js";
import { DOTS, ERRORS, LINES, PICTURE } from "./shaders.js";

/**
 * @typedef {import("../mesh/mesh.js").Mesh} Mesh
 * @typedef {{picture: number, drawn: number, errors: number, painted: number, mesh: number}} Opacities
 */

/** Root of the energy of a pixel that is shown brightest [code values]. */
const MOST_ERROR = 60;
/** Corners of the two triangles of a box. */
const BOX = 6;

/** Draws the layers of the stage with WebGL. */
export class Painter {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { alpha: true, antialias: false, premultipliedAlpha: false });
    if (!gl) throw new Error("this browser has no WebGL 2; try a newer one, or another machine");
    this.canvas = canvas;
    this.gl = gl;
    this.pictures = new Program(gl, PICTURE);
    this.lines = new Program(gl, LINES, ["ends", "held"]);
    this.dots = new Program(gl, DOTS, ["at", "held"]);
    this.errors = new Program(gl, ERRORS, ["at", "error"]);
    this.isChecked = false;
    /** @type {Record<string, WebGLTexture>} */
    this.textures = {};
    this.isOpaque = false;
    this.news = 0; // how often something was taken in
    this.painted = "";
    this.edges = 0;
    this.vertices = 0;
    this.lineArray = gl.createVertexArray();
    this.dotArray = gl.createVertexArray();
    this.errorArray = gl.createVertexArray();
    this.corners = 0;
    this.empty = gl.createVertexArray();
    this.buffers = { ends: gl.createBuffer(), held: gl.createBuffer(), at: gl.createBuffer(), heldAt: gl.createBuffer(), cornerAt: gl.createBuffer(), error: gl.createBuffer() };
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  /** Whether all is there that it draws with; else a browser without a card would wait, up to a second. */
  get isReady() {
    const programs = [this.pictures, this.lines, this.dots, this.errors];
    if (!this.isChecked && programs.every((one) => one.isReady)) {
      this.isChecked = true;
      for (const one of programs) one.check();
    }
    return this.isChecked;
  }

  /**
   * Take in a picture.
   * @param {"picture" | "drawn"} name
   * @param {import("../net/packed.js").Packed} packed
   */
  setPicture(name, { head, arrays }) {
    const { gl } = this;
    this.news += 1;
    if (name === "drawn") this.isOpaque = head.channels === 3;
    this.fit(head.channels === 4 ? gl.RGBA : gl.RGB, name, (format) => {
      gl.texImage2D(gl.TEXTURE_2D, 0, format, head.columns, head.rows, 0, format, gl.UNSIGNED_BYTE, arrays.pixels);
    });
  }

  /** @param {HTMLCanvasElement | null} sheet what lies over the pictures; null for nothing */
  setSheet(sheet) {
    const { gl } = this;
    this.news += 1;
    if (!sheet) gl.deleteTexture(this.textures.painted ?? null);
    if (!sheet) delete this.textures.painted;
    else this.fit(gl.RGBA, "painted", (format) => gl.texImage2D(gl.TEXTURE_2D, 0, format, format, gl.UNSIGNED_BYTE, sheet));
  }

  /**
   * Fill a texture.
   * @param {number} format
   * @param {string} name
   * @param {(format: number) => void} filled
   */
  fit(format, name, filled) {
    const { gl } = this;
    const texture = (this.textures[name] ??= /** @type {WebGLTexture} */ (gl.createTexture()));
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    filled(format);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
  }

  /** @param {Mesh} mesh */
  setMesh(mesh) {
    this.news += 1;
    const ends = new Float32Array(4 * mesh.edgeCount);
    for (let e = 0; e < mesh.edgeCount; e++) {
      const [a, b] = mesh.ends(e);
      ends.set([mesh.vertices[2 * a], mesh.vertices[2 * a + 1], mesh.vertices[2 * b], mesh.vertices[2 * b + 1]], 4 * e);
    }
    this.edges = mesh.edgeCount;
    this.vertices = mesh.vertexCount;
    const heldEdges = Float32Array.from(mesh.heldEdges.subarray(0, mesh.edgeCount));
    this.fill(this.lineArray, this.lines, { ends: [4, boxed(ends, 4)], held: [1, boxed(heldEdges, 1)] }, this.buffers);
    const at = { at: this.buffers.at, held: this.buffers.heldAt };
    const positions = Float32Array.from(mesh.vertices);
    this.setErrors(mesh);
    const held = Float32Array.from(mesh.held);
    this.fill(this.dotArray, this.dots, { at: [2, boxed(positions, 2)], held: [1, boxed(held, 1)] }, at);
  }

  /** @param {Mesh} mesh */
  setErrors(mesh) {
    this.corners = mesh.triangles.length;
    const at = new Float32Array(2 * this.corners);
    const error = new Float32Array(this.corners);
    for (let corner = 0; corner < this.corners; corner++) {
      at.set(mesh.vertices.subarray(2 * mesh.triangles[corner], 2 * mesh.triangles[corner] + 2), 2 * corner);
      error[corner] = Math.min(1, Math.sqrt(Math.max(0, mesh.energies[Math.floor(corner / 3)])) / MOST_ERROR);
    }
    const buffers = { at: this.buffers.cornerAt, error: this.buffers.error };
    this.fill(this.errorArray, this.errors, { at: [2, at], error: [1, error] }, buffers);
  }

  /**
   * @param {WebGLVertexArrayObject | null} array
   * @param {Program} used
   * @param {Record<string, [number, Float32Array]>} values
   * @param {Record<string, WebGLBuffer | null>} buffers
   */
  fill(array, used, values, buffers) {
    const { gl } = this;
    gl.bindVertexArray(array);
    for (const [name, [size, data]] of Object.entries(values)) {
      const place = used.places[name];
      gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name]);
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, 0, 0);
    }
    gl.bindVertexArray(null);
  }

  /**
   * Draw everything, unless it is on the screen already.
   * @param {import("./camera.js").Camera} camera
   * @param {{width: number, height: number}} size of the picture
   * @param {Opacities} opacities
   */
  paint(camera, size, opacities) {
    const { gl, canvas } = this;
    const scale = devicePixelRatio || 1;
    const [across, down] = [Math.round(canvas.clientWidth * scale), Math.round(canvas.clientHeight * scale)];
    const lies = `${camera.x} ${camera.y} ${camera.zoom} ${across} ${down}`;
    const painted = `${this.news} ${lies} ${Object.values(opacities)}`;
    if (painted === this.painted) return;
    this.painted = painted;
    if (canvas.width !== across || canvas.height !== down) [canvas.width, canvas.height] = [across, down];
    gl.viewport(0, 0, across, down);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    const view = [camera.x * scale, camera.y * scale, camera.zoom * scale];
    for (const name of /** @type {const} */ (["picture", "drawn"])) {
      const isHidden = name === "picture" && this.isOpaque && opacities.drawn === 1;
      if (this.textures[name] && opacities[name] > 0 && !isHidden) this.paintPicture(name, view, size, opacities[name]);
    }
    if (opacities.errors > 0 && this.corners) this.paintErrors(view, opacities.errors);
    if (this.textures.painted && opacities.painted > 0) this.paintPicture("painted", view, size, opacities.painted);
    if (opacities.mesh > 0 && this.edges) this.paintMesh(view, scale, camera.zoom, opacities.mesh);
  }

  /**
   * @param {string} name
   * @param {number[]} view
   * @param {{width: number, height: number}} size
   * @param {number} opacity
   */
  paintPicture(name, view, size, opacity) {
    const { gl, pictures } = this;
    this.use(pictures, view, opacity);
    gl.uniform2f(pictures.at("size"), size.width, size.height);
    gl.bindTexture(gl.TEXTURE_2D, this.textures[name]);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, view[2] > 4 ? gl.NEAREST : gl.LINEAR);
    gl.bindVertexArray(this.empty);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }

  /**
   * @param {number[]} view
   * @param {number} opacity
   */
  paintErrors(view, opacity) {
    const { gl } = this;
    this.use(this.errors, view, opacity);
    gl.bindVertexArray(this.errorArray);
    gl.drawArrays(gl.TRIANGLES, 0, this.corners);
  }

  /**
   * @param {number[]} view
   * @param {number} scale
   * @param {number} zoom
   * @param {number} opacity
   */
  paintMesh(view, scale, zoom, opacity) {
    const { gl, lines, dots } = this;
    this.use(lines, view, opacity);
    gl.uniform1f(lines.at("width"), scale * Math.min(1.6, 0.8 + 0.2 * zoom));
    gl.bindVertexArray(this.lineArray);
    gl.drawArrays(gl.TRIANGLES, 0, BOX * this.edges);
    this.use(dots, view, opacity);
    gl.uniform1f(dots.at("radius"), scale * Math.min(3.2, 1.1 + 0.7 * zoom));
    gl.bindVertexArray(this.dotArray);
    gl.drawArrays(gl.TRIANGLES, 0, BOX * this.vertices);
  }

  /**
   * @param {Program} used
   * @param {number[]} view
   * @param {number} opacity
   */
  use(used, view, opacity) {
    const { gl } = this;
    gl.useProgram(used.program);
    gl.uniform3f(used.at("camera"), view[0], view[1], view[2]);
    gl.uniform2f(used.at("screen"), gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.uniform1f(used.at("opacity"), opacity);
  }
}

/**
 * Values of boxes as values of their corners.
 * @param {Float32Array} values
 * @param {number} size numbers of a value
 */
function boxed(values, size) {
  const made = new Float32Array(BOX * values.length);
  for (let i = 0; i < values.length; i += size) {
    for (let k = 0; k < BOX; k++) for (let j = 0; j < size; j++) made[BOX * i + k * size + j] = values[i + j];
  }
  return made;
}
