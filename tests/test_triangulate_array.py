"""`triangulate`: an array in, triangles out, drawn and shown."""

import cv2
import numpy as np
import pytest

import trimotion
from pipeline.track import TrackReader
from stages.validate import assert_valid
from tests import media_samples as samples

QUICK: trimotion.PictureKeywords = {"triangles": 40, "iterations": 8, "threads": 1}
PIXELS = samples.picture(48, 32)

# (array, words of the message: what it is and what to do)
REFUSED = [
    (np.zeros((4, 5, 4), np.uint8), ["4x5x4", "pixels[..., :3]"]),
    (np.zeros((4, 5, 1), np.uint8), ["4x5x1", "pixels[..., 0]"]),
    (np.zeros((3, 4, 5), np.uint8), ["3x4x5", "[H, W, 3]"]),
    (np.zeros(7, np.uint8), ["7 uint8", "[H, W, 3]"]),
    (np.zeros((2, 4, 5, 3), np.uint8), ["2x4x5x3"]),
    (np.zeros((4, 5, 3)), ["float64", "(255 * pixels).round()"]),
    (np.zeros((4, 5), np.uint16), ["uint16", "0 to 255"]),
    (np.zeros((0, 5), np.uint8), ["0x5", "sides"]),
    (np.zeros((1, 8193), np.uint8), ["1x8193", "8192"]),
    (None, ["object"]),
    ("picture.png", ["no dimension"]),
]


@pytest.mark.parametrize(("array", "words"), REFUSED, ids=[str(w) for _, w in REFUSED])
def test_other_arrays_are_refused(array: object, words: list[str]) -> None:
    """With what they are and how to make a picture of them."""
    with pytest.raises(trimotion.OptionError) as caught:
        trimotion.triangulate(array)
    for word in ["pixels: ", *words]:
        assert word in str(caught.value)


@pytest.mark.parametrize("shape", [(1, 1), (1, 7), (5, 2)])
def test_small_pictures(shape: tuple[int, int]) -> None:
    """Down to a single pixel."""
    found = trimotion.triangulate(np.full(shape, 9, np.uint8), triangles=2, threads=1)
    assert found.size == (shape[1], shape[0])
    assert 9 in found.colors
    assert found.draw().shape == (*shape, 3)


def test_arrays_of_a_triangulation() -> None:
    """Shapes and kinds as documented; not to be written to; the mesh is valid."""
    found = trimotion.triangulate(PIXELS, **QUICK)
    V, T = len(found.vertices), len(found.triangles)
    assert found.vertices.shape == (V, 2)
    assert found.triangles.shape == found.colors.shape == (T, 3)
    assert (found.colors.dtype, found.vertices.dtype) == (np.uint8, np.float64)
    assert (len(found.vertex_ids), len(found.triangle_ids)) == (V, T)
    assert found.vertices.min(axis=0).tolist() == [0, 0]
    assert found.vertices.max(axis=0).tolist() == [48, 32]
    assert abs(T - 40) <= 1
    assert (found.frame, found.shot, found.time, found.size) == (0, 0, None, (48, 32))
    assert 0 < found.rmse < 60
    for array in (found.vertices, found.triangles, found.colors):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    assert f"{T} triangles" in repr(found)


def test_array_equals_still(tmp_path) -> None:
    """To the bit what `solve` makes of the same picture as a file."""
    still = samples.write_still(tmp_path / "still.png", PIXELS)
    for color in ("constant", "linear"):
        track = tmp_path / f"{color}.mtrk"
        trimotion.solve(still, track, color=color, **QUICK)
        found = trimotion.triangulate(PIXELS, color=color, **QUICK)
        with TrackReader(track) as reader:
            snapshot = reader.snapshot(0)
        assert_valid(snapshot.mesh)
        np.testing.assert_array_equal(found.vertices, snapshot.mesh.vertices)
        np.testing.assert_array_equal(found.triangles, snapshot.mesh.triangles)
        assert found.rmse == snapshot.rmse


def test_drawn_as_the_command_draws(tmp_path) -> None:
    """The same pixels for styles that need slopes, the picture or transparency, in another size."""
    still = samples.write_still(tmp_path / "still.png", PIXELS)
    found = trimotion.triangulate(PIXELS, **QUICK)
    for styles in (["flat"], ["gradient"], ["flat", "lenses"], ["edges:width=2"]):
        out = tmp_path / f"{'_'.join(styles)}.png"
        trimotion.animate(still, out, styles=styles, scale=2, **QUICK)
        written = cv2.imread(str(out), cv2.IMREAD_UNCHANGED)
        order = cv2.COLOR_BGRA2RGBA if written.shape[2] == 4 else cv2.COLOR_BGR2RGB
        np.testing.assert_array_equal(found.draw(styles, 2), cv2.cvtColor(written, order))


def test_grey_is_as_three_equal_channels() -> None:
    """[H, W] is [H, W, 3] of equal channels; arrays in other orders of memory are the same."""
    grey = PIXELS[..., 0]
    one = trimotion.triangulate(grey, **QUICK)
    three = trimotion.triangulate(np.stack([grey.T] * 3, axis=2).transpose(1, 0, 2), **QUICK)
    np.testing.assert_array_equal(one.vertices, three.vertices)
    assert (one.colors == one.colors[:, :1]).all()


def test_picture_is_copied() -> None:
    """The caller may go on with the array."""
    pixels = PIXELS.copy()
    found = trimotion.triangulate(pixels, **QUICK)
    before = found.draw("source")
    pixels[:] = 0
    np.testing.assert_array_equal(found.draw("source"), before)
    np.testing.assert_array_equal(before, PIXELS)


def test_weights_as_array_and_as_file(tmp_path) -> None:
    """The same to the bit; other arrays are refused."""
    weights = np.zeros((32, 48), np.uint8)
    weights[8:20, 10:30] = 255
    path = samples.write_still(tmp_path / "w.png", np.repeat(weights[..., None], 3, axis=2))
    array = trimotion.triangulate(PIXELS, weights=weights, **QUICK)
    file = trimotion.triangulate(PIXELS, weights=path, **QUICK)
    plain = trimotion.triangulate(PIXELS, **QUICK)
    np.testing.assert_array_equal(array.vertices, file.vertices)
    assert not np.array_equal(array.vertices, plain.vertices)
    for wrong, word in ((weights[:5], "32x48"), (weights * 1.0, "float64"), (0 * weights, "black")):
        with pytest.raises(trimotion.OptionError, match=word):
            trimotion.triangulate(PIXELS, weights=wrong, **QUICK)


@pytest.mark.parametrize(
    ("keywords", "word"),
    [
        ({"styles": "sparkle"}, "styles=sparkle"),
        ({"scale": 0}, "scale=0"),
        ({"scale": 2, "size": (3, 4)}, "size and scale"),
        ({"size": "x"}, "size"),
        ({"device": "gpu"}, "device=gpu"),
    ],
)
def test_impossible_drawing(keywords: dict, word: str) -> None:
    """Told as keywords."""
    found = trimotion.triangulate(PIXELS, **QUICK)
    with pytest.raises(trimotion.OptionError, match=word):
        found.draw(**keywords)


def test_notebook_shows_a_picture() -> None:
    """A PNG of what `draw` gives."""
    found = trimotion.triangulate(PIXELS, **QUICK)
    shown = cv2.imdecode(np.frombuffer(found._repr_png_(), np.uint8), cv2.IMREAD_COLOR)
    np.testing.assert_array_equal(shown[..., ::-1], found.draw())
