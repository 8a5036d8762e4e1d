"""The program in `client_of_trimotion.py`: complete, and it runs."""

import ast
from pathlib import Path

import trimotion
from tests import client_of_trimotion as client
from tests.tracks import write_clip


def test_client_uses_every_public_name() -> None:
    """What is new in `trimotion` is used there, so that type checkers see it."""
    tree = ast.parse(Path(client.__file__).read_text(encoding="utf-8"))
    used = {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
    used |= {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    assert set(trimotion.__all__) <= used
    for cls in (trimotion.Triangulation, trimotion.Track, trimotion.Animator, trimotion.Result):
        public = {name for name in dir(cls) if not name.startswith("_")}
        unused = public - used - {"close"}
        assert not unused, f"{cls.__name__}: {unused}"


def test_client_runs(tmp_path: Path, capsys) -> None:
    """And every kind of mistake is told as one."""
    clip = write_clip(tmp_path / "clip.mkv")
    kinds = [text.split(":")[0] for text in client.main(clip, tmp_path)]
    assert kinds == ["option", "media", "output", "track"]
    assert "3/3: " in capsys.readouterr().out
