"""Frames as formats of shapes see them, made by hand."""

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

import numpy as np

from stages.exchange import FORMATS
from stages.exchange.exchange_options import ExchangeOptions
from stages.exchange.figure import Figure
from stages.exchange.film import Film
from stages.exchange.format import Format
from stages.look.framing import Framing
from stages.look.paint import paint_of
from stages.snapshot import Snapshot
from tests.meshes import HEIGHT, WIDTH, random_mesh
from tests.snapshots import restless_shot, snapshot_with
from warp_kernels.color_model import LINEAR
from warp_kernels.registry import imported
from warp_kernels.styles import STYLES

RATE = Fraction(25)
"""Frames per second."""


def film_of(ending: str, style: str = "flat", frames: int | None = None, **options: Any) -> Film:
    """What frames of `random_mesh` have in common."""
    size = (WIDTH, HEIGHT)
    return Film(
        name="made",
        ending=ending,
        size=size,
        framing=Framing(size, size, None),
        background=None,
        styles=(STYLES[style](),),
        degree=STYLES[style]().degree,
        rate=RATE,
        frames=frames,
        triangles=None,
        options=ExchangeOptions(**options),
    )


def figures_of(snapshots: Iterable[Snapshot], shot: int = 0) -> list[Figure]:
    """Snapshots as frames at 25 per second."""
    return [Figure(one, shot, Fraction(one.frame_index) / RATE, paint_of(one)) for one in snapshots]


def mixed_figures(seed: int = 4) -> list[Figure]:
    """Three frames of one topology that move and change colour, two that change it, and a cut."""
    rng = np.random.default_rng(seed)
    mesh = random_mesh(seed)
    inner = ~(mesh.on_left_right | mesh.on_top_bottom)
    calm = []
    for index in range(3):
        calm.append(snapshot_with(mesh, rng.integers(0, 256, (mesh.triangle_count, 3)), index))
        mesh = mesh.moved(mesh.vertices + 0.01 * rng.random(mesh.vertices.shape) * inner[:, None])
    restless = restless_shot(mesh, 5)[3:]
    return figures_of([*calm, *restless]) + figures_of(restless_shot(mesh, 6)[5:], 5)


def graded_figures(seed: int = 5) -> list[Figure]:
    """Two frames of one topology in linear colours."""
    rng = np.random.default_rng(seed)
    mesh = random_mesh(seed)
    slopes = rng.normal(0, 0.3, (2, mesh.triangle_count, 3, 3)) + np.array([120, 0, 0])
    return figures_of(snapshot_with(mesh, one, n, LINEAR) for n, one in enumerate(slopes))


def format_with(film: Film, figures: Iterable[Figure]) -> Format:
    """A format that took some frames."""
    one: Format = imported(FORMATS[film.ending])(film)
    for figure in figures:
        one.add(figure)
    return one
