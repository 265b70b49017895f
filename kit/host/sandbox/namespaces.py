"""Separates a process by Linux namespaces: it sees no other process, no network and only granted files.

As root this needs nothing else; for anyone else a user namespace, which some systems forbid. Man pages:
unshare(2), user_namespaces(7), mount_namespaces(7), pivot_root(2).
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache

from kit.host.sandbox import libc

_NEW_MOUNT, _NEW_UTS, _NEW_IPC, _NEW_USER, _NEW_PID, _NEW_NET = (
    0x00020000, 0x04000000, 0x08000000, 0x10000000, 0x20000000, 0x40000000,
)  # fmt: skip
_READ_ONLY, _NO_SUID, _NO_DEVICES, _NO_EXECUTE = 1, 2, 4, 8
_REMOUNT, _BIND, _RECURSIVE, _PRIVATE = 32, 4096, 16384, 1 << 18
_DETACH = 2
_TREE = "size=1m,mode=755"
_PIVOT_ROOT = {"x86_64": 155, "aarch64": 41}


def unshare_namespaces() -> None:
    """Makes the next child of this process the first of a process tree of its own, without a network."""
    _unshare_as_any_user(_NEW_PID | _NEW_NET | _NEW_IPC | _NEW_UTS)


def mount_scratch(scratch: str, room: int, files: int) -> bool:
    """Makes ``scratch`` a folder in memory, with room for ``room`` bytes and ``files`` files, that this process and those that
    it starts see. It is gone when they have ended, however they end. Returns whether this machine allows that.
    """
    try:
        _unshare_as_any_user(_NEW_MOUNT)
        _mount("none", "/", "", _RECURSIVE | _PRIVATE)
        _mount("none", scratch, "tmpfs", _NO_SUID | _NO_DEVICES, _scratch_options(room, files))
    except OSError:
        return False
    os.chdir(scratch)
    return True


def unmount_scratch(scratch: str) -> None:
    """Undoes ``mount_scratch``, so that the folder can be removed."""
    os.chdir("/")
    libc().umount2(os.fsencode(scratch), _DETACH)


def _scratch_options(room: int, files: int) -> str:
    return f"size={room},nr_inodes={files + 1},mode=700"


def _unshare_as_any_user(flags: int) -> None:
    """Makes namespaces as root, or with one in which this user has the rights for it."""
    if os.geteuid() == 0:
        try:
            _unshare(flags)
        except PermissionError:  # root of a container
            pass
        else:
            return
    user, group = os.geteuid(), os.getegid()
    _unshare(flags | _NEW_USER)
    for name, content in (
        ("setgroups", "deny"),
        ("uid_map", f"{user} {user} 1"),
        ("gid_map", f"{group} {group} 1"),
    ):
        with open(f"/proc/self/{name}", "w") as file:
            file.write(content)


@dataclass(frozen=True, slots=True)
class FileTree:
    """The paths of which a restricted file tree consists. Those that do not exist are left out."""

    readable: Sequence[str]
    """Absolute paths, with everything below them. One that is a link leads to the same file as before."""
    writable: Sequence[str]
    hidden: Sequence[str]
    """Absolute paths without links below readable ones: empty folders and files appear there. A readable path below
    a hidden folder is shown nevertheless."""


def restrict_file_tree(root: str, tree: FileTree, scratch: str, room: int, files: int) -> None:
    """Replaces the file tree by one with nothing in it but ``tree``, built on the empty folder ``root``.

    ``scratch`` becomes an empty folder in memory, with room for ``room`` bytes and ``files`` files.
    """
    _unshare(_NEW_MOUNT)
    _mount("none", "/", "", _RECURSIVE | _PRIVATE)
    _mount("none", root, "tmpfs", _NO_SUID | _NO_DEVICES, _TREE)
    covers = []
    for mount in plan_mounts(tree):
        if mount.real is not None:
            _bind(root, mount.name, mount.real, mount.flags)
        elif _hide_path(root, mount.name):
            covers.append(root + mount.name)
    os.makedirs(root + scratch, exist_ok=True)  # it is there already if its surroundings are readable
    _mount("none", root + scratch, "tmpfs", _NO_SUID | _NO_DEVICES, _scratch_options(room, files))
    for folder in (*covers, root):
        _mount("none", folder, "tmpfs", _NO_SUID | _NO_DEVICES | _REMOUNT | _READ_ONLY, _TREE)
    os.chdir(root)
    # The old root comes to lie over the new one, and is then taken away: pivot_root(2), "pivot_root(., .)".
    _check(libc().syscall(ctypes.c_long(_PIVOT_ROOT[os.uname().machine]), b".", b"."), "pivot_root")
    _check(libc().umount2(b".", _DETACH), "umount2")
    os.chdir(scratch)


@dataclass(frozen=True, slots=True)
class PlannedMount:
    """What is mounted at one path of the new tree."""

    name: str
    real: str | None
    """The path that is shown; None: nothing is to be seen there."""
    flags: int = 0

    @property
    def is_writable(self) -> bool:
        return self.real is not None and not self.flags & _READ_ONLY


def plan_mounts(tree: FileTree) -> Iterator[PlannedMount]:
    """Yields what has to be mounted, outer folders first: every path under its own name and under its real one.

    What lies in a folder comes with it, so as few mounts as possible are made: a mount takes time, and a folder of
    installed packages has hundreds of entries.
    """
    planned: dict[str, PlannedMount] = {}
    for path, flags in (dict.fromkeys(tree.readable, _READ_ONLY) | dict.fromkeys(tree.writable, 0)).items():
        real = _real_path(path)
        if os.path.exists(real):
            for name in (path, real):
                planned.setdefault(name, PlannedMount(name, real, flags))
    for shown in tuple(planned.values()):
        for hidden in tree.hidden:
            if shown.real is not None and hidden.startswith(f"{shown.real}/"):
                name = shown.name + hidden[len(shown.real) :]
                planned.setdefault(name, PlannedMount(name, None))
    kept: dict[str, PlannedMount] = {}
    for name in sorted(planned, key=len):
        mount = planned[name]
        above = next((kept[each] for each in _with_parents(name) if each in kept), None)
        is_seen_above = above is not None and above.real is not None
        if is_seen_above == (mount.real is None):
            kept[name] = mount
            yield mount


def _real_path(path: str) -> str:
    """Returns a path without links, asking only once about a folder of which hundreds of entries are granted."""
    if os.path.islink(path):
        return os.path.realpath(path)
    folder, name = os.path.split(path)
    return f"{_real_folder(folder).rstrip('/')}/{name}"


@cache
def _real_folder(path: str) -> str:
    return os.path.realpath(path)


def _with_parents(path: str) -> Iterator[str]:
    """Yields a path and every folder above it, without the root."""
    while path != "/":
        yield path
        path = os.path.dirname(path)


def _bind(root: str, name: str, real: str, flags: int) -> None:
    target = root + name
    if os.path.isdir(real):
        os.makedirs(target)
    else:
        os.makedirs(os.path.dirname(target), exist_ok=True)
        os.close(os.open(target, os.O_CREAT, 0o444))
    # With what is mounted below: a part of a tree may hide what the whole one does not show.
    _mount(real, target, "", _BIND | _RECURSIVE)
    # A mount that came from outside may only be made stricter: what it forbids has to be forbidden again.
    kept = os.statvfs(target).f_flag & (_READ_ONLY | _NO_SUID | _NO_DEVICES | _NO_EXECUTE)
    _mount("none", target, "", _REMOUNT | _BIND | flags | _NO_SUID | kept)


def _hide_path(root: str, name: str) -> bool:
    """Makes a folder or a file of the new tree look empty; returns whether it is a folder.

    A link stays: it leads to something that is covered itself, or that the new tree does not have."""
    target = root + name
    if os.path.islink(target) or not os.path.exists(target):
        return False
    if os.path.isdir(target):
        _mount("none", target, "tmpfs", _NO_SUID | _NO_DEVICES, _TREE)
        return True
    _mount(os.devnull, target, "", _BIND)  # an empty file of the new tree would have to have a name there
    return False


def _unshare(flags: int) -> None:
    _check(libc().unshare(flags), "unshare")


def _mount(source: str, target: str, kind: str, flags: int, options: str = "") -> None:
    arguments = (source.encode(), os.fsencode(target), kind.encode(), ctypes.c_ulong(flags), options.encode())
    _check(libc().mount(*arguments), f"mount on {target}")


def _check(result: int, what: str) -> None:
    if result < 0:
        error = ctypes.get_errno()
        raise OSError(error, f"{what}: {os.strerror(error)}")
