"""What of a log is drawn: styles and textures of regions, over all that a look has."""

import reprlib
from collections.abc import Collection
from dataclasses import dataclass, replace

from pipeline.options.edit_log import EditLog, left_out
from pipeline.options.look import Look
from pipeline.options.members import parse_member
from stages.hand import Edit
from stages.hand.regions.style_region import StyleRegion
from stages.hand.regions.texture_region import TextureRegion
from stages.masks.gray import read_gray
from stages.masks.region import Region
from stages.media.embedded import HEAD, is_embedded
from warp_kernels.errors import MediaError, OptionError
from warp_kernels.styles import STYLES, Style
from warp_kernels.styles.texture import Texture

LONGEST = 300
"""Letters of a style or of a file's name."""


@dataclass(frozen=True)
class PaintedRegions:
    """Regions that edits gave a style."""

    regions: tuple[Region, ...] = ()
    """The regions, bottom to top."""
    refused: tuple[str, ...] = ()
    """What cannot be drawn, one sentence for each edit."""

    def over(self, look: Look) -> Look:
        """A look with these regions over its own.

        Args:
            look: The look.
        """
        new = tuple(region for region in self.regions if region not in look.regions)
        return replace(look, regions=look.regions + new) if new else look


def painted_regions(log: EditLog | None, frames: Collection[int] | None = None) -> PaintedRegions:
    """What of a log is drawn.

    Strokes of one frame in one style that follow each other become one region.

    Args:
        log: The edits, or None.
        frames: Numbers of the frames that there are; edits of others are passed over. None for all.
    """
    regions: list[Region] = []
    refused: list[str] = []
    for number, edit in enumerate(() if log is None else log.edits, start=1):
        if not isinstance(edit, StyleRegion | TextureRegion):
            continue
        if frames is not None and edit.frame not in frames:
            continue
        try:
            style = _style_of(edit)
        except (OptionError, MediaError) as error:
            refused.append(left_out(number, edit, error))
            continue
        last = regions[-1] if regions else None
        if last is not None and last.style == style and last.frames == (edit.frame,):
            regions[-1] = replace(last, areas=(*last.areas, edit.area))
        else:
            regions.append(Region(f"edit {number}", style, (edit.frame,), (edit.area,)))
    return PaintedRegions(tuple(regions), tuple(refused))


def check_style(edit: Edit) -> None:
    """Refuse an edit that gives a region a style that there is not.

    Args:
        edit: An edit of any kind.

    Raises:
        OptionError: If there is none such.
        MediaError: If a picture cannot be read.
    """
    if isinstance(edit, StyleRegion | TextureRegion):
        _style_of(edit)


def _style_of(edit: StyleRegion | TextureRegion) -> Style:
    """The style of a region, once its pictures are known to be there.

    Raises:
        OptionError: If there is none such.
        MediaError: If a picture cannot be read.
    """
    named = edit.style if isinstance(edit, StyleRegion) else edit.file
    is_style = isinstance(edit, StyleRegion)
    if not is_style and named.lower().startswith("data:") and not is_embedded(named):
        raise OptionError(f"{reprlib.repr(named)} holds no picture; one begins with {HEAD}")
    if (is_style or not is_embedded(named)) and (not named.isprintable() or len(named) > LONGEST):
        wanted = "what --style takes" if is_style else "a file"
        raise OptionError(f"{reprlib.repr(named)} names nothing; give {wanted}")
    style: Style
    if isinstance(edit, StyleRegion):
        style = parse_member("style", edit.style, STYLES)
    else:
        style = Texture(file=edit.file, strength=edit.strength, opacity=edit.opacity)
    style.texture(read_gray)
    return style
