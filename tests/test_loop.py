"""Loops: the last frame leads into the first one, whoever solves and draws it."""

from pathlib import Path

import cv2
import numpy as np
import pytest

import trimotion
from pipeline.loop.animate import solve
from pipeline.options.seam import Seam
from pipeline.progress import Progress
from stages.motion.morph import morphed
from tests import media_samples as samples
from tests.jobs import job_of
from tests.meshes import random_mesh
from tests.snapshots import edited, snapshot_with
from tests.tracks import QUICK, InTurn, rows_of, write_clip

OPTIONS = {"iterations": 8, "frame_iterations": 4, "triangles": 40, "focus": "none"}
COUNT = 10


def write_round(path: Path) -> Path:
    """A clip that leads into itself: a slope goes round, and a square with it; 96 x 64."""
    x = np.arange(96)
    rows = 110 + 90 * np.sin(2 * np.pi * x / 96)
    pictures = []
    for number in range(COUNT):
        turned = np.roll(rows, round(96 * number / COUNT))
        picture = np.repeat(np.repeat(turned[None, :, None], 64, axis=0), 3, axis=2)
        picture[20:44, 30:50] = 250 - 20 * abs(number - COUNT // 2)
        pictures.append(picture.astype(np.uint8))
    return samples.write_video(path, pictures)


def drawn(folder: Path, name: str) -> dict[int, np.ndarray]:
    """Stills by the numbers in their names."""
    found = sorted(folder.glob(f"{name}_??.png"))
    return {int(path.stem[-2:]): cv2.imread(str(path)) for path in found}


@pytest.mark.parametrize("is_own", [True, False])
def test_a_seam_leads_over(is_own: bool) -> None:
    """Every frame is blended with one that is solved, the more the nearer it is to the seam."""
    seam = Seam(3, 10, 29, is_own)
    partners = {frame: seam.partner_of(frame) for frame in range(10, 30)}
    blended = {frame: found for frame, found in partners.items() if found is not None}
    assert list(blended) == ([10, 11, 12] if is_own else [27, 28, 29])
    assert [other for other, _ in blended.values()] == ([30, 31, 32] if is_own else [7, 8, 9])
    shares = [share for _, share in blended.values()]
    assert shares == sorted(shares, reverse=is_own)
    assert seam.solved == ((10, 32) if is_own else (7, 29))
    assert seam.picture_of(31) == (11 if is_own else 31)


def test_a_morph_goes_where_the_other_mesh_is() -> None:
    rng = np.random.default_rng(3)
    mesh = random_mesh(3)
    other = mesh
    for _ in range(4):
        other = edited(other, rng)
    inner = ~(other.on_left_right | other.on_top_bottom)
    other = other.moved(other.vertices + 0.05 * inner[:, None])
    snapshot = snapshot_with(mesh, np.zeros((mesh.triangle_count, 3)))
    assert morphed(snapshot, other, 0.0) is snapshot
    there = morphed(snapshot, other, 1.0).mesh
    assert there.areas.min() > 0
    kept = np.isin(mesh.vertex_ids, other.vertex_ids)
    goals = other.vertices[np.searchsorted(other.vertex_ids, mesh.vertex_ids[kept])]
    assert np.median(np.abs(there.vertices[kept] - goals)) < 1e-9
    half = morphed(snapshot, other, 0.5).mesh
    assert np.median(np.abs(half.vertices[kept] - (mesh.vertices[kept] + goals) / 2)) < 1e-9


def test_a_film_that_leads_into_itself(tmp_path: Path) -> None:
    """It keeps its length; meshes are the same however it is solved, ranges those of the whole."""
    clip = write_round(tmp_path / "clip.mp4")
    track, look = tmp_path / "a.mtrk", {"palette": "riso:nearest"}  # which is held from the start
    result = trimotion.animate(clip, tmp_path / "a_##.png", loop=3, track=track, **look, **OPTIONS)
    assert "lead into themselves" in " ".join(result.notes)
    whole = drawn(tmp_path, "a")
    assert list(whole) == list(range(COUNT))
    steps = [rms(whole[k], whole[k + 1]) for k in range(COUNT - 1)]
    assert rms(whole[COUNT - 1], whole[0]) < 1.2 * np.median(steps)
    trimotion.render(track, tmp_path / "b_##.png", frames="1-4", **look)
    part = drawn(tmp_path, "b")
    assert all(np.array_equal(pixels, whole[index]) for index, pixels in part.items())
    for last in (4, 11):  # interrupted before the end, and behind it
        cut_off(track, tmp_path / "d.mtrk", last)
        trimotion.solve(clip, tmp_path / "d.mtrk", loop=3, resume=True, **OPTIONS)
        assert rows_of(tmp_path / "d.mtrk") == rows_of(track)


def test_shots_of_a_loop_are_solved_apart(tmp_path: Path) -> None:
    """What follows the end is part of the last one."""
    clip = write_round(tmp_path / "clip.mp4")
    (tmp_path / "cuts.txt").write_text("5\n")
    rows = []
    for name, runner in (("one", None), ("two", InTurn())):
        given = {"loop": 3, "triangulate": QUICK, "cuts": str(tmp_path / "cuts.txt")}
        job = job_of(clip, track=tmp_path / f"{name}.mtrk", **given)
        solve(job.solve, job.output, job.run, Progress(), runner=runner)
        rows.append(rows_of(tmp_path / f"{name}.mtrk"))
    assert rows[0] == rows[1]
    assert len(next(iter(rows[0].values()))) == COUNT + 3


def test_a_film_that_does_not(tmp_path: Path) -> None:
    """Its end fades into what comes before its first frame, or into its own beginning."""
    clip = write_clip(tmp_path / "clip.mp4")
    trimotion.animate(clip, tmp_path / "a_##.png", loop=2, **OPTIONS)
    whole = drawn(tmp_path, "a")
    assert list(whole) == list(range(2, 12))
    trimotion.animate(clip, tmp_path / "b_##.png", loop=2, frames="3-11", **OPTIONS)
    assert list(drawn(tmp_path, "b")) == list(range(3, 12))
    trimotion.animate(clip, tmp_path / "c_##.png", **OPTIONS)
    plain = drawn(tmp_path, "c")
    assert np.array_equal(plain[9], whole[9])
    for frame, share in ((10, 1 / 3), (11, 2 / 3)):
        mixed = (1 - share) * plain[frame] + share * plain[frame - 10]
        assert np.abs(whole[frame] - mixed).max() < 1.5  # of two shots nothing is matched


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"loop": 12}, "there are 12 frames, too few to blend; choose loop=5 or fewer"),
        ({"loop": 300}, "loop=300: must lie between 0"),
        ({"loop": 2, "frames": "0-11x2"}, "takes every frame; leave x2 out"),
        ({"loop": 2, "independent": True}, "no mesh leads to the next"),
        ({"loop": 1, "frames": "3"}, "a loop needs more frames"),
    ],
)
def test_loops_that_are_none(tmp_path: Path, options: dict, message: str) -> None:
    clip = write_clip(tmp_path / "clip.mp4")
    with pytest.raises(trimotion.TrimotionError, match=message):
        trimotion.animate(clip, tmp_path / "a.gif", **options, **OPTIONS)


def rms(one: np.ndarray, other: np.ndarray) -> float:
    """Root mean square difference."""
    return float(np.sqrt(((one.astype(np.float64) - other) ** 2).mean()))


def cut_off(track: Path, copy: Path, last: int) -> None:
    """A copy of a track that ends with a frame, as if it had been interrupted."""
    import shutil
    import sqlite3
    from contextlib import closing

    shutil.copy(track, copy)
    with closing(sqlite3.connect(copy)) as connection:
        names = [name for (name,) in connection.execute("SELECT name FROM sqlite_master")]
        for name in names:
            columns = [row[1] for row in connection.execute(f"PRAGMA table_info({name})")]
            if "frame" in columns:
                connection.execute(f"DELETE FROM {name} WHERE frame > ?", (last,))
        connection.commit()
