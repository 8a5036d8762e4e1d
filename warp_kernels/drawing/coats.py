"""What a kernel that draws a stack of styles depends on."""

from dataclasses import replace

from warp_kernels.drawing.blend import Coat
from warp_kernels.styles import Style


def coats_of(
    styles: tuple[Style, ...],
    masked: tuple[Style, ...],
    followed: tuple[int, ...] = (),
    moves: bool = False,
) -> tuple[Coat, ...]:
    """The coats of a stack; over an opaque style it does not matter whether one is opaque.

    Args:
        styles: Bottom to top.
        masked: Those over them that are drawn inside of masks.
        followed: Numbers of those among these that are drawn on triangles of a region instead.
        moves: Whether triangles may be drawn elsewhere than they lie: they leave holes then, and
            only what stays can be opaque.
    """
    coats = [
        Coat(s.shader, s.blend, s.is_opaque and (s.stays or not moves), s.covers) for s in styles
    ]
    for number in range(1, len(coats)):
        if any(coat.is_opaque for coat in coats[:number]):
            coats[number] = replace(coats[number], is_opaque=False)
    for number, s in enumerate(masked):
        is_followed = number in followed
        coats.append(Coat(s.shader, s.blend, False, s.covers, not is_followed, is_followed))
    if not moves:
        return tuple(coats)
    stay = [style.stays for style in (*styles, *masked)]
    return tuple(replace(coat, moves=not s) for coat, s in zip(coats, stay, strict=True))
