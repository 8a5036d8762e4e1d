import { FilmPanel } from "../time/film.js";
import { StylePanel } from "./style.js";
import { OptimiserPanel } from "./optimiser.js";
import { marksSection } from "./marks.js";
import { section, slider } from "./rows.js";
import { TexturePanel } from "./texture.js";

/** @typedef {import("../stage.js").Stage} Stage */

/** @param {number} value */
const percent = (value) => `${Math.round(100 * value)} %`;

/**
 * Opacities of the layers.
 * @param {Stage} stage
 */
function viewSection(stage) {
  /** @type {["picture" | "drawn" | "errors" | "painted" | "mesh", string, string][]} */
  const layers = [
    ["picture", "Picture", "The frame of the source"],
    ["drawn", "Style", "The frame as the film will show it"],
    ["errors", "Errors", "Where triangles differ from the picture: dark little, bright much"],
    ["painted", "Focus", "Where focus is painted in this frame: blue"],
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
  const texture = new TexturePanel(stage, style);
  const brush = marksSection(stage, style, texture);
  const optimiser = new OptimiserPanel(stage);
  panel.append(film.element, viewSection(stage), style.element, brush, texture.element, optimiser.element, commandSection(stage));
  return { film, style, optimiser };
}
