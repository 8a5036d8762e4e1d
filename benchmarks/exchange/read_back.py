"""USD and glTF of a real clip: validators, and every frame read back to the bit of float32.

    python benchmarks/exchange/read_back.py [CLIP] [--frames A-B] [--triangles N]

Needs usd-core, and for glTF's validator Node with npm gltf-validator (found by NODE_PATH).
"""

import argparse
import json
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

import trimotion  # noqa: E402
from stages.exchange.solids.linear_light import linear_light  # noqa: E402
from tests.test_gltf import VALIDATOR, Glb  # noqa: E402
from tests.test_usd import Usd, seen_at  # noqa: E402

FILES = {
    "runs.usdc": {},
    "single.usdc": {"usd_single": True},
    "clip.glb": {},
    "relief.usdc": {"relief": 0.2},
    "relief.glb": {"relief": 0.2},
}
"""Names and options of the files."""
Seen = Callable[[trimotion.Triangulation, float], list[np.ndarray]]
"""Positions and colours of all corners that are seen in a frame, so many seconds from the first."""


def of_usd(path: Path) -> tuple[list[str], Seen]:
    """What validators say, and what is seen at a frame."""
    from pxr import UsdValidation

    stage = Usd.Stage.Open(str(path))
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    errors = UsdValidation.ValidationContext(validators).Validate(stage)
    said = [error.GetErrorAsString() for error in errors]
    return said, lambda frame, _: list(seen_at(stage, frame.frame)[0])


def of_gltf(path: Path) -> tuple[list[str], Seen]:
    """What the validator says, and what is seen at a frame."""
    command = ["node", "-e", VALIDATOR, str(path)]
    said = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)
    glb = Glb(path)

    def _seen(_: trimotion.Triangulation, time: float) -> list[np.ndarray]:
        (found,) = glb.seen_at(np.float32(time), knows_visibility=True)
        return [part.reshape(-1, 3, 3) for part in found]

    return said, _seen


def equal_frames(frames: list[trimotion.Triangulation], seen: Seen, is_flat: bool) -> int:
    """How many frames are what was solved, but for heights and the colours of gradients."""
    count = 0
    for frame in frames:
        corners = frame.vertices[frame.triangles][:, [0, 2, 1]]
        upwards = np.dstack([corners[..., 0], frame.size[1] - corners[..., 1]]).astype(np.float32)
        points, colors = seen(frame, float(frame.time - frames[0].time))
        light = np.repeat(linear_light(frame.colors)[:, None], 3, axis=1)
        is_equal = np.array_equal(points[..., :2], upwards)
        count += is_equal and (not is_flat or np.array_equal(colors, light))
    return count


def main() -> None:
    """Print a row for each style and file."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    clip = ROOT / "sample_videos" / "bigbuckbunny.mp4"
    parser.add_argument("clip", nargs="?", type=Path, default=clip)
    parser.add_argument("--frames", default="20-30")
    parser.add_argument("--triangles", type=int, default=1500)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as made:
        track = Path(made) / "clip.mtrk"
        trimotion.solve(given.clip, track, frames=given.frames, triangles=given.triangles)
        frames = list(trimotion.open_track(track))
        for style in ("flat", "gradient"):
            for name, options in FILES.items():
                path = Path(made) / name
                trimotion.render(track, path, styles=style, overwrite=True, **options)
                said, seen = of_gltf(path) if path.suffix == ".glb" else of_usd(path)
                equal = equal_frames(frames, seen, style == "flat")
                told = f"validators {said or 'find nothing'}, {equal} of {len(frames)} frames equal"
                print(f"{style} {name}: {told}", flush=True)


if __name__ == "__main__":
    main()
