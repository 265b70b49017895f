"""The child's side of the protocol: one question at a time, one answer to each, by a deadline."""

from __future__ import annotations

import faulthandler
import os
import signal
import sys
import threading

from kit.host.failure import Failure
from kit.host.wire import HEADER, LOST_PIPE, Json, decode, encode

STDERR = 2


class Channel:
    """Frames over a file descriptor. EOFError when the parent has gone."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor

    def send(self, content: Json) -> None:
        rest = memoryview(encode(content))
        while rest:
            rest = rest[os.write(self._descriptor, rest) :]

    def receive(self) -> Json:
        (length,) = HEADER.unpack(self._exactly(HEADER.size))
        return decode(self._exactly(length))

    def _exactly(self, count: int) -> bytes:
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


def watch_stacks() -> None:
    """On a crash, or when time is up, Python writes where every thread was; the parent reads it."""
    faulthandler.enable(STDERR)
    faulthandler.register(signal.SIGALRM, STDERR)
    faulthandler.register(signal.SIGXCPU, STDERR, chain=True)


class Conversation:
    """Questions from the kit and the student's answers. Safe to use from any thread."""

    def __init__(self, channel: Channel) -> None:
        self._channel = channel
        self._lock = threading.Lock()
        self._seq = 0
        self._open = False
        self._failure: Failure | None = None
        self.reply_s = 0.0
        """How long an answer may take."""

    def allow(self, seconds: float) -> None:
        """Has Python say where it is when that long has passed without an answer."""
        signal.setitimer(signal.ITIMER_REAL, seconds)

    def next_question(self) -> list[Json]:
        """Waits for the next question, and returns it without its number."""
        try:
            kind, seq, *content = self._channel.receive()
        except (EOFError, ConnectionError):
            os._exit(0)
        except OSError:
            os._exit(LOST_PIPE)
        with self._lock:
            self._seq, self._open = seq, True
        if self._failure is not None:
            self.fail(self._failure)
        self.allow(self.reply_s)
        return [kind, *content]

    def answer(self, kind: str, *content: Json) -> None:
        """Answers the question."""
        self.allow(0)
        sys.stdout.flush()
        with self._lock:
            self._open = False
            self._send([kind, self._seq, *content])

    def fail(self, failure: Failure) -> None:
        """Answers that the program is over, now or as soon as there is a question. Ends the process if it can."""
        with self._lock:
            self._failure = failure
            if not self._open:
                return
            sys.stdout.flush()
            sys.stderr.flush()
            self._send(["failed", self._seq, failure.kind.value, failure.message, failure.file, failure.line])
            os._exit(0)

    def _send(self, frame: Json) -> None:
        try:
            self._channel.send(frame)
        except OSError:
            os._exit(LOST_PIPE)
