"""Whole jobs: times and sound kept, cuts obeyed, every mesh valid, nothing left after a failure."""

import threading
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import av
import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from pipeline.loop.animate import animate
from pipeline.loop.result import Animated
from pipeline.options.job import Job
from pipeline.progress import Progress
from pipeline.track import TrackReader
from sample_videos.make_shapes import CUT_FRAME, FRAME_COUNT
from stages.flows.dis import Dis
from stages.flows.field import FlowField
from stages.flows.view import View
from stages.focus.none import NoFocus
from stages.layouts.grid import Grid
from stages.masks.region import Region
from stages.media import FrameRange, open_decoder
from stages.mesh import Mesh
from stages.snapshot import Snapshot
from stages.topology.refine_options import RefineOptions
from stages.triangulate_options import TriangulateOptions
from stages.validate import assert_valid
from tests import media_samples as samples
from tests.jobs import changed, job_of
from tests.kernel_samples import waves
from warp_kernels.errors import MediaError, OptionError, OutputError
from warp_kernels.styles import STYLES

SHAPES = Path(__file__).parents[1] / "sample_videos" / "shapes.mp4"
QUICK = TriangulateOptions(iterations=40, frame_iterations=6, refine=RefineOptions(triangles=120))


@dataclass(frozen=True)
class Recorded:
    """A job that ran."""

    job: Job
    result: Animated
    snapshots: list[Snapshot]
    shots: list[int]
    """The frames with which shots begin."""


def run(job: Job) -> Recorded:
    """Run a job and keep its snapshots: what its track holds."""
    with TemporaryDirectory() as folder:
        track = Path(folder) / "t.mtrk"
        result = animate(changed(job, track=track, threads=job.run.threads or 1), Progress())
        with TrackReader(track) as reader:
            snapshots = list(reader.snapshots(reader.rows))
            shots = list(reader.shots)
    for snapshot in snapshots:
        assert_valid(snapshot.mesh)
    return Recorded(job, result, snapshots, shots)


@pytest.fixture(autouse=True)
def _no_thread_stays() -> Iterator[None]:
    """Every job ends with the threads that ran ahead and behind, however it ends."""
    yield
    names = {thread.name for thread in threading.enumerate()}
    assert not names & {"trimotion-ahead", "trimotion-behind"}


@pytest.fixture(scope="module")
def shapes(tmp_path_factory: pytest.TempPathFactory) -> Recorded:
    """The whole drawn sample clip, converted once."""
    target = tmp_path_factory.mktemp("shapes") / "out.mp4"
    return run(job_of(SHAPES, target, triangulate=QUICK, scale=0.5, focus=(NoFocus(),)))


@pytest.fixture
def clip(tmp_path: Path) -> Path:
    """Six frames of 64 x 48 at uneven times."""
    pictures = [samples.picture(64, 48, number) for number in range(6)]
    pts = [0, 40, 90, 91, 400, 440]
    return samples.write_video(
        tmp_path / "in.mp4", pictures, pts=pts, time_base=samples.MILLISECOND
    )


def times_of(path: Path) -> list[Fraction]:
    """Times of all frames of a file [s]."""
    with open_decoder(path) as decoder:
        return [frame.pts * frame.time_base for frame in decoder]


def pixels_of(path: Path) -> list[np.ndarray]:
    """Pixels of all frames of a file."""
    with open_decoder(path) as decoder:
        return [frame.pixels for frame in decoder]


def leftovers(folder: Path, *known: Path) -> list[str]:
    """Names of files in a folder beside known ones."""
    return sorted(path.name for path in folder.iterdir() if path not in known)


def test_sample_keeps_its_times(shapes: Recorded) -> None:
    """Times in are times out, frame for frame."""
    assert shapes.result.frames == FRAME_COUNT == len(shapes.snapshots)
    assert times_of(shapes.job.output.path) == times_of(SHAPES)
    assert [snapshot.frame_index for snapshot in shapes.snapshots] == list(range(FRAME_COUNT))


def test_sample_keeps_its_sound(shapes: Recorded) -> None:
    """Audio packets are carried over byte for byte."""
    assert samples.sound_packets(shapes.job.output.path) == samples.sound_packets(SHAPES)
    assert len(samples.sound_packets(SHAPES)) > 100


def test_sample_has_the_wanted_triangles(shapes: Recorded) -> None:
    """Every frame has the number that was asked for, give or take one."""
    counts = [snapshot.mesh.triangle_count for snapshot in shapes.snapshots]
    assert min(counts) >= 119
    assert max(counts) <= 121


def test_sample_restarts_at_its_cut(shapes: Recorded) -> None:
    """The layout is made anew for the first frame and at the hard cut, nowhere else."""
    assert shapes.shots == [0, CUT_FRAME]


def test_sample_looks_like_its_source(shapes: Recorded) -> None:
    """The drawn frames are as near to the source as the fits say, at half the size."""
    drawn = pixels_of(shapes.job.output.path)
    assert {picture.shape for picture in drawn} == {(180, 320, 3)}
    source = pixels_of(SHAPES)
    for number in (0, CUT_FRAME - 1, CUT_FRAME, FRAME_COUNT - 1):
        halved = source[number].reshape(180, 2, 320, 2, 3).mean(axis=(1, 3))
        rmse = np.sqrt(((drawn[number] - halved) ** 2).mean())
        assert rmse < shapes.snapshots[number].rmse + 3.0
    mean = np.mean([snapshot.rmse for snapshot in shapes.snapshots])
    assert shapes.result.mean_rmse == pytest.approx(mean)


def test_ids_persist_within_a_shot(shapes: Recorded) -> None:
    """From frame to frame most vertices are the same ones, and numbers are never given twice."""
    for before, after in pairwise(shapes.snapshots):
        if after.frame_index != CUT_FRAME:
            kept = np.isin(before.mesh.vertex_ids, after.mesh.vertex_ids)
            assert kept.mean() > 0.8
            fresh = np.setdiff1d(after.mesh.vertex_ids, before.mesh.vertex_ids)
            assert (fresh >= before.mesh.next_vertex_id).all()


def test_uneven_times_are_kept(clip: Path, tmp_path: Path) -> None:
    """Variable frame rates stay what they are."""
    done = run(job_of(clip, tmp_path / "out.mp4", triangulate=QUICK))
    assert times_of(done.job.output.path) == times_of(clip)


def test_independent_starts_every_frame_anew(clip: Path, tmp_path: Path) -> None:
    """The baseline knows no frame before: each is what it would be if it were alone."""
    job = job_of(clip, tmp_path / "out.mp4", triangulate=QUICK, independent=True)
    together = run(job).snapshots
    for number in (0, 4):
        only = FrameRange(number, number)
        (alone,) = run(changed(job, path=tmp_path / f"{number}.mp4", frame_range=only)).snapshots
        np.testing.assert_array_equal(alone.mesh.vertices, together[number].mesh.vertices)


def test_part_of_a_clip(clip: Path, tmp_path: Path) -> None:
    """A range keeps the distances of its times and the numbers of its frames."""
    part = FrameRange(first=2, last=4)
    done = run(job_of(clip, tmp_path / "out.mp4", frame_range=part, triangulate=QUICK))
    assert [snapshot.frame_index for snapshot in done.snapshots] == [2, 3, 4]
    wanted = times_of(clip)[2:5]
    assert times_of(done.job.output.path) == [time - wanted[0] for time in wanted]


def test_listed_cuts_are_obeyed(clip: Path, tmp_path: Path) -> None:
    """A list of cuts restarts the layout where it says, `none` nowhere."""
    cuts = tmp_path / "cuts.json"
    cuts.write_text("[2, 5]")
    job = job_of(clip, tmp_path / "a.mp4", triangulate=QUICK, cuts=str(cuts))
    assert run(job).shots == [0, 2, 5]
    assert run(changed(job, path=tmp_path / "b.mp4", cuts="none")).shots == [0]


def test_still_becomes_a_still(tmp_path: Path) -> None:
    """A picture in, a picture out: opaque, with slopes, with holes, over the source."""
    source = samples.write_still(tmp_path / "in.png", waves(81, 55))
    for name in ("flat", "gradient", "circles", "source"):
        styles = (STYLES[name](),)
        job = job_of(source, tmp_path / f"{name}.png", triangulate=QUICK, styles=styles)
        assert run(job).result.frames == 1
        assert pixels_of(job.output.path)[0].shape == (55, 81, 3)


def test_sequence_is_numbered_like_the_source(clip: Path, tmp_path: Path) -> None:
    """Stills carry the numbers of the source's frames, and make a clip again."""
    folder = tmp_path / "frames"
    folder.mkdir()
    part = FrameRange(first=1, last=5, step=2)
    run(job_of(clip, folder / "f_%03d.png", frame_range=part, triangulate=QUICK))
    assert leftovers(folder) == ["f_001.png", "f_003.png", "f_005.png"]
    for number in (0, 1, 2):
        samples.write_still(folder / f"g_{number:02d}.png", samples.picture(64, 48, number))
    done = run(job_of(folder / "g_%02d.png", tmp_path / "again.mp4", triangulate=QUICK))
    assert done.result.frames == 3


def test_gradients_over_constant_optimisation(clip: Path, tmp_path: Path) -> None:
    """A style that needs slopes gets them although constants are optimised."""
    job = job_of(clip, tmp_path / "out.mp4", triangulate=QUICK, styles=(STYLES["gradient"](),))
    assert all(snapshot.model.degree == 1 for snapshot in run(job).snapshots)


def test_same_job_gives_the_same_frames(clip: Path, tmp_path: Path) -> None:
    """Twice, and with another number of threads: equal meshes; another seed: others."""
    job = job_of(clip, tmp_path / "a.mp4", triangulate=QUICK, threads=1)
    first = run(job)
    second = run(changed(job, path=tmp_path / "b.mp4", threads=3))
    for one, other in zip(first.snapshots, second.snapshots, strict=True):
        np.testing.assert_array_equal(one.mesh.vertices, other.mesh.vertices)
        np.testing.assert_array_equal(one.coefficients, other.coefficients)
    seeded = run(changed(job, path=tmp_path / "c.mp4", seed=1))
    assert not np.array_equal(seeded.snapshots[0].mesh.vertices, first.snapshots[0].mesh.vertices)


class Planted(Progress):
    """Fails at a frame."""

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Fail at the third frame."""
        if done == 3:
            raise KeyboardInterrupt


def test_interruption_leaves_nothing(clip: Path, tmp_path: Path) -> None:
    """Ctrl-C in the middle: no output, no temporary file, no thread."""
    with pytest.raises(KeyboardInterrupt):
        animate(job_of(clip, tmp_path / "out.mp4", triangulate=QUICK), Planted())
    assert leftovers(tmp_path, clip) == []


@dataclass(frozen=True)
class FailingFlow(Dis):
    """Fails between the second and the third frame, which happens ahead of the solution."""

    calls: list[int] = field(default_factory=list)

    def estimate(self, earlier: View, later: View) -> FlowField:
        """Fail when it is asked for the second time."""
        self.calls.append(1)
        if len(self.calls) == 2:
            raise RuntimeError("planted")
        return super().estimate(earlier, later)


@dataclass(frozen=True)
class FailingLayout(Grid):
    """Fails where a second shot begins, which is where frames are solved."""

    calls: list[int] = field(default_factory=list)

    def build(self, pixels: np.ndarray, triangles: int, rng: np.random.Generator) -> Mesh:
        """Fail when it is asked for the second time."""
        self.calls.append(1)
        if len(self.calls) == 2:
            raise RuntimeError("planted")
        return super().build(pixels, triangles, rng)


@pytest.mark.parametrize("place", ["ahead", "solving"])
def test_failure_anywhere_leaves_nothing(place: str, clip: Path, tmp_path: Path) -> None:
    """Estimating motion or triangulating fails: its own error, once, and nothing left."""
    job = job_of(clip, tmp_path / "out.mp4", triangulate=QUICK, layout=Grid())
    flow, layout = FailingFlow(), FailingLayout()
    if place == "ahead":
        job = changed(job, flow=flow)
    else:
        (tmp_path / "cuts.txt").write_text("3\n")
        job = changed(job, layout=layout, cuts=str(tmp_path / "cuts.txt"))
    with pytest.raises(RuntimeError, match="planted"):
        animate(job, Progress())
    assert len(flow.calls) + len(layout.calls) == 2
    assert leftovers(tmp_path, clip, tmp_path / "cuts.txt") == []


def test_failure_of_drawing_leaves_nothing(clip: Path, tmp_path: Path) -> None:
    """A mask that ends before the clip does is missed behind the solution."""
    short = samples.write_video(tmp_path / "mask.mp4", [samples.picture(64, 48)] * 2)
    job = job_of(clip, tmp_path / "out.mp4", triangulate=QUICK)
    with pytest.raises(MediaError, match="mask for frame 2"):
        animate(changed(job, regions=(Region(str(short), STYLES["edges"]()),)), Progress())
    assert leftovers(tmp_path, clip, short) == []


def test_existing_output_is_kept(clip: Path, tmp_path: Path) -> None:
    """Without --overwrite an existing file stays as it is."""
    target = tmp_path / "out.mp4"
    target.write_bytes(b"precious")
    with pytest.raises(OutputError, match="out"):
        animate(job_of(clip, target, triangulate=QUICK), Progress())
    assert target.read_bytes() == b"precious"


def test_range_beyond_the_end(clip: Path, tmp_path: Path) -> None:
    """A range without frames is an error that names it, and nothing is written."""
    job = job_of(clip, tmp_path / "out.mp4", frame_range=FrameRange(first=50), triangulate=QUICK)
    with pytest.raises(OptionError, match="frames 50-"):
        animate(job, Progress())
    assert leftovers(tmp_path, clip) == []


def test_translated_clip_moves_vertices_by_the_translation(tmp_path: Path) -> None:
    """A pan over a soft texture carries inner vertices along, frame by frame."""
    rng = np.random.default_rng(2)
    texture = gaussian_filter(rng.normal(size=(160, 220, 3)), (5, 5, 0))
    texture = np.clip(128 + 45 * texture / texture.std(), 0, 255).astype(np.uint8)
    step = np.array([3, 2])
    views = [texture[20 + 2 * n : 116 + 2 * n, 30 + 3 * n : 158 + 3 * n] for n in range(6)]
    source = samples.write_video(
        tmp_path / "in.mkv",
        [np.ascontiguousarray(view) for view in views],
        codec="ffv1",
        pixel_format="bgr0",
        time_base=samples.MILLISECOND,
    )
    wanted = replace(QUICK, iterations=200, frame_iterations=20)
    snapshots = run(job_of(source, tmp_path / "out.mp4", triangulate=wanted)).snapshots
    assert len(snapshots) == 6
    for before, after in pairwise(snapshots):
        _, old, new = np.intersect1d(
            before.mesh.vertex_ids, after.mesh.vertex_ids, return_indices=True
        )
        place, moved = before.mesh.vertices[old], after.mesh.vertices[new]
        inner = ((place > 16) & (place < (112, 80))).all(axis=1)
        assert inner.sum() > 20
        away = np.linalg.norm(moved[inner] - place[inner] + step, axis=1)
        assert np.median(away) < 0.3
        assert np.quantile(away, 0.9) < 1.5


def test_size_that_changes_the_shape(clip: Path, tmp_path: Path) -> None:
    """Any output size is filled, whatever its proportions."""
    job = job_of(clip, tmp_path / "out.mkv", triangulate=QUICK, output_size=(50, 90))
    run(job)
    with av.open(str(job.output.path)) as container:
        assert (container.streams.video[0].width, container.streams.video[0].height) == (50, 90)
