"""Damaged, hostile and mistaken inputs: one clear error, or what can be saved."""

import os
from pathlib import Path

import media_samples as samples
import numpy as np
import pytest
from test_encode import convert

from stages.media import EncodeOptions, open_decoder, probe
from warp_kernels.errors import MediaError, OutputError


def good_video(path: Path, **how: object) -> Path:
    """40 noisy frames, so that the pictures fill most of the file."""
    noise = np.random.default_rng(1).integers(0, 255, (40, 48, 64, 3), dtype=np.uint8)
    return samples.write_video(path, list(noise), **how)


def read_all(path: Path) -> tuple[int, list[str]]:
    """Number of frames and the warnings."""
    with open_decoder(path) as decoder:
        count = sum(1 for _ in decoder)
    return count, decoder.warnings


@pytest.mark.parametrize(
    "content",
    [b"", b"\0" * 5000, np.random.default_rng(0).bytes(20000), b"hello\n" * 100],
    ids=["empty", "zeros", "random", "text"],
)
def test_no_media_at_all(tmp_path: Path, content: bytes) -> None:
    """Files that are no media are refused by name."""
    path = tmp_path / "bad.mp4"
    path.write_bytes(content)
    with pytest.raises(MediaError, match=r"bad\.mp4"):
        read_all(path)


def test_what_is_not_a_file(tmp_path: Path) -> None:
    """Missing names, folders, pipes and addresses are refused without touching them."""
    os.mkfifo(tmp_path / "pipe.mp4")
    for name in ("missing.mp4", "", "pipe.mp4"):
        with pytest.raises(MediaError):
            probe(tmp_path / name)
    for address in ("http://localhost/a.mp4", "rtsp://localhost/a", "concat:a|b", "pipe:0"):
        with pytest.raises(MediaError):
            probe(address)


def test_sound_only(tmp_path: Path) -> None:
    """A file without pictures says so."""
    path = samples.write_sound(tmp_path / "a.m4a")
    with pytest.raises(MediaError, match="no video stream"):
        probe(path)


def test_playlists_are_refused(tmp_path: Path) -> None:
    """A script cannot make us open other files."""
    video = good_video(tmp_path / "a.mp4")
    script = tmp_path / "list.ffconcat"
    script.write_text(f"ffconcat version 1.0\nfile {video.name}\n")
    playlist = tmp_path / "list.m3u8"
    playlist.write_text(
        f"#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\n{video.name}\n#EXT-X-ENDLIST\n"
    )
    for path in (script, playlist):
        with pytest.raises(MediaError):
            read_all(path)


def test_content_counts_not_the_ending(tmp_path: Path) -> None:
    """A video with the ending of a picture is still a video."""
    path = good_video(tmp_path / "a.mp4").rename(tmp_path / "a.png")
    assert read_all(path)[0] == 40


def test_file_that_breaks_off(tmp_path: Path) -> None:
    """The frames that are there are converted, and a warning tells the rest is missing."""
    path = good_video(tmp_path / "a.mp4", options={"bf": "0"})
    faststart = tmp_path / "fast.mp4"
    convert(path, faststart, EncodeOptions(audio=False))
    content = faststart.read_bytes()
    faststart.write_bytes(content[: len(content) * 6 // 10])
    count, warnings = read_all(faststart)
    assert 5 <= count < 40
    assert any("breaks off" in warning for warning in warnings)


def test_file_without_its_index(tmp_path: Path) -> None:
    """An mp4 whose index was never written cannot be read."""
    path = good_video(tmp_path / "a.mp4")
    path.write_bytes(path.read_bytes()[:-4000])
    with pytest.raises(MediaError):
        read_all(path)


@pytest.mark.parametrize("seed", range(6))
def test_random_damage_never_crashes(tmp_path: Path, seed: int) -> None:
    """Whatever bytes are hit: frames in order of time, or a MediaError."""
    path = good_video(tmp_path / "a.mp4")
    content = bytearray(path.read_bytes())
    rng = np.random.default_rng(seed)
    for place in rng.integers(0, len(content), len(content) // 400):
        content[place] = rng.integers(256)
    path.write_bytes(bytes(content))
    try:
        with open_decoder(path) as decoder:
            times = [frame.pts for frame in decoder]
    except MediaError:
        times = []
    assert times == sorted(set(times))


@pytest.mark.parametrize("size", [(30000, 30000), (65535, 65535), (12000, 12000)])
def test_bombs_are_refused(tmp_path: Path, size: tuple[int, int]) -> None:
    """A small file that claims a huge picture is refused before memory is taken for it."""
    path = samples.png_header_only(tmp_path / "bomb.png", *size)
    with pytest.raises(MediaError, match="million pixels"):
        probe(path)


def test_limit_on_pixels_can_be_set(tmp_path: Path) -> None:
    """The limit is the caller's."""
    path = samples.write_still(tmp_path / "a.png", samples.picture(100, 100))
    with pytest.raises(MediaError, match="million"):
        open_decoder(path, max_pixels=9999)
    open_decoder(path, max_pixels=10000).close()


def test_truncated_still(tmp_path: Path) -> None:
    """Half a picture is no picture."""
    noise = np.random.default_rng(1).integers(0, 255, (64, 64, 3), dtype=np.uint8)
    path = samples.write_still(tmp_path / "a.png", noise)
    path.write_bytes(path.read_bytes()[:3000])
    with pytest.raises(MediaError, match="png"):
        read_all(path)


def test_no_stills_of_a_pattern(tmp_path: Path) -> None:
    """A pattern that matches nothing shows what was looked for."""
    with pytest.raises(MediaError, match=r"s_0001\.png"):
        probe(tmp_path / "s_####.png")


def test_damaged_still_of_a_sequence_is_left_out(tmp_path: Path) -> None:
    """One bad still does not cost the others."""
    for number in range(3):
        samples.write_still(tmp_path / f"s_{number:02}.png", samples.picture(16, 8))
    (tmp_path / "s_01.png").write_bytes(b"\x89PNG\r\n\x1a\nbroken")
    with open_decoder(tmp_path / "s_##.png") as decoder:
        assert [frame.index for frame in decoder] == [0, 2]
    assert any("s_01.png" in warning for warning in decoder.warnings)


def test_errors_name_file_problem_and_remedy() -> None:
    """The one line that users see has all three."""
    error = OutputError("a.mp4", "is full", "empty it")
    assert str(error) == "a.mp4: is full; empty it"
    assert (error.exit_code, MediaError("a", "b", "c").exit_code) == (4, 3)
