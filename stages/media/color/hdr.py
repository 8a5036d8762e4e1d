"""High dynamic range (PQ or HLG, BT.2020) to BT.709 pictures of 100 % white."""

from functools import lru_cache

import numpy as np

PEAK = 1000.0
"""Brightness that is mapped to full white [cd/m2]; most programmes are mastered for it."""
WHITE = 203.0
"""Brightness of diffuse white [cd/m2]. Source: ITU-R BT.2408, Sec. 2.1."""

_CODES = 65536
_M1, _M2 = 2610 / 16384, 2523 / 4096 * 128
_C1, _C2, _C3 = 3424 / 4096, 2413 / 4096 * 32, 2392 / 4096 * 32
_TO_709 = np.array(
    [
        [1.660491, -0.587641, -0.072850],
        [-0.124550, 1.132900, -0.008349],
        [-0.018151, -0.100579, 1.118730],
    ],
    dtype=np.float32,
)
_LUMA_2020 = np.array([0.2627, 0.6780, 0.0593], dtype=np.float32)


def tone_map(codes: np.ndarray, transfer: str) -> np.ndarray:
    """Map a picture to standard range.

    The largest channel follows the curve and the others keep their ratio to it, so hues stay.

    Args:
        codes: Full-range BT.2020 code values, [H, W, 3] uint16.
        transfer: `pq` or `hlg`.

    Returns:
        BT.709 code values, [H, W, 3] uint8.

    Source: ITU-R BT.2100 (transfers), BT.2390 Sec. 5.4 (curve), BT.2087 (primaries).
    """
    light = _light_table(transfer)[codes]
    if transfer == "hlg":
        luma = light @ _LUMA_2020
        light *= np.maximum(luma, 1e-6)[..., None] ** np.float32(0.2)
        light *= np.float32(PEAK / WHITE)
    red, green, blue = light[..., 0], light[..., 1], light[..., 2]
    brightest = np.maximum(np.maximum(red, green), blue)  # ten times as fast as max(axis=2)
    brightest = np.sqrt(brightest * np.float32(WHITE / 10000))
    index = np.minimum(brightest * (_CODES - 1), _CODES - 1).astype(np.uint16)
    light *= _gain_table()[index][..., None]
    light = light @ _TO_709.T
    np.clip(light, 0.0, 1.0, out=light)
    np.sqrt(light, out=light)
    light *= _CODES - 1
    return _code_table()[light.astype(np.uint16)]


def _pq_to_nits(code: np.ndarray) -> np.ndarray:
    root = code ** (1 / _M2)
    return 10000 * (np.maximum(root - _C1, 0) / (_C2 - _C3 * root)) ** (1 / _M1)


def _nits_to_pq(nits: np.ndarray | float) -> np.ndarray:
    power = (np.asarray(nits) / 10000) ** _M1
    return ((_C1 + _C2 * power) / (1 + _C3 * power)) ** _M2


@lru_cache(maxsize=2)
def _light_table(transfer: str) -> np.ndarray:
    """Light of a code value [1 = diffuse white; for HLG scene light, 1 = peak], [65536] float32."""
    code = np.arange(_CODES) / (_CODES - 1)
    if transfer == "pq":
        return (_pq_to_nits(code) / WHITE).astype(np.float32)
    a, b, c = 0.17883277, 0.28466892, 0.55991073
    scene = np.where(code <= 0.5, code**2 / 3, (np.exp((code - c) / a) + b) / 12)
    return scene.astype(np.float32)


@lru_cache(maxsize=1)
def _gain_table() -> np.ndarray:
    """Factor by which light of a brightness is dimmed, by sqrt(cd/m2 / 10000), [65536] float32."""
    nits = 10000 * (np.arange(_CODES) / (_CODES - 1)) ** 2
    top = _nits_to_pq(PEAK)
    signal = np.minimum(_nits_to_pq(nits) / top, 1.0)
    limit = float(_nits_to_pq(WHITE) / top)
    knee = 1.5 * limit - 0.5
    t = np.clip((signal - knee) / (1 - knee), 0, 1)
    spline = (
        (2 * t**3 - 3 * t**2 + 1) * knee
        + (t**3 - 2 * t**2 + t) * (1 - knee)
        + (-2 * t**3 + 3 * t**2) * limit
    )
    mapped = _pq_to_nits(np.where(signal < knee, signal, spline) * top)
    gain = np.divide(mapped, nits, out=np.ones_like(nits), where=nits > 0)
    return np.minimum(gain, 1.0).astype(np.float32)


@lru_cache(maxsize=1)
def _code_table() -> np.ndarray:
    """Code value of light for a BT.1886 display (gamma 2.4), by sqrt(light), [65536] uint8."""
    light = (np.arange(_CODES) / (_CODES - 1)) ** 2
    return np.rint(255 * light ** (1 / 2.4)).astype(np.uint8)
