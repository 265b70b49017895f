"""Confines a student's process at one of four levels.

Level 0 is a process of its own: with limits, without descriptors or environment, in its own session and folder,
killed as a whole. Level 1 takes away, for good and without needing any right, all files that were not granted
(Landlock), the network, new processes and other processes (seccomp). Level 2 adds namespaces, level 3 (root only) a
user of its own for each run. ``promises`` lists what each level keeps from a program.

Interactively the level is 0: the program is its user's own, run with the user's rights, as ``python file.py`` or ROS 2
would run it, and it may well want to write a log file or ask a server. The limits and the process of its own contain
its accidents. Other people's programs need a higher level.
"""

from __future__ import annotations

import ctypes
import os
import resource
import sys
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from enum import IntEnum

from kit.host.sandbox import landlock, libc, namespaces, seccomp
from kit.host.sandbox.limits import KIB, Limits
from kit.host.wire import Json


class Level(IntEnum):
    """Confinement level of a student's process. Each includes those below."""

    LIMITED = 0
    FILTERED = 1
    SEPARATE = 2
    ANOTHER_USER = 3


INTERACTIVE_LEVEL = Level.LIMITED

WRITABLE = ("/dev/null",)
"""Files that every program may write to, besides its own folder."""


@dataclass(frozen=True, slots=True)
class SandboxConfig:
    """The settings of one process's confinement, sent by the parent."""

    level: Level
    limits: Limits
    folder: str
    """The run's folder, removed at the end, with two empty folders in it: ``scratch`` and ``root``."""
    readable: Sequence[str]
    """Absolute paths of files and folders that it may read, with everything below them. From level 1 on."""
    listed: Sequence[str]
    """Absolute paths of folders that it may list. From level 1 on."""
    hidden: Sequence[str]
    """Absolute paths without links in ``listed`` folders, of which the program may see nothing."""
    in_bubblewrap: bool = False
    """Whether bubblewrap has made the namespaces and the file tree already. At level 2."""
    groups: Sequence[str] = ()
    """Files of control groups: who writes 0 to them joins."""

    @property
    def scratch(self) -> str:
        """The one folder that it may write in, and its working folder."""
        return f"{self.folder}/scratch"

    @property
    def root(self) -> str:
        """Where the restricted file tree is built, out of the child's reach."""
        return f"{self.folder}/root"

    @classmethod
    def from_json(cls, content: Json) -> SandboxConfig:
        """Reads what ``dataclasses.asdict`` and JSON have made of a configuration."""
        limits = Limits(**content["limits"])
        return cls(
            Level(content["level"]),
            limits,
            content["folder"],
            content["readable"],
            content["listed"],
            content["hidden"],
            content["in_bubblewrap"],
            content["groups"],
        )

    @property
    def makes_namespaces(self) -> bool:
        """Whether this process has to make namespaces itself."""
        return self.level >= Level.SEPARATE and not self.in_bubblewrap

    @property
    def file_tree(self) -> namespaces.FileTree:
        """All files of a program that has a file tree of its own. Listed folders are shown without what is hidden."""
        shown = [path for path in self.listed if os.path.realpath(path) not in self.hidden]
        return namespaces.FileTree((*shown, *self.readable), WRITABLE, self.hidden)


class ConfinementError(Exception):
    """This machine does not have the requested level; the message says why, and what would help."""


_PR_SET_PDEATHSIG, _PR_SET_DUMPABLE, _PR_SET_CHILD_SUBREAPER, _PR_SET_NO_NEW_PRIVS = 1, 4, 36, 38
_PR_SET_THP_DISABLE = 41
MAX_PENDING_SIGNALS = 128
"""Signals and timers that wait, of all programs of its user together."""
MAX_LOCKED_BYTES = 64 * KIB
"""Bytes of memory that cannot be written to the disk."""
_KILL = 9
_FIRST_USER, _USERS = 1_500_000_000, 100_000_000
"""User ids for runs, above those that systems give to people, services and containers."""


def _prctl(option: int, value: int) -> None:
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(option, ctypes.c_ulong(value), 0, 0, 0)


def adopt_orphans() -> None:
    """Makes this process the parent of all orphans below it (Linux)."""
    _prctl(_PR_SET_CHILD_SUBREAPER, 1)


def shield_this_process() -> None:
    """Forbids other processes of this user to read this one's memory, files and environment (Linux).

    For processes that hold secrets, such as the grader's. Processes that it starts are not protected.
    """
    _prctl(_PR_SET_DUMPABLE, 0)


# Called in this order: ``prepare`` in the process above the student's, ``confine`` in the student's.


def prepare(config: SandboxConfig) -> bool:
    """Prepares the process that will start the student's. Raises ConfinementError if the level is out of reach.

    Returns whether the file system of the scratch folder limits it: always from level 2 on, and at level 1 wherever this
    process may mount.
    """
    if config.level >= Level.FILTERED:
        _require_filters()
    if config.makes_namespaces:
        try:
            namespaces.unshare_namespaces()
        except OSError as problem:
            raise ConfinementError(
                f"namespaces are refused ({problem.strerror}). {_namespace_hint()}"
            ) from None
    if config.level >= Level.ANOTHER_USER and os.geteuid() != 0:
        raise ConfinementError(
            "a user for each run needs root. Run this as root, or in a container as its root."
        )
    if config.level == Level.FILTERED:
        return namespaces.mount_scratch(config.scratch, config.limits.scratch, config.limits.files)
    return config.makes_namespaces


def confine(config: SandboxConfig) -> None:
    """Confines this process, for good, before it receives the student's code. Raises ConfinementError."""
    os.umask(0o022)
    for group in config.groups:
        try:
            with open(group, "w") as file:
                file.write("0")
        except OSError as problem:
            raise ConfinementError(f"a control group cannot be joined ({problem.strerror}).") from None
    # The folder exists as long as the run, so no other run has its inode.
    user = _FIRST_USER + os.stat(config.scratch).st_ino % _USERS
    if config.level >= Level.ANOTHER_USER:
        os.chmod(config.folder, 0o711)  # the other user must get through to its scratch folder
    if config.makes_namespaces:
        try:
            namespaces.restrict_file_tree(
                config.root,
                config.file_tree,
                config.scratch,
                config.limits.scratch,
                config.limits.files,
            )
        except OSError as problem:
            raise ConfinementError(f"{problem.strerror}. {_namespace_hint()}") from None
    _limit(config)
    if config.level >= Level.ANOTHER_USER:
        _switch_user(user, config.scratch)
    _prctl(_PR_SET_NO_NEW_PRIVS, 1)
    # Not inherited when a process changes its user, so only now.
    _prctl(_PR_SET_PDEATHSIG, _KILL)
    if config.level >= Level.FILTERED:
        _prctl(_PR_SET_THP_DISABLE, 1)  # a page is 4 KiB: what holds one byte of it holds no more
        _restrict(config)


def confine_reader(
    readable: Sequence[str], listed: Sequence[str], writable: Sequence[str], *, starts_programs: bool = True
) -> None:
    """Confines this process of the kit's own, for good, before it reads what somebody else has written.

    As at level 1, but that with ``starts_programs`` it may start programs, which are then confined likewise. Raises
    ConfinementError.
    """
    _require_filters()
    _prctl(_PR_SET_NO_NEW_PRIVS, 1)
    _prctl(_PR_SET_PDEATHSIG, _KILL)
    try:
        _drop_capabilities()
        landlock.restrict(readable, listed, (*writable, *WRITABLE))
        seccomp.install(starts_programs=starts_programs)
    except OSError as problem:
        raise ConfinementError(
            f"{problem.strerror}. A container may forbid it: see its seccomp profile."
        ) from None


def _require_filters() -> None:
    if sys.platform != "linux" or not seccomp.is_supported():
        raise ConfinementError(
            f"Landlock and seccomp are Linux's, on x86-64 and aarch64, not {os.uname().machine}'s."
        )
    if landlock.abi() == 0:
        raise ConfinementError(
            "this kernel has no Landlock. It needs Linux 5.13 or newer, "
            "started with 'landlock' in the list of its parameter lsm= (see /sys/kernel/security/lsm)."
        )


def _restrict(config: SandboxConfig) -> None:
    try:
        _drop_capabilities()
        landlock.restrict(config.readable, config.listed, (config.scratch, *WRITABLE))
        seccomp.install()
    except OSError as problem:
        raise ConfinementError(
            f"{problem.strerror}. A container may forbid it: see its seccomp profile."
        ) from None


def _limit(config: SandboxConfig) -> None:
    limits = config.limits
    wanted = {
        resource.RLIMIT_AS: limits.memory,
        resource.RLIMIT_NOFILE: limits.open_files,
        resource.RLIMIT_FSIZE: limits.file_size,
        resource.RLIMIT_CORE: 0,
    }
    if limits.processes is not None:
        running = 0 if config.level >= Level.ANOTHER_USER else _threads_of(os.getuid())
        wanted[resource.RLIMIT_NPROC] = running + limits.processes
    if config.level >= Level.FILTERED and sys.platform == "linux":
        wanted[resource.RLIMIT_MEMLOCK] = MAX_LOCKED_BYTES
        wanted[resource.RLIMIT_MSGQUEUE] = 0
        wanted[resource.RLIMIT_SIGPENDING] = MAX_PENDING_SIGNALS
    for kind, value in wanted.items():
        _set_limit(kind, value, value)
    if limits.cpu_s is not None:
        # The soft limit ends the program with a signal of its own, which tells us why; the hard one kills.
        _set_limit(resource.RLIMIT_CPU, limits.cpu_s, limits.cpu_s + 1)


def _set_limit(kind: int, soft: int, hard: int) -> None:
    allowed = resource.getrlimit(kind)[1]
    if allowed != resource.RLIM_INFINITY:
        soft, hard = min(soft, allowed), min(hard, allowed)
    with suppress(ValueError, OSError):  # a system that knows the limit but does not set it (macOS, memory)
        resource.setrlimit(kind, (soft, hard))


def _threads_of(user: int) -> int:
    """Returns how many threads a user has: the kernel counts them against the limit of processes."""
    count = 0
    for process in filter(str.isdigit, os.listdir("/proc") if os.path.isdir("/proc/self") else ()):
        with suppress(OSError):
            if os.stat(f"/proc/{process}").st_uid == user:
                count += len(os.listdir(f"/proc/{process}/task"))
    return count


def _switch_user(user: int, scratch: str) -> None:
    """Makes this process belong to a user of its own."""
    try:
        os.chown(scratch, user, user)
        os.setgroups([])
        os.setresgid(user, user, user)
        os.setresuid(user, user, user)
    except OSError as problem:
        raise ConfinementError(
            f"a user for each run is refused ({problem.strerror}): this root is only a container's."
        ) from None


class _Header(ctypes.Structure):
    _fields_ = (("version", ctypes.c_uint32), ("process", ctypes.c_int))


def _drop_capabilities() -> None:
    """Gives up root's rights."""
    header, nothing = _Header(0x20080522, 0), (ctypes.c_uint32 * 6)()
    if libc().capset(ctypes.byref(header), ctypes.byref(nothing)):
        raise OSError(ctypes.get_errno(), f"capset: {os.strerror(ctypes.get_errno())}")


_SWITCHES = (
    (
        "/proc/sys/kernel/apparmor_restrict_unprivileged_userns",
        "1",
        "kernel.apparmor_restrict_unprivileged_userns=0",
    ),
    ("/proc/sys/kernel/unprivileged_userns_clone", "0", "kernel.unprivileged_userns_clone=1"),
    ("/proc/sys/user/max_user_namespaces", "0", "user.max_user_namespaces=10000"),
)


def _namespace_hint() -> str:
    for file, refusing, cure in _SWITCHES:
        with suppress(OSError):
            with open(file) as opened:
                refuses = opened.read().strip() == refusing
            if refuses:
                return f"Allow them with: sudo sysctl -w {cure}. Or install bubblewrap (bwrap), if that is allowed to."
    return "A container's default profile forbids them; outside of one they need Linux 4.18 or newer, or bubblewrap."
