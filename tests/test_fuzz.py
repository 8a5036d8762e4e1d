"""Damage by the hundred: some of what `benchmarks/fuzz` tries, and each fault that it found."""

import random
from pathlib import Path

import pytest

from benchmarks.fuzz.__main__ import broken_media, broken_presets, broken_tracks
from benchmarks.fuzz.media import samples_in
from benchmarks.fuzz.mutate import broken_text, mutant
from benchmarks.fuzz.watch import Watch
from pipeline.track.cuts import read_cuts
from pipeline.track.plain_values import from_plain
from stages.media import FrameRange
from warp_kernels.errors import MediaError, TrimotionError


@pytest.mark.parametrize(
    ("try_all", "count", "least"), [(broken_media, 160, 60), (broken_presets, 52, 30)]
)
def test_damage_is_told_in_plain_words(try_all, count: int, least: int, tmp_path: Path) -> None:
    """Nothing hangs, nothing but a `TrimotionError` arises, and most of it is noticed."""
    watch = try_all(tmp_path, count, 7)
    assert not watch.bad, "\n".join(watch.bad)
    assert watch.count == count
    assert least <= watch.refused < count


def test_damaged_tracks_are_told_in_plain_words(tmp_path: Path) -> None:
    """Words of Python's are no reason that a person understands."""
    watch = broken_tracks(tmp_path, 40)
    assert not watch.bad, "\n".join(watch.bad)
    assert watch.refused == 40


def test_all_kinds_are_tried(tmp_path: Path) -> None:
    """Films of every container and stills, as far as this FFmpeg writes them."""
    endings = {sample.ending for sample in samples_in(tmp_path)}
    assert {".mp4", ".mkv", ".webm", ".mov", ".avi", ".gif", ".png", ".jpg", ".m4a"} <= endings
    assert len(endings) > 18


def test_a_seed_is_one_damage() -> None:
    """What is found can be found again."""
    content = bytes(range(256)) * 4
    twice = [mutant(content, [content], random.Random(5)) for _ in range(2)]
    assert twice[0] == twice[1] != content
    assert broken_text("a = 1\n" * 9, random.Random(5)) == broken_text(
        "a = 1\n" * 9, random.Random(5)
    )


def test_the_watch_sees_what_is_wrong() -> None:
    """A traceback, words of Python's, and a line without an end."""

    def fails(error: Exception):
        def work() -> None:
            raise error

        return work

    watch = Watch("x")
    watch.attempt("fine", fails(TrimotionError("a.mp4: is empty; give another")))
    assert (watch.count, watch.refused, watch.bad) == (1, 1, [])
    for error in (KeyError("x"), TrimotionError("a: <class 'int'>; b"), TrimotionError("a" * 2000)):
        watch.attempt("bad", fails(error))
    assert len(watch.bad) == 3


def test_deep_brackets_are_no_list_of_cuts(tmp_path: Path) -> None:
    """Python's own limit of nesting is reached within JSON."""
    path = tmp_path / "cuts.json"
    path.write_text("[" * 100_000)
    with pytest.raises(MediaError, match="no list of whole numbers"):
        read_cuts(path)


def test_what_lacks_is_named() -> None:
    """A field that must be there."""
    with pytest.raises(ValueError, match=r"^Wanted lacks there$"):
        from_plain(_wanted(), {"class": "Wanted"})
    assert from_plain(FrameRange, {"class": "FrameRange"}) == FrameRange()


def _wanted() -> type:
    from dataclasses import make_dataclass

    return make_dataclass("Wanted", [("there", int)], namespace={"__module__": __name__})
