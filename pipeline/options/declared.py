"""Options as their dataclasses declare them, read from the source without running it.

The options' dataclasses and the registries live beside what they configure, and importing that
means importing Warp, OpenCV and FFmpeg: a second before the first line of help. A declaration is
literal by custom (numbers, texts, tuples, a literal registry), so it can be read instead. What is
not literal is imported after all: slower, never wrong.
"""

import ast
import dataclasses
import importlib
import inspect
import runpy
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
"""Folder of the packages."""
NO_DEFAULT = object()
"""Default of a field that has none, or one that is made when needed."""


@dataclass(frozen=True)
class DeclaredField:
    """One field of a dataclass."""

    name: str
    """Its name."""
    kind: str
    """Its type as written, such as `int | None`."""
    owner: str
    """Name of the dataclass that declares it."""
    module: str
    """Dotted name of the module that declares it."""
    default: object = NO_DEFAULT
    """Its default, if it has one that is a plain value."""
    metadata: Mapping[str, Any] = field(default_factory=dict)
    """Its metadata."""
    factory: str = ""
    """Name of the class that makes the default, or empty."""


class _NotLiteralError(Exception):
    """A declaration that only Python itself can evaluate."""


def declared_fields(module: str, name: str) -> tuple[DeclaredField, ...]:
    """Fields of a dataclass, in order; those that it inherits come last.

    Args:
        module: Dotted name of the module in which it can be found.
        name: Name of the class.
    """
    source = _source(module)
    definition = source.statements.get(name)
    if isinstance(definition, ast.ImportFrom):
        return declared_fields(str(definition.module), name)
    try:
        return tuple(_read_fields(source, definition))
    except _NotLiteralError:
        return tuple(_imported_fields(getattr(importlib.import_module(module), name)))


def declared_summary(module: str, name: str) -> str:
    """First line of a class's docstring.

    Args:
        module: Dotted name of the module in which it can be found.
        name: Name of the class.
    """
    definition = _source(module).statements.get(name)
    if isinstance(definition, ast.ImportFrom):
        return declared_summary(str(definition.module), name)
    text = ast.get_docstring(definition) if isinstance(definition, ast.ClassDef) else None
    return (text or "").split("\n", maxsplit=1)[0]


def own_first(cls: type) -> list[dataclasses.Field[Any]]:
    """Fields of an imported dataclass: its own, then those that it inherits, the nearest first.

    Args:
        cls: The dataclass.
    """
    order = [name for base in cls.__mro__ for name in inspect.get_annotations(base)]
    return sorted(dataclasses.fields(cls), key=lambda field: order.index(field.name))


def declared_registry(reference: str) -> dict[str, tuple[DeclaredField, ...]]:
    """Members of a registry and their parameters.

    Args:
        reference: Module and name, such as `stages.flows:FLOWS`.
    """
    module = reference.partition(":")[0]
    classes = registry_classes(reference)
    return {member: declared_fields(module, cls) for member, cls in classes.items()}


def registry_classes(reference: str) -> dict[str, str]:
    """Names of a registry's members and of their classes.

    Args:
        reference: Module and name, such as `stages.flows:FLOWS`.
    """
    module, _, name = reference.partition(":")
    try:
        return dict(_literal_members(_assigned(_source(module), name)))
    except _NotLiteralError:
        registry = getattr(importlib.import_module(module), name)
        return {member: cls.__name__ for member, cls in registry.items()}


def _literal_members(value: ast.expr) -> Iterator[tuple[str, str]]:
    """Pairs of a literal dictionary from names to classes."""
    if not isinstance(value, ast.Dict):
        raise _NotLiteralError(ast.unparse(value))
    for key, member in zip(value.keys, value.values, strict=True):
        if not (isinstance(key, ast.Constant) and isinstance(member, ast.Name)):
            raise _NotLiteralError(ast.unparse(value))
        yield str(key.value), member.id


@dataclass(frozen=True, eq=False)
class _Source:
    """A parsed module."""

    module: str
    """Its dotted name."""
    path: Path
    statements: Mapping[str, ast.stmt]
    """Its top-level statements by the names that they define."""
    is_light: bool
    """Whether it imports nothing but the standard library."""


@cache
def _source(module: str) -> _Source:
    path = ROOT.joinpath(*module.split("."))
    path = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    tree = ast.parse(path.read_text(encoding="utf-8"))
    statements: dict[str, ast.stmt] = {}
    for statement in tree.body:
        for name in _names_of(statement):
            statements[name] = statement
    imported = {name.split(".")[0] for name in _imports(tree)}
    return _Source(module, path, statements, imported <= sys.stdlib_module_names)


def _names_of(statement: ast.stmt) -> Iterator[str]:
    """Names that a top-level statement defines."""
    if isinstance(statement, ast.ClassDef):
        yield statement.name
    elif isinstance(statement, ast.ImportFrom):
        yield from (alias.asname or alias.name for alias in statement.names)
    elif isinstance(statement, ast.Assign):
        yield from (target.id for target in statement.targets if isinstance(target, ast.Name))
    elif isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name):
        yield statement.target.id


def _imports(tree: ast.Module) -> Iterator[str]:
    """Modules that a module imports."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.module or "."


def _assigned(source: _Source, name: str) -> ast.expr:
    """The expression that a module assigns to a name."""
    statement = source.statements.get(name)
    if isinstance(statement, ast.Assign | ast.AnnAssign) and statement.value is not None:
        return statement.value
    raise _NotLiteralError(name)


def _value_of(source: _Source, name: str) -> object:
    """What a module-level name stands for."""
    statement = source.statements.get(name)
    if isinstance(statement, ast.ImportFrom):
        return _value_of(_source(str(statement.module)), name)
    if source.is_light:
        return runpy.run_path(str(source.path))[name]
    return _evaluate(source, _assigned(source, name))


def _evaluate(source: _Source, node: ast.expr) -> Any:
    """Value of a literal, of a name of one, or of a tuple made from one."""
    if isinstance(node, ast.Name):
        return _value_of(source, node.id)
    if isinstance(node, ast.Call) and ast.unparse(node.func) == "tuple" and len(node.args) == 1:
        return tuple(_iterable(source, node.args[0]))
    if isinstance(node, ast.Dict) and None not in node.keys:
        keys = (_evaluate(source, key) for key in node.keys if key is not None)
        return dict(zip(keys, (_evaluate(source, value) for value in node.values), strict=True))
    try:
        return ast.literal_eval(node)
    except ValueError as error:
        raise _NotLiteralError(ast.unparse(node)) from error


def _iterable(source: _Source, node: ast.expr) -> Iterable[Any]:
    """What a tuple is made from: of a registry the names alone, its classes stay unread."""
    if isinstance(node, ast.Name):
        home, name = source, node.id
        while isinstance(statement := home.statements.get(name), ast.ImportFrom):
            home = _source(str(statement.module))
        if not home.is_light and isinstance(value := _assigned(home, name), ast.Dict):
            return [member for member, _ in _literal_members(value)]
    return _evaluate(source, node)


def _read_fields(source: _Source, definition: ast.stmt | None) -> Iterator[DeclaredField]:
    """Fields that a class statement declares, then those of its bases."""
    if not isinstance(definition, ast.ClassDef):
        raise _NotLiteralError
    for statement in definition.body:
        if isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name):
            kind = ast.unparse(statement.annotation)
            if not kind.startswith("ClassVar"):
                yield _read_field(source, definition.name, statement.target.id, kind, statement)
    for base in definition.bases:
        if isinstance(base, ast.Name) and base.id in source.statements:
            yield from declared_fields(source.module, base.id)


def _read_field(
    source: _Source, owner: str, name: str, kind: str, statement: ast.AnnAssign
) -> DeclaredField:
    value = statement.value
    if value is None:
        return DeclaredField(name, kind, owner, source.module)
    if not isinstance(value, ast.Call):
        return DeclaredField(name, kind, owner, source.module, _evaluate(source, value))
    if ast.unparse(value.func) != "field":
        return DeclaredField(name, kind, owner, source.module)
    parts = {keyword.arg: keyword.value for keyword in value.keywords}
    default = _evaluate(source, parts["default"]) if "default" in parts else NO_DEFAULT
    metadata = _evaluate(source, parts["metadata"]) if "metadata" in parts else {}
    factory = ast.unparse(parts["default_factory"]) if "default_factory" in parts else ""
    return DeclaredField(name, kind, owner, source.module, default, metadata, factory)


def _imported_fields(cls: type) -> Iterator[DeclaredField]:
    """The same from the class itself."""
    for declared in own_first(cls):
        kind = declared.type if isinstance(declared.type, str) else _kind_of(declared.type)
        factory: Callable[[], Any] | Any = declared.default_factory
        yield DeclaredField(
            declared.name,
            kind,
            cls.__name__,
            cls.__module__,
            NO_DEFAULT if declared.default is dataclasses.MISSING else declared.default,
            declared.metadata,
            getattr(factory, "__name__", "") if factory is not dataclasses.MISSING else "",
        )


def _kind_of(annotation: object) -> str:
    return annotation.__name__ if isinstance(annotation, type) else str(annotation)
