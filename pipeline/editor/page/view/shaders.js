const SCREEN = `
  uniform vec3 camera; // where the picture begins [px], and its zoom
  uniform vec2 screen; // size [px]
  vec4 shown(vec2 pixels) {
    vec2 unit = pixels / screen * 2.0 - 1.0;
    return vec4(unit.x, -unit.y, 0.0, 1.0);
  }`;

/** The corner of a box of two triangles, 0 to 3: instances of a box each would be drawn one by one by
 * a browser without a card, in many times the time. */
const BOX = `
  int corner() {
    int number = gl_VertexID % 6;
    return number < 3 ? number : number == 3 ? 2 : number == 4 ? 1 : 3;
  }`;

/** A picture over its domain. */
export const PICTURE = {
  vertex: `#version 300 es
    ${SCREEN}
    uniform vec2 size;
    out vec2 place;
    void main() {
      place = vec2(gl_VertexID & 1, gl_VertexID >> 1);
      gl_Position = shown(place * size * camera.z + camera.xy);
    }`,
  fragment: `#version 300 es
    precision highp float;
    uniform sampler2D picture;
    uniform float opacity;
    in vec2 place;
    out vec4 color;
    void main() {
      color = texture(picture, place);
      color.a *= opacity;
    }`,
};

/** Lines of any width, a box an edge. */
export const LINES = {
  vertex: `#version 300 es
    ${SCREEN}
    ${BOX}
    uniform float width;
    in vec4 ends;
    in float held;
    out float across;
    out float isHeld;
    void main() {
      vec2 a = ends.xy * camera.z + camera.xy, b = ends.zw * camera.z + camera.xy;
      vec2 along = normalize(b - a + vec2(1e-6, 0.0)), normal = vec2(-along.y, along.x);
      float side = float(corner() & 1) * 2.0 - 1.0;
      float reach = width * (1.0 + 0.8 * held) * 0.5 + 1.0;
      across = side * reach;
      isHeld = held;
      gl_Position = shown(((corner() >> 1) == 0 ? a : b) + normal * across);
    }`,
  fragment: `#version 300 es
    precision highp float;
    uniform float width;
    uniform float opacity;
    in float across;
    in float isHeld;
    out vec4 color;
    void main() {
      float half_ = width * (1.0 + 0.8 * isHeld) * 0.5;
      float cover = clamp(half_ + 0.5 - abs(across), 0.0, 1.0);
      vec3 hue = mix(vec3(1.0), vec3(0.95, 0.71, 0.36), isHeld);
      color = vec4(hue, cover * opacity * mix(0.62, 1.0, isHeld));
    }`,
};

/** Discs, a box a vertex. */
export const DOTS = {
  vertex: `#version 300 es
    ${SCREEN}
    ${BOX}
    uniform float radius;
    in vec2 at;
    in float held;
    out vec2 away;
    out float isHeld;
    void main() {
      vec2 side = vec2(corner() & 1, corner() >> 1) * 2.0 - 1.0;
      away = side * (radius * (1.0 + 0.6 * held) + 1.5);
      isHeld = held;
      gl_Position = shown(at * camera.z + camera.xy + away);
    }`,
  fragment: `#version 300 es
    precision highp float;
    uniform float radius;
    uniform float opacity;
    in vec2 away;
    in float isHeld;
    out vec4 color;
    void main() {
      float size = radius * (1.0 + 0.6 * isHeld);
      float cover = clamp(size + 0.5 - length(away), 0.0, 1.0);
      float rim = clamp(size - 0.7 - length(away), 0.0, 1.0);
      vec3 hue = mix(vec3(0.94), vec3(0.95, 0.71, 0.36), isHeld);
      color = vec4(mix(vec3(0.08), hue, rim), cover * opacity);
    }`,
};

/** Triangles in the colours of their errors. */
export const ERRORS = {
  vertex: `#version 300 es
    ${SCREEN}
    in vec2 at;
    in float error;
    flat out float much;
    void main() {
      much = error;
      gl_Position = shown(at * camera.z + camera.xy);
    }`,
  fragment: `#version 300 es
    precision highp float;
    uniform float opacity;
    flat in float much;
    out vec4 color;
    void main() {
      vec3 hot = vec3(smoothstep(0.0, 0.5, much), smoothstep(0.3, 0.85, much), smoothstep(0.75, 1.0, much));
      color = vec4(hot + vec3(0.03, 0.02, 0.09) * (1.0 - much), opacity);
    }`,
};
