"""The child's side of the protocol: one question at a time, one answer to each, by a deadline."""

from __future__ import annotations

import faulthandler
import os
import signal
import sys
import threading
from contextlib import suppress
from typing import NoReturn

from kit.host.child.student_module import STDERR
from kit.host.failure import Failure
from kit.host.wire import HEADER, LOST_PIPE, Json, decode, encode


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


class CommandSession:
    """Questions from the kit and the student's answers. Safe to use from any thread."""

    def __init__(self, channel: Channel) -> None:
        self._channel = channel
        self._lock = threading.Lock()
        self._seq = 0
        self._open = False
        self._last_word: tuple[Json, ...] | None = None
        self.reply_s = 0.0
        """How long an answer may take."""

    def allow(self, seconds: float) -> None:
        """Has Python say where it is when that long has passed without an answer; 0: not any more."""
        signal.setitimer(signal.ITIMER_REAL, seconds)

    def next_command(self) -> list[Json]:
        """Waits for the next question, and returns it without its number."""
        try:
            kind, seq, *content = self._channel.receive()
        except (EOFError, ConnectionError):
            os._exit(0)
        except OSError:
            os._exit(LOST_PIPE)
        with self._lock:
            self._seq, self._open = seq, True
        if self._last_word is not None:
            self._end(*self._last_word)
        self.allow(self.reply_s)
        return [kind, *content]

    def answer(self, kind: str, *content: Json) -> None:
        """Answers the question. After ``ended`` there is no return."""
        if kind == "ended":
            self._end(kind, *content)
        self._say(kind, *content)

    def fail(self, failure: Failure) -> NoReturn:
        """Answers that the program is over by its own fault."""
        self._end("failed", failure.kind.value, failure.message, failure.file, failure.line)

    def _end(self, *last_word: Json) -> NoReturn:
        """Ends the process with this answer: now, or to the next question, for which another thread waits."""
        if not self._say(*last_word):
            threading.Event().wait()
        os._exit(0)

    def _say(self, kind: str, *content: Json) -> bool:
        """Whether there was a question to answer; else this is kept, unless something is already."""
        self.allow(0)
        for stream in (sys.stdout, sys.stderr):
            with suppress(AttributeError, OSError, ValueError):  # the program may have closed or replaced it
                stream.flush()
        with self._lock:
            if not self._open:
                self._last_word = self._last_word or (kind, *content)
                return False
            self._open = False
            try:
                self._channel.send([kind, self._seq, *content])
            except OSError:
                os._exit(LOST_PIPE)
        return True
