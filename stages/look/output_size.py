"""Sizes of outputs as users write them: `1280x720`, `1080x`, `x1080`, `story`."""

import re

NAMED_SIZES = {
    "square": (1080, 1080),
    "portrait": (1080, 1350),
    "story": (1080, 1920),
    "720p": (1280, 720),
    "1080p": (1920, 1080),
    "1440p": (2560, 1440),
    "4k": (3840, 2160),
}
"""Sizes of the places that people post to [px]."""
FORM = f"WxH such as 1280x720, 1080x, x1080, or one of {', '.join(NAMED_SIZES)}"
"""How a size is written, for messages."""

_SIZE = re.compile(r"([1-9]\d{0,8})?[xX]([1-9]\d{0,8})?")


def parse_size(text: str) -> tuple[int, int]:
    """Read a size.

    Args:
        text: What the user wrote.

    Returns:
        Width and height [px]; 0 for the side that follows from the other one.

    Raises:
        ValueError: If the text has another form.
    """
    named = NAMED_SIZES.get(text.lower())
    if named is not None:
        return named
    match = _SIZE.fullmatch(text)
    if match is None or not (match[1] or match[2]):
        raise ValueError(text)
    return int(match[1] or 0), int(match[2] or 0)
