/** Rows of the panel: a label, what sets a value, the value. */

/**
 * A slider.
 * @param {{name: string, label: string, least: number, most: number, step: number, value: number, title?: string,
 *   shown?: (value: number) => string, changed: (value: number) => void}} told
 */
export function slider({ name, label, least, most, step, value, title = "", shown = String, changed }) {
  const row = document.createElement("div");
  row.className = "row";
  row.title = title;
  const id = `set-${name}`;
  const text = document.createElement("label");
  text.htmlFor = id;
  text.textContent = label;
  const input = document.createElement("input");
  Object.assign(input, { id, type: "range", min: String(least), max: String(most), step: String(step), value: String(value) });
  const output = document.createElement("output");
  output.htmlFor.add(id);
  output.textContent = shown(value);
  input.addEventListener("input", () => {
    output.textContent = shown(input.valueAsNumber);
    changed(input.valueAsNumber);
  });
  row.append(text, input, output);
  /** @param {number} next */
  const set = (next) => {
    if (input.value === String(next)) return;
    input.value = String(next);
    output.textContent = shown(input.valueAsNumber);
  };
  return { row, set };
}

/**
 * A choice of a few.
 * @param {{name: string, label: string, choices: string[], value: string, title?: string, changed: (value: string) => void}} told
 */
export function choice({ name, label, choices, value, title = "", changed }) {
  const row = document.createElement("div");
  row.className = "row";
  row.title = title;
  const id = `set-${name}`;
  const text = document.createElement("label");
  text.htmlFor = id;
  text.textContent = label;
  const select = document.createElement("select");
  select.id = id;
  for (const one of choices) select.add(new Option(one, one));
  select.value = value;
  select.addEventListener("change", () => changed(select.value));
  row.append(text, select);
  /** @param {string} next */
  const set = (next) => (select.value = next);
  return { row, set };
}

/**
 * A part of the panel.
 * @param {string} title
 * @param {...(Node | string)} content
 */
export function section(title, ...content) {
  const made = document.createElement("section");
  const heading = document.createElement("h2");
  heading.textContent = title;
  made.append(heading, ...content);
  return made;
}

/**
 * A line of help.
 * @param {string} text
 */
export function help(text) {
  const made = document.createElement("p");
  made.className = "help";
  made.textContent = text;
  return made;
}
