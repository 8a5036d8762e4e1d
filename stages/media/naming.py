"""Names of numbered stills: `shot_####.png`, `shot_%04d.png`, `shot_$F4.png`.

A number field is two or more `#`, `%0Nd` or `$FN`; a single `#`, a `%` or a `$` elsewhere is part
of a name like any other character. A file that bears exactly the name of a pattern is that file.
"""

import os
import re
from dataclasses import dataclass, replace
from pathlib import Path

from warp_kernels.errors import OptionError

STILL_ENDINGS = frozenset({".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp"})
"""Endings of a still that can be written; anything FFmpeg knows can be read."""

SHAPES = {
    ".csv": True,
    ".dxf": False,
    ".glb": True,
    ".json": True,
    ".npz": True,
    ".obj": False,
    ".ply": False,
    ".svg": True,
    ".usd": True,
    ".usda": True,
    ".usdc": True,
}
"""Endings of what is written as shapes and numbers, see `stages.exchange`, and whether one file
holds a clip."""

_FIELD = re.compile(r"(?P<hashes>##+)|%0(?P<printf>\d+)d|\$F(?P<houdini>\d+)")


@dataclass(frozen=True)
class NumberedPattern:
    """A file name with one field for the frame number.

    Raises:
        OptionError: From `parse`, if the name has two fields or the folder has one.
    """

    text: str
    """The pattern as the user wrote it."""
    folder: Path
    """Folder of the stills."""
    prefix: str
    """Name before the number."""
    suffix: str
    """Name after the number, ending included."""
    digits: int
    """Least number of digits; larger numbers simply take more."""

    @classmethod
    def parse(cls, path: str | Path) -> "NumberedPattern | None":
        """Read a pattern, or return None when the name has no number field.

        Args:
            path: File name such as `out/shot_####.png`.

        Raises:
            OptionError: If the name holds more than one field.
        """
        whole = Path(path)
        fields = list(_FIELD.finditer(whole.name))
        if not fields:
            return None
        if len(fields) > 1:
            raise OptionError(
                f"{path}: {len(fields)} number fields in one name; keep one, such as name_####.png"
            )
        field = fields[0]
        digits = len(field["hashes"] or "") or int(field["printf"] or field["houdini"])
        name = whole.name
        return cls(
            str(path),
            whole.parent,
            name[: field.start()],
            name[field.end() :],
            max(1, min(digits, 20)),
        )

    @property
    def ending(self) -> str:
        """Ending with its dot, in lower case."""
        return Path(self.prefix + "0" + self.suffix).suffix.lower()

    def path_for(self, number: int) -> Path:
        """Name of the still with this frame number.

        Args:
            number: Frame number, from 0.
        """
        return self.folder / f"{self.prefix}{number:0{self.digits}d}{self.suffix}"

    def numbers(self, *, anything: bool = False) -> list[int]:
        """Frame numbers that exist in the folder, in ascending order.

        Args:
            anything: Whether what is no file counts, too: links that lead nowhere, pipes, folders.
        """
        stills = self._stills(anything)
        return sorted(number for number, name in stills if name == self.path_for(number).name)

    def left_out(self) -> list[str]:
        """Names of stills that differ only in the digits of their number, by that number."""
        stills = sorted(self._stills())
        return [name for number, name in stills if name != self.path_for(number).name]

    def taking_all(self) -> str | None:
        """The pattern that takes what is left out as well; None if there is none."""
        stills = self._stills()
        for digits in range(1, 21):
            other = replace(self, digits=digits)
            if all(name == other.path_for(number).name for number, name in stills):
                field = "#" * digits if digits > 1 else "%01d"
                return f"{self.prefix}{field}{self.suffix}"
        return None

    def _stills(self, anything: bool = False) -> list[tuple[int, str]]:
        """Numbers and names of the files that have any digits in the field's place."""
        if not os.path.isdir(self.folder):
            return []
        shape = re.compile(re.escape(self.prefix) + r"([0-9]{1,20})" + re.escape(self.suffix))
        entries = [entry for entry in self.folder.iterdir() if shape.fullmatch(entry.name)]
        names = [entry.name for entry in entries if anything or entry.is_file()]
        return [(int(match[1]), match[0]) for match in map(shape.fullmatch, names) if match]


def input_pattern(path: str | Path) -> NumberedPattern | None:
    """Pattern that an input name means; a file of exactly that name wins over its reading.

    Args:
        path: Input as the user wrote it.

    Raises:
        OptionError: If the name holds more than one number field.
    """
    return None if os.path.isfile(path) else NumberedPattern.parse(path)
