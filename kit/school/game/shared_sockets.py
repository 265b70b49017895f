"""Sockets by which other users of the machine find shared games, and who may join.

Each host has a folder of its own in one that all users may write to, and opens it on purpose: to its own user alone, to a
group, or to everybody. Whoever comes in is asked of the system who they are.
"""

from __future__ import annotations

import grp
import os
import pwd
import socket
import stat
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Final

from kit.inspection.sockets import SUFFIX, FramedSocket, connect, is_world_name, listen
from kit.workspace import open_common_folder

DEFAULT_FOLDER: Final = "/var/tmp/robot-learning-kit-games"
FOLDER_VARIABLE: Final = "KIT_GAMES"
MAX_SOCKETS_OF_ONE_USER: Final = 32
"""Sockets of one user that a search looks at."""


class SharedGameError(Exception):
    """A shared game cannot be opened or found; the message says why."""


@dataclass(frozen=True, slots=True)
class Audience:
    """The accounts that may come in besides the host's own: a group's, all, or none."""

    group: int | None = None
    everybody: bool = False

    @classmethod
    def of_group(cls, name: str) -> Audience:
        """Raises SharedGameError for a group that is not there or that this user is not in."""
        try:
            group = grp.getgrnam(name).gr_gid
        except KeyError:
            raise SharedGameError(f"There is no group {name} on this machine.") from None
        if group not in (os.getegid(), *os.getgroups()) and os.geteuid() != 0:
            raise SharedGameError(f"You are not in the group {name}, so the game cannot be opened to it.")
        return cls(group)

    def admits(self, user: int) -> bool:
        """Whether this user may come in."""
        return self.everybody or user in (0, os.getuid()) or (self.group is not None and self._has(user))

    def _has(self, user: int) -> bool:
        try:
            found = pwd.getpwuid(user)
        except KeyError:
            return False
        return self.group in os.getgrouplist(found.pw_name, found.pw_gid)

    @property
    def modes(self) -> tuple[int, int]:
        """Permissions of the folder and of the socket."""
        if self.everybody:
            return 0o755, 0o666
        return (0o750, 0o660) if self.group is not None else (0o700, 0o600)


@dataclass(frozen=True, slots=True)
class FoundGame:
    """A host that can be found."""

    path: Path
    owner: int
    """The user who hosts it."""

    @property
    def name(self) -> str:
        """Its level and its process: ``two_doors-4711``."""
        return self.path.stem

    def connect(self) -> socket.socket:
        """Raises SharedGameError if nobody is there, one may not come in, or somebody else answers."""
        try:
            connection = connect(self.path)
        except OSError as error:
            raise SharedGameError(f"{self.name} cannot be joined: {error.strerror}.") from error
        answering = peer_user(connection)
        if answering not in (None, self.owner):
            connection.close()
            raise SharedGameError(f"{self.name} does not belong to the user who owns its folder.")
        return connection


def games_folder() -> Path:
    """The folder of all hosts: ``$KIT_GAMES``, or one that all users of the machine can write to."""
    return Path(os.environ.get(FOLDER_VARIABLE) or DEFAULT_FOLDER)


def listen_for_guests(folder: Path, name: str, audience: Audience) -> tuple[socket.socket, Path]:
    """Opens a listening socket for a game called ``name``. Raises SharedGameError."""
    try:
        if problem := open_common_folder(folder):
            raise SharedGameError(f"{folder}: {problem}.")
        own = folder / str(os.getuid())
        own.mkdir(mode=0o700, exist_ok=True)
        _check_own(own)
        folder_mode, socket_mode = audience.modes
        return listen(own, name, folder_mode=folder_mode, socket_mode=socket_mode, group=audience.group)
    except OSError as error:
        raise SharedGameError(f"{folder}: the game cannot be opened there ({error.strerror}).") from error


def found_games(folder: Path) -> list[FoundGame]:
    """All hosts that this user can see, by name. A folder or socket of another owner than its name says is left out."""
    return sorted(_find_games(folder), key=lambda game: game.name)


def answering_games(folder: Path) -> list[FoundGame]:
    """The hosts of ``found_games`` that still listen."""
    return [game for game in found_games(folder) if _answers(game)]


def find_game(folder: Path, name: str | None) -> FoundGame:
    """The host whose name is or begins with ``name``; without one, the only one. Raises SharedGameError."""
    games = answering_games(folder)
    if name is not None:
        wanted = name.replace("-", "_")  # as sockets are named
        chosen = [game for game in games if name == game.name or wanted == game.name.rpartition("-")[0]]
    else:
        chosen = games
    if len(chosen) == 1:
        return chosen[0]
    if not games:
        raise SharedGameError(
            "Nobody is hosting a game on this machine. `kit game host first-drive` opens one."
        )
    names = ", ".join(f"{game.name} ({user_name(game.owner)})" for game in games)
    raise SharedGameError(f"Say which game: {names}.")


def user_name(user: int) -> str:
    """The login name of a user, or its number."""
    with suppress(KeyError):
        return pwd.getpwuid(user).pw_name
    return f"user {user}"


def own_user_name() -> str:
    """This user's login name, or its number."""
    return user_name(os.getuid())


def peer_user(connection: socket.socket) -> int | None:
    """The user id of the other process; None where the system does not tell."""
    return FramedSocket(connection).peer_user


def _find_games(folder: Path) -> Iterator[FoundGame]:
    with suppress(OSError):
        for own in sorted(folder.iterdir()):
            with suppress(OSError):
                status = own.lstat()
                if not stat.S_ISDIR(status.st_mode) or own.name != str(status.st_uid):
                    continue
                # What another user has put there may be anything: names with control characters, thousands of sockets.
                for path in islice(own.glob(f"*{SUFFIX}"), MAX_SOCKETS_OF_ONE_USER):
                    found = path.lstat()
                    if (
                        is_world_name(path.stem)
                        and stat.S_ISSOCK(found.st_mode)
                        and found.st_uid == status.st_uid
                    ):
                        yield FoundGame(path, found.st_uid)


def _answers(game: FoundGame) -> bool:
    """Whether a process listens; a socket that one may not use counts as one."""
    try:
        connect(game.path).close()
    except PermissionError:
        return True
    except OSError:
        return False
    return True


def _check_own(own: Path) -> None:
    status = own.lstat()
    if not stat.S_ISDIR(status.st_mode) or status.st_uid != os.getuid():
        raise SharedGameError(f"{own}: belongs to another user; an administrator can remove it.")
