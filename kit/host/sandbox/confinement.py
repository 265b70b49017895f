"""The ladder of confinement: how far a student's process is locked in.

Level 0 is a process of its own, empty-handed: limits, no descriptors, no environment, its own session and
folder, killed as a whole. Level 1 takes away, for good and without needing any right, the sight of files that
were not granted (Landlock), the network, new processes and other processes (seccomp). Level 2 adds namespaces,
level 3 (root only) a user of its own for each run.

At the desk the level is 0: there the program is its author's, run with its author's rights, as ``python
file.py`` or ROS 2 would run it, and it may well want to write a log file or ask a server. The limits and the
process of its own are what keeps its accidents to itself. Whoever runs other people's programs asks for more.
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

from kit.host.sandbox import landlock, namespaces, seccomp
from kit.host.sandbox.limits import Limits
from kit.host.wire import Json


class Level(IntEnum):
    """How far a student's process is locked in. Each level includes those below."""

    LIMITED = 0
    FILTERED = 1
    SEPARATE = 2
    ANOTHER_USER = 3


INTERACTIVE_LEVEL = Level.LIMITED

WRITABLE = ("/dev/null",)
"""What every program may write to, besides its own folder."""


@dataclass(frozen=True, slots=True)
class SandboxConfig:
    """What the parent tells a child about its confinement."""

    level: Level
    limits: Limits
    folder: str
    """The run's own folder, removed at the end, with two empty ones in it: ``scratch`` and ``root``."""
    readable: Sequence[str]
    """Files and folders it may read, as absolute paths; everything below them too. From level 1 on."""
    listed: Sequence[str]
    """Folders of which it may read the names of what lies in them, as absolute paths. From level 1 on."""

    @property
    def scratch(self) -> str:
        """The one folder it may write in. It starts there."""
        return f"{self.folder}/scratch"

    @property
    def root(self) -> str:
        """Where a narrowed file tree is built, out of the child's reach."""
        return f"{self.folder}/root"

    @classmethod
    def from_json(cls, content: Json) -> SandboxConfig:
        """The record that ``dataclasses.asdict`` and JSON made of one."""
        limits = Limits(**content["limits"])
        return cls(Level(content["level"]), limits, content["folder"], content["readable"], content["listed"])


class ConfinementError(Exception):
    """This machine does not allow the level asked for; the message says why, and what would help."""


_PR_SET_PDEATHSIG, _PR_SET_DUMPABLE, _PR_SET_CHILD_SUBREAPER, _PR_SET_NO_NEW_PRIVS = 1, 4, 36, 38
_KILL = 9
_FIRST_USER, _USERS = 1_500_000_000, 100_000_000
"""Users of our own, above what systems give to people, services and containers."""


def _prctl(option: int, value: int) -> None:
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(option, ctypes.c_ulong(value), 0, 0, 0)


def adopt_orphans() -> None:
    """Makes this process the parent of everything that comes out of its children (Linux)."""
    _prctl(_PR_SET_CHILD_SUBREAPER, 1)


def shield_this_process() -> None:
    """Other processes of this user can no longer look into this one's memory, files and environment (Linux).

    For the process that holds secrets: a grader's worker. What it starts can be looked into again.
    """
    _prctl(_PR_SET_DUMPABLE, 0)


# In the child, in this order: what the process above the student's does, then what the student's does.


def separate(level: Level) -> None:
    """Called in the process that will start the student's. ConfinementError if it is clear that the level fails."""
    if level >= Level.FILTERED:
        _require_filters()
    if level >= Level.SEPARATE:
        try:
            namespaces.separate()
        except OSError as problem:
            raise ConfinementError(
                f"namespaces are refused ({problem.strerror}). {_namespace_hint()}"
            ) from None
    if level >= Level.ANOTHER_USER and os.geteuid() != 0:
        raise ConfinementError(
            "a user for each run needs root. Run this as root, or in a container as its root."
        )


def lock(config: SandboxConfig) -> None:
    """Called in the process that will run the student's code, just before it does. There is no way back."""
    os.umask(0o022)
    # The folder is there as long as the run, so its number belongs to no other run.
    user = _FIRST_USER + os.stat(config.scratch).st_ino % _USERS
    if config.level >= Level.ANOTHER_USER:
        os.chmod(config.folder, 0o711)  # a way through
    if config.level >= Level.SEPARATE:
        try:
            namespaces.narrow(config.root, config.readable, WRITABLE, config.scratch, config.limits.scratch)
        except OSError as problem:
            raise ConfinementError(f"{problem.strerror}. {_namespace_hint()}") from None
    _limit(config)
    if config.level >= Level.ANOTHER_USER:
        _become(user, config.scratch)
    _prctl(_PR_SET_NO_NEW_PRIVS, 1)
    # Not inherited when a process changes its user, so only now.
    _prctl(_PR_SET_PDEATHSIG, _KILL)
    if config.level >= Level.FILTERED:
        _filter(config)


def _require_filters() -> None:
    if sys.platform != "linux" or not seccomp.supported():
        raise ConfinementError(
            f"Landlock and seccomp are Linux's, on x86-64 and aarch64, not {os.uname().machine}'s."
        )
    if landlock.abi() == 0:
        raise ConfinementError(
            "this kernel has no Landlock. It needs Linux 5.13 or newer, "
            "started with 'landlock' in the list of its parameter lsm= (see /sys/kernel/security/lsm)."
        )


def _filter(config: SandboxConfig) -> None:
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
    """The kernel counts threads against the limit of processes."""
    count = 0
    for process in filter(str.isdigit, os.listdir("/proc") if os.path.isdir("/proc/self") else ()):
        with suppress(OSError):
            if os.stat(f"/proc/{process}").st_uid == user:
                count += len(os.listdir(f"/proc/{process}/task"))
    return count


def _become(user: int, scratch: str) -> None:
    """This process belongs to a user that nobody else is."""
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
    """Root without root's rights."""
    header, nothing = _Header(0x20080522, 0), (ctypes.c_uint32 * 6)()
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.capset(ctypes.byref(header), ctypes.byref(nothing)):
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
                return f"Allow them with: sudo sysctl -w {cure}"
    return "A container's default profile forbids them; outside of one they need Linux 4.18 or newer."
