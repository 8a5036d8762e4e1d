"""The drawing that cuts are laid on: millimetres, y up, a layer a colour."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from stages.exchange.film import Film
from warp_kernels.errors import OptionError

MOST_LAYERS = 32
"""So many colours of a look at most have a layer each."""
VERSION = "R2010"
"""Of AutoCAD: one that knows more than 255 colours, and that cutters read."""


def ezdxf() -> Any:
    """The library.

    Raises:
        OptionError: If it is not installed.
    """
    try:
        import ezdxf as library
    except ImportError as error:
        raise OptionError(
            ".dxf: needs the package ezdxf; pip install 'trimotion[dxf]', or use .svg"
        ) from error
    return library


@contextmanager
def _without_times(library: Any) -> Iterator[None]:
    """Let it write no times and no random numbers: the same input gives the same bits.

    What a program that calls this one writes with it is as it was.
    """
    options = library.options
    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = before


class Sheet:
    """A drawing in the making.

    Args:
        film: Says where the picture lies, and how wide the output is.
    """

    def __init__(self, film: Film) -> None:
        library = ezdxf()
        self._library = library
        with _without_times(library):
            self._document = library.new(VERSION, units=library.units.MM)
        self._space = self._document.modelspace()
        width, height = film.framing.canvas
        self._by = (film.options.mm or width) / width
        self._scale, self._offset = np.array(film.scale), np.array(film.framing.offset)
        self._height = height

    def places(self, points: np.ndarray) -> np.ndarray:
        """Where points of the picture lie on the sheet.

        Args:
            points: Positions [px of the source], [..., 2].

        Returns:
            Positions [mm], y up, [..., 2].
        """
        x, y = np.moveaxis(points * self._scale + self._offset, -1, 0)
        return self._by * np.stack([x, self._height - y], axis=-1)

    def lengths(self, lengths: np.ndarray) -> np.ndarray:
        """How long something is on the sheet [mm]; of pixels that are no squares the mean.

        Args:
            lengths: How long it is on the picture [px of the source].
        """
        return lengths * (self._by * float(np.sqrt(self._scale.prod())))

    def pens(self, name: str, colors: np.ndarray) -> list[dict[str, Any]]:
        """Layer and colour of shapes: a layer a colour if there are few.

        Args:
            name: Begin of the layers' names.
            colors: Those of the shapes [code values], [N, 3] uint8.
        """
        kinds, firsts, own = np.unique(colors, axis=0, return_index=True, return_inverse=True)
        if len(kinds) > MOST_LAYERS:
            self._layer(name, colors.mean(axis=0))
            packed = (colors.astype(np.int64) @ np.array([1 << 16, 1 << 8, 1])).tolist()
            return [{"layer": name, "true_color": color} for color in packed]
        ranks = np.argsort(np.argsort(firsts)) + 1
        names = [
            f"{name}-{rank}-" + bytes(kind.tolist()).hex()
            for rank, kind in zip(ranks.tolist(), kinds, strict=True)
        ]
        for kind in np.argsort(firsts).tolist():
            self._layer(names[kind], kinds[kind])
        return [{"layer": names[kind]} for kind in own.reshape(-1).tolist()]

    def _layer(self, name: str, color: np.ndarray) -> None:
        """Begin a layer; programs that know no true colours show the nearest of AutoCAD's."""
        known = np.array(
            [self._library.colors.aci2rgb(number) for number in range(1, 256)], np.int64
        )
        nearest = 1 + int(np.square(known - color).sum(axis=1).argmin())
        layer = self._document.layers.add(name, color=nearest)
        layer.rgb = tuple(np.rint(color).astype(int).tolist())

    def strokes(self, ends: np.ndarray, pens: Sequence[dict[str, Any]]) -> None:
        """Draw straight strokes.

        Args:
            ends: Their ends [px of the source], [N, 2, 2].
            pens: Layer and colour of each.
        """
        for (begin, end), pen in zip(self.places(ends).tolist(), pens, strict=True):
            self._space.add_line(begin, end, dxfattribs=pen)

    def lines(self, lines: Sequence[np.ndarray], pens: Sequence[dict[str, Any]]) -> None:
        """Draw open lines.

        Args:
            lines: Points of each [px of the source], [N, 2].
            pens: Layer and colour of each.
        """
        for points, pen in zip(lines, pens, strict=True):
            self._space.add_lwpolyline(self.places(points).tolist(), dxfattribs=pen)

    def loops(
        self,
        loops: Sequence[np.ndarray],
        pens: Sequence[dict[str, Any]],
        bulges: Sequence[np.ndarray] | None = None,
    ) -> None:
        """Draw closed lines.

        Args:
            loops: Points of each [px of the source], [N, 2].
            pens: Layer and colour of each.
            bulges: How round each is behind its points, as DXF says, [N]; None for straight ones.
        """
        for number, (points, pen) in enumerate(zip(loops, pens, strict=True)):
            table = self.places(points)
            if bulges is not None:
                table = np.column_stack([table, bulges[number]])
            self._space.add_lwpolyline(
                table.tolist(), format="xy" if bulges is None else "xyb", close=True, dxfattribs=pen
            )

    def circles(
        self, centres: np.ndarray, radii: np.ndarray, pens: Sequence[dict[str, Any]]
    ) -> None:
        """Draw circles.

        Args:
            centres: Theirs [px of the source], [N, 2].
            radii: Theirs [px of the source], [N].
            pens: Layer and colour of each.
        """
        rows = zip(self.places(centres).tolist(), self.lengths(radii).tolist(), pens, strict=True)
        for centre, radius, pen in rows:
            self._space.add_circle(centre, radius, dxfattribs=pen)

    def save(self, path: Path) -> None:
        """Write it."""
        with _without_times(self._library):
            self._document.saveas(path)
