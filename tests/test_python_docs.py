"""The examples of docs/python.md, docs/data.md and the README run and leave nothing behind."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGES = ("docs/python.md", "docs/data.md", "README.md")


def examples(page: str) -> list[str]:
    """The blocks of Python on a page."""
    text = (ROOT / page).read_text(encoding="utf-8")
    return re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL)


@pytest.mark.parametrize("page", PAGES)
def test_examples_run(page: str, tmp_path: Path, monkeypatch, capsys) -> None:
    """One after the other, in one program; what a comment says behind a print is printed.

    Takes seconds: they are what people try first, on clips as people have them.
    """
    (tmp_path / "sample_videos").symlink_to(ROOT / "sample_videos")
    monkeypatch.chdir(tmp_path)
    blocks = examples(page)
    assert blocks
    names: dict[str, object] = {}
    for number, block in enumerate(blocks):
        exec(compile(block, f"{page}, example {number}", "exec"), names)
        promised = re.findall(r"print\(.*\)  # (.*)", block)
        printed = capsys.readouterr().out.splitlines()
        assert not set(promised) - set(printed)
    assert {path.name for path in tmp_path.iterdir()} <= {"sample_videos", "out"}
