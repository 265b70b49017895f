"""The child's end of the pipe: blocking, whole frames."""

from __future__ import annotations

import os
from typing import Final

from kit.host.wire import HEADER, Json, decode, encode

LOST_PIPE: Final = 70
"""Exit status of a child whose pipe was closed under it (EX_SOFTWARE of sysexits.h)."""


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
