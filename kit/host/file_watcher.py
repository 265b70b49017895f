"""Noticing that a student's file was saved, so that it can be run anew.

Files are looked at, not listened to: notification does not reach across network file systems, where home
folders lie. Editors save in two ways, both of which take a moment in which the file is not whole: they write a
new file and rename it, or they empty the old one and fill it. So a file counts as saved when it has looked the
same for a while.

Who exchanges the running version for the new one: start a second ``NodeProcess`` on the file, ask ``is_started`` now
and then, and only when it says yes, ``close`` the old one and ``join`` the new.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Final, NamedTuple

SETTLED_S: Final = 0.15
"""How long a file must look the same."""
EMPTY_S: Final = 1.0
"""How long an empty file must: most are about to be filled."""
MOST_FILES: Final = 200
"""Of a folder."""
LOOK_S: Final = 0.05
"""How often to look: asking more often costs nothing."""


class _Look(NamedTuple):
    """What tells one state of a file from another without reading it."""

    modified_ns: int
    size: int
    inode: int


class FileWatcher:
    """Notices when a file has been saved, or any file of a folder. ``clock`` gives seconds."""

    def __init__(self, file: Path, *, clock: Callable[[], float] = time.monotonic) -> None:
        self._file = file
        self._clock = clock
        self._known = self._look()
        self._seen = self._known
        self._since = self._looked = clock()

    def has_changed(self) -> bool:
        """Whether there is a saved version that was not there the last time this was true. Call it often."""
        now = self._clock()
        if now - self._looked < LOOK_S:
            return False
        self._looked = now
        look = self._look()
        if look != self._seen:
            self._seen, self._since = look, now
            return False
        if look is None or look == self._known:
            return False
        if now - self._since < (SETTLED_S if look.size else EMPTY_S):
            return False
        self._known = look
        return True

    def _look(self) -> _Look | None:
        try:
            if self._file.is_dir():
                return _together(self._file)
            found = self._file.stat()
        except OSError:
            return None
        return _Look(found.st_mtime_ns, found.st_size, found.st_ino)


def _together(folder: Path) -> _Look:
    """A folder as if it were one file: what is hidden, such as an editor's own files, does not count."""
    looks: list[_Look] = []
    names_seen: list[str] = []
    for place, folders, names in os.walk(folder):
        folders[:] = sorted(each for each in folders if not each.startswith((".", "__")))[:MOST_FILES]
        for name in sorted(names)[: MOST_FILES - len(looks)]:
            if not name.startswith("."):
                found = Path(place, name).stat()
                names_seen.append(name)
                looks.append(_Look(found.st_mtime_ns, found.st_size, found.st_ino))
    return _Look(
        max((look.modified_ns for look in looks), default=0),
        sum(look.size for look in looks),
        hash((*names_seen, *looks)),
    )
