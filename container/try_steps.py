"""Run the steps of the Dockerfile in a folder, where no engine for containers is at hand.

    python container/try_steps.py FOLDER CLIP

ENV, COPY and RUN are done as they stand, with FOLDER in place of the root; then one frame of a clip
is converted three times where everything can only be read but for a tmpfs, as with `docker run
--read-only --tmpfs /tmp`. Needs Linux and to be root, for mounts that only this sees.
"""

import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]


def steps() -> Iterator[tuple[str, str]]:
    """Instructions of the Dockerfile, with their arguments."""
    text = (ROOT / "Dockerfile").read_text().replace("\\\n", " ")
    for line in text.splitlines():
        if line and not line.startswith("#"):
            name, _, rest = line.partition(" ")
            yield name, rest.strip()


def moved(text: str, folder: Path) -> str:
    """A text in which `/opt` lies in the folder."""
    return text.replace("/opt/", f"{folder}/opt/")


def build(folder: Path) -> dict[str, str]:
    """Do the steps; what the environment is in the end."""
    environment = {"PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}", "HOME": "/none"}
    for name, rest in steps():
        begun = time.perf_counter()
        if name == "ENV":
            for key, value in re.findall(r"(\w+)=(\S+)", rest):
                environment[key] = moved(value, folder).replace("$PATH", environment["PATH"])
        elif name == "COPY":
            files = subprocess.run(
                ["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True
            ).stdout.split("\0")[:-1]
            target = Path(moved(rest.split()[-1], folder))
            for file in files:
                (target / file).parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(ROOT / file, target / file)
        elif name == "RUN":
            subprocess.run(["sh", "-c", moved(rest, folder)], env=environment, check=True)
        print(f"{name} {rest[:60]}: {time.perf_counter() - begun:.1f} s", flush=True)
    return environment


def first_frame(environment: dict[str, str], folder: Path, clip: Path) -> None:
    """Convert one frame where nothing else can be written."""
    place = folder / "tmp"
    place.mkdir(exist_ok=True)
    shut = 'mount -o remount,ro,bind / && mount -t tmpfs tmpfs "$0" && exec "$@"'
    convert = ["trimotion", "animate", clip, "-o", place / "one.png", "--frames", "0"]
    for again in range(3):
        begun, used = time.perf_counter(), os.times()
        subprocess.run(
            ["unshare", "-m", "sh", "-c", shut, place, *convert],
            env={**environment, "TMPDIR": str(place)},
            check=True,
        )
        now = os.times()
        cpu = sum(now[2:4]) - sum(used[2:4])
        wall = time.perf_counter() - begun
        print(f"first frame, run {again + 1}: {wall:.2f} s, CPU {cpu:.2f} s", flush=True)


def main() -> int:
    """Build, then convert."""
    folder, clip = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    first_frame(build(folder), folder, clip)
    return 0


if __name__ == "__main__":
    sys.exit(main())
