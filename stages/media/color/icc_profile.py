"""ICC profiles of three primaries and curves, or of one grey curve, to sRGB.

Source: ICC.1:2022, Sec. 8.3 and 8.4 (matrix and grey profiles), 10.6 (curv), 10.18 (para);
IEC 61966-2-1 (sRGB).
"""

import struct
from dataclasses import dataclass

import numpy as np

_SRGB_TO_D50 = np.array(
    [
        [0.4360747, 0.3850649, 0.1430804],
        [0.2225045, 0.7168786, 0.0606169],
        [0.0139322, 0.0971045, 0.7141733],
    ]
)
"""Linear sRGB to XYZ of the profile connection space, whose white is D50."""
_PRIMARIES = {
    9: ("BT.2020", ((0.708, 0.292), (0.170, 0.797), (0.131, 0.046))),
    12: ("Display P3", ((0.680, 0.320), (0.265, 0.690), (0.150, 0.060))),
}
"""Primaries by FFmpeg's number, with a white of D65 and light as in sRGB."""
_SRGB = ((0.640, 0.330), (0.300, 0.600), (0.150, 0.060))
_D65 = (0.3127, 0.3290)
_STEPS = 65536
_ALIKE = 1
"""Most by which a profile may change a colour to be taken for sRGB [code values]."""


@dataclass(frozen=True, eq=False)
class ColorTransform:
    """Colours of a profile to those of sRGB."""

    name: str
    """The profile's own name."""
    curves: np.ndarray
    """Light of a code value, for every channel, [3, 256] float32, 0 to 1."""
    matrix: np.ndarray
    """Linear light of the profile to linear sRGB, [3, 3] float32."""

    def apply(self, pixels: np.ndarray) -> np.ndarray:
        """Convert a picture.

        Args:
            pixels: Code values, [H, W, 3] uint8.

        Returns:
            Code values of sRGB, [H, W, 3] uint8; what lies outside of it is cut off.
        """
        light = np.stack([self.curves[c][pixels[..., c]] for c in range(3)], axis=2)
        light = light @ self.matrix.T
        np.clip(light, 0.0, 1.0, out=light)
        np.sqrt(light, out=light)
        light *= _STEPS - 1
        return _ENCODED[(light + np.float32(0.5)).astype(np.uint16)]

    @property
    def is_srgb(self) -> bool:
        """Whether it leaves colours as they are, but for rounding."""
        steps = np.linspace(0, 255, 18).astype(np.uint8)
        every = np.stack(np.meshgrid(steps, steps, steps), axis=3).reshape(1, -1, 3)
        return bool(np.abs(self.apply(every).astype(int) - every).max() <= _ALIKE)


def transform_of(profile: bytes, *, gray: bool) -> ColorTransform:
    """Read a profile.

    Args:
        profile: Its bytes.
        gray: Whether the picture has no colours.

    Raises:
        ValueError: If it is damaged, of another kind, or for other pictures.
    """
    try:
        tags = _tags_of(profile)
        space = profile[16:20]
        name = _name_of(tags.get(b"desc", b""))
        if space == b"GRAY" and gray:
            return ColorTransform(name, np.stack([_curve(tags[b"kTRC"])] * 3), _UNCHANGED)
        if space != b"RGB ":
            raise ValueError(f"it is for {space.decode('latin-1').strip()} pictures")
        if b"rXYZ" not in tags:
            raise ValueError("it is a table of colours")
        columns = [struct.unpack(">3i", tags[tag][8:20]) for tag in (b"rXYZ", b"gXYZ", b"bXYZ")]
        to_d50 = np.array(columns).T / 65536
        matrix = (np.linalg.inv(_SRGB_TO_D50) @ to_d50).astype(np.float32)
        curves = np.stack([_curve(tags[tag]) for tag in (b"rTRC", b"gTRC", b"bTRC")])
        return ColorTransform(name, curves, matrix)
    except (KeyError, IndexError, struct.error, OverflowError) as error:
        raise ValueError("it is damaged") from error


def transform_of_primaries(number: int) -> ColorTransform | None:
    """The transform of pictures that state their primaries without a profile.

    Args:
        number: FFmpeg's number of the primaries.

    Returns:
        The transform; None for those of sRGB, and for what is close to them or not known.
    """
    if number not in _PRIMARIES:
        return None
    name, primaries = _PRIMARIES[number]
    matrix = np.linalg.inv(_to_xyz(_SRGB)) @ _to_xyz(primaries)
    curve = _decoded(np.arange(256) / 255).astype(np.float32)
    return ColorTransform(name, np.stack([curve] * 3), matrix.astype(np.float32))


def _tags_of(profile: bytes) -> dict[bytes, bytes]:
    """Contents of a profile's tags by their letters."""
    if profile[36:40] != b"acsp":
        raise ValueError("it is damaged")
    (count,) = struct.unpack_from(">I", profile, 128)
    tags = {}
    for number in range(min(count, 1000)):
        letters, begin, length = struct.unpack_from(">4sII", profile, 132 + 12 * number)
        tags[letters] = profile[begin : begin + length]
    return tags


def _curve(tag: bytes) -> np.ndarray:
    """Light of the 256 code values, [256] float32."""
    code = np.arange(256) / 255
    if tag[:4] == b"curv":
        (count,) = struct.unpack_from(">I", tag, 8)
        if count == 0:
            light = code
        elif count == 1:
            light = code ** (struct.unpack_from(">H", tag, 12)[0] / 256)
        else:
            table = np.array(struct.unpack_from(f">{count}H", tag, 12)) / 65535
            light = np.interp(code, np.linspace(0, 1, count), table)
    elif tag[:4] == b"para":
        light = _parametric(tag, code)
    else:
        raise ValueError("it has a curve of another kind")
    return np.clip(np.nan_to_num(light), 0, 1).astype(np.float32)


def _parametric(tag: bytes, code: np.ndarray) -> np.ndarray:
    """A curve of one of five formulas."""
    (kind,) = struct.unpack_from(">H", tag, 8)
    lengths = (1, 3, 4, 5, 7)
    if kind >= len(lengths):
        raise ValueError("it has a curve of another kind")
    values = np.array(struct.unpack_from(f">{lengths[kind]}i", tag, 12)) / 65536
    gamma, a, b, c, d, e, f = np.pad(values, (0, 7 - len(values)))
    if kind == 0:
        return np.asarray(code**gamma)
    with np.errstate(divide="ignore", invalid="ignore"):
        power = np.maximum(a * code + b, 0) ** gamma
        if kind in (1, 2):
            shift = c if kind == 2 else 0.0
            return np.where(code >= -b / a, power + shift, shift)
        return np.where(code >= d, power + (e if kind == 4 else 0.0), c * code + f)


def _name_of(tag: bytes) -> str:
    """A profile's description, of version 2 or 4."""
    if tag[:4] == b"desc":
        (length,) = struct.unpack_from(">I", tag, 8)
        text = tag[12 : 12 + length].decode("latin-1")
    elif tag[:4] == b"mluc":
        length, begin = struct.unpack_from(">II", tag, 20)
        text = tag[begin : begin + length].decode("utf-16-be", "replace")
    else:
        text = ""
    return "".join(c for c in text if c.isprintable()).strip()[:60] or "a colour profile"


def _to_xyz(primaries: tuple[tuple[float, float], ...]) -> np.ndarray:
    """Linear light of three primaries to XYZ, with a white of D65."""
    columns = np.array([(x / y, 1.0, (1 - x - y) / y) for x, y in primaries]).T
    white = np.array([_D65[0] / _D65[1], 1.0, (1 - sum(_D65)) / _D65[1]])
    return np.asarray(columns * np.linalg.solve(columns, white))


def _decoded(code: np.ndarray) -> np.ndarray:
    """Light of sRGB's code values from 0 to 1."""
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)


def _encoding_table() -> np.ndarray:
    """sRGB's code value of light, by its square root, [65536] uint8."""
    light = (np.arange(_STEPS) / (_STEPS - 1)) ** 2
    code = np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)
    return np.rint(255 * code).astype(np.uint8)


_ENCODED = _encoding_table()
_UNCHANGED = np.eye(3, dtype=np.float32)
