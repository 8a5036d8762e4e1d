"""Draw a region in a style of its own."""

from dataclasses import dataclass

from stages.hand.regions.on_region import OnRegion


@dataclass(frozen=True, kw_only=True)
class StyleRegion(OnRegion):
    """A style over all others, where the triangles are that lie in a region in its frame.

    They keep it through their shot, as those of `--region MASK@FRAME` do.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 7: artists wished for
        styles of regions.
    """

    style: str
    """As `--style` takes it, such as hatching:spacing=3."""
