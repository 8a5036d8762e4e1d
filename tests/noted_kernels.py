"""Which kernels a job can launch: all are asked for on a device that only notes them."""

from collections.abc import Sequence
from functools import cache
from itertools import product
from typing import Any

import numpy as np

from tests.kernel_samples import random_mesh
from warp_kernels.color_model import COLOR_MODELS
from warp_kernels.device.device import Device
from warp_kernels.device.phase import Phase
from warp_kernels.device.staging import ArrayRows
from warp_kernels.drawing.blend import BLENDS
from warp_kernels.drawing.canvas import Canvas
from warp_kernels.drawing.layers import Layers
from warp_kernels.drawing.moved import Moved
from warp_kernels.drawing.paint import Paint
from warp_kernels.energy.color_extremes import Extremes
from warp_kernels.energy.nearby_colors import Nearby
from warp_kernels.energy.plain_colors import PlainColors
from warp_kernels.energy.sums import SUMS
from warp_kernels.energy.topology_survey import Survey
from warp_kernels.energy.workspace import Workspace
from warp_kernels.styles import STYLES, Style

SIZE = (64, 48)


class Nothing(Phase):
    """A phase without a launch."""

    def __init__(self) -> None:
        super().__init__([], lambda number, begin, end: None, 1, 1)

    def resize(self, count: int, **_: Any) -> None:
        """Nothing becomes no larger."""


class NotingDevice(Device):
    """Notes what would be launched, and compiles and launches nothing.

    Args:
        as_card: Whether to note what a card is given, which for some steps is another kernel.
    """

    def __init__(self, *, as_card: bool = False) -> None:
        super().__init__("cpu", 1)
        self.is_cuda = as_card
        self.kernels: dict[Any, None] = {}

    def record(self, kernel: Any, inputs: Sequence[Any], outputs: Sequence[Any], **_: Any) -> Phase:
        """Note the kernel."""
        self.kernels[kernel] = None
        return Nothing()

    def run(self, phases: Sequence[Phase], times: int = 1) -> None:
        """Do nothing."""

    def write(self, array: Any, values: np.ndarray) -> None:
        """Write nothing."""

    def read(self, array: Any, count: int) -> np.ndarray:
        """Read zeros."""
        return np.zeros((count, *array.shape[1:]), array.numpy().dtype)

    def read_all(self, wanted: Sequence[ArrayRows]) -> list[np.ndarray]:
        """Read zeros."""
        whole = [self.read(rows.array, rows.count) for rows in wanted]
        return [
            array if rows.column is None else array[:, rows.column]
            for array, rows in zip(whole, wanted, strict=True)
        ]


def note_solver(device: Device, kinds: Sequence[tuple[str, str, bool]]) -> None:
    """Ask for every kernel that solving can need.

    Args:
        device: Where to ask.
        kinds: Colour models by name, ways to sum, and whether pictures have weights.
    """
    for name, sums, weighted in kinds:
        model = COLOR_MODELS[name]
        workspace = Workspace(device, SIZE, model, sums, weighted)
        nothing = np.zeros((1, 3, model.term_count)), np.zeros(1), np.zeros((1, 2, 3), np.uint8)
        Nearby(workspace).measure(*nothing)
        Extremes(workspace).measure(1)
        if model.degree == 0:
            PlainColors(workspace).measure(np.zeros(1, int), np.zeros((1, 3)), np.zeros(1))
        if sums == "edges":
            survey = Survey(workspace)
            survey.load_topology(np.zeros(3, int), np.zeros(3, int))
            for measured in (survey.flip_gains, survey.collapse_costs, survey.split_gains):
                measured(np.zeros(1, int))


def note_styles(device: Device, *, moves: bool = False) -> None:
    """Ask for the kernels of every style alone, with and without triangles that fade."""
    for style in STYLES.values():
        _note_canvas(device, (style(),), moves=moves)


def note_stacks(device: Device) -> None:
    """Ask for the kernels of every style on paper, of every blend, of regions, of large outputs."""
    flat, gradient, edges, paper = (STYLES[name] for name in ("flat", "gradient", "edges", "paper"))
    for style in STYLES.values():
        _note_canvas(device, (paper(), style(opacity=0.5)))
    for blend in BLENDS:
        _note_canvas(device, (flat(), gradient(blend=blend, opacity=0.5)))
        _note_canvas(device, (gradient(opacity=0.5), edges(blend=blend)))
    _note_canvas(device, (flat(),), (gradient(),))
    _note_canvas(device, (flat(),), (edges(),), followed=(0,))
    for width in (4000, 8192):  # fewer samples a pixel
        _note_canvas(device, (flat(),), output=(width, 16))


def _note_canvas(
    device: Device,
    styles: tuple[Style, ...],
    masked: tuple[Style, ...] = (),
    *,
    followed: tuple[int, ...] = (),
    moves: bool = False,
    output: tuple[int, int] = SIZE,
) -> None:
    """Ask for what draws a mesh with a stack, with and without triangles that fade."""
    textures = [style.texture(lambda name: np.ones((32, 32))) for style in (*styles, *masked)]
    canvas = Canvas(device, SIZE, output, styles, masked, textures, followed, moves)
    mesh = random_mesh(*SIZE, 12)
    count = mesh.triangle_count
    corners = mesh.vertices[mesh.triangles]
    paint = Paint(
        np.zeros((count, 3)),
        np.zeros((count, 2, 3)),
        None,
        np.broadcast_to([[[0.0], [255.0]]], (count, 2, 3)),
        corners,
        np.arange(count),
        shares=np.zeros((count, len(followed)), np.uint8) if followed else None,
    )
    layers = Layers(
        np.ones(count, np.float32),
        np.zeros((count, 2, 2), np.float32),
        np.zeros((count, 2)),
        np.zeros((count, 2), np.int32),
        np.zeros(1, np.int32),
    )
    ones = np.ones(count)
    moved = Moved(corners, ones, ones, ones) if moves else None
    for fading in (None, layers):
        canvas.draw(
            vertices=mesh.vertices,
            triangles=mesh.triangles,
            paint=paint,
            layers=fading,
            moved=moved,
        )


@cache
def kernels_of_jobs() -> tuple[Any, ...]:
    """What the CPU is given for the solver, weights with one model, and for every style alone."""
    device = NotingDevice()
    note_solver(
        device, [(name, sums, name == "linear") for name, sums in product(COLOR_MODELS, SUMS)]
    )
    note_styles(device)
    return tuple(device.kernels)


@cache
def kernels_of_card() -> tuple[Any, ...]:
    """What a card is given: everything."""
    device = NotingDevice(as_card=True)
    note_solver(device, list(product(COLOR_MODELS, SUMS, (False, True))))
    note_styles(device)
    note_styles(device, moves=True)
    note_stacks(device)
    return tuple(device.kernels)
