"""Pure edits Mesh -> Mesh, each over a whole set of triangles or edges at once.

Untouched triangles keep their rows and ids. One that an edit changes goes on, under its id, as
what shares most area with it: textures and regions are tied to ids. What there is more of gets the
next fresh ids. Edits of one set must not touch each other: `independent_flips` and
`independent_collapses` choose such sets.
An edit refuses (ValueError) what would leave an invalid mesh.
"""

from stages.edits.base_edge import turn_base_edge
from stages.edits.collapse_edges import collapse_edges, collapsible
from stages.edits.flip_edges import flip_edges, flippable
from stages.edits.independent import independent_collapses, independent_flips
from stages.edits.legalise import legalise
from stages.edits.press import press_onto_border, pressable
from stages.edits.split import split_edges, split_triangles

__all__ = [
    "collapse_edges",
    "collapsible",
    "flip_edges",
    "flippable",
    "independent_collapses",
    "independent_flips",
    "legalise",
    "press_onto_border",
    "pressable",
    "split_edges",
    "split_triangles",
    "turn_base_edge",
]
