"""Calls the functions of a student's file, such as a reward, in a process of their own."""

from __future__ import annotations

from array import array
from collections.abc import Mapping, Sequence
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kit.host.failure import Failure, FailureKind, StudentCodeError, protocol_violation
from kit.host.process import HostedFile, StudentProcess
from kit.host.protocol import BatchResult, FunctionNames, JsonResult
from kit.host.sandbox.limits import INTERACTIVE_LIMITS, Limits
from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL, Level
from kit.host.wire import Json, numbers_to_text
from kit.plain_text import nearest_name

if TYPE_CHECKING:
    from numpy.typing import NDArray


class StudentFunctions(HostedFile):
    """The functions that a student's file defines, in a process of their own.

    The constructor waits until the file is loaded. Every method raises StudentCodeError when the student's code fails;
    the process has ended by then.
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
        super().__init__(StudentProcess("functions", file, {"seed": seed}, limits=limits, level=level))
        try:
            answer = self._process.wait_started()
            if not isinstance(answer, FunctionNames):
                raise StudentCodeError(protocol_violation("another answer than a list of functions"))
        except BaseException:  # Ctrl-C too: the process must not outlive it; raised again
            self._process.close()
            raise
        self.names = answer.names
        """Names of the public functions that the file defines itself."""

    def call_batch(self, name: str, batch: Sequence[Mapping[str, Json]]) -> list[float]:
        """Returns ``name(**record)`` for each record, in order: finite numbers.

        All records have the same names. They hold plain data: None, truth values, numbers, texts, lists and
        dicts of these. Raises ValueError or TypeError for other records: that is the caller's mistake.
        """
        names = batch[0].keys() if batch else ()
        if any(record.keys() != names for record in batch):
            raise ValueError("all records of a batch must have the same names")
        return list(
            self._call_columns(name, len(batch), {key: [record[key] for record in batch] for key in names})
        )

    def call_columns(self, name: str, columns: Mapping[str, Sequence[Json] | NDArray[Any]]) -> array[float]:
        """Like ``call_batch``, with one sequence or one-dimensional array for each parameter, all equally long."""
        lengths = {len(column) for column in columns.values()}
        if len(lengths) != 1:
            raise ValueError("columns must have the same length, and there must be at least one")
        return self._call_columns(name, lengths.pop(), columns)

    def call_json(self, name: str, record: Mapping[str, Json]) -> Json:
        """Returns ``name(**record)``: None, a truth value, a number, a text, or lists of these, at most three deep.

        The record holds plain data; floats may be nan or infinite, wherever they stand. Raises ValueError or TypeError for other records: that is
        the caller's mistake.
        """
        if name not in self.names:
            raise StudentCodeError(self._missing_function(name))
        packed = {key: _encode_argument(value) for key, value in record.items()}
        answer = self._process.request("tell", name, packed)
        if not isinstance(answer, JsonResult):
            raise self._process.fail(protocol_violation("something other than what the function returned"))
        return answer.value

    def _call_columns(
        self, name: str, count: int, columns: Mapping[str, Sequence[Json] | NDArray[Any]]
    ) -> array[float]:
        if name not in self.names:
            raise StudentCodeError(self._missing_function(name))
        packed = {key: _encode_column(column) for key, column in columns.items()}
        answer = self._process.request("call", name, count, packed)
        if not isinstance(answer, BatchResult) or len(answer.values) != count:
            raise self._process.fail(protocol_violation(f"something other than {count} numbers"))
        return answer.values

    def _missing_function(self, name: str) -> Failure:
        near = nearest_name(name, self.names)
        hint = f" Did you mean {near}()?" if near else ""
        return Failure(FailureKind.IMPORT, f"it has no function {name}().{hint}", self.file.name)


def _encode_argument(value: Json) -> list[Json]:
    """Encodes an argument as its form and its value in that form, as JSON knows neither nan nor infinity: ``plain``, as it
    is; ``numbers``, a list of floats as the text of their bytes; ``list`` and ``dict``, whose items are encoded likewise.
    """
    if isinstance(value, list) and value and all(type(each) is float for each in value):
        return ["numbers", numbers_to_text(array("d", value))]
    if isinstance(value, float) and not isfinite(value):
        return ["number", numbers_to_text(array("d", [value]))]
    if _is_finite(value):
        return ["plain", value]
    if isinstance(value, dict):
        return ["dict", {key: _encode_argument(each) for key, each in value.items()}]
    return ["list", [_encode_argument(each) for each in value]]


def _is_finite(value: Json) -> bool:
    """Whether no number in it is nan or infinite."""
    if isinstance(value, (list, tuple)):
        return all(map(_is_finite, value))
    if isinstance(value, dict):
        return all(map(_is_finite, value.values()))
    return not isinstance(value, float) or isfinite(value)


def _encode_column(column: Sequence[Json] | NDArray[Any]) -> Json:
    """Encodes a column: floats as the text of their bytes, anything else as a list."""
    # Not isinstance against numpy.ndarray, which would have to import numpy.
    if not isinstance(column, Sequence):
        column = array("d", column.astype("d").tobytes()) if column.dtype.kind == "f" else column.tolist()
    elif all(type(value) is float for value in column):
        column = array("d", column)
    return numbers_to_text(column) if isinstance(column, array) else column
