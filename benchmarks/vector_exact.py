"""How near SVG comes to the pictures that are drawn: every style, in every renderer that is here.

    python benchmarks/vector_exact.py [TRACK.mtrk ...] [--styles flat edges ...] [--keep FOLDER]

Renderers: resvg (PyPI resvg-py), Cairo (PyPI cairosvg) and Chromium (`chromium` on the path); those
that are missing are left out. A track is made of the sample picture if none is named. Two pictures
are compared with: what is drawn at the same size (`own`), whose pixels are means of 3 x 3 samples,
and the same drawn 4 times as large (`exact`), whose pixels are means of 12 x 12.
"""

import argparse
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import cv2
import numpy as np

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT))

import trimotion  # noqa: E402

STACKS = {
    "flat": ["flat"],
    "gradient": ["gradient"],
    "edges": ["flat", "edges"],
    "shrink": ["paper:color=#111,grain=0,sheets=0", "shrink"],
    "circles": ["paper:color=#111,grain=0,sheets=0", "circles"],
    "incircles": ["paper:color=#111,grain=0,sheets=0", "flat:opacity=0.3", "incircles"],
    "paper": ["paper:grain=0"],
}
"""Stacks of styles by a short name."""
FINER = 4
"""How many times as large the picture is drawn that is taken for exact."""
NEAR = 2
"""Code values."""


def resvg(svg: Path, scale: int) -> np.ndarray:
    import resvg_py

    return read(bytes(resvg_py.svg_to_bytes(svg_string=svg.read_text("utf-8"), zoom=scale)))


def cairo(svg: Path, scale: int) -> np.ndarray:
    import cairosvg

    return read(cairosvg.svg2png(bytestring=svg.read_bytes(), scale=scale))


def chromium(svg: Path, scale: int) -> np.ndarray:
    """A screenshot of the document on a transparent page, at so many device pixels a px."""
    head = svg.read_text("utf-8")[:400]
    width, height = (int(head.split(f'{side}="')[1].split('"')[0]) for side in ("width", "height"))
    with tempfile.TemporaryDirectory() as folder:
        page, shot = Path(folder) / "page.html", Path(folder) / "shot.png"
        page.write_text(
            '<body style="margin:0;background:transparent">'
            f'<img style="display:block" src="{svg.resolve().as_uri()}"></body>'
        )
        command = ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"]
        command += [f"--force-device-scale-factor={scale}", f"--window-size={width},{height}"]
        command += ["--default-background-color=00000000", "--force-color-profile=srgb"]
        command += ["--allow-file-access-from-files", f"--screenshot={shot}", page.as_uri()]
        subprocess.run(command, check=True, capture_output=True, timeout=120)
        return read(shot.read_bytes())[: height * scale, : width * scale]


def read(png: bytes) -> np.ndarray:
    """Code values, [H, W, 4] uint8."""
    found = cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_UNCHANGED)
    if found.shape[2] == 3:
        found = cv2.cvtColor(found, cv2.COLOR_BGR2BGRA)
    return found[..., [2, 1, 0, 3]]


def renderers() -> Iterator[tuple[str, Callable[[Path, int], np.ndarray]]]:
    """Those that are here."""
    for name, draw, module in (("resvg", resvg, "resvg_py"), ("cairo", cairo, "cairosvg")):
        try:
            __import__(module)
        except ImportError:
            continue
        yield name, draw
    if shutil.which("chromium"):
        yield "chromium", chromium


def averaged(picture: np.ndarray, times: int) -> np.ndarray:
    """A picture at a fraction of its size, by means of code values."""
    height, width = picture.shape[:2]
    parts = picture.reshape(height // times, times, width // times, times, -1)
    return np.rint(parts.mean(axis=(1, 3), dtype=np.float64)).astype(np.int64)


def drawn(track: Path, frame: int, styles: list[str], scale: int, folder: Path) -> np.ndarray:
    """What this program draws, [H, W, 3]."""
    target = folder / f"own{scale}.png"
    trimotion.render(track, target, styles=styles, frames=frame, scale=scale, overwrite=True)
    return read(target.read_bytes())[..., :3].astype(np.int64)


def row(found: np.ndarray, own: np.ndarray, exact: np.ndarray | None) -> str:
    """Shares of near pixels, transparent ones, and the largest difference."""
    far = np.abs(found[..., :3].astype(np.int64) - own).max(axis=2)
    text = f"own {100 * (far <= NEAR).mean():6.2f} %"
    if exact is not None:
        off = np.abs(found[..., :3].astype(np.int64) - exact).max(axis=2)
        text += f"  exact {100 * (off <= NEAR).mean():6.2f} %"
    clear = int((found[..., 3] < 255).sum())
    return f"{text}  mean {far.mean():5.2f}  most {far.max():3d}  transparent {clear}"


def measure(track: Path, frame: int, name: str, scales: list[int], keep: Path | None) -> None:
    """Print a row for each renderer and size."""
    with tempfile.TemporaryDirectory() as made:
        folder = keep or Path(made)
        folder.mkdir(parents=True, exist_ok=True)
        svg = folder / f"{track.stem}_{frame}_{name}.svg"
        options = {"styles": STACKS[name], "frames": frame, "overwrite": True}
        trimotion.render(track, svg, **options)
        print(f"{track.stem} {frame} {name}: {svg.stat().st_size / 1000:.0f} kB")
        for scale in scales:
            own = drawn(track, frame, STACKS[name], scale, folder)
            exact = None
            if max(own.shape) * FINER <= 8192:
                finer = drawn(track, frame, STACKS[name], scale * FINER, folder)
                exact = averaged(finer, FINER)
                full = np.full((*own.shape[:2], 1), 255)
                print(f"  {'drawn':9} {scale}x {row(np.dstack([own, full]), own, exact)}")
            for title, render in renderers():
                found = render(svg, scale)
                print(f"  {title:9} {scale}x {row(found, own, exact)}", flush=True)
                if keep:
                    shown = folder / f"{svg.stem}_{title}_{scale}x.png"
                    cv2.imwrite(str(shown), found[..., [2, 1, 0, 3]])


def seams() -> None:
    """Two triangles of one colour, at many angles and zooms: no pixel may differ from it."""
    from fractions import Fraction

    from stages.exchange.exchange_options import ExchangeOptions
    from stages.exchange.figure import Figure
    from stages.exchange.film import Film
    from stages.exchange.svg.document import Svg
    from stages.look.framing import Framing
    from stages.look.paint import paint_of
    from stages.mesh import Mesh
    from stages.snapshot import Snapshot
    from warp_kernels.color_model import CONSTANT
    from warp_kernels.styles.flat import Flat

    with tempfile.TemporaryDirectory() as made:
        svg = Path(made) / "seam.svg"
        for place in (3.0, 17.3, 31.7, 49.1):
            points = np.array([[0, 0], [64, 0], [64, 64], [0, 64], [place, 0], [64 - place, 64]])
            corners = np.array([[0, 4, 5], [0, 5, 3], [4, 1, 2], [4, 2, 5]])
            mesh = Mesh(64, 64, points, corners, np.arange(6), np.arange(4), 6, 4)
            colors = np.full((4, 3, 1), 200.0)
            zero = np.zeros(4)
            snapshot = Snapshot(
                0, 0, Fraction(1, 25), mesh, CONSTANT, colors, zero, zero.astype(np.int64)
            )
            framing = Framing((64, 64), (64, 64), None)
            options = ExchangeOptions()
            film = Film("seam", ".svg", (64, 64), framing, None, (Flat(),), 0, None, 1, options)
            one = Svg(film)
            one.add(Figure(snapshot, 0, Fraction(0), paint_of(snapshot)))
            one.save(svg)
            for title, render in renderers():
                for scale in (1, 2, 3, 7):
                    found = render(svg, scale)
                    off = np.abs(found.astype(int) - [200, 200, 200, 255]).max(axis=2)
                    if off.any():
                        told = f"{(off > 0).sum()} pixels, by {off.max()} at most"
                        print(f"seam at {place} in {title} {scale}x: {told}")
    print("seams between triangles of one colour: looked for at 4 angles, 4 zooms")


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("tracks", nargs="*", type=Path)
    parser.add_argument("--styles", nargs="*", default=list(STACKS), choices=list(STACKS))
    parser.add_argument("--frames", nargs="*", type=int)
    parser.add_argument("--scales", nargs="*", type=int, default=[1, 3])
    parser.add_argument("--keep", type=Path)
    given = parser.parse_args()
    if not given.tracks:
        seams()
    with tempfile.TemporaryDirectory() as folder:
        tracks = given.tracks
        if not tracks:
            tracks = [Path(folder) / "astronaut.mtrk"]
            picture = ROOT / "sample_videos" / "astronaut.jpg"
            trimotion.solve(picture, tracks[0], triangles=700)
        for track in tracks:
            with trimotion.open_track(track) as opened:
                frames = given.frames or [next(iter(opened)).frame]
            for frame in frames:
                for name in given.styles:
                    measure(track, frame, name, given.scales, given.keep)


if __name__ == "__main__":
    main()
