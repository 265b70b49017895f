"""The child as a set of functions: the kit names one, sends a batch of records, and gets a number for each; or one
record, and gets whatever plain data the function returns."""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from itertools import repeat
from types import FunctionType

from kit.host.child.command_loop import CommandSession
from kit.host.child.student_module import Program, shown
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.protocol import DEEPEST
from kit.host.wire import Json, numbers_to_text, text_to_numbers

MOST_TOLD = 100_000
"""Entries of a list that a function returns."""

MODULE = "student"
"""The name of the module that the file becomes: no file of the library's may be hidden by it."""


def serve(program: Program, session: CommandSession) -> None:
    """Loads the file, then answers until the kit hangs up."""
    functions = {
        name: value
        for name, value in vars(program.load(MODULE)).items()
        if isinstance(value, FunctionType) and value.__module__ == MODULE and not name.startswith("_")
    }
    session.answer("functions", sorted(functions))
    while True:
        kind, name, *given = session.next_command()
        if kind == "tell":
            session.answer("told", _told(functions[name], given[0], program))
        else:
            values = _values(functions[name], _records(*given), program)
            session.answer("values", numbers_to_text(values))


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
            raise _refused(function, "a finite number", value, program)
        values.append(number)
    return values


def _refused(function: FunctionType, wanted: str, value: object, program: Program) -> StudentCodeError:
    """What to say where a function does not return what is wanted."""
    code = function.__code__
    hint = " Does every way through it end in a return?" if value is None else ""
    message = f"{code.co_name}() must return {wanted}, not {shown(value)}.{hint}"
    place = program.relative(code.co_filename), code.co_firstlineno
    return StudentCodeError(Failure(FailureKind.EXCEPTION, message, *place))


def _told(function: FunctionType, record: dict[str, Json], program: Program) -> Json:
    """What the function returns for a record, as plain data. Nothing, where it returns nothing."""
    value = function(**{name: _unpacked(*packed) for name, packed in record.items()})
    try:
        return _plain(value, DEEPEST)
    except ValueError:
        wanted = "finite numbers, texts, True or False, or lists of these"
        raise _refused(function, wanted, value, program) from None


def _unpacked(is_numbers: bool, value: Json) -> Json:
    """A list of floats comes as text, so that it may hold nan; anything else as it is."""
    return list(text_to_numbers(value, "d", finite=False)) if is_numbers else value


def _plain(value: object, deep: int) -> Json:
    """Plain data of Python's and numpy's kinds. ValueError for anything else."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if value is None or type(value) in (bool, str):
        return value
    if isinstance(value, (list, tuple)):
        if deep == 0 or len(value) > MOST_TOLD:
            raise ValueError
        return [_plain(each, deep - 1) for each in value]
    number = _number(value)
    if number is None or number - number != 0:
        raise ValueError
    return number


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
