"""A student's functions, such as a reward: called by name, for a batch of records at a time, for numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from pathlib import Path
from types import TracebackType
from typing import Self

from kit.host import verdicts
from kit.host.confine import DESK_LEVEL, Level
from kit.host.failure import Failure, FailureKind, GuestError
from kit.host.launcher import Child
from kit.host.limits import DESK, Limits
from kit.host.output import Printed
from kit.host.protocol import Functions, Values
from kit.host.wire import Json


class StudentFunctions:
    """The functions that a student's file defines, in a process of their own.

    Starts at once and waits until the file is loaded. Use as a context manager, or ``close`` it. Everything
    raises GuestError when the student's code fails; the process has ended by then.
    """

    def __init__(
        self, file: Path, *, seed: int = 0, limits: Limits = DESK, level: Level = DESK_LEVEL
    ) -> None:
        self.file = file
        self._child = Child("functions", file, {"seed": seed}, limits=limits, level=level)
        try:
            answer = self._child.started()
            if not isinstance(answer, Functions):
                raise GuestError(verdicts.nonsense("another answer than a list of functions"))
        except BaseException:
            self._child.close()
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
        return self._child.failure

    @property
    def level(self) -> Level:
        return self._child.level

    def call(self, name: str, batch: Sequence[Mapping[str, Json]]) -> list[float]:
        """``name(**record)`` for each record, in order: as many finite numbers.

        Records hold plain data: None, truth values, finite numbers, texts, lists and dicts of these
        (ValueError or TypeError otherwise: that is the caller's mistake).
        """
        if name not in self.names:
            raise GuestError(self._missing(name))
        answer = self._child.ask("call", name, [dict(record) for record in batch])
        if not isinstance(answer, Values) or len(answer.values) != len(batch):
            self.close()
            raise GuestError(verdicts.nonsense(f"something else than {len(batch)} numbers"))
        return answer.values

    def take_output(self) -> Printed:
        """What the functions have printed since the last time."""
        return self._child.take_output()

    def close(self) -> None:
        """Ends the process. May be called twice."""
        self._child.close()

    def _missing(self, name: str) -> Failure:
        near = get_close_matches(name, self.names, n=1)
        hint = f" Is it the one that is called {near[0]}?" if near else ""
        return Failure(FailureKind.IMPORT, f"there is no function {name}() in it.{hint}", self.file.name)
