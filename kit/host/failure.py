"""Failures of a student's code, as records that can be shown as they are."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class FailureKind(Enum):
    """Why a student's code has stopped."""

    SYNTAX = "syntax"
    IMPORT = "import"
    EXCEPTION = "exception"
    EXIT = "exit"
    TIMEOUT = "timeout"
    MEMORY = "memory"
    PROTOCOL = "protocol"
    DISK = "disk"
    KILLED = "killed"
    CRASH = "crash"
    FLOOD = "flood"
    """More messages in one tick than a program may send."""
    CONFINEMENT = "confinement"
    """Not the student's fault: the machine does not have the requested confinement level."""


REPORTABLE = frozenset(
    (FailureKind.SYNTAX, FailureKind.IMPORT, FailureKind.EXCEPTION, FailureKind.EXIT, FailureKind.MEMORY)
)
"""The kinds that a child may report of itself; the parent finds the others."""


@dataclass(frozen=True, slots=True)
class Failure:
    """One failure: what, and where in the student's own file. ``str()`` is the message to show.

    ``file`` is relative to the folder of the student's file; ``line`` is 1-based. Both are None where there
    is no such place. All text is printable, without control characters.
    """

    kind: FailureKind
    message: str
    file: str | None = None
    line: int | None = None

    def __str__(self) -> str:
        if self.file is None:
            return self.message
        return f"{self.file}:{self.line}: {self.message}" if self.line else f"{self.file}: {self.message}"


class StudentCodeError(Exception):
    """Student code has failed; ``failure`` says why."""

    def __init__(self, failure: Failure) -> None:
        super().__init__(str(failure))
        self.failure = failure
