"""Which stacks one canvas draws."""

from typing import Any

from warp_kernels.drawing.coats import coats_of
from warp_kernels.styles import Style


def kind_of_stack(
    styles: tuple[Style, ...],
    masked: tuple[Style, ...],
    followed: tuple[int, ...] = (),
    moves: bool = False,
) -> Any:
    """What a canvas is made for: it draws all stacks of one kind, see `Canvas.restyle`.

    Args:
        styles: As for the canvas.
        masked: The same.
        followed: The same.
        moves: The same.

    Returns:
        Something to compare.
    """
    built = tuple(
        (type(style), *(getattr(style, name) for name in style.built_from))
        for style in (*styles, *masked)
    )
    return coats_of(styles, masked, followed, moves), moves, built
