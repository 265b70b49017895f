"""Describes how a program of a package is run, rather than a file by itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from kit.host.wire import Json


@dataclass(frozen=True, slots=True)
class PackageProgram:
    """What an installation would provide: entry point, imports, working folder, environment."""

    folder: Path
    """The package's folder: messages name files relative to it."""
    cwd: Path
    environment: Mapping[str, str]
    entry: str | None = None
    """``package.module:function``; None: the file itself is run."""
    imports: tuple[Path, ...] = ()
    """Folders from which modules are imported, before the installed libraries."""

    def to_start_fields(self) -> dict[str, Json]:
        """Returns the fields of the ``start`` frame."""
        return {
            "folder": str(self.folder),
            "cwd": str(self.cwd),
            "environment": dict(self.environment),
            "entry": self.entry,
            "imports": [str(path) for path in self.imports],
        }
