"""`--allow-url`: sources on the web, fetched only if the user says so."""

import argparse
import json
import threading
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest

import trimotion
from pipeline.cli import main
from pipeline.commands.addresses import fetched, is_address
from pipeline.commands.called import as_called
from pipeline.progress import Progress
from pipeline.track import TrackReader
from tests.jobs import job_of
from tests.media_samples import write_sound
from tests.tracks import CUT, QUICK_FLAGS, solve_to, write_clip
from warp_kernels.errors import MediaError, OptionError

ODD = {
    "/x/../..%2F..%2Fetc%2Fpasswd": "passwd",
    "/clips/shot_%23%23%23%23.png?q=1#t": "shot_____.png",
    "/%2e%2e": "download",
    "/": "download",
    "/a%00b.mp4": "a_b.mp4",
    "/-x.mp4": "x.mp4",
    f"/{'n' * 300}.mp4": f"{'n' * 116}.mp4",
}
"""Paths of addresses, and what the file is called."""


class Server(SimpleHTTPRequestHandler):
    """Serves a folder, and some answers that are none."""

    def do_GET(self) -> None:
        """Answer."""
        path = self.path.split("?")[0]
        if path.startswith("/away/"):
            self.send_response(302)
            self.send_header("Location", "file:///etc/hostname" if "file" in path else "/clip.mkv")
            self.end_headers()
        elif path == "/short.mp4":
            self.send_response(200)
            self.send_header("Content-Length", "5000")
            self.end_headers()
            self.wfile.write(b"x" * 100)
        elif path in (odd.split("?")[0] for odd in ODD) or path == "/text.mp4":
            self.send_response(200)
            self.end_headers()
            self.wfile.write(b"no film")
        else:
            super().do_GET()

    def log_message(self, *_: object) -> None:
        """Say nothing."""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, Path]]:
    """The address of a server on this machine, and its folder with a clip."""
    folder = tmp_path_factory.mktemp("site")
    write_clip(folder / "clip.mkv")
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Server, directory=str(folder)))
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02})
    thread.start()
    yield f"http://127.0.0.1:{server.server_port}", folder
    server.shutdown()
    thread.join()
    server.server_close()


@pytest.fixture(autouse=True)
def no_proxy(monkeypatch: pytest.MonkeyPatch) -> None:
    """This machine is reached directly."""
    monkeypatch.setenv("no_proxy", "127.0.0.1")


def animate(source: str, output: Path | str, *flags: str) -> int:
    """A quick run of three frames."""
    return main(
        ["animate", source, "-o", str(output), *QUICK_FLAGS, "--frames", "0-2", "-q", *flags]
    )


def test_a_film_on_the_web_is_as_good_as_a_file(site: tuple[str, Path], tmp_path: Path) -> None:
    """The same bits, by a redirection as well; a folder takes its name, a report its address."""
    address, folder = site
    assert animate(str(folder / "clip.mkv"), tmp_path / "file.mkv") == 0
    flags = ("--allow-url", "--report", str(tmp_path / "r.json"))
    assert animate(f"{address}/away/there", f"{tmp_path}/out/", *flags) == 0
    assert (tmp_path / "out/clip.mkv").read_bytes() == (tmp_path / "file.mkv").read_bytes()
    assert json.loads((tmp_path / "r.json").read_text())["source"] == f"{address}/away/there"


def test_a_film_on_the_web_is_told_of_and_compared(
    site: tuple[str, Path], tmp_path: Path, capsys
) -> None:
    """By the figures of the file itself."""
    address, file = f"{site[0]}/clip.mkv", str(site[1] / "clip.mkv")
    told = []
    for name in (file, address):
        assert main(["info", name, "--json", "--allow-url"]) == 0
        told.append(json.loads(capsys.readouterr().out))
    assert [each.pop("path") for each in told] == [file, address]
    assert told[0] == told[1]
    assert main(["measure", address, file, "--json", "--allow-url"]) == 0
    assert json.loads(capsys.readouterr().out)["rmse"] == 0
    assert main(["plan", address, "--json", "--allow-url"]) == 0
    planned = json.loads(capsys.readouterr().out)
    assert (planned["source"], planned["shots"]) == (address, [0, CUT])
    song = write_sound(site[1] / "song.m4a")
    for name in (str(song), f"{site[0]}/song.m4a"):
        assert main(["listen", name, "--allow-url", "-q"]) == 0
        told.append(capsys.readouterr().out)
        assert told[-1].startswith(f"{name}: ")
    assert told[-1].split(": ", 1)[1] == told[-2].split(": ", 1)[1]


def test_a_track_keeps_the_address(site: tuple[str, Path], tmp_path: Path, capsys) -> None:
    """In a temporary file's place: whoever reads it later must know whence the film came."""
    address, track = f"{site[0]}/clip.mkv", tmp_path / "job.mtrk"
    flags = ("--allow-url", "--track", str(track))
    assert animate(address, tmp_path / "out.mkv", *flags) == 0
    assert main(["info", str(track), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    places = (told["source"]["path"], told["info"]["path"], told["options"]["source"])
    assert places == (address,) * 3
    with trimotion.open_track(track) as opened:
        assert opened.source == address
    for words in (
        ("render", "-o", f"{tmp_path}/o.mkv", "--style", "source"),
        ("edit", "--no-open"),
    ):
        assert main([words[0], str(track), *words[1:]]) == 3
        error = capsys.readouterr().err
        assert error.startswith(f"trimotion: error: {address}: ")
        assert error.count("--source") == 1
    look = ("--style", "source", "--source", str(site[1] / "clip.mkv"), "-q")
    assert main(["render", str(track), "-o", f"{tmp_path}/o.mkv", *look]) == 0


class Stopping(Progress):
    """Breaks off where the user does."""

    def frame(self, done: int, total: int | None, triangles: int, rmse: float) -> None:
        """Be interrupted."""
        if done == 2:
            raise KeyboardInterrupt


def test_what_broke_off_keeps_the_address_and_another_track_its_own(
    site: tuple[str, Path], tmp_path: Path
) -> None:
    """An interrupted run is gone on with; a refused one leaves what stands in its way alone."""
    address, track = f"{site[0]}/clip.mkv", tmp_path / "job.mtrk"
    file, arguments = site[1] / "clip.mkv", argparse.Namespace(address=address)
    with pytest.raises(KeyboardInterrupt), as_called(arguments, job_of(file, track=track)):
        solve_to(track, file, "0-2", Stopping())
    with TrackReader(track) as reader:
        assert reader.header.source.path == address
    track.unlink()
    flags = ("-o", str(track), *QUICK_FLAGS, "--frames", "0-2", "-q")
    assert main(["solve", str(file), *flags]) == 0
    before = track.read_bytes()
    assert main(["solve", address, "--allow-url", *flags]) == 4
    assert track.read_bytes() == before
    assert main(["solve", address, "--allow-url", "--resume", *flags]) == 0
    with TrackReader(track) as reader:
        assert reader.header.source.path == address


def test_what_is_waited_for_is_told(site: tuple[str, Path], capsys) -> None:
    """Before it comes, in a note, by commands with and without progress."""
    address = f"{site[0]}/clip.mkv"
    for words in (
        ("info", address),
        ("plan", address),
        ("measure", address, str(site[1] / "clip.mkv")),
    ):
        assert main([*words, "--allow-url"]) == 0
        assert capsys.readouterr().err.startswith(f"trimotion: note: fetching {address}\n")


OTHERS = {"info": [], "measure": ["other.mkv"]}
"""What a command wants beside its source; others write a file."""


@pytest.mark.parametrize(
    "command", ["animate", "solve", "preview", "info", "measure", "plan", "listen"]
)
def test_nothing_is_fetched_unasked(command: str, tmp_path: Path, capsys) -> None:
    """The line names the option."""
    source = "https://example.invalid/clip.mp4"
    assert main([command, source, *OTHERS.get(command, ["-o", str(tmp_path / "o.png")])]) == 3
    error = capsys.readouterr().err
    assert error == (
        f"trimotion: error: {source}: is an address; add --allow-url to have it fetched\n"
    )


NOT_FETCHED = [
    ("edit", "URL", "--no-open"),
    ("edit", "URL", "--no-open", "--allow-url"),
    ("render", "URL", "-o", "a.mp4"),
    ("render", "a.mtrk", "--source", "URL", "-o", "a.mp4"),
    ("join", "a.mtrk", "URL", "-o", "b.mtrk"),
    ("measure", "a.mp4", "URL"),
    ("timeline", "pulse", "--check", "URL"),
    ("plan", "URL", "--allow-url", "--format", "slurm"),
    ("animate", "a.mp4", "-o", "URL", "--allow-url"),
]


@pytest.mark.parametrize("words", NOT_FETCHED, ids=" ".join)
def test_where_no_address_can_be_a_line_says_so(words: tuple[str, ...], capsys) -> None:
    """It names the address as it was written, and a file is the remedy."""
    address = "https://example.invalid/clip.mp4"
    assert main([address if word == "URL" else word for word in words]) in (2, 3, 4)
    error = capsys.readouterr().err
    named = "--allow-url" if words[0] == "edit" and "--allow-url" in words else address
    assert error.startswith(f"trimotion: error: {named}: ")
    assert ("address" in error) == (named == address)
    assert "file" in error.split("; ")[1]
    assert error.count("\n") == 1


def test_a_call_fetches_nothing(tmp_path: Path) -> None:
    """A program does that itself."""
    address = "https://example.invalid/clip.mp4"
    with pytest.raises(MediaError, match="is a network address"):
        trimotion.animate(address, tmp_path / "o.mp4")
    with pytest.raises(OptionError, match="urlretrieve fetches a file"):
        trimotion.animate(address, tmp_path / "o.mp4", allow_url=True)


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("/none.mp4", "cannot be fetched (file not found)"),
        ("/short.mp4", "cannot be fetched ("),
        ("/away/file", "cannot be fetched ("),
        ("/text.mp4", "not a readable media file"),
    ],
)
def test_what_gives_no_film_is_one_line(
    path: str, words: str, site: tuple[str, Path], tmp_path: Path, capsys
) -> None:
    """It names the address, and nothing is left."""
    assert animate(site[0] + path, tmp_path / "o.mp4", "--allow-url") == 3
    error = capsys.readouterr().err
    assert error.startswith(f"trimotion: error: {site[0]}{path}: {words}")
    assert error.count("\n") == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("address", ["file:///etc/hostname", "ftp://127.0.0.1/a", "concat://a"])
def test_other_kinds_of_addresses_are_refused(address: str, tmp_path: Path, capsys) -> None:
    """No protocol but those of the web, allowed or not."""
    assert animate(address, tmp_path / "o.mp4", "--allow-url") == 3
    assert "is an address of another kind; give http or https" in capsys.readouterr().err


def test_nobody_there_and_no_address_at_all(tmp_path: Path, capsys) -> None:
    """A port at which nothing listens; a host that is none."""
    for address in ("http://127.0.0.1:9/a.mp4", "http://[::bad/a.mp4", "http:///a.mp4"):
        assert animate(address, tmp_path / "o.mp4", "--allow-url") == 3
        error = capsys.readouterr().err
        assert error.startswith(f"trimotion: error: {address}: cannot be fetched (")
        assert "errno" not in error
        assert error.count("\n") == 1


def test_an_address_stands_alone(tmp_path: Path, capsys) -> None:
    """One of several inputs is refused before anything is fetched."""
    flags = ("-o", f"{tmp_path}/out/", "--allow-url")
    assert main(["animate", "a.mp4", "http://127.0.0.1:9/b.mp4", *flags]) == 2
    assert "an address is an input of its own" in capsys.readouterr().err


@pytest.mark.parametrize(("path", "name"), ODD.items())
def test_names_lead_nowhere(path: str, name: str, site: tuple[str, Path], tmp_path: Path) -> None:
    """Whatever stands in an address."""
    (tmp_path / "place").mkdir()
    found = fetched(site[0] + path, tmp_path / "place")
    assert found == tmp_path / "place" / name
    assert [one.name for one in tmp_path.iterdir()] == ["place"]


def test_files_are_no_addresses(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Even one that looks like an address."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "http:").mkdir()
    (tmp_path / "http:" / "a.mp4").touch()
    assert not is_address("http://a.mp4")
    assert is_address("http://b.mp4")
    assert not is_address("clip.mp4")
    with pytest.raises(MediaError):
        fetched("clip.mp4", tmp_path)
