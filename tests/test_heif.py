"""Photos of phones: whole, cropped to their true size, upright, never a part."""

from pathlib import Path

import heif_samples as heif
import media_samples as samples
import numpy as np
import pytest
from PIL import Image, ImageOps, features

from stages.media import open_decoder, probe
from warp_kernels.errors import MediaError


def photo(width: int, height: int) -> np.ndarray:
    """Every part of it differs from every other."""
    pixels = samples.picture(width, height)
    pixels[..., 2] = (np.indices((height, width)).sum(axis=0) * 2) % 256
    return pixels


def shown(path: Path) -> np.ndarray:
    """The photo of a file."""
    with open_decoder(path) as decoder:
        (frame,) = decoder
        assert (decoder.info.kind, decoder.info.container) == ("image", "heif")
        assert frame.pixels.shape[:2] == (decoder.info.height, decoder.info.width)
    return frame.pixels


def assert_alike(found: np.ndarray, expected: np.ndarray) -> None:
    """Equal but for what the coder loses."""
    assert found.shape == expected.shape
    assert np.abs(found.astype(int) - expected).max() < 24


@pytest.mark.parametrize("size", [(128, 128), (130, 70), (192, 64), (40, 150), (64, 64)])
def test_tiles_make_the_whole_photo(tmp_path: Path, size: tuple[int, int]) -> None:
    """Without the padding of the last ones, and not the thumbnail that comes first."""
    pixels = photo(*size)
    assert_alike(shown(heif.write_grid(tmp_path / "a.heic", pixels)), pixels)


@pytest.mark.parametrize("place", [(0, 0, 100, 60), (20, 8, 90, 50), (21, 9, 91, 51)])
def test_photos_are_cropped(tmp_path: Path, place: tuple[int, int, int, int]) -> None:
    """At even and at odd places."""
    pixels = photo(130, 70)
    path = tmp_path / "a.heic"
    heif.write_grid(path, pixels, properties=(heif.crop(*place, (130, 70)),))
    left, top, width, height = place
    assert_alike(shown(path), pixels[top : top + height, left : left + width])


@pytest.mark.parametrize("angle", [0, 90, 180, 270])
@pytest.mark.parametrize("axis", [None, 0, 1])
def test_photos_are_turned_and_mirrored(tmp_path: Path, angle: int, axis: int | None) -> None:
    """In the order in which the file lists it."""
    pixels = photo(130, 70)
    mirrors = () if axis is None else (heif.mirror(axis),)
    path = tmp_path / "a.heic"
    heif.write_grid(path, pixels, properties=(heif.turn(angle), *mirrors))
    expected = np.rot90(pixels, angle // 90)
    if axis is not None:
        expected = expected[:, ::-1] if axis else expected[::-1]
    assert_alike(shown(path), expected)


def test_a_mirror_before_a_turn(tmp_path: Path) -> None:
    """The order matters."""
    pixels = photo(130, 70)
    properties = (heif.mirror(1), heif.turn(90))
    path = heif.write_grid(tmp_path / "a.heic", pixels, properties=properties)
    assert_alike(shown(path), np.rot90(pixels[:, ::-1]))


def test_a_photo_without_all_its_tiles_is_refused(tmp_path: Path) -> None:
    """One line, never a part of the photo."""
    path = heif.write_grid(tmp_path / "a.heic", photo(130, 70), kept=4)
    with pytest.raises(MediaError, match="of its photo"):
        probe(path)


def test_a_photo_with_a_damaged_tile_is_refused(tmp_path: Path) -> None:
    """One line, never a part of the photo."""
    path = heif.write_grid(tmp_path / "a.heic", photo(130, 70))
    content = path.read_bytes()
    path.write_bytes(content[:-400] + bytes(400))
    with pytest.raises(MediaError, match="photo"):
        shown(path)


@pytest.mark.parametrize("seed", range(40))
def test_damaged_boxes_are_one_line(tmp_path: Path, seed: int) -> None:
    """Whatever is hit: a photo of the size that the file states, or a MediaError."""
    content = bytearray(heif.write_grid(tmp_path / "a.heic", photo(70, 40)).read_bytes())
    rng = np.random.default_rng(seed)
    for place in rng.integers(8, content.index(b"mdat"), 3):
        content[place] = rng.integers(256)
    (tmp_path / "b.heic").write_bytes(bytes(content))
    try:
        with open_decoder(tmp_path / "b.heic") as decoder:
            for frame in decoder:
                assert (frame.width, frame.height) == (decoder.info.width, decoder.info.height)
    except MediaError:
        pass


needs_avif = pytest.mark.skipif(not features.check("avif"), reason="Pillow without AVIF")


@needs_avif
def test_avif_photos_are_shown_in_all_orientations(tmp_path: Path) -> None:
    """Another writer's files."""
    for number in range(1, 9):
        exif = Image.Exif()
        exif[0x0112] = number
        path = tmp_path / f"{number}.avif"
        Image.fromarray(photo(70, 40)).save(path, exif=exif, quality=95, subsampling="4:4:4")
        opened = Image.open(path)
        # Pillow's reader turns AVIF itself or hands the tag on, by its version
        expected = np.asarray(ImageOps.exif_transpose(opened).convert("RGB"))
        assert_alike(shown(path), expected)


@needs_avif
def test_transparent_avif_photos(tmp_path: Path) -> None:
    """Half the picture is hidden: paper shows through."""
    pixels = np.dstack([photo(70, 40), np.full((40, 70), 255, np.uint8)])
    pixels[:, :35, 3] = 0
    path = tmp_path / "a.avif"
    Image.fromarray(pixels).save(path, quality=95, subsampling="4:4:4")
    found = shown(path)
    assert (found[:, :33] > 250).all()
    assert_alike(found[:, 37:], pixels[:, 37:, :3])
