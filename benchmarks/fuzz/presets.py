"""Presets of everything, damaged, and lists of cuts, edits and points likewise."""

import random
from collections.abc import Iterator
from pathlib import Path

from benchmarks.fuzz.mutate import broken_text
from pipeline.options.command_line import job_options

OTHERS = (
    ("cuts", "cuts.json", "[3, 9, 12]\n"),
    ("layout", "points.csv", "1.5,2\n10 20\n30;4\n7,8\n"),
    ("layout", "points.json", "[[1.5, 2], [10, 20], [7, 8]]\n"),
    ("edits", "log.jsonl", '{"edit": "flip_edge", "frame": 0, "at": [13.5, 12.25]}\n'),
    ("beats", "beats.txt", "0.5\n1.0\n1.5\n2.0\n"),
    ("beats", "beats.json", '{"beats": [0.5, 1.0], "downbeats": [0.5], "meter": 2, "bpm": 120}\n'),
    ("palette", "swatches.txt", "#123\n#fa0\nwhite\n"),
    ("palette", "swatches.json", '["#123", {"name": "x", "hex": "#fa0"}, [1, 2, 3]]\n'),
    ("palette", "swatches.gpl", "GIMP Palette\nName: x\n#\n1 2 3 one\n200 100 0 two\n"),
)
"""Option, name and text of what other options read."""
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
    texts = (*[("preset", "preset.toml", preset())] * 4, *OTHERS)
    number = 0
    while True:
        flag, name, text = texts[number % len(texts)]
        path = folder / f"broken-{name}"
        path.write_text(broken_text(text, chance), "utf-8", "surrogatepass")
        yield f"--{flag}", FORMS.get(flag, "{}").format(path)
        number += 1
