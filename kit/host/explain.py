"""From an exception in a student's program to a sentence about it, with the student's own file and line."""

from __future__ import annotations

import sys

from kit.host.failure import Failure, FailureKind, GuestError
from kit.host.program import Program
from kit.host.wire import MAX_TEXT

LONGEST_MESSAGE = 600
"""Characters of an exception's own text."""


def explain(problem: BaseException, program: Program) -> Failure:
    """What to report. Also writes the student's part of the traceback to the standard error."""
    if isinstance(problem, GuestError):
        return problem.failure
    if isinstance(problem, MemoryError):
        # Nothing may be built while the frames hold what filled the memory.
        frames = program.frames(problem.__traceback__)
        problem.__traceback__ = None
        return _failure(FailureKind.MEMORY, "out of memory", frames)
    if isinstance(problem, SyntaxError) and program.relative(problem.filename):
        file, line = program.relative(problem.filename), problem.lineno
        return Failure(FailureKind.SYNTAX, f"{type(problem).__name__}: {problem.msg}", file, line or None)
    frames = program.frames(problem.__traceback__)
    if isinstance(problem, SystemExit):
        text = f"the program left by sys.exit({_text(problem)}). Let the callback or main() return instead."
        return _failure(FailureKind.EXIT, text, frames)
    if len(frames) > 1:
        _show(frames, program)
    kind = FailureKind.IMPORT if isinstance(problem, ImportError) else FailureKind.EXCEPTION
    text = _text(problem)
    message = f"{type(problem).__name__}: {text}" if text else type(problem).__name__
    if frames and frames[-1][2] != "<module>":
        message += f" (in {frames[-1][2]})"
    return _failure(kind, message, frames)


def _failure(kind: FailureKind, message: str, frames: list[tuple[str, int, str]]) -> Failure:
    file, line = frames[-1][:2] if frames else (None, None)
    return Failure(kind, message[:MAX_TEXT], file, line)


def shown(value: object) -> str:
    """A value as a short text, whatever it is."""
    try:
        return repr(value)[:60]
    except Exception:  # noqa: BLE001 - a student's class may have a broken __repr__
        return f"a {type(value).__name__}"


def _text(problem: BaseException) -> str:
    try:
        return str(problem)[:LONGEST_MESSAGE]
    except Exception:  # noqa: BLE001 - likewise
        return ""


def _show(frames: list[tuple[str, int, str]], program: Program) -> None:
    print("How it came to that, the last call last:", file=sys.stderr)  # noqa: T201 - the student's own output
    for file, line, function in frames[-20:]:
        print(f"  {file}:{line} in {function}: {program.text(file, line)}", file=sys.stderr)  # noqa: T201
