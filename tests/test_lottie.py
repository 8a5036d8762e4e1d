"""Lottie: at each frame every triangle lies where it does, and players show what is drawn."""

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stages.exchange.figure import Figure
from stages.exchange.lottie.document import COLOR_TOLERANCE, OVERLAP, POINT_TOLERANCE
from stages.exchange.lottie.grown import MITRE, grown
from stages.exchange.lottie.keyframes import kept
from tests.films import figures_of, film_of, format_with, mixed_figures
from tests.meshes import HEIGHT, WIDTH, random_mesh, two_triangles
from tests.snapshots import snapshot_with
from warp_kernels.errors import OptionError

PLAYER = """
<body style="margin:0;background:#f0f"><div id="a" style="width:97px;height:64px"></div></body>
"""


def written(path: Path, figures: list[Figure]) -> Path:
    format_with(film_of(".json"), figures).save(path)
    return path


def valued(told: dict[str, Any], frame: float) -> np.ndarray:
    """A property at a frame: paths as their points."""
    if not told["a"]:
        return points_of(told["k"])
    times = [key["t"] for key in told["k"]]
    values = np.array([points_of(key["s"]) for key in told["k"]])
    flat = values.reshape(len(times), -1).T
    return np.array([np.interp(frame, times, row) for row in flat]).reshape(values.shape[1:])


def points_of(value: Any) -> np.ndarray:
    if isinstance(value, list) and isinstance(value[0], dict):
        (value,) = value
    return np.array(value["v"] if isinstance(value, dict) else value, np.float64)


def test_every_frame_has_its_triangles_where_they_are(tmp_path: Path) -> None:
    figures = mixed_figures()
    told = json.loads(written(tmp_path / "a.json", figures).read_text())
    assert (told["w"], told["h"], told["fr"], told["op"]) == (WIDTH, HEIGHT, 25, len(figures))
    assert [figure.index for figure in figures] == list(range(len(figures)))
    for figure in figures:
        seen = {}
        for layer in told["layers"][:-1]:
            if layer["ip"] <= figure.index < layer["op"]:
                for group in layer["shapes"]:
                    path, fill, _ = group["it"]
                    here = valued(path["ks"], figure.index), valued(fill["c"], figure.index)
                    seen[int(group["nm"])] = here
        mesh = figure.mesh
        assert sorted(seen) == sorted(mesh.triangle_ids.tolist())
        corners, colors = zip(*(seen[number] for number in mesh.triangle_ids.tolist()), strict=True)
        wanted = grown(mesh.corners, OVERLAP)
        np.testing.assert_allclose(np.array(corners), wanted, atol=POINT_TOLERANCE + 0.06)
        np.testing.assert_allclose(
            255 * np.array(colors), figure.colors, atol=COLOR_TOLERANCE + 0.2
        )


def test_grown_triangles_hold_the_old_ones() -> None:
    mesh = random_mesh(3)
    larger = grown(mesh.corners, OVERLAP)
    moved = np.linalg.norm(larger - mesh.corners, axis=2)
    assert OVERLAP * 0.99 < moved.min() <= moved.max() <= 1.01 * OVERLAP * MITRE
    sides = np.roll(larger, -1, axis=1) - larger
    for corner in range(3):
        away = mesh.corners[:, [corner]] - larger
        assert (sides[..., 0] * away[..., 1] - sides[..., 1] * away[..., 0] > -1e-9).all()


def test_keyframes_are_few_and_near_enough() -> None:
    times = np.arange(20.0)
    values = np.stack([2 * times, np.abs(times - 8)], axis=1)
    assert kept(times, values, 0.1) == [0, 8, 19]
    noisy = values + np.random.default_rng(1).uniform(-1, 1, values.shape)
    steps = kept(times, noisy, 1.5)
    assert len(steps) < 20
    for column in noisy.T:
        assert np.abs(np.interp(times, times[steps], column[steps]) - column).max() <= 1.5


def test_too_many_triangles_are_told_with_the_remedy() -> None:
    film = film_of(".json", lottie_limit=100)
    with pytest.raises(OptionError, match="use --triangles 100, or --lottie-limit 1"):
        format_with(film, mixed_figures())


def off_edges(picture: np.ndarray, figure: Figure) -> np.ndarray:
    """Differences between a player's picture and the triangles well inside of them."""
    mesh, found = figure.mesh, []
    y, x = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    for corners, color in zip(mesh.corners, figure.colors, strict=True):
        sides = np.roll(corners, -1, axis=0) - corners
        inside = np.ones(x.shape, bool)
        for (cx, cy), (sx, sy) in zip(corners, sides, strict=True):
            inside &= (sx * (y - cy) - sy * (x - cx)) / np.hypot(sx, sy) > 3
        found.append(np.abs(picture[inside].astype(int) - color).ravel())
    return np.concatenate(found)


def test_rlottie_shows_what_is_drawn(tmp_path: Path) -> None:
    rlottie = pytest.importorskip("rlottie_python", reason="pip install rlottie-python")
    figures = mixed_figures()
    with rlottie.LottieAnimation.from_file(str(written(tmp_path / "a.json", figures))) as player:
        for frame in (0, 2, 5):
            data = player.lottie_animation_render(frame)
            pixels = np.frombuffer(data, np.uint8).reshape(HEIGHT, WIDTH, 4)[..., [2, 1, 0]]
            off = off_edges(pixels, figures[frame])
            assert len(off) > 100
            assert off.max() <= 3


def test_the_published_schema_holds(tmp_path: Path) -> None:
    """Of the Lottie Animation Community (npm `@lottie-animation-community/lottie-specs`)."""
    schemas = pytest.importorskip("jsonschema", reason="pip install jsonschema")
    path = npm_file("@lottie-animation-community/lottie-specs", "src/data/lottie.schema.json")
    colors = np.array([[[9, 9, 9], [8, 8, 8]], [[9, 9, 9], [90, 8, 8]], [[1, 9, 9], [8, 8, 8]]])
    figures = figures_of(snapshot_with(two_triangles(), one, n) for n, one in enumerate(colors))
    told = json.loads(written(tmp_path / "a.json", figures).read_text())
    schemas.Draft202012Validator(json.loads(path.read_text())).validate(told)


def test_lottie_web_shows_what_is_drawn(tmp_path: Path) -> None:
    """In Chromium (npm `lottie-web`, PyPI `playwright`); starting it takes seconds."""
    browsers = pytest.importorskip("playwright.sync_api", reason="pip install playwright")
    script, chromium = (
        npm_file("lottie-web", "build/player/lottie.min.js"),
        shutil.which("chromium"),
    )
    if chromium is None:
        pytest.skip("no chromium on the path")
    image = pytest.importorskip("PIL.Image")
    figures = mixed_figures()
    told = json.loads(written(tmp_path / "a.json", figures).read_text())
    with browsers.sync_playwright() as program:
        flags = ["--no-sandbox", "--force-color-profile=srgb"]
        browser = program.chromium.launch(executable_path=chromium, args=flags)
        page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
        page.set_content(PLAYER)
        page.add_script_tag(content=script.read_text())
        page.evaluate(
            "told => { window.player = lottie.loadAnimation({container: a, renderer: 'svg', "
            "loop: false, autoplay: false, animationData: told}) }",
            told,
        )
        for frame in (0, 2, 5):
            page.evaluate(f"player.goToAndStop({frame}, true)")
            page.screenshot(path=str(tmp_path / "a.png"))
            pixels = np.asarray(image.open(tmp_path / "a.png").convert("RGB"))
            assert off_edges(pixels, figures[frame]).max() <= 3
        browser.close()


def npm_file(package: str, name: str) -> Path:
    """A file of a package that Node finds."""
    node = shutil.which("node")
    if node is not None:
        probe = "console.log(module.paths.concat(require('module').globalPaths).join('\\n'))"
        said = subprocess.run([node, "-e", probe], capture_output=True, text=True).stdout
        for folder in said.splitlines():
            if (Path(folder) / package / name).is_file():
                return Path(folder) / package / name
    pytest.skip(f"no {package}: npm install {package}, and NODE_PATH on its folder")
