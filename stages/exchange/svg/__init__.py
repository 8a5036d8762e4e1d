"""SVG: real shapes, layers and ids, in the units of the picture."""
