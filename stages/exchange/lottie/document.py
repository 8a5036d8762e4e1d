"""The file of a Lottie animation."""

import json
from fractions import Fraction
from itertools import groupby
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.format import Format
from stages.exchange.lottie.grown import grown
from stages.exchange.lottie.keyframes import animated, kept, short
from stages.exchange.lottie.lives import Life, Lives
from stages.exchange.solids.corners import refuse_stacks
from warp_kernels.errors import OptionError

POINT_TOLERANCE = 0.2
"""Most that a corner is off between keyframes [px]."""
COLOR_TOLERANCE = 1.0
"""Most that a channel is off between keyframes [code values]."""
DECIMALS = 1
"""Of positions: off by 0.05 px at most."""
OVERLAP = 0.5
"""By how much triangles are grown [px]: renderers smooth every path on its own, so between two that
merely touch what lies below would shine through."""
STANDING = {"r": 0, "o": 100, "p": [0, 0], "a": [0, 0], "s": [100, 100]}
"""A transform that changes nothing."""


class Lottie(Format):
    """A layer for all triangles that come and go together; paths and fills have keyframes.

    Source: Lottie Animation Community, Lottie Specification 1.0.
    """

    styles: ClassVar[tuple[str, ...]] = ("flat",)
    most_degree: ClassVar[int] = 1

    def __init__(self, film: Film) -> None:
        super().__init__(film)
        self._lives = Lives()
        self._times: list[Fraction] = []
        self._sum, self._area = np.zeros(3), 0.0

    @classmethod
    def check(cls, film: Film) -> None:
        """As every format, one style only, and no more triangles than players show."""
        super().check(film)
        refuse_stacks(film)
        _refuse_many(film, film.triangles or 0)

    def add(self, figure: Figure) -> None:
        """Take a frame."""
        _refuse_many(self.film, figure.mesh.triangle_count)
        self._lives.add(figure)
        self._times.append(figure.time)
        areas = figure.mesh.areas
        self._sum, self._area = self._sum + areas @ figure.colors, self._area + areas.sum()

    def save(self, path: Path) -> None:
        """Write them."""
        rate = self.film.rate or Fraction(25)
        frames = [(time - self._times[0]) * rate for time in self._times]
        times = np.round(np.array([*frames, frames[-1] + 1], np.float64), 3)
        # the first layer is the topmost: what ends lies below what stays, since rlottie shows a
        # layer for a frame longer than it lasts
        layers = []
        lives = self._lives.found()
        for (first, end), group in groupby(lives, key=lambda life: (life.first, life.end)):
            shapes = [_shape(life, times) for life in group]
            layers.append(_layer(f"{first}-{end - 1}", times[first], times[end], shapes))
        layers.append(_layer("ground", 0.0, times[-1], [self._ground()]))
        width, height = self.film.size
        whole = {
            "v": "5.7.0",
            "nm": self.film.name,
            "fr": short(float(rate)),
            "ip": 0,
            "op": short(float(times[-1])),
            "w": width,
            "h": height,
            "ddd": 0,
            "assets": [],
            "layers": layers,
        }
        path.write_text(json.dumps(whole, separators=(",", ":")), "utf-8", newline="\n")

    def _ground(self) -> dict[str, Any]:
        """A sheet in the mean colour, so that nothing is transparent."""
        width, height = self.film.size
        sheet = {
            "ty": "rc",
            "p": {"a": 0, "k": [width / 2, height / 2]},
            "s": {"a": 0, "k": [width, height]},
            "r": {"a": 0, "k": 0},
        }
        return _group("ground", sheet, {"a": 0, "k": _channels(self._sum / self._area)})


def _refuse_many(film: Film, count: int) -> None:
    """Refuse more triangles than players show."""
    most = film.options.lottie_limit
    if count > most:
        raise OptionError(
            f"{film.ending}: {count} triangles, and players of Lottie become slow beyond {most}; "
            f"use --triangles {most}, or --lottie-limit {count}"
        )


def _layer(name: str, begin: float, end: float, shapes: list[dict[str, Any]]) -> dict[str, Any]:
    return {
        "ty": 4,
        "nm": name,
        "ip": short(float(begin)),
        "op": short(float(end)),
        "st": 0,
        "ks": _transform(),
        "shapes": shapes,
    }


def _transform() -> dict[str, Any]:
    return {name: {"a": 0, "k": value} for name, value in STANDING.items()}


def _group(name: str, outline: dict[str, Any], color: dict[str, Any]) -> dict[str, Any]:
    fill = {"ty": "fl", "c": color, "o": {"a": 0, "k": 100}, "r": 1}
    return {"ty": "gr", "nm": name, "it": [outline, fill, {"ty": "tr", **_transform()}]}


def _shape(life: Life, times: np.ndarray) -> dict[str, Any]:
    """One triangle over its life."""
    own = times[life.first : life.end]
    points = np.round(grown(life.corners, OVERLAP), DECIMALS)
    steps = kept(own, points.reshape(-1, 6), POINT_TOLERANCE)
    paths = [
        {"c": True, "v": corners, "i": [[0, 0]] * 3, "o": [[0, 0]] * 3}
        for corners in points[steps].tolist()
    ]
    outline = {"ty": "sh", "ks": animated(own[steps], [[path] for path in paths], paths[0])}
    steps = kept(own, life.colors.astype(np.float64), COLOR_TOLERANCE)
    colors = [_channels(color) for color in life.colors[steps]]
    return _group(str(life.triangle), outline, animated(own[steps], colors, colors[0]))


def _channels(codes: np.ndarray) -> list[float]:
    """Code values as shares of white."""
    return [round(code / 255, 3) for code in np.asarray(codes, np.float64).tolist()]
