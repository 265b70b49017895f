"""Sends and receives length-prefixed JSON frames over a Unix socket."""

from __future__ import annotations

import socket
import struct
import sys
from contextlib import suppress
from typing import Final

from kit.host.sandbox.limits import MIB
from kit.host.wire import HEADER, Json, ProtocolError, decode, encode

LARGEST_FRAME: Final = 64 * MIB
"""Bytes; large because a terminal that has fallen behind gets many messages at once."""

_CREDENTIALS: Final = struct.Struct("3i")


class FramedSocket:
    """Frames over a stream socket. EOFError when the other end has gone, ProtocolError for what is no frame."""

    def __init__(self, connection: socket.socket, *, largest_frame: int = LARGEST_FRAME) -> None:
        self._connection = connection
        self._largest_frame = largest_frame

    @property
    def peer_user(self) -> int | None:
        """The user id of the other process; None where the system does not tell (only Linux does)."""
        if sys.platform != "linux":
            return None
        credentials = self._connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, _CREDENTIALS.size)
        return int(_CREDENTIALS.unpack(credentials)[1])

    def send(self, content: Json) -> None:
        try:
            self._connection.sendall(encode(content))
        except (BrokenPipeError, ConnectionError) as problem:
            raise EOFError from problem

    def receive(self) -> Json:
        (length,) = HEADER.unpack(self._receive_exactly(HEADER.size))
        if length > self._largest_frame:
            raise ProtocolError(f"a frame of {length} bytes; {self._largest_frame} are allowed")
        return decode(self._receive_exactly(length))

    def close(self) -> None:
        """Closes the connection; a waiting ``receive`` at either end raises EOFError."""
        with suppress(OSError):  # the other end may have been quicker
            self._connection.shutdown(socket.SHUT_RDWR)
        self._connection.close()

    def _receive_exactly(self, count: int) -> bytes:
        data = bytearray()
        while len(data) < count:
            try:
                part = self._connection.recv(min(count - len(data), MIB))
            except ConnectionError as problem:
                raise EOFError from problem
            if not part:
                raise EOFError
            data += part
        return bytes(data)
