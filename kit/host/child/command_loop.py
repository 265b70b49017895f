"""The child's side of the protocol: one command at a time, one answer to each, by a deadline."""

from __future__ import annotations

import faulthandler
import os
import signal
import sys
import threading
from contextlib import suppress
from typing import NoReturn

from kit.host.child.program_input import DeferredInterrupts
from kit.host.failure import Failure
from kit.host.wire import HEADER, LOST_PIPE, Json, decode, encode


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


def enable_stack_dumps(descriptor: int) -> None:
    """Makes Python dump the stack of every thread on a crash and on a timeout; the parent reads it there."""
    faulthandler.enable(descriptor)
    faulthandler.register(signal.SIGALRM, descriptor)
    faulthandler.register(signal.SIGPROF, descriptor)
    faulthandler.register(signal.SIGXCPU, descriptor, chain=True)


class CommandSession:
    """Receives the parent's commands and sends the answers. Safe to use from any thread."""

    def __init__(self, channel: CommandChannel) -> None:
        self._channel = channel
        self._lock = threading.Lock()
        self._seq = 0
        self._open = False
        self._final_answer: tuple[Json, ...] | None = None
        self.interrupts = DeferredInterrupts()
        self.reply_s = self.reply_wall_s = 0.0
        """How long an answer may take, by processor time and by the wall clock [s]."""

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
