"""What a user may have meant by a name that there is not."""

import difflib
from collections.abc import Iterable

NOTHING = frozenset({"off", "no", "false", "0", "nothing"})
"""Words for which the families of members say `none`."""


def nearest(word: str, known: Iterable[str], offer: str = "choose from") -> str:
    """The remedy for a wrong name.

    Args:
        word: What was written.
        known: The names that there are.
        offer: What to do with them.

    Returns:
        All of them, after a question if one of them is similar.
    """
    names = list(known)
    similar = difflib.get_close_matches(word.lower(), names, n=1, cutoff=0.65)
    if word.lower() in NOTHING and "none" in names:
        similar = ["none"]
    choice = f"{offer} {', '.join(names)}"
    return f"did you mean {similar[0]}? Else {choice}" if similar else choice
