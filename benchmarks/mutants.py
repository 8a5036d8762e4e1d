"""Faults planted one by one in a copy of the program: which of them do the tests find?

A mutant is a piece of the source replaced by another, and the tests that should fail then. What
lives is a promise that no test keeps. Run with names to try these alone:

    python -m benchmarks.mutants [NAME ...]

A piece that is not found any more is told: the source has moved on, and the mutant must follow.
"""

import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

ROOT = Path(__file__).parents[1]
PATIENCE = 600
"""Seconds after which a mutant has made something endless: it is found as well."""
LEFT_OUT = (".git", ".venv", "out", "docs", ".mypy_cache", ".ruff_cache", "__pycache__")


@dataclass(frozen=True)
class Mutant:
    """One planted fault."""

    name: str
    """What goes wrong."""
    path: str
    """The file."""
    old: str
    """What stands there, once."""
    new: str
    """What is put in its place."""
    tests: str
    """The tests that should find it, as arguments of pytest."""


BAD = "tests/test_bad_tracks.py"
ROWS = "pipeline/track/reader.py"
MUTANTS = (
    Mutant(
        "same picture is solved again",
        "pipeline/loop/motion.py",
        "        passage.is_still\n        and is_steady",
        "        False\n        and is_steady",
        "tests/test_track.py -k same_picture",
    ),
    Mutant(
        "same picture keeps its mesh whatever its weights",
        "pipeline/loop/motion.py",
        "        and not options.maps\n",
        "",
        "tests/test_track.py -k same_picture",
    ),
    Mutant(
        "same picture keeps its mesh whatever a timeline says",
        "pipeline/loop/motion.py",
        "        and is_steady\n",
        "",
        "tests/test_timeline_drawn.py tests/test_timeline.py",
    ),
    Mutant(
        "a frame's own numbers lose what a space asks for",
        "stages/triangulate.py",
        "self._options = _against(options, self._space.scale)",
        "self._options = options",
        "tests/test_spaces.py",
    ),
    Mutant(
        "last iterations look a pixel far",
        "stages/solve/approximate.py",
        "LAST_DISPLACEMENT = 0.25",
        "LAST_DISPLACEMENT = 1.0",
        "tests/test_triangulate.py -k between_pixels",
    ),
    Mutant(
        "processes at work outlive the first",
        "pipeline/loop/processes.py",
        "        _watch(self._parent)\n",
        "",
        "tests/test_resume.py -k end_with_the_first",
    ),
    Mutant(
        "idle processes outlive the first",
        "pipeline/loop/processes.py",
        "        except Empty:\n            _watch(parent)",
        "        except Empty:\n            pass",
        "tests/test_resume.py -k end_with_the_first",
    ),
    Mutant(
        "blobs unpack to any size",
        "pipeline/track/packing/plain.py",
        "machine.decompress(blob, size + 1)",
        "machine.decompress(blob)",
        "tests/test_track.py -k no_larger",
    ),
    Mutant(
        "arrays of a header unpack to any size",
        "pipeline/track/plain_values.py",
        "decompress(base64.b64decode(data), size + 1)",
        "decompress(base64.b64decode(data))",
        f"{BAD} -k no_larger",
    ),
    Mutant(
        "ids in any order",
        "stages/validate.py",
        "not (ids[1:] > ids[:-1]).all()",
        "False",
        BAD,
    ),
    Mutant(
        "triangles turned inside out",
        "stages/validate.py",
        "if not mesh.areas.min() > 0:",
        "if False:",
        BAD,
    ),
    Mutant(
        "another picture's mesh",
        "stages/validate.py",
        "<= READ_TOLERANCE * domain",
        "<= domain",
        f"{BAD} -k another_picture",
    ),
    Mutant("colours of no number", "stages/validate.py", "colors.max() < LARGEST", "True", BAD),
    Mutant("counts below zero", "stages/validate.py", "snapshot.counts.min() < 0", "False", BAD),
    Mutant("times in any order", ROWS, "row.pts <= before.pts", "False", BAD),
    Mutant(
        "shots in any order",
        ROWS,
        "row.shot != before.shot and row.shot <= before.frame",
        "False",
        BAD,
    ),
    Mutant("frames may be missing", ROWS, "if row.frame != expected:", "if False:", BAD),
    Mutant(
        "tables of strangers",
        "pipeline/track/schema.py",
        "    if found:\n        raise TrackError(",
        "    if False:\n        raise TrackError(",
        BAD,
    ),
    Mutant(
        "options of strangers",
        "pipeline/track/plain_values.py",
        "if name not in fields and name != CLASS and name not in GONE:",
        "if False:",
        BAD,
    ),
    Mutant(
        "commands to the terminal",
        "pipeline/printable.py",
        'one if one.isprintable() or one == "\\n" else _spelled(one)',
        "one",
        "tests/test_track.py -k terminal",
    ),
    Mutant(
        "another source goes on with a track",
        "pipeline/track/resume.py",
        "    header.source.check(options.source)\n",
        "",
        "tests/test_track.py -k other_source",
    ),
    Mutant(
        "tracks with a gap are joined",
        "pipeline/track/join.py",
        "if first != last + step:",
        "if False:",
        "tests/test_track.py -k do_not_fit",
    ),
    Mutant(
        "shots share a stored topology",
        "pipeline/track/writer.py",
        "brings = shot != self._shot or not",
        "brings = not",
        "tests/test_track.py -k brings_its_topology",
    ),
    Mutant(
        "threads outlive a closed device",
        "warp_kernels/device/device.py",
        "            self._team.dismiss()\n        self._team.join()\n",
        "",
        "tests/test_device.py -k threads_end",
    ),
    Mutant(
        "threads outlive a dropped device",
        "warp_kernels/device/device.py",
        "        weakref.finalize(self, team.dismiss).atexit = False\n",
        "",
        "tests/test_device.py -k threads_end",
    ),
    Mutant(
        "Warp stays silent for others",
        "warp_kernels/device/runtime.py",
        "    finally:\n        wp.config.log_level = level",
        "    finally:\n        pass",
        "tests/test_device.py -k nothing_of_the_process",
    ),
    Mutant(
        "errors stay lost",
        "warp_kernels/device/runtime.py",
        "        os.dup2(kept, ERRORS)\n",
        "",
        "tests/test_device.py -k nothing_of_the_process",
    ),
    Mutant(
        "a kernel may fuse",
        "warp_kernels/energy/fit.py",
        "module_options=EXACT",
        'module_options={"enable_backward": False}',
        "tests/test_exact.py",
    ),
    Mutant(
        "a copy without the lock",
        "warp_kernels/device/device.py",
        "        with WARP:\n            return self._staging.read(wanted)\n",
        "        if True:\n            return self._staging.read(wanted)\n",
        "tests/test_architecture.py -k lock",
    ),
    Mutant(
        "ranges without their first frame",
        "stages/media/frame_range.py",
        "index >= self.first\n",
        "index > self.first\n",
        "tests/test_frame_range.py",
    ),
    Mutant(
        "border vertices leave the border",
        "stages/motion/advect.py",
        "np.where(fixed, 0.0, goals - mesh.vertices)",
        "goals - mesh.vertices",
        "tests/test_advect.py",
    ),
    Mutant(
        "one idle round ends an optimisation",
        "stages/solve/convergence.py",
        "PATIENCE = 3",
        "PATIENCE = 1",
        "tests/test_triangulate.py -k idle_round",
    ),
    Mutant(
        "lives are counted one frame short",
        "pipeline/compare/lifetimes.py",
        "np.ones(len(ids), dtype=np.int64)\n            return",
        "np.zeros(len(ids), dtype=np.int64)\n            return",
        "tests/test_track_metrics.py",
    ),
    Mutant(
        "an edge that a vertex splits is exchanged",
        "stages/metrics/mesh_changes.py",
        "np.count_nonzero(split == 0)",
        "len(split)",
        "tests/test_track_metrics.py",
    ),
    Mutant(
        "smoothing forgets the later frames",
        "pipeline/look/smooth.py",
        "((before - own) + (after - own))",
        "(2.0 * (before - own))",
        "tests/test_smooth.py",
    ),
    Mutant(
        "standing still has no advantage",
        "stages/flows/patch_matching.py",
        "handicap[:2] = 0.0",
        "handicap[:1] = 0.0",
        "tests/test_vote.py",
    ),
    Mutant(
        "equal weights are not none",
        "warp_kernels/moments/pixel_weights.py",
        "    values //= np.gcd.reduce(values[counts > 0])\n",
        "",
        "tests/test_weights.py tests/test_moments.py",
    ),
    Mutant(
        "a failure of drawing is lost",
        "pipeline/loop/threads.py",
        "        if error is None and self._error is not None:\n            raise self._error",
        "",
        "tests/test_stream.py",
    ),
    Mutant(
        "illegal edges stay",
        "stages/edits/legalise.py",
        "turn.imag < -ANGLE_TOLERANCE",
        "turn.imag > ANGLE_TOLERANCE",
        "tests/test_legalise.py",
    ),
    Mutant(
        "slivers by area stay",
        "stages/topology/collapse_slivers.py",
        "(mesh.heights < min_height) | (mesh.areas < min_area)",
        "(mesh.heights < min_height)",
        "tests/test_collapse.py tests/test_topology.py",
    ),
    Mutant(
        "new triangles join every region",
        "stages/motion/inherit_regions.py",
        "found[born] = votes > 0.0",
        "found[born] = True",
        "tests/test_following.py",
    ),
    Mutant(
        "the smallest mesh of a quality is not kept",
        "stages/solve/quality.py",
        "elif best is None or trial.mesh.triangle_count < best.mesh.triangle_count:",
        "else:",
        "tests/test_quality.py tests/test_triangulate.py -k quality",
    ),
)


def main(names: list[str]) -> int:
    """Try mutants and print a line for each, and the score.

    Args:
        names: Which; all if there are none.

    Returns:
        0 if all of them were found.
    """
    chosen = [mutant for mutant in MUTANTS if not names or mutant.name in names]
    found = 0
    with TemporaryDirectory(prefix="mutants-") as folder:
        tree = Path(folder) / "tree"
        shutil.copytree(ROOT, tree, ignore=shutil.ignore_patterns(*LEFT_OUT))
        for mutant in chosen:
            begun = perf_counter()
            verdict = tried(mutant, tree)
            found += verdict == "found"
            print(f"{verdict:<8} {perf_counter() - begun:6.1f} s  {mutant.name}", flush=True)
    print(f"{found} of {len(chosen)} found")
    return int(found < len(chosen))


def tried(mutant: Mutant, tree: Path) -> str:
    """What the tests say of a mutant: found, lives, or gone if its source has moved on."""
    path = tree / mutant.path
    source = path.read_text(encoding="utf-8")
    if source.count(mutant.old) != 1:
        return "gone"
    path.write_text(source.replace(mutant.old, mutant.new), encoding="utf-8")
    try:
        return "found" if fails(mutant.tests, tree) else "lives"
    finally:
        path.write_text(source, encoding="utf-8")


def fails(tests: str, tree: Path) -> bool:
    """Whether one of some tests fails in a tree."""
    command = f'"{sys.executable}" -B -m pytest -x -q -p no:cacheprovider {tests}'
    try:
        ended = subprocess.run(
            command, shell=True, cwd=tree, capture_output=True, timeout=PATIENCE, check=False
        )
    except subprocess.TimeoutExpired:
        return True
    if ended.returncode not in (0, 1):
        raise SystemExit(f"{tests}: pytest ends with {ended.returncode}: {ended.stdout!r}")
    return ended.returncode == 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
