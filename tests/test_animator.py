"""`Animator` gives what `solve` gives, frame by frame; `open_track` gives it back."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trimotion
from stages.media import open_decoder
from tests import media_samples as samples
from tests.tracks import COUNT, CUT

QUICK: trimotion.AnimatorKeywords = {
    "triangles": 40,
    "iterations": 8,
    "frame_iterations": 4,
    "threads": 1,
}


@pytest.fixture(scope="module")
def stills(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Twelve stills in two shots, 96x64; one of them comes twice."""
    folder = tmp_path_factory.mktemp("stills")
    for number in range(COUNT):
        seen = number - 1 if number == 4 else number
        pixels = samples.picture(96, 64, seen)
        pixels = pixels if number < CUT else 255 - pixels[::-1]
        samples.write_still(folder / f"s_{number:02}.png", pixels)
    return str(folder / "s_##.png")


@pytest.fixture(scope="module")
def frames(stills: str) -> list[np.ndarray]:
    """Their pixels."""
    with open_decoder(stills) as decoder:
        return [frame.pixels for frame in decoder]


def fed(animator: trimotion.Animator, frames: list[np.ndarray]) -> list[trimotion.Triangulation]:
    """What becomes of frames; they come back in order."""
    found = []
    with animator:
        for pixels in frames:
            found += animator.feed(pixels)
        found += animator.finish()
    assert [one.frame for one in found] == list(range(len(frames)))
    return found


def assert_same(one: trimotion.Triangulation, other: trimotion.Triangulation) -> None:
    """All of two triangulations is equal, to the bit."""
    assert (one.frame, one.shot, one.rmse) == (other.frame, other.shot, other.rmse)
    for name in ("vertices", "triangles", "colors", "vertex_ids", "triangle_ids"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name))


@pytest.mark.parametrize(
    "options",
    [{}, {"cuts": "none"}, {"color": "linear", "seed": 3}, {"independent": True}, {"flow": "none"}],
    ids=str,
)
def test_animator_gives_what_solve_gives(
    options: dict, stills: str, frames: list[np.ndarray], tmp_path: Path
) -> None:
    """To the bit, shots and ids as well, for cuts that are found and cuts that are ignored."""
    trimotion.solve(stills, tmp_path / "t.mtrk", **QUICK, **options)
    found = fed(trimotion.Animator((96, 64), **QUICK, **options), frames)
    with trimotion.open_track(tmp_path / "t.mtrk") as track:
        for one, other in zip(found, track, strict=True):
            assert_same(one, other)
        assert sorted({one.shot for one in found}) == list(track.shots)
    if not options:
        assert {one.shot for one in found} == {0, CUT}


def test_weights_lie_over_all_frames(stills: str, frames: list[np.ndarray], tmp_path: Path) -> None:
    """A map by its name, as in a clip."""
    grey = np.full((64, 96, 3), 20, np.uint8)
    grey[20:40, 30:60] = 255
    weights = samples.write_still(tmp_path / "w.png", grey)
    trimotion.solve(stills, tmp_path / "t.mtrk", frames="0-5", weights=weights, **QUICK)
    found = fed(trimotion.Animator((96, 64), weights=weights, **QUICK), frames[:6])
    with trimotion.open_track(tmp_path / "t.mtrk") as track:
        for one, other in zip(found, track, strict=True):
            np.testing.assert_array_equal(one.vertices, other.vertices)


def test_told_shots_are_as_good_as_found_ones(frames: list[np.ndarray]) -> None:
    """Whether cuts are ignored or found as well."""
    wanted = fed(trimotion.Animator((96, 64), **QUICK), frames)
    for cuts in ("none", "auto"):
        with trimotion.Animator((96, 64), cuts=cuts, **QUICK) as animator:
            found = []
            for number, pixels in enumerate(frames):
                found += animator.feed(pixels, new_shot=number == CUT)
            found += animator.finish()
        for one, other in zip(found, wanted, strict=True):
            assert_same(one, other)


def test_frames_come_as_late_as_promised(frames: list[np.ndarray]) -> None:
    """At once if cuts are ignored, four frames later if they are found; told ones end the wait."""

    def counts(**options: Any) -> list[int]:
        """How many come back from each call."""
        with trimotion.Animator((96, 64), focus="none", **QUICK, **options) as animator:
            fed = [len(animator.feed(pixels, new_shot=n == 6)) for n, pixels in enumerate(frames)]
            return [*fed, len(animator.finish())]

    assert counts(cuts="none") == [1] * COUNT + [0]
    assert counts() == [0, 0, 0, 0, 1, 1, 4, 0, 0, 0, 1, 1, 4]


def test_finished_animator_goes_on_with_a_new_shot(frames: list[np.ndarray]) -> None:
    """Numbers count on; what comes does not depend on what was."""
    with trimotion.Animator("96x64", **QUICK) as animator:
        assert not animator.feed(frames[0])
        assert [one.frame for one in animator.finish()] == [0]
        animator.feed(frames[1])
        (one,) = animator.finish()
    assert (one.frame, one.shot) == (1, 1)


@pytest.mark.parametrize("size", [(0, 4), (4, 9000), "big", (1, 2, 3), 7, (2.5, 3), None])
def test_impossible_size(size: object) -> None:
    """Refused before any frame comes."""
    with pytest.raises(trimotion.OptionError, match="size"):
        trimotion.Animator(size)  # type: ignore[arg-type]


def test_frame_of_another_size_is_refused_and_forgotten(frames: list[np.ndarray]) -> None:
    """The animator goes on as if it had not been."""
    wanted = fed(trimotion.Animator((96, 64), **QUICK), frames[:2])
    with trimotion.Animator((96, 64), **QUICK) as animator:
        found = animator.feed(frames[0])
        with pytest.raises(trimotion.OptionError, match="64x96; this animator takes 96x64"):
            animator.feed(frames[0].transpose(1, 0, 2))
        with pytest.raises(trimotion.OptionError, match="pixels"):
            animator.feed(frames[0] / 255.0)
        found += animator.feed(frames[1]) + animator.finish()
    assert_same(found[1], wanted[1])


def test_closed_animator_says_so(frames: list[np.ndarray]) -> None:
    """As one that was interrupted."""
    animator = trimotion.Animator((96, 64), **QUICK)
    animator.close()
    animator.close()
    for call in (lambda: animator.feed(frames[0]), animator.finish):
        with pytest.raises(trimotion.OptionError, match="closed; make another"):
            call()


@pytest.fixture(scope="module")
def track(stills: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The track of every second frame from the third on."""
    path = tmp_path_factory.mktemp("track") / "t.mtrk"
    options = {**QUICK, "threads": 2}
    trimotion.solve(stills, path, frames="2-10x2", flow="dis:lines=60", **options)  # type: ignore
    return path


def test_track_is_a_collection_of_frames(track: Path, stills: str) -> None:
    """By the numbers of the source; facts of the header."""
    with trimotion.open_track(track) as opened:
        assert opened.frames == (2, 4, 6, 8, 10)
        assert len(opened) == 5
        assert 4 in opened
        assert 3 not in opened
        assert [one.frame for one in opened] == [2, 4, 6, 8, 10]
        assert opened[np.int64(6)].frame == 6
        assert opened.shots == (2, 6)
        assert (opened[8].shot, opened[8].time) == (6, 8 / 25)
        assert (opened.path, str(opened.source), opened.size) == (track, stills, (96, 64))
        assert opened.finished
        assert opened.program == trimotion.__version__
        assert "5 frames, 2 shots" in repr(opened)
        assert opened[6].draw("edges", scale=2).shape == (128, 192, 4)


@pytest.mark.parametrize("frame", [0, 3, -1, 12, "6", slice(2, 4), 2.0])
def test_frame_that_a_track_does_not_hold(track: Path, frame: object) -> None:
    """The message says which ones there are, or what to ask for."""
    with (
        trimotion.open_track(track) as opened,
        pytest.raises(trimotion.TrimotionError, match=r"it has 2 to 10|number of one frame"),
    ):
        opened[frame]  # type: ignore[index]


def test_look_that_a_track_cannot_give(track: Path) -> None:
    """Without the picture there are no lenses and no slopes."""
    with trimotion.open_track(track) as opened:
        for style in ("lenses", "gradient"):
            with pytest.raises(trimotion.OptionError, match=f"{style} need.*render"):
                opened[2].draw(style)


def test_options_of_a_track_can_be_used_again(track: Path, stills: str, tmp_path: Path) -> None:
    """Given to `solve` they make the same track; what does not decide it is not among them."""
    with trimotion.open_track(track) as opened:
        options = opened.options
        first = list(opened)
    assert (options["triangles"], options["frames"], options["weights"]) == (40, "2-10x2", None)
    assert options["flow"].startswith("dis:lines=60")
    assert not {"device", "threads", "jobs", "output", "styles"} & options.keys()
    trimotion.solve(stills, tmp_path / "again.mtrk", **options)
    with trimotion.open_track(tmp_path / "again.mtrk") as again:
        for one, other in zip(first, again, strict=True):
            assert_same(one, other)


def test_closed_track_says_so(track: Path, tmp_path: Path) -> None:
    """What was read before stays; what is no track is refused."""
    opened = trimotion.open_track(track)
    one = opened[2]
    opened.close()
    assert len(one.colors) == len(one.triangles)
    with pytest.raises(trimotion.TrackError, match="closed; open it again"):
        opened[2]
    (tmp_path / "x.mtrk").write_bytes(b"nothing")
    with pytest.raises(trimotion.TrackError, match="no mesh track"):
        trimotion.open_track(tmp_path / "x.mtrk")


def test_failing_animator_is_closed(frames: list[np.ndarray], tmp_path: Path) -> None:
    """What ends half-way cannot be gone on with, and says so: here the weights end too early."""
    grey = np.full((64, 96, 3), 200, np.uint8)
    for number in range(2):
        samples.write_still(tmp_path / f"w_{number}.png", grey)
    weights = str(tmp_path / "w_%01d.png")
    with trimotion.Animator((96, 64), weights=weights, **QUICK) as animator:
        with pytest.raises(trimotion.MediaError, match="no weights for frame 2"):
            [animator.feed(pixels) for pixels in frames]
        with pytest.raises(trimotion.OptionError, match="closed; make another"):
            animator.feed(frames[3])


def test_frames_from_two_threads_are_refused(frames: list[np.ndarray]) -> None:
    """In one line: which came first nobody could say. One after the other they may."""
    with trimotion.Animator((96, 64), **QUICK) as animator:
        with animator._alone(), ThreadPoolExecutor(1) as other:
            for call in (lambda: animator.feed(frames[0]), animator.finish):
                with pytest.raises(trimotion.TrimotionError, match="another thread"):
                    other.submit(call).result()
        with ThreadPoolExecutor(1) as other:
            found = other.submit(fed, animator, frames[:2]).result()
        assert len(found) == 2


@pytest.mark.parametrize("name", ["style", "styles", "size", "fit"])
def test_what_draws_nothing_says_what_does(frames: list[np.ndarray], name: str) -> None:
    """`triangulate` and `Animator` make triangles; looks belong to `draw`."""
    with pytest.raises(trimotion.TrimotionError, match=r"\.draw\(\)"):
        trimotion.triangulate(frames[0], **{name: "flat"})  # type: ignore[arg-type]
