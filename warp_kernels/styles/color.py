"""Colours as people write them."""

import difflib
import re

from warp_kernels.errors import OptionError
from warp_kernels.styles.color_names import COLOR_NAMES

_FORM = re.compile(r"#?([0-9a-fA-F]{3}|[0-9a-fA-F]{6})")


def parse_color(text: str) -> tuple[float, float, float]:
    """Read `#rgb` or `#rrggbb`, with or without the `#`, or a name of CSS such as `white`.

    Returns:
        Red, green, blue [code values].

    Raises:
        OptionError: If the text has another form.
    """
    name = text.lower().replace(" ", "")
    match = _FORM.fullmatch(COLOR_NAMES.get(name, text))
    if match is None:
        similar = difflib.get_close_matches(name, COLOR_NAMES, n=1, cutoff=0.65)
        hint = f" ({similar[0]}?)" if similar else ""
        raise OptionError(
            f"colour {text!r}: write #rgb or #rrggbb, for example #222, or a name of CSS{hint}"
        )
    digits = match[1]
    if len(digits) == 3:
        digits = "".join(2 * digit for digit in digits)
    red, green, blue = (float(int(digits[i : i + 2], 16)) for i in (0, 2, 4))
    return red, green, blue
