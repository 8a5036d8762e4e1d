"""One portrait in every style, as the paper's Fig. 6 shows them."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from pipeline.envelope import InShot
from pipeline.loop.attention import Attention
from pipeline.options.members import parse_member
from stages.focus.faces import Faces
from stages.frame import Frame
from stages.layouts.importance import Importance
from stages.look.sheet import sheet_of
from stages.media import (
    EncodeOptions,
    FrameRange,
    check_output,
    open_decoder,
    open_encoder,
    probe,
)
from stages.media.color.yuv import over_paper
from stages.render import Renderer
from stages.snapshot import Snapshot
from stages.topology.refine_options import RefineOptions
from stages.triangulate import Triangulator
from stages.triangulate_options import TriangulateOptions
from warp_kernels.color_model import LINEAR
from warp_kernels.device.device import Device
from warp_kernels.errors import OptionError
from warp_kernels.styles import STYLES

COLUMNS = 4
"""Portraits in a row."""
WIDTH = 360
"""Width of a portrait [px]."""
TRIANGLES = 900
"""As many as show a face and are still seen as triangles."""
ONE = FrameRange(0, 0)
"""A sheet shows the first frame."""
OVER = " + "
"""Written between the styles of a stack, the lower one first."""
SAMPLE = Path(__file__).parents[3] / "sample_videos" / "astronaut.jpg"
"""The portrait, unless another picture is named."""


def draw_sheet(
    picture: str | None,
    output: str,
    *,
    triangles: int = TRIANGLES,
    overwrite: bool = False,
    names: Iterable[str] | None = None,
) -> None:
    """Write a picture that shows styles.

    Args:
        picture: What is drawn: a still, or a clip whose first frame is taken; None for the
            portrait among the sample clips.
        output: A still.
        triangles: How many triangles it becomes.
        overwrite: Whether to replace what is there.
        names: The styles; None for all that can be used.

    Raises:
        MediaError: If the picture cannot be read.
        OptionError: If there is no sample portrait, or the output is none that can be written.
        OutputError: If the sheet cannot be written.
    """
    source = Path(picture) if picture is not None else SAMPLE
    if picture is None and not SAMPLE.is_file():
        raise OptionError("styles --sheet: there is no sample portrait here; name a picture")
    info = probe(source)
    check_output(output, info, (WIDTH, WIDTH), EncodeOptions(overwrite=overwrite), ONE)
    with open_decoder(source) as decoder:
        frame = next(decoder)
    # faces count more, as in every other picture
    (alone,) = Attention([Faces()], info, 1, triangles).beside([InShot(frame.index, frame)])
    frame = alone.frame
    shown = STYLES.usable if names is None else {name: STYLES[name] for name in names}
    stacks = [stack for name, cls in shown.items() for stack in cls.portraits or (name,)]
    with Device("auto") as device:
        snapshot = _triangulated(frame, device, triangles)
        cells = [_drawn(stack.split(OVER), snapshot, frame, device) for stack in stacks]
    sheet = sheet_of(cells, stacks, COLUMNS)
    size = (sheet.shape[1], sheet.shape[0])
    options = EncodeOptions(overwrite=overwrite, audio=False)
    with open_encoder(output, info, size, options, ONE) as out:
        out.write(sheet, frame.pts, frame.time_base, frame.index)


def _triangulated(frame: Frame, device: Device, triangles: int) -> Snapshot:
    """Triangles for constant colours, with the linear ones that fit them."""
    size = (frame.pixels.shape[1], frame.pixels.shape[0])
    options = TriangulateOptions(refine=RefineOptions(triangles=triangles))
    triangulator = Triangulator(device, size, options, LINEAR)
    return triangulator.first(frame, Importance(), np.random.default_rng([0, 0]))


def _drawn(specs: list[str], snapshot: Snapshot, frame: Frame, device: Device) -> np.ndarray:
    """A portrait in a stack of styles, over white paper."""
    mesh = snapshot.mesh
    styles = tuple(parse_member("--style", spec, STYLES) for spec in specs)
    size = (WIDTH, max(1, round(WIDTH * mesh.height / mesh.width)))
    renderer = Renderer(device, (mesh.width, mesh.height), size, styles)
    pixels = renderer.render(snapshot, source=frame.pixels)
    return over_paper(pixels) if pixels.shape[2] == 4 else pixels
