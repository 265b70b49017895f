"""Parts that other installed packages bring, found by their entry points and loaded one by one, when they are first named.

A package names its parts in groups, ``robot_learning_kit.devices`` and so on; ``GROUPS`` says what each holds. Looking for them
imports nothing. A part that is broken, that does not return from its import, or whose name is taken is left out, and ``kit doctor``
says why. A grader loads parts of those packages alone that the teacher's sheet names: see
``admitting``.
"""

from __future__ import annotations

import os
import re
import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from types import MappingProxyType
from typing import Final

PREFIX: Final = "robot_learning_kit."
OBJECTS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "devices": "a PluginType or WorldPluginType, under its type's name",
        "checks": "a grader's Check, under KIND.CHECK",
        "kinds": "a grader's SubmissionKind, under the kind's name",
        "dialogues": "a function of a Workspace that makes a Dialogue, under the verb that opens it",
        "verbs": "a click command, under its name",
    }
)
"""Groups whose entries are objects, ``module:attribute``."""
FOLDERS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "maps": "a folder of maps, each as in the kit's maps/",
        "lessons": "a folder of lessons, each as in the kit's lessons/",
        "tasks": "a folder of task files, NAME.yaml",
        "controllers": "a folder of node files, NAME.py",
    }
)
"""Groups whose entries are folders, ``package.folder``; they are read and never imported."""
GROUPS: Final[Mapping[str, str]] = MappingProxyType({**OBJECTS, **FOLDERS})
"""Every group, and what its entries are."""

PACKAGES_VARIABLE: Final = "KIT_PACKAGES"
"""Environment variable with the names of the packages whose parts may be loaded, separated by commas; all where it is not
set. Processes that a grader starts inherit it."""
IMPORT_LIMIT_S: Final = 10.0
"""Seconds that the import of a part may take."""


@dataclass(frozen=True, slots=True)
class Extension:
    """One part of another package."""

    group: str
    name: str
    value: str
    """``module:attribute``, or of a folder ``package.folder``."""
    package: str
    version: str

    @property
    def source(self) -> str:
        """The package and its version."""
        return f"{self.package} {self.version}"


class ExtensionError(Exception):
    """A part cannot be used; the message says why and which package to mend or remove."""


def _normalize_package_name(package: str) -> str:
    return re.sub(r"[-_.]+", "-", package).lower()


@cache
def installed_extensions() -> tuple[Extension, ...]:
    """All parts of all installed packages, by group and name. Imports none of them."""
    from importlib.metadata import distributions  # takes longer than a light command may wait for

    found = {
        Extension(
            entry.group.removeprefix(PREFIX), entry.name, entry.value, each.metadata["Name"], each.version
        )
        for each in distributions()
        for entry in each.entry_points
        if entry.group.removeprefix(PREFIX) in GROUPS and entry.group.startswith(PREFIX)
    }
    return tuple(sorted(found, key=lambda each: (each.group, each.name, each.package)))


def admitted_packages() -> frozenset[str] | None:
    """Names of the packages whose parts may be loaded in this process; None: those of all."""
    names = os.environ.get(PACKAGES_VARIABLE)
    return None if names is None else frozenset(map(_normalize_package_name, filter(None, names.split(","))))


@contextmanager
def admitting(packages: Sequence[str]) -> Iterator[None]:
    """Loads parts of these packages alone in the block, here and in processes that it starts."""
    before = os.environ.get(PACKAGES_VARIABLE)
    os.environ[PACKAGES_VARIABLE] = ",".join(packages)
    try:
        yield
    finally:
        if before is None:
            del os.environ[PACKAGES_VARIABLE]
        else:
            os.environ[PACKAGES_VARIABLE] = before


def extensions(group: str, taken: Sequence[str] = ()) -> Mapping[str, Extension]:
    """The parts of a group that may be used, by name. ``taken``: the kit's own names, which none may have."""
    admitted = admitted_packages()
    if admitted is not None and not admitted:
        return MappingProxyType({})
    found = [
        each
        for each in installed_extensions()
        if each.group == group and (admitted is None or _normalize_package_name(each.package) in admitted)
    ]
    names = [each.name for each in found]
    return MappingProxyType(
        {each.name: each for each in found if names.count(each.name) == 1 and each.name not in taken}
    )


def name_conflicts(group: str, taken: Sequence[str] = ()) -> Iterator[tuple[Extension, str]]:
    """Yields each part that is left out for its name, and why."""
    found = [each for each in installed_extensions() if each.group == group]
    for each in found:
        others = sorted({other.package for other in found if other.name == each.name and other != each})
        if each.name in taken:
            yield each, "the kit has one of this name"
        elif others:
            yield each, f"{' and '.join(others)} brings one of this name too"


def load(extension: Extension) -> object:
    """The object of a part; its module is imported now. Raises ExtensionError.

    The import runs in a thread of its own, which is left alone if it does not return in time.
    """
    loaded: list[object] = []
    failed: list[BaseException] = []

    def run() -> None:
        module, _, attribute = extension.value.partition(":")
        try:
            found: object = import_module(module.strip())
            for name in filter(None, attribute.strip().split(".")):
                found = getattr(found, name)
            loaded.append(found)
        except BaseException as error:  # noqa: BLE001 - whatever somebody else's module raises
            failed.append(error)

    thread = threading.Thread(target=run, name=f"import {extension.value}", daemon=True)
    thread.start()
    thread.join(IMPORT_LIMIT_S)
    if loaded:
        return loaded[0]
    what = f"{extension.group.removesuffix('s')} {extension.name} of {extension.source}"
    if not failed:
        raise ExtensionError(f"The {what} cannot be used: its import takes more than {IMPORT_LIMIT_S:g} s.")
    error = failed[0]
    raise ExtensionError(f"The {what} cannot be used: {type(error).__name__}: {error}")


def folder_of(extension: Extension) -> Path:
    """The folder of a part, found without importing its package. Raises ExtensionError if it is not there."""
    top, *rest = extension.value.split(".")
    try:
        spec = find_spec(top)
    except (ImportError, ValueError):
        spec = None
    for place in (spec.submodule_search_locations or ()) if spec is not None else ():
        folder = Path(place, *rest)
        if folder.is_dir():
            return folder
    raise ExtensionError(
        f"The {extension.group} of {extension.source} cannot be used: there is no folder {extension.value}."
    )


def folders(group: str) -> Iterator[tuple[Extension, Path]]:
    """Yields the parts of a group of folders that are there, each with its folder."""
    for each in extensions(group).values():
        try:
            yield each, folder_of(each)
        except ExtensionError:
            continue


def checked(extension: Extension) -> str:
    """Tries a part as its use would: an empty text if it works, else why not."""
    try:
        if extension.group in FOLDERS:
            folder_of(extension)
        else:
            load(extension)
    except ExtensionError as error:
        return str(error)
    return ""
