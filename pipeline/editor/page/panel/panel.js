import { FilmPanel } from "../time/film.js";
import { StylePanel } from "./style.js";
import { OptimiserPanel } from "./optimiser.js";
import { choice, help, section, slider } from "./rows.js";

/** @typedef {import("../stage.js").Stage} Stage */

/** @param {number} value */
const percent = (value) => `${Math.round(100 * value)} %`;

/**
 * Opacities of the layers.
 * @param {Stage} stage
 */
function viewSection(stage) {
  /** @type {["picture" | "drawn" | "errors" | "mesh", string, string][]} */
  const layers = [
    ["picture", "Picture", "The frame of the source"],
    ["drawn", "Style", "The frame as the film will show it"],
    ["errors", "Errors", "Where triangles differ from the picture: dark little, bright much"],
    ["mesh", "Mesh", "Edges and vertices; what is pinned is yellow (Tab)"],
  ];
  const rows = layers.map(([name, label, title]) => {
    const changed = (/** @type {number} */ value) => stage.setOpacity(name, value);
    const made = slider({ name, label, title, least: 0, most: 1, step: 0.01, value: stage.opacities[name], shown: percent, changed });
    stage.watch(() => made.set(stage.opacities[name]));
    return made.row;
  });
  return section("Layers", ...rows);
}

/**
 * The brush.
 * @param {Stage} stage
 * @param {StylePanel} style knows the styles that can be painted
 */
function brushSection(stage, style) {
  const { brush } = stage;
  const radius = slider({ name: "radius", label: "Radius", title: "Of the brush, in pixels of the picture (wheel, [ and ])", least: 3, most: 400, step: 1, value: brush.radius, changed: (value) => stage.setBrush({ radius: value }) });
  const count = slider({ name: "count", label: "Vertices", title: "How many a touch puts or takes", least: 1, most: 60, step: 1, value: brush.count, changed: (value) => stage.setBrush({ count: value }) });
  const spread = choice({ name: "spread", label: "Falloff", title: "How they are spread (O)", choices: ["uniform", "normal"], value: brush.spread, changed: (value) => stage.setBrush({ spread: value }) });
  const paint = choice({ name: "paint", label: "Paints", title: "The style that the paint tool (T) gives to triangles", choices: [], value: "", changed: (value) => (stage.paintStyle = value) });
  stage.watch(() => {
    const select = /** @type {HTMLSelectElement} */ (paint.row.querySelector("select"));
    if (select.options.length || !Object.keys(style.styles).length) return;
    for (const name of Object.keys(style.styles)) select.add(new Option(name, name));
    select.value = stage.paintStyle;
  });
  stage.watch(() => {
    radius.set(stage.brush.radius);
    count.set(stage.brush.count);
    spread.set(stage.brush.spread);
  });
  return section("Brush and region", radius.row, count.row, spread.row, paint.row, help("Green dots show where vertices would come to be, before you click."));
}

/**
 * What to type to make the same without the editor.
 * @param {Stage} stage
 */
function commandSection(stage) {
  const solve = document.createElement("pre");
  const render = document.createElement("pre");
  solve.id = "command-solve";
  render.id = "command-render";
  stage.watchCommands((lines) => ([solve.textContent, render.textContent] = lines));
  return section("The same without the editor", solve, render);
}

/**
 * Fill the panel.
 * @param {HTMLElement} panel
 * @param {Stage} stage
 */
export function fillPanel(panel, stage) {
  const film = new FilmPanel(stage);
  const style = new StylePanel(stage);
  const brush = brushSection(stage, style);
  const optimiser = new OptimiserPanel(stage);
  panel.append(film.element, viewSection(stage), style.element, brush, optimiser.element, commandSection(stage));
  return { film, style, optimiser };
}
