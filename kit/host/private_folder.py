"""Makes private temporary folders, and removes those whose process was killed before it could do so itself.

Every folder's name says which process owns it. The first folder that a process makes also removes the folders of
processes of this user that no longer live. So a SIGKILL leaves nothing behind after the next start.
"""

from __future__ import annotations

import os
import re
import socket
import tempfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from kit.host.sandbox.reaper import remove_folder

PREFIX: Final = "kit-private-"
_NAME: Final = re.compile(rf"{PREFIX}(?P<machine>[0-9a-f]{{8}})-(?P<pid>\d+)-(?P<start>\d+)-")
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
    return f"{PREFIX}{_MACHINE}-{pid}-{_start_of_process(pid) or 0}-"


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
        abandoned = [entry.path for entry in entries if is_abandoned(entry)]
        for folder in abandoned:
            remove_folder(folder)


def is_abandoned(entry: os.DirEntry[str]) -> bool:
    """Returns whether this user's process that owned it, by its name, no longer lives."""
    named = _NAME.match(entry.name)
    if named is None or named["machine"] != _MACHINE:
        return False
    try:
        if entry.is_symlink() or entry.stat(follow_symlinks=False).st_uid != os.geteuid():
            return False
    except OSError:  # removed meanwhile
        return False
    return _start_of_process(int(named["pid"])) != int(named["start"])


def _machine_digits() -> str:
    """Returns eight digits that differ where process ids mean something else: on other machines, in other containers."""
    namespace = ""
    with suppress(OSError):
        namespace = os.readlink("/proc/self/ns/pid")
    return f"{zlib.crc32(f'{socket.gethostname()} {namespace}'.encode()):08x}"


# At import, since the process cannot read its own namespace any more once it is shielded.
_MACHINE: Final = _machine_digits()


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
