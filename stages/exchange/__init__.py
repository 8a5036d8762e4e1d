"""What leaves as shapes and numbers instead of pixels: one file, or folder, a format.

`FORMATS` names them by the endings of their files; a new one is a class, see
`stages.exchange.format`, a line here and one in `stages.media.naming.SHAPES`.
"""

from pathlib import Path
from typing import TYPE_CHECKING

from stages.media.naming import NumberedPattern
from warp_kernels.registry import imported

if TYPE_CHECKING:
    from stages.exchange.format import Format

FORMATS = {
    ".csv": "stages.exchange.table:Table",
    ".dxf": "stages.exchange.dxf.document:Dxf",
    ".glb": "stages.exchange.solids.gltf:Gltf",
    ".json": "stages.exchange.lottie.document:Lottie",
    ".npz": "stages.exchange.arrays:Arrays",
    ".obj": "stages.exchange.solids.obj:Obj",
    ".ply": "stages.exchange.solids.ply:Ply",
    ".svg": "stages.exchange.svg.document:Svg",
    ".usd": "stages.exchange.usd.document:Usd",
    ".usda": "stages.exchange.usd.document:Usd",
    ".usdc": "stages.exchange.usd.document:Usd",
}
"""Where the classes are, by ending."""


def ending_of(path: str | Path) -> str:
    """The ending of an output, in lower case.

    Args:
        path: A file, or a pattern of numbered ones.
    """
    pattern = NumberedPattern.parse(path)
    return pattern.ending if pattern else Path(path).suffix.lower()


def is_exchange(path: str | Path) -> bool:
    """Whether an output is written as shapes.

    Args:
        path: A file, or a pattern of numbered ones.
    """
    return ending_of(path) in FORMATS


def format_of(path: str | Path) -> "type[Format]":
    """The format of an output that `is_exchange`.

    Args:
        path: A file, or a pattern of numbered ones.
    """
    found: type[Format] = imported(FORMATS[ending_of(path)])
    return found
