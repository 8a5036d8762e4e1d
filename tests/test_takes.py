"""Parts of one shot that were solved apart meet without a jump."""

from pathlib import Path

import numpy as np
import pytest

from pipeline.cli import main
from pipeline.loop.plan import Pieces, plan
from pipeline.options.seam import Seam
from pipeline.options.solve_options import SolveOptions
from pipeline.track import TrackReader
from stages.media import open_decoder
from stages.mesh import Mesh
from stages.motion.matching import Matching
from stages.validate import assert_valid
from tests import media_samples as samples
from tests.meshes import random_mesh
from tests.tracks import QUICK_FLAGS
from warp_kernels.errors import OptionError

COUNT, LEAD, BLEND = 14, 3, 3
FIRST = 7
"""Frames of the clip, those that its parts have in common, those of the fade, and where the second
part begins without its lead."""
SHOWN = FIRST - BLEND
"""The first frame that fades."""


@pytest.fixture(scope="module")
def clip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A clip of one shot."""
    pictures = [samples.picture(96, 64, n) for n in range(COUNT)]
    return samples.write_video(tmp_path_factory.mktemp("takes") / "in.mp4", pictures)


@pytest.fixture(scope="module")
def parts(clip: Path) -> list[Path]:
    """Its parts, as a plan says."""
    options = SolveOptions(clip, cuts="none")
    ranges = [str(part) for part in plan(options, pieces=Pieces(FIRST, LEAD)).ranges]
    assert ranges == [f"0-{FIRST - 1}", f"{FIRST - LEAD}-{COUNT - 1}"]
    found = []
    for part in ranges:
        found.append(clip.with_name(f"{part}.mtrk"))
        flags = [*QUICK_FLAGS, "--frames", part, "--cuts", "none", "-q"]
        assert main(["solve", str(clip), "-o", str(found[-1]), *flags]) == 0
    return found


@pytest.fixture(scope="module")
def joined(parts: list[Path]) -> Path:
    """The parts, put together in the wrong order."""
    track = parts[0].with_name("joined.mtrk")
    command = ["join", *map(str, parts[::-1]), "-o", str(track), "--blend", str(BLEND)]
    assert main(command) == 0
    return track


def pictures(path: Path, *options: str) -> list[np.ndarray]:
    """What is drawn of a track."""
    output = path.with_suffix(".mkv")
    flags = ["--codec", "ffv1", "--overwrite", "-q", *options]
    assert main(["render", str(path), "-o", str(output), *flags]) == 0
    with open_decoder(output) as decoder:
        return [frame.pixels.astype(np.int16) for frame in decoder]


def test_every_frame_is_one_of_a_part(parts: list[Path], joined: Path, capsys) -> None:
    """Those of the fade are the later part's; the earlier one's stand behind the end."""
    with TrackReader(joined) as whole, TrackReader(parts[0]) as a, TrackReader(parts[1]) as b:
        whole.check()
        seam = whole.header.solve.seam
        assert (seam.over, seam.joints, seam.closes) == (BLEND, (SHOWN,), COUNT - 1)
        assert [row.frame for row in whole.rows] == list(range(COUNT + BLEND))
        for frame in range(COUNT):
            here, there = whole.snapshot(frame), (b if frame >= SHOWN else a).snapshot(frame)
            np.testing.assert_array_equal(here.mesh.vertices, there.mesh.vertices)
            np.testing.assert_array_equal(here.mesh.triangle_ids, there.mesh.triangle_ids)
            np.testing.assert_array_equal(here.coefficients, there.coefficients)
        for place in range(BLEND):
            assert seam.partner_of(SHOWN + place)[0] == COUNT + place
            assert seam.picture_of(COUNT + place) == SHOWN + place
            mesh = whole.snapshot(COUNT + place).mesh
            assert_valid(mesh)
            at = {tuple(v) for v in a.snapshot(SHOWN + place).mesh.vertices}
            assert {tuple(v) for v in mesh.vertices} == at
        assert {row.shot for row in whole.rows} == {0, SHOWN, COUNT}


def test_what_is_drawn_fades(parts: list[Path], joined: Path) -> None:
    """Outside of the fade it is the parts'; in it, it goes from one to the other."""
    whole = pictures(joined)
    a, b = (pictures(part) for part in parts)
    b = [None] * (FIRST - LEAD) + b
    assert len(whole) == COUNT
    for frame in range(COUNT):
        if frame < SHOWN:
            np.testing.assert_array_equal(whole[frame], a[frame])
        elif frame >= FIRST:
            np.testing.assert_array_equal(whole[frame], b[frame])
    apart = [
        [np.abs(whole[frame] - part[frame]).mean() for frame in range(SHOWN, FIRST)]
        for part in (a, b)
    ]
    assert apart[0] == sorted(apart[0])
    assert apart[1] == sorted(apart[1], reverse=True)
    middle = pictures(joined, "--frames", f"{SHOWN}-{FIRST}")
    np.testing.assert_array_equal(middle, whole[SHOWN : FIRST + 1])


def test_three_parts_and_one_after_a_cut() -> None:
    """Each joint has its own frames behind the end."""
    seam = Seam(over=2, opens=0, closes=29, joints=(8, 20))
    assert [seam.partner_of(n) for n in (7, 10, 19, 22)] == [None] * 4
    assert [seam.partner_of(n)[0] for n in (8, 9, 20, 21)] == [30, 31, 32, 33]
    assert seam.partner_of(8)[1] > seam.partner_of(9)[1]
    assert [seam.picture_of(n) for n in (5, 30, 31, 32, 33)] == [5, 8, 9, 20, 21]
    assert seam.solved == (0, 33)
    for wrong in ((8, 9), (20, 8), (29,)):
        with pytest.raises(ValueError, match="impossible"):
            Seam(over=2, opens=0, closes=29, joints=wrong)


def test_vertices_are_matched_and_numbered() -> None:
    """Those that lie together are the same; corners always; the mesh stays what it is."""
    mesh = random_mesh(3)
    inner = ~(mesh.on_left_right | mesh.on_top_bottom)
    other = mesh.moved(mesh.vertices + 0.01 * inner[:, None])
    other = renumbered_by(other, 1000)
    matching = Matching.between(mesh, other)
    again = matching.renumbered(mesh)
    assert_valid(again)
    np.testing.assert_array_equal(np.sort(again.vertex_ids), other.vertex_ids)
    np.testing.assert_array_equal(again.areas, mesh.areas)
    alone = Matching(np.empty(0, np.int64), np.empty(0, np.int64), 50).renumbered(mesh)
    np.testing.assert_array_equal(alone.vertex_ids, 50 + mesh.vertex_ids)


def renumbered_by(mesh: Mesh, shift: int) -> Mesh:
    """The same mesh with higher numbers."""
    return Matching(np.empty(0, np.int64), np.empty(0, np.int64), shift).renumbered(mesh)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ((), "--blend N"),
        (("--blend", "9"), "choose --blend 3 or fewer"),
        (("--blend", "-1"), "must be 0 or more"),
    ],
)
def test_parts_that_do_not_fit(
    parts: list[Path], options: tuple[str, ...], message: str, tmp_path: Path, capsys
) -> None:
    """One line, and no track."""
    track = tmp_path / "t.mtrk"
    assert main(["join", *map(str, parts), "-o", str(track), *options]) == 2
    captured = capsys.readouterr()
    assert captured.err.count("\n") == 1
    assert message in captured.err
    assert not list(tmp_path.iterdir())


def test_plan_cuts_long_shots(clip: Path, capsys) -> None:
    """Even pieces, each with its lead; the job of a farm lets them fade."""
    options = SolveOptions(clip, cuts="none")
    assert plan(options, pieces=Pieces(5, 2)).as_lines() == "0-3\n2-8\n7-13"
    assert plan(options, pieces=Pieces(14, 2)).as_lines() == "0-13"
    assert plan(options, pieces=Pieces(5, 2)).frames == COUNT
    flags = ["--cuts", "none", "--format", "slurm", "--lead", "2"]
    assert main(["plan", str(clip), *flags, "--max-frames", "5"]) == 0
    assert "--blend 2" in capsys.readouterr().out
    assert main(["plan", str(clip), *flags, "--max-frames", "14"]) == 0
    assert "--blend" not in capsys.readouterr().out
    for wrong in (["--lead", "3"], ["--max-frames", "3"], ["--max-frames", "20", "--lead", "0"]):
        assert main(["plan", str(clip), *wrong]) == 2
    with pytest.raises(OptionError, match="leave one out"):
        plan(options, 2, Pieces(5, 2))
