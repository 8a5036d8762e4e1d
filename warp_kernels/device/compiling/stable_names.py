"""A compiled kernel has one name, whatever was compiled before it in the same process.

Warp names it by a hash of its source, of its constants, and of those constants of its functions
that depend on the variable of a loop. These are known only once a function was compiled, with
whatever kernel: without what is done here a kernel would have two names, and would be compiled a
second time by a job that meets it in another order.
"""

from collections.abc import Iterable
from contextlib import suppress
from typing import Any


def forget_loop_constants(modules: Iterable[Any]) -> None:
    """Leave functions as they were before they were compiled; nothing but names looks at that.

    Args:
        modules: Warp's modules that have been compiled.
    """
    seen: set[int] = set()
    with suppress(AttributeError):  # a Warp that names them otherwise: compiled twice at worst
        left = [kernel.adj for module in modules for kernel in module.kernels.values()]
        while left:
            code = left.pop()
            if id(code) in seen:
                continue
            seen.add(id(code))
            code.deferred_static_expressions = []
            for function in _called_by(code):
                left += [variant.adj for variant in function.user_overloads.values()]
                left += [variant.adj for variant in function.user_templates.values()]


def _called_by(code: Any) -> list[Any]:
    """Functions that are called by name, or by a constant expression that names them."""
    _, _, called = code.get_references()
    named = [value for value in code.resolved_static_expressions.values() if _is_function(value)]
    return [function for function in [*called, *named] if not function.is_builtin()]


def _is_function(value: Any) -> bool:
    """Whether a constant is one of Warp's functions."""
    return hasattr(value, "user_overloads")
