"""Runs a student's file as a set of functions: answers each call with numbers for a batch of records, or with plain
data for one record."""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from itertools import repeat
from types import FunctionType

from kit.host.child.command_loop import CommandSession
from kit.host.child.student_module import StudentProgram, short_repr
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.wire import MAX_RESULT_DEPTH, Json, numbers_to_text, text_to_numbers
from kit.ros import install_import_names

MAX_RESULT_ITEMS = 100_000
"""Items of a list that a function returns."""

MODULE = "student"
"""The name of the module that the file becomes: no file of the library's may be hidden by it."""


def serve(program: StudentProgram, session: CommandSession) -> None:
    """Loads the file, then answers calls until the parent disconnects.

    The file may hold a node beside its functions, so the import names of ROS are found.
    """
    install_import_names(first=False)
    functions = {
        name: value
        for name, value in vars(program.load(MODULE)).items()
        if isinstance(value, FunctionType) and value.__module__ == MODULE and not name.startswith("_")
    }
    session.answer("functions", sorted(functions))
    while True:
        kind, name, *given = session.next_command()
        if kind == "tell":
            session.answer("told", _json_result(functions[name], given[0], program))
        else:
            values = _batch_result(functions[name], _rows_of_columns(*given), program)
            session.answer("values", numbers_to_text(values))


def _rows_of_columns(count: int, columns: dict[str, Json]) -> Iterator[dict[str, Json]]:
    """Yields the rows of a table that came as columns; columns of floats came as text."""
    lists = [
        text_to_numbers(column, "d", finite=False) if type(column) is str else column
        for column in columns.values()
    ]
    names = tuple(columns)
    for row in zip(*lists, strict=True) if names else repeat((), count):
        yield dict(zip(names, row, strict=True))


def _batch_result(
    function: FunctionType, records: Iterator[dict[str, Json]], program: StudentProgram
) -> array[float]:
    values = array("d")
    for record in records:
        value = function(**record)
        number = value if type(value) is float else _to_float(value)
        if number is None or number - number != 0:
            raise _wrong_result(function, "a finite number", value, program)
        values.append(number)
    return values


def _wrong_result(
    function: FunctionType, wanted: str, value: object, program: StudentProgram
) -> StudentCodeError:
    """Makes the error for a function that does not return what is required."""
    code = function.__code__
    hint = " Does every path through it end with a return?" if value is None else ""
    odd = _odd_number(value, MAX_RESULT_DEPTH) if isinstance(value, (list, tuple)) else None
    returned = short_repr(value) if odd is None else f"a list with {odd} in it"
    message = f"{code.co_name}() must return {wanted}, not {returned}.{hint}"
    place = program.relative_path(code.co_filename), code.co_firstlineno
    return StudentCodeError(Failure(FailureKind.EXCEPTION, message, *place))


def _odd_number(value: object, deep: int) -> float | None:
    """Returns the first number in nested lists that is not finite; None if there is none."""
    if isinstance(value, (list, tuple)):
        found = (_odd_number(each, deep - 1) for each in value if deep)
        return next((each for each in found if each is not None), None)
    number = _to_float(value)
    return number if number is not None and number - number != 0 else None


def _json_result(function: FunctionType, record: dict[str, Json], program: StudentProgram) -> Json:
    """Calls the function for one record; returns its result as plain data."""
    value = function(**{name: _decode_argument(*packed) for name, packed in record.items()})
    try:
        return _to_plain_data(value, MAX_RESULT_DEPTH)
    except ValueError:
        wanted = "finite numbers, texts, True or False, or lists of these"
        raise _wrong_result(function, wanted, value, program) from None


def _decode_argument(form: str, value: Json) -> Json:
    """Decodes an argument; its forms are those of ``kit.host.student_functions``."""
    if form == "numbers":
        return list(text_to_numbers(value, "d", finite=False))
    if form == "number":
        return text_to_numbers(value, "d", finite=False)[0]
    if form == "list":
        return [_decode_argument(*each) for each in value]
    if form == "dict":
        return {key: _decode_argument(*each) for key, each in value.items()}
    return value


def _to_plain_data(value: object, deep: int) -> Json:
    """Converts a result of Python's or numpy's types to plain data. Raises ValueError for anything else."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if value is None or type(value) in (bool, str):
        return value
    if isinstance(value, (list, tuple)):
        if deep == 0 or len(value) > MAX_RESULT_ITEMS:
            raise ValueError
        return [_to_plain_data(each, deep - 1) for each in value]
    number = _to_float(value)
    if number is None or number - number != 0:
        raise ValueError
    return number


def _to_float(value: object) -> float | None:
    """Converts Python's and numpy's numbers to float; None for anything else, and for True and False."""
    if getattr(value, "shape", None) == () and hasattr(value, "item"):
        value = value.item()
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    try:
        return float(value)
    except OverflowError:
        return None
