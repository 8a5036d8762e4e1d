"""The house rules that a machine can check, over the whole repository; proof that each bites."""

import ast
import dataclasses
import importlib
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests import architecture_rules
from tests.architecture_rules import (
    LEVELS,
    RULES,
    Module,
    foreign_paths,
    markdown_links,
    patches_and_pokes,
    upward_arrow,
)

ROOT = Path(__file__).parents[1]
RUNTIME_DEPENDENCIES = {
    "warp-lang",
    "numpy",
    "scipy",
    "opencv-contrib-python-headless",
    "av",
    "tqdm",
}
REGISTRIES = ("COLOR_MODELS", "EDITS", "LAYOUTS", "FLOWS", "FOCI", "SPACES", "STYLES", "TOPOLOGIES")
TEXT_SUFFIXES = {".py", ".md", ".toml", ".txt", ".yml", ".yaml", ".cfg", ".ini", ".json", ".sh", ""}


def repository_files() -> list[Path]:
    """Give the files of the repository, without what git ignores or what tools leave behind."""
    ignored = (ROOT / ".gitignore").read_text(encoding="utf-8").split()
    patterns = [".git", *(pattern.strip("/") for pattern in ignored)]
    return sorted(
        path
        for path in ROOT.rglob("*")
        if path.is_file()
        and not any(Path(part).match(p) for part in path.relative_to(ROOT).parts for p in patterns)
    )


FILES = repository_files()
MARKDOWN = [path for path in FILES if path.suffix == ".md"]
MODULES = [
    Module(path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8"))
    for path in FILES
    if path.suffix == ".py" and path.relative_to(ROOT).parts[0] in LEVELS
]

KERNEL = '"""K."""\nimport warp as wp\n\n@wp.kernel(enable_backward=False)\ndef k({}):\n    {}\n'
LONG_BODY = '"""M."""\ndef f():\n    """F."""\n' + "    x = 1\n" * 45

# (rule, path, source): each source departs from the rule once.
PLANTED = [
    ("imports_point_downwards", "stages/a.py", "from pipeline.options.job import Job"),
    ("imports_point_downwards", "warp_kernels/a.py", "def f():\n    import stages.mesh"),
    ("imports_point_downwards", "warp_kernels/a.py", "import numpy, pipeline"),
    ("imports_stay_at_home", "stages/a.py", "import warp as wp"),
    ("imports_stay_at_home", "pipeline/a.py", "from warp import launch"),
    ("imports_stay_at_home", "warp_kernels/a.py", "from scipy.sparse import coo_array"),
    ("imports_stay_at_home", "stages/render.py", "import cv2"),
    ("imports_stay_at_home", "stages/flows/dis.py", "import av.video"),
    ("imports_stay_at_home", "stages/a.py", "import argparse"),
    ("imports_stay_at_home", "stages/a.py", "from tqdm import tqdm"),
    ("imports_stay_at_home", "stages/track.py", "import sqlite3"),
    ("imports_stay_at_home", "pipeline/a.py", "import matplotlib.pyplot"),
    ("kernels_only_in_warp_kernels", "stages/a.py", KERNEL.format("x_out: float", "pass")),
    ("kernels_only_in_warp_kernels", "stages/a.py", "wp.launch(k, dim=1)"),
    ("kernels_only_in_warp_kernels", "pipeline/a.py", "warp.launch(k, dim=1)"),
    (
        "kernel_files_keep_annotations",
        "warp_kernels/a.py",
        "from __future__ import annotations\n@wp.kernel\ndef k(x_out: wp.array(dtype=float)): pass",
    ),
    ("kernel_outputs_come_last", "warp_kernels/a.py", KERNEL.format("a, b", "pass")),
    ("kernel_outputs_come_last", "warp_kernels/a.py", KERNEL.format("a_out, b", "pass")),
    ("kernel_outputs_come_last", "warp_kernels/a.py", KERNEL.format("a, b_out", "a[0] = 1")),
    ("kernel_outputs_come_last", "warp_kernels/a.py", KERNEL.format("a, b_out", "a[0] += 1")),
    (
        "kernel_outputs_come_last",
        "warp_kernels/a.py",
        KERNEL.format("a, b_out", "wp.atomic_add(a, 0, 1)"),
    ),
    ("memory_is_allocated_in_one_place", "warp_kernels/a.py", "x = wp.zeros(3, dtype=int)"),
    ("memory_is_allocated_in_one_place", "warp_kernels/a.py", "x = wp.array([1], dtype=int)"),
    ("memory_is_allocated_in_one_place", "warp_kernels/a.py", "x = wp.array(ptr=p, dtype=int)"),
    ("memory_is_allocated_in_one_place", "warp_kernels/a.py", "x = warp.empty_like(y)"),
    ("warp_is_called_under_its_lock", "warp_kernels/a.py", "with WARP:\n    wp.copy(a, b)"),
    ("warp_is_called_under_its_lock", "stages/a.py", "x = workspace.table.numpy()"),
    ("warp_is_called_under_its_lock", "warp_kernels/device/device.py", "wp.launch(k, 1, [], [])"),
    ("warp_is_called_under_its_lock", "warp_kernels/device/device.py", "def f(a):\n    a.fill_(1)"),
    ("warp_is_called_under_its_lock", "warp_kernels/device/device.py", "with lock:\n    wp.init()"),
    (
        "warp_is_called_under_its_lock",
        "warp_kernels/device/device.py",
        "with wp.ScopedCapture(device=d), WARP:\n    pass",
    ),
    (
        "kernels_of_their_own_module_are_exact",
        "warp_kernels/a.py",
        '@wp.kernel(enable_backward=False, module="unique")\ndef k(a_out): pass',
    ),
    (
        "kernels_call_no_library_of_functions",
        "warp_kernels/a.py",
        "@wp.func\ndef f(x: float) -> float:\n    return wp.exp(x)",
    ),
    (
        "kernels_call_no_library_of_functions",
        "warp_kernels/a.py",
        "@wp.func\ndef f(x: float) -> float:\n    return x**3.0",
    ),
    ("kernels_call_no_library_of_functions", "warp_kernels/a.py", "LOG = wp.log2"),
    ("modules_have_docstrings", "stages/a.py", "x = 1"),
    ("public_names_have_docstrings", "stages/a.py", "def f(): pass"),
    ("public_names_have_docstrings", "stages/a.py", "class A: pass"),
    ("public_names_have_docstrings", "stages/a.py", 'class _A:\n    def f(self): """"""'),
    ("functions_are_short", "stages/a.py", LONG_BODY),
    ("files_are_short", "stages/a.py", "x = 1\n" * 401),
    ("files_are_short", "stages/a.py", "x = 1  #" + "." * 93),
    ("files_are_named_after_one_thing", "stages/utils.py", ""),
    ("files_are_named_after_one_thing", "stages/common/mesh.py", ""),
    ("no_bare_except", "stages/a.py", "try:\n    pass\nexcept:\n    pass"),
]

# (rule, path, source): near a rule's edge, but within it.
ALLOWED = [
    ("imports_point_downwards", "pipeline/a.py", "import stages.mesh, warp_kernels.device.device"),
    ("imports_point_downwards", "stages/flows/a.py", "from . import dis\nfrom ..mesh import Mesh"),
    ("imports_stay_at_home", "stages/media/reading/source.py", "import av\nimport numpy as np"),
    ("imports_stay_at_home", "stages/layouts/importance.py", "import cv2, scipy.spatial"),
    ("kernels_only_in_warp_kernels", "stages/a.py", "process.launch()\nkernel(3)"),
    ("kernel_files_keep_annotations", "stages/a.py", "from __future__ import annotations"),
    ("kernel_outputs_come_last", "warp_kernels/a.py", KERNEL.format("a, b_out", "b_out[0] = a[0]")),
    (
        "memory_is_allocated_in_one_place",
        "warp_kernels/energy/workspace.py",
        "wp.zeros(3, dtype=int)",
    ),
    (
        "memory_is_allocated_in_one_place",
        "warp_kernels/a.py",
        KERNEL.format("a: wp.array(dtype=int, ndim=2), b_out: wp.array2d(dtype=int)", "pass"),
    ),
    (
        "memory_is_allocated_in_one_place",
        "warp_kernels/a.py",
        KERNEL.format("a_out", "x = wp.zeros(shape=3, dtype=float)"),
    ),
    ("memory_is_allocated_in_one_place", "stages/a.py", "x = np.zeros(3)"),
    (
        "warp_is_called_under_its_lock",
        "warp_kernels/device/device.py",
        "with WARP, wp.ScopedCapture(device=d) as c:\n    wp.launch(k, 1)\n    a.fill_(1)",
    ),
    (
        "warp_is_called_under_its_lock",
        "warp_kernels/device/device.py",
        "def replay(g):\n    wp.capture_launch(g)",
    ),
    (
        "warp_is_called_under_its_lock",
        "warp_kernels/a.py",
        KERNEL.format("a: wp.array(dtype=int), b_out", "x = wp.array(ptr=p, dtype=int)"),
    ),
    ("warp_is_called_under_its_lock", "warp_kernels/a.py", "x = wp.vec2d(1.0, 2.0)"),
    (
        "kernels_of_their_own_module_are_exact",
        "warp_kernels/a.py",
        '@wp.kernel(module="unique", module_options=EXACT)\ndef k(a_out): pass',
    ),
    (
        "kernels_call_no_library_of_functions",
        "warp_kernels/a.py",
        "@wp.func\ndef f(x: float) -> float:\n    return wp.sqrt(x) * wp.static(2.0**0.5)",
    ),
    ("kernels_call_no_library_of_functions", "stages/a.py", "x = np.exp(y) ** 2"),
    ("public_names_have_docstrings", "stages/a.py", "def _f(): pass"),
    ("functions_are_short", "stages/a.py", LONG_BODY.removesuffix("    x = 1\n")),
    ("files_are_short", "stages/a.py", "x = 1\n" * 400),
    ("files_are_named_after_one_thing", "pipeline/commonplace.py", ""),
    ("no_bare_except", "stages/a.py", "try:\n    pass\nexcept OSError:\n    pass"),
]


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.__name__)
def test_packages_keep_the_rule(rule) -> None:
    """No file of the three packages departs from the rule."""
    found = [f"{m.path}:{line}: {text}" for m in MODULES for line, text in rule(m)]
    assert not found, f"{rule.__doc__}\n" + "\n".join(found)


@pytest.mark.parametrize(("name", "path", "source"), PLANTED, ids=range(len(PLANTED)))
def test_planted_violation_is_found(name: str, path: str, source: str) -> None:
    """The rule finds exactly the one departure that the source holds."""
    assert len(list(getattr(architecture_rules, name)(Module(path, source)))) == 1


@pytest.mark.parametrize(("name", "path", "source"), ALLOWED, ids=range(len(ALLOWED)))
def test_what_is_allowed_passes(name: str, path: str, source: str) -> None:
    """The rule stays silent about what only looks like a departure."""
    assert not list(getattr(architecture_rules, name)(Module(path, source)))


def test_rooms_import_downwards() -> None:
    """Folders of a package stand over each other: none imports, by others or not, from itself."""
    assert not upward_arrow(MODULES)
    lower = Module("stages/low/a.py", "import stages.high.b")
    planted = [lower, Module("stages/high/b.py", "def f():\n    from stages.low import c")]
    assert set(upward_arrow(planted)) == {"stages/low", "stages/high"}
    assert not upward_arrow(planted[:1])


@pytest.mark.parametrize("path", sorted((ROOT / "tests").glob("*.py")), ids=lambda path: path.name)
def test_tests_bind_behaviour(path: Path) -> None:
    """No test patches the program or touches what is private, without a reason."""
    if path.name not in ("architecture_rules.py", "test_architecture.py"):
        assert not list(patches_and_pokes(path.read_text(encoding="utf-8")))


@pytest.mark.parametrize(
    "line", ["monkeypatch.setattr(a, 'b', 1)", "patch.setitem(TABLE, 1, 2)", "x = team._job"]
)
def test_patch_is_found(line: str) -> None:
    """Once; the environment, one's own fields and what has a reason may be touched."""
    assert len(list(patches_and_pokes(line))) == 1
    assert not list(patches_and_pokes(f"# real need: it takes an hour\n{line}"))
    assert not list(patches_and_pokes("monkeypatch.setenv('A', '1')\nself._kept = 1"))


def test_every_rule_is_planted() -> None:
    """A new rule comes with a violation that it finds, and the rules have files to judge."""
    assert {rule.__name__ for rule in RULES} == {name for name, _, _ in PLANTED}
    assert {module.package for module in MODULES} == set(LEVELS)


def test_long_kernel_is_found() -> None:
    """A kernel may have 60 lines, 61 are found; the factory around it is not counted twice."""
    head = "def make():\n  @wp.kernel\n  def k(a_out):\n"
    for lines, findings in ((60, 0), (61, 1)):
        source = head + "    x = 1\n" * (lines - 1) + "  return k\n"
        module = Module("warp_kernels/a.py", source)
        assert len(list(architecture_rules.functions_are_short(module))) == findings


def members_of(registry: str) -> Iterator[tuple[str, object]]:
    """Give the entries of a registry dict, by importing the one module that assigns it."""
    pattern = re.compile(rf"^{registry}\b.*=", flags=re.MULTILINE)
    owners = [module.path for module in MODULES if pattern.search(module.source)]
    if not owners:
        pytest.skip(f"no module holds {registry}")
    assert len(owners) == 1, f"{registry} is assigned in {owners}; it has one place"
    name = owners[0].removesuffix(".py").removesuffix("/__init__").replace("/", ".")
    yield from getattr(importlib.import_module(name), registry).items()


@pytest.mark.parametrize("registry", REGISTRIES)
def test_registry_members_are_frozen_dataclasses(registry: str) -> None:
    """Every colour model, layout, flow and style is a frozen dataclass or an instance of one."""
    members = list(members_of(registry))
    assert members, f"{registry} is empty"
    assert not [name for name, member in members if not is_frozen_dataclass(member)]


def is_frozen_dataclass(member: object) -> bool:
    """Say whether a class, or the class of a value, is a frozen dataclass."""
    cls = member if isinstance(member, type) else type(member)
    return dataclasses.is_dataclass(cls) and cls.__dataclass_params__.frozen


def test_mutable_registry_member_is_found() -> None:
    """A plain class, an unfrozen dataclass and a function are not frozen dataclasses."""
    thawed = dataclasses.make_dataclass("Thawed", ["x"])
    frozen = dataclasses.make_dataclass("Frozen", ["x"], frozen=True)
    for planted in (thawed, thawed(1), object(), print):
        assert not is_frozen_dataclass(planted)
    assert is_frozen_dataclass(frozen)
    assert is_frozen_dataclass(frozen(1))


def class_names(modules: list[Module]) -> dict[str, list[str]]:
    """The modules that define a class, by its name."""
    found: dict[str, list[str]] = {}
    for module in modules:
        for node in module.nodes:
            if isinstance(node, ast.ClassDef):
                found.setdefault(node.name, []).append(module.path)
    return found


def test_no_two_classes_have_one_name() -> None:
    """A name in a message, a track or a search leads to one place; a planted pair is found."""
    assert not {name: paths for name, paths in class_names(MODULES).items() if len(paths) > 1}
    pair = [Module("stages/a.py", "class A: ..."), Module("pipeline/b.py", "class A: ...")]
    assert class_names(pair) == {"A": ["stages/a.py", "pipeline/b.py"]}


def test_runtime_dependencies_are_the_six() -> None:
    """An installation brings nothing that was not decided."""
    with (ROOT / "pyproject.toml").open("rb") as file:
        stated = tomllib.load(file)["project"]["dependencies"]
    assert {re.match(r"[\w\-]+", entry)[0] for entry in stated} == RUNTIME_DEPENDENCIES
    assert len(stated) == len(RUNTIME_DEPENDENCIES)


@pytest.mark.parametrize(
    "path",
    [path for path in FILES if path.suffix in TEXT_SUFFIXES],
    ids=lambda path: path.relative_to(ROOT).as_posix(),
)
def test_file_names_no_foreign_path(path: Path) -> None:
    """No file mentions a folder that exists on one machine only."""
    assert not list(foreign_paths(path.read_text(encoding="utf-8")))


@pytest.mark.parametrize("folder", ["root", "home", "Users", "work", "tmp"])
def test_foreign_path_is_found(folder: str) -> None:
    """A planted path is found; the same words in a relative path or an address are not."""
    assert len(list(foreign_paths(f'open("/{folder}/someone/clip.mp4")'))) == 1
    assert not list(
        foreign_paths(f"see https://example.org/{folder}/a and {folder}/a and ./{folder}/a")
    )


@pytest.mark.parametrize("path", MARKDOWN, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_markdown_links_lead_somewhere(path: Path) -> None:
    """Every relative link and picture of a Markdown file exists."""
    targets = markdown_links(path.read_text(encoding="utf-8"))
    assert not [target for target in targets if not (path.parent / target).exists()]


def test_markdown_links_are_found() -> None:
    """Links, pictures and HTML pictures are found; addresses, anchors and code are not."""
    text = (
        "[a](docs/a.md#part) ![b](b.png) [c](https://c.org) [d](#d)\n"
        '<img src="e.png" width=3>\n```\n[f](f.md)\n```\n'
    )
    assert list(markdown_links(text)) == ["docs/a.md", "b.png", "e.png"]
