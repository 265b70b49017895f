"""Counts a run's memory in pages, and its processes and threads, with control groups, where this user may make some.

Limits of the address space count neither pages that the kernel keeps for a program nor the threads of root. A control group
counts both. Making one needs root, or a part of the hierarchy that was delegated to this user; where neither is given, there
are no groups, and ``kit doctor`` says so. Man page: cgroups(7); both versions of the hierarchy are known.

A group serves one run after the other. A killed kit leaves its groups behind, empty; the first that it makes at its next start
removes them.
"""

from __future__ import annotations

import atexit
import os
import signal
import time
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import count
from typing import Final

from kit.host.private_folder import abandoned, owned_name
from kit.host.sandbox.limits import MIB, Limits

MEMBERS: Final = "cgroup.procs"
"""The file that names the processes of a group; what writes 0 to it joins."""
KERNEL_MEMORY: Final = 64 * MIB
"""Bytes granted besides a program's own limits: page tables, pipes, and what Python's supervisor shares with it."""
OWN_PROCESSES: Final = 4
"""Processes and threads granted besides: the program's first, and the first of its process tree."""
EMPTY_S: Final = 2.0
"""How long the last process of a group may take to be gone [s]."""
MAX_FREE: Final = 8
"""Groups that wait for another run: the programs of a launch file run at the same time."""
_numbers: Final = count()


@dataclass(frozen=True, slots=True)
class _Hierarchy:
    """A folder in which groups can be made."""

    folder: str
    counts: frozenset[str]
    """``memory``, ``pids`` or both."""
    is_unified: bool
    """Version 2."""


@dataclass(slots=True)
class ControlGroup:
    """The groups of one run: one folder where the hierarchy is unified, else one for each thing that is counted."""

    folders: dict[str, _Hierarchy]
    """The folder of each group, and where it lies."""
    limits: tuple[int, int]
    """Bytes of memory, processes and threads."""
    _kills_before: int = field(default=0)

    @property
    def member_files(self) -> tuple[str, ...]:
        """What a process writes 0 to that joins."""
        return tuple(f"{folder}/{MEMBERS}" for folder in self.folders)

    def begin(self) -> None:
        """Notes how often the kernel has ended something here, before a run."""
        self._kills_before = self._count_kills()

    def has_run_out_of_memory(self) -> bool:
        """Returns whether the kernel has ended something here since ``begin`` because the memory was used up."""
        return self._count_kills() > self._kills_before

    def _count_kills(self) -> int:
        for folder, hierarchy in self.folders.items():
            if "memory" in hierarchy.counts:
                file = "memory.events" if hierarchy.is_unified else "memory.oom_control"
                for line in _read_group_file(f"{folder}/{file}").splitlines():
                    name, _, number = line.partition(" ")
                    if name == "oom_kill":
                        return int(number)
        return 0

    def empty(self) -> bool:
        """Ends every process that is left; returns whether none is."""
        ends = time.monotonic() + EMPTY_S
        while members := [line for each in self.member_files for line in _read_group_file(each).split()]:
            for process in map(int, members):
                with suppress(OSError):
                    os.kill(process, signal.SIGKILL)
            if time.monotonic() > ends:
                return False
            time.sleep(0.001)
        return True

    def remove(self) -> None:
        """Removes the groups; what is not empty stays for the next start."""
        for folder in self.folders:
            with suppress(OSError):
                os.rmdir(folder)


class _Groups:
    """The groups of this process that no run uses."""

    def __init__(self) -> None:
        self.owner = os.getpid()
        self.free: list[ControlGroup] = []
        self.hierarchies: tuple[_Hierarchy, ...] | None = None
        """Where groups can be made; None until that was looked for."""


_groups = _Groups()


def _own_groups() -> _Groups:
    global _groups
    if _groups.owner != os.getpid():  # a copy of a process leaves those of the original alone
        _groups = _Groups()
    return _groups


def can_make_groups() -> bool:
    """Returns whether this user may make groups for both memory and processes. Makes one to find out."""
    group = take_group(Limits(processes=1))
    if group is None:
        return False
    return_group(group)
    return True


def take_group(limits: Limits) -> ControlGroup | None:
    """Returns an empty group with these limits; None where none can be made. ``return_group`` gives it back."""
    groups = _own_groups()
    wanted = (limits.memory + limits.scratch + KERNEL_MEMORY, (limits.processes or 0) + OWN_PROCESSES)
    if limits.processes is None:
        return None
    for group in tuple(groups.free):
        if group.limits == wanted:
            with suppress(ValueError):  # another thread has taken it
                groups.free.remove(group)
                group.begin()
                return group
    if groups.hierarchies is None:
        groups.hierarchies = _find_hierarchies()
        atexit.register(remove_free_groups)
        for each in groups.hierarchies:
            _remove_abandoned(each.folder)
    if not groups.hierarchies:
        return None
    made = _make_group(groups.hierarchies, wanted)
    if made is None:
        groups.hierarchies = ()  # it will not be possible a second time
    else:
        made.begin()
    return made


def return_group(group: ControlGroup) -> None:
    """Gives a group back after a run, for the next one with the same limits."""
    groups = _own_groups()
    if group.empty() and len(groups.free) < MAX_FREE:
        groups.free.append(group)
    else:
        group.remove()


def remove_free_groups() -> None:
    """Removes the groups that wait for another run."""
    groups = _own_groups()
    while groups.free:
        groups.free.pop().remove()


def _make_group(hierarchies: tuple[_Hierarchy, ...], wanted: tuple[int, int]) -> ControlGroup | None:
    group = ControlGroup({}, wanted)
    memory, processes = map(str, wanted)
    try:
        for each in hierarchies:
            folder = f"{each.folder}/{owned_name()}{next(_numbers)}"
            os.mkdir(folder)
            group.folders[folder] = each
            if "memory" in each.counts and each.is_unified:
                _write_group_file(f"{folder}/memory.max", memory)
                for name, value in (("memory.swap.max", "0"), ("memory.oom.group", "1")):
                    with suppress(OSError):  # without swap, or an older kernel
                        _write_group_file(f"{folder}/{name}", value)
            elif "memory" in each.counts:
                _write_group_file(f"{folder}/memory.limit_in_bytes", memory)
                with suppress(OSError):  # without swap
                    _write_group_file(f"{folder}/memory.memsw.limit_in_bytes", memory)
            if "pids" in each.counts:
                _write_group_file(f"{folder}/pids.max", processes)
    except OSError:
        group.remove()
        return None
    return group


def _find_hierarchies() -> tuple[_Hierarchy, ...]:
    """Returns where this process may make groups for memory and for processes; nothing unless for both."""
    found: dict[str, _Hierarchy] = {}
    for name, folder in _own_folders():
        if name:
            if name in ("memory", "pids") and os.access(folder, os.W_OK):
                found[name] = _Hierarchy(folder, frozenset({name}), is_unified=False)
            continue
        # A group that has processes hands nothing down to groups below it, but the one above it may.
        for place in (folder, os.path.dirname(folder)):
            handed_down = set(_read_group_file(f"{place}/cgroup.subtree_control").split())
            if handed_down >= {"memory", "pids"} and os.access(place, os.W_OK):
                return (_Hierarchy(place, frozenset({"memory", "pids"}), is_unified=True),)
    return tuple(found.values()) if len(found) == 2 else ()


def _own_folders() -> list[tuple[str, str]]:
    """Returns the folder of this process's group in each hierarchy, with what it counts; the unified one by an empty name."""
    mounts: dict[str, tuple[str, str]] = {}
    for line in _read_group_file("/proc/self/mountinfo").splitlines():
        before, _, after = line.partition(" - ")
        root, point = before.split()[3:5]
        kind, _, options = after.split(" ", 2)
        if kind == "cgroup2":
            mounts[""] = root, point
        elif kind == "cgroup":
            mounts |= {each: (root, point) for each in ("memory", "pids") if each in options.split(",")}
    folders = []
    for line in _read_group_file("/proc/self/cgroup").splitlines():
        _, names, path = line.split(":", 2)
        for name in names.split(","):
            if name in mounts:
                root, point = mounts[name]
                inner = path.removeprefix(root.rstrip("/"))
                folders.append((name, f"{point}{inner}".rstrip("/")))
    return folders


def _remove_abandoned(folder: str) -> None:
    with suppress(OSError), os.scandir(folder) as entries:
        for path in abandoned(entries):
            with suppress(OSError):
                os.rmdir(path)


def _read_group_file(file: str) -> str:
    try:
        with open(file) as opened:
            return opened.read()
    except OSError:
        return ""


def _write_group_file(file: str, text: str) -> None:
    with open(file, "w") as opened:
        opened.write(text)
