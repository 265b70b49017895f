"""The child as a set of functions: the kit names one, sends a batch of records, and gets a number for each."""

from __future__ import annotations

from types import FunctionType

from kit.host.child.conversation import Conversation
from kit.host.child.program import Program, shown
from kit.host.failure import Failure, FailureKind, GuestError
from kit.host.wire import Json

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
        _, name, batch = conversation.next_question()
        conversation.answer("values", _values(functions[name], batch, program))


def _values(function: FunctionType, batch: list[dict[str, Json]], program: Program) -> list[float]:
    values = []
    for record in batch:
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
