"""Break timelines in many ways: each must be told in one line that names file and line.

Those that come with the program and one in which every key and every curve stands. Run it in the
root of the repository: python benchmarks/broken_timelines.py [--count 300] [--seed 0]
"""

import argparse
import contextlib
import io
import random
import re
import string
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from pipeline.cli import main as run
from pipeline.options.look import Look
from pipeline.options.members import parameters
from pipeline.timeline.targets import Kind, Target, kind_of_target, slots_of
from pipeline.timeline.timeline import TEMPLATES
from stages.moves import MOVES
from warp_kernels.styles import STYLES

CLIP = Path("sample_videos/bigbuckbunny.mp4")
TOLD = re.compile(
    r"trimotion: error: \S+?:\d+(:\d+)?: .+(; |: write |: must lie |: choose |did you mean ).+"
)
"""How a mistake is told: file, line, what, and what to do."""
PYTHON = re.compile(r"<class |<[\w.]+ object|np\.|array\(|KeyError|Errno|Traceback|internal error")
"""What no message to a user holds."""
WORDS = (
    "wobble",
    "12",
    "-1",
    "1e999",
    "nan",
    "bar 0",
    "4 bars",
    "#12",
    "''",
    "99999s",
    "t.x",
    "1/0",
)
"""What is put where something else stood."""


def mutants(text: str, seed: int) -> Iterator[str]:
    """Texts with one mistake each, without end.

    Args:
        text: A timeline that is right.
        seed: Chooses the mistakes.
    """
    chance = random.Random(seed)
    while True:
        lines = text.splitlines()
        places = [k for k, line in enumerate(lines) if line and not line.startswith("#")]
        place = chance.choice(places)
        lines[place] = chance.choice(MISTAKES)(lines[place], chance)
        broken = "\n".join(lines) + "\n"
        if broken != text:
            yield broken


def _misspelt(line: str, chance: random.Random) -> str:
    """A word with two letters exchanged."""
    words = list(re.finditer(r"[a-z]{4,}", line))
    if not words:
        return line
    word = chance.choice(words)
    at = word.start() + chance.randrange(len(word[0]) - 1)
    return line[:at] + line[at + 1] + line[at] + line[at + 2 :]


def _dropped(line: str, chance: random.Random) -> str:
    at = chance.randrange(len(line))
    return line[:at] + line[at + 1 :]


def _added(line: str, chance: random.Random) -> str:
    at = chance.randrange(len(line) + 1)
    return line[:at] + chance.choice(string.punctuation + string.ascii_letters) + line[at:]


def _cut(line: str, chance: random.Random) -> str:
    return line[: chance.randrange(len(line))]


def _replaced(line: str, chance: random.Random) -> str:
    """A value or a part of it is another one."""
    parts = list(re.finditer(r"[\w.#%+]+(?: (?:bars?|beats?))?", line))
    part = chance.choice(parts) if parts else None
    return (
        line if part is None else line[: part.start()] + chance.choice(WORDS) + line[part.end() :]
    )


MISTAKES = (_misspelt, _dropped, _added, _cut, _replaced)


def everything() -> str:
    """A timeline in which every key stands, and a curve of every target that takes one."""
    styles = [name for name in STYLES.own if name != "texture"]
    moves = list(MOVES.own)
    look = Look(
        styles=tuple(STYLES[name]() for name in styles), moves=tuple(MOVES[n]() for n in moves)
    )
    curves = {"opacity": "smooth(t)", "background": "start: #000, end: white"}
    curves |= {"triangles": "start: 40, 50%: 200 ease-in, end: 90", "error": "12 + 3*sin(t)"}
    for name in (*styles, *moves):
        for target, kind in _targets(name, look):
            curves[str(target)] = _curve(kind)
    lines = [
        'title = "Everything"',
        "bpm = 121.5",
        "meter = 3",
        "[[section]]",
        'name = "first"',
        'to = "1s"',
        "[[section]]",
        'from = "bar at 50%"',
        'transition = "wipe left 1 beat, 10% at most"',
        f"style = [{', '.join(map(repr, styles))}]",
        f"move = [{', '.join(map(repr, moves))}]",
        'palette = "#123,#fa0,white:mode=nearest,amount=0.5"',
        'grade = "exposure=0.5,saturation=0.8"',
        'background = "#224"',
        "triangles = 60",
        "[section.curves]",
        '"edges.width" = "0s: 1, +1 beat: 3 ease-out, +500ms: 2"',
        '"grade.hue" = "90*env(beat, decay=0.4s) + 10*noise(1, 2s)"',
        '"palette.amount" = "clamp(t/4, 0, 1)"',
        "[curves]",
        *(f'"{name}" = "{value}"' for name, value in curves.items()),
    ]
    return "\n".join(lines) + "\n"


def _targets(name: str, look: Look) -> Iterator[tuple[Target, Kind]]:
    """What curves may change of a member of a look."""
    slot = next(slot for slot in slots_of(look) if slot.name == name)
    for field in parameters(type(slot.member)):
        target = Target(name, 0, field.name)
        with contextlib.suppress(ValueError):  # what is built, and changes by sections alone
            kind = kind_of_target(target, look)
            if kind is not None:
                yield target, kind


def _curve(kind: Kind) -> str:
    """A curve of a target: an expression, or keys where values cannot run."""
    if kind.is_number and not kind.is_fixed:
        least, most = max(kind.least, -1e3), min(kind.most, 1e3)
        return f"{least + 0.4 * (most - least):g} + {0.1 * (most - least):g}*sin(t)"
    if kind.is_color:
        return "start: #222, 2s: red ease-in, end: #fff"
    if kind.is_number:
        ends = (min(max(value, kind.least), kind.most) for value in (1.0, 2.0))
        return "start: {:g} step, 3s: {:g}".format(*ends)
    values = kind.choices or (("true", "false") if kind.name == "bool" else ("one", "two"))
    return f"start: {values[0]} step, 3s: {values[-1]}"


def told_of(text: str, folder: Path) -> tuple[int, str]:
    """Exit code and words of the command line about a timeline.

    Args:
        text: The timeline.
        folder: Where it may be written.
    """
    show = folder / "show.toml"
    show.write_text(text, "utf-8")
    words = io.StringIO()
    with contextlib.redirect_stderr(words), contextlib.redirect_stdout(io.StringIO()):
        code = run(["timeline", str(show), "--check", str(CLIP)])
    return code, words.getvalue()


def main() -> None:
    """Try all of them through the command line, and print what is not told well."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=0)
    given = parser.parse_args()
    texts = [path.read_text("utf-8") for path in sorted(TEMPLATES.glob("*.toml"))]
    texts += [everything()] * len(texts)
    streams = [mutants(text, given.seed + number) for number, text in enumerate(texts)]
    refused = accepted = 0
    bad: list[str] = []
    with tempfile.TemporaryDirectory() as name:
        whole = told_of(everything(), Path(name))
        bad += [] if whole[0] == 0 else [f"everything: {whole[1]}"]
        while refused < given.count:
            text = next(streams[(refused + accepted) % len(streams)])
            code, words = told_of(text, Path(name))
            if code == 0 and not words:
                accepted += 1  # the change means something
                continue
            refused += 1
            lines = words.splitlines()
            if code != 2 or len(lines) != 1 or not TOLD.fullmatch(lines[0]) or PYTHON.search(words):
                bad.append(f"{code}: {words.strip()[-300:]}")
    print(f"{refused} broken timelines, {len(bad)} told badly ({accepted} changes were none)")
    print("\n".join(bad))
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
