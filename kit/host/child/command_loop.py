"""The child's side of the protocol: one command at a time, one answer to each, by a deadline."""

from __future__ import annotations

import faulthandler
import os
import signal
import sys
import threading
import time
from contextlib import suppress
from time import sleep as wall_sleep  # before it is replaced by one of simulated time
from typing import Final, NoReturn

from kit.host.child.program_input import DeferredInterrupts
from kit.host.failure import Failure
from kit.host.wire import HEADER, LOST_PIPE, Json, decode, encode

FORK_STEP_NS: Final = 10_000_000
"""How long a forked process waits at most at once [ns]."""


SENT: Final = frozenset({"message", "request", "response"})
"""The events that a program sends by what it does, and not because it has a node."""


class CommandChannel:
    """Sends and receives frames over a file descriptor. Raises EOFError when the parent has disconnected."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor

    def send(self, content: Json) -> None:
        rest = memoryview(encode(content))
        while rest:
            rest = rest[os.write(self._descriptor, rest) :]

    def receive(self) -> Json:
        (length,) = HEADER.unpack(self._read_exactly(HEADER.size))
        return decode(self._read_exactly(length))

    def _read_exactly(self, count: int) -> bytes:
        data = os.read(self._descriptor, count)
        if len(data) == count:
            return data
        parts = [data]
        while count := count - len(data):
            if not data:
                raise EOFError("the kit has gone")
            data = os.read(self._descriptor, count)
            parts.append(data)
        return b"".join(parts)


class ForkChannel:
    """In place of the channel in a process that the program has forked: time goes by the wall clock, from the fork on, and
    nothing goes to the kit, which knows of one process and has one answer to each question from it."""

    def __init__(self, now_ns: int) -> None:
        """``now_ns``: the simulated time at the fork."""
        self._began_ns = time.monotonic_ns() - now_ns
        self._wake_ns: int | None = None
        self._has_told = False

    def send(self, content: Json) -> None:
        """Takes an answer; one that the program has ended, or failed, ends the process."""
        kind, _, *fields = content
        if kind == "failed":
            os._exit(fields[-1])
        if kind == "ended":
            os._exit(0)
        self._wake_ns = fields[0] if len(fields) > 1 else None
        if not self._has_told and any(event[0] in SENT for event in fields[-1]):
            self._has_told = True
            text = "a process that the program has forked cannot publish, nor call: what it sends goes nowhere.\n"
            os.write(2, text.encode())

    def receive(self) -> Json:
        """Waits until the time for which the process waits, for a step at most; returns a tick without events."""
        now_ns = time.monotonic_ns() - self._began_ns
        until_ns = (
            now_ns + FORK_STEP_NS if self._wake_ns is None else min(self._wake_ns, now_ns + FORK_STEP_NS)
        )
        wall_sleep(max(0, until_ns - now_ns) / 1e9)
        return ["tick", 0, max(until_ns, time.monotonic_ns() - self._began_ns), []]


def enable_stack_dumps(descriptor: int) -> None:
    """Makes Python dump the stack of every thread on a crash and on a timeout; the parent reads it there."""
    faulthandler.enable(descriptor)
    faulthandler.register(signal.SIGALRM, descriptor)
    faulthandler.register(signal.SIGPROF, descriptor)
    faulthandler.register(signal.SIGXCPU, descriptor, chain=True)


class CommandSession:
    """Receives the parent's commands and sends the answers. Safe to use from any thread."""

    def __init__(self, channel: CommandChannel) -> None:
        self._channel: CommandChannel | ForkChannel = channel
        self._lock = threading.Lock()
        self._seq = 0
        self._open = False
        self._final_answer: tuple[Json, ...] | None = None
        self.interrupts = DeferredInterrupts()
        self.reply_s = self.reply_wall_s = 0.0
        """How long an answer may take, by processor time and by the wall clock [s]."""

    def leave(self, now_ns: int) -> None:
        """Makes this a session without the parent, in a process that the program has forked. ``now_ns``: the simulated time."""
        self._channel, self._lock = ForkChannel(now_ns), threading.Lock()
        self.reply_s = self.reply_wall_s = 0.0
        self._open, self._final_answer = True, None

    def set_deadline(self, processor_s: float, wall_s: float) -> None:
        """Makes Python dump its stacks after this long without an answer, by either clock; 0 switches that off."""
        signal.setitimer(signal.ITIMER_PROF, processor_s)
        signal.setitimer(signal.ITIMER_REAL, wall_s)

    def next_command(self) -> list[Json]:
        """Waits for the next command; returns its kind and its content, without its number."""
        try:
            kind, seq, *content = self._channel.receive()
        except (EOFError, ConnectionError):
            os._exit(0)
        except OSError:
            os._exit(LOST_PIPE)
        with self._lock:
            self._seq, self._open = seq, True
        if self._final_answer is not None:
            self._finish(*self._final_answer)
        self.set_deadline(self.reply_s, self.reply_wall_s)
        return [kind, *content]

    def answer(self, kind: str, *content: Json) -> None:
        """Answers the command. Does not return after ``ended``."""
        if kind == "ended":
            self._finish(kind, *content)
        self._send_answer(kind, *content)

    def fail(self, failure: Failure) -> NoReturn:
        """Answers that the program has failed, and ends the process."""
        self._finish(
            "failed", failure.kind.value, failure.message, failure.file, failure.line, failure.status
        )

    def _finish(self, *final_answer: Json) -> NoReturn:
        """Ends the process with this answer: to the open command, or to the next one, for which another thread waits."""
        if not self._send_answer(*final_answer):
            threading.Event().wait()
        os._exit(0)

    def _send_answer(self, kind: str, *content: Json) -> bool:
        """Sends an answer; returns False if no command is open: then the first such answer is kept for the next one."""
        self.set_deadline(0, 0)
        for stream in (sys.stdout, sys.stderr):
            with suppress(AttributeError, OSError, ValueError):  # the program may have closed or replaced it
                stream.flush()
        with self._lock:
            if not self._open:
                self._final_answer = self._final_answer or (kind, *content)
                return False
            self._open = False
            try:
                self._channel.send([kind, self._seq, *content])
            except OSError:
                os._exit(LOST_PIPE)
        return True
