"""Filters system calls: no new processes, no network, no access to other processes or to the system.

Classic BPF through ``prctl``, so no library is needed. Threads, files (which Landlock governs) and numbers
stay possible. A refused call gives EPERM, which Python shows as PermissionError at the student's own line.
Tables: arch/x86/entry/syscalls/syscall_64.tbl and include/uapi/asm-generic/unistd.h (aarch64).
"""

from __future__ import annotations

import ctypes
import errno
import os
import struct
from typing import Final, NamedTuple

from kit.host.sandbox import libc

# Call: (x86-64, aarch64), None where the architecture never had it.
DENIED: Final[dict[str, tuple[int | None, int | None]]] = {
    # New programs and processes. `clone` is looked at more closely below: threads are clones too.
    "fork": (57, None), "vfork": (58, None), "execve": (59, 221), "execveat": (322, 281),
    # The network. `socketpair` (asyncio needs one) is looked at more closely below.
    "socket": (41, 198), "bind": (49, 200), "listen": (50, 201), "connect": (42, 203),
    "accept": (43, 202), "accept4": (288, 242),
    # Other processes. `kill`, `tgkill` and `prlimit64` are looked at more closely below.
    "ptrace": (101, 117), "process_vm_readv": (310, 270), "process_vm_writev": (311, 271),
    "process_madvise": (440, 440), "process_mrelease": (448, 448), "kcmp": (312, 272), "tkill": (200, 130),
    "rt_sigqueueinfo": (129, 138), "rt_tgsigqueueinfo": (297, 240), "pidfd_open": (434, 434),
    "pidfd_getfd": (438, 438), "pidfd_send_signal": (424, 424), "setpriority": (141, 140),
    "ioprio_set": (251, 30), "sched_setaffinity": (203, 122), "sched_setattr": (314, 274),
    "sched_setparam": (142, 118), "sched_setscheduler": (144, 119), "migrate_pages": (256, 238),
    "move_pages": (279, 239),
    # Mounts and namespaces.
    "mount": (165, 40), "umount2": (166, 39), "pivot_root": (155, 41), "chroot": (161, 51),
    "move_mount": (429, 429), "open_tree": (428, 428), "fsopen": (430, 430), "fsconfig": (431, 431),
    "fsmount": (432, 432), "fspick": (433, 433), "mount_setattr": (442, 442), "unshare": (272, 97),
    "setns": (308, 268),
    # Parts of the kernel with a long list of holes.
    "bpf": (321, 280), "perf_event_open": (298, 241), "userfaultfd": (323, 282), "io_uring_setup": (425, 425),
    "io_uring_enter": (426, 426), "io_uring_register": (427, 427), "add_key": (248, 217),
    "request_key": (249, 218), "keyctl": (250, 219), "personality": (135, 92), "modify_ldt": (154, None),
    # Memory that no limit counts, and mailboxes shared with other programs.
    "memfd_create": (319, 279), "memfd_secret": (447, 447), "shmget": (29, 194), "shmat": (30, 196),
    "shmctl": (31, 195), "msgget": (68, 186), "msgctl": (71, 187), "msgsnd": (69, 189), "msgrcv": (70, 188),
    "semget": (64, 190), "semop": (65, 193), "semctl": (66, 191), "semtimedop": (220, 192),
    "mq_open": (240, 180), "mq_unlink": (241, 181),
    # What Landlock does not restrict about files.
    "chmod": (90, None), "fchmod": (91, 52), "fchmodat": (268, 53), "fchmodat2": (452, 452),
    "chown": (92, None), "lchown": (94, None), "fchown": (93, 55), "fchownat": (260, 54),
    "setxattr": (188, 5), "lsetxattr": (189, 6), "fsetxattr": (190, 7), "removexattr": (197, 14),
    "lremovexattr": (198, 15), "fremovexattr": (199, 16), "utime": (132, None), "utimes": (235, None),
    "futimesat": (261, None), "utimensat": (280, 88), "truncate": (76, 45), "name_to_handle_at": (303, 264),
    "open_by_handle_at": (304, 265), "fanotify_init": (300, 262), "fanotify_mark": (301, 263),
    "inotify_init": (253, None), "inotify_init1": (294, 26), "quotactl": (179, 60), "quotactl_fd": (443, 443),
    # The system itself, in case this runs as root.
    "init_module": (175, 105), "finit_module": (313, 273), "delete_module": (176, 106),
    "kexec_load": (246, 104), "kexec_file_load": (320, 294), "reboot": (169, 142), "swapon": (167, 224),
    "swapoff": (168, 225), "acct": (163, 89), "syslog": (103, 116), "iopl": (172, None),
    "ioperm": (173, None), "settimeofday": (164, 170), "clock_settime": (227, 112), "adjtimex": (159, 171),
    "clock_adjtime": (305, 266), "sethostname": (170, 161), "setdomainname": (171, 162),
    "vhangup": (153, 58), "capset": (126, 91),
}  # fmt: skip


STARTING_PROGRAMS: Final = frozenset({"fork", "vfork", "execve", "execveat"})
"""What a process may do besides that has to start programs and to end them: see ``program``."""


class Architecture(NamedTuple):
    """The name of one processor architecture in a filter, and the calls whose arguments the filter checks."""

    audit: int
    column: int
    clone: int
    kill: int
    tgkill: int
    prlimit64: int
    fcntl: int
    ioctl: int
    prctl: int
    socketpair: int


ARCHITECTURES: Final = {
    "x86_64": Architecture(
        0xC000003E,
        0,
        clone=56,
        kill=62,
        tgkill=234,
        prlimit64=302,
        fcntl=72,
        ioctl=16,
        prctl=157,
        socketpair=53,
    ),
    "aarch64": Architecture(
        0xC00000B7,
        1,
        clone=220,
        kill=129,
        tgkill=131,
        prlimit64=261,
        fcntl=25,
        ioctl=29,
        prctl=167,
        socketpair=199,
    ),
}

SET_OWNER, SET_SIGNAL, SET_OWNER_EX, SET_LEASE, NOTIFY = 8, 10, 15, 1024, 1026
"""Commands of ``fcntl``. Who owns a descriptor is sent a signal of the program's choice, whatever ``kill`` may do; a
lease on a file that can be read makes every other process wait for 45 s that opens it; a folder's notices tell what
others read there."""
SET_OWNER_OF_FILE, SET_OWNER_OF_SOCKET, SEND_SIGNALS = 0x8901, 0x8902, 0x5452
"""The same requests of ``ioctl``: FIOSETOWN, SIOCSPGRP, FIOASYNC."""
SET_SIGNAL_OF_PARENTS_DEATH: Final = 1
"""The option of ``prctl`` that ends a program whose kit was killed; it must stay as it is."""

LOCAL_DOMAIN: Final = 1
STREAM_TYPES: Final = (1, 1 | 0o4000, 1 | 0o2000000, 1 | 0o2004000)
"""The only pairs of sockets that reach nobody else: streams, which may also not block, or be closed in a new program. One of
datagrams needs no ``connect``: each may name another receiver, such as ``/dev/log`` or a service of the machine's."""

CLONE3: Final = 435
"""Its flags lie in memory, out of a filter's sight. ENOSYS makes the C library fall back to ``clone``."""
NEWEST_CALL: Final = 453
"""Calls with a higher number are newer than this table: ENOSYS, as on an older kernel."""
CLONE_THREAD: Final = 0x00010000

_PR_SET_SECCOMP, _FILTER = 22, 2
_LOAD, _EQUAL, _ABOVE, _ANY_BIT, _RETURN = 0x20, 0x15, 0x25, 0x45, 0x06
_NUMBER, _ARCH = 0, 4
_ALLOW, _KILL = 0x7FFF0000, 0x80000000


def _argument(index: int) -> int:
    """Returns the offset of the low half of a call's argument on a little-endian machine."""
    return 16 + 8 * index


def _refuse(error: int) -> int:
    return 0x00050000 | error


def program(architecture: Architecture, own_process: int, *, starts_programs: bool = False) -> bytes:
    """Builds the filter, 8 bytes an instruction: ``(operation, skip if true, skip if false, operand)``.

    ``starts_programs``: the process may start programs, limit them and end them; they are under the same filter. Which
    processes it may signal is left to Landlock.
    """
    code: list[tuple[int, int, int, int]] = [
        (_LOAD, 0, 0, _ARCH),
        (_EQUAL, 1, 0, architecture.audit),
        (_RETURN, 0, 0, _KILL),  # calls of another architecture, such as 32-bit ones, have other numbers
        (_LOAD, 0, 0, _NUMBER),
        (_EQUAL, 0, 1, CLONE3),
        (_RETURN, 0, 0, _refuse(errno.ENOSYS)),
    ]
    allowed = STARTING_PROGRAMS if starts_programs else frozenset()
    denied = [call[architecture.column] for name, call in DENIED.items() if name not in allowed]
    for number in filter(None, denied):
        code += [(_EQUAL, 0, 1, number), (_RETURN, 0, 0, _refuse(errno.EPERM))]
    # Also turns away the x32 calls of x86-64, whose numbers start at 2**30.
    code += [(_ABOVE, 0, 1, NEWEST_CALL), (_RETURN, 0, 0, _refuse(errno.ENOSYS))]
    checked_calls = (
        (architecture.clone, ((_ANY_BIT, 0, 1, CLONE_THREAD),)),
        (architecture.kill, ((_EQUAL, 0, 1, own_process),)),
        (architecture.tgkill, ((_EQUAL, 0, 1, own_process),)),
        (architecture.prlimit64, ((_EQUAL, 1, 0, own_process), (_EQUAL, 0, 1, 0))),
    )
    for number, tests in () if starts_programs else checked_calls:
        body = [
            (_LOAD, 0, 0, _argument(0)),
            *tests,
            (_RETURN, 0, 0, _ALLOW),
            (_RETURN, 0, 0, _refuse(errno.EPERM)),
        ]
        code += [(_EQUAL, 0, len(body), number), *body]
    for number, index, values in (
        (architecture.fcntl, 1, (SET_OWNER, SET_SIGNAL, SET_OWNER_EX, SET_LEASE, NOTIFY)),
        (architecture.ioctl, 1, (SET_OWNER_OF_FILE, SET_OWNER_OF_SOCKET, SEND_SIGNALS)),
        (architecture.prctl, 0, () if starts_programs else (SET_SIGNAL_OF_PARENTS_DEATH,)),
    ):
        body = [(_LOAD, 0, 0, _argument(index))]
        for value in values:
            body += [(_EQUAL, 0, 1, value), (_RETURN, 0, 0, _refuse(errno.EPERM))]
        body.append((_RETURN, 0, 0, _ALLOW))
        code += [(_EQUAL, 0, len(body), number), *body]
    pair: list[tuple[int, int, int, int]] = [
        (_LOAD, 0, 0, _argument(0)),
        (_EQUAL, 1, 0, LOCAL_DOMAIN),
        (_RETURN, 0, 0, _refuse(errno.EPERM)),
        (_LOAD, 0, 0, _argument(1)),
    ]
    for value in STREAM_TYPES:
        pair += [(_EQUAL, 0, 1, value), (_RETURN, 0, 0, _ALLOW)]
    pair.append((_RETURN, 0, 0, _refuse(errno.EPERM)))
    code += [(_EQUAL, 0, len(pair), architecture.socketpair), *pair]
    code.append((_RETURN, 0, 0, _ALLOW))
    return b"".join(struct.pack("=HBBI", *instruction) for instruction in code)


class _Program(ctypes.Structure):
    _fields_ = (("length", ctypes.c_ushort), ("filter", ctypes.c_char_p))


def is_supported() -> bool:
    """Returns whether the filter knows this processor."""
    return os.uname().machine in ARCHITECTURES


def install(*, starts_programs: bool = False) -> None:
    """Installs the filter for this thread and what it starts, for good. Needs ``no_new_privs``."""
    code = program(ARCHITECTURES[os.uname().machine], os.getpid(), starts_programs=starts_programs)
    record = _Program(len(code) // 8, code)
    if libc().prctl(_PR_SET_SECCOMP, ctypes.c_ulong(_FILTER), ctypes.byref(record), 0, 0):
        error = ctypes.get_errno()
        raise OSError(error, f"seccomp: {os.strerror(error)}")
