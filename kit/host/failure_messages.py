"""What to tell a student whose program has stopped: one sentence on what, one on the way out."""

from __future__ import annotations

import signal
from pathlib import Path
from typing import Literal, TypeAlias

from kit.host.failure import Failure, FailureKind
from kit.host.output import Position
from kit.host.sandbox.confinement import Level
from kit.host.sandbox.limits import MIB, Limits
from kit.host.wire import LOST_PIPE, printable

Budget: TypeAlias = Literal["start", "reply", "total"]


def too_slow(budget: Budget, limit_s: float, where: Position | None) -> Failure:
    """A deadline has passed."""
    function = f"{where.function}()" if where and where.function != "<module>" else "the program"
    kept = "has not let the program start" if function != "the program" else "has not started"
    message = {
        "start": f"{function} {kept} within {limit_s:g} s.",
        "reply": f"{function} has not come back within {limit_s:g} s.",
        "total": f"the program has used up its {limit_s:g} s in all.",
    }[budget]
    hint = (
        "Is it very slow?"
        if budget == "total"
        else "Is there a loop that never ends, or a wait for something that never comes?"
    )
    return _at(FailureKind.TIMEOUT, f"{message} {hint}", where)


def dead(status: int, where: Position | None, limits: Limits) -> Failure:
    """The process has ended without a word. ``status``: its exit status, 128 + n for signal n."""
    if status == LOST_PIPE:
        return nonsense("nothing any more: the program has closed a file descriptor that is not its own")
    number = status - 128 if status > 128 else -status
    if number == signal.SIGXCPU:
        return _at(
            FailureKind.TIMEOUT, f"the program has used up its {limits.cpu_s} s of processor time.", where
        )
    if number == signal.SIGKILL:
        return _at(
            FailureKind.KILLED,
            "the program was killed from outside; perhaps the machine ran out of memory.",
            where,
        )
    if 0 < number < signal.NSIG:
        name = (signal.strsignal(number) or f"signal {number}").lower()
        text = f"the program crashed ({name}) inside compiled code, in a package or called through ctypes."
        return _at(FailureKind.CRASH, text, where)
    return Failure(FailureKind.EXIT, f"the program left by os._exit({status}). Let main() return instead.")


def told(failure: Failure, limits: Limits) -> Failure:
    """What the child told of itself, with what only the parent knows."""
    if failure.kind is not FailureKind.MEMORY:
        return failure
    message = f"the program needs more memory than the {limits.memory // MIB} MiB it may have. Does a list grow for ever?"
    return Failure(failure.kind, message, failure.file, failure.line)


def nonsense(what: str) -> Failure:
    """The child broke the protocol."""
    message = f"the program disturbed its conversation with the kit, which got {what}."
    return Failure(FailureKind.PROTOCOL, printable(message))


def cannot_confine(level: Level, reason: str) -> Failure:
    """This machine does not allow the level of confinement that was asked for."""
    return Failure(
        FailureKind.CONFINEMENT, f"confinement level {level:d} cannot be had on this machine: {reason}"
    )


def unreadable(file: Path, reason: str) -> Failure:
    """The file cannot be read, so there is nothing to run."""
    return Failure(FailureKind.IMPORT, f"cannot be read ({reason}).", file.name)


def _at(kind: FailureKind, message: str, where: Position | None) -> Failure:
    return Failure(kind, message, where.file, where.line) if where else Failure(kind, message)
