"""A film with everything that a timeline may hold: the same bits however it is made."""

from pathlib import Path

import av
import numpy as np
import pytest

import trimotion
from benchmarks.listening import save
from benchmarks.made_music import Piece, play
from tests import media_samples as samples

FRAMES, CUT = 24, 13
QUICK = {"iterations": 8, "frame_iterations": 4, "triangles": 40, "focus": "none", "threads": 1}
SHOW = """
bpm = 300
[[section]]
style = ["flat", "edges:width=1"]
move = ["wave"]
[[section]]
from = "f4"
transition = "fade 2 frames"
style = ["paper:color=#111", "shrink:gap=2"]
[[section]]
from = "f8"
transition = "wipe left 1 beat"
style = ["flat", "edges:width=1"]
background = "#123"
[[section]]
from = "f13"
transition = "scatter 3 frames"
style = ["gradient"]
move = ["pulse"]
[[section]]
from = "f17"
transition = "grow 3 frames"
style = ["paper:color=#111", "shrink:gap=2"]
[[section]]
from = "f22"
transition = "cut"
style = ["flat"]
[curves]
"edges.width" = "0s: 1, f4: 4"
"edges.color" = "start: #222, end: #a33"
"edges.opacity" = "0.9 - 0.3*beat"
"edges.fade" = "3 + sin(t)"
"flat.opacity" = "1 - 0.4*smooth(rms, 0.2s)"
"paper.color" = "f3: #111, f19: teal ease-in-out"
"paper.grain" = "0.2 + 0.1*random(floor(b))"
"paper.size" = "start: 200, end: 300"
"paper.sheets" = "0.01 + 0.01*low"
"shrink.gap" = "px*10*(1 + env(beat, decay=0.2s))"
"shrink.rounding" = "0.3 + 0.1*noise(1)"
"shrink.smallest" = "start: 0.5, end: 0.6 ease-in"
"shrink.opacity" = "start: 0.9 bounce, end: 0.8"
"gradient.opacity" = "0.7 + 0.3*env(shot, decay=0.2s)"
"wave.amount" = "start: 0, f8: 2 elastic"
"pulse.amount" = "env(every(1 beat), decay=0.1s)"
"grade.exposure" = "0.2*mid"
"grade.saturation" = "1 - 0.5*progress"
"grade.hue" = "start: 0, end: 40"
"opacity" = "f20: 1, f23: 0.5"
"triangles" = "start: 40, f12: 40 step, f13: 56, end: 70"
"""


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a clip of two shots, a song and a timeline."""
    folder = tmp_path_factory.mktemp("music_video")
    pictures = [samples.picture(96, 64) for _ in range(FRAMES)]
    moved = [
        np.roll(p, 2 * k, 1) if k < CUT else 255 - np.roll(p, k, 0) for k, p in enumerate(pictures)
    ]
    samples.write_video(folder / "clip.mp4", moved)
    save(folder / "song.wav", play(Piece(150, seconds=0.7)).sound[None])
    (folder / "show.toml").write_text(SHOW)
    return folder


def frames_of(path: Path) -> list[np.ndarray]:
    """The frames of a film without loss."""
    with av.open(str(path)) as film:
        return [frame.to_ndarray(format="rgb24") for frame in film.decode(video=0)]


def test_it_is_the_same_however_it_is_made(place: Path) -> None:
    """In one pass, with two processes, solved and then drawn, and a part of it."""
    look = {"timeline": place / "show.toml", "audio_mode": str(place / "song.wav"), "codec": "ffv1"}
    clip, track = place / "clip.mp4", place / "clip.mtrk"
    trimotion.animate(clip, place / "whole.mkv", **look, **QUICK)
    trimotion.animate(clip, place / "jobs.mkv", jobs=2, **look, **QUICK)
    solving = {key: look[key] for key in ("timeline",)}
    trimotion.solve(clip, track, **solving, **QUICK)
    trimotion.render(track, place / "drawn.mkv", **look)
    trimotion.render(track, place / "part.mkv", frames="9-18", **look)
    whole = frames_of(place / "whole.mkv")
    assert len(whole) == FRAMES
    for name, first, count in (("jobs", 0, FRAMES), ("drawn", 0, FRAMES), ("part", 9, 10)):
        others = frames_of(place / f"{name}.mkv")
        assert len(others) == count
        differing = [k for k, one in enumerate(others) if not np.array_equal(one, whole[first + k])]
        assert differing == [], name
