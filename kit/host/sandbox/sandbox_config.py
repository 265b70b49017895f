"""What one process's confinement is: its level, what it may read and write, its limits."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

from kit.host.sandbox import namespaces
from kit.host.sandbox.limits import Limits
from kit.host.wire import Json


class Level(IntEnum):
    """Confinement level of a student's process. Each includes those below."""

    LIMITED = 0
    FILTERED = 1
    SEPARATE = 2
    ANOTHER_USER = 3


INTERACTIVE_LEVEL = Level.LIMITED

WRITABLE = ("/dev/null",)
"""Files that every program may write to, besides its own folder."""


@dataclass(frozen=True, slots=True)
class SandboxConfig:
    """The settings of one process's confinement, sent by the parent."""

    level: Level
    limits: Limits
    folder: str
    """The run's folder, removed at the end, with two empty folders in it: ``scratch`` and ``root``."""
    readable: Sequence[str]
    """Absolute paths of files and folders that it may read, with everything below them. From level 1 on."""
    listed: Sequence[str]
    """Absolute paths of folders that it may list. From level 1 on."""
    hidden: Sequence[str]
    """Absolute paths without links in ``listed`` folders, of which the program may see nothing."""
    in_bubblewrap: bool = False
    """Whether bubblewrap has made the namespaces and the file tree already. At level 2."""
    groups: Sequence[str] = ()
    """Files of control groups: who writes 0 to them joins."""

    @property
    def scratch(self) -> str:
        """The one folder that it may write in, and its working folder."""
        return f"{self.folder}/scratch"

    @property
    def root(self) -> str:
        """Where the restricted file tree is built, out of the child's reach."""
        return f"{self.folder}/root"

    @classmethod
    def from_json(cls, content: Json) -> SandboxConfig:
        """Reads what ``dataclasses.asdict`` and JSON have made of a configuration."""
        limits = Limits(**content["limits"])
        return cls(
            Level(content["level"]),
            limits,
            content["folder"],
            content["readable"],
            content["listed"],
            content["hidden"],
            content["in_bubblewrap"],
            content["groups"],
        )

    @property
    def makes_namespaces(self) -> bool:
        """Whether this process has to make namespaces itself."""
        return self.level >= Level.SEPARATE and not self.in_bubblewrap

    @property
    def file_tree(self) -> namespaces.FileTree:
        """All files of a program that has a file tree of its own. Listed folders are shown without what is hidden."""
        shown = [path for path in self.listed if os.path.realpath(path) not in self.hidden]
        return namespaces.FileTree((*shown, *self.readable), WRITABLE, self.hidden)


class ConfinementError(Exception):
    """This machine does not have the requested level; the message says why, and what would help."""
