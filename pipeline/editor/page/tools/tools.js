/**
 * The tools of the rail.
 * @typedef {{name: string, key: string, label: string, hint: string, icon: string}} Tool
 * @type {Tool[]}
 */
export const TOOLS = [
  {
    name: "edit",
    key: "A",
    label: "Edit",
    hint: "Left: split what is under the pointer, drag a vertex. Right: collapse a vertex, flip an edge. Shift + left: turn the base edge.",
    icon: '<path d="M5 3l6 17 2.6-7.4L21 10z"/>',
  },
  {
    name: "brush",
    key: "B",
    label: "Brush",
    hint: "Left: put vertices under the brush. Right: take them away. Wheel or [ and ]: radius. Dots show where they would come to be.",
    icon: '<circle cx="12" cy="12" r="8.5"/><circle cx="9" cy="10" r=".9"/><circle cx="14.5" cy="9" r=".9"/><circle cx="11" cy="14.5" r=".9"/><circle cx="15.5" cy="14" r=".9"/>',
  },
  {
    name: "region",
    key: "R",
    label: "Region",
    hint: "Drag around a region, or click its corners and then the first one again. The panel says what it gets.",
    icon: '<path d="M4 14c-1-5 3-10 9-10s9 4 7 9-7 4-9 4-2 3-5 3"/>',
  },
  {
    name: "paint",
    key: "T",
    label: "Paint",
    hint: "Drag over triangles: they get a style, a texture or focus, as the panel says, through their whole shot. Wheel: radius.",
    icon: '<path d="M20 4c-5 2-9 6-11 9l2 2c3-2 7-6 9-11zM8 14c-3 0-2 4-5 5 4 2 7 0 7-3z"/>',
  },
  {
    name: "pin",
    key: "P",
    label: "Pin",
    hint: "Left: hold a vertex or an edge fast. Right: let it go.",
    icon: '<path d="M9 4h6l-1 6 3 3H7l3-3zM12 13v7"/>',
  },
];

/** What may be chosen for picking. */
export const MODES = /** @type {const} */ ([
  { name: "vertex", key: "V", label: "Vertices only", icon: '<circle cx="12" cy="12" r="3.2" fill="currentColor"/>' },
  { name: "edge", key: "E", label: "Edges only", icon: '<path d="M5 18 19 6"/>' },
  { name: "face", key: "F", label: "Faces only", icon: '<path d="M12 5 4 19h16z"/>' },
]);
