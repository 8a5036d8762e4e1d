"""What becomes of the colours of triangles before they are drawn: grades and palettes."""
