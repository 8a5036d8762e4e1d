"""Styles and textures of regions as edits: in logs, in journals, and in what is drawn."""

import re
from pathlib import Path

import cv2
import numpy as np
import pytest

from pipeline.cli import main
from pipeline.edit_log.journal import EditJournal
from pipeline.edit_log.json_lines import as_json_lines, from_json_lines, write_log
from pipeline.edit_log.painted_regions import check_style, painted_regions
from pipeline.options.edit_log import EditLog
from stages.hand import Edit
from stages.hand.find import inside_polygon
from stages.hand.regions.style_region import StyleRegion
from stages.hand.regions.texture_region import TextureRegion
from stages.hand.worked import Worked
from stages.masks.area import Area
from stages.masks.painted import painted
from tests.meshes import random_mesh
from tests.tracks import CUT, QUICK_FLAGS, rows_of, write_clip
from warp_kernels.errors import EditError, TrimotionError

SIZE = (96, 64)
LEFT = ((0.0, 0.0), (48.0, 0.0), (48.0, 64.0), (0.0, 64.0))
EDGES = StyleRegion(frame=2, polygon=LEFT, style="edges:width=3,color=#f00")


@pytest.mark.parametrize("seed", range(6))
def test_a_polygon_is_painted_where_its_inside_is(seed: int) -> None:
    """Compared with a test of every pixel's centre, for polygons that cross themselves as well."""
    rng = np.random.default_rng(seed)
    polygon = tuple(map(tuple, rng.uniform(-20, 110, (int(rng.integers(3, 9)), 2)).tolist()))
    x, y = np.meshgrid(np.arange(96) + 0.5, np.arange(64) + 0.5)
    wanted = inside_polygon(np.stack([x.ravel(), y.ravel()], axis=1), polygon).reshape(64, 96)
    found = painted([Area(polygon=polygon)], SIZE) > 0
    assert np.array_equal(found, wanted)


def test_a_polygon_may_be_as_large_as_numbers_are() -> None:
    far = 1e308
    everything = Area(polygon=((-far, -far), (far, -far), (far, far), (-far, far)))
    assert painted([everything], SIZE).all()


def test_strokes_are_discs_and_add_up() -> None:
    both = painted([Area((20.0, 20.0), 9.0), Area((60.0, 30.0), 5.0)], SIZE) > 0
    assert both.sum() == pytest.approx(np.pi * (81 + 25), rel=0.03)
    assert both[20, 20]
    assert both[30, 60]
    assert not both[5, 5]
    assert not painted([Area()], SIZE).any()


def test_strokes_of_one_style_are_one_region() -> None:
    strokes = [StyleRegion(frame=2, at=(9.0 + i, 9.0), radius=4.0, style="flat") for i in range(9)]
    drawn = painted_regions(EditLog((*strokes, EDGES, strokes[0])))
    assert [len(region.areas) for region in drawn.regions] == [9, 1, 1]
    assert len({region.mask for region in drawn.regions}) == 3
    assert not painted_regions(EditLog((EDGES,)), frames={0, 1}).regions


def test_what_cannot_be_drawn_is_told_before_the_work(
    tmp_path: Path, capsys: pytest.CaptureFixture
) -> None:
    """Once, as a warning: a film may take hours until then."""
    clip, log = write_clip(tmp_path / "in.mp4"), tmp_path / "log.jsonl"
    write_log(EditLog((EDGES, TextureRegion(frame=2, polygon=LEFT, file="gone.png"))), log)
    options = ["--edits", str(log), "--frames", "0-2", *QUICK_FLAGS]
    for command, target in (("solve", "a.mtrk"), ("animate", "a.mp4")):
        assert main([command, str(clip), "-o", str(tmp_path / target), *options]) == 0
        first, *rest = capsys.readouterr().err.splitlines()
        assert first.startswith("trimotion: warning: edit 2 (texture_region in frame 2) was left")
        assert first.count("gone.png") == first.count("no such file") == 1
        assert not any("gone.png" in line for line in rest)


@pytest.mark.parametrize(
    ("edit", "told"),
    [
        (StyleRegion(frame=2, polygon=LEFT, style="hatchin"), "no 'hatchin'; .*hatching"),
        (StyleRegion(frame=2, polygon=LEFT, style="edges:width=x"), "width"),
        (StyleRegion(frame=2, polygon=LEFT, style="a\nb"), "names nothing"),
        (StyleRegion(frame=2, polygon=LEFT, style="x" * 10**5), "names nothing"),
        (TextureRegion(frame=2, polygon=LEFT, file="none.png"), "none.png.*or choose from cushion"),
        (TextureRegion(frame=2, polygon=LEFT, file="cushion", strength=9.0), "strength=9"),
    ],
)
def test_styles_that_there_are_not_are_told(edit: Edit, told: str) -> None:
    (refused,) = painted_regions(EditLog((EDGES, edit))).refused
    assert refused.startswith("edit 2 (")
    assert "\n" not in refused
    assert re.search(told, refused)
    with pytest.raises(TrimotionError, match=told):
        check_style(edit)
    check_style(EDGES)


@pytest.mark.parametrize(
    ("edit", "told"),
    [
        (StyleRegion(frame=0, style="flat"), "give either a brush"),
        (StyleRegion(frame=0, at=(3.0, 3.0), style="flat"), "radius 0"),
        (StyleRegion(frame=0, at=(300.0, 3.0), radius=9.0, style="flat"), "outside of the picture"),
        (TextureRegion(frame=0, polygon=((1.0, 1.0), (2.0, 2.0)), file="cushion"), "no inside"),
    ],
)
def test_regions_that_there_are_not_are_refused(edit: Edit, told: str) -> None:
    worked = Worked(random_mesh(1))
    with pytest.raises(EditError, match=told):
        edit.apply(worked)
    assert EDGES.apply(worked) is worked


def test_they_are_lines() -> None:
    log = EditLog((EDGES, TextureRegion(frame=1, at=(3.0, 4.0), radius=5.0, file="cushion")))
    assert from_json_lines(as_json_lines(log), "log") == log
    assert '"style": "edges:width=3,color=#f00"' in as_json_lines(log)


def trimotion(*arguments: object) -> None:
    """Run the program."""
    assert main([*map(str, arguments), "--progress", "none"]) == 0


def red(path: Path) -> np.ndarray:
    """Which pixels of a still are the red of the edges, purer than any in the clip, [H, W] bool."""
    picture = cv2.imread(str(path)).astype(int)
    found: np.ndarray = (picture[..., 2] > 180) & (picture[..., :2].max(axis=2) < 40)
    return found


def test_a_region_is_drawn_through_its_shot_and_as_a_mask_is(tmp_path: Path) -> None:
    """By `solve` and `render`, by `animate`, from the journal, and with a mask of the same."""
    clip, log, track = write_clip(tmp_path / "in.mp4"), tmp_path / "log.jsonl", tmp_path / "a.mtrk"
    write_log(EditLog((EDGES,)), log)
    flags = (*QUICK_FLAGS, "--edits", log)
    trimotion("solve", clip, "-o", track, *flags)
    plain = tmp_path / "plain.mtrk"
    trimotion("solve", clip, "-o", plain, *QUICK_FLAGS)
    assert rows_of(track) == rows_of(plain)  # no mesh is changed
    trimotion("render", track, "-o", tmp_path / "a_####.png")
    trimotion("animate", clip, "-o", tmp_path / "b_####.png", *flags)
    cv2.imwrite(str(tmp_path / "mask.png"), painted([EDGES.area], SIZE))
    style = f"{tmp_path / 'mask.png'}@2:{EDGES.style}"
    trimotion("render", plain, "-o", tmp_path / "c_####.png", "--region", style)
    with EditJournal(plain) as journal:
        journal.append([EDGES])
    trimotion("render", plain, "-o", tmp_path / "d_####.png")
    with EditJournal(plain) as journal:
        journal.undo()
    trimotion("render", plain, "-o", tmp_path / "e_####.png")
    for frame in (0, 2, CUT - 1, CUT):
        pictures = [(tmp_path / f"{name}_{frame:04}.png").read_bytes() for name in "abcde"]
        assert pictures[0] == pictures[1] == pictures[2] == pictures[3]
        assert red(tmp_path / f"e_{frame:04}.png").sum() == 0
        shown = red(tmp_path / f"a_{frame:04}.png")
        if frame == CUT:
            assert not shown.any()
        else:
            assert shown[:, :40].sum() > 100
            assert shown[:, 70:].sum() == 0
