"""Starts, limits and ends one student's process, and exchanges frames with it: the parent's side.

There are no threads: the child runs only while it owes an answer, and the caller that waits for the answer also reads
what the child prints. Every way out ends the child and every process that it has started.
"""

from __future__ import annotations

import math
import os
import select
import socket
import subprocess
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from types import MappingProxyType
from typing import Final, Literal, NoReturn, Self, TypeAlias

from kit.host.failure import (
    Budget,
    Failure,
    FailureKind,
    StudentCodeError,
    add_limits,
    confinement_unavailable,
    process_ended,
    protocol_violation,
    timed_out,
)
from kit.host.output import OutputCollector, ProgramOutput, StackPosition, Stream
from kit.host.private_folder import make_private_folder
from kit.host.processor_delay import delayed_s
from kit.host.program_start import (
    STARTS,
    PackageProgram,
    child_seed,
    process_environment,
    read_grants,
    read_program,
    start_command,
)
from kit.host.program_terminal import ProgramStreams
from kit.host.protocol import (
    STATE_AFTER_COMMAND,
    Confined,
    ConfinementRefused,
    Ended,
    Failed,
    Frame,
    ProcessState,
    check_allowed,
    parse,
)
from kit.host.sandbox import bubblewrap
from kit.host.sandbox.control_groups import ControlGroup, return_group, take_group
from kit.host.sandbox.limits import INTERACTIVE_LIMITS, Limits
from kit.host.sandbox.reaper import descendants, end_descendants, remove_folder
from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL, Level, SandboxConfig
from kit.host.wire import HEADER, Json, ProtocolError, decode, encode

Role: TypeAlias = Literal["node", "functions", "launch"]

CHECK_S: Final = 0.02
"""How long to wait at least before the processor time is read again [s]."""
STACK_DUMP_S: Final = 1.0
"""How long to wait, after a deadline, for the stack dump of the child's Python [s]."""
SHUTDOWN_S: Final = 3.0
"""How long the process above the child may take to clean up [s]."""

_STARTING_STATES: Final[Mapping[Role, ProcessState]] = MappingProxyType(
    {
        "node": ProcessState.STARTING_NODE,
        "functions": ProcessState.STARTING_FUNCTIONS,
        "launch": ProcessState.STARTING_LAUNCH,
    }
)

_READ_SIZE = 1 << 16


class StudentProcess:
    """Runs one student's file in a process of its own. Use it as a context manager, or ``close`` it.

    The process starts with the constructor; ``wait_started`` waits for it. After that comes one ``request`` after the
    other. Whatever fails is raised as StudentCodeError and kept as ``failure``; the process has ended by then.
    """

    def __init__(
        self,
        role: Role,
        file: Path,
        start: Mapping[str, Json],
        *,
        limits: Limits = INTERACTIVE_LIMITS,
        level: Level = INTERACTIVE_LEVEL,
        package: PackageProgram | None = None,
        streams: ProgramStreams | None = None,
    ) -> None:
        """``streams``: what the program reads and writes where it is run by hand."""
        self.failure: Failure | None = None
        self._state = ProcessState.CONFINING
        self._starting_state = _STARTING_STATES[role]
        self._file = file.absolute()
        self._limits = limits
        self._level = level
        self._home_folder = self._file.parent if package is None else package.folder
        self._start_fields = {
            **start,
            **read_program(self._file),
            "reply_s": limits.reply_s,
            "reply_wall_s": limits.reply_wall_s,
        }
        self._start_fields["has_input"] = streams is not None and streams.stdin is not None
        seed = start.get("seed")
        if isinstance(seed, int):
            self._start_fields["seed"] = child_seed(seed)
        if package is not None:
            self._start_fields |= package.to_start_fields()
        self._seq = 0
        self._waited_s = 0.0
        self._output = OutputCollector(limits.output)
        self._folder = make_private_folder()
        granted = read_grants(level, self._file, package)
        in_bubblewrap = level == Level.SEPARATE and bubblewrap.is_needed()
        # From inside bubblewrap no group can be joined.
        self._group: ControlGroup | None = (
            take_group(limits) if level >= Level.FILTERED and not in_bubblewrap else None
        )
        config = SandboxConfig(
            level,
            limits,
            self._folder,
            granted.readable,
            granted.listed,
            granted.hidden,
            in_bubblewrap,
            () if self._group is None else self._group.member_files,
        )
        for folder in (config.scratch, config.root):
            Path(folder).mkdir()
        self._pipe, theirs = socket.socketpair()
        descriptors = (streams or ProgramStreams()).descriptors()
        # Duplicates, since the numbers 0 to 2 are replaced in the child before it is told the others.
        inherited = [None if each is None else os.dup(each) for each in descriptors]
        try:
            self._process = STARTS[-1](
                start_command(config),
                stdin=theirs.fileno(),
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                cwd=config.scratch,
                env=process_environment(config.scratch),
                start_new_session=True,
                bufsize=0,
                pass_fds=[each for each in inherited if each is not None],
            )
        except BaseException:  # Ctrl-C too: the process must not outlive it; raised again
            self._pipe.close()
            remove_folder(self._folder)
            self._leave_group()
            raise
        finally:
            theirs.close()
            for each in inherited:
                if each is not None:
                    os.close(each)
        self._pipe.setblocking(False)
        self._buffer = bytearray()
        self._unsent = bytearray(encode([role, asdict(config), inherited]))
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
        self._program: int | None = None
        self._deadline = time.monotonic() + limits.start_wall_s
        self._start_used_s = 0.0
        self._first_answer: Frame | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def pid(self) -> int:
        """Process id of the process above the student's."""
        return self._process.pid

    @property
    def level(self) -> Level:
        """Confinement level of the process. The child reported it before it received the student's code."""
        return self._level

    def wait_started(self, wait_s: float | None = None) -> Frame | None:
        """Returns the first answer; None if it has not come within ``wait_s`` [s], by default the limit."""
        until = self._deadline if wait_s is None else min(self._deadline, time.monotonic() + wait_s)
        while self._first_answer is None:
            # Nothing has been used before the student's code is there.
            left_s = self._limits.start_s - self._processor_s()
            frame = self._receive(min(until, time.monotonic() + max(CHECK_S, left_s)))
            if isinstance(frame, Confined):
                self._send_program(frame)
            elif isinstance(frame, ConfinementRefused):
                raise self.fail(confinement_unavailable(self._level, frame.reason))
            elif frame is not None:
                self._first_answer = self._check_answer(frame)
                self._start_used_s = self._processor_s()
            elif self._processor_s() >= self._limits.start_s:
                self._fail_timeout("start", self._limits.start_s)
            elif time.monotonic() >= self._deadline:
                self._fail_timeout("start wall", self._limits.start_wall_s)
            elif time.monotonic() >= until:
                return None
        return self._first_answer

    def _send_program(self, frame: Confined) -> None:
        """Sends the student's code, and what it needs to start, to a child that is confined."""
        if frame.level != self._level:
            raise self.fail(protocol_violation("another level of confinement than was asked for"))
        self._program = _program_below(self._process.pid)
        self._start_fields["start_s"] = self._limits.start_s
        self._start_fields["start_wall_s"] = max(0.001, self._deadline - time.monotonic())
        self._unsent += encode(["start", 0, self._start_fields])
        self._start_fields = {}
        self._state = self._starting_state

    def continue_start(self, kind: str, *content: Json) -> Frame:
        """Sends a command whose answer belongs to the start, and so has what is left of its time. Raises
        StudentCodeError."""
        left_s = max(CHECK_S, self._limits.start_s - self._start_used_s)
        self._send_command(kind, *content)
        frame = self._receive_within(left_s, self._limits.start_wall_s, "start")
        return self._check_answer(frame)

    def request(self, kind: str, *content: Json, wall_s: float | None = None) -> Frame:
        """Sends one command and waits for its answer: for ``wall_s`` by the wall clock, whether it computes or not, by default
        as long as the limits allow [s]. Raises StudentCodeError."""
        limits = self._limits
        self._send_command(kind, *content)
        if limits.total_s is not None and self._waited_s >= limits.total_s:
            self._fail_timeout("total", limits.total_s)
        began = time.monotonic()
        try:
            if wall_s is None:
                return self._check_answer(self._receive_within(limits.reply_s, limits.reply_wall_s, "reply"))
            return self._check_answer(
                self._receive_within(limits.reply_s, wall_s, "reply", extends_wall=False)
            )
        finally:
            self._waited_s += time.monotonic() - began

    def finish_request(self, wall_s: float) -> Frame | None:
        """Waits for the answer to a command whose ``request`` was interrupted, for ``wall_s`` by the wall clock [s]; None if
        there is none. Raises StudentCodeError."""
        if self._state is ProcessState.IDLE:
            return None
        return self._check_answer(
            self._receive_within(self._limits.reply_s, wall_s, "reply", extends_wall=False)
        )

    def _receive_within(
        self,
        processor_s: float,
        wall_s: float,
        budget: Literal["start", "reply"],
        *,
        extends_wall: bool = True,
    ) -> Frame:
        """Returns the answer to a command. Ends a child that uses more processor time before it answers, or more of the wall
        clock, of which with ``extends_wall`` its waiting for a processor does not count. Raises StudentCodeError."""
        began, used_before_s = time.monotonic(), self._processor_s()
        total_s = self._limits.total_s
        left_s = math.inf if total_s is None or budget == "start" else total_s - self._waited_s
        used_s, extra_s = 0.0, 0.0
        pause_s = CHECK_S  # the kernel's files are read only of a program that does not answer at once
        delayed_before_s: float | None = None
        while True:
            now = time.monotonic()
            end = began + min(wall_s + extra_s, left_s)
            frame = self._receive(min(max(end, now + CHECK_S), now + pause_s))
            if frame is not None:
                return frame
            if self._program is None:  # nothing but the wall clock is known
                used_s = time.monotonic() - began
            else:
                used_s = self._processor_s() - used_before_s
            if used_s >= processor_s:
                self._fail_timeout(budget, processor_s)
            if extends_wall and self._program is not None:
                if delayed_before_s is None:
                    delayed_before_s = delayed_s(self._program)
                extra_s = delayed_s(self._program) - delayed_before_s
            waited_s = time.monotonic() - began
            if waited_s >= min(wall_s + extra_s, left_s):
                if total_s is not None and waited_s >= left_s:
                    self._fail_timeout("total", total_s)
                self._fail_timeout("start wall" if budget == "start" else "reply wall", wall_s)
            pause_s = max(CHECK_S, processor_s - used_s)

    def _processor_s(self) -> float:
        """Returns the processor time that the student's process has used [s]; 0 where it cannot be known."""
        if self._program is None:
            return 0.0
        try:
            # The kernel's number for the clock of a process, as of clock_getcpuclockid(3).
            return time.clock_gettime((~self._program << 3) | 2)
        except OSError:  # it has ended
            return 0.0

    def _send_command(self, kind: str, *content: Json) -> None:
        assert self._first_answer is not None, "a command before wait_started"
        if self.failure is not None:
            raise StudentCodeError(self.failure)
        self._check_silence()
        self._state = STATE_AFTER_COMMAND[kind]
        self._seq += 1
        self._unsent += encode([kind, self._seq, *content])

    def charge(self, seconds: float) -> None:
        """Counts the parent's own work on an answer against the child's time in all."""
        self._waited_s += seconds

    def take_output(self) -> ProgramOutput:
        """Removes and returns what the program has printed since the last call."""
        return self._output.take()

    def fail(self, failure: Failure) -> StudentCodeError:
        """Ends the child for this reason; returns the exception to raise."""
        self.failure = failure
        self.close()
        return StudentCodeError(failure)

    def disconnect(self) -> None:
        """Disconnects, from any thread: ``request`` and ``wait_started`` raise StudentCodeError in the thread that waits."""
        with suppress(OSError):  # it has ended already
            self._pipe.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        """Ends the child and every process that it has started, and removes its folder. May be called twice."""
        self._pipe.close()  # the process above the child notices, and cleans up
        try:
            self._process.wait(SHUTDOWN_S)
        except subprocess.TimeoutExpired:
            end_descendants(self._process.pid)
            self._process.kill()
            self._process.wait()
        self._output.finish()
        for stream in (self._process.stdout, self._process.stderr):
            if stream is not None:
                stream.close()
        remove_folder(self._folder)
        self._leave_group()

    def _leave_group(self) -> None:
        if self._group is not None:
            return_group(self._group)
            self._group = None

    def _receive(self, deadline: float) -> Frame | None:
        """Returns the next frame; None if it is not complete at the deadline."""
        try:
            while True:
                self._send()
                for descriptor, _ in self._poller.poll(max(0.0, deadline - time.monotonic()) * 1000):
                    if descriptor in self._streams:
                        self._drain(descriptor)
                    else:
                        self._read()
                content = self._take_frame()
                if content is not None:
                    frame = parse(decode(content))
                    check_allowed(frame, self._state)
                    return frame
                if time.monotonic() >= deadline:
                    return None
        except ProtocolError as problem:
            raise self.fail(protocol_violation(str(problem))) from None
        except (EOFError, ConnectionError):
            raise self.fail(self._exit_failure()) from None

    def _check_silence(self) -> None:
        """Ends a child that has sent something although no command was open."""
        try:
            self._read()
        except (EOFError, ConnectionError):
            raise self.fail(self._exit_failure()) from None
        if self._buffer:
            raise self.fail(protocol_violation("something while nothing was asked"))

    def _exit_failure(self) -> Failure:
        """Returns why the child has ended, after reading the rest of its output."""
        self._drain_until(time.monotonic() + SHUTDOWN_S)
        try:
            status = self._process.wait(SHUTDOWN_S)
        except subprocess.TimeoutExpired:
            return protocol_violation("an end of the conversation in the middle of the program")
        if self._group is not None and self._group.has_run_out_of_memory():
            return add_limits(Failure(FailureKind.MEMORY, ""), self._limits)
        return process_ended(status, self._last_position(), self._limits)

    def _last_position(self) -> StackPosition | None:
        return self._output.position(str(self._home_folder))

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
            data = self._pipe.recv(_READ_SIZE)
            if not data:
                raise EOFError
            self._buffer += data

    def _take_frame(self) -> bytes | None:
        """Returns the content of the frame that has arrived; None while it is incomplete."""
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

    def _check_answer(self, frame: Frame) -> Frame:
        """Returns an answer to the last command. Raises StudentCodeError for any other frame, and for a failure."""
        if (
            isinstance(frame, (Confined, ConfinementRefused)) or frame.seq != self._seq
        ):  # the first two for mypy only
            raise self.fail(protocol_violation("an answer to a question that was not asked"))
        if isinstance(frame, Failed):
            raise self.fail(add_limits(frame.failure, self._limits))
        if isinstance(frame, Ended):
            self.close()
        self._state = ProcessState.IDLE
        return frame

    def _drain(self, descriptor: int) -> None:
        data = os.read(descriptor, _READ_SIZE)
        if data:
            self._output.feed(self._streams[descriptor], data)
        else:
            self._poller.unregister(descriptor)
            del self._streams[descriptor]

    def _drain_until(self, deadline: float) -> None:
        """Goes on reading what the child prints until its streams end or the deadline comes."""
        while self._streams and (left := deadline - time.monotonic()) > 0:
            for descriptor, _ in self._poller.poll(left * 1000):
                if descriptor in self._streams:
                    self._drain(descriptor)
                else:
                    self._poller.modify(self._pipe, 0)

    def _fail_timeout(self, budget: Budget, limit_s: float) -> NoReturn:
        deadline = time.monotonic() + STACK_DUMP_S
        while self._last_position() is None and time.monotonic() < deadline:
            self._drain_until(time.monotonic() + STACK_DUMP_S / 50)
        raise self.fail(timed_out(budget, limit_s, self._last_position()))


def _program_below(supervisor: int) -> int | None:
    """Returns the id of the student's process, the last one below its supervisor; None on other systems than Linux."""
    below = supervisor
    with suppress(OSError, ValueError):  # ended meanwhile, or a kernel without these lists
        while children := Path(f"/proc/{below}/task/{below}/children").read_text().split():
            below = int(children[-1])
    return below if below != supervisor else next(reversed(descendants(supervisor)), None)


class HostedFile:
    """A student's file that runs in a process of its own. Use it as a context manager, or ``close`` it."""

    def __init__(self, process: StudentProcess) -> None:
        self._process = process

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def failure(self) -> Failure | None:
        """Why the student's code has failed; None while it runs, and when it has ended by itself."""
        return self._process.failure

    @property
    def pid(self) -> int:
        """Process id of the process above the student's, which ends with it."""
        return self._process.pid

    @property
    def level(self) -> Level:
        """Confinement level of the process."""
        return self._process.level

    def take_output(self) -> ProgramOutput:
        """Removes and returns what the file has printed since the last call, including its log."""
        return self._process.take_output()

    def close(self) -> None:
        """Ends the process. May be called twice."""
        self._process.close()
