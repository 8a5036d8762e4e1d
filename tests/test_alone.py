"""One run at a time writes to an output; the others say so, and break nothing."""

import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path

import pytest

from pipeline.cli import main
from pipeline.progress import Progress
from pipeline.track import TrackReader
from stages.media.writing.alone import alone
from stages.media.writing.commit import remove_left_overs
from stages.media.writing.place import check_folder
from tests import media_samples as samples
from tests.tracks import COUNT, QUICK_FLAGS, solve_to, write_clip
from warp_kernels.errors import OutputError

ROOT = Path(__file__).parents[1]
HOLD = """
import sys, time
from pathlib import Path
from stages.media.writing.alone import alone

with alone(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(60)
"""


def locks_in(folder: Path) -> list[Path]:
    """The locks that lie in a folder."""
    return sorted(folder.glob(".trimotion-*.lock"))


def test_second_run_says_who_is_first(tmp_path: Path) -> None:
    """In one process, too; a link is what it leads to, another name is another output."""
    output, link = tmp_path / "o.mp4", tmp_path / "link.mp4"
    link.symlink_to(output)
    with alone(output, None):
        (lock,) = locks_in(tmp_path)
        for name in (output, link):
            with (
                pytest.raises(OutputError, match=rf"process {os.getpid()} on .*; wait"),
                alone(name),
            ):
                pass
        with alone(tmp_path / "other.mp4", tmp_path / "o.mtrk"):
            assert len(locks_in(tmp_path)) == 3
    assert not locks_in(tmp_path)
    with alone(output, output), alone(tmp_path / "s_##.png"), alone(tmp_path / "s_##.png"):
        assert locks_in(tmp_path) == [lock]


def test_nothing_is_locked_where_nothing_can_be(tmp_path: Path) -> None:
    """Whoever writes there says what is wrong; beside a device no file is made."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with alone(tmp_path / "no" / "o.mp4"), alone(pipe), alone(pipe), alone(Path(os.devnull)):
        assert not locks_in(tmp_path)


def test_lock_dies_with_its_process(tmp_path: Path) -> None:
    """A killed run leaves a file that locks nothing, and that the next run removes."""
    output = tmp_path / "o.mp4"
    command = [sys.executable, "-c", HOLD, str(output)]
    holder = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)
    assert holder.stdout is not None
    with closing(holder.stdout):
        assert holder.stdout.readline() == "held\n"
        with pytest.raises(OutputError, match=f"process {holder.pid} on"), alone(output):
            pass
        remove_left_overs(tmp_path)
        assert len(locks_in(tmp_path)) == 1
        holder.send_signal(signal.SIGKILL)
        holder.wait()
    assert len(locks_in(tmp_path)) == 1
    remove_left_overs(tmp_path)
    assert not locks_in(tmp_path)
    with alone(output):
        pass


def test_waiting_for_a_run_that_ends(tmp_path: Path) -> None:
    """Processes of a killed run end soon; who waits for them goes on."""
    output = tmp_path / "o.mtrk"
    command = [sys.executable, "-c", HOLD, str(output)]
    holder = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)
    assert holder.stdout is not None
    with closing(holder.stdout):
        holder.stdout.readline()
        begun = time.monotonic()
        with pytest.raises(OutputError), alone(output, patience=0.3):
            pass
        assert time.monotonic() - begun >= 0.3
        holder.kill()
        holder.wait()
    with alone(output, patience=30):
        pass


def test_two_solves_of_one_track(tmp_path: Path, capsys) -> None:
    """The second one ends with one line, whatever it was asked; the first one's track is whole."""
    clip, track = write_clip(tmp_path / "in.mp4"), tmp_path / "t.mtrk"
    codes: list[int] = []

    class Second(Progress):
        """Begins another run while the first one is at work."""

        def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
            """Try each way to write there."""
            if done == 3:
                for more in ((), ("--overwrite",), ("--resume",)):
                    words = [str(clip), "-o", str(track), *QUICK_FLAGS, "--progress", "none"]
                    codes.append(main(["solve", *words, *more]))
                out = str(tmp_path / "o.mkv")
                words = [str(clip), "-o", out, "--track", str(track), *QUICK_FLAGS]
                codes.append(main(["animate", *words, "--progress", "none", "--overwrite"]))
                codes.append(main(["join", str(track), "-o", str(track), "--overwrite"]))

    solve_to(track, clip, progress=Second())
    assert codes == [4, 4, 4, 4, 2]
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 5
    assert all("another run is writing it" in line for line in lines[:4])
    with TrackReader(track) as reader:
        reader.check()
        assert len(reader.rows) == COUNT
        assert reader.header.finished
    assert sorted(tmp_path.iterdir()) == [clip, track]


def test_two_drawings_of_one_film(tmp_path: Path, capsys) -> None:
    """`render` and `animate` keep their output to themselves; stills are free for many machines."""
    clip, track = write_clip(tmp_path / "in.mp4"), tmp_path / "t.mtrk"
    solve_to(track, clip, "0-2")
    samples.write_still(tmp_path / "p.png", samples.picture(64, 48, 0))
    output = tmp_path / "o.mkv"
    with alone(output):
        for command, source in (("render", track), ("animate", tmp_path / "p.png")):
            assert main([command, str(source), "-o", str(output), "--progress", "none"]) == 4
            assert "another run is writing it" in capsys.readouterr().err
    stills = str(tmp_path / "s_##.png")
    with alone(Path(stills)):
        assert main(["render", str(track), "-o", stills, "--progress", "none"]) == 0


def test_threads_may_try_one_folder(tmp_path: Path) -> None:
    """None takes away what another has just made to see whether it can."""
    usual = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        with ThreadPoolExecutor(8) as pool:
            list(pool.map(check_folder, [tmp_path / f"{n}.mtrk" for n in range(400)]))
    finally:
        sys.setswitchinterval(usual)
    assert not list(tmp_path.iterdir())
