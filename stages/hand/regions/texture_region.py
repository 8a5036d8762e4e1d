"""Put a texture into the triangles of a region."""

from dataclasses import dataclass

from stages.hand.regions.on_region import OnRegion


@dataclass(frozen=True, kw_only=True)
class TextureRegion(OnRegion):
    """A texture in the triangles that lie in a region in its frame; they keep it.

    Source: Lawonn & Guenther, Stylized Image Triangulation (2018), Sec. 5 and 7: textures follow
        the base edges of triangles.
    """

    file: str
    """A picture whose lower edge is the base edge, or cushion, or triangle. A picture is a file,
    or a text that holds it and goes wherever the edit goes, see `stages.media.embedded`."""
    strength: float = 1.0
    """Contrast of the picture, 0 to 4."""
    opacity: float = 1.0
    """How much of what lies below it changes, 0 to 1."""
