"""Presets of everything, damaged, and lists of cuts, edits and points likewise."""

import random
from collections.abc import Iterator
from pathlib import Path

from benchmarks.fuzz.mutate import broken_text
from pipeline.options.command_line import job_options

OTHERS = {
    "cuts": "[3, 9, 12]\n",
    "layout": "1.5,2\n10 20\n30;4\n7,8\n",
    "edits": '{"edit": "flip_edge", "frame": 0, "at": [13.5, 12.25]}\n',
    "beats": "0.5\n1.0\n1.5\n2.0\n",
    "palette": "#123\n#fa0\nwhite\n",
}
"""Texts that other options read, by option."""
FORMS = {"layout": "points:{}"}
"""How an option names its file, where the name does not stand alone."""


def preset() -> str:
    """A preset in which every option stands that has a default."""
    lines = []
    for option in job_options():
        default = option.default
        if option.flag in ("device", "track") or default is None:
            continue
        if option.is_switch:
            lines.append(f"{option.flag} = {str(not default).lower()}")
        elif option.is_repeatable:
            lines.append(f"{option.flag} = []")
        elif isinstance(default, int | float):
            lines.append(f"{option.flag} = {default}")
        else:
            lines.append(f'{option.flag} = "{default}"')
    return "\n".join(lines) + "\n"


def broken(folder: Path, seed: int) -> Iterator[tuple[str, ...]]:
    """Flags that name damaged texts, without end; each replaces the one before it.

    Args:
        folder: Where they are written.
        seed: Chooses the damage.
    """
    chance = random.Random(seed)
    texts = {"preset": preset(), **OTHERS}
    number = 0
    while True:
        flag = ("preset", "preset", *OTHERS)[number % (2 + len(OTHERS))]
        path = folder / f"broken.{'txt' if flag == 'palette' else flag}"
        path.write_text(broken_text(texts[flag], chance), "utf-8", "surrogatepass")
        yield f"--{flag}", FORMS.get(flag, "{}").format(path)
        number += 1
