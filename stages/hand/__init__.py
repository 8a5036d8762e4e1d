"""What a person does to a mesh by hand: `EDITS` names the kinds of edits for logs.

An edit is a frozen dataclass that begins with the number of its `frame` and has one method,
`apply(worked) -> Worked`, which is pure: the same edit makes the same mesh of the same mesh, to the
bit. Where it happens is said in positions of the picture, so an edit still means the same place
when the clip was solved anew. What cannot be made raises an `EditError` and changes nothing.
`stages.edits` has what the optimiser and these kinds are both made of.
"""

from typing import TYPE_CHECKING, Protocol

from warp_kernels.registry import Registry

if TYPE_CHECKING:
    from stages.hand.worked import Worked


class Edit(Protocol):
    """What every member of `EDITS` can do."""

    @property
    def frame(self) -> int:
        """Number of the frame that is edited."""
        ...

    def apply(self, worked: "Worked") -> "Worked":
        """Make the edit.

        Raises:
            EditError: If it cannot be made.
        """
        ...


EDITS: Registry[Edit] = Registry(
    "edits",
    {
        "split_edge": "stages.hand.split_edge:SplitEdge",
        "split_triangle": "stages.hand.split_triangle:SplitTriangle",
        "collapse_vertex": "stages.hand.collapse_vertex:CollapseVertex",
        "flip_edge": "stages.hand.flip_edge:FlipEdge",
        "turn_base_edge": "stages.hand.turn_base_edge:TurnBaseEdge",
        "move_vertex": "stages.hand.move_vertex:MoveVertex",
        "insert": "stages.hand.insert:Insert",
        "remove": "stages.hand.remove:Remove",
        "retriangulate": "stages.hand.retriangulate:Retriangulate",
        "lock": "stages.hand.lock:Lock",
        "unlock": "stages.hand.unlock:Unlock",
        "set_focus": "stages.hand.regions.set_focus:SetFocus",
        "style_region": "stages.hand.regions.style_region:StyleRegion",
        "texture_region": "stages.hand.regions.texture_region:TextureRegion",
    },
)

DRAWN = frozenset({"style_region", "texture_region"})
"""Kinds that say how triangles are drawn, and change none."""
