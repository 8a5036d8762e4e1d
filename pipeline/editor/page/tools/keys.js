/** All keys and gestures, as the help shows them. */
export const HELP = [
  ["Mouse", [
    ["Left on an edge", "split it there"],
    ["Left in a triangle", "split it there"],
    ["Drag a vertex", "move it (Shift: precisely)"],
    ["Right on a vertex", "collapse it into its nearest neighbour"],
    ["Right on an edge", "flip it"],
    ["Shift + left", "turn a triangle's base edge"],
    ["Wheel", "zoom under the pointer; radius of the brush"],
    ["Middle, or Alt + drag", "pan; two fingers pan and zoom"],
  ]],
  ["Tools", [
    ["A", "edit"],
    ["B", "brush: left puts vertices, right takes them away"],
    ["[ and ]", "radius of the brush"],
    ["O", "soft falloff of the brush"],
    ["R", "region: drag around it, or click its corners"],
    ["T", "paint a style, a texture or focus onto triangles"],
    ["P", "pin and unpin what is under the pointer"],
  ]],
  ["On what is under the pointer", [
    ["V E F", "pick vertices, edges or faces only; again for all"],
    ["G", "move the vertex; type 5, -3 and Enter for an exact step"],
    ["X or Delete", "collapse the vertex"],
    ["J", "flip the edge"],
    ["Enter", "what a left click does"],
    ["Arrows", "move the cursor (Shift: one pixel)"],
  ]],
  ["Time", [
    ["Space", "play and pause"],
    [", and .", "one frame back and on"],
    ["L", "watch the optimiser, and pause it"],
    [";", "one step of the optimiser"],
    ["Ctrl + Enter", "let the edits reach through their shot"],
  ]],
  ["View and history", [
    ["Ctrl + Z", "undo"],
    ["Ctrl + Shift + Z", "redo"],
    ["Tab", "mesh on and off"],
    ["Home", "show all of the picture"],
    ["+ and -", "zoom"],
    ["Esc", "let go of what was begun"],
    ["?", "this help"],
  ]],
];

/**
 * Fill the help.
 * @param {HTMLDialogElement} dialog
 */
export function fillHelp(dialog) {
  const sections = HELP.map(([title, rows]) => {
    const lines = /** @type {string[][]} */ (rows).map(([keys, what]) => `<dt>${shown(keys)}</dt><dd>${what}</dd>`);
    return `<section><h2>${title}</h2><dl>${lines.join("")}</dl></section>`;
  });
  dialog.innerHTML = `<div class="columns">${sections.join("")}</div>
    <form method="dialog" class="buttons"><button class="main" autofocus>Close</button></form>`;
}

/** @param {string} keys */
function shown(keys) {
  if (keys === ", and .") return "<kbd>,</kbd> and <kbd>.</kbd>";
  return keys.split(/( \+ | and | or |, | )/).map((part) => (/^[^ ,]+$/.test(part) && !/^(and|or|on|an|in|a|drag|triangle|vertex|edge|Left|Right|Drag|Middle|Wheel)$/.test(part) ? `<kbd>${part}</kbd>` : part)).join("");
}
