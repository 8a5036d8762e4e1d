"""How Blender shows USD and glTF: imported and rendered as they are, beside what is drawn.

    python benchmarks/exchange/in_blender.py [--python PY] [--triangles N] [--keep FOLDER]

In the `blender` on the path, and with --python in the package bpy of that Python; some builds of
Blender, such as Debian's, have no USD.
"""

import argparse
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

import trimotion  # noqa: E402
from benchmarks.exchange.compared import row  # noqa: E402

SCENE = Path(__file__).with_name("blender_scene.py")
FIRST, FRAMES = 27, (27, 28, 30)
"""Of the clip, and those that are looked at."""
FILES = {
    "runs.usdc": {},
    "single.usdc": {"usd_single": True},
    "clip.glb": {},
}
"""Names and options of the files."""


def main() -> None:
    """Print a row for each program, file and frame."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--python", help="one that has bpy")
    parser.add_argument("--triangles", type=int, default=700)
    parser.add_argument("--keep", type=Path)
    given = parser.parse_args()
    programs = []
    if shutil.which("blender"):
        programs.append(["blender", "-b", "--factory-startup", "--python", str(SCENE), "--"])
    if given.python:
        programs.append([given.python, str(SCENE)])
    with tempfile.TemporaryDirectory() as made:
        folder = given.keep or Path(made)
        folder.mkdir(parents=True, exist_ok=True)
        track = folder / "clip.mtrk"
        clip = ROOT / "sample_videos" / "bigbuckbunny.mp4"
        frames = f"{FIRST}-{FRAMES[-1]}"
        trimotion.solve(clip, track, triangles=given.triangles, frames=frames, overwrite=True)
        for name, options in FILES.items():
            trimotion.render(track, folder / name, styles="flat", overwrite=True, **options)
        for frame in FRAMES:
            own = folder / f"own_{frame:04}.png"
            trimotion.render(track, own, styles="flat", frames=frame, overwrite=True)
        for number, program in enumerate(programs):
            for name in FILES:
                show(program, folder, name, number)


def show(program: list[str], folder: Path, name: str, number: int) -> None:
    """Render a file and print how near it comes."""
    shift = -FIRST if name.endswith(".glb") else 0
    pattern = folder / f"{Path(name).stem}_{number}_####.png"
    asked = [str(folder / name), str(pattern), str(shift), "1280x720", *map(str, FRAMES)]
    said = subprocess.run([*program, *asked], capture_output=True, text=True, timeout=900)
    told = [line for line in said.stdout.splitlines() if line.startswith("imported")]
    if not told:
        lines = [line for line in (said.stderr + said.stdout).splitlines() if "Error" in line]
        print(f"{Path(program[0]).name} {name}: {lines[-1].strip() if lines else 'no import'}")
        return
    print(f"{Path(program[0]).name} {name}: {told[0]}")
    for frame in FRAMES:
        found = pattern.with_name(pattern.name.replace("####", f"{frame:04}"))
        print(f"  frame {frame}: {row(found, folder / f'own_{frame:04}.png', 2)}", flush=True)


if __name__ == "__main__":
    main()
