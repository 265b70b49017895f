"""Failures of a student's code, as records that can be shown as they are."""

from __future__ import annotations

import signal
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Literal, TypeAlias

from kit.host.output import StackPosition
from kit.host.sandbox.limits import MIB, Limits
from kit.host.sandbox.sandbox_config import Level
from kit.host.wire import LOST_PIPE, OVER_DISK_LIMIT, printable

if TYPE_CHECKING:
    from pathlib import Path


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
    (
        FailureKind.SYNTAX,
        FailureKind.IMPORT,
        FailureKind.EXCEPTION,
        FailureKind.EXIT,
        FailureKind.MEMORY,
        FailureKind.DISK,
    )
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
    status: int = 1
    """The exit status with which ``python FILE`` would have ended: 1 for an exception."""

    def __str__(self) -> str:
        if self.file is None:
            return self.message
        return f"{self.file}:{self.line}: {self.message}" if self.line else f"{self.file}: {self.message}"


class StudentCodeError(Exception):
    """Student code has failed; ``failure`` says why."""

    def __init__(self, failure: Failure) -> None:
        super().__init__(str(failure))
        self.failure = failure


Budget: TypeAlias = Literal["start", "start wall", "reply", "reply wall", "total"]


def timed_out(budget: Budget, limit_s: float, where: StackPosition | None) -> Failure:
    """Makes the failure of a program that has exceeded a time limit."""
    function = f"{where.function}()" if where and where.function != "<module>" else "the program"
    kept = "kept the program from starting" if function != "the program" else "did not start"
    message = {
        "start": f"{function} {kept} within {limit_s:g} s of processor time.",
        "start wall": f"{function} {kept} within {limit_s:g} s.",
        "reply": f"{function} did not return within {limit_s:g} s of processor time.",
        "reply wall": f"{function} did not return within {limit_s:g} s.",
        "total": f"the program used up its total time of {limit_s:g} s.",
    }[budget]
    hint = "Is it very slow?" if budget == "total" else "Is there a loop or a wait that never ends?"
    return _failure_at(FailureKind.TIMEOUT, f"{message} {hint}", where)


def process_ended(status: int, where: StackPosition | None, limits: Limits) -> Failure:
    """Makes the failure of a process that has ended without a report. ``status``: exit status; 128 + n for signal n."""
    if status == LOST_PIPE:
        return protocol_violation(
            "no more data: the program closed a file descriptor that belongs to the kit"
        )
    if status == OVER_DISK_LIMIT:
        return Failure(FailureKind.DISK, _disk_text(limits))
    number = status - 128 if status > 128 else -status
    if number == signal.SIGXCPU:
        return _failure_at(
            FailureKind.TIMEOUT, f"the program used up its {limits.cpu_s} s of processor time.", where
        )
    if number == signal.SIGKILL:
        return _failure_at(
            FailureKind.KILLED,
            "the program was killed from outside; perhaps the machine ran out of memory.",
            where,
        )
    if 0 < number < signal.NSIG:
        name = (signal.strsignal(number) or f"signal {number}").lower()
        text = f"the program crashed ({name}) inside compiled code, in a package or called through ctypes."
        return _failure_at(FailureKind.CRASH, text, where)
    return Failure(
        FailureKind.EXIT, f"the program exited with os._exit({status}). Let main() return instead."
    )


def add_limits(failure: Failure, limits: Limits) -> Failure:
    """Adds the limit to a failure that the child has reported: only the parent knows it."""
    if failure.kind is FailureKind.MEMORY:
        message = f"the program needs more memory than its limit of {limits.memory // MIB} MiB. Does a list grow forever?"
    elif failure.kind is FailureKind.DISK:
        message = _disk_text(limits)
    else:
        return failure
    return Failure(failure.kind, message, failure.file, failure.line)


def _disk_text(limits: Limits) -> str:
    return (
        f"the program wrote more than its limit of {limits.scratch / MIB:g} MiB or {limits.files} files. "
        "Does it keep writing to a file, or never remove one?"
    )


def protocol_violation(what: str) -> Failure:
    """Makes the failure of a child that has broken the protocol."""
    message = f"the program disturbed its communication with the kit, which received {what}."
    return Failure(FailureKind.PROTOCOL, printable(message))


def too_many_messages(limit: int, file: Path) -> Failure:
    """Makes the failure of a program that sends more messages in one tick than it may."""
    message = (
        f"the program sent more than {limit} messages at one moment of simulated time. "
        "Does a loop publish without waiting, or a callback publish to the topic that calls it? Publish from a timer."
    )
    return Failure(FailureKind.FLOOD, message, file.name)


def too_much_kept(limit: int, file: Path) -> Failure:
    """Makes the failure of a program for which more messages would have to be kept than may be."""
    message = (
        f"the kit would have to store more than {limit // MIB} MiB of messages for the program. Does a publisher with "
        "transient-local durability have a large depth, or does a service never answer?"
    )
    return Failure(FailureKind.FLOOD, message, file.name)


def refused_name(message: str, file: Path) -> Failure:
    """Makes the failure of a program that uses a name which is not its own."""
    return Failure(FailureKind.EXCEPTION, printable(message), file.name)


def confinement_unavailable(level: Level, reason: str) -> Failure:
    """Makes the failure of a machine without the requested confinement level."""
    return Failure(
        FailureKind.CONFINEMENT, f"this machine does not support confinement level {level:d}: {reason}"
    )


def unreadable_file(file: Path, reason: str) -> Failure:
    """Makes the failure of a file that cannot be read."""
    return Failure(FailureKind.IMPORT, f"cannot be read ({reason}).", file.name)


def _failure_at(kind: FailureKind, message: str, where: StackPosition | None) -> Failure:
    return Failure(kind, message, where.file, where.line) if where else Failure(kind, message)


def syntax_error(text: str) -> SyntaxError | None:
    """Why a text is no program of Python, if that is so because of one of its characters. It is read, never run.

    >>> syntax_error("a = = 1").offset
    5
    """
    import ast
    import warnings

    try:
        with warnings.catch_warnings(action="ignore"):
            ast.parse(text)
    except SyntaxError as error:
        return error
    except (ValueError, RecursionError, MemoryError):  # a NUL, or nested too deeply
        return None
    return None
