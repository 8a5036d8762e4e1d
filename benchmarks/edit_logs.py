"""Long random logs of edits by hand: valid after each, undone and replayed to the bit.

    python -m benchmarks.edit_logs [EDITS] [SEEDS]

Prints for each seed how many edits were made and refused, and what one takes.
"""

import sys
from collections.abc import Callable
from time import perf_counter

import numpy as np

from pipeline.edit_log.json_lines import as_json_lines, from_json_lines
from pipeline.options.edit_log import EditLog
from stages.hand import EDITS, Edit
from stages.hand.worked import Worked
from stages.layouts.importance import Importance
from stages.mesh import Mesh
from stages.validate import assert_valid

SIZE = (640, 360)
TRIANGLES = 1500


def random_edit(rng: np.random.Generator) -> Edit:
    """One edit of any kind, now and then one that cannot be made."""
    name = list(EDITS)[rng.integers(len(EDITS))]

    def point() -> tuple[float, float]:
        x, y = rng.uniform(-10, 10 + np.array(SIZE))
        return float(x), float(y)

    at = point()
    polygon = tuple((at[0] + float(x), at[1] + float(y)) for x, y in rng.uniform(-60, 60, (4, 2)))
    few = {"count": int(rng.integers(1, 30)), "seed": int(rng.integers(99))}
    round_brush = {"at": at, "radius": float(rng.uniform(5, 60)), **few}
    others: dict[str, Callable[[], dict[str, object]]] = {
        "move_vertex": lambda: {"at": at, "to": (at[0] + 4.0, at[1] - 3.0)},
        "insert": lambda: round_brush,
        "remove": lambda: round_brush,
        "retriangulate": lambda: {"polygon": polygon, **few},
        "lock": lambda: {"polygon": polygon},
        "unlock": lambda: {"polygon": polygon, "what": "edges"},
    }
    edit: Edit = EDITS[name](0, **others.get(name, lambda: {"at": at})())  # type: ignore[call-arg]
    return edit


def same(one: Mesh, other: Mesh) -> bool:
    """Whether two meshes are equal to the bit."""
    names = ("vertices", "triangles", "vertex_ids", "triangle_ids")
    return all(np.array_equal(getattr(one, n), getattr(other, n)) for n in names)


def first_mesh(seed: int) -> Mesh:
    """A layout over noise."""
    rng = np.random.default_rng(seed)
    pixels = rng.integers(0, 255, (SIZE[1], SIZE[0], 3)).astype(np.uint8)
    return Importance().build(pixels, TRIANGLES, rng)


def run(seed: int, count: int) -> None:
    """Make one log and check it."""
    rng = np.random.default_rng([1, seed])
    worked = Worked(first_mesh(seed))
    made: list[Edit] = []
    refused = 0
    seconds = 0.0
    while len(made) < count:
        edit = random_edit(rng)
        begun = perf_counter()
        result = EditLog((edit,)).replay(0, worked)
        seconds += perf_counter() - begun
        refused += len(result.refused)
        if result.refused:
            continue
        worked = result.worked
        made.append(edit)
        assert_valid(worked.mesh)
    log = from_json_lines(as_json_lines(EditLog(tuple(made))), "log")
    undone = EditLog(()).replay(0, Worked(first_mesh(seed))).worked
    replayed = log.replay(0, Worked(first_mesh(seed))).worked
    print(
        f"seed {seed}: {count} edits made, {refused} refused, {1e3 * seconds / count:.1f} ms each; "
        f"{worked.mesh.triangle_count} triangles, {len(worked.locks.vertices)} held vertices; "
        f"undone to the bit: {same(undone.mesh, first_mesh(seed))}, "
        f"replayed to the bit: {same(replayed.mesh, worked.mesh)}"
    )


def main() -> None:
    """Run all."""
    given = list(map(int, sys.argv[1:]))
    count, seeds = (*given, *(2000, 3)[len(given) :])
    for seed in range(seeds):
        run(seed, count)


if __name__ == "__main__":
    main()
