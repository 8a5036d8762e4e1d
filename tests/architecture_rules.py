"""The house rules that a machine can check, each a function over one parsed file.

A rule takes a `Module` and yields the line and text of everything that departs from it. The rules
read syntax only and import nothing, so they also judge a small planted source string.
"""

import ast
import re
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from graphlib import CycleError, TopologicalSorter
from pathlib import PurePosixPath

LEVELS = {"warp_kernels": 0, "stages": 1, "pipeline": 2, "trimotion": 3}
"""A package imports from its own level and from lower ones."""

IMPORT_HOMES = {
    "warp": ("warp_kernels/",),
    "scipy": ("stages/", "pipeline/"),
    # in the focus it runs the network that finds faces, and scales pictures and maps for it; in
    # media it interleaves planes of colour
    "cv2": (
        "stages/flows",
        "stages/focus",
        "stages/layouts",
        "stages/media/color/yuv",
        "stages/metrics",
        "stages/look/sheet",
        "stages/spaces",
    ),
    "av": ("stages/media",),
    "ezdxf": ("stages/exchange/dxf",),
    "pxr": ("stages/exchange/usd",),
    "argparse": ("pipeline/",),
    "sqlite3": ("pipeline/",),
    "tomllib": ("pipeline/",),
    "tqdm": ("pipeline/",),
    "starlette": ("pipeline/editor/serving/",),
    "dask": ("pipeline/farm/cluster/",),
    "distributed": ("pipeline/farm/cluster/",),
    "uvicorn": ("pipeline/editor/serving/",),
}
"""Beginnings of the paths that may import a package; a package without a line is free."""

RUNTIME_PACKAGES = frozenset({"warp", "numpy", "scipy", "cv2", "av", "tqdm"})
"""Import names of the run-time dependencies."""

EXTRA_PACKAGES = frozenset({"dask", "distributed", "ezdxf", "pxr", "starlette", "uvicorn"})
"""Import names of what extras install; it is imported only where it is used."""

ALLOCATING_FILES = frozenset(
    {"warp_kernels/energy/workspace.py"}
    | {f"warp_kernels/device/{name}.py" for name in ("device", "staging")}
)
"""The only files that ask Warp for memory: the arrays of a job come from the workspace or through
`Device.empty`, which owns beside them the spans of phases, the counters of a team, and the memory
in which copies wait."""

ALLOCATORS = frozenset(
    f"{kind}{suffix}" for kind in ("zeros", "ones", "empty", "full") for suffix in ("", "_like")
) | {"array", "array1d", "array2d", "array3d", "array4d", "clone", "from_numpy", "from_torch"}
TYPE_KEYWORDS = frozenset({"dtype", "ndim"})
"""`wp.array` with these alone is a type, not memory."""

WARP_HOMES = frozenset(
    f"warp_kernels/device/{name}.py"
    for name in ("device", "emulation", "launcher", "runtime", "staging", "team")
)
"""The only files that call Warp while the program runs."""
WARP_CALLS = ALLOCATORS | {
    *("launch", "launch_tiled", "copy", "init", "synchronize", "synchronize_device"),
    *("capture_begin", "capture_end", "capture_launch", "ScopedCapture", "ScopedStream"),
    *("get_device", "get_devices", "get_cuda_device_count", "load_module", "force_load"),
}
"""Names of `wp` that work on a device, or on the list of them."""
ARRAY_CALLS = frozenset({"numpy", "assign", "zero_", "fill_"})
"""Methods of Warp's arrays that copy or launch."""
UNLOCKED = frozenset({"replay", "_seen_by_host"})
"""Functions of those files that need no lock of their own: the first runs on a team's threads, for
the caller who holds it and waits for them; the second looks at the host's memory."""

LIBRARY_FUNCTIONS = frozenset(
    {"exp", "log", "log2", "log10", "pow", "cbrt", "erf", "sin", "cos", "tan"}
    | {"asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh"}
)
"""Names of `wp` that the C library and CUDA's round otherwise than each other."""

FORBIDDEN_STEMS = frozenset({"utils", "util", "helpers", "helper", "manager", "common", "misc"})
MAX_FILE_LINES = 400
MAX_LINE_LENGTH = 100
MAX_FUNCTION_LINES = 45
MAX_KERNEL_LINES = 60

# The homes of users and of build machines, and scratch folders.
FOREIGN_PATH = re.compile(r"(?<![\w.\-/~}>])/(?:root|home|Users|work|workspace|tmp)/[\w.\-]")

# An object's private name after a dot, but for one's own and those that notebooks look for.
PATCH = re.compile(
    r"\b(?:setattr|delattr|setitem|delitem)\(|\bmock\b"
    r"|(?<!self)(?<!cls)(?<!\(\))(?<!r)\._(?!repr_)[a-z]\w*"
)

Finding = tuple[int, str]
FunctionNode = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True)
class Module:
    """One Python file of the repository."""

    path: str
    """Relative to the repository, with slashes."""
    source: str

    @cached_property
    def tree(self) -> ast.Module:
        """The parsed source."""
        return ast.parse(self.source)

    @cached_property
    def nodes(self) -> tuple[ast.AST, ...]:
        """All of the tree: a dozen rules look at them, and to walk takes longer than to look."""
        return tuple(ast.walk(self.tree))

    @property
    def package(self) -> str:
        """The top folder."""
        return self.path.split("/")[0]

    def functions(self) -> Iterator[FunctionNode]:
        """Walk all functions, methods and nested functions."""
        for node in self.nodes:
            if isinstance(node, FunctionNode):
                yield node

    def imports(self) -> Iterator[tuple[int, str]]:
        """Walk the absolute dotted names of all imports, with their lines."""
        folder = PurePosixPath(self.path).parent.parts
        for node in self.nodes:
            if isinstance(node, ast.Import):
                yield from ((node.lineno, alias.name) for alias in node.names)
            elif isinstance(node, ast.ImportFrom):
                base = folder[: len(folder) - node.level + 1] if node.level else ()
                parts = (*base, node.module) if node.module else base
                yield node.lineno, ".".join(parts)

    @property
    def room(self) -> str:
        """The folder of a package that it lies in, or the file if it lies on top."""
        return "/".join(self.path.removesuffix(".py").split("/")[:2])


def upward_arrow(modules: Sequence[Module]) -> list[str]:
    """Rooms of a circle of imports, the first also last; none if there is no circle."""
    rooms = {module.room for module in modules}
    graph: dict[str, set[str]] = {room: set() for room in rooms}
    for module in modules:
        for _, name in module.imports():
            other = "/".join(name.split(".")[:2])
            if other in rooms and other != module.room:
                graph[module.room].add(other)
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def imports_point_downwards(module: Module) -> Iterator[Finding]:
    """Imports go from pipeline to stages to warp_kernels, never the other way."""
    level = LEVELS[module.package]
    for line, name in module.imports():
        if LEVELS.get(name.split(".")[0], -1) > level:
            yield line, f"{module.package} imports {name}"


def imports_stay_at_home(module: Module) -> Iterator[Finding]:
    """A package with a home is imported only there, and nothing beyond the dependencies is."""
    known = RUNTIME_PACKAGES | EXTRA_PACKAGES | LEVELS.keys() | sys.stdlib_module_names
    for line, name in module.imports():
        top = name.split(".")[0]
        if top not in known:
            yield line, f"{top} is not a run-time dependency"
        homes = IMPORT_HOMES.get(top, ("",))
        if not module.path.startswith(homes):
            yield line, f"{top} is imported outside {', '.join(homes)}"


def kernels_only_in_warp_kernels(module: Module) -> Iterator[Finding]:
    """`@wp.kernel` and `wp.launch` stay in warp_kernels, under whatever name warp is imported."""
    if module.package == "warp_kernels":
        return
    for function in module.functions():
        if _is_kernel(function):
            yield function.lineno, f"kernel {function.name}"
    for node in module.nodes:
        if isinstance(node, ast.Call) and _warp_name(node.func) in {"launch", "launch_tiled"}:
            yield node.lineno, "launch of a kernel"


def kernel_files_keep_annotations(module: Module) -> Iterator[Finding]:
    """Warp reads annotations as objects: no `from __future__ import annotations` near kernels."""
    if not any(_is_kernel(f) or _has_decorator(f, "func") for f in module.functions()):
        return
    for node in module.tree.body:
        if isinstance(node, ast.ImportFrom) and node.module == "__future__":
            yield node.lineno, "annotations would become strings"


def kernel_outputs_come_last(module: Module) -> Iterator[Finding]:
    """A kernel has outputs, they end in `_out`, they come last, and it writes to nothing else."""
    for kernel in filter(_is_kernel, module.functions()):
        names = [argument.arg for argument in kernel.args.args]
        are_outputs = [name.endswith("_out") for name in names]
        if not any(are_outputs):
            yield kernel.lineno, f"{kernel.name} has no parameter that ends in _out"
        if are_outputs != sorted(are_outputs):
            yield kernel.lineno, f"{kernel.name} has an input after an output"
        for line, name in _written_arrays(kernel):
            if name in names and not name.endswith("_out"):
                yield line, f"{kernel.name} writes to {name}, which does not end in _out"


def memory_is_allocated_in_one_place(module: Module) -> Iterator[Finding]:
    """Only the workspace allocates device memory; array types and a kernel's registers do not."""
    if module.path in ALLOCATING_FILES:
        return
    on_device = {
        id(node)
        for function in module.functions()
        if _is_kernel(function) or _has_decorator(function, "func")
        for node in ast.walk(function)
    }
    for node in module.nodes:
        if isinstance(node, ast.Call) and _warp_name(node.func) in ALLOCATORS:
            is_type = not node.args and {k.arg for k in node.keywords} <= TYPE_KEYWORDS
            if not is_type and id(node) not in on_device:
                yield node.lineno, f"wp.{_warp_name(node.func)} outside the workspace"


def warp_is_called_under_its_lock(module: Module) -> Iterator[Finding]:
    """Only the device calls Warp, and holds `WARP` while it does; kernels are Warp's language."""
    if module.package not in LEVELS:
        return
    exempt: set[int] = set()
    for function in module.functions():
        is_kernel = _is_kernel(function) or _has_decorator(function, "func")
        if is_kernel or (module.path in WARP_HOMES and function.name in UNLOCKED):
            exempt |= {id(node) for node in ast.walk(function)}
    for node in module.nodes if module.path in WARP_HOMES else ():
        if isinstance(node, ast.With):
            for position, item in enumerate(node.items):
                if ast.unparse(item.context_expr) == "WARP":
                    for held in (*node.items[position + 1 :], *node.body):
                        exempt |= {id(inner) for inner in ast.walk(held)}
    for node in module.nodes:
        if isinstance(node, ast.Call) and id(node) not in exempt and _calls_warp(node):
            yield node.lineno, f"{ast.unparse(node.func)} without the lock WARP of the device"


def kernels_of_their_own_module_are_exact(module: Module) -> Iterator[Finding]:
    """A kernel of a module of its own says how it is compiled: its file's options are not its."""
    for kernel in filter(_is_kernel, module.functions()):
        for decorator in kernel.decorator_list:
            keywords = decorator.keywords if isinstance(decorator, ast.Call) else []
            names = {keyword.arg for keyword in keywords}
            if "module" in names and "module_options" not in names:
                yield kernel.lineno, f"{kernel.name} has no module_options; give it EXACT"


def kernels_call_no_library_of_functions(module: Module) -> Iterator[Finding]:
    """Kernels take logarithms, powers and angles from `elementary`, whose bits are the same."""
    for node in module.nodes:
        if isinstance(node, ast.Attribute) and _warp_name(node) in LIBRARY_FUNCTIONS:
            yield node.lineno, f"wp.{node.attr} has other bits on other devices"
    for function in module.functions():
        if _is_kernel(function) or _has_decorator(function, "func"):
            for node in ast.walk(function):
                is_power = isinstance(getattr(node, "op", None), ast.Pow)
                if is_power and not _in_static(function, node):
                    yield node.lineno, "a power has other bits on other devices"


def modules_have_docstrings(module: Module) -> Iterator[Finding]:
    """Every file that holds something starts with what it is for."""
    if module.source.strip() and not ast.get_docstring(module.tree):
        yield 1, "no module docstring"


def public_names_have_docstrings(module: Module) -> Iterator[Finding]:
    """Public functions, methods and classes say what they do."""
    for node in module.nodes:
        named = isinstance(node, FunctionNode | ast.ClassDef)
        if named and not node.name.startswith("_") and not ast.get_docstring(node):
            yield node.lineno, f"{node.name} has no docstring"


def functions_are_short(module: Module) -> Iterator[Finding]:
    """A longer function is a missing name; docstrings do not count."""
    for function in module.functions():
        limit = MAX_KERNEL_LINES if _is_kernel(function) else MAX_FUNCTION_LINES
        length = function.end_lineno - function.lineno + 1
        if ast.get_docstring(function):
            length -= function.body[0].end_lineno - function.body[0].lineno + 1
        # A factory is as long as what it adds around the kernels inside it.
        for inner in _nested_functions(function):
            length -= inner.end_lineno - inner.lineno + 1
        if length > limit:
            yield function.lineno, f"{function.name} has {length} lines, {limit} are allowed"


def files_are_short(module: Module) -> Iterator[Finding]:
    """A longer file holds a second thing; a longer line does not fit beside another."""
    lines = module.source.splitlines()
    if len(lines) > MAX_FILE_LINES:
        yield MAX_FILE_LINES + 1, f"{len(lines)} lines, {MAX_FILE_LINES} are allowed"
    for number, line in enumerate(lines, start=1):
        if len(line) > MAX_LINE_LENGTH:
            yield number, f"{len(line)} characters, {MAX_LINE_LENGTH} are allowed"


def files_are_named_after_one_thing(module: Module) -> Iterator[Finding]:
    """No utils, helpers or manager, as a file or as a folder."""
    for part in PurePosixPath(module.path).with_suffix("").parts:
        if part.strip("_") in FORBIDDEN_STEMS:
            yield 1, f"{part} names no thing"


def no_bare_except(module: Module) -> Iterator[Finding]:
    """A handler names what it handles."""
    for node in module.nodes:
        if isinstance(node, ast.ExceptHandler) and node.type is None:
            yield node.lineno, "bare except"


RULES: tuple[Callable[[Module], Iterator[Finding]], ...] = (
    imports_point_downwards,
    imports_stay_at_home,
    kernels_only_in_warp_kernels,
    kernel_files_keep_annotations,
    kernel_outputs_come_last,
    memory_is_allocated_in_one_place,
    warp_is_called_under_its_lock,
    kernels_of_their_own_module_are_exact,
    kernels_call_no_library_of_functions,
    modules_have_docstrings,
    public_names_have_docstrings,
    functions_are_short,
    files_are_short,
    files_are_named_after_one_thing,
    no_bare_except,
)


def foreign_paths(text: str) -> Iterator[Finding]:
    """Find absolute paths that exist on one machine only."""
    for number, line in enumerate(text.splitlines(), start=1):
        for match in FOREIGN_PATH.finditer(line):
            yield number, f"path of one machine: {line[match.start() :][:40]}"


def markdown_links(text: str) -> Iterator[str]:
    """Find the targets of a Markdown text's relative links and pictures, without anchors."""
    prose = re.sub(r"```.*?```", "", text, flags=re.DOTALL)
    patterns = (
        r"\]\(\s*<?([^)\s>]+)",
        r"<(?:img|video|source|a)\b[^>]*?(?:src|href)=[\"']([^\"']+)",
    )
    for pattern in patterns:
        for target in re.findall(pattern, prose):
            if not re.match(r"[a-z][a-z0-9+.\-]*:|#|//", target):
                yield target.split("#")[0]


def _decorator_names(function: FunctionNode) -> Iterator[str]:
    """Give the last parts of a function's decorators: `kernel` for `@wp.kernel(...)`."""
    for decorator in function.decorator_list:
        target = decorator.func if isinstance(decorator, ast.Call) else decorator
        yield ast.unparse(target).split(".")[-1]


def _has_decorator(function: FunctionNode, name: str) -> bool:
    """Say whether a decorator has this name."""
    return name in _decorator_names(function)


def _is_kernel(function: FunctionNode) -> bool:
    """Say whether a function is a Warp kernel."""
    return _has_decorator(function, "kernel")


def _warp_name(called: ast.expr) -> str:
    """Give `launch` for `wp.launch` and `warp.launch`, and nothing for what is not Warp's."""
    owner, _, name = ast.unparse(called).rpartition(".")
    return name if owner in {"wp", "warp"} else ""


def _calls_warp(call: ast.Call) -> bool:
    """Say whether a call launches, copies, allocates or captures, or asks for devices."""
    if _warp_name(call.func) in WARP_CALLS:
        return (
            bool(call.args)
            or not {k.arg for k in call.keywords} <= TYPE_KEYWORDS
            or (not call.keywords)
        )
    name = call.func.attr if isinstance(call.func, ast.Attribute) else ""
    return name in ARRAY_CALLS and not _warp_name(call.func)


def _in_static(function: FunctionNode, sought: ast.AST) -> bool:
    """Say whether a part of a kernel is computed in Python, when the kernel is made."""
    statics = (n for n in ast.walk(function) if isinstance(n, ast.Call))
    return any(
        sought is inner
        for call in statics
        if _warp_name(call.func) == "static"
        for inner in ast.walk(call)
    )


def _written_arrays(kernel: FunctionNode) -> Iterator[Finding]:
    """Give the names of arrays that a kernel stores to, by index or by an atomic operation."""
    for node in ast.walk(kernel):
        targets: list[ast.expr] = []
        if isinstance(node, ast.Assign):
            targets = node.targets
        elif isinstance(node, ast.AugAssign):
            targets = [node.target]
        elif isinstance(node, ast.Call) and _warp_name(node.func).startswith("atomic_"):
            yield node.lineno, ast.unparse(node.args[0])
        for target in targets:
            if isinstance(target, ast.Subscript):
                yield node.lineno, ast.unparse(target.value)


def _nested_functions(function: FunctionNode) -> Iterator[FunctionNode]:
    """Give the outermost functions defined inside a function; their lines do not overlap."""
    pending: list[ast.AST] = list(function.body)
    while pending:
        node = pending.pop()
        if isinstance(node, FunctionNode):
            yield node
        else:
            pending.extend(ast.iter_child_nodes(node))


def patches_and_pokes(text: str) -> Iterator[Finding]:
    """Lines of a test that put something in place of a part of the program, or reach into it.

    Tests bind behaviour: a part may be exchanged by whoever is given another one, and looked at by
    its public names. Where nothing else is possible a comment above says why: `# real need: ...`.
    """
    needed = -9
    for number, line in enumerate(text.splitlines(), start=1):
        if "# real need: " in line:
            needed = number
        elif PATCH.search(line) and number > needed + 2:
            yield number, line.strip()
