"""What is told in bytes: a JSON head of known length, then arrays one after the other.

The first four bytes are the length of the head, little-endian; the head is padded with blanks so
that the arrays begin at a multiple of eight. It names them in order with their type and length.
"""

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from stages.hand.worked import Worked
from stages.look.paint import paint_of
from stages.snapshot import Snapshot

KINDS = {"f4": "<f4", "u4": "<u4", "u1": "u1", "f8": "<f8"}
"""Types of arrays."""
MOST_SIDE = 8192
"""Longest side of a picture [px]: larger textures there are not everywhere."""


def pack(head: Mapping[str, Any], arrays: Mapping[str, tuple[str, np.ndarray]]) -> bytes:
    """Put a head and arrays into one message.

    Args:
        head: What it is about.
        arrays: By name their type, one of `KINDS`, and what they hold.
    """
    parts: list[bytes] = []
    listed: list[list[object]] = []
    for name, (kind, array) in arrays.items():
        data = np.ascontiguousarray(array, dtype=KINDS[kind]).tobytes()
        listed.append([name, kind, int(array.size)])
        parts.append(data + bytes(-len(data) % 8))
    text = json.dumps({**head, "arrays": listed}).encode()
    text += b" " * (-(len(text) + 4) % 8)
    return b"".join([len(text).to_bytes(4, "little"), text, *parts])


def packed_mesh(head: Mapping[str, Any], snapshot: Snapshot) -> bytes:
    """A mesh with its colours and what is held of it.

    Args:
        head: What it is about; `kind` and sizes are added.
        snapshot: The mesh.
    """
    worked = Worked(snapshot.mesh, snapshot.locks)
    facts = {**head, "rmse": snapshot.rmse}
    return packed_work(facts, worked, snapshot.energies, paint_of(snapshot).colors)


def packed_work(
    head: Mapping[str, Any], worked: Worked, energies: np.ndarray, colors: np.ndarray
) -> bytes:
    """A mesh that is being worked on.

    Args:
        head: What it is about; `kind` and sizes are added.
        worked: The mesh, and what of it is held.
        energies: E(T) [code value^2 px], [T].
        colors: Colours of the triangles [code values], [T, 3].
    """
    mesh, locks = worked.mesh, worked.locks
    held = locks.held(mesh)
    edges = mesh.edge_half_edges[held.edges[mesh.edge_half_edges]]
    facts = {"kind": "mesh", "width": mesh.width, "height": mesh.height}
    return pack(
        {**head, **facts},
        {
            "vertices": ("f8", mesh.vertices),
            "triangles": ("u4", mesh.triangles),
            "ids": ("f8", mesh.vertex_ids),
            "held": ("u1", held.vertices),
            "heldEdges": ("u4", edges),
            "bare": ("u1", np.isin(mesh.triangle_ids, locks.bare)),
            "colors": ("u1", np.clip(np.rint(colors), 0, 255)),
            "energies": ("f4", energies / np.maximum(mesh.areas, 1e-9)),
        },
    )


def packed_pixels(head: Mapping[str, Any], pixels: np.ndarray) -> bytes:
    """A picture; every other pixel of it or so, if it is larger than what browsers take.

    Args:
        head: What it is about, with its `kind`; sizes are added.
        pixels: Code values, [H, W, 3 or 4] uint8.
    """
    each = -(-max(pixels.shape) // MOST_SIDE)
    pixels = pixels[::each, ::each]
    rows, columns, channels = pixels.shape
    facts = {"columns": columns, "rows": rows, "channels": channels}
    return pack({**head, **facts}, {"pixels": ("u1", pixels)})
