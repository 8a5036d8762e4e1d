"""Grades and palettes: colours of triangles change, no bit without a change."""

import json
import struct
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

import trimotion
from pipeline.options.tones import parse_grade, parse_palette
from stages.look.paint import paint_of
from stages.toning.choices import Choices
from stages.toning.grade import Grade
from stages.toning.oklab_colors import to_codes, to_lab
from stages.toning.palette import Palette
from stages.toning.swatches import read_swatches
from stages.toning.tone import Tone, toned
from tests.meshes import random_mesh
from tests.snapshots import snapshot_with
from tests.tracks import write_clip
from warp_kernels.color_model import LINEAR, QUADRATIC, ColorModel
from warp_kernels.drawing.paint import Paint
from warp_kernels.errors import TrimotionError

QUICK = {"iterations": 8, "frame_iterations": 4, "triangles": 40, "focus": "none"}
COLORS = ((16.0, 32.0, 48.0), (255.0, 0.0, 128.0), (240.0, 240.0, 10.0))
SHOW = """
[[section]]
palette = "#123,#f08,#ff0:nearest"
[[section]]
from = "f4"
transition = "fade 2 frames"
palette = "sunset"
[curves]
"grade.exposure" = "0s: 0, f9: 1"
"palette.amount" = "0s: 1, f8: 0.5"
"""


def painted(model: ColorModel, seed: int = 3) -> Paint:
    """Triangles in colours by lot, none of them clipped."""
    rng = np.random.default_rng(seed)
    mesh = random_mesh(seed, 20)
    values = rng.uniform(-0.4, 0.4, (mesh.triangle_count, 3, model.term_count))
    values[:, :, 1:3] *= 2.0
    values[:, :, 3:] *= 0.01
    values[:, :, 0] = rng.uniform(90, 160, (mesh.triangle_count, 3))
    return paint_of(snapshot_with(mesh, values, model=model))


def at(paint: Paint, points: np.ndarray) -> np.ndarray:
    """Colours at a point of every triangle [N, 2], without curvatures."""
    away = points - paint.corners.mean(axis=1)
    shown = paint.colors + np.einsum("na,nac->nc", away, paint.gradients)
    return np.clip(shown, paint.limits[:, 0], paint.limits[:, 1])


def test_oklab_and_back() -> None:
    codes = np.random.default_rng(1).uniform(0, 255, (500, 3))
    assert to_codes(to_lab(codes)) == pytest.approx(codes, abs=1e-9)
    assert to_lab(np.array([255.0, 255.0, 255.0])) == pytest.approx([1, 0, 0], abs=1e-6)


def test_what_changes_nothing_gives_the_very_same_triangles() -> None:
    paint = painted(LINEAR)
    assert toned(paint, Tone(Grade())) is paint
    assert toned(paint, Tone(Grade(hue=360), Palette(COLORS, amount=0.0))) is paint


@pytest.mark.parametrize("model", [LINEAR, QUADRATIC], ids=lambda model: model.name)
def test_a_small_change_is_a_small_change(model: ColorModel) -> None:
    paint = painted(model)
    near = toned(paint, Tone(Grade(saturation=1.0001, exposure=1e-4, hue=0.01)))
    assert near.colors == pytest.approx(paint.colors, abs=0.2)
    assert near.gradients == pytest.approx(paint.gradients, abs=0.02)
    if paint.curvatures is not None:
        assert near.curvatures == pytest.approx(paint.curvatures, abs=0.02)


def test_grades_do_what_they_say() -> None:
    paint = painted(LINEAR)
    grey = toned(paint, Tone(Grade(saturation=0)))
    assert np.ptp(grey.colors, axis=1).max() < 1e-3
    assert np.ptp(grey.gradients, axis=2).max() < 1e-3
    light = 255 * (toned(paint, Tone(Grade(exposure=0.5))).colors > paint.colors)
    assert light.all()
    flat = to_lab(toned(paint, Tone(Grade(contrast=0))).colors)
    assert flat[:, 0] == pytest.approx(0.5, abs=0.01)  # but for what no screen shows


def test_gradients_run_between_changed_corners() -> None:
    paint, palette = painted(LINEAR), Palette(COLORS)
    found = toned(paint, Tone(Grade(), palette))
    changes = [at(found, paint.corners[:, k]) - at(found, paint.corners[:, 0]) for k in (1, 2)]
    for k, change in zip((1, 2), changes, strict=True):
        ends = [at(paint, paint.corners[:, c]) for c in (k, 0)]
        wanted = [np.clip(to_codes(palette.applied(to_lab(end), None)), 0, 255) for end in ends]
        assert np.abs(change - (wanted[0] - wanted[1])).mean() < 12
    stops = to_codes(palette.applied(np.linspace([0, 0, 0], [1, 0, 0], 400), None))
    for corner in range(3):
        shown = at(found, paint.corners[:, corner])
        away = np.abs(shown[:, None] - stops[None]).max(axis=2).min(axis=1)
        assert np.median(away) < 8  # between colours of the palette, not beyond


def test_nearest_shows_the_colours_alone_and_holds_them() -> None:
    paint, palette = painted(LINEAR), Palette(COLORS, mode="nearest", hold=0.05)
    tone = Tone(Grade(), palette)
    found = toned(paint, tone)
    assert not found.gradients.any()
    assert {tuple(color) for color in np.rint(found.colors)} <= set(COLORS)
    lab = np.array([[0.5, 0.0, 0.0]])
    grey = Palette(((0.0, 0.0, 0.0), (255.0, 255.0, 255.0)), mode="nearest", hold=0.05)
    choices, ids, taken = Choices.none(), np.array([7]), []
    for light in (0.49, 0.51, 0.52, 0.53, 0.51, 0.49, 0.48, 0.47):
        choices = choices.followed_by(ids, lab * light / 0.5, grey)
        taken.append(int(choices.taken(ids, lab * light / 0.5, grey)[0]))
    assert taken == [0, 0, 0, 1, 1, 1, 1, 0]
    other = choices.followed_by(np.array([8]), 1.4 * lab, grey, lingering=2)
    assert other.taken(np.array([8, 7]), np.repeat(1.4 * lab, 2, axis=0), grey).tolist() == [1, 0]
    assert other.followed_by(np.array([8]), lab, grey, lingering=0).ids.tolist() == [8]


def test_a_range_is_the_whole(tmp_path: Path) -> None:
    clip, show = write_clip(tmp_path / "clip.mp4"), tmp_path / "show.toml"
    show.write_text(SHOW)
    track = tmp_path / "clip.mtrk"
    trimotion.solve(clip, track, **QUICK)

    def drawn(name: str, **options: object) -> dict[int, np.ndarray]:
        trimotion.render(track, tmp_path / f"{name}_##.png", **options)
        found = sorted(tmp_path.glob(f"{name}_??.png"))
        return {int(path.stem[-2:]): cv2.imread(str(path)) for path in found}

    for number, options in enumerate(({"timeline": show}, {"palette": "riso:nearest", "blend": 2})):
        whole = drawn(f"whole{number}", **options)
        part = drawn(f"part{number}", frames="5-7", **options)
        assert all(np.array_equal(pixels, whole[index]) for index, pixels in part.items())
    plain = drawn("plain", frames="5")
    assert np.array_equal(plain[5], drawn("same", frames="5", grade="saturation=1,hue=0")[5])
    assert not np.array_equal(plain[5], part[5])
    one = trimotion.triangulate(plain[5][..., ::-1].copy(), triangles=20, iterations=0)
    shown = one.draw(palette="#000,#fff:nearest")
    assert np.isin(shown, (0, 255)).mean() > 0.5


def written(path: Path) -> Path:
    """A palette in the form of a file's ending."""
    whole = [tuple(int(value) for value in color) for color in COLORS]
    words = ["#{:02x}{:02x}{:02x}".format(*color) for color in whole]
    rows = "".join("{:3d} {:3d} {:3d}\tx\n".format(*color) for color in whole)
    ase = b"".join(
        struct.pack(">HIHH", 1, 22, 1, 0) + b"RGB " + struct.pack(">3fH", *(v / 255 for v in c), 2)
        for c in whole
    )
    aco = b"".join(struct.pack(">H4H", 0, *(257 * value for value in c), 0) for c in whole)
    content = {
        ".txt": f"# mine\n{words[0]}\n\n{words[1].upper()}\n240 240 10\n".encode(),
        ".gpl": f"GIMP Palette\nName: x\nColumns: 3\n#\n{rows}".encode(),
        ".json": json.dumps({"colors": [words[0], list(whole[1]), {"hex": words[2]}]}).encode(),
        ".ase": struct.pack(">4sHHI", b"ASEF", 1, 0, 3) + ase,
        ".aco": struct.pack(">HH", 1, 3) + aco,
    }[path.suffix]
    path.write_bytes(content)
    return path


@pytest.mark.parametrize("ending", [".txt", ".gpl", ".json", ".ase", ".aco"])
def test_files_of_palettes(tmp_path: Path, ending: str) -> None:
    path = written(tmp_path / f"a{ending}")
    found = read_swatches(path)
    assert np.array(found) == pytest.approx(np.array(COLORS), abs=1e-3)
    assert len(parse_palette(f"{path}:nearest,amount=0.5").colors) == 3
    content = path.read_bytes()
    for broken in (b"", content[:9], content[: len(content) - 4] + b"zzzz", b"\xff\xfe\x00" * 9):
        path.write_bytes(broken)
        told = ""
        try:
            read_swatches(path)
        except TrimotionError as error:
            told = str(error)
        assert "\n" not in told
        assert str(path) in told or not told


def test_colours_of_a_picture(tmp_path: Path) -> None:
    picture = np.zeros((40, 60, 3), np.uint8)
    picture[:, :20], picture[:, 20:40], picture[:, 40:] = (10, 20, 200), (40, 160, 40), 250
    cv2.imwrite(str(tmp_path / "a.png"), picture[..., ::-1])
    palette = parse_palette(f"{tmp_path / 'a.png'}:count=3")
    assert palette.mode == "match"
    found = sorted(tuple(round(value) for value in color) for color in palette.colors)
    assert found == [(10, 20, 200), (40, 160, 40), (250, 250, 250)]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("#123", "one colour is no palette"),
        ("sunsett", "did you mean sunset"),
        ("#12,#fff", "colour '#12'"),
        ("none.gpl", "none.gpl: cannot be read"),
        ("#123,#fff:mode=nearst", "mode=nearst: choose from map, match, nearest"),
        ("#123,#fff:amount=2", "amount=2: must lie between 0 and 1"),
        ("#123,#fff:hold=x", "hold=x: write a number"),
        ("#123,#fff:count=3", "count is for the colours of a picture"),
        ("#123,#fff:amount=1,amount=1", "amount is given twice"),
    ],
)
def test_palettes_that_are_none(text: str, message: str) -> None:
    with pytest.raises(TrimotionError, match=message) as told:
        parse_palette(text)
    assert "\n" not in str(told.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("0.5", "write KEY=VALUE"),
        ("exposre=1", "a grade has no parameter 'exposre'; it has exposure, contrast"),
        ("contrast=9", "contrast=9: must lie between 0 and 4"),
        ("hue=red", "hue=red: write a number"),
    ],
)
def test_grades_that_are_none(text: str, message: str) -> None:
    with pytest.raises(TrimotionError, match=message):
        parse_grade(text)
    assert replace(parse_grade("hue=20"), hue=0.0) == Grade()
