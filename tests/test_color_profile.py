"""Colours of profiles come out as those of sRGB, as another program makes them."""

import io
import struct
from pathlib import Path

import icc_samples as icc
import numpy as np
import pytest
from PIL import Image, ImageCms
from test_encode import convert

from stages.media import open_decoder, probe
from stages.media.color.icc_profile import transform_of, transform_of_primaries

CURVES = {
    "linear": icc.table([]),
    "gamma": icc.gamma(1.8),
    "points": icc.table([int(65535 * (n / 30) ** 2.2) for n in range(31)]),
    "power": icc.formula(0, 2.2),
    "power with a foot": icc.SRGB_CURVE,
    "power and shifts": icc.formula(4, 2.4, 0.9, 0.1, 0.08, 0.05, 0.0, 0.0),
}


def every_color() -> np.ndarray:
    """A picture of 4,096 colours, [64, 64, 3] uint8."""
    steps = np.linspace(0, 255, 16).astype(np.uint8)
    return np.stack(np.meshgrid(steps, steps, steps), axis=3).reshape(64, 64, 3)


def as_others_see(pixels: np.ndarray, profile: bytes) -> np.ndarray:
    """Little CMS's conversion to sRGB."""
    made = ImageCms.profileToProfile(
        Image.fromarray(pixels),
        ImageCms.ImageCmsProfile(io.BytesIO(profile)),
        ImageCms.createProfile("sRGB"),
        renderingIntent=ImageCms.Intent.RELATIVE_COLORIMETRIC,
        outputMode="RGB",
    )
    return np.asarray(made).astype(int)


def shown(path: Path) -> tuple[np.ndarray, list[str]]:
    """Picture and notes."""
    with open_decoder(path) as decoder:
        return next(decoder).pixels.astype(int), decoder.notes


@pytest.mark.parametrize("curve", CURVES.values(), ids=CURVES)
@pytest.mark.parametrize("primaries", [icc.DISPLAY_P3, icc.SRGB[:, ::-1]], ids=["p3", "swapped"])
def test_profiles_are_converted(tmp_path: Path, curve: bytes, primaries: np.ndarray) -> None:
    """Every form of curve, of a wide and of a strange profile."""
    profile = icc.profile(primaries, curve)
    Image.fromarray(every_color()).save(tmp_path / "a.png", icc_profile=profile)
    found, notes = shown(tmp_path / "a.png")
    expected = as_others_see(every_color(), profile)
    assert np.abs(found - expected).max() <= 4  # steep at black
    assert np.abs(found - expected).mean() < 0.3
    assert notes == ["colours converted from made for a test to sRGB"]


@pytest.mark.parametrize("ending", ["jpg", "tif", "webp", "png"])
def test_every_kind_of_still(tmp_path: Path, ending: str) -> None:
    """Wherever a file keeps its profile."""
    profile = icc.profile(icc.DISPLAY_P3, icc.SRGB_CURVE, name="Display P3")
    flat = np.full((32, 32, 3), (180, 90, 40), np.uint8)
    path = tmp_path / f"a.{ending}"
    Image.fromarray(flat).save(path, icc_profile=profile, quality=95, lossless=True)
    found, notes = shown(path)
    assert np.abs(found - as_others_see(flat, profile)).max() <= 3
    assert "colours converted from Display P3 to sRGB" in notes


def test_grey_pictures(tmp_path: Path) -> None:
    """Their curve, and three equal channels."""
    profile = icc.profile(None, icc.gamma(1.0), b"GRAY")
    ramp = np.tile(np.arange(256, dtype=np.uint8), (4, 1))
    Image.fromarray(ramp).save(tmp_path / "a.png", icc_profile=profile)
    found, _ = shown(tmp_path / "a.png")
    light = ramp[..., None] / 255  # Little CMS is too coarse near black for a linear curve
    encoded = np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)
    assert np.abs(found - 255 * encoded).max() <= 1


def test_srgb_itself_changes_nothing(tmp_path: Path) -> None:
    """And nothing is told of it."""
    for profile in (
        icc.profile(icc.SRGB, icc.SRGB_CURVE),
        ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes(),
    ):
        Image.fromarray(every_color()).save(tmp_path / "a.png", icc_profile=profile)
        found, notes = shown(tmp_path / "a.png")
        assert np.array_equal(found, every_color())
        assert notes == []


def test_what_cannot_be_converted_is_told(tmp_path: Path) -> None:
    """Tables, profiles for print, damaged ones: colours stay, and a note says so."""
    good = icc.profile(icc.DISPLAY_P3, icc.SRGB_CURVE)
    for profile in (
        icc.profile(None, icc.SRGB_CURVE),
        icc.profile(None, icc.SRGB_CURVE, b"CMYK"),
        icc.profile(None, icc.gamma(2.2), b"GRAY"),
        good[:200],
        good.replace(b"curv", b"cruv").replace(b"para", b"prap"),
        struct.pack(">I", 40) + bytes(36),
    ):
        Image.fromarray(every_color()).save(tmp_path / "a.png", icc_profile=profile)
        found, notes = shown(tmp_path / "a.png")
        assert np.array_equal(found, every_color())
        assert any("profile left out" in note for note in notes)


@pytest.mark.parametrize("seed", range(60))
def test_damaged_profiles_never_crash(seed: int) -> None:
    """Whatever bytes are hit."""
    profile = bytearray(icc.profile(icc.DISPLAY_P3, icc.SRGB_CURVE))
    rng = np.random.default_rng(seed)
    for place in rng.integers(0, len(profile), 12):
        profile[place] = rng.integers(256)
    try:
        transform = transform_of(bytes(profile), gray=False)
    except ValueError:
        return
    transform.apply(every_color())


def test_a_profile_is_applied_once(tmp_path: Path) -> None:
    """What is written holds sRGB and says nothing else."""
    profile = icc.profile(icc.DISPLAY_P3, icc.SRGB_CURVE)
    Image.fromarray(every_color()).save(tmp_path / "a.png", icc_profile=profile)
    convert(tmp_path / "a.png", tmp_path / "b.png")
    assert probe(tmp_path / "b.png").notes == ()
    first, _ = shown(tmp_path / "a.png")
    second, _ = shown(tmp_path / "b.png")
    assert np.array_equal(first, second)


def test_transparent_parts_keep_the_paper(tmp_path: Path) -> None:
    """The profile is the picture's, not the paper's."""
    pixels = np.dstack([np.full((8, 8, 3), (180, 90, 40), np.uint8), np.zeros((8, 8), np.uint8)])
    profile = icc.profile(icc.SRGB[:, ::-1] * 0.5, icc.gamma(1.0))
    Image.fromarray(pixels).save(tmp_path / "a.png", icc_profile=profile)
    assert (shown(tmp_path / "a.png")[0] == 255).all()


def test_stills_of_a_sequence_have_profiles_of_their_own(tmp_path: Path) -> None:
    """One with and one without."""
    flat = np.full((8, 8, 3), (180, 90, 40), np.uint8)
    profile = icc.profile(icc.SRGB[:, ::-1], icc.SRGB_CURVE)
    Image.fromarray(flat).save(tmp_path / "s_01.png")
    Image.fromarray(flat).save(tmp_path / "s_02.png", icc_profile=profile)
    with open_decoder(tmp_path / "s_##.png") as decoder:
        first, second = decoder
    assert first.pixels[0, 0].tolist() == [180, 90, 40]
    assert np.abs(second.pixels[0, 0].astype(int) - [40, 90, 180]).max() <= 1


def test_cmyk_pictures(tmp_path: Path) -> None:
    """Turned to RGB without their profile, and that is told."""
    pixels = np.full((32, 32, 4), (0, 128, 255, 20), np.uint8)
    profile = icc.profile(None, icc.gamma(1.0), b"CMYK")
    Image.fromarray(pixels, mode="CMYK").save(tmp_path / "a.jpg", icc_profile=profile, quality=95)
    found, notes = shown(tmp_path / "a.jpg")
    assert np.abs(found[16, 16] - [235, 117, 0]).max() < 8
    assert any("CMYK" in note for note in notes)


def test_wide_primaries_without_a_profile() -> None:
    """Tagged Display P3: the reddest of sRGB is stored less saturated, and comes out whole."""
    wide = transform_of_primaries(12)
    assert wide is not None
    assert np.abs(wide.apply(np.full((1, 1, 3), 255, np.uint8)).astype(int) - 255).max() <= 1
    (red,) = wide.apply(np.array([[[234, 51, 35]]], np.uint8)).reshape(-1, 3)
    assert np.abs(red.astype(int) - [255, 0, 0]).max() <= 8
    assert transform_of_primaries(1) is None
