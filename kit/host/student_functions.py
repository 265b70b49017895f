"""A student's functions, such as a reward: called by name, for a batch of records at a time, for numbers."""

from __future__ import annotations

from array import array
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from kit.host import failure_messages
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.output import Printed
from kit.host.process import StudentProcess
from kit.host.protocol import Functions, Told, Values
from kit.host.sandbox.confinement import INTERACTIVE_LEVEL, Level
from kit.host.sandbox.limits import INTERACTIVE_LIMITS, Limits
from kit.host.wire import Json, numbers_to_text
from kit.plain_text import nearest_name

if TYPE_CHECKING:
    from numpy.typing import NDArray


class StudentFunctions:
    """The functions that a student's file defines, in a process of their own.

    Starts at once and waits until the file is loaded. Use as a context manager, or ``close`` it. Everything
    raises StudentCodeError when the student's code fails; the process has ended by then.
    """

    def __init__(
        self,
        file: Path,
        *,
        seed: int = 0,
        limits: Limits = INTERACTIVE_LIMITS,
        level: Level = INTERACTIVE_LEVEL,
    ) -> None:
        self.file = file
        self._process = StudentProcess("functions", file, {"seed": seed}, limits=limits, level=level)
        try:
            answer = self._process.started()
            if not isinstance(answer, Functions):
                raise StudentCodeError(failure_messages.nonsense("another answer than a list of functions"))
        except BaseException:
            self._process.close()
            raise
        self.names = answer.names
        """Public functions the file defines itself."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def failure(self) -> Failure | None:
        return self._process.failure

    @property
    def level(self) -> Level:
        return self._process.level

    def call_batch(self, name: str, batch: Sequence[Mapping[str, Json]]) -> list[float]:
        """``name(**record)`` for each record, in order: as many finite numbers.

        All records have the same names. They hold plain data: None, truth values, numbers, texts, lists and
        dicts of these. ValueError or TypeError otherwise: that is the caller's mistake.
        """
        names = batch[0].keys() if batch else ()
        if any(record.keys() != names for record in batch):
            raise ValueError("the records of a batch must all have the same names")
        return list(self._call(name, len(batch), {key: [record[key] for record in batch] for key in names}))

    def call_columns(self, name: str, columns: Mapping[str, Sequence[Json] | NDArray[Any]]) -> array[float]:
        """Like ``call_batch``, with one sequence or one-dimensional array for each parameter, all equally long."""
        lengths = {len(column) for column in columns.values()}
        if len(lengths) != 1:
            raise ValueError("columns must be equally long, and there must be at least one")
        return self._call(name, lengths.pop(), columns)

    def call_json(self, name: str, record: Mapping[str, Json]) -> Json:
        """``name(**record)``: None, a truth value, a number, a text, or lists of these, at most three deep.

        The record holds plain data, and lists of floats, which may be nan. ValueError or TypeError otherwise: that is the caller's mistake.
        """
        if name not in self.names:
            raise StudentCodeError(self._missing(name))
        packed = {key: _tagged(value) for key, value in record.items()}
        answer = self._process.ask("tell", name, packed)
        if not isinstance(answer, Told):
            raise self._process.fail(
                failure_messages.nonsense("something else than what the function returned")
            )
        return answer.value

    def _call(
        self, name: str, count: int, columns: Mapping[str, Sequence[Json] | NDArray[Any]]
    ) -> array[float]:
        if name not in self.names:
            raise StudentCodeError(self._missing(name))
        packed = {key: _packed(column) for key, column in columns.items()}
        answer = self._process.ask("call", name, count, packed)
        if not isinstance(answer, Values) or len(answer.values) != count:
            raise self._process.fail(failure_messages.nonsense(f"something else than {count} numbers"))
        return answer.values

    def take_output(self) -> Printed:
        """What the functions have printed since the last time."""
        return self._process.take_output()

    def close(self) -> None:
        """Ends the process. May be called twice."""
        self._process.close()

    def _missing(self, name: str) -> Failure:
        near = nearest_name(name, self.names)
        hint = f" Is it the one that is called {near}?" if near else ""
        return Failure(FailureKind.IMPORT, f"there is no function {name}() in it.{hint}", self.file.name)


def _tagged(value: Json) -> list[Json]:
    """Whether it travels as the text of numbers' bytes, and how."""
    if isinstance(value, list) and value and all(type(each) is float for each in value):
        return [True, numbers_to_text(array("d", value))]
    return [False, value]


def _packed(column: Sequence[Json] | NDArray[Any]) -> Json:
    """A column as it travels: floats as the text of their bytes, anything else as a list."""
    # Not isinstance against numpy.ndarray, which would have to import numpy.
    if not isinstance(column, Sequence):
        column = array("d", column.astype("d").tobytes()) if column.dtype.kind == "f" else column.tolist()
    elif all(type(value) is float for value in column):
        column = array("d", column)
    return numbers_to_text(column) if isinstance(column, array) else column
