"""What belongs to the whole process stays as it was: others may live in it."""

import os
from pathlib import Path

from pipeline.cli import main
from tests.media_samples import picture, write_video


def test_encoders_leave_the_environment(tmp_path: Path, capsys) -> None:
    """One of them is kept from printing by a variable, which is gone afterwards."""
    clip = write_video(tmp_path / "in.mp4", [picture(96, 64, number) for number in range(2)])
    before = {**os.environ}
    flags = ["--codec", "av1", "--triangles", "20", "--iterations", "2", "--progress", "none"]
    assert main(["animate", str(clip), "-o", str(tmp_path / "out.mp4"), *flags]) == 0
    assert dict(os.environ) == before
    assert capsys.readouterr().err == ""
