"""Starting, feeding, limiting and ending one student's process: the parent's side, and the only one there is.

No threads: the child runs only while it owes an answer, and whoever waits for the answer also empties what the
child prints. Every way out of here ends the child and all that came out of it.
"""

from __future__ import annotations

import os
import select
import socket
import stat
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from types import MappingProxyType, TracebackType
from typing import Final, Literal, NoReturn, Self, TypeAlias

from kit.host import failure_messages
from kit.host.failure import Failure, StudentCodeError
from kit.host.output import Output, Position, Printed, Stream
from kit.host.package_program import Installed
from kit.host.protocol import ASKING, Confined, Ended, Failed, Frame, Refused, State, check_allowed, parse
from kit.host.sandbox.confinement import INTERACTIVE_LEVEL, Level, SandboxConfig
from kit.host.sandbox.grants import Grants, grants, libraries
from kit.host.sandbox.limits import INTERACTIVE_LIMITS, KIB, Limits
from kit.host.sandbox.reaper import end_descendants, remove_folder
from kit.host.wire import HEADER, Json, ProtocolError, decode, encode

Role: TypeAlias = Literal["node", "functions", "launch"]

LARGEST_SOURCE: Final = 512 * KIB
"""Bytes of a student's file."""
DUMP_S: Final = 1.0
"""How long to wait, after a deadline, for the child's Python to say where it was."""
FAREWELL_S: Final = 3.0
"""How long the process above the child may take to clean up."""

_STARTING: Final[Mapping[Role, State]] = MappingProxyType(
    {
        "node": State.STARTING_NODE,
        "functions": State.STARTING_FUNCTIONS,
        "launch": State.STARTING_LAUNCH,
    }
)

_HERE = Path(__file__).parent
_READ = 1 << 16


class StudentProcess:
    """One student's file in a process of its own. Use as a context manager, or ``close`` it.

    Starts at once and does not wait: ``started`` does. After that, one ``ask`` after the other. What goes
    wrong, whenever, is raised as StudentCodeError, kept as ``failure``, and the child is gone by then.
    """

    def __init__(
        self,
        role: Role,
        file: Path,
        start: Mapping[str, Json],
        *,
        limits: Limits = INTERACTIVE_LIMITS,
        level: Level = INTERACTIVE_LEVEL,
        installed: Installed | None = None,
    ) -> None:
        self.failure: Failure | None = None
        self._state = State.CONFINING
        self._starting = _STARTING[role]
        self._file = file.absolute()
        self._limits = limits
        self._level = level
        self._home = self._file.parent if installed is None else installed.folder
        self._start = {**start, **_program(self._file), "reply_s": limits.reply_s}
        if installed is not None:
            self._start |= installed.as_start()
        self._seq = 0
        self._waited = 0.0
        self._output = Output(limits.output)
        self._folder = tempfile.mkdtemp(prefix="kit-")
        granted = _granted(level, self._file, installed)
        config = SandboxConfig(level, limits, self._folder, granted.readable, granted.listed)
        for folder in (config.scratch, config.root):
            Path(folder).mkdir()
        self._pipe, theirs = socket.socketpair()
        try:
            self._process = subprocess.Popen(
                command(),
                stdin=theirs.fileno(),
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                cwd=config.scratch,
                env=environment(config.scratch),
                start_new_session=True,
                bufsize=0,
            )
        except BaseException:
            self._pipe.close()
            remove_folder(self._folder)
            raise
        finally:
            theirs.close()
        self._pipe.setblocking(False)
        self._buffer = bytearray()
        self._unsent = bytearray(encode([role, asdict(config)]))
        self._blocked = False
        assert self._process.stdout is not None
        assert self._process.stderr is not None
        self._streams: dict[int, Stream] = {
            self._process.stdout.fileno(): "out",
            self._process.stderr.fileno(): "err",
        }
        self._poller = select.poll()
        for descriptor in (self._pipe.fileno(), *self._streams):
            self._poller.register(descriptor, select.POLLIN)
        self._deadline = time.monotonic() + limits.start_s
        self._answer: Frame | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def pid(self) -> int:
        """Of the process above the child."""
        return self._process.pid

    @property
    def level(self) -> Level:
        """How far the child is locked in. It said so before it got the student's code."""
        return self._level

    def started(self, wait_s: float | None = None) -> Frame | None:
        """The first answer, to the start; None if it has not come within ``wait_s``, by default the limit."""
        until = self._deadline if wait_s is None else min(self._deadline, time.monotonic() + wait_s)
        while self._answer is None:
            frame = self._receive(until)
            if isinstance(frame, Confined):
                self._send_program(frame)
            elif isinstance(frame, Refused):
                raise self.fail(failure_messages.cannot_confine(self._level, frame.reason))
            elif frame is not None:
                self._answer = self._checked(frame)
            elif time.monotonic() >= self._deadline:
                self._time_out("start", self._limits.start_s)
            else:
                return None
        return self._answer

    def _send_program(self, frame: Confined) -> None:
        """Sends the student's code, and what it needs to start, to a child that is locked in."""
        if frame.level != self._level:
            raise self.fail(failure_messages.nonsense("another level of confinement than was asked for"))
        self._start["start_s"] = max(0.001, self._deadline - time.monotonic())
        self._unsent += encode(["start", 0, self._start])
        self._start = {}
        self._state = self._starting

    def ask(self, kind: str, *content: Json) -> Frame:
        """Sends one frame and waits for its answer."""
        assert self._answer is not None, "ask before started"
        if self.failure is not None:
            raise StudentCodeError(self.failure)
        self._refuse_unasked()
        self._state = ASKING[kind]
        self._seq += 1
        self._unsent += encode([kind, self._seq, *content])
        began = time.monotonic()
        in_all = float("inf") if self._limits.total_s is None else self._limits.total_s - self._waited
        frame = self._receive(began + min(self._limits.reply_s, in_all))
        self._waited += time.monotonic() - began
        if frame is None and in_all < self._limits.reply_s and self._limits.total_s is not None:
            self._time_out("total", self._limits.total_s)
        if frame is None:
            self._time_out("reply", self._limits.reply_s)
        return self._checked(frame)

    def take_output(self) -> Printed:
        """What the program has printed since the last time."""
        return self._output.take()

    def fail(self, failure: Failure) -> StudentCodeError:
        """Ends the child for this reason; what to raise then."""
        self.failure = failure
        self.close()
        return StudentCodeError(failure)

    def disconnect(self) -> None:
        """Ends the conversation, from any thread: who waits in ``ask`` or ``started`` gets a StudentCodeError."""
        with suppress(OSError):  # it has ended already
            self._pipe.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        """Ends the child and everything that came out of it, and removes its folder. May be called twice."""
        self._pipe.close()  # the process above the child notices, and cleans up
        try:
            self._process.wait(FAREWELL_S)
        except subprocess.TimeoutExpired:
            end_descendants(self._process.pid)
            self._process.kill()
            self._process.wait()
        self._output.finish()
        for stream in (self._process.stdout, self._process.stderr):
            if stream is not None:
                stream.close()
        remove_folder(self._folder)

    def _receive(self, deadline: float) -> Frame | None:
        """The next frame; None if it is not complete at the deadline."""
        try:
            while True:
                self._send()
                for descriptor, _ in self._poller.poll(max(0.0, deadline - time.monotonic()) * 1000):
                    if descriptor in self._streams:
                        self._drain(descriptor)
                    else:
                        self._read()
                content = self._frame()
                if content is not None:
                    frame = parse(decode(content))
                    check_allowed(frame, self._state)
                    return frame
                if time.monotonic() >= deadline:
                    return None
        except ProtocolError as problem:
            raise self.fail(failure_messages.nonsense(str(problem))) from None
        except (EOFError, ConnectionError):
            raise self.fail(self._post_mortem()) from None

    def _refuse_unasked(self) -> None:
        """Ends a child that has said something while nothing was asked."""
        try:
            self._read()
        except (EOFError, ConnectionError):
            raise self.fail(self._post_mortem()) from None
        if self._buffer:
            raise self.fail(failure_messages.nonsense("something while nothing was asked"))

    def _post_mortem(self) -> Failure:
        """Why the child is gone, after its last words."""
        self._drain_until(time.monotonic() + FAREWELL_S)
        try:
            status = self._process.wait(FAREWELL_S)
        except subprocess.TimeoutExpired:
            return failure_messages.nonsense("an end of the conversation in the middle of the program")
        return failure_messages.dead(status, self._where(), self._limits)

    def _where(self) -> Position | None:
        return self._output.position(str(self._home))

    def _send(self) -> None:
        if not self._unsent:
            return
        with suppress(BlockingIOError):
            del self._unsent[: self._pipe.send(self._unsent)]
        if self._blocked != bool(self._unsent):  # rarely: a frame larger than the pipe takes at once
            self._blocked = not self._blocked
            self._poller.modify(self._pipe, select.POLLIN | (select.POLLOUT if self._blocked else 0))

    def _read(self) -> None:
        with suppress(BlockingIOError):  # called because there is room to send
            data = self._pipe.recv(_READ)
            if not data:
                raise EOFError
            self._buffer += data

    def _frame(self) -> bytes | None:
        """The one frame that has come, if it is complete."""
        if len(self._buffer) < HEADER.size:
            return None
        (length,) = HEADER.unpack_from(self._buffer)
        if length > self._limits.frame:
            raise ProtocolError(f"a frame of {length} bytes; {self._limits.frame} are allowed")
        if len(self._buffer) > HEADER.size + length:
            raise ProtocolError("more than one answer to one question")
        if len(self._buffer) < HEADER.size + length:
            return None
        content = bytes(self._buffer[HEADER.size :])
        self._buffer.clear()
        return content

    def _checked(self, frame: Frame) -> Frame:
        """An answer to what was asked last."""
        if isinstance(frame, (Confined, Refused)) or frame.seq != self._seq:  # the first two for mypy only
            raise self.fail(failure_messages.nonsense("an answer to a question that was not asked"))
        if isinstance(frame, Failed):
            raise self.fail(failure_messages.told(frame.failure, self._limits))
        if isinstance(frame, Ended):
            self.close()
        self._state = State.IDLE
        return frame

    def _drain(self, descriptor: int) -> None:
        data = os.read(descriptor, _READ)
        if data:
            self._output.feed(self._streams[descriptor], data)
        else:
            self._poller.unregister(descriptor)
            del self._streams[descriptor]

    def _drain_until(self, deadline: float) -> None:
        """Goes on emptying the child's streams, without it, until they end or the deadline comes."""
        while self._streams and (left := deadline - time.monotonic()) > 0:
            for descriptor, _ in self._poller.poll(left * 1000):
                if descriptor in self._streams:
                    self._drain(descriptor)
                else:
                    self._poller.modify(self._pipe, 0)

    def _time_out(self, which: failure_messages.Budget, limit_s: float) -> NoReturn:
        deadline = time.monotonic() + DUMP_S
        while self._where() is None and time.monotonic() < deadline:
            self._drain_until(time.monotonic() + DUMP_S / 50)
        raise self.fail(failure_messages.too_slow(which, limit_s, self._where()))


def _program(file: Path) -> dict[str, Json]:
    """The student's file as data. It is read once: what runs is what was here now."""
    try:
        # A named pipe would have us wait for ever.
        with open(os.open(file, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC), "rb") as opened:
            if not stat.S_ISREG(os.fstat(opened.fileno()).st_mode):
                raise StudentCodeError(failure_messages.unreadable(file, "not a file"))
            source = opened.read(LARGEST_SOURCE + 1)
    except OSError as problem:
        raise StudentCodeError(failure_messages.unreadable(file, problem.strerror or "unreadable")) from None
    if len(source) > LARGEST_SOURCE:
        raise StudentCodeError(failure_messages.unreadable(file, f"larger than {LARGEST_SOURCE // KIB} KiB"))
    return {"file": str(file), "source": source.decode("latin-1"), "libraries": libraries()}


def command() -> list[str]:
    """The interpreter without anything of the user's or the folder's: no site, no user site, no ``sys.path[0]``.

    ``-I`` would also ignore PYTHONHASHSEED, and so let the order of a set differ from run to run; the
    environment is ours anyway.
    """
    return [sys.executable, "-s", "-S", "-P", str(_HERE / "child" / "bootstrap.py")]


def environment(scratch: str) -> dict[str, str]:
    """All the environment there is: the same at the desk and in the grader."""
    fixed = {
        "PATH": "/usr/bin:/bin",
        "HOME": scratch,
        "TMPDIR": scratch,
        "LANG": "C.UTF-8",
        "PYTHONHASHSEED": "0",
        "PYTHONUTF8": "1",
        # One thread each: more would differ between machines, and each reserves memory.
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_NUM_THREADS": "1",
        "MKL_NUM_THREADS": "1",
    }
    # Where a computing cluster keeps the libraries of the very Python that runs this.
    library_path = os.environ.get("LD_LIBRARY_PATH")
    return fixed | ({"LD_LIBRARY_PATH": library_path} if library_path else {})


def _granted(level: Level, file: Path, installed: Installed | None) -> Grants:
    """What a program may read; of one that is a part of a package: the package too, and what it imports from."""
    if level == Level.LIMITED:  # nothing is kept from it
        return Grants()
    more = () if installed is None else (installed.folder, *installed.imports)
    return grants((file.parent, *more))
