"""Ranges are exact: killed, resumed, split or solved side by side, a track has the same bits."""

import json
import os
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest

from pipeline.cli import main
from pipeline.loop.animate import animate, solve
from pipeline.loop.plan import plan
from pipeline.loop.ranges import Part, Work
from pipeline.loop.result import Animated
from pipeline.options.solve_options import SolveOptions
from pipeline.progress import Progress
from pipeline.track import TrackReader, join
from stages.media import FrameRange
from tests import media_samples as samples
from tests.jobs import job_of
from tests.tracks import COUNT, CUT, QUICK, QUICK_FLAGS, InTurn, rows_of, solve_to, write_clip
from warp_kernels.errors import OptionError

ROOT = Path(__file__).parents[1]
KILL = """
import os, signal, sys
from pathlib import Path
from pipeline.progress import Progress
from tests.tracks import solve_to

class Deadly(Progress):
    def frame(self, done, total, triangles, rmse):
        if done == 9:
            os.kill(os.getpid(), signal.SIGKILL)

solve_to(Path(sys.argv[2]), Path(sys.argv[1]), progress=Deadly())
"""


@pytest.fixture(scope="module")
def clip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The clip."""
    return write_clip(tmp_path_factory.mktemp("resume") / "in.mp4")


@pytest.fixture(scope="module")
def whole(clip: Path) -> Path:
    """The track of the whole clip, made at once."""
    track = clip.with_name("whole.mtrk")
    solve_to(track, clip)
    return track


class Interrupting(Progress):
    """Ctrl-C after some frames."""

    def __init__(self, after: int) -> None:
        super().__init__()
        self.after = after

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Interrupt at the frame."""
        if done == self.after:
            raise KeyboardInterrupt


class Counting(Progress):
    """Keeps what it is told."""

    def __init__(self) -> None:
        super().__init__()
        self.told: list[tuple[int, int | None]] = []

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Keep the count."""
        self.told.append((done, total))


def test_rows_tell_frames_and_shots(whole: Path) -> None:
    """One row a frame, the cut where it is, topologies stored only where they change."""
    rows = rows_of(whole)
    assert [row[0] for row in rows["frames"]] == list(range(COUNT))
    assert [row[2] for row in rows["frames"]] == [0] * CUT + [CUT] * (COUNT - CUT)
    brought = [row[0] for row in rows["topologies"]]
    assert {0, CUT} <= set(brought)
    assert [row[3] for row in rows["frames"]] == [
        max(frame for frame in brought if frame <= number) for number in range(COUNT)
    ]


@pytest.mark.parametrize(
    ("last", "from_start"),
    [(0, True), (CUT - 1, False), (CUT, True), (CUT + 1, False), (COUNT - 1, True)],
)
def test_two_ranges_are_the_whole(
    last: int, from_start: bool, clip: Path, whole: Path, tmp_path: Path
) -> None:
    """A track goes on to the same bits wherever it ended: also around a cut."""
    track = tmp_path / "t.mtrk"
    assert solve_to(track, clip, f"0-{last}").frames == last + 1
    more = "0-" if from_start else f"{min(last + 1, COUNT - 1)}-{COUNT - 1}"
    again = solve_to(track, clip, more, resume=True)
    assert again.frames == COUNT - 1 - last
    assert rows_of(track) == rows_of(whole)
    with TrackReader(track) as reader:
        assert reader.header.finished


def test_other_threads_resume_to_the_same_bits(clip: Path, whole: Path, tmp_path: Path) -> None:
    """What does not change the result may change: threads, names, where the source lies."""
    moved = tmp_path / "moved.mp4"
    moved.write_bytes(clip.read_bytes())
    solve_to(tmp_path / "t.mtrk", clip, "0-4", threads=3)
    solve_to(tmp_path / "t.mtrk", moved, resume=True, threads=2)
    assert rows_of(tmp_path / "t.mtrk") == rows_of(whole)


def test_steps_and_times_resume(clip: Path, tmp_path: Path) -> None:
    """Every second frame, and a range that is bounded by times."""
    for name, frames in (("a", "1-"), ("b", "1-5")):
        solve_to(tmp_path / f"{name}.mtrk", clip, f"{frames}x2")
    solve_to(tmp_path / "b.mtrk", clip, "1-x2", resume=True)
    assert rows_of(tmp_path / "a.mtrk") == rows_of(tmp_path / "b.mtrk")
    assert [row[2] for row in rows_of(tmp_path / "a.mtrk")["frames"]] == [1, 1, 1, 7, 7, 7]
    times = ["--start", "0.16", "--end", "0.36", *QUICK_FLAGS, "--progress", "none"]
    solve_to(tmp_path / "c.mtrk", clip, "4-9")
    assert main(["solve", str(clip), "-o", str(tmp_path / "d.mtrk"), *times]) == 0
    assert rows_of(tmp_path / "c.mtrk") == rows_of(tmp_path / "d.mtrk")


def test_sequence_resumes(tmp_path: Path) -> None:
    """Numbered stills, with a gap before the range."""
    for number in (1, 5, 6, 7, 8):
        samples.write_still(tmp_path / f"s_{number}.png", samples.picture(64, 48, number))
    for name, frames in (("a", "5-8"), ("b", "5-6")):
        solve_to(tmp_path / f"{name}.mtrk", tmp_path / "s_%01d.png", frames)
    solve_to(tmp_path / "b.mtrk", tmp_path / "s_%01d.png", "7-8", resume=True)
    assert rows_of(tmp_path / "a.mtrk") == rows_of(tmp_path / "b.mtrk")


def test_interrupted_job_goes_on(clip: Path, whole: Path, tmp_path: Path) -> None:
    """An exception in the middle leaves a track that reads and continues."""
    track = tmp_path / "t.mtrk"
    with pytest.raises(KeyboardInterrupt):
        solve_to(track, clip, progress=Interrupting(8))
    with TrackReader(track) as reader:
        assert not reader.header.finished
        assert 1 <= len(reader.rows) <= 8
        assert reader.snapshot(len(reader.rows) - 1).rmse > 0
    solve_to(track, clip, resume=True)
    assert rows_of(track) == rows_of(whole)


def test_track_of_an_earlier_program_goes_on(clip: Path, whole: Path, tmp_path: Path) -> None:
    """Its header held a whole job: looks, outputs and threads beside what decides meshes."""
    track = tmp_path / "t.mtrk"
    solve_to(track, clip, "0-4")
    job = {"output": "o.mp4", "device": "auto", "threads": 7, "styles": [{"class": "Flat"}]}
    job |= {"regions": [], "output_size": None, "scale": 2.0, "blend": 0, "smooth": 0.0}
    job |= {"encode": {"class": "EncodeOptions"}, "track": "t.mtrk", "resume": False, "jobs": 2}
    with closing(sqlite3.connect(track)) as connection, connection:
        (text,) = connection.execute("SELECT value FROM header WHERE key = 'options'").fetchone()
        options = {**json.loads(text), **job, "class": "Job"}
        options["layout"]["class"], options["flow"]["class"] = "Importance", "Dis"
        update = "UPDATE header SET value = ? WHERE key = 'options'"
        connection.execute(update, (json.dumps(options),))
    with pytest.raises(OptionError, match="--seed 1 instead of 0"):
        solve_to(track, clip, resume=True, seed=1)
    solve_to(track, clip, resume=True)
    assert rows_of(track) == rows_of(whole)


def test_killed_process_goes_on(clip: Path, whole: Path, tmp_path: Path) -> None:
    """SIGKILL while frames are solved, stored and drawn."""
    track = tmp_path / "t.mtrk"
    run = subprocess.run([sys.executable, "-c", KILL, str(clip), str(track)], cwd=ROOT, check=False)
    assert run.returncode == -9
    with TrackReader(track) as reader:
        assert 1 <= len(reader.rows) < COUNT
    solve_to(track, clip, resume=True)
    assert rows_of(track) == rows_of(whole)


def test_range_inside_a_shot_says_so(clip: Path, tmp_path: Path) -> None:
    """A new mesh starts with it; a range that begins at a cut needs no word."""
    inside = solve_to(tmp_path / "a.mtrk", clip, "3-4")
    assert any("frame 3 is inside a shot" in note for note in inside.notes)
    at_cut = solve_to(tmp_path / "b.mtrk", clip, f"{CUT}-{CUT + 1}")
    assert not any("inside" in note for note in at_cut.notes)


def test_plan_follows_the_shots(clip: Path, capsys) -> None:
    """Ranges begin with shots, wherever the wanted frames begin."""
    job = SolveOptions(clip)
    assert plan(job).as_lines() == f"0-{CUT - 1}\n{CUT}-{COUNT - 1}"
    assert plan(job, 1).as_lines() == f"0-{COUNT - 1}"
    assert plan(job, 9).as_lines() == plan(job).as_lines()
    part = SolveOptions(clip, frame_range=FrameRange(CUT - 1, CUT + 2))
    assert plan(part).as_lines() == f"{CUT - 1}-{CUT - 1}\n{CUT}-{CUT + 2}"
    stepped = SolveOptions(clip, frame_range=FrameRange(1, None, 4))
    assert plan(stepped).as_lines() == "1-5x4\n9-9x4"
    assert main(["plan", str(clip), "--cuts", "none"]) == 0
    assert capsys.readouterr().out == f"0-{COUNT - 1}\n"


def test_joined_parts_are_the_whole(clip: Path, whole: Path, tmp_path: Path) -> None:
    """The ranges of a plan, solved apart, in any order."""
    parts = []
    for number, part in enumerate(plan(SolveOptions(clip)).ranges):
        parts.append(tmp_path / f"{number}.mtrk")
        solve_to(parts[-1], clip, str(part))
    join(parts[::-1], tmp_path / "joined.mtrk")
    assert rows_of(tmp_path / "joined.mtrk") == rows_of(whole)
    with TrackReader(tmp_path / "joined.mtrk") as reader:
        assert reader.header.finished
        assert reader.header.frame_range.is_whole  # so that it is drawn with all of the sound


def test_two_processes_are_one(clip: Path, whole: Path, tmp_path: Path) -> None:
    """Shots solved side by side, then drawn: one progress that counts to the end once, in order.

    Nothing is left beside the output and the track.
    """
    track, output, progress = tmp_path / "t.mtrk", tmp_path / "o.mkv", Counting()
    job = job_of(clip, output, track=track, triangulate=QUICK, jobs=2, threads=1)
    assert animate(job, progress).frames == COUNT
    assert progress.told == [(done, COUNT) for done in range(1, COUNT + 1)]
    assert rows_of(track) == rows_of(whole)
    assert sorted(tmp_path.iterdir()) == [output, track]


def test_one_after_the_other_is_one(clip: Path, whole: Path, tmp_path: Path) -> None:
    """Who solves the ranges is the caller's choice; progress counts all of them together."""
    track, progress = tmp_path / "t.mtrk", Counting()
    job = job_of(clip, track=track, triangulate=QUICK, threads=1)
    done = solve(job.solve, job.output, job.run, progress, runner=InTurn())
    assert done.frames == COUNT
    assert any("2 shots" in note for note in done.notes)
    assert progress.told == [(number, COUNT) for number in range(1, COUNT + 1)]
    assert rows_of(track) == rows_of(whole)
    assert list(tmp_path.iterdir()) == [track]


def test_failed_range_is_tried_again(clip: Path, whole: Path, tmp_path: Path) -> None:
    """What a runner loses half-way goes on from the track of its range, and so does the whole."""

    class Failing(InTurn):
        """Loses its second range after four frames."""

        def run(self, work: Work, parts: Sequence[Part], progress: Progress) -> Sequence[Animated]:
            """Solve one range, then half of the other."""
            super().run(work, parts[:1], progress)
            return super().run(work, parts[1:], Interrupting(4))

    track, progress = tmp_path / "t.mtrk", Counting()
    job = job_of(clip, track=track, triangulate=QUICK, threads=1)
    with pytest.raises(KeyboardInterrupt):
        solve(job.solve, job.output, job.run, Progress(), runner=Failing())
    assert len(list(track.with_name("t.mtrk.parts").glob("*.mtrk"))) == 2
    again = replace(job.output, resume=True)
    solve(job.solve, again, job.run, progress, runner=InTurn())
    assert rows_of(track) == rows_of(whole)
    assert CUT < progress.told[0][0] <= CUT + 5
    assert progress.told[-1] == (COUNT, COUNT)


def children_of(process: int) -> set[int]:
    """Processes that a process has started and that live."""
    found = Path(f"/proc/{process}/task/{process}/children")
    return {int(number) for number in found.read_text().split()}


def is_alive(process: int) -> bool:
    """Whether a process is still there, and more than a name."""
    try:
        return ") Z " not in Path(f"/proc/{process}/stat").read_text()
    except OSError:
        return False


def wait_for(condition: Callable[[], object], seconds: float) -> bool:
    """Wait for a condition to hold."""
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.1)
    return bool(condition())


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="no list of processes")
def test_processes_end_with_the_first(tmp_path: Path) -> None:
    """The first one is killed, which no process can tell others: they notice, at work and idle.

    One shot is long, the other is done soon, so that a process waits for its next task.
    """
    pictures = [samples.picture(96, 64, number) for number in range(150)]
    clip = samples.write_video(tmp_path / "in.mp4", [*pictures, *(255 - pictures[0],) * 2])
    track = tmp_path / "t.mtrk"
    command = [sys.executable, "-m", "pipeline.cli", "solve", clip, "-o", track, "--jobs", "2"]
    command += [*QUICK_FLAGS, "--frame-iterations", "48", "--threads", "1", "--progress", "none"]
    first = subprocess.Popen([*map(str, command)], cwd=ROOT)
    parts = track.with_name("t.mtrk.parts")
    try:
        assert wait_for(lambda: len(list(parts.glob("*.mtrk"))) == 2, 60)
        others = children_of(first.pid)
    finally:
        first.kill()
        first.wait()
    assert len(others) >= 2
    ended = wait_for(lambda: not any(map(is_alive, others)), 20)
    for process in filter(is_alive, others):
        os.kill(process, signal.SIGKILL)
    assert ended
    (longer,) = parts.glob("0-*.mtrk")
    with TrackReader(longer) as reader:
        assert len(reader.rows) < len(pictures)


def test_animate_goes_on_with_its_track(clip: Path, tmp_path: Path) -> None:
    """The output of a resumed job is that of one that was not interrupted, frame for frame."""
    jobs = []
    for name in ("a", "b"):
        out = tmp_path / f"{name}_##.png"
        part = FrameRange(4, 9)
        jobs.append(
            job_of(clip, out, frame_range=part, track=tmp_path / f"{name}.mtrk", triangulate=QUICK)
        )
    animate(jobs[0], Progress())
    with pytest.raises(KeyboardInterrupt):
        animate(jobs[1], Interrupting(4))
    flags = [
        "--frames",
        "4-9",
        "--track",
        str(jobs[1].output.track),
        "--resume",
        *QUICK_FLAGS,
        "--progress",
        "none",
    ]
    assert main(["animate", str(clip), "-o", str(jobs[1].output.path), *flags]) == 0
    assert rows_of(jobs[0].output.track) == rows_of(jobs[1].output.track)
    for number in range(4, 10):
        names = (tmp_path / f"{name}_{number:02d}.png" for name in ("a", "b"))
        assert len({name.read_bytes() for name in names}) == 1


def test_half_written_frame_is_undone(clip: Path, tmp_path: Path) -> None:
    """The power fails in the middle of a write: the journal beside the track mends it."""
    track, later = tmp_path / "t.mtrk", tmp_path / "later.mtrk"
    solve_to(track, clip, "0-7")
    before = rows_of(track)
    script = (
        "import os, sqlite3, sys\n"
        "c = sqlite3.connect(sys.argv[1], isolation_level=None)\n"
        "c.execute('PRAGMA cache_size = 1')\n"
        "c.execute('BEGIN IMMEDIATE')\n"
        "c.execute('UPDATE meshes SET vertices = zeroblob(90000)')\n"
        "os.kill(os.getpid(), 9)\n"
    )
    subprocess.run([sys.executable, "-c", script, str(track)], check=False)
    assert track.with_name("t.mtrk-journal").stat().st_size > 0
    with TrackReader(track) as reader:
        assert len(reader.rows) == 8
    assert rows_of(track) == before
    later.with_name("later.mtrk-journal").write_bytes(b"of an old track")
    solve_to(later, clip, "0-2")
    with TrackReader(later) as reader:
        assert reader.snapshot(2).rmse > 0
