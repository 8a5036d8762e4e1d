"""One array as triangles."""

from dataclasses import replace
from typing import Any, Unpack

from pipeline.library.arrays import options_of_arrays, solved_arrays, told
from pipeline.library.device import opened_device
from pipeline.library.keywords import PictureKeywords
from pipeline.library.pixels import frame_of, info_of, weights_of
from pipeline.library.signature import with_keywords
from pipeline.library.triangulation import Triangulation
from pipeline.library.wording import worded
from pipeline.loop.convert import triangulator_of


@with_keywords("triangulate")
@worded()
def triangulate(pixels: Any, **options: Unpack[PictureKeywords]) -> Triangulation:
    """Triangulate one picture.

    Args:
        pixels: Code values, [H, W, 3] uint8 in RGB, or [H, W] uint8 in grey, or anything that
            NumPy makes such an array of.
        options: See below; `weights` may be an array, too, [H, W] uint8.

    Raises:
        OptionError: If the array is of another kind, or an option has an impossible value.
        MediaError: If a file that an option names cannot be read.
    """
    frame = frame_of(pixels, 0)
    size = (frame.width, frame.height)
    named: Any = dict(options)
    if hasattr(named.get("weights"), "__array__"):
        frame = replace(frame, weights=weights_of(named["weights"], size))
        del named["weights"]
        named.setdefault("focus", "none")
    wanted, run = options_of_arrays("triangulate", named)
    with opened_device(run.device, run.threads) as device:
        triangulator = triangulator_of(wanted, size, device, wanted.model)
        (solved,) = solved_arrays(iter([frame]), wanted, triangulator, info_of(size, "image"))
        return told(solved, frame, wanted, run)
