"""Break timelines in many ways: each must be told in one line that names file and line.

Run it in the root of the repository: python benchmarks/broken_timelines.py [--count 300]
"""

import argparse
import random
import re
import string
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from pipeline.timeline.timeline import TEMPLATES

CLIP = Path("sample_videos/bigbuckbunny.mp4")
TOLD = re.compile(
    r"trimotion: error: \S+?:\d+(:\d+)?: .+(; |: write |: must lie |: choose |did you mean ).+"
)
"""How a mistake is told: file, line, what, and what to do."""
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


def main() -> None:
    """Try all of them through the command line, and print what is not told well."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=300)
    count = parser.parse_args().count
    templates = sorted(TEMPLATES.glob("*.toml"))
    streams = [mutants(path.read_text("utf-8"), seed) for seed, path in enumerate(templates)]
    refused = accepted = 0
    bad: list[str] = []
    with tempfile.TemporaryDirectory() as folder:
        show = Path(folder) / "show.toml"
        while refused < count:
            show.write_text(next(streams[(refused + accepted) % len(streams)]))
            run = subprocess.run(
                [sys.executable, "-m", "pipeline.cli", "timeline", str(show), "--check", str(CLIP)],
                capture_output=True,
                text=True,
            )
            lines = run.stderr.splitlines()
            if run.returncode == 0:
                accepted += 1  # the change means something
                continue
            refused += 1
            if run.returncode != 2 or len(lines) != 1 or not TOLD.fullmatch(lines[0]):
                bad.append(f"{run.returncode}: {run.stderr.strip()[-300:]}")
    print(f"{refused} broken timelines, {len(bad)} told badly ({accepted} changes were none)")
    print("\n".join(bad))
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
