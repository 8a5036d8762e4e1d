"""Expressions: `1 + 4*env(beat, decay=0.25s)`, read with Python's `ast` against a white list.

Nothing is evaluated by Python: every node that is allowed becomes a function of `Signals`.
"""

import ast
import math
import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import NoReturn

import numpy as np

from pipeline.options.nearest import nearest
from pipeline.timeline.functions import FUNCTIONS, FaultError, Given, Length, Value, division
from pipeline.timeline.signals import EVENTS, STRENGTHS, VARIABLES, Signals
from pipeline.timeline.times import parse_span
from pipeline.timeline.written.place import Place
from warp_kernels.errors import OptionError

MOST_CHARACTERS = 1000
"""Longer texts are no expressions."""
MOST_DEPTH = 40
"""Deeper brackets are no expressions either: Python's own parser knows a bound, too."""
MOST_NESTED = 100
"""Operations within operations; `1 + 2 + 3` is one within another."""

Code = Callable[[Signals], Value]
"""What a part of an expression comes to at some frames."""

_LENGTH = re.compile(
    r"(?<![\w.])(\d+(?:\.\d*)?|\.\d+)\s*(ms|seconds?|s|frames?|beats?|bars?)\b(?!\s*\()"
)
_BINARY: dict[type, Callable[[Value, Value], Value]] = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: division(a, b, lambda x, y: x / y),
    ast.FloorDiv: lambda a, b: division(a, b, lambda x, y: x // y),
    ast.Mod: lambda a, b: division(a, b, lambda x, y: x % y),
}
_COMPARED: dict[type, Callable[[Value, Value], Value]] = {
    ast.Lt: lambda a, b: np.less(a, b),
    ast.LtE: lambda a, b: np.less_equal(a, b),
    ast.Gt: lambda a, b: np.greater(a, b),
    ast.GtE: lambda a, b: np.greater_equal(a, b),
    ast.Eq: lambda a, b: np.equal(a, b),
    ast.NotEq: lambda a, b: np.not_equal(a, b),
}
_OTHERS = {ast.Pow: "**", ast.MatMult: "@", ast.LShift: "<<", ast.RShift: ">>"}


@dataclass(frozen=True, eq=False)
class Expression:
    """A number for every frame."""

    text: str
    """What the user wrote."""
    code: Code
    """What it comes to."""
    names: frozenset[str]
    """The variables that it looks at."""
    lengths: tuple[Length, ...]
    """The lengths of time in it."""
    place: Place
    """Where it begins."""

    @property
    def changes_with_shots(self) -> bool:
        """Whether it looks at where shots begin, which is found while frames are drawn."""
        return "shot" in self.names

    @property
    def needs_beats(self) -> bool:
        """Whether it looks at beats or bars."""
        counted = any(length.span.unit.needs_beats for length in self.lengths)
        return counted or bool(self.names & {"b", "bar", "bpm", "beat", "downbeat"})

    @property
    def needs_sound(self) -> bool:
        """Whether it looks at what is heard beside beats."""
        return bool(self.names & {*STRENGTHS, "onset"})

    def at(self, signals: Signals) -> np.ndarray:
        """What it comes to, [N] float64.

        Args:
            signals: The frames.

        Raises:
            OptionError: If that is no number at some frame, or nothing is heard.
        """
        try:
            with np.errstate(all="ignore"):
                found = np.broadcast_to(np.asarray(self.code(signals), float), signals.times.shape)
            wrong = ~np.isfinite(found)
            if wrong.any():
                raise FaultError("is no finite number", wrong, 0, "keep it in bounds with clamp()")
        except FaultError as fault:
            first = int(np.argmax(np.broadcast_to(fault.where, signals.times.shape)))
            frame, time = int(signals.frames[first]), float(signals.times[first])
            raise self.place.after(fault.column).error(
                f"{self.text!r} {fault.problem} at frame {frame} ({time:.2f} s); {fault.remedy}"
            ) from fault
        except OptionError as error:
            raise self.place.error(f"{self.text!r}: {error}") from error
        return found


def parse_expression(text: str, place: Place) -> Expression:
    """Read an expression.

    Args:
        text: What the user wrote.
        place: Where it begins.

    Raises:
        OptionError: If it holds anything that is not allowed; told with its column.
    """
    if len(text) > MOST_CHARACTERS:
        raise place.error(f"the expression is too long ({len(text)} characters); shorten it")
    depth = _depth(text)
    if depth > MOST_DEPTH:
        raise place.error(
            f"the expression nests too deeply ({depth} brackets one within another, at most "
            f"{MOST_DEPTH}); leave some out"
        )
    try:
        plain, columns, lengths = _without_units(text)
    except ValueError as error:
        raise place.error(error) from error
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # Python frowns upon `1if`, and we say what is wrong
            tree = ast.parse(plain, mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        at = _start_of(plain, getattr(error, "lineno", 1) or 1)
        at += max(getattr(error, "offset", 1) or 1, 1) - 1
        here = place.after(columns[min(at, len(columns) - 1)])
        reason = getattr(error, "msg", "") or "it cannot be read"
        raise here.error(
            f"{text!r} is no expression ({reason}); write 1 + 2*sin(t), or keyframes such as 0s: 1"
        ) from error
    reader = _Reader(text, plain, place, columns, lengths)
    code = reader.code(tree.body)
    return Expression(text, code, frozenset(reader.names), tuple(lengths.values()), place)


def _without_units(text: str) -> tuple[str, list[int], dict[str, Length]]:
    """A text that Python reads: lengths of time become names; and where its characters stood."""
    plain = ""
    columns: list[int] = []
    lengths: dict[str, Length] = {}
    begin = 0
    for match in _LENGTH.finditer(text):
        plain += text[begin : match.start()]
        columns += range(begin, match.start())
        name = f"_{len(lengths)}_"
        lengths[name] = Length(parse_span(" ".join(match.groups())))
        plain += name
        columns += [match.start()] * len(name)
        begin = match.end()
    columns += range(begin, len(text) + 1)
    return plain + text[begin:], columns, lengths


def _depth(text: str) -> int:
    """How many brackets stand one within another at most."""
    deepest = depth = 0
    for letter in text:
        depth += (letter in "([{") - (letter in ")]}")
        deepest = max(deepest, depth)
    return deepest


def _start_of(plain: str, line: int) -> int:
    """Where a line of a text begins, counted from 1."""
    return sum(len(one) + 1 for one in plain.split("\n")[: line - 1])


class _Reader:
    """Turns the nodes of one expression into functions."""

    def __init__(
        self, text: str, plain: str, place: Place, columns: list[int], lengths: dict[str, Length]
    ) -> None:
        self._text = text
        self._plain = plain
        self._place = place
        self._columns = columns
        self._lengths = lengths
        self._depth = 0
        self.names: set[str] = set()

    def code(self, node: ast.expr) -> Code:
        """What a node does."""
        self._depth += 1
        if self._depth > MOST_NESTED:
            raise self._place.error(
                f"the expression has more than {MOST_NESTED} operations one within another; "
                "shorten it"
            )
        try:
            return self._code(node)
        finally:
            self._depth -= 1

    def _code(self, node: ast.expr) -> Code:
        if isinstance(node, ast.Constant):
            return self._constant(node)
        if isinstance(node, ast.Name):
            return self._name(node)
        if isinstance(node, ast.BinOp):
            return self._binary(node)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.UAdd | ast.Not):
            return self._unary(node)
        if isinstance(node, ast.Compare):
            return self._comparison(node)
        if isinstance(node, ast.BoolOp):
            return self._logic(node)
        if isinstance(node, ast.IfExp):
            return self._choice(node)
        if isinstance(node, ast.Call):
            return self._call(node)
        self._refuse(node, "is not allowed", "use numbers, variables, + - * / % **, functions")

    def _constant(self, node: ast.Constant) -> Code:
        value = node.value
        if isinstance(value, bool) or not isinstance(value, int | float):
            self._refuse(node, "is no number", "write numbers such as 0.5")
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if math.isinf(number):
            self._refuse(node, "is too large", "write numbers such as 0.5")
        return lambda signals: number

    def _name(self, node: ast.Name) -> Code:
        name = node.id
        if name in self._lengths:
            length = self._lengths[name]
            if length.span.unit.needs_beats or length.span.unit.value == "frames":
                self._refuse(node, "is a length of time", "give it to every(), env() or smooth()")
            seconds = float(length.span.amount)
            return lambda signals: seconds
        if name == "pi":
            return lambda signals: float(np.pi)
        if name not in VARIABLES:
            hint = f"write {name}(...)" if name in FUNCTIONS else nearest(name, VARIABLES)
            self._refuse(node, "is no variable", hint)
        self.names.add(name)
        return lambda signals: signals.value(name)

    def _binary(self, node: ast.BinOp) -> Code:
        kind, column = type(node.op), self._column(node)
        one, other = self.code(node.left), self.code(node.right)
        if kind is ast.Pow:
            return lambda signals: _located(column, _power, one(signals), other(signals))
        if kind not in _BINARY:
            sign = _OTHERS.get(kind, "this sign")
            self._refuse(node, f"{sign} is not allowed", "use + - * / // % **")
        apply = _BINARY[kind]
        return lambda signals: _located(column, apply, one(signals), other(signals))

    def _unary(self, node: ast.UnaryOp) -> Code:
        inner, kind = self.code(node.operand), type(node.op)
        if kind is ast.Not:
            return lambda signals: np.equal(inner(signals), 0.0) * 1.0
        return inner if kind is ast.UAdd else lambda signals: -inner(signals)

    def _comparison(self, node: ast.Compare) -> Code:
        if len(node.ops) != 1 or type(node.ops[0]) not in _COMPARED:
            self._refuse(node, "is no single comparison", "write a < b, or join two with and")
        apply = _COMPARED[type(node.ops[0])]
        one, other = self.code(node.left), self.code(node.comparators[0])
        return lambda signals: apply(one(signals), other(signals)) * 1.0

    def _logic(self, node: ast.BoolOp) -> Code:
        parts = [self.code(value) for value in node.values]
        join = np.logical_and if isinstance(node.op, ast.And) else np.logical_or

        def joined(signals: Signals) -> Value:
            """1 where they hold, 0 where not."""
            found = parts[0](signals)
            for part in parts[1:]:
                found = join(found, part(signals))
            return np.asarray(found) * 1.0

        return joined

    def _choice(self, node: ast.IfExp) -> Code:
        test, then, other = (self.code(part) for part in (node.test, node.body, node.orelse))

        def chosen(signals: Signals) -> Value:
            """What the test chooses, frame by frame."""
            truth = np.broadcast_to(np.asarray(test(signals)) != 0, signals.times.shape)
            found = np.zeros(signals.times.shape)
            for where, part in ((truth, then), (~truth, other)):
                if where.any():  # a branch is not looked at in frames that do not take it
                    found[where] = _inside(part, signals, where)
            return found

        return chosen

    def _call(self, node: ast.Call) -> Code:
        if not isinstance(node.func, ast.Name) or node.func.id not in FUNCTIONS:
            known = ", ".join(FUNCTIONS)
            name = getattr(node.func, "id", "this")
            hint = nearest(name, FUNCTIONS) if name != "this" else f"there are {known}"
            self._refuse(node, "is no function", hint)
        function, column = FUNCTIONS[node.func.id], self._column(node)
        if any(isinstance(a, ast.Starred) for a in node.args) or len(node.args) > 8:
            self._refuse(node, "has impossible arguments", f"write {function.form}")
        given = [self._argument(part) for part in node.args]
        named: dict[str, Given] = {}
        for keyword in node.keywords:
            if keyword.arg is None or keyword.arg in named:
                self._refuse(node, "has impossible arguments", f"write {function.form}")
            named[keyword.arg] = self._argument(keyword.value)
        try:
            code = function.bind(given, named)
        except ValueError as error:
            self._refuse(node, str(error), f"write {function.form}")
        return lambda signals: _located(column, code, signals)

    def _argument(self, node: ast.expr) -> Given:
        """An argument of a function: a number at every frame, a length of time, or moments."""
        if isinstance(node, ast.Name):
            if node.id in self._lengths:
                return Given(self._lengths[node.id], None, None)
            if node.id in (*EVENTS, "shot", *STRENGTHS):
                self.names.add(node.id)
                code = self.code(node)
                return Given(None, code, node.id, is_whole=True)
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "every":
            code = self._call(node)
            if len(node.args) == 1 and isinstance(node.args[0], ast.Name):
                length = self._lengths.get(node.args[0].id)
                return Given(length, code, "every", is_whole=True)
        code = self.code(node)  # refuses what is too large
        number = node.value if isinstance(node, ast.Constant) else None
        fixed = float(number) if isinstance(number, int | float) else None
        return Given(None, code, None, fixed)

    def _column(self, node: ast.expr) -> int:
        return self._place_of(node.lineno, node.col_offset)

    def _place_of(self, line: int, offset: int) -> int:
        """Where a character stands in the text; Python counts bytes of a line."""
        begin = _start_of(self._plain, line)
        before = self._plain[begin:].encode()[:offset]
        at = begin + len(before.decode("utf-8", "replace"))
        return self._columns[min(at, len(self._columns) - 1)]

    def _refuse(self, node: ast.expr, problem: str, remedy: str) -> NoReturn:
        begin = self._column(node)
        end = self._place_of(node.end_lineno or node.lineno, node.end_col_offset or 0)
        part = self._text[begin : max(end, begin + 1)].strip() or self._text
        raise self._place.after(begin).error(f"{part!r} {problem}; {remedy}")


def _power(base: Value, exponent: Value) -> Value:
    """One number at a time: the last bit does not depend on how many there are."""
    bases, exponents = np.broadcast_arrays(np.asarray(base, float), np.asarray(exponent, float))
    wrong = (bases == 0) & (exponents < 0) | (bases < 0) & (exponents != np.floor(exponents))
    if wrong.any():
        raise FaultError("is no number", wrong, 0, "raise what is above 0, such as abs(...)")
    found = [_one_power(a, b) for a, b in zip(bases.flat, exponents.flat, strict=True)]
    return np.array(found).reshape(bases.shape)


def _one_power(base: float, exponent: float) -> float:
    try:
        return float(base) ** float(exponent)
    except OverflowError:
        return float("inf")


def _located(column: int, apply: Callable[..., Value], *values: object) -> Value:
    """A result, or the fault with the column that it has, the innermost one."""
    try:
        return apply(*values)
    except FaultError as fault:
        fault.column = fault.column or column
        raise


def _inside(part: Code, signals: Signals, where: np.ndarray) -> Value:
    """What a part comes to in some of the frames; faults are told with their place among all."""
    try:
        return part(signals.some(where))
    except FaultError as fault:
        spread = np.zeros(where.shape, bool)
        spread[where] = np.broadcast_to(fault.where, int(where.sum()))
        fault.where = spread
        raise
