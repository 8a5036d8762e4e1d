import { PAINTS, REGIONS } from "../tools/marks.js";
import { choice, help, section, slider } from "./rows.js";
import { specOf, styleForm } from "./style_form.js";

/** @typedef {import("../stage.js").Stage} Stage */

/**
 * A choice of kinds that are called something.
 * @param {[string, string][]} kinds
 * @param {Omit<Parameters<typeof choice>[0], "choices">} told
 */
function called(kinds, told) {
  const made = choice({ ...told, choices: kinds.map(([kind]) => kind) });
  for (const option of made.row.querySelectorAll("option")) {
    option.textContent = kinds.find(([kind]) => kind === option.value)?.[1] ?? option.value;
  }
  return made;
}

/**
 * The brush, and what is painted and given to regions.
 * @param {Stage} stage
 * @param {import("./style.js").StylePanel} style knows the styles that can be painted
 * @param {import("./texture.js").TexturePanel} texture
 */
export function marksSection(stage, style, texture) {
  const { brush, marks } = stage;
  const radius = slider({ name: "radius", label: "Radius", title: "Of the brush, in pixels of the picture (wheel, [ and ])", least: 3, most: 400, step: 1, value: brush.radius, changed: (value) => stage.setBrush({ radius: value }) });
  const count = slider({ name: "count", label: "Vertices", title: "How many a touch puts or takes, and a region gets", least: 1, most: 60, step: 1, value: brush.count, changed: (value) => stage.setBrush({ count: value }) });
  const spread = choice({ name: "spread", label: "Falloff", title: "How they are spread (O)", choices: ["uniform", "normal"], value: brush.spread, changed: (value) => stage.setBrush({ spread: value }) });
  const paints = called(PAINTS, { name: "paints", label: "Paint (T)", title: "What the paint tool gives to triangles", value: marks.paints, changed: (value) => chosen(value, "paints", "paint") });
  const gives = called(REGIONS, { name: "region", label: "Region (R)", title: "What a region gets that is drawn with the region tool", value: marks.gives, changed: (value) => chosen(value, "gives", "region") });
  const names = choice({ name: "paint", label: "Style", title: "The style that is painted, or given to a region", choices: [], value: "", changed: dress });
  const form = document.createElement("div");
  form.className = "form";
  const focus = slider({ name: "focus", label: "Focus", title: "How much more errors count there: at 1 five times", least: 0.25, most: 4, step: 0.25, value: marks.focus, changed: (value) => (marks.focus = value) });

  /**
   * A style is chosen, as it usually is; what is set of it goes into the next region.
   * @param {string} name
   */
  function dress(name) {
    /** @type {Record<string, any>} */
    const values = {};
    marks.style = name;
    form.replaceChildren(...styleForm(style.styles[name], values, "paint", () => (marks.style = specOf(name, values))));
  }

  /**
   * What is chosen is what one wants to do next.
   * @param {string} value
   * @param {"paints" | "gives"} of
   * @param {string} tool
   */
  function chosen(value, of, tool) {
    marks[of] = value;
    stage.setTool(tool);
    if (value === "texture") texture.element.open = true;
  }

  stage.watch(() => {
    const select = /** @type {HTMLSelectElement} */ (names.row.querySelector("select"));
    if (select.options.length || !Object.keys(style.styles).length) return;
    for (const name of Object.keys(style.styles)) select.add(new Option(name, name));
    select.value = marks.style;
    dress(marks.style);
  });
  stage.watch(() => {
    radius.set(stage.brush.radius);
    count.set(stage.brush.count);
    spread.set(stage.brush.spread);
    const wanted = [marks.paints, marks.gives];
    names.row.hidden = !wanted.includes("style");
    form.hidden = { paint: marks.paints, region: marks.gives }[stage.tool] !== "style";
    focus.row.hidden = !wanted.includes("focus");
  });
  const made = section("Brush and region", radius.row, count.row, spread.row, help("Green dots show where vertices would come to be, before you click."), paints.row, gives.row, names.row, form, focus.row);
  let tool = stage.tool;
  stage.watch(() => {
    if (tool === stage.tool) return;
    tool = stage.tool;
    if (["brush", "region", "paint"].includes(tool)) made.scrollIntoView({ block: "nearest" });
  });
  return made;
}
