"""The Unix sockets of running worlds: found in a folder of the workspace, and read and written in frames of JSON."""

from __future__ import annotations

import math
import os
import re
import socket
import struct
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from kit.host.sandbox.limits import MIB
from kit.host.wire import HEADER, Json, ProtocolError, decode, encode

LARGEST_FRAME: Final = 64 * MIB
"""Bytes; large because a terminal that has fallen behind gets many messages at once."""

_CREDENTIALS: Final = struct.Struct("3i")


class FramedSocket:
    """Frames over a stream socket. EOFError when the other end has gone, ProtocolError for what is no frame.

    ``longest_wait_s``: TimeoutError where a whole frame takes longer than this, however often a part of it comes [s].
    """

    def __init__(
        self,
        connection: socket.socket,
        *,
        largest_frame: int = LARGEST_FRAME,
        longest_wait_s: float = math.inf,
    ) -> None:
        self._connection = connection
        self._largest_frame = largest_frame
        self._longest_wait_s = longest_wait_s

    @property
    def peer_user(self) -> int | None:
        """The user id of the other process; None where the system does not tell (only Linux does)."""
        return self._peer_credential(1)

    @property
    def peer_process(self) -> int | None:
        """Its process id, likewise."""
        return self._peer_credential(0)

    def _peer_credential(self, field: int) -> int | None:
        if sys.platform != "linux":
            return None
        credentials = self._connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, _CREDENTIALS.size)
        return int(_CREDENTIALS.unpack(credentials)[field])

    def send(self, content: Json) -> None:
        try:
            self._connection.sendall(encode(content))
        except (BrokenPipeError, ConnectionError) as problem:
            raise EOFError from problem

    def receive(self) -> Json:
        ends = time.monotonic() + self._longest_wait_s
        (length,) = HEADER.unpack(self._receive_exactly(HEADER.size, ends))
        if length > self._largest_frame:
            raise ProtocolError(f"a frame of {length} bytes; {self._largest_frame} are allowed")
        return decode(self._receive_exactly(length, ends))

    def close(self) -> None:
        """Closes the connection; a waiting ``receive`` at either end raises EOFError."""
        with suppress(OSError):  # the other end may have been quicker
            self._connection.shutdown(socket.SHUT_RDWR)
        self._connection.close()

    def _receive_exactly(self, count: int, ends: float) -> bytes:
        data = bytearray()
        while len(data) < count:
            if time.monotonic() > ends:
                raise TimeoutError
            try:
                part = self._connection.recv(min(count - len(data), MIB))
            except ConnectionError as problem:
                raise EOFError from problem
            if not part:
                raise EOFError
            data += part
        return bytes(data)


MAX_SOCKET_PATH: Final = 100
"""Bytes of a socket's path that every system accepts."""

SUFFIX: Final = ".sock"
UNREADY_SUFFIX: Final = ".unready"
"""Suffix of a socket whose process does not listen yet."""
CONNECT_S = 2.0
"""Seconds until a connection must have been made."""

WORLD_VARIABLE: Final = "KIT_WORLD"
"""Environment variable with the name of the world to connect to if the command names none."""


class WorldNotFound(LookupError):
    """No running world matches; the message lists those there are, or says how to start one."""


@dataclass(frozen=True, slots=True)
class RunningWorld:
    """A running world that other terminals can connect to."""

    path: Path
    started_s: float
    """When it was started [seconds since the epoch]."""

    @property
    def name(self) -> str:
        """Its map or launch file and its process: ``maze-4711``."""
        return self.path.stem


def sockets_folder(workspace: Path) -> Path:
    """This machine's folder of sockets in a workspace."""
    host = re.sub(r"[^A-Za-z0-9.-]", "_", socket.gethostname()) or "here"
    return workspace / ".running" / host


def world_name(name: str) -> str:
    """The name under which others find this process's world called ``name``, if it is the first of that name."""
    return f"{re.sub(r'[^A-Za-z0-9_.]', '_', name)[:24] or 'world'}-{os.getpid()}"


def is_world_name(name: str) -> bool:
    """Whether ``listen`` gives such names: another user may name a socket as they like."""
    return re.fullmatch(r"[A-Za-z0-9_.]{1,24}-[0-9]{1,10}(\.[0-9]{1,3})?", name) is not None


def listen(
    folder: Path, name: str, *, folder_mode: int = 0o700, socket_mode: int = 0o600, group: int | None = None
) -> tuple[socket.socket, Path]:
    """Opens a listening socket for a world called ``name``; returns it and its path. Raises OSError.

    By default only its owner can use it. ``group``: of the folder and the socket, where the modes let a group in.
    """
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    if group is not None:
        os.chown(folder, -1, group)
    folder.chmod(folder_mode)
    running_worlds(folder)  # deletes what a killed world has left
    stem = world_name(name)
    listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    # A socket that is found must answer already: else a search would take it for that of a killed world.
    unready = folder / f".{stem}.{listener.fileno()}{UNREADY_SUFFIX}"
    try:
        with _short_name(unready) as short:
            listener.bind(short)
        unready.chmod(0o600)
        if group is not None:
            os.chown(unready, -1, group)
        unready.chmod(socket_mode)
        listener.listen(16)
        path = _rename_to_free_name(unready, folder, stem)
    except BaseException:  # Ctrl-C too: the socket is closed, then it is raised again
        listener.close()
        raise
    finally:
        unready.unlink(missing_ok=True)
    return listener, path


def _rename_to_free_name(unready: Path, folder: Path, stem: str) -> Path:
    """Gives a listening socket the first name that is free."""
    for number in range(1, 1000):
        path = folder / f"{stem}{'' if number == 1 else f'.{number}'}{SUFFIX}"
        if not path.exists():
            return unready.rename(path)
    raise FileExistsError(f"{folder}: too many worlds with the same name")


def connect(path: Path) -> socket.socket:
    """Connects to the world that listens at ``path``. Raises OSError if none does, or it lets nobody in for ``CONNECT_S``."""
    connection = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        # Linux waits this long, and without it for ever, for a listener that accepts nobody and whose queue is full.
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_SNDTIMEO, _timeval(CONNECT_S))
        with _short_name(path) as name:
            connection.connect(name)
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_SNDTIMEO, _timeval(0.0))
    except BaseException:  # Ctrl-C too: the socket is closed, then it is raised again
        connection.close()
        raise
    return connection


def _timeval(seconds: float) -> bytes:
    """Packs seconds as C's ``struct timeval``."""
    return struct.pack("ll", int(seconds), int(seconds % 1 * 1e6))


def running_worlds(folder: Path) -> list[RunningWorld]:
    """The running worlds, the newest first. Deletes sockets that no process listens at."""
    worlds = []
    for unready in folder.glob(f".*{UNREADY_SUFFIX}"):
        if not _is_alive(int(unready.name.split(".")[-3].rpartition("-")[2])):
            unready.unlink(missing_ok=True)
    for path in folder.glob(f"*{SUFFIX}"):
        try:
            connect(path).close()
        except ConnectionRefusedError:
            with suppress(FileNotFoundError):
                path.unlink()
        except OSError:  # it has gone meanwhile, or is not ours
            continue
        else:
            with suppress(FileNotFoundError):
                worlds.append(RunningWorld(path, path.stat().st_mtime))
    return sorted(worlds, key=lambda world: (-world.started_s, world.name))


def _is_alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:  # somebody else's
        return True
    return True


def find_world(folder: Path, name: str | None = None) -> RunningWorld:
    """The newest world, or the newest one whose name is or begins with ``name``. Raises WorldNotFound."""
    worlds = running_worlds(folder)
    if not worlds:
        raise WorldNotFound(
            "No world is running in this workspace. Start one in another terminal: kit drive maze, "
            "kit launch FOLDER, or kit run maze --serve."
        )
    for world in worlds:
        if name is None or world.name == name or world.name.rpartition("-")[0] == name:
            return world
    raise WorldNotFound(
        f"No running world is named {name}; running: {', '.join(world.name for world in worlds)}."
    )


@contextmanager
def _short_name(path: Path) -> Iterator[str]:
    """A name for the path that is short enough for the system, however deep the folder lies (Linux)."""
    if len(os.fsencode(path)) <= MAX_SOCKET_PATH:
        yield str(path)
        return
    folder = os.open(path.parent, os.O_RDONLY | os.O_DIRECTORY)
    try:
        yield f"/proc/self/fd/{folder}/{path.name}"
    finally:
        os.close(folder)
