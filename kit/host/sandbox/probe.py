"""Finds out, by trying, which confinement levels this machine has."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Final

from kit.host.failure import FailureKind, StudentCodeError
from kit.host.private_folder import private_folder
from kit.host.sandbox import bubblewrap, landlock
from kit.host.sandbox.control_groups import can_make_groups
from kit.host.sandbox.sandbox_config import Level
from kit.host.student_functions import StudentFunctions

TRIAL_S: Final = 20.0
"""How long a trial may take [s]."""
_KIT: Final = str(Path(__file__).parents[3])


@dataclass(frozen=True, slots=True)
class SandboxSupport:
    """Whether this machine has one confinement level."""

    level: Level
    is_available: bool
    reason: str
    """What the level consists of here; or why it is missing, and what would help."""


def probe_levels() -> tuple[SandboxSupport, ...]:
    """Tries every level, lowest first, with an empty program: a fifth of a second in all."""
    with private_folder() as folder:
        file = Path(folder, "empty.py")
        file.write_text("")
        return tuple(_try_level(level, file) for level in Level)


def is_level_available(level: Level) -> bool:
    """Returns whether this machine has this level; only this one is tried."""
    with private_folder() as folder:
        file = Path(folder, "empty.py")
        file.write_text("")
        return _try_level(level, file).is_available


def highest_level_up_to(wanted: Level) -> Level:
    """Returns the highest level that this machine has and that is not above ``wanted``.

    Called before a student's code runs, so that nothing that this code sends can change the level. A level that was
    reached once in this process is not tried again.
    """
    for level in sorted(Level, reverse=True):
        if level <= wanted and (
            level is Level.LIMITED or level in _known_levels or is_level_available(level)
        ):
            _known_levels.add(level)
            return level
    raise AssertionError("every machine has the lowest level")


_known_levels: Final[set[Level]] = set()


def _try_level(level: Level, file: Path) -> SandboxSupport:
    try:
        StudentFunctions(file, level=level).close()
    except StudentCodeError as problem:
        if problem.failure.kind is not FailureKind.CONFINEMENT:
            raise
        return SandboxSupport(level, False, problem.failure.message)
    return SandboxSupport(level, True, _DESCRIPTIONS[level]())


@cache
def can_mount_scratch() -> bool:
    """Returns whether ``mount_scratch`` works on this machine. Tried once, by a process of its own."""
    with private_folder() as folder:
        call = f"mount_scratch({str(folder)!r}, 1 << 20, 10)"
        trial = f"import sys; sys.path.insert(0, {_KIT!r}); import kit.host.sandbox.namespaces as n; sys.exit(not n.{call})"
        try:
            done = subprocess.run(
                [sys.executable, "-S", "-P", "-c", trial], capture_output=True, timeout=TRIAL_S, check=False
            )
        except (OSError, subprocess.TimeoutExpired):
            return False
        return done.returncode == 0


def _describe_limits() -> str:
    return "its own process and limits" + (", but not of memory (macOS)" if sys.platform == "darwin" else "")


def _describe_filters() -> str:
    disk = "limited" if can_mount_scratch() else "measured ten times a second"
    pages = "limited" if can_make_groups() else "limited by addresses alone, for want of control groups"
    return f"Landlock (version {landlock.abi()}) and a filter of system calls; its disk is {disk}, its memory {pages}"


def _describe_namespaces() -> str:
    by = " by bubblewrap" if bubblewrap.is_needed() else ""
    return f"namespaces{by}: no other process, no network and no other file exists for it"


_DESCRIPTIONS: Final[Mapping[Level, Callable[[], str]]] = MappingProxyType(
    {
        Level.LIMITED: _describe_limits,
        Level.FILTERED: _describe_filters,
        Level.SEPARATE: _describe_namespaces,
        Level.ANOTHER_USER: lambda: "a user of its own for every run",
    }
)
