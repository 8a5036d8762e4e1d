"""How near SVG comes to the pictures that are drawn: every style, in every renderer that is here.

    python benchmarks/vector_exact.py [TRACK.mtrk ...] [--styles flat edges ...] [--keep FOLDER]

Renderers: resvg (PyPI resvg-py), Cairo (PyPI cairosvg), Chromium (`chromium` on the path) and
Inkscape (`inkscape`); those that are missing are left out. A track is made of the sample picture if
none is named. What they show of a document is compared with

- `own`: what this program draws at the same size, with 3 x 3 samples a pixel, as it does by itself;
- `smooth`: the same with `--samples 4`;
- `itself`: what the renderer shows of the document at FINER times the size, averaged: it says how
  exact its own borders are, whatever the document holds.

Figures are percent of the pixels within 2 code values, and how many are transparent.
"""

import argparse
import importlib.util
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from itertools import product
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
FINER = {1: 8, 3: 4}
"""How many times as large a renderer's own measure is, by the scale."""
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


def inkscape(svg: Path, scale: int) -> np.ndarray:
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "shown.png"
        command = ["inkscape", "--export-type=png", f"--export-filename={target}"]
        command += [f"--export-dpi={96 * scale}", str(svg)]
        subprocess.run(command, check=True, capture_output=True, timeout=300)
        return read(target.read_bytes())


NEEDED = {"resvg": "resvg_py", "cairo": "cairosvg"}
"""Modules of renderers that are no programs."""
RENDERERS = {"resvg": resvg, "cairo": cairo, "chromium": chromium, "inkscape": inkscape}
"""What shows a document at so many pixels a px, [H, W, 4] uint8."""


def is_here(name: str) -> bool:
    """Whether a renderer is installed."""
    if name in NEEDED:
        return importlib.util.find_spec(NEEDED[name]) is not None
    return shutil.which(name) is not None


def averaged(picture: np.ndarray, times: int) -> np.ndarray:
    """A picture at a fraction of its size, by means of code values."""
    height, width = picture.shape[:2]
    parts = picture.reshape(height // times, times, width // times, times, -1)
    return np.rint(parts.mean(axis=(1, 3), dtype=np.float64)).astype(np.int64)


def near(one: np.ndarray, other: np.ndarray) -> float:
    """Percent of the pixels that are alike."""
    off = np.abs(one[..., :3].astype(np.int64) - other[..., :3]).max(axis=2)
    return 100.0 * float((off <= NEAR).mean())


Row = tuple[str, str, int, float, float, float, int]
"""Style, renderer, scale; near `own`, `smooth` and `itself`; transparent pixels."""


def measure(track: Path, frame: int, name: str, given: argparse.Namespace) -> Iterator[Row]:
    """Rows of one frame in one stack."""
    keep: Path | None = given.keep
    with tempfile.TemporaryDirectory() as made, trimotion.open_track(track) as opened:
        folder = keep or Path(made)
        folder.mkdir(parents=True, exist_ok=True)
        svg = folder / f"{track.stem}_{frame}_{name}.svg"
        trimotion.render(track, svg, styles=STACKS[name], frames=frame, overwrite=True)
        one = opened[frame]
        for scale in given.scales:
            own, smooth = (one.draw(STACKS[name], scale, samples=samples) for samples in (3, 4))
            for title in given.renderers:
                render = RENDERERS[title]
                found = render(svg, scale)
                limit = float("nan")
                if given.limits and title in ("resvg", "cairo"):
                    limit = near(found, averaged(render(svg, scale * FINER[scale]), FINER[scale]))
                clear = int((found[..., 3] < 255).sum())
                yield name, title, scale, near(found, own), near(found, smooth), limit, clear
                if keep:
                    shown = folder / f"{svg.stem}_{title}_{scale}x.png"
                    cv2.imwrite(str(shown), found[..., [2, 1, 0, 3]])


def seams(names: list[str]) -> None:
    """Triangles of one colour, at many angles and zooms: no pixel may differ from it.

    Each with a path of its own, and as `--svg-merge` has them.
    """
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
            for merge in (False, True):
                known = 0, None, 1, None, ExchangeOptions(svg_merge=merge)
                film = Film("seam", ".svg", (64, 64), framing, None, (Flat(),), *known)
                one = Svg(film)
                one.add(Figure(snapshot, 0, Fraction(0), paint_of(snapshot)))
                one.save(svg)
                for title, scale in product(names, (1, 2, 3, 7)):
                    found = RENDERERS[title](svg, scale)
                    off = np.abs(found.astype(int) - [200, 200, 200, 255]).max(axis=2)
                    if off.any():
                        told = f"{(off > 0).sum()} pixels, by {off.max()} at most"
                        kind = "merged" if merge else "plain"
                        print(f"seam at {place}, {kind}, in {title} {scale}x: {told}")
    print("seams between triangles of one colour: looked for at 4 angles, 4 zooms")


def told(rows: list[Row]) -> None:
    """Print means over all frames, and the least of them."""
    print("\nstyle      renderer   scale    own          smooth       itself  transparent")
    kinds = dict.fromkeys(row[:3] for row in rows)
    for kind in kinds:
        own, smooth, limit, clear = np.array([row[3:] for row in rows if row[:3] == kind]).T
        style, title, scale = kind
        print(
            f"{style:10} {title:10} {scale}x {own.mean():7.2f} ({own.min():5.1f})"
            f"{smooth.mean():7.2f} ({smooth.min():5.1f}){limit.mean():8.2f} {int(clear.sum()):6d}"
        )


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("tracks", nargs="*", type=Path)
    parser.add_argument("--styles", nargs="*", default=list(STACKS), choices=list(STACKS))
    parser.add_argument("--scales", nargs="*", type=int, default=[1, 3])
    parser.add_argument("--limits", action="store_true", help="also how exact a renderer is")
    parser.add_argument("--keep", type=Path)
    here = [name for name in RENDERERS if is_here(name)]
    parser.add_argument("--renderers", nargs="*", default=here, choices=here)
    given = parser.parse_args()
    if not given.tracks:
        seams(given.renderers)
    with tempfile.TemporaryDirectory() as folder:
        tracks = given.tracks
        if not tracks:
            tracks = [Path(folder) / "astronaut.mtrk"]
            picture = ROOT / "sample_videos" / "astronaut.jpg"
            trimotion.solve(picture, tracks[0], triangles=700)
        rows: list[Row] = []
        for track in tracks:
            with trimotion.open_track(track) as opened:
                frame = next(iter(opened)).frame
            for name in given.styles:
                for row in measure(track, frame, name, given):
                    rows.append(row)
                    print(track.stem, *row[:3], *(f"{x:.2f}" for x in row[3:6]), row[6], flush=True)
        told(rows)


if __name__ == "__main__":
    main()
