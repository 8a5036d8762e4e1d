"""The editor's server: who is let in, what is refused, and that it lives on."""

import json
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, closing
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

from pipeline.cli import main
from pipeline.editor.serving.address import Address, listening
from pipeline.editor.serving.pace import Pace
from pipeline.editor.wire.asked import AskError, read_asked
from pipeline.options.edit_log import EditLog
from stages.hand.worked import Worked
from tests import media_samples as samples
from tests.editing import Served, opened, raw_answer, served, write_job


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """A server with a still."""
    with served(write_job(tmp_path_factory.mktemp("job"))) as found:
        yield found


def ask(window: ClientConnection, what: str, **values: Any) -> dict[str, Any]:
    """Ask for something; the answer, whatever comes before it."""
    window.send(json.dumps({"number": 1, "ask": what, **values}))
    while True:
        words = window.recv(timeout=30)
        if isinstance(words, str) and "re" in (found := json.loads(words)):
            return found


def send_and_wait(window: ClientConnection, texts: list[str]) -> None:
    """Send messages, and listen until the connection is closed."""
    for text in texts:
        window.send(text)
    while True:
        window.recv(timeout=10)


def news(window: ClientConnection) -> dict[str, Any]:
    """The next words that nobody asked for."""
    while True:
        words = window.recv(timeout=30)
        if isinstance(words, str) and "tell" in (found := json.loads(words)):
            return found


def get(server: Served, path: str, *headers: str, method: str = "GET") -> bytes:
    """The answer to a request; the headers begin with Host unless others are given."""
    named = any(header.startswith("Host") for header in headers)
    own = headers if named else (f"Host: {server.host}", *headers)
    request = "\r\n".join([f"{method} {path} HTTP/1.1", *own, "Connection: close", "", ""])
    return raw_answer(server, request.encode("latin-1"))


def status(answer: bytes) -> int:
    return int(answer.split(maxsplit=2)[1])


def test_the_page_is_served_with_its_own_rules(server: Served) -> None:
    answer = get(server, f"/{server.address.token}/")
    assert status(answer) == 200
    assert b"default-src 'none'; script-src 'self'" in answer
    assert b"no-referrer" in answer
    assert status(get(server, f"/{server.address.token}/view/painter.js")) == 200


@pytest.mark.parametrize(
    "headers",
    [
        ["Host: evil.example:80"],
        ["Host: 127.0.0.1:1"],
        ["Host: 127.0.0.1.evil.example:{port}"],
        ["Host: 127.0.0.1:{port}", "Host: evil.example"],
        ["Host: 127.0.0.1:{port}", "Origin: http://evil.example"],
        ["Host: 127.0.0.1:{port}", "Origin: null"],
        ["Host: 127.0.0.1:{port}", "Origin: https://127.0.0.1:{port}"],
    ],
    ids=str,
)
def test_other_hosts_and_origins_are_refused(server: Served, headers: list[str]) -> None:
    """A page of another site may make a browser ask, and gets nothing but a no."""
    told = [header.format(port=server.address.port) for header in headers]
    assert status(get(server, f"/{server.address.token}/", *told)) in (400, 403)


@pytest.mark.parametrize(
    "path",
    [
        *("/", "/index.html", "/socket", "/wrong/", "/{half}/", "/{token}x/", "//{token}/"),
        *("/{token}/../{token}/nothing", "/{token}/../../etc/passwd"),
        *("/{token}/%2e%2e/%2e%2e/etc/passwd", "/{token}/..%2fserving/server.py"),
        *("/{token}//etc/passwd", "/{token}/jsconfig.json", "/{token}/main.js%00.png"),
        *("/{token}/view\\painter.js", "/{token}/MAIN.JS"),
    ],
)
def test_there_are_no_other_paths(server: Served, path: str) -> None:
    word = server.address.token
    answer = get(server, path.format(token=word, half=word[:16]))
    assert status(answer) in (400, 403, 404)
    assert b"root:" not in answer


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "OPTIONS", "TRACE"])
def test_nothing_is_changed_by_other_requests(server: Served, method: str) -> None:
    assert status(get(server, f"/{server.address.token}/", method=method)) == 403


def test_the_word_is_in_no_line_of_the_log(server: Served) -> None:
    get(server, f"/{server.address.token}/", "Origin: http://evil.example")
    assert "another page" in server.lines[-1]
    assert server.address.token not in "".join(server.lines)


@pytest.mark.parametrize("origin", ["http://evil.example", "null"])
def test_windows_of_other_pages_are_refused(server: Served, origin: str) -> None:
    with pytest.raises(InvalidStatus, match="403"):
        connect(server.socket_url, additional_headers={"Origin": origin})


def test_windows_without_the_word_are_refused(server: Served) -> None:
    with pytest.raises(InvalidStatus, match="403"):
        connect(server.socket_url.replace(server.address.token, "wrong"))


MALFORMED = [
    *("", "{", "[]", "null", "1e999", '{"number": 1}', '{"number": "1", "ask": "hello"}'),
    *('{"ask": "hello"}', "[" * 100_000, '{"number": NaN, "ask": "hello"}', "\ud83d\ude00"),
    '{"number": true, "ask": "undo"}',
]


@pytest.mark.parametrize("text", MALFORMED, ids=range(len(MALFORMED)))
def test_what_is_no_message_is_one_line(text: str) -> None:
    with pytest.raises(AskError) as error:
        read_asked(text)
    assert "\n" not in str(error.value)


WRONG = [
    ("nothing", {}, "nothing is called"),
    ("look", {}, "it needs frame"),
    ("look", {"frame": -1}, "counts something"),
    ("look", {"frame": 10**30}, "counts something"),
    ("look", {"frame": 7}, "the track holds frames 0 to 0"),
    ("edit", {"edits": []}, "from 1 to"),
    ("edit", {"edits": [5]}, "is not an edit"),
    ("edit", {"edits": [{"edit": "fly", "frame": 0}]}, "no edit is called"),
    ("edit", {"edits": [{"edit": "split_edge", "frame": 0, "at": ["a", 1]}]}, "split_edge"),
    (
        "edit",
        {"edits": [{"edit": "split_edge", "frame": 0, "at": [1e9, 1]}]},
        "outside of the picture",
    ),
    ("edit", {"edits": [{"edit": "split_edge", "frame": 9, "at": [1, 1]}]}, "frames 0 to 0"),
    ("style", {"styles": ["hatchin"]}, "did you mean hatching"),
    ("style", {"styles": [{}]}, "texts"),
    ("style", {"styles": ["flat"] * 99}, "up to"),
]


def test_wrong_messages_are_told_and_change_nothing(server: Served) -> None:
    """One line each in the window; it can go on."""
    with connect(server.socket_url) as window:
        before = ask(window, "hello")["state"]
        for what, values, told in WRONG:
            reply = ask(window, what, **values)
            assert told in reply["error"], (what, values, reply)
            assert "\n" not in reply["error"]
        window.send("{not JSON")
        assert "not JSON" in json.loads(window.recv(timeout=10))["error"]
        assert ask(window, "hello")["state"] == before


def test_a_message_of_100_megabytes_is_refused(server: Served) -> None:
    """The window is closed before much of it is read, and the log has one line."""
    told = len(server.lines)
    with connect(server.socket_url) as window, pytest.raises(ConnectionClosed):
        send_and_wait(window, ["a" * 100_000_000])
    with connect(server.socket_url) as window:
        assert ask(window, "hello")["state"]["number"] == 0
    assert len(server.lines) <= told + 2


def test_a_flood_is_cut_off(server: Served) -> None:
    """A thousand messages at once close the window that sends them, and no other."""
    with connect(server.socket_url) as other, connect(server.socket_url) as window:
        with pytest.raises(ConnectionClosed) as closed:
            send_and_wait(window, ['{"number": 1, "ask": "nothing"}'] * 1000)
        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == 1008
        assert "too many messages" in server.lines[-1]
        assert "state" in ask(other, "hello")


def test_a_pace_lets_bursts_through() -> None:
    now = [0.0]
    pace = Pace(rate=10, burst=5, clock=lambda: now[0])
    assert [pace.is_kept() for _ in range(6)] == [True] * 5 + [False]
    now[0] = 1.0
    assert pace.is_kept()


def test_too_many_windows_are_refused(server: Served) -> None:
    with ExitStack() as windows:
        for _ in range(16):
            ask(windows.enter_context(connect(server.socket_url)), "hello")
        late = windows.enter_context(connect(server.socket_url))
        with pytest.raises(ConnectionClosed, match="too many"):
            late.recv(timeout=10)


@pytest.mark.parametrize(
    ("host", "named", "known"),
    [
        ("127.0.0.1", "localhost:80", True),
        ("127.0.0.1", "[::1]:80", True),
        ("127.0.0.1", "192.168.0.7:80", False),
        ("127.0.0.1", "127.0.0.1", False),
        ("0.0.0.0", "192.168.0.7:80", True),
        ("0.0.0.0", "evil.example:80", False),
        ("10.0.0.5", "10.0.0.5:80", True),
    ],
)
def test_which_hosts_are_this_server(host: str, named: str, known: bool) -> None:
    """Where all addresses are listened at numbers will do: a page of another site has a name."""
    assert Address(host, 80).knows_host(named) is known


def test_two_windows_see_one_job(server: Served) -> None:
    """What one does the other is shown; an edit after what it has not seen is refused."""
    edit = {"edit": "split_triangle", "frame": 0, "at": [40.0, 30.0]}
    with connect(server.socket_url) as one, connect(server.socket_url) as other:
        before = ask(one, "hello")["state"]["number"]
        ask(other, "hello")
        number = ask(one, "edit", edits=[edit], after=before)["number"]
        told = news(other)
        assert (told["tell"], told["number"]) == ("state", number)
        late = ask(other, "edit", edits=[{**edit, "at": [70.0, 50.0]}], after=before)
        assert "another window went on" in late["error"]
        assert ask(other, "undo") == {"re": 1, "frame": 0}


def test_what_is_written_is_told_with_its_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Even if the job was opened by its name alone: who looks for a file asks where."""
    write_job(tmp_path)
    monkeypatch.chdir(tmp_path)  # real need: a track is named from where one stands
    with served(Path("job.mtrk")) as server, connect(server.socket_url) as window:
        assert ask(window, "export", name="one.png")["path"] == str(tmp_path / "one.png")


def test_edits_do_not_wait_for_kernels_of_a_style(
    server: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    """They are compiled beside all else; the style is drawn once they are there."""
    compiles, goes_on = Event(), Event()

    def wait() -> None:
        compiles.set()
        assert goes_on.wait(30)

    # real need: kernels that are missing for as long as one likes
    monkeypatch.setattr(server.studio.session, "prepare", lambda *_: not goes_on.is_set())
    monkeypatch.setattr(server.studio.session, "compile_expected", wait)
    with connect(server.socket_url) as window:
        ask(window, "hello")
        assert "error" not in ask(window, "look", frame=0)
        ask(window, "style", styles=["flat"])
        assert compiles.wait(30)
        edit = {"edit": "split_triangle", "frame": 0, "at": [50.0, 30.0]}
        assert "error" not in ask(window, "edit", edits=[edit])
        assert "error" not in ask(window, "undo")
        goes_on.set()
        while not (isinstance(told := window.recv(timeout=30), bytes) and b'"drawn"' in told[:200]):
            pass


def test_a_killed_server_loses_nothing(tmp_path: Path) -> None:
    """All that was acknowledged is in force afterwards, and the mesh is as it was shown."""
    track = write_job(tmp_path)
    words = [sys.executable, "-m", "trimotion", "edit", str(track), "--no-open", "--quiet"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as program:
        assert program.stdout is not None
        url = program.stdout.readline().strip()
        with connect(f"{url.replace('http', 'ws', 1)}socket") as window:
            number = ask(window, "hello")["state"]["number"]
            for at in ([40.0, 30.0], [70.0, 50.0]):
                edit = {"edit": "insert", "frame": 0, "at": at, "radius": 9, "count": 3}
                number = ask(window, "edit", edits=[edit], after=number)["number"]
            last = {"edit": "flip_edge", "frame": 0, "at": [20.0, 20.0]}
            window.send(json.dumps({"number": 9, "ask": "edit", "edits": [last]}))
            program.kill()
        assert program.wait(timeout=30) == -signal.SIGKILL
    session = opened(track)
    edits = session.log.edits
    assert [type(edit).__name__ for edit in edits][:2] == ["Insert", "Insert"]
    assert len(edits) <= 3
    ground = session.film.snapshot(0).mesh
    again = EditLog(edits).replay(0, Worked(ground)).worked.mesh
    assert np.array_equal(session.worked(0).mesh.vertices, again.vertices)
    session.close()


def test_ctrl_c_ends_it_in_peace(tmp_path: Path) -> None:
    """All is saved at any time: the exit code says that all is well."""
    track = write_job(tmp_path)
    words = [sys.executable, "-m", "trimotion", "edit", str(track), "--no-open"]
    with subprocess.Popen(
        words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as program:
        assert program.stdout is not None
        assert program.stdout.readline().startswith("http://127.0.0.1:")
        program.send_signal(signal.SIGINT)
        told = program.communicate(timeout=60)[1]
    assert program.returncode == 0
    assert "Traceback" not in told


def test_mistakes_on_the_command_line_are_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A port that is taken, a host that there is not, a track that is none, another source."""
    track = write_job(tmp_path)
    (tmp_path / "none.mtrk").write_text("nothing")
    samples.write_still(tmp_path / "other.png", samples.picture(96, 64, 1))
    with closing(listening("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        mistakes = [
            (["edit", str(track), "--port", str(port)], 2, "leave it out for a free one"),
            (["edit", str(track), "--host", "no.such.host.invalid"], 2, "--host"),
            (["edit", str(tmp_path / "none.mtrk")], 3, "no mesh track"),
            (["edit", str(tmp_path / "other.png"), "-o", str(track)], 3, "not the source"),
            (["edit", str(tmp_path / "absent.mp4")], 3, "absent.mp4"),
        ]
        for words, code, told in mistakes:
            assert main([*words, "--no-open"]) == code
            said = capsys.readouterr().err
            assert told in said, said
            assert said.count("\n") == 1, said
