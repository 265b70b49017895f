"""Detects that a student's file was saved, so that it can be restarted.

Files are polled: notification does not reach across network file systems, where home folders often are. Editors save
in two ways, both of which take a moment in which the file is not whole: they write a new file and rename it, or they
empty the old one and fill it. So a file counts as saved when it has looked the same for a while.

To replace the running version: start a second ``NodeProcess`` on the file, poll its ``is_started``, and only when that
is true, ``close`` the old one and ``join`` the new one.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Final, NamedTuple

SETTLED_S: Final = 0.15
"""How long a file must look the same [s]."""
EMPTY_S: Final = 1.0
"""How long an empty file must look the same [s]: most are about to be filled."""
MAX_FILES: Final = 200
"""Files of a folder that are watched."""
POLL_S: Final = 0.05
"""How often the file is checked [s]: more frequent calls cost nothing."""


class _FileState(NamedTuple):
    """Distinguishes the states of a file without reading it."""

    modified_ns: int
    size: int
    inode: int


class FileWatcher:
    """Detects that a file, or any file of a folder, has been saved. ``clock`` returns seconds."""

    def __init__(self, file: Path, *, clock: Callable[[], float] = time.monotonic) -> None:
        self._file = file
        self._clock = clock
        self._reported = self._read_state()
        self._last = self._reported
        self._changed_at = self._polled_at = clock()

    def has_changed(self) -> bool:
        """Returns whether a new version was saved since the last time this was true. Call it often."""
        now = self._clock()
        if now - self._polled_at < POLL_S:
            return False
        self._polled_at = now
        state = self._read_state()
        if state != self._last:
            self._last, self._changed_at = state, now
            return False
        if state is None or state == self._reported:
            return False
        if now - self._changed_at < (SETTLED_S if state.size else EMPTY_S):
            return False
        self._reported = state
        return True

    def take_as_known(self) -> None:
        """What stands there now was written by whoever watches: it is no change."""
        self._reported = self._last = self._read_state()

    def _read_state(self) -> _FileState | None:
        try:
            if self._file.is_dir():
                return _folder_state(self._file)
            found = self._file.stat()
        except OSError:
            return None
        return _FileState(found.st_mtime_ns, found.st_size, found.st_ino)


def _folder_state(folder: Path) -> _FileState:
    """Returns the state of a folder as if it were one file; hidden files, such as an editor's own, do not count."""
    states: list[_FileState] = []
    names_seen: list[str] = []
    for place, folders, names in os.walk(folder):
        folders[:] = sorted(each for each in folders if not each.startswith((".", "__")))[:MAX_FILES]
        for name in sorted(names)[: MAX_FILES - len(states)]:
            if not name.startswith("."):
                found = Path(place, name).stat()
                names_seen.append(name)
                states.append(_FileState(found.st_mtime_ns, found.st_size, found.st_ino))
    return _FileState(
        max((state.modified_ns for state in states), default=0),
        sum(state.size for state in states),
        hash((*names_seen, *states)),
    )
