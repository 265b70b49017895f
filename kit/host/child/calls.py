"""The child as a set of functions: the kit names one, sends a batch of records, and gets a number for each."""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from itertools import repeat
from types import FunctionType

from kit.host.child.conversation import Conversation
from kit.host.child.program import Program, shown
from kit.host.failure import Failure, FailureKind, GuestError
from kit.host.wire import Json, numbers_to_text, text_to_numbers

MODULE = "student"
"""The name of the module that the file becomes: no file of the library's may be hidden by it."""


def serve(program: Program, conversation: Conversation) -> None:
    """Loads the file, then answers until the kit hangs up."""
    functions = {
        name: value
        for name, value in vars(program.load(MODULE)).items()
        if isinstance(value, FunctionType) and value.__module__ == MODULE and not name.startswith("_")
    }
    conversation.answer("functions", sorted(functions))
    while True:
        _, name, count, columns = conversation.next_question()
        values = _values(functions[name], _records(count, columns), program)
        conversation.answer("values", numbers_to_text(values))


def _records(count: int, columns: dict[str, Json]) -> Iterator[dict[str, Json]]:
    """The rows of a table that came as columns; columns of floats came as text."""
    lists = [
        text_to_numbers(column, "d", finite=False) if type(column) is str else column
        for column in columns.values()
    ]
    names = tuple(columns)
    for row in zip(*lists, strict=True) if names else repeat((), count):
        yield dict(zip(names, row, strict=True))


def _values(function: FunctionType, records: Iterator[dict[str, Json]], program: Program) -> array[float]:
    values = array("d")
    for record in records:
        value = function(**record)
        number = value if type(value) is float else _number(value)
        if number is None or number - number != 0:
            code = function.__code__
            hint = " Does every way through it end in a return?" if value is None else ""
            message = f"{code.co_name}() must return a finite number, not {shown(value)}.{hint}"
            raise GuestError(
                Failure(
                    FailureKind.EXCEPTION, message, program.relative(code.co_filename), code.co_firstlineno
                )
            )
        values.append(number)
    return values


def _number(value: object) -> float | None:
    """A number as a float: Python's and numpy's, but not True and False, which would pass for 1 and 0."""
    if getattr(value, "shape", None) == () and hasattr(value, "item"):
        value = value.item()
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    try:
        return float(value)
    except OverflowError:
        return None
