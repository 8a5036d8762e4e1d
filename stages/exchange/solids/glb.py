"""Binary glTF: numbers in one block, and a description of them in JSON.

Source: Khronos, glTF 2.0 Specification, Sec. 3.6 (data) and 4 (the binary container).
"""

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

FLOAT, BYTE = 5126, 5121
"""Component types."""
VERTICES = 34962
"""Use of a buffer view that holds attributes of vertices."""
SHAPES = {(): "SCALAR", (3,): "VEC3"}
"""Names of the shapes of elements."""
MOST_BYTES = 2**32 - 1
"""Size of a file: the container counts in 32 bits."""


class Block:
    """Arrays that lie one after the other in a buffer, by what they are for.

    Each purpose has a view of its own, since vertices need one with a stride.
    """

    def __init__(self) -> None:
        self.accessors: list[dict[str, Any]] = []
        """Descriptions of the arrays."""
        self._views: dict[str, int] = {}
        self._parts: list[list[bytes]] = []
        self._sizes: list[int] = []
        self._strides: list[int | None] = []

    def add(self, array: np.ndarray, use: str, *, bounded: bool = False) -> int:
        """Take an array.

        Args:
            array: [N] or [N, 3], float32 or uint8.
            use: What it is for; one that begins with `vertex` is an attribute of vertices.
            bounded: Whether its lowest and highest values are told, which positions and times need.

        Returns:
            The number of its description.
        """
        data = np.ascontiguousarray(array)
        if use not in self._views:
            self._views[use] = len(self._parts)
            self._parts.append([])
            self._sizes.append(0)
            self._strides.append(data[:1].nbytes if use.startswith("vertex") else None)
        view = self._views[use]
        told: dict[str, Any] = {
            "bufferView": view,
            "byteOffset": self._sizes[view],
            "componentType": BYTE if data.dtype == np.uint8 else FLOAT,
            "count": len(data),
            "type": SHAPES[data.shape[1:]],
        }
        if bounded:
            for name, edge in (("min", data.min(axis=0)), ("max", data.max(axis=0))):
                told[name] = np.atleast_1d(edge).tolist()
        self.accessors.append(told)
        self._parts[view].append(data.tobytes())
        self._sizes[view] += data.nbytes
        return len(self.accessors) - 1

    def save(self, path: Path, scene: dict[str, Any]) -> None:
        """Write them and what is said of them.

        Args:
            path: The file.
            scene: All of the JSON but the tables of the arrays.
        """
        views, place = [], 0
        for size, stride in zip(self._sizes, self._strides, strict=True):
            view = {"buffer": 0, "byteOffset": place, "byteLength": size}
            views.append(
                view if stride is None else {**view, "byteStride": stride, "target": VERTICES}
            )
            place += size + -size % 4
        tables = {
            "accessors": self.accessors,
            "bufferViews": views,
            "buffers": [{"byteLength": place}],
        }
        text = json.dumps({**scene, **tables}, separators=(",", ":"), ensure_ascii=False).encode()
        text += b" " * (-len(text) % 4)
        with path.open("wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + place))
            file.write(struct.pack("<I4s", len(text), b"JSON"))
            file.write(text)
            file.write(struct.pack("<I4s", place, b"BIN\0"))
            for size, parts in zip(self._sizes, self._parts, strict=True):
                file.writelines(parts)
                file.write(bytes(-size % 4))
