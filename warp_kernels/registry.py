"""Families of classes by the names that users give: imported when used, extended by packages.

A member's module is imported when the member is asked for, so a list of names costs nothing. An
installed package adds members by entry points, such as `[project.entry-points."trimotion.styles"]`
with `neon = "my_package:Neon"`. It cannot replace one that is there.
"""

from collections.abc import Iterator, Mapping
from dataclasses import is_dataclass
from functools import cache, cached_property
from importlib import import_module
from typing import TYPE_CHECKING, Any, TypeVar

from warp_kernels.errors import OptionError

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

Kind = TypeVar("Kind")


def imported(reference: str) -> Any:
    """What a module has.

    Args:
        reference: The module and the name in it, such as `stages.flows.dis:Dis`.
    """
    module, _, name = reference.partition(":")
    return getattr(import_module(module), name)


class Imported:
    """An attribute of a class that is imported when it is asked for.

    It has no annotation: a dataclass asks for all that have one.

    Args:
        reference: See `imported`.
    """

    def __init__(self, reference: str) -> None:
        self._reference = reference

    def __get__(self, instance: object, owner: type) -> Any:
        return imported(self._reference)


class Registry(Mapping[str, type[Kind]]):
    """Classes by name.

    Args:
        kind: What they are, such as `style`.
        homes: Where they are, by name, see `imported`; in the order in which they are listed.
        method: What a member of another package must have.
    """

    def __init__(self, kind: str, homes: Mapping[str, str], method: str | None = None) -> None:
        self._kind = kind
        self._homes = dict(homes)
        self._method = method

    def __getitem__(self, name: str) -> type[Kind]:
        """The class of a name.

        Raises:
            OptionError: If the package that has it cannot be used.
        """
        if name in self._homes:
            found: type[Kind] = imported(self._homes[name])
            return found
        return self._loaded(self.added[name])

    def __iter__(self) -> Iterator[str]:
        yield from self._homes
        yield from self.added

    def __len__(self) -> int:
        return len(self._homes) + len(self.added)

    def __str__(self) -> str:
        return self._kind

    def __contains__(self, name: object) -> bool:
        return name in self._homes or name in self.added

    @property
    def own(self) -> Mapping[str, type[Kind]]:
        """Those that this program brings: they can all be imported."""
        return {name: self[name] for name in self._homes}

    @property
    def usable(self) -> Mapping[str, type[Kind]]:
        """All that can be imported: packages that do not work here are left out."""
        return {name: cls for name in self if (cls := self._found(name)) is not None}

    @cached_property
    def added(self) -> "Mapping[str, EntryPoint]":
        """What installed packages add, by name; nothing of it is imported yet."""
        if self._method is None:
            return {}
        group = f"trimotion.{self._kind}"
        found = {entry.name: entry for entry in reversed(_installed()) if entry.group == group}
        return {name: found[name] for name in sorted(found.keys() - self._homes.keys())}

    def origin(self, name: str) -> str:
        """The package that adds a member, with its version.

        Args:
            name: One of `added`.
        """
        entry = self.added[name]
        return entry.module if entry.dist is None else f"{entry.dist.name} {entry.dist.version}"

    def name_of(self, cls: type) -> str:
        """The name of a member's class; of a stranger its own.

        Args:
            cls: The class.
        """
        homes = {**self._homes, **{name: entry.value for name, entry in self.added.items()}}
        for name, home in homes.items():
            if home.replace(" ", "") == f"{cls.__module__}:{cls.__qualname__}":
                return name
        named = (name for name in self.added if self._found(name) is cls)
        return next(named, cls.__name__)

    def _found(self, name: str) -> type[Kind] | None:
        """The class of a name, or None if it cannot be used."""
        try:
            return self[name]
        except OptionError:
            return None

    def _loaded(self, entry: "EntryPoint") -> type[Kind]:
        """The class that a package adds: what it raises while it is imported is its own fault."""
        try:
            found: Any = entry.load()
            if not (is_dataclass(found) and hasattr(found, str(self._method))):
                raise TypeError(f"a dataclass with {self._method} is wanted")
        except (Exception, SystemExit) as error:
            reason = " ".join(f"{type(error).__name__}: {error}".split())
            raise OptionError(
                f"the package {self.origin(entry.name)} does not work here ({reason}); update it "
                "or remove it"
            ) from error
        return found


@cache
def _installed() -> "tuple[EntryPoint, ...]":
    """All that installed packages add; what else is installed may be damaged."""
    from importlib.metadata import distributions

    found: list[EntryPoint] = []
    for package in distributions():
        try:
            found += (e for e in package.entry_points if e.group.startswith("trimotion."))
        except Exception:
            continue
    return tuple(found)
