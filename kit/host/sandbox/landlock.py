"""Restricts a process to granted files with Linux's Landlock, for good; needs neither root nor a package.

Kernel interface: Documentation/userspace-api/landlock.rst. What the kernel cannot restrict yet (older
versions restrict less) is left out, and ``abi()`` says which version this is.
"""

from __future__ import annotations

import ctypes
import os
import stat
from collections.abc import Iterable
from contextlib import suppress
from typing import Final

from kit.host.sandbox import libc

_CREATE, _ADD, _RESTRICT = 444, 445, 446
"""System call numbers, the same on every architecture."""
_VERSION_FLAG: Final = 1
_PATH_BENEATH: Final = 1

EXECUTE, WRITE, READ, READ_DIR = 1 << 0, 1 << 1, 1 << 2, 1 << 3
REMOVE_DIR, REMOVE_FILE = 1 << 4, 1 << 5
MAKE_CHAR, MAKE_DIR, MAKE_REGULAR, MAKE_SOCKET, MAKE_FIFO, MAKE_BLOCK, MAKE_LINK = (
    1 << bit for bit in range(6, 13)
)
REFER, TRUNCATE, IOCTL_DEVICE = 1 << 13, 1 << 14, 1 << 15

ALL_FILE_ACCESS: Final = ((1, (1 << 13) - 1), (2, REFER), (3, TRUNCATE), (5, IOCTL_DEVICE))
"""Accesses, by the Landlock version that can restrict them."""
TCP_ACCESS: Final = (4, 0b11)
"""Bind and connect."""
SCOPES: Final = (6, 0b11)
"""Abstract sockets and signals: only within what is locked in."""

READ_ACCESS: Final = EXECUTE | READ | READ_DIR
"""Accesses granted below a readable folder. Execute, because shared libraries are mapped."""
FILE_ACCESS: Final = EXECUTE | WRITE | READ | TRUNCATE | IOCTL_DEVICE
"""Accesses that exist for what is not a folder."""


class _Ruleset(ctypes.Structure):
    _fields_ = (("files", ctypes.c_uint64), ("network", ctypes.c_uint64), ("scopes", ctypes.c_uint64))


class _PathBeneath(ctypes.Structure):
    _pack_ = 1
    _layout_ = "ms"  # what `_pack_` implies; Python 3.14 wants it said
    _fields_ = (("access", ctypes.c_uint64), ("descriptor", ctypes.c_int32))


def abi() -> int:
    """Returns the Landlock version of this kernel; 0 if it has none or it is switched off."""
    version: int = libc().syscall(_CREATE, None, ctypes.c_size_t(0), ctypes.c_uint32(_VERSION_FLAG))
    return max(0, version)


def restrict(readable: Iterable[str], listed: Iterable[str], writable: Iterable[str]) -> None:
    """Restricts this thread, and what it starts, to reading and writing at and below these paths.

    ``listed`` folders, and folders in them, can only be listed. Paths to be read that are missing, or out of reach
    anyway, are left out. Needs ``no_new_privs``. Raises OSError if the kernel refuses.
    """
    version = abi()
    handled = sum(bits for since, bits in ALL_FILE_ACCESS if version >= since)
    ruleset = _Ruleset(
        handled,
        TCP_ACCESS[1] if version >= TCP_ACCESS[0] else 0,
        SCOPES[1] if version >= SCOPES[0] else 0,
    )
    # A kernel that knows fewer fields takes a longer record, as long as the rest is zero.
    descriptor = _syscall(
        _CREATE, ctypes.byref(ruleset), ctypes.c_size_t(ctypes.sizeof(ruleset)), ctypes.c_uint32(0)
    )
    try:
        for paths, access in ((readable, READ_ACCESS), (listed, READ_DIR)):
            for path in paths:
                with suppress(FileNotFoundError, NotADirectoryError, PermissionError):
                    _allow_access(descriptor, path, access & handled)
        for path in writable:
            _allow_access(descriptor, path, handled)
        _syscall(_RESTRICT, ctypes.c_int(descriptor), ctypes.c_uint32(0))
    finally:
        os.close(descriptor)


def _allow_access(ruleset: int, path: str, access: int) -> None:
    target = os.open(path, os.O_PATH | os.O_CLOEXEC)
    try:
        if not stat.S_ISDIR(os.fstat(target).st_mode):
            access &= FILE_ACCESS
        rule = _PathBeneath(access, target)
        _syscall(
            _ADD, ctypes.c_int(ruleset), ctypes.c_int(_PATH_BENEATH), ctypes.byref(rule), ctypes.c_uint32(0)
        )
    finally:
        os.close(target)


def _syscall(number: int, *arguments: object) -> int:
    result: int = libc().syscall(ctypes.c_long(number), *arguments)
    if result < 0:
        error = ctypes.get_errno()
        raise OSError(error, f"Landlock: {os.strerror(error)}")
    return result
