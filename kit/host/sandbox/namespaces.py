"""Separates a process by Linux namespaces: it sees no other process, no network and only granted files.

As root this needs nothing else; for anyone else a user namespace, which some systems forbid. Man pages:
unshare(2), user_namespaces(7), mount_namespaces(7), pivot_root(2).
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Iterable, Iterator, Mapping
from functools import cache

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
    flags = _NEW_PID | _NEW_NET | _NEW_IPC | _NEW_UTS
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


def restrict_file_tree(
    root: str, readable: Iterable[str], writable: Iterable[str], scratch: str, room: int, files: int
) -> None:
    """Replaces the file tree by one with nothing in it but these paths, built on the empty folder ``root``.

    ``scratch`` becomes an empty folder in memory, with room for ``room`` bytes and ``files`` files. Paths that do not exist are left out;
    one that is a link leads to the same file as before.
    """
    _unshare(_NEW_MOUNT)
    _mount("none", "/", "", _RECURSIVE | _PRIVATE)
    _mount("none", root, "tmpfs", _NO_SUID | _NO_DEVICES, _TREE)
    wanted = dict.fromkeys(readable, _READ_ONLY) | dict.fromkeys(writable, 0)
    for name, real, flags in _outer_first(wanted):
        _bind(root, name, real, flags)
    os.makedirs(root + scratch, exist_ok=True)  # it is there already if its surroundings are readable
    _mount(
        "none", root + scratch, "tmpfs", _NO_SUID | _NO_DEVICES, f"size={room},nr_inodes={files + 1},mode=700"
    )
    _mount("none", root, "tmpfs", _NO_SUID | _NO_DEVICES | _REMOUNT | _READ_ONLY, _TREE)
    os.chdir(root)
    # The old root comes to lie over the new one, and is then taken away: pivot_root(2), "pivot_root(., .)".
    _check(_libc().syscall(ctypes.c_long(_PIVOT_ROOT[os.uname().machine]), b".", b"."), "pivot_root")
    _check(_libc().umount2(b".", _DETACH), "umount2")
    os.chdir(scratch)


def _outer_first(wanted: Mapping[str, int]) -> Iterator[tuple[str, str, int]]:
    """Yields each path under its own name and under its real one, with its real path and flags.

    Folders come first; what is in them is left out, because it is mounted with them."""
    names: dict[str, tuple[str, int]] = {}
    for path, flags in wanted.items():
        real = os.path.realpath(path)
        if os.path.exists(real):
            names |= {name: (real, flags) for name in (path, real) if name not in names}
    shown: set[str] = set()
    for name in sorted(names, key=len):
        if shown.isdisjoint(_with_parents(name)):
            shown.add(name)
            yield name, *names[name]


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


def _unshare(flags: int) -> None:
    _check(_libc().unshare(flags), "unshare")


def _mount(source: str, target: str, kind: str, flags: int, options: str = "") -> None:
    arguments = (source.encode(), os.fsencode(target), kind.encode(), ctypes.c_ulong(flags), options.encode())
    _check(_libc().mount(*arguments), f"mount on {target}")


@cache  # loading it costs as much as a mount, and there are hundreds
def _libc() -> ctypes.CDLL:
    return ctypes.CDLL(None, use_errno=True)


def _check(result: int, what: str) -> None:
    if result < 0:
        error = ctypes.get_errno()
        raise OSError(error, f"{what}: {os.strerror(error)}")
