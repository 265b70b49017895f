"""The version of the grader: a digest of all code and maps that decide a grade."""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Final

import grader
import kit
from kit.world.catalogue import maps_folder

DISTRIBUTION: Final = "robot_learning_kit"
UNUSED_PARTS: Final = ("cli", "tui", "help", "school", "study", "data")
"""Parts of the kit that no grading runs through; an installation's maps in ``data`` count as maps."""


@cache
def grader_version() -> str:
    """Returns the package version with a digest of the code and maps that grading depends on.

    The version alone is not enough: an updated checkout keeps it, and older results would pass for current ones.
    """
    digest = hashlib.sha256()
    for name, file in _source_files():
        content = file.read_bytes()
        digest.update(repr((name, len(content))).encode())
        digest.update(content)
    return f"{_package_version()}+{digest.hexdigest()[:12]}"


def _source_files() -> Iterator[tuple[str, Path]]:
    for package in (grader, kit):
        folder = Path(package.__path__[0])
        for file in sorted(folder.rglob("*.py")):
            name = file.relative_to(folder)
            if package is grader or name.parts[0] not in UNUSED_PARTS:
                yield f"{package.__name__}/{name.as_posix()}", file
    for file in sorted(path for path in maps_folder().rglob("*") if path.is_file()):
        yield f"maps/{file.relative_to(maps_folder()).as_posix()}", file


def _package_version() -> str:
    """Returns the installed version, by the name of the folder that an installation writes: ``importlib.metadata`` would
    import a parser of e-mails for it."""
    for entry in filter(None, sys.path):
        for found in sorted(Path(entry).glob(f"{DISTRIBUTION}-*.dist-info")):
            return found.name.removeprefix(f"{DISTRIBUTION}-").removesuffix(".dist-info")
    return "unknown"
