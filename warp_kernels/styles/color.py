"""Colours as people write them."""

import re

from warp_kernels.errors import OptionError

_FORM = re.compile(r"#?([0-9a-fA-F]{3}|[0-9a-fA-F]{6})")


def parse_color(text: str) -> tuple[float, float, float]:
    """Read `#rgb` or `#rrggbb`, with or without the `#`.

    Returns:
        Red, green, blue [code values].

    Raises:
        OptionError: If the text has another form.
    """
    match = _FORM.fullmatch(text)
    if match is None:
        raise OptionError(f"colour {text!r}: write #rgb or #rrggbb, for example #222")
    digits = match[1]
    if len(digits) == 3:
        digits = "".join(2 * digit for digit in digits)
    red, green, blue = (float(int(digits[i : i + 2], 16)) for i in (0, 2, 4))
    return red, green, blue
