"""Python expressions of launch files, evaluated within bounds: what a single operation would make is estimated before it is made.

What the interpreter computes in one operation, such as a power of powers, nothing can interrupt but the end of the process.
Loops of an expression are the concern of the limit on the process that carries a launch file out.
"""

from __future__ import annotations

import ast
import math
from collections.abc import Mapping, Sequence, Sized
from types import MappingProxyType
from typing import Any, Final

from kit.ros.launch.bounds import MAX_TEXT_LENGTH

MAX_BITS: Final = 1 << 16
"""Bits of a whole number: far more than the digits that Python writes out."""
MAX_FACTORIAL: Final = 4000
"""The largest argument of ``factorial``, ``comb`` and ``perm``: beyond it, the result has more than ``MAX_BITS``."""


class ExpressionTooLarge(Exception):
    """An operation would make more than a launch file may hold."""


def evaluate(expression: str, location: tuple[str, int] | None) -> str:
    """Returns the value of an expression as a text; it knows the names of ``math``.

    ``location``: the file and line in which it stands; one that never ends is told by that line. Raises ExpressionTooLarge,
    and whatever the expression raises.
    """
    file, line = location or ("<string>", 1)
    tree = ast.parse(expression.lstrip(" \t"), filename="<string>", mode="eval")
    bounded = ast.fix_missing_locations(_Bounded().visit(tree))
    code = compile(ast.increment_lineno(bounded, line - 1), file, "eval")
    # The launch file's author's own code, in the launch file's own process.
    value = eval(code, dict(_OPERATIONS), {**vars(math), **_COMBINATORICS})
    _check_parts(value)
    return str(value)


class _Bounded(ast.NodeTransformer):
    """Replaces the operations whose results can be far larger than their operands by calls that estimate them first."""

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        self.generic_visit(node)
        name = _OPERATORS.get(type(node.op))
        if name is None:
            return node
        function = ast.copy_location(ast.Name(name, ast.Load()), node)
        return ast.copy_location(ast.Call(function, [node.left, node.right], []), node)


def _power(base: Any, exponent: Any) -> Any:
    if isinstance(base, int) and isinstance(exponent, int) and abs(base) > 1:
        _check_size(base.bit_length() * exponent, MAX_BITS)
    return base**exponent


def _shift(number: Any, places: Any) -> Any:
    if isinstance(number, int) and isinstance(places, int) and number:
        _check_size(number.bit_length() + places, MAX_BITS)
    return number << places


def _product(left: Any, right: Any) -> Any:
    for several, count in ((left, right), (right, left)):
        if isinstance(several, Sequence) and isinstance(count, int):
            _check_size(len(several) * count, MAX_TEXT_LENGTH)
    if isinstance(left, int) and isinstance(right, int):
        _check_size(left.bit_length() + right.bit_length(), MAX_BITS)
    return left * right


def _factorial(number: Any) -> int:
    _check_size(number if isinstance(number, int) else 0, MAX_FACTORIAL)
    return math.factorial(number)


def _combinations(count: Any, chosen: Any) -> int:
    _check_size(count if isinstance(count, int) else 0, MAX_FACTORIAL)
    return math.comb(count, chosen)


def _permutations(count: Any, chosen: Any = None) -> int:
    _check_size(count if isinstance(count, int) else 0, MAX_FACTORIAL)
    return math.perm(count, chosen)


def _range(*limits: Any) -> range:
    found = range(*limits)
    _check_size(abs(found.stop - found.start) // abs(found.step), MAX_TEXT_LENGTH)
    return found


def _check_size(size: int, largest: int) -> None:
    if size > largest:
        raise ExpressionTooLarge("its result would be too large for a launch file")


def _check_parts(value: Any) -> None:
    """Counts the parts of a value, those of parts too: a list that holds one list a thousand times is short only in memory."""
    count, waiting = 0, [value]
    while waiting:
        part = waiting.pop()
        if isinstance(part, int):
            _check_size(part.bit_length(), MAX_BITS)
        if not isinstance(part, Sized):
            continue
        count += len(part)
        _check_size(count, MAX_TEXT_LENGTH)
        if isinstance(part, Mapping):
            waiting += [*part.keys(), *part.values()]
        elif isinstance(part, (list, tuple, set, frozenset)):
            waiting += part


_OPERATORS: Final[Mapping[type[ast.operator], str]] = MappingProxyType(
    {ast.Pow: "<power>", ast.LShift: "<shift>", ast.Mult: "<product>"}
)
"""By operation, the name of what is called in its place: none that an expression can use."""
_OPERATIONS: Final[Mapping[str, Any]] = MappingProxyType(
    {"<power>": _power, "<shift>": _shift, "<product>": _product, "range": _range}
)
_COMBINATORICS: Final[Mapping[str, Any]] = MappingProxyType(
    {"factorial": _factorial, "comb": _combinations, "perm": _permutations}
)
