"""What a thread has read of Warp's headers is lent to others, and to processes that come later."""

from pathlib import Path

import pytest

from warp_kernels.device.compiling import headers
from warp_kernels.device.compiling.headers import headers_are_read, shared_headers


@pytest.fixture
def threads(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """Folders of three threads that have not read anything, of which the last takes its turn."""
    folders = [tmp_path / f"thread{number}" for number in range(3)]
    for folder in folders:
        folder.mkdir()
    # real need: Warp names the folder of a thread, and this one has read already
    monkeypatch.setattr(headers, "_folder_of_thread", lambda: folders[-1])
    return folders


def test_the_next_thread_has_read_what_the_first_did(threads: list[Path], tmp_path: Path) -> None:
    """And what it reads in addition is lent to the third."""
    assert not headers_are_read(tmp_path)
    for _ in range(2):
        thread = threads[-1]
        with shared_headers(tmp_path):
            (thread / f"{thread.name}.pch").write_text(thread.name)
        threads.pop()
    assert headers_are_read(tmp_path)
    with shared_headers(tmp_path):
        assert (threads[-1] / "thread2.pch").read_text() == "thread2"
        assert (threads[-1] / "thread1.pch").read_text() == "thread1"


def test_what_the_compiler_refused_is_replaced(threads: list[Path], tmp_path: Path) -> None:
    """It reads anew and writes a file in place of the one that was lent."""
    for told in ("broken", "whole", "seen"):
        thread = threads[-1]
        with shared_headers(tmp_path):
            file = thread / "read.pch"
            if told == "seen":
                assert file.read_text() == "whole"
            else:
                file.unlink(missing_ok=True)
                file.write_text(told)
        threads.pop()


def test_where_nothing_can_be_kept_each_reads_for_itself(threads: list[Path]) -> None:
    """No error: it takes longer."""
    with shared_headers(Path("/dev/null")):
        (threads[-1] / "read.pch").write_text("read")
    assert not headers_are_read(Path("/dev/null"))


def test_warp_tells_where_a_thread_keeps_them() -> None:
    """It is asked for through a name that is not promised; without it each thread would read."""
    # real need: that it is gone shows in nothing but time
    assert headers._folder_of_thread().is_dir()
    # real need: as above
    assert headers._kept(Path("folder")).name.startswith(headers.PREFIX)
