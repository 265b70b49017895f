"""The version of the grader: a digest of all code and maps that decide a grade."""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Iterator, Sequence
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
        content = Path(file).read_bytes()
        digest.update(repr((name, len(content))).encode())
        digest.update(content)
    return f"{_package_version()}+{digest.hexdigest()[:12]}"


def _source_files() -> Iterator[tuple[str, str]]:
    """Yields name and path of each file, sorted by name. With ``os``: a thousand paths of pathlib's take a tenth of a check."""
    for package, parts in ((grader, ()), (kit, UNUSED_PARTS)):
        for name, file in _files_below(package.__path__[0], parts):
            if name.endswith(".py"):
                yield f"{package.__name__}/{name}", file
    for name, file in _files_below(str(maps_folder()), ()):
        yield f"maps/{name}", file


def _files_below(folder: str, without: Sequence[str]) -> list[tuple[str, str]]:
    """Returns all files of a folder by their names in it, but for those of some of its own folders."""
    found = []
    for place, folders, names in os.walk(folder):
        inside = place[len(folder) :].replace(os.sep, "/").strip("/")
        folders[:] = [each for each in folders if each != "__pycache__" and (inside or each not in without)]
        found += [(f"{inside}/{name}" if inside else name, f"{place}/{name}") for name in names]
    return sorted(found)


def _package_version() -> str:
    """Returns the installed version, by the name of the folder that an installation writes: ``importlib.metadata`` would
    import a parser of e-mails for it."""
    for entry in filter(None, sys.path):
        for found in sorted(Path(entry).glob(f"{DISTRIBUTION}-*.dist-info")):
            return found.name.removeprefix(f"{DISTRIBUTION}-").removesuffix(".dist-info")
    return "unknown"
