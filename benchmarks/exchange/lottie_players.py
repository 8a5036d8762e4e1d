"""How players show Lottie: a clip in lottie-web and in rlottie, beside what is drawn.

    python benchmarks/exchange/lottie_players.py [CLIP] [--first N] [--frames N] [--triangles N]

lottie-web runs in the `chromium` on the path (npm lottie-web, found by NODE_PATH; PyPI playwright),
rlottie is PyPI rlottie-python; what is missing is left out.
"""

import argparse
import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path

import cv2
import numpy as np

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

import trimotion  # noqa: E402
from benchmarks.exchange.compared import row  # noqa: E402

Show = Callable[[int, Path], None]
"""Shows a frame of the file, counted from its first, in a picture."""
SCRIPT = "lottie-web/build/player/lottie.min.js"
FLAGS = ["--no-sandbox", "--force-color-profile=srgb", "--hide-scrollbars"]
AROUND = 3
"""Pixels to each side that have one colour where a pixel is off the edges."""


@contextmanager
def lottie_web(file: Path, size: tuple[int, int]) -> Iterator[Show]:
    """The player of web pages, with its renderer of SVG."""
    from playwright.sync_api import sync_playwright

    (script, *_) = npm_files()
    with sync_playwright() as program:
        browser = program.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        page = browser.new_page(viewport={"width": size[0], "height": size[1]})
        style = f"width:{size[0]}px;height:{size[1]}px"
        page.set_content(f'<body style="margin:0"><div id="a" style="{style}"></div></body>')
        page.add_script_tag(content=script.read_text())
        page.evaluate(
            "told => { window.player = lottie.loadAnimation({container: a, renderer: 'svg', "
            "loop: false, autoplay: false, animationData: JSON.parse(told)}) }",
            file.read_text("utf-8"),
        )

        def _show(frame: int, picture: Path) -> None:
            page.evaluate(f"player.goToAndStop({frame}, true)")
            page.screenshot(path=str(picture))

        yield _show
        browser.close()


@contextmanager
def rlottie(file: Path, size: tuple[int, int]) -> Iterator[Show]:
    """The player of Telegram, Tizen and others."""
    from rlottie_python import LottieAnimation

    with LottieAnimation.from_file(str(file)) as player:

        def _show(frame: int, picture: Path) -> None:
            data = player.lottie_animation_render(frame)
            pixels = np.frombuffer(data, np.uint8).reshape(size[1], size[0], 4)
            cv2.imwrite(str(picture), pixels[..., :3])

        yield _show


def npm_files() -> list[Path]:
    """Where the script of lottie-web lies."""
    folders = [Path(folder) for folder in os.environ.get("NODE_PATH", "").split(os.pathsep)]
    return [folder / SCRIPT for folder in folders if (folder / SCRIPT).is_file()]


def players() -> Iterator[tuple[str, Callable]]:
    """Those that are here."""
    if npm_files() and shutil.which("chromium") and find_spec("playwright"):
        yield "lottie-web", lottie_web
    if find_spec("rlottie_python"):
        yield "rlottie", rlottie


def main() -> None:
    """Print the size and a row for each player and frame."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    clips = ROOT / "sample_videos"
    parser.add_argument("clip", nargs="?", type=Path, default=clips / "bigbuckbunny.mp4")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--frames", type=int, default=75)
    parser.add_argument("--triangles", type=int, default=300)
    parser.add_argument("--keep", type=Path)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as made:
        folder = given.keep or Path(made)
        folder.mkdir(parents=True, exist_ok=True)
        track, file = folder / "clip.mtrk", folder / "clip.json"
        frames = f"{given.first}-{given.first + given.frames - 1}"
        trimotion.solve(given.clip, track, triangles=given.triangles, frames=frames, overwrite=True)
        trimotion.render(track, file, styles="flat", overwrite=True)
        told = f"{given.triangles} triangles, {given.frames} frames"
        print(f"{given.clip.name}: {told}: {file.stat().st_size / 1e6:.2f} MB")
        looked_at = np.linspace(0, given.frames - 1, 4).astype(int).tolist()
        for frame in looked_at:
            own = folder / f"own_{frame}.png"
            number = given.first + frame
            trimotion.render(track, own, styles="flat", frames=number, overwrite=True)
        height, width = cv2.imread(str(own)).shape[:2]
        for name, player in players():
            with player(file, (width, height)) as show:
                for frame in looked_at:
                    found = folder / f"{name}_{frame}.png"
                    show(frame, found)
                    said = row(found, folder / f"own_{frame}.png", AROUND)
                    print(f"{name} frame {frame}: {said}", flush=True)


if __name__ == "__main__":
    main()
