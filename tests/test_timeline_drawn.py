"""What timelines draw: a frame alone is the frame of the whole, whoever draws it."""

from pathlib import Path

import cv2
import numpy as np
import pytest

import trimotion
from tests.tracks import COUNT, write_clip

QUICK = {"iterations": 8, "frame_iterations": 4, "triangles": 40, "focus": "none"}
SHOW = """
bpm = 120
[[section]]
style = ["flat", "edges:width=1"]
[[section]]
from = "f3"
style = ["paper:color=#111", "shrink:gap=2"]
transition = "fade 2 frames"
[[section]]
from = "f7"
style = ["flat:opacity=0.5"]
background = "#123"
transition = "wipe up 3 frames"
[curves]
edges.width = "0s: 1, f4: 4"
shrink.gap = "1 + 2*abs(sin(t*9)) + env(beat, decay=0.2s)"
paper.color = "f3: #111, f9: teal ease-in-out"
opacity = "f8: 1, f11: 0.25"
"""


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a clip, its track and a timeline."""
    folder = tmp_path_factory.mktemp("shows")
    clip = write_clip(folder / "clip.mp4")
    (folder / "show.toml").write_text(SHOW)
    trimotion.solve(clip, folder / "clip.mtrk", **QUICK)
    return folder


def drawn(place: Path, name: str, **options: object) -> dict[int, np.ndarray]:
    """Frames of the track by number."""
    pattern = place / f"{name}_##.png"
    trimotion.render(place / "clip.mtrk", pattern, **options)
    found = sorted(place.glob(f"{name}_??.png"))
    return {int(path.stem[-2:]): cv2.imread(str(path), cv2.IMREAD_UNCHANGED) for path in found}


def test_a_frame_of_a_range_is_that_of_the_whole(place: Path) -> None:
    whole = drawn(place, "whole", timeline=place / "show.toml")
    assert len(whole) == COUNT
    for number, frames in enumerate(("2-5", "4", "8-10")):
        part = drawn(place, f"part{number}", timeline=place / "show.toml", frames=frames)
        assert part
        for index, pixels in part.items():
            assert np.array_equal(pixels, whole[index]), index


def test_a_range_has_alpha_where_the_whole_has(place: Path) -> None:
    (place / "open.toml").write_text(
        '[[section]]\nstyle = ["flat"]\n[[section]]\nfrom = "f6"\nstyle = ["edges"]\n'
        "[curves]\nopacity = 0.5\n"
    )
    whole = drawn(place, "open", timeline=place / "open.toml")
    part = drawn(place, "opaque", timeline=place / "open.toml", frames="2-3")
    assert whole[2].shape[2] == 4
    assert all(np.array_equal(pixels, whole[index]) for index, pixels in part.items())


def test_a_frame_with_curves_is_that_of_the_same_stack_without(place: Path) -> None:
    whole = drawn(place, "curved", timeline=place / "show.toml")
    steady = drawn(place, "steady", styles=["flat", "edges:width=2.5"], frames="2")
    assert np.array_equal(whole[2], steady[2])
    assert not np.array_equal(whole[1], drawn(place, "other", styles=["flat"], frames="1")[1])


def test_a_wipe_shows_both_looks(place: Path) -> None:
    whole = drawn(place, "wiped", timeline=place / "show.toml")
    half, below = whole[8], whole[6]
    assert (half[-1, :, 0] != half[0, :, 0]).any()
    assert half.shape == below.shape


def test_jobs_resume_and_ranges_give_the_meshes_of_the_whole(tmp_path: Path) -> None:
    clip = write_clip(tmp_path / "clip.mp4")
    (tmp_path / "a.toml").write_text('[curves]\ntriangles = "f2: 20, f9: 60"\n')
    (tmp_path / "copy.toml").write_text('[curves]\n# the same\ntriangles = "f2: 20, f9: 60"\n')
    (tmp_path / "b.toml").write_text('[curves]\ntriangles = "f2: 20, f9: 62"\n')
    one, two = tmp_path / "one.mtrk", tmp_path / "two.mtrk"
    trimotion.solve(clip, one, timeline=tmp_path / "a.toml", **QUICK)
    trimotion.solve(clip, two, timeline=tmp_path / "a.toml", frames="0-4", **QUICK)
    with pytest.raises(trimotion.TrimotionError, match="triangles of the timeline"):
        trimotion.solve(clip, two, timeline=tmp_path / "b.toml", resume=True, **QUICK)
    with pytest.raises(trimotion.TrimotionError, match=r"timeline none instead of \[\["):
        trimotion.solve(clip, two, resume=True, **QUICK)
    trimotion.solve(clip, two, timeline=tmp_path / "copy.toml", resume=True, **QUICK)
    with trimotion.open_track(one) as whole, trimotion.open_track(two) as resumed:
        counts = [len(frame.triangles) for frame in whole]
        assert counts[0] == 20
        assert counts[-1] >= 58
        for frame, again in zip(whole, resumed, strict=True):
            assert np.array_equal(frame.vertices, again.vertices)
            assert np.array_equal(frame.colors, again.colors)
