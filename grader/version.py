"""Which grader this is: what decides a result besides the submission and the assignment.

The package's version alone would not do: a checkout that is brought up to date keeps it, and results of before would be
taken for those of now.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Final

import grader
import kit
from kit.world.catalogue import maps_folder

NOT_JUDGING: Final = ("cli", "tui", "school", "study", "data")
"""Parts of the kit that no grading runs through; ``data`` holds an installation's maps, which are looked at as maps."""


@cache
def grader_version() -> str:
    """The version, and a digest of the code and the maps that grading depends on."""
    made = hashlib.sha256()
    for name, file in _sources():
        content = file.read_bytes()
        made.update(repr((name, len(content))).encode())
        made.update(content)
    return f"{_version()}+{made.hexdigest()[:12]}"


def _sources() -> Iterator[tuple[str, Path]]:
    for package in (grader, kit):
        folder = Path(package.__path__[0])
        for file in sorted(folder.rglob("*.py")):
            name = file.relative_to(folder)
            if package is grader or name.parts[0] not in NOT_JUDGING:
                yield f"{package.__name__}/{name.as_posix()}", file
    for file in sorted(path for path in maps_folder().rglob("*") if path.is_file()):
        yield f"maps/{file.relative_to(maps_folder()).as_posix()}", file


def _version() -> str:
    try:
        return version("robot-learning-kit")
    except PackageNotFoundError:
        return "unknown"
