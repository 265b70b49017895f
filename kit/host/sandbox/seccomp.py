"""Filters system calls: no new processes, no network, no access to other processes or to the system.

Classic BPF through ``prctl``, so no library is needed. Only the calls of a list are possible: those that every solution, torch,
numba and threads make (``tests/host/sandbox/system_calls.py`` lists them), and their like. A call that this file does not know
gives ENOSYS, as on an older kernel; one that it refuses gives EPERM, which Python shows as PermissionError at the student's
own line. Tables: arch/x86/entry/syscalls/syscall_64.tbl and include/uapi/asm-generic/unistd.h (aarch64).
"""

from __future__ import annotations

import ctypes
import errno
import os
import struct
from collections.abc import Iterator
from typing import Final, NamedTuple

from kit.host.sandbox import libc

CallNumbers = tuple[int | None, int | None]
"""The number of a call on x86-64 and on aarch64; None where the architecture never had it."""

ALLOWED: Final[dict[str, CallNumbers]] = {
    # The most frequent first: the filter is read from its beginning.
    "read": (0, 63), "write": (1, 64), "futex": (202, 98), "poll": (7, None), "ppoll": (271, 73), "clock_gettime": (228, 113),
    "recvfrom": (45, 207), "sendto": (44, 206), "mmap": (9, 222), "munmap": (11, 215), "brk": (12, 214),
    "lseek": (8, 62), "newfstatat": (262, 79), "fstat": (5, 80), "openat": (257, 56), "close": (3, 57),
    "rt_sigprocmask": (14, 135), "rt_sigaction": (13, 134), "rt_sigreturn": (15, 139), "setitimer": (38, 103),
    # Files, of which Landlock decides which.
    "open": (2, None), "openat2": (437, 437), "creat": (85, None), "stat": (4, None), "lstat": (6, None),
    "statx": (332, 291), "access": (21, None), "faccessat": (269, 48), "faccessat2": (439, 439),
    "readlink": (89, None), "readlinkat": (267, 78), "getdents": (78, None), "getdents64": (217, 61),
    "getcwd": (79, 17), "chdir": (80, 49), "fchdir": (81, 50), "umask": (95, 166), "statfs": (137, 43),
    "fstatfs": (138, 44), "pread64": (17, 67), "pwrite64": (18, 68), "readv": (19, 65), "writev": (20, 66),
    "preadv": (295, 69), "pwritev": (296, 70), "ftruncate": (77, 46), "fsync": (74, 82), "fdatasync": (75, 83),
    "flock": (73, 32), "sendfile": (40, 71), "copy_file_range": (326, 285), "rename": (82, None),
    "renameat": (264, 38), "renameat2": (316, 276), "mkdir": (83, None), "mkdirat": (258, 34), "rmdir": (84, None),
    "link": (86, None), "linkat": (265, 37), "symlink": (88, None), "symlinkat": (266, 36), "unlink": (87, None),
    "unlinkat": (263, 35), "mknod": (133, None), "mknodat": (259, 33),
    "fgetxattr": (193, 10), "flistxattr": (196, 13),
    # Descriptors, pipes and waiting.
    "dup": (32, 23), "dup2": (33, None), "dup3": (292, 24), "close_range": (436, 436), "pipe": (22, None),
    "pipe2": (293, 59), "eventfd": (284, None), "eventfd2": (290, 19), "select": (23, None), "pselect6": (270, 72),
    "epoll_create": (213, None), "epoll_create1": (291, 20), "epoll_ctl": (233, 21), "epoll_wait": (232, None),
    "epoll_pwait": (281, 22), "epoll_pwait2": (441, 441), "signalfd": (282, None), "signalfd4": (289, 74),
    "timerfd_create": (283, 85), "timerfd_settime": (286, 86), "timerfd_gettime": (287, 87),
    "shutdown": (48, 210), "getsockname": (51, 204), "getpeername": (52, 205), "setsockopt": (54, 208),
    "getsockopt": (55, 209),
    # Memory.
    "mprotect": (10, 226), "mremap": (25, 216), "msync": (26, 227), "mlock": (149, 228), "mlock2": (325, 284),
    "munlock": (150, 229), "mbind": (237, 235), "get_mempolicy": (239, 236), "set_mempolicy": (238, 237),
    "membarrier": (324, 283), "pkey_mprotect": (329, 288), "pkey_alloc": (330, 289), "pkey_free": (331, 290),
    "arch_prctl": (158, None),
    # Time.
    "gettimeofday": (96, 169), "time": (201, None), "clock_getres": (229, 114), "clock_nanosleep": (230, 115),
    "nanosleep": (35, 101), "getitimer": (36, 102), "alarm": (37, None), "times": (100, 153),
    "timer_create": (222, 107), "timer_settime": (223, 110), "timer_gettime": (224, 108),
    "timer_getoverrun": (225, 109), "timer_delete": (226, 111),
    # Signals, threads, the end.
    "sigaltstack": (131, 132), "rt_sigpending": (127, 136), "rt_sigtimedwait": (128, 137),
    "rt_sigsuspend": (130, 133), "pause": (34, None), "restart_syscall": (219, 128), "set_robust_list": (273, 99),
    "get_robust_list": (274, 100), "set_tid_address": (218, 96), "rseq": (334, 293), "sched_yield": (24, 124),
    "exit": (60, 93), "exit_group": (231, 94), "wait4": (61, 260), "waitid": (247, 95), "setsid": (112, 157),
    "setpgid": (109, 154),
    # What it is, and what it runs on.
    "getpid": (39, 172), "getppid": (110, 173), "gettid": (186, 178), "getuid": (102, 174), "geteuid": (107, 175),
    "getgid": (104, 176), "getegid": (108, 177), "getgroups": (115, 158), "getresuid": (118, 148),
    "getresgid": (120, 150), "getpgrp": (111, None), "getpgid": (121, 155), "getsid": (124, 156),
    "capget": (125, 90), "getrlimit": (97, 163), "getrusage": (98, 165),
    "getpriority": (140, 141), "sched_getaffinity": (204, 123), "sched_getparam": (143, 121),
    "sched_getscheduler": (145, 120), "sched_get_priority_max": (146, 125), "sched_get_priority_min": (147, 126),
    "sched_rr_get_interval": (148, 127), "getcpu": (309, 168), "uname": (63, 160), "sysinfo": (99, 179),
    "getrandom": (318, 278),
}  # fmt: skip
"""What a program may call, with any arguments."""

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
    # Pages that only a pipe holds, and requests that the whole machine has a number of.
    "vmsplice": (278, 75), "tee": (276, 77), "splice": (275, 76), "io_setup": (206, 0), "io_destroy": (207, 1),
    "io_submit": (209, 2), "io_cancel": (210, 3), "io_getevents": (208, 4), "io_pgetevents": (333, 292),
    # Descriptors in flight, which no folder and no list of a process's shows.
    "sendmsg": (46, 211), "sendmmsg": (307, 269), "recvmsg": (47, 212), "recvmmsg": (299, 243),
    # What of others' files is in memory, and writing all of it to the disk at once.
    "mincore": (27, 232), "cachestat": (451, 451), "readahead": (187, 213), "sync": (162, 81), "syncfs": (306, 267),
    # What Landlock does not restrict about files.
    "chmod": (90, None), "fchmod": (91, 52), "fchmodat": (268, 53), "fchmodat2": (452, 452),
    "chown": (92, None), "lchown": (94, None), "fchown": (93, 55), "fchownat": (260, 54),
    "getxattr": (191, 8), "lgetxattr": (192, 9), "listxattr": (194, 11), "llistxattr": (195, 12),
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
    "vhangup": (153, 58), "capset": (126, 91), "setuid": (105, 146), "setgid": (106, 144),
    "setreuid": (113, 145), "setregid": (114, 143), "setresuid": (117, 147), "setresgid": (119, 149),
    "setfsuid": (122, 151), "setfsgid": (123, 152), "setgroups": (116, 159),
}  # fmt: skip
"""What is refused with EPERM: it exists, and a program may not do it."""

STARTING_PROGRAMS: Final[dict[str, CallNumbers]] = {
    "fork": (57, None), "vfork": (58, None), "execve": (59, 221), "execveat": (322, 281), "clone": (56, 220),
    "kill": (62, 129), "tgkill": (234, 131), "prlimit64": (302, 261), "prctl": (157, 167),
}  # fmt: skip
"""What a process may do besides, with any arguments, that has to start programs and to end them: see ``program``."""


class Architecture(NamedTuple):
    """The name of one processor architecture in a filter, and the column of its numbers in the tables."""

    audit: int
    column: int


ARCHITECTURES: Final = {"x86_64": Architecture(0xC000003E, 0), "aarch64": Architecture(0xC00000B7, 1)}

DESCRIPTOR_COMMANDS: Final = (
    0,
    1,
    2,
    3,
    4,
    5,
    6,
    7,
    9,
    16,
    36,
    37,
    38,
    1024 + 1,
    1024 + 6,
    1024 + 8,
    1024 + 10,
)
"""The only commands of ``fcntl``: F_DUPFD, F_GETFD, F_SETFD, F_GETFL, F_SETFL, F_GETLK, F_SETLK, F_SETLKW, F_GETOWN,
F_GETOWN_EX, F_OFD_GETLK, F_OFD_SETLK, F_OFD_SETLKW, F_GETLEASE, F_DUPFD_CLOEXEC, F_GETPIPE_SZ, F_GET_SEALS. Of the others, one has
other processes signalled, one makes them wait for 45 s that open a file, one tells what they read, one widens pipes beyond
every limit, and one leaves a hint with the file itself, which a later program can read."""
TERMINAL_STATE, TERMINAL_STATE_2, WINDOW_SIZE, BYTES_TO_READ, NOT_BLOCKING, CLOSE_ON_EXEC, KEEP_ON_EXEC = (
    0x5401, 0x802C542A, 0x5413, 0x541B, 0x5421, 0x5451, 0x5450,
)  # fmt: skip
"""The only requests of ``ioctl``: TCGETS, TCGETS2, TIOCGWINSZ, FIONREAD, FIONBIO, FIOCLEX, FIONCLEX. Others set the flags of
files that can merely be read, or have other processes signalled."""
SET_SIGNAL_OF_PARENTS_DEATH, SET_HUGE_PAGES = 1, 41
"""Options of ``prctl`` that must stay as they are: the first ends a program whose kit was killed."""
LIMIT_OF_CORES: Final = 4
"""The limit that must stay as it is: see ``privileges.NO_CORE``."""
DROP_FROM_MEMORY, MAKE_COLD, PAGE_OUT = 4, 20, 21
"""Advice on files, the last two of ``madvise``: which of a library's pages are in memory is a message to later programs."""

LOCAL_DOMAIN: Final = 1
STREAM_TYPES: Final = (1, 1 | 0o4000, 1 | 0o2000000, 1 | 0o2004000)
"""The only pairs of sockets that reach nobody else: streams, which may also not block, or be closed in a new program. One of
datagrams needs no ``connect``: each may name another receiver, such as ``/dev/log`` or a service of the machine's."""

CLONE_THREAD: Final = 0x00010000

_PR_SET_SECCOMP, _PR_GET_SECCOMP, _FILTER = 22, 21, 2
_LOAD, _EQUAL, _ANY_BIT, _RETURN = 0x20, 0x15, 0x45, 0x06
_NUMBER, _ARCH = 0, 4
_ALLOW, _KILL = 0x7FFF0000, 0x80000000

Instruction = tuple[int, int, int, int]
"""``(operation, skip if true, skip if false, operand)``"""


class CheckedCall(NamedTuple):
    """A call that depends on one of its arguments."""

    numbers: CallNumbers
    argument: int
    values: tuple[int, ...]
    are_allowed: bool
    """Whether these values of the argument are allowed, and all others refused; or the other way round."""
    refused: tuple[int, int] | None = None
    """Another argument, and a value of it that is refused whatever the first one is."""


def checked_calls(own_process: int) -> dict[str, CheckedCall]:
    """Returns the calls that depend on an argument. ``own_process``: the process that may be signalled and limited."""
    requests = (
        TERMINAL_STATE,
        TERMINAL_STATE_2,
        WINDOW_SIZE,
        BYTES_TO_READ,
        NOT_BLOCKING,
        CLOSE_ON_EXEC,
        KEEP_ON_EXEC,
    )
    return {
        "fcntl": CheckedCall((72, 25), 1, DESCRIPTOR_COMMANDS, are_allowed=True),
        "ioctl": CheckedCall((16, 29), 1, requests, are_allowed=True),
        "madvise": CheckedCall((28, 233), 2, (MAKE_COLD, PAGE_OUT), are_allowed=False),
        "fadvise64": CheckedCall((221, 223), 3, (DROP_FROM_MEMORY,), are_allowed=False),
        # Any other mode reserves the disk's space beyond every limit on a file's size.
        "fallocate": CheckedCall((285, 47), 1, (0,), are_allowed=True),
        # Flags that tell whether what is read lies in memory.
        "preadv2": CheckedCall((327, 286), 5, (0,), are_allowed=True),
        "pwritev2": CheckedCall((328, 287), 5, (0,), are_allowed=True),
        "kill": CheckedCall((62, 129), 0, (own_process,), are_allowed=True),
        "tgkill": CheckedCall((234, 131), 0, (own_process,), are_allowed=True),
        "prlimit64": CheckedCall(
            (302, 261), 0, (0, own_process), are_allowed=True, refused=(1, LIMIT_OF_CORES)
        ),
        "setrlimit": CheckedCall((160, 164), 0, (LIMIT_OF_CORES,), are_allowed=False),
        "prctl": CheckedCall((157, 167), 0, (SET_SIGNAL_OF_PARENTS_DEATH, SET_HUGE_PAGES), are_allowed=False),
    }


def program(architecture: Architecture, own_process: int, *, starts_programs: bool = False) -> bytes:
    """Builds the filter, 8 bytes an instruction.

    ``starts_programs``: the process may start programs, limit them and end them; they are under the same filter. Which
    processes it may signal is left to Landlock.
    """
    code: list[Instruction] = [
        (_LOAD, 0, 0, _ARCH),
        (_EQUAL, 1, 0, architecture.audit),
        (_RETURN, 0, 0, _KILL),  # calls of another architecture, such as 32-bit ones, have other numbers
        (_LOAD, 0, 0, _NUMBER),
    ]
    free = {**ALLOWED, **STARTING_PROGRAMS} if starts_programs else ALLOWED
    for number in _call_numbers(free, architecture):
        code += [(_EQUAL, 0, 1, number), (_RETURN, 0, 0, _ALLOW)]
    for name, call in checked_calls(own_process).items():
        own = call.numbers[architecture.column]
        if name not in free and own is not None:
            body = list(_check_argument(call))
            code += [(_EQUAL, 0, len(body), own), *body]
    clone, socketpair = ((56, 220), (53, 199))
    body = [
        (_LOAD, 0, 0, _argument_offset(0)),
        (_ANY_BIT, 0, 1, CLONE_THREAD),
        (_RETURN, 0, 0, _ALLOW),
        (_RETURN, 0, 0, _errno_action(errno.EPERM)),
    ]
    if "clone" not in free:
        code += [(_EQUAL, 0, len(body), clone[architecture.column]), *body]
    pair: list[Instruction] = [
        (_LOAD, 0, 0, _argument_offset(0)),
        (_EQUAL, 1, 0, LOCAL_DOMAIN),
        (_RETURN, 0, 0, _errno_action(errno.EPERM)),
        (_LOAD, 0, 0, _argument_offset(1)),
    ]
    for value in STREAM_TYPES:
        pair += [(_EQUAL, 0, 1, value), (_RETURN, 0, 0, _ALLOW)]
    pair.append((_RETURN, 0, 0, _errno_action(errno.EPERM)))
    code += [(_EQUAL, 0, len(pair), socketpair[architecture.column]), *pair]
    for number in _call_numbers(
        {name: call for name, call in DENIED.items() if name not in free}, architecture
    ):
        code += [(_EQUAL, 0, 1, number), (_RETURN, 0, 0, _errno_action(errno.EPERM))]
    # ``clone3`` too, whose flags lie in memory, out of a filter's sight: the C library falls back to ``clone``.
    code.append((_RETURN, 0, 0, _errno_action(errno.ENOSYS)))
    return b"".join(struct.pack("=HBBI", *instruction) for instruction in code)


def _call_numbers(calls: dict[str, CallNumbers], architecture: Architecture) -> Iterator[int]:
    for numbers in calls.values():
        number = numbers[architecture.column]
        if number is not None:
            yield number


def _check_argument(call: CheckedCall) -> Iterator[Instruction]:
    listed, others = (
        (_ALLOW, _errno_action(errno.EPERM)) if call.are_allowed else (_errno_action(errno.EPERM), _ALLOW)
    )
    if call.refused is not None:
        argument, value = call.refused
        yield _LOAD, 0, 0, _argument_offset(argument)
        yield _EQUAL, 0, 1, value
        yield _RETURN, 0, 0, _errno_action(errno.EPERM)
    yield _LOAD, 0, 0, _argument_offset(call.argument)
    for value in call.values:
        yield _EQUAL, 0, 1, value
        yield _RETURN, 0, 0, listed
    yield _RETURN, 0, 0, others


def _argument_offset(index: int) -> int:
    """Returns the offset of the low half of a call's argument on a little-endian machine."""
    return 16 + 8 * index


def _errno_action(error: int) -> int:
    return 0x00050000 | error


class _Program(ctypes.Structure):
    _fields_ = (("length", ctypes.c_ushort), ("filter", ctypes.c_char_p))


def is_supported() -> bool:
    """Returns whether the filter knows this processor."""
    return os.uname().machine in ARCHITECTURES


def is_installed() -> bool:
    """Returns whether this thread is under a filter."""
    return bool(libc().prctl(_PR_GET_SECCOMP, 0, 0, 0, 0) == _FILTER)


def install(*, starts_programs: bool = False) -> None:
    """Installs the filter for this thread and what it starts, for good. Needs ``no_new_privs``."""
    code = program(ARCHITECTURES[os.uname().machine], os.getpid(), starts_programs=starts_programs)
    record = _Program(len(code) // 8, code)
    if libc().prctl(_PR_SET_SECCOMP, ctypes.c_ulong(_FILTER), ctypes.byref(record), 0, 0):
        error = ctypes.get_errno()
        raise OSError(error, f"seccomp: {os.strerror(error)}")
