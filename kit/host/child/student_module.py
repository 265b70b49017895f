"""Loads a student's file as a module in the child, and explains its exceptions."""

from __future__ import annotations

import builtins
import errno
import os
import re
import sys
from collections.abc import Mapping
from contextlib import suppress
from itertools import islice
from types import ModuleType, TracebackType
from typing import Any

from kit.host.child.common_mistakes import meaning
from kit.host.child.missing_imports import import_way_out, nearest
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.sandbox import seccomp
from kit.host.wire import MAX_ID, MAX_TEXT

STDERR = 2
MAX_MESSAGE = 600
"""Characters of an exception's own text."""
MAX_REPR = 60
"""Characters of a value that is shown."""
ADDRESS = re.compile(r" at 0x[0-9a-f]+")
UNSET_ATTRIBUTE = re.compile(r"'(\w+)' object has no attribute '(\w+)'$")


class StudentProgram:
    """A student's file, with the content that it had at the start."""

    def __init__(self, file: str, source: bytes, folder: str | None = None) -> None:
        self.file = file
        self.folder = folder or os.path.dirname(file)
        """Messages name files relative to it."""
        self.source = source
        """The file's content at the start."""

    def load(self, name: str) -> ModuleType:
        """Runs the file as the module ``name``. Raises what the student's code raises."""
        self._check_encoding()
        module = ModuleType(name)
        module.__file__ = self.file
        if name == "__main__":
            module.__package__ = self._package() or None
        sys.modules[name] = module
        exec(compile(self.source, self.file, "exec", dont_inherit=True), module.__dict__)
        return module

    def _package(self) -> str:
        """Returns the name of the Python package in which the file lies, so that it may import its neighbours with a dot."""
        folder, names = os.path.dirname(self.file), []
        while os.path.isfile(os.path.join(folder, "__init__.py")):
            folder, name = os.path.split(folder)
            names.append(name)
        return (
            ".".join(reversed(names)) if os.path.realpath(folder) in map(os.path.realpath, sys.path) else ""
        )

    def _check_encoding(self) -> None:
        """Raises SyntaxError with its line for what ``python FILE`` refuses and ``compile`` of bytes accepts."""
        place = self.source.find(b"\0")
        problem = "source code cannot contain null bytes: save the file as text in UTF-8"
        try:
            if place < 0:
                self.source.decode()
                return
        except UnicodeDecodeError as error:
            if self._declared_encoding() != "utf-8":
                return
            place = error.start
            problem = (
                f"Non-UTF-8 code starting with '\\x{self.source[place]:02x}': save the file as UTF-8, "
                "or declare its encoding in line 1"
            )
        line = self.source.count(b"\n", 0, place) + 1
        raise SyntaxError(problem, (self.file, line, None, None))

    def _declared_encoding(self) -> str:
        from io import BytesIO
        from tokenize import detect_encoding  # here: few programs need it, and each start would pay for it

        try:
            return detect_encoding(BytesIO(self.source).readline)[0]
        except SyntaxError:  # no declaration, and its first two lines are not UTF-8
            return "utf-8"

    def frames(self, trace: TracebackType | None) -> list[tuple[str, int, str]]:
        """Returns the student's own part of a traceback: relative file, line, function; outermost first."""
        found = []
        while trace is not None:
            code = trace.tb_frame.f_code
            relative = self.relative_path(code.co_filename)
            if relative is not None:
                found.append((relative, trace.tb_lineno, code.co_name))
            trace = trace.tb_next
        return found

    def relative_path(self, file: str | None) -> str | None:
        """Returns a path relative to the student's folder; None if it is elsewhere or in an environment there."""
        if file is None or not file.startswith(self.folder + os.sep):
            return None
        relative = file[len(self.folder) + 1 :]
        return None if "site-packages/" in relative else relative

    def source_line(self, file: str, line: int) -> str:
        """Returns a line of one of the student's files, without its indentation; empty if it cannot be read."""
        source = self.source
        if self.relative_path(self.file) != file:
            try:
                with open(f"{self.folder}/{file}", "rb") as opened:
                    source = opened.read()
            except OSError:
                return ""
        lines = source.splitlines()
        return lines[line - 1].decode("utf-8", "replace").strip() if line <= len(lines) else ""


def explain(problem: BaseException, program: StudentProgram) -> Failure:
    """Converts an exception to a failure with the student's own file and line.

    Also writes the student's part of the traceback to the standard error.
    """
    if isinstance(problem, StudentCodeError):
        return problem.failure
    if isinstance(problem, MemoryError):
        # Nothing may be built while the frames hold what filled the memory.
        frames = program.frames(problem.__traceback__)
        problem.__traceback__ = None
        return _make_failure(FailureKind.MEMORY, "out of memory", frames)
    if isinstance(problem, SyntaxError) and program.relative_path(problem.filename):
        line = problem.lineno  # whatever a program's own SyntaxError holds
        return Failure(
            FailureKind.SYNTAX,
            f"{type(problem).__name__}: {problem.msg}",
            program.relative_path(problem.filename),
            line if type(line) is int and 0 < line <= MAX_ID else None,
        )
    if (
        isinstance(problem, SyntaxError) and problem.filename is None
    ):  # null bytes, say: no line was ever read
        return Failure(
            FailureKind.SYNTAX,
            f"{type(problem).__name__}: {problem.msg}",
            program.relative_path(program.file),
        )
    frames = program.frames(problem.__traceback__)
    if isinstance(problem, SystemExit):
        return _exit_failure(problem, frames)
    if isinstance(problem, OSError) and problem.errno == errno.ENOSPC and seccomp.is_installed():
        return _make_failure(FailureKind.DISK, "its folder is full", frames)
    if len(frames) > 1:
        _print_frames(frames, program)
    kind = FailureKind.IMPORT if isinstance(problem, ImportError) else FailureKind.EXCEPTION
    text = _message_of(problem)
    message = f"{type(problem).__name__}: {text}" if text else type(problem).__name__
    if frames and frames[-1][2] != "<module>":
        message += f" (in {frames[-1][2]})"
    way_out = _way_out(problem, program)
    with suppress(BaseException):  # an exception of the student's own may have a broken __str__
        way_out = way_out or meaning(problem)
    return _make_failure(kind, message + way_out, frames)


def exit_status(problem: SystemExit) -> int:
    """Returns the status with which Python would end the process: 0 to 255."""
    if problem.code is None:
        return 0
    return problem.code & 0xFF if isinstance(problem.code, int) else 1


def _exit_failure(problem: SystemExit, frames: list[tuple[str, int, str]]) -> Failure:
    status = exit_status(problem)
    if not isinstance(problem.code, int | None):
        text = f"the program exited: {_message_of(problem)}"
    elif status:
        text = f"the program exited with status {status}."
    else:  # what was called has not returned
        text = "the program exited before it had done what it was called for. Let it return instead."
    return _make_failure(FailureKind.EXIT, text, frames, status)


def _way_out(problem: BaseException, program: StudentProgram) -> str:
    """Says what a name that does not exist was probably meant to be, as Python's own traceback does."""
    if (
        isinstance(problem, OSError)
        and problem.errno in (errno.EPERM, errno.EACCES, errno.ENOSYS)
        and seccomp.is_installed()
    ):
        return f". {_innermost_call(problem.__traceback__)} is refused to a program that is confined."
    if isinstance(problem, ImportError):
        return import_way_out(problem, program.file)
    name = getattr(problem, "name", None)
    unset = UNSET_ATTRIBUTE.match(str(problem.args[0])) if name is None and problem.args else None
    if unset is not None and isinstance(problem, AttributeError):  # Python tells of what was read alone
        name = unset[2]
    if not isinstance(name, str):
        return ""
    known: set[str] = set()
    with suppress(BaseException):  # a student's class may have a broken __dir__
        if isinstance(problem, AttributeError):
            owner = problem.obj if unset is None else _local_of_type(problem.__traceback__, unset[1])
            known.update(word for word in dir(owner) if name.startswith("_") or word[:1] != "_")
        elif isinstance(problem, NameError):
            if name in sys.stdlib_module_names:
                return f". Did you forget `import {name}`?"
            known.update(dir(builtins), *_innermost_names(problem.__traceback__))
    return nearest(name, known)


def _innermost_call(trace: TracebackType | None) -> str:
    """Returns what was called where an exception was raised, as it is written there: ``os.fork()``."""
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    if trace is None:
        return "That"
    import linecache  # here: only a mistake needs it

    code = trace.tb_frame.f_code
    first, last, begin, end = next(islice(code.co_positions(), trace.tb_lasti // 2, None), (None,) * 4)
    line = linecache.getline(code.co_filename, first or 0)
    called = (
        line.encode()[begin : end if first == last else None]
        .decode(errors="replace")
        .partition("(")[0]
        .strip()
    )
    return f"{called}()" if called else f"What {code.co_name}() calls"


def _innermost_names(trace: TracebackType | None) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
    """Returns the local and the global names where an exception was raised, with their values."""
    if trace is None:
        return {}, {}
    while trace.tb_next is not None:
        trace = trace.tb_next
    return trace.tb_frame.f_locals, trace.tb_frame.f_globals


def _local_of_type(trace: TracebackType | None, type_name: str) -> object:
    """Returns a local object of a type where an exception was raised; None if there is none."""
    values = _innermost_names(trace)[0].values()
    return next((each for each in values if type(each).__name__ == type_name), None)


def _make_failure(
    kind: FailureKind, message: str, frames: list[tuple[str, int, str]], status: int = 1
) -> Failure:
    file, line = frames[-1][:2] if frames else (None, None)
    return Failure(kind, message[:MAX_TEXT], file, line, status)


def short_repr(value: object) -> str:
    """Returns a value as a short text, whatever it is: without its place in memory, which differs from run to run."""
    try:
        text = ADDRESS.sub("", repr(value))
        return text if len(text) <= MAX_REPR else f"{text[:MAX_REPR]}..."
    except Exception:  # noqa: BLE001 - a student's class may have a broken __repr__
        return f"a {type(value).__name__}"


def _message_of(problem: BaseException) -> str:
    try:
        return str(problem)[:MAX_MESSAGE]
    except BaseException:  # noqa: BLE001 - likewise, also one that is an interrupt
        return ""


def _print_frames(frames: list[tuple[str, int, str]], program: StudentProgram) -> None:
    lines = ["Traceback (most recent call last):"]
    lines += [
        f"  {file}:{line} in {function}: {program.source_line(file, line)}"
        for file, line, function in frames[-20:]
    ]
    # Past sys.stderr, which the program may have closed or replaced.
    with suppress(OSError):
        os.write(STDERR, "".join(f"{line}\n" for line in lines).encode("utf-8", "replace"))
