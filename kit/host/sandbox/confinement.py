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

import os
import sys
from collections.abc import Sequence
from contextlib import suppress

from kit.host.sandbox import landlock, namespaces, seccomp
from kit.host.sandbox.privileges import FIRST_USER, USERS, drop_capabilities, set_limits, switch_user
from kit.host.sandbox.process_control import PR_SET_NO_NEW_PRIVS, PR_SET_PDEATHSIG, PR_SET_THP_DISABLE, prctl
from kit.host.sandbox.sandbox_config import WRITABLE, ConfinementError, Level, SandboxConfig

_KILL = 9


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
    user = FIRST_USER + os.stat(config.scratch).st_ino % USERS
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
    set_limits(config)
    if config.level >= Level.ANOTHER_USER:
        switch_user(user, config.scratch)
    prctl(PR_SET_NO_NEW_PRIVS, 1)
    # Not inherited when a process changes its user, so only now.
    prctl(PR_SET_PDEATHSIG, _KILL)
    if config.level >= Level.FILTERED:
        prctl(PR_SET_THP_DISABLE, 1)  # a page is 4 KiB: what holds one byte of it holds no more
        _restrict(config)


def confine_reader(
    readable: Sequence[str], listed: Sequence[str], writable: Sequence[str], *, starts_programs: bool = True
) -> None:
    """Confines this process of the kit's own, for good, before it reads what somebody else has written.

    As at level 1, but that with ``starts_programs`` it may start programs, which are then confined likewise. Raises
    ConfinementError.
    """
    _require_filters()
    prctl(PR_SET_NO_NEW_PRIVS, 1)
    prctl(PR_SET_PDEATHSIG, _KILL)
    try:
        drop_capabilities()
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
        drop_capabilities()
        landlock.restrict(config.readable, config.listed, (config.scratch, *WRITABLE))
        seccomp.install()
    except OSError as problem:
        raise ConfinementError(
            f"{problem.strerror}. A container may forbid it: see its seccomp profile."
        ) from None


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
