/** A program of shaders, which the browser compiles beside all else where it can. */
export class Program {
  /**
   * Begin to compile it; nothing waits for that.
   * @param {WebGL2RenderingContext} gl
   * @param {{vertex: string, fragment: string}} source
   * @param {string[]} values names of what is given for every corner
   */
  constructor(gl, source, values = []) {
    this.gl = gl;
    this.beside = gl.getExtension("KHR_parallel_shader_compile");
    this.program = gl.createProgram();
    this.shaders = [[gl.VERTEX_SHADER, source.vertex], [gl.FRAGMENT_SHADER, source.fragment]].map(([kind, text]) => {
      const shader = /** @type {WebGLShader} */ (gl.createShader(/** @type {number} */ (kind)));
      gl.shaderSource(shader, /** @type {string} */ (text));
      gl.compileShader(shader);
      gl.attachShader(this.program, shader);
      return shader;
    });
    /** @type {Record<string, number>} */
    this.places = {};
    for (const [place, name] of values.entries()) {
      this.places[name] = place; // told, for to ask would be to wait
      gl.bindAttribLocation(this.program, place, name);
    }
    gl.linkProgram(this.program);
    /** @type {Record<string, WebGLUniformLocation | null>} */
    this.known = {};
  }

  /** Whether to draw with it would not wait. */
  get isReady() {
    return !this.beside || this.gl.getProgramParameter(this.program, this.beside.COMPLETION_STATUS_KHR);
  }

  /** Complain if the browser does not take it. */
  check() {
    const { gl } = this;
    if (gl.isContextLost() || gl.getProgramParameter(this.program, gl.LINK_STATUS)) return;
    const told = [gl.getProgramInfoLog(this.program), ...this.shaders.map((one) => gl.getShaderInfoLog(one))];
    throw new Error(told.filter(Boolean).join(" "));
  }

  /**
   * Where a value lies that is the same for all corners.
   * @param {string} name
   */
  at(name) {
    if (!(name in this.known)) this.known[name] = this.gl.getUniformLocation(this.program, name);
    return this.known[name];
  }
}
