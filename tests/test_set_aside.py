"""Frames that wait for an edited one: the same when they come back, wherever they waited."""

import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from pipeline.loop.attention import Attention
from pipeline.loop.convert import triangulator_of
from pipeline.loop.edited import EditedFrames
from pipeline.loop.prepare import prepared
from pipeline.options.edit_log import EditLog
from pipeline.track import TrackReader
from stages.frame import Frame
from stages.hand.insert import Insert
from stages.media import open_decoder
from stages.media.set_aside import SetAside
from tests.jobs import job_of
from tests.tracks import CUT, QUICK, solve_to, write_clip
from warp_kernels.device.device import Device

LOG = EditLog((Insert(1, (30.0, 32.0), 12.0, 5), Insert(4, (66.0, 32.0), 12.0, 5)))


def frames_of(count: int) -> list[Frame]:
    """Frames of noise, every other one with weights."""
    rng = np.random.default_rng(2)
    found = []
    for index in range(count):
        pixels = rng.integers(0, 256, (9, 7, 3), dtype=np.uint8)
        weights = rng.integers(1, 256, (9, 7), dtype=np.uint8) if index % 2 else None
        found.append(Frame(index, 3 * index, Fraction(1, 25), pixels, weights))
    return found


@pytest.mark.parametrize("room", [0, 300, 1 << 20])
def test_what_comes_back_is_what_went(room: int) -> None:
    store = SetAside(room)
    for count in (7, 4):  # what was cleared leaves no trace
        frames = frames_of(count)
        aside = [store.put(frame) for frame in frames]
        for number in (*range(count)[::-1], 0, count - 1):
            wanted, found = frames[number], aside[number].frame()
            assert (found.index, found.pts) == (wanted.index, wanted.pts)
            assert np.array_equal(found.pixels, wanted.pixels)
            assert (found.weights is None) == (wanted.weights is None)
            assert found.weights is None or np.array_equal(found.weights, wanted.weights)
        kept = sum(one.frame() is frame for one, frame in zip(aside, frames, strict=True))
        assert kept == (0 if room == 0 else 1 if room == 300 else count)
        store.clear()


FULL = """
import resource, signal
from tests.test_set_aside import frames_of
from stages.media.set_aside import SetAside
from warp_kernels.errors import OutputError
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (400, 400))
store = SetAside(0)
try:
    aside = [store.put(frame) for frame in frames_of(3)]
except OutputError as error:
    print(error)
"""


def test_a_disk_without_room_is_told() -> None:
    """Where no file may grow beyond 400 bytes."""
    pytest.importorskip("resource")
    run = subprocess.run([sys.executable, "-c", FULL], capture_output=True, text=True, check=True)
    assert "cannot be kept there (file too large); free space in it" in run.stdout
    assert run.stdout.count("\n") == 1


def test_a_shot_is_the_same_to_the_bit_whether_pictures_wait_in_a_file(tmp_path: Path) -> None:
    clip = write_clip(tmp_path / "in.mp4")
    solve_to(tmp_path / "a.mtrk", clip, f"0-{CUT - 1}", edits=LOG)
    options = job_of(clip, edits=LOG, triangulate=QUICK).solve
    with Device("cpu") as device, open_decoder(clip) as decoder:
        info = decoder.info
        attention = Attention(options.foci, info, 1, QUICK.refine.triangles)
        found = prepared(decoder, info, attention, [], options, None, [])
        size = (info.width, info.height)
        triangulator = triangulator_of(options, size, device, options.model)
        edited = EditedFrames(triangulator, options, None, keeps=True, room=0)
        solved = list(edited.solved(found))
    with TrackReader(tmp_path / "a.mtrk") as track:
        for one, frame in zip(solved, range(CUT), strict=False):
            wanted = track.snapshot(frame)
            assert np.array_equal(one.snapshot.mesh.vertices, wanted.mesh.vertices)
            assert np.array_equal(one.snapshot.mesh.triangles, wanted.mesh.triangles)
            assert one.source is not None
            assert one.source.shape == (info.height, info.width, 3)
