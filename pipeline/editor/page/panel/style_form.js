import { choice, help, slider } from "./rows.js";

/**
 * @typedef {{name: string, kind: string, default: any, help?: string, unit?: string, range?: [number, number],
 *   choices?: string[], form?: string}} Parameter
 * @typedef {{summary: string, parameters: Parameter[]}} Style
 */

/** Parameters that one looks for first stand first; these every style has. */
const SHARED = ["opacity", "blend"];

/**
 * Rows in which one sets all that a style takes, made from what the registry tells of it.
 * @param {Style} style
 * @param {Record<string, any>} values what was set already; what is set goes into it
 * @param {string} prefix of the names of the rows
 * @param {() => void} changed
 */
export function styleForm(style, values, prefix, changed) {
  const own = style.parameters.filter(({ name }) => !SHARED.includes(name));
  const shared = style.parameters.filter(({ name }) => SHARED.includes(name));
  return [help(style.summary), ...[...own, ...shared].map((one) => parameter(one, values, prefix, changed))];
}

/**
 * A style as the command line takes it.
 * @param {string} name
 * @param {Record<string, any>} values
 */
export function specOf(name, values) {
  const pairs = Object.entries(values).filter(([, value]) => value !== "");
  return pairs.length ? `${name}:${pairs.map(([key, value]) => `${key}=${value}`).join(",")}` : name;
}

/**
 * @param {Parameter} told
 * @param {Record<string, any>} values
 * @param {string} prefix
 * @param {() => void} changed
 */
function parameter(told, values, prefix, changed) {
  const value = values[told.name] ?? told.default ?? "";
  const title = `${told.help ?? ""}${told.unit ? ` [${told.unit}]` : ""}, usually ${told.default}`;
  const name = `${prefix}-${told.name}`;
  /** @param {any} next */
  const set = (next) => {
    values[told.name] = next;
    changed();
  };
  if (told.choices) return choice({ name, label: told.name, title, choices: told.choices, value, changed: set }).row;
  if (told.range && (told.kind === "float" || told.kind === "int")) {
    const [least, most] = told.range;
    const step = told.kind === "int" ? 1 : niceStep(most - least);
    return slider({ name, label: told.name, title, least, most, step, value, changed: set }).row;
  }
  return text(told.name, name, title, String(value), set);
}

/**
 * @param {string} called
 * @param {string} name
 * @param {string} title
 * @param {string} value
 * @param {(value: string) => void} changed
 */
function text(called, name, title, value, changed) {
  const row = document.createElement("div");
  row.className = "row";
  row.title = title;
  const label = document.createElement("label");
  label.htmlFor = `set-${name}`;
  label.textContent = called;
  const input = document.createElement("input");
  Object.assign(input, { id: `set-${name}`, type: "text", value });
  input.addEventListener("change", () => changed(input.value));
  row.append(label, input);
  if (/^#([0-9a-f]{3}){1,2}$/i.test(value)) {
    const color = document.createElement("input");
    const six = value.length === 4 ? value.replace(/[^#]/g, "$&$&") : value;
    Object.assign(color, { type: "color", value: six });
    color.setAttribute("aria-label", `${called}, as a colour`);
    color.addEventListener("input", () => {
      input.value = color.value;
      changed(color.value);
    });
    row.append(color);
  }
  return row;
}

/** @param {number} span */
function niceStep(span) {
  return 10 ** Math.floor(Math.log10(span / 100));
}
