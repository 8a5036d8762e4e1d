"""Maps of weights: what is read, what is refused, whose frame gets which, and what they change."""

from contextlib import closing
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from pipeline.cli import main
from pipeline.loop.animate import animate
from pipeline.progress import Progress
from stages.focus.none import NoFocus
from stages.frame import Frame
from stages.masks.weight_maps import WeightMap
from stages.media import FrameRange, open_decoder
from stages.topology.refine_options import RefineOptions
from stages.triangulate_options import TriangulateOptions
from tests import media_samples as samples
from tests.jobs import job_of
from tests.kernel_samples import frame_of
from warp_kernels.errors import MediaError
from warp_kernels.styles import STYLES

SIZE = (48, 32)
QUICK = TriangulateOptions(iterations=16, frame_iterations=2, refine=RefineOptions(triangles=40))


def level(value: int, size: tuple[int, int] = SIZE) -> np.ndarray:
    """A picture of one grey, [H, W, 3] uint8."""
    return np.full((size[1], size[0], 3), value, dtype=np.uint8)


def ramp() -> np.ndarray:
    """A picture of the greys 0 to 255 and back, [H, W, 3] uint8."""
    width, height = SIZE
    greys = np.linspace(0, 255, width * height).astype(np.uint8).reshape(height, width)
    return np.repeat(greys[..., None], 3, axis=2)


def source_frames(*numbers: int) -> list[Frame]:
    """Frames of the source with these numbers."""
    return [frame_of(level(9), number) for number in numbers]


def read_still(path: Path) -> np.ndarray:
    """The weights that a still gives, [H, W] uint8."""
    (frame,) = source_frames(0)
    return WeightMap(str(path), SIZE, FrameRange()).weighed(frame).weights


def read_numbers(path: Path, frame_range: FrameRange, *numbers: int) -> list[int]:
    """Weight of the first pixel for each frame of the source."""
    with closing(WeightMap(str(path), SIZE, frame_range)) as weights:
        frames = [weights.weighed(frame) for frame in source_frames(*numbers)]
    return [int(frame.weights[0, 0]) for frame in frames]


def write_stills(folder: Path, numbers: range) -> Path:
    """Numbered stills, each as light as ten times its number and one."""
    for number in numbers:
        samples.write_still(folder / f"w_{number:04d}.png", level(10 * number + 1))
    return folder / "w_####.png"


def write_levels(path: Path, values: list[int], size: tuple[int, int] = SIZE) -> Path:
    """A video without loss, one grey for each frame."""
    pictures = [level(value, size) for value in values]
    return samples.write_video(path, pictures, codec="ffv1", pixel_format="gray")


def test_still_gives_its_greys_to_every_frame(tmp_path: Path) -> None:
    """Grey is weight, black is one, and all frames share one array."""
    path = samples.write_still(tmp_path / "w.png", ramp())
    np.testing.assert_array_equal(read_still(path), np.maximum(ramp()[..., 0], 1))
    frames = list(map(WeightMap(str(path), SIZE, FrameRange()).weighed, source_frames(3, 4, 9)))
    assert [frame.index for frame in frames] == [3, 4, 9]
    assert frames[0].weights is frames[2].weights
    assert frames[0].weights.min() == 1


@pytest.mark.parametrize("layout", ["gray", "gray16le", "rgb48le", "rgba"])
def test_stills_of_other_kinds(layout: str, tmp_path: Path) -> None:
    """One channel, 16 bits, and a transparency that hides nothing."""
    pixels = ramp()
    if layout.startswith("gray"):
        pixels = pixels[..., 0]
    if "16" in layout or "48" in layout:
        pixels = pixels.astype(np.uint16) * 257
    if layout == "rgba":
        pixels = np.dstack([pixels, np.full(pixels.shape[:2], 255, np.uint8)])
    path = samples.write_still(tmp_path / "w.png", np.ascontiguousarray(pixels), layout)
    expected = np.maximum(ramp()[..., 0], 1).astype(int)
    assert np.abs(read_still(path) - expected).max() <= ("16" in layout or "48" in layout)


def test_transparent_parts_count_least(tmp_path: Path) -> None:
    """White painted on an empty layer: what was not painted is black, and a note says so."""
    pixels = np.full((SIZE[1], SIZE[0], 4), 255, np.uint8)
    pixels[:, 10:20, 3], pixels[:, 20:, 3] = 128, 0
    path = samples.write_still(tmp_path / "w.png", pixels, "rgba")
    weights = WeightMap(str(path), SIZE, FrameRange())
    (frame,) = map(weights.weighed, source_frames(0))
    assert frame.weights[0, [0, 15, 40]].tolist() == [255, 128, 1]
    assert any("over black" in note for note in weights.notes)


def test_nearly_grey_is_grey(tmp_path: Path) -> None:
    """Channels may differ by the rounding of other programs, and by no more."""
    pixels = ramp() // 2
    pixels[..., 0] += 2
    assert read_still(samples.write_still(tmp_path / "a.png", pixels)).max() == 127
    pixels[0, 0, 0] += 1
    with pytest.raises(MediaError, match="not grey"):
        read_still(samples.write_still(tmp_path / "b.png", pixels))


def test_compressed_grey_is_grey(tmp_path: Path) -> None:
    """Strong compression of a grey clip, stored as brightness and colour."""
    pictures = [np.roll(ramp(), 5 * n, axis=1) for n in range(3)]
    path = samples.write_video(tmp_path / "w.mp4", pictures, options={"crf": "35"})
    with closing(WeightMap(str(path), SIZE, FrameRange())) as weights:
        frames = list(map(weights.weighed, source_frames(0, 1, 2)))
    for frame, picture in zip(frames, pictures, strict=True):
        assert np.abs(frame.weights.astype(int) - picture[..., 0]).mean() < 12


@pytest.mark.parametrize("name", ["w.png", "w.mp4"])
def test_colour_is_refused(name: str, tmp_path: Path) -> None:
    """A picture of colours is no map of weights."""
    path, pixels = tmp_path / name, samples.picture(*SIZE)
    if name == "w.png":
        samples.write_still(path, pixels)
    else:
        samples.write_video(path, [pixels, pixels])
    with pytest.raises(MediaError, match=r"w\.\w+: the weights are not grey .*; convert"):
        read_numbers(path, FrameRange(), 0, 1)


def test_size_is_that_of_the_upright_picture(tmp_path: Path) -> None:
    """Both sizes are named; a map that lies on its side stands up first."""
    path = write_levels(tmp_path / "w.mkv", [1, 2], (40, 32))
    with pytest.raises(MediaError, match=r"40x32 and the source is 48x32; scale the map to 48x32"):
        WeightMap(str(path), SIZE, FrameRange())
    pictures = [level(50, SIZE[::-1])] * 2
    lying = samples.write_video(tmp_path / "w.mp4", pictures, rotation=90)
    assert read_numbers(lying, FrameRange(), 0, 1) == pytest.approx([50, 50], abs=3)


def test_black_is_refused_or_told(tmp_path: Path) -> None:
    """A black still is a mistake; a clip may be black for a while, and is told if it stays so."""
    with pytest.raises(MediaError, match="black all over; paint"):
        read_still(samples.write_still(tmp_path / "w.png", level(0)))
    for values, told in (([0, 0, 7], 0), ([0, 0, 0], 1)):
        path = write_levels(tmp_path / "w.mkv", values)
        weights = WeightMap(str(path), SIZE, FrameRange())
        for frame in source_frames(0, 1, 2):
            weights.weighed(frame)
        weights.close()
        assert len(weights.warnings) == told


@pytest.mark.parametrize("kind", ["stills", "video"])
def test_frames_are_matched_by_number(kind: str, tmp_path: Path) -> None:
    """Any range of the source takes the weights of the same numbers."""
    path = tmp_path / "w.mkv"
    if kind == "video":
        write_levels(path, [10 * n + 1 for n in range(8)])
    else:
        path = write_stills(tmp_path, range(8))
    assert read_numbers(path, FrameRange(), *range(8)) == [10 * n + 1 for n in range(8)]
    assert read_numbers(path, FrameRange(2, 4), 2, 3, 4) == [21, 31, 41]
    assert read_numbers(path, FrameRange(1, None, 3), 1, 4, 7) == [11, 41, 71]
    late = FrameRange(start_time=Fraction(3), end_time=Fraction(4))  # of a slow source
    assert read_numbers(path, late, 3, 4) == [31, 41]
    assert read_numbers(path, FrameRange(), 2, 5) == [21, 51]  # damage left 3 and 4 out


def test_map_that_ends_before_the_clip(tmp_path: Path) -> None:
    """The frame without weights, the last one with, and what to do."""
    for path in (write_levels(tmp_path / "w.mkv", [9, 9, 9]), write_stills(tmp_path, range(3))):
        with pytest.raises(MediaError, match=r"for frame 3 of .* for frame 2; add .*A-2") as error:
            read_numbers(path, FrameRange(), *range(5))
        assert str(path) in str(error.value)
        with pytest.raises(MediaError, match="for frame 6 of the source"):
            read_numbers(path, FrameRange(first=6), 6, 7)


def test_stills_that_begin_late_or_lack_one(tmp_path: Path) -> None:
    """Numbers are not shifted, and gaps are named."""
    path = write_stills(tmp_path, range(1, 6))
    with pytest.raises(MediaError, match="no weights for frame 0 of the source"):
        read_numbers(path, FrameRange(), 0, 1, 2)
    (tmp_path / "w_0003.png").unlink()
    with pytest.raises(MediaError, match=r"w_0003\.png: is missing"):
        read_numbers(path, FrameRange(first=1), 1, 2, 3)
    (tmp_path / "w_0003.png").write_bytes(b"not a picture")
    with pytest.raises(MediaError, match=r"for frame 3 .*left out: .*w_0003\.png"):
        read_numbers(path, FrameRange(first=1), 1, 2, 3)


@pytest.mark.parametrize(
    ("weights", "word"),
    [
        ("missing.png", "missing.png: no such file"),
        ("text.png", "text.png: no frame of its png"),
        ("none_##.png", "none_##.png: no still"),
        ("small.png", "scale the map to 48x32"),
        ("colour.png", "not grey"),
        ("black.png", "black"),
        ("short.mkv", "for frame 2 of the source"),
    ],
)
def test_mistakes_are_one_line(
    weights: str, word: str, tmp_path: Path, monkeypatch, capsys
) -> None:
    """Exit code 3, and nothing written, even where the mistake comes late."""
    monkeypatch.chdir(tmp_path)
    samples.write_video(Path("in.mp4"), [samples.picture(*SIZE, n) for n in range(5)])
    Path("text.png").write_text("no picture\n")
    samples.write_still(Path("small.png"), level(9, (8, 8)))
    samples.write_still(Path("colour.png"), samples.picture(*SIZE))
    samples.write_still(Path("black.png"), level(0))
    write_levels(Path("short.mkv"), [5, 6])
    before = sorted(tmp_path.rglob("*"))
    quick = ["--triangles", "20", "--iterations", "8", "--progress", "none", "--weights"]
    assert main(["animate", "in.mp4", "-o", "out.mp4", *quick, weights]) == 3
    captured = capsys.readouterr()
    assert captured.err.startswith("trimotion: error: ")
    assert captured.err.count("\n") == 1
    assert word in captured.err
    assert sorted(tmp_path.rglob("*")) == before


def test_every_frame_has_the_weights_of_its_number(tmp_path: Path) -> None:
    """The half that is white in its own map gains, whatever the maps of others say."""
    picture = texture()
    source = samples.write_video(tmp_path / "in.mkv", [picture] * 6, codec="ffv1")
    for number in range(6):
        half = np.full_like(picture, 1)
        half[:, 80 * (number in (3, 4)) :][:, :80] = 255
        samples.write_still(tmp_path / f"w_{number:02d}.png", half)
    wanted = TriangulateOptions(iterations=60, refine=RefineOptions(triangles=120))
    options = {"triangulate": wanted, "weights": str(tmp_path / "w_##.png"), "independent": True}
    job = job_of(source, tmp_path / "out_##.png", frame_range=FrameRange(1, 5, 2), **options)
    assert animate(job, Progress()).frames == 3
    for number in (1, 3, 5):
        left, right = halves_rmse(picture, tmp_path / f"out_{number:02d}.png")
        white, black = (right, left) if number == 3 else (left, right)
        assert white < 0.8 * black


def test_no_map_asks_for_no_weights(tmp_path: Path) -> None:
    """Without the option, and without a face, everything is as if nothing counted more."""
    source = samples.write_still(tmp_path / "in.png", samples.picture(*SIZE))
    for name, focus in (("auto", ()), ("none", (NoFocus(),))):
        job = job_of(source, tmp_path / f"{name}.png", triangulate=QUICK, focus=focus)
        animate(job, Progress())
    assert (tmp_path / "auto.png").read_bytes() == (tmp_path / "none.png").read_bytes()


def test_told_error_is_that_of_all_pixels(tmp_path: Path) -> None:
    """With a map as without: the rmse of the drawn picture, before it is rounded and smoothed."""
    picture = texture()
    source = samples.write_still(tmp_path / "in.png", picture)
    half = np.full_like(picture, 10)
    half[:, :80] = 255
    weights = str(samples.write_still(tmp_path / "map.png", half))
    job = job_of(source, tmp_path / "out.png", triangulate=QUICK, weights=weights)
    told = animate(job, Progress()).mean_rmse
    assert told == pytest.approx(
        np.sqrt((halves_rmse(picture, job.output.path) ** 2).mean()), rel=0.1
    )


@pytest.mark.parametrize("wrong", [np.ones((3, 3), np.uint8), np.ones((32, 48), np.float32)])
def test_frame_refuses_other_weights(wrong: np.ndarray) -> None:
    """Another shape or type is a mistake of the caller."""
    with pytest.raises(ValueError, match="weights"):
        Frame(0, 0, Fraction(1), level(1), wrong)


def texture() -> np.ndarray:
    """Soft random texture whose right half mirrors its left one, [120, 160, 3] uint8."""
    half = gaussian_filter(np.random.default_rng(3).normal(size=(120, 80, 3)), (5, 5, 0))
    half = np.clip(128 + 45 * half / half.std(), 0, 255).astype(np.uint8)
    return np.concatenate([half, half[:, ::-1]], axis=1)


def halves_rmse(picture: np.ndarray, path: Path) -> np.ndarray:
    """Error of an output in the left half and in the right one [code values]."""
    with open_decoder(path) as decoder:
        squares = (next(decoder).pixels.astype(float) - picture) ** 2
    return np.sqrt([squares[:, :80].mean(), squares[:, 80:].mean()])


@pytest.mark.parametrize("style", ["flat", "gradient"])
def test_white_half_is_approximated_better(style: str, tmp_path: Path) -> None:
    """Alike without a map; with one the white half gains clearly, at the other's expense."""
    picture = texture()
    source = samples.write_still(tmp_path / "in.png", picture)
    left = np.zeros_like(picture)
    left[:, :80] = 255
    maps = {"even": None, "left": samples.write_still(tmp_path / "map.png", left)}
    errors = {}
    for name, weights in maps.items():
        wanted = TriangulateOptions(iterations=120, refine=RefineOptions(triangles=200))
        job = job_of(
            source,
            tmp_path / f"{name}.png",
            triangulate=wanted,
            styles=(STYLES[style](),),
            weights=weights and str(weights),
        )
        animate(job, Progress())
        errors[name] = halves_rmse(picture, job.output.path)
    assert errors["even"][0] == pytest.approx(errors["even"][1], rel=0.1)
    assert errors["left"][0] < 0.9 * errors["even"][0]
    assert errors["left"][1] > errors["even"][1]


def test_white_map_changes_nothing_but_rounding(tmp_path: Path) -> None:
    """All white: about the error of a run without a map, also in later frames."""
    pictures = [np.roll(texture(), n, axis=1) for n in range(3)]
    source = samples.write_video(tmp_path / "in.mp4", pictures, options={"crf": "10"})
    white = samples.write_still(tmp_path / "white.png", level(255, (160, 120)))
    jobs = [job_of(source, tmp_path / f"{w is None}.mp4", triangulate=QUICK, weights=w)
            for w in (None, str(white))]  # fmt: skip
    even, weighted = (animate(job, Progress()).mean_rmse for job in jobs)
    assert weighted == pytest.approx(even, rel=0.05)
