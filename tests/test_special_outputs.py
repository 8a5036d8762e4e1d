"""Outputs where a device, a pipe or a socket stands: refused, and what stands there stays.

A finished file is moved onto its name, which would take the device away: `-o /dev/null` of an
administrator once replaced it for the whole machine.
"""

import os
import stat
import subprocess
import sys
from pathlib import Path

import media_samples as samples
import pytest
from test_listening import save

from benchmarks.made_music import Piece, play
from pipeline.cli import main
from pipeline.edit_log.json_lines import write_log
from pipeline.options.edit_log import EditLog
from stages.media.writing.commit import PendingFile
from stages.media.writing.still_writer import write_picture
from warp_kernels.errors import OutputError

QUICK = ["--triangles", "12", "--iterations", "1", "--frame-iterations", "1", "--progress", "none"]


@pytest.fixture(scope="module")
def given(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a clip, a song, a timeline and a track."""
    folder = tmp_path_factory.mktemp("given")
    samples.write_video(folder / "clip.mp4", [samples.picture(32, 24, n) for n in range(2)])
    (folder / "show.toml").write_text('[curves]\n"grade.hue" = "t"\n')
    save(folder / "song.wav", play(Piece(120, seconds=3)).sound[None])
    solved = ["solve", str(folder / "clip.mp4"), "-o", str(folder / "clip.mtrk"), *QUICK]
    assert main(solved) == 0
    return folder


COMMANDS = [
    "animate clip.mp4 -o OUT.mp4",
    "animate clip.mp4 -o OUT.gif",
    "animate clip.mp4 -o OUT.png --frames 1",
    "animate clip.mp4 -o OUT.svg --frames 1",
    "animate clip.mp4 -o OUT.npz",
    "animate clip.mp4 -o OUT_##.png",
    "animate clip.mp4 -o other.mp4 --track OUT.mtrk",
    "solve clip.mp4 -o OUT.mtrk",
    "render clip.mtrk -o OUT.mp4",
    "render clip.mtrk -o OUT.csv",
    "join clip.mtrk -o OUT.mtrk",
    "listen song.wav -o OUT.json",
    "listen song.wav --labels OUT.txt",
    "listen song.wav --plot OUT.png",
    "preview clip.mp4 -o OUT.png",
    "styles clip.mp4 --sheet OUT.png",
    "timeline show.toml --check clip.mp4 -o OUT.png",
]


@pytest.mark.parametrize("command", COMMANDS)
def test_every_writer_leaves_a_pipe_where_it_is(
    command: str, given: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """One line says so before any work is done, although --overwrite is given."""
    words = [str(given / one) if (given / one).exists() else one for one in command.split()]
    words = [one.replace("OUT", str(tmp_path / "out")).replace("other", "x") for one in words]
    output = Path(next(one for one in words if one.startswith(str(tmp_path))).replace("##", "01"))
    os.mkfifo(output)
    wanted = QUICK if command.startswith(("animate", "solve", "preview")) else []
    assert main([*words, "--overwrite", *wanted]) == 4
    told = capsys.readouterr().err
    assert told.splitlines()[-1].endswith("is no regular file; give the name of a file"), told
    assert stat.S_ISFIFO(output.stat().st_mode)
    assert os.listdir(tmp_path) == [output.name]


def test_what_appears_meanwhile_is_left(tmp_path: Path) -> None:
    """A pipe that was put in the place of an output while the work was done."""
    pending = PendingFile(tmp_path / "out.bin")
    pending.path.write_bytes(b"done")
    os.mkfifo(tmp_path / "out.bin")
    with pytest.raises(OutputError, match="no regular file"):
        pending.commit()
    with pytest.raises(OutputError, match="no regular file"):
        write_log(EditLog(), tmp_path / "out.bin")
    assert os.listdir(tmp_path) == ["out.bin"]


def test_a_device_stays(tmp_path: Path) -> None:
    """The full device, and a link to it: who may not make one skips."""
    device = tmp_path / "full.png"
    try:
        os.mknod(device, stat.S_IFCHR | 0o600, os.makedev(1, 7))
    except (OSError, AttributeError):
        pytest.skip("only an administrator can make a device")
    (tmp_path / "link.png").symlink_to(device)
    for path in (device, tmp_path / "link.png"):
        with pytest.raises(OutputError, match="no regular file"):
            write_picture(path, samples.picture(8, 8))
        assert stat.S_ISCHR(path.stat().st_mode)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="other systems have no full device")
def test_a_pipe_to_where_there_is_no_room_is_told(tmp_path: Path) -> None:
    """In one line with the code of outputs: it is no mistake of the program."""
    write_picture(tmp_path / "in.png", samples.picture(16, 16))
    words = ["animate", str(tmp_path / "in.png"), "-o", "-.png", *QUICK]
    with Path("/dev/full").open("wb") as full:
        done = subprocess.run(
            [sys.executable, "-m", "trimotion", *words],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            cwd=Path(__file__).parents[1],
        )
    assert done.returncode == 4
    assert done.stderr.startswith("trimotion: error: -: cannot be written (no space left")
    assert done.stderr.count("\n") == 1
