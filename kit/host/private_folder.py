"""Makes private temporary folders, and removes those whose process was killed before it could do so itself.

Every folder's name says which process owns it, to those alone who know this start of the machine: a confined program, which
sees the path, learns no process from it. The first folder that a process makes also removes the folders of processes of this
user that no longer live. So a SIGKILL leaves nothing behind after the next start.
"""

from __future__ import annotations

import hashlib
import os
import re
import socket
import tempfile
import zlib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from kit.host.sandbox.reaper import remove_folder

PREFIX: Final = "kit-private-"
_NAME: Final = re.compile(rf"{PREFIX}(?P<machine>[0-9a-f]{{8}})-(?P<owner>[0-9a-f]{{16}}|p\d+)-")
_swept_folders: Final[set[str]] = set()
"""Folders for temporary files that this process has looked through."""


def make_private_folder() -> str:
    """Makes a folder that only this user may enter (mode 0700), and returns its path. Its maker removes it."""
    # The program that is granted it has another current folder.
    parent = os.path.abspath(tempfile.gettempdir())
    if parent not in _swept_folders:
        _swept_folders.add(parent)
        remove_abandoned_folders(parent)
    return tempfile.mkdtemp(prefix=owned_name(), dir=parent)


def owned_name() -> str:
    """Returns how a name begins that says that this process owns what bears it; see ``is_abandoned``."""
    pid = os.getpid()
    return f"{PREFIX}{_MACHINE}-{_owner_word(pid, _start_of_process(pid) or 0)}-"


@contextmanager
def private_folder() -> Iterator[Path]:
    """Makes a folder as ``make_private_folder`` does, and removes it at the end of the context."""
    folder = make_private_folder()
    try:
        yield Path(folder)
    finally:
        remove_folder(folder)


def remove_abandoned_folders(parent: str) -> None:
    """Removes the private folders in ``parent`` that belong to this user and whose process no longer lives."""
    with suppress(OSError), os.scandir(parent) as entries:
        for folder in abandoned(entries):
            remove_folder(folder)


def abandoned(entries: Iterable[os.DirEntry[str]]) -> list[str]:
    """Returns the paths of the entries that a process of this user owned, by their names, that no longer lives."""
    found = [(entry, named) for entry in entries if (named := _NAME.match(entry.name)) is not None]
    owned = [(entry.path, named["owner"]) for entry, named in found if _is_own(entry, named["machine"])]
    living = _living_owners() if owned else frozenset()
    return [path for path, owner in owned if not (_is_alive(owner) if owner[0] == "p" else owner in living)]


def _is_own(entry: os.DirEntry[str], machine: str) -> bool:
    try:
        is_link, user = entry.is_symlink(), entry.stat(follow_symlinks=False).st_uid
    except OSError:  # removed meanwhile
        return False
    return machine == _MACHINE and not is_link and user == os.geteuid()


def _is_alive(owner: str) -> bool:
    """Whether the process of an owner's word that is its number lives: where there is no /proc."""
    return _start_of_process(int(owner[1:])) is not None


def _living_owners() -> frozenset[str]:
    """The owners' words of all processes."""
    pids = map(int, filter(str.isdecimal, os.listdir("/proc") if os.path.isdir("/proc/self") else ()))
    starts = ((pid, _start_of_process(pid)) for pid in pids)
    return frozenset(_owner_word(pid, start) for pid, start in starts if start is not None)


def _owner_word(pid: int, start: int) -> str:
    """What stands for a process in a name: its number and start, hashed with what no confined program can read."""
    if not start:
        return f"p{pid}"
    return hashlib.blake2s(f"{pid} {start}".encode(), key=_BOOT, digest_size=8).hexdigest()


def _machine_digits() -> str:
    """Returns eight digits that differ where process ids mean something else: on other machines, in other containers."""
    namespace = ""
    with suppress(OSError):
        namespace = os.readlink("/proc/self/ns/pid")
    return f"{zlib.crc32(f'{socket.gethostname()} {namespace}'.encode()):08x}"


def _boot_identity() -> bytes:
    """Returns what Linux drew at random when it was started; nothing elsewhere."""
    try:
        with open("/proc/sys/kernel/random/boot_id", "rb") as file:
            return file.read(32)
    except OSError:
        return b""


# At import, since the process cannot read its own namespace any more once it is shielded.
_MACHINE: Final = _machine_digits()
_BOOT: Final = _boot_identity()


def _start_of_process(pid: int) -> int | None:
    """Returns when a living process was started [clock ticks]; 0 where the system does not tell, None if it does not live."""
    if not os.path.exists("/proc/self/stat"):
        try:
            os.kill(pid, 0)
        except ProcessLookupError:
            return None
        except OSError:  # it lives, and belongs to somebody else
            return 0
        return 0
    try:
        with open(f"/proc/{pid}/stat", "rb") as file:
            # "pid (name) state ...": the name may hold spaces and brackets; the start is the 22nd field.
            fields = file.read().rpartition(b")")[2].split()
    except OSError:
        return None
    return None if fields[0] in (b"Z", b"X") else int(fields[19])
