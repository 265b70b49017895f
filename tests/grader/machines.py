"""Tries the catalogue of attacks as root, as an ordinary user, and on a kernel without Landlock.

``python -m tests.grader.machines`` tries all of it on all three, level by level; ``--only user`` on one of them, and words
choose attacks by their names. Exit code 1 if an attack is not held.
"""

from __future__ import annotations

import ctypes
import errno
import os
import struct
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Final

import click

from kit.host.sandbox import landlock
from kit.host.sandbox.probe import probe_levels
from kit.host.sandbox.sandbox_config import Level

ROOT: Final = Path(__file__).parents[2]
ORDINARY_USER: Final = 65_534
"""``nobody``, of whom no file here is."""

_NEW_MOUNT, _BIND, _RECURSIVE, _PRIVATE = 0x00020000, 4096, 16384, 1 << 18
PR_SET_NO_NEW_PRIVS, _PR_SET_SECCOMP, _FILTER = 38, 22, 2
_CREATE_RULESET: Final = 444
"""Landlock's first system call, on every architecture."""


def _libc() -> ctypes.CDLL:
    return ctypes.CDLL(None, use_errno=True)


def _check(result: int, what: str) -> None:
    if result < 0:
        raise OSError(ctypes.get_errno(), f"{what}: {os.strerror(ctypes.get_errno())}")


def become_root() -> str:
    """Stays root. Returns why that is not possible; empty if it is."""
    return "" if os.geteuid() == 0 else "this is not root"


def become_ordinary_user() -> str:
    """Becomes a user without any right, for good. Returns why that is not possible; empty if it is."""
    if os.geteuid() != 0:
        return ""
    try:
        _reveal(sys.base_prefix, sys.prefix, sysconfig.get_path("purelib"), str(ROOT))
    except OSError as error:
        return f"the folder of Python or of this checkout is closed to others, and stays so ({error})"
    for name in ("TMPDIR", "HOME", "NUMBA_CACHE_DIR"):
        os.chown(os.environ[name], ORDINARY_USER, ORDINARY_USER)
    os.setgroups([])
    os.setresgid(ORDINARY_USER, ORDINARY_USER, ORDINARY_USER)
    os.setresuid(ORDINARY_USER, ORDINARY_USER, ORDINARY_USER)
    _check(_libc().prctl(4, ctypes.c_ulong(1), 0, 0, 0), "prctl")  # its own /proc is its own again
    return "" if os.access(sys.executable, os.X_OK) else f"{sys.executable} cannot be run by others"


def _reveal(*needed: str) -> None:
    """Opens closed folders above these paths for this process alone: only what is needed is seen in them."""
    closed = {
        str(folder)
        for path in needed
        for folder in (*Path(path).resolve().parents, *Path(path).absolute().parents)
        if not folder.stat().st_mode & 0o001
    }
    if not closed:
        return
    libc = _libc()
    _check(libc.unshare(_NEW_MOUNT), "unshare")
    _check(libc.mount(b"none", b"/", None, ctypes.c_ulong(_RECURSIVE | _PRIVATE), None), "mount")
    for folder in sorted(closed, key=len):
        inside = [path for path in map(os.path.realpath, needed) if path.startswith(f"{folder}/")]
        handles = {path: os.open(path, os.O_PATH) for path in sorted(inside, key=len)}
        _check(libc.mount(b"none", os.fsencode(folder), b"tmpfs", 0, b"mode=755"), f"mount on {folder}")
        for path, handle in handles.items():
            Path(path).mkdir(parents=True, exist_ok=True)
            source = f"/proc/self/fd/{handle}".encode()
            flags = ctypes.c_ulong(_BIND | _RECURSIVE)
            _check(libc.mount(source, os.fsencode(path), None, flags, None), f"mount on {path}")
            os.close(handle)


def become_without_landlock() -> str:
    """Has the kernel refuse Landlock to this process and all that it starts, for good. Returns ""."""
    code = [
        (0x20, 0, 0, 0),  # load the number of the call
        (0x15, 0, 1, _CREATE_RULESET),
        (0x06, 0, 0, 0x00050000 | errno.ENOSYS),
        (0x06, 0, 0, 0x7FFF0000),
    ]
    instructions = b"".join(struct.pack("<HBBI", *each) for each in code)
    buffer = ctypes.create_string_buffer(instructions, len(instructions))
    record = struct.pack("@HxxxxxxQ", len(code), ctypes.addressof(buffer))
    libc = _libc()
    _check(libc.prctl(PR_SET_NO_NEW_PRIVS, ctypes.c_ulong(1), 0, 0, 0), "prctl")
    _check(libc.prctl(_PR_SET_SECCOMP, ctypes.c_ulong(_FILTER), record, 0, 0), "seccomp")
    assert landlock.abi() == 0
    return ""


MACHINES: Final[Mapping[str, Callable[[], str]]] = MappingProxyType(
    {"root": become_root, "user": become_ordinary_user, "no-landlock": become_without_landlock}
)
"""By name: what turns a process into one on such a machine."""


def try_attacks(machine: str, words: tuple[str, ...]) -> Iterator[str]:
    """Runs the catalogue in a process on such a machine, and yields the lines that it prints."""
    with tempfile.TemporaryDirectory(prefix="kit-machine-", ignore_cleanup_errors=True) as folder:
        own = {}
        for name in ("TMPDIR", "HOME", "NUMBA_CACHE_DIR"):
            own[name] = str(Path(folder, name.lower()))
            Path(own[name]).mkdir()
        Path(folder).chmod(0o755)
        shared = os.environ | {"PYTHONPATH": str(ROOT), "PYTHONDONTWRITEBYTECODE": "1"}
        environment = {name: value for name, value in shared.items() if name != "KIT_WORKSPACE"} | own
        command = [sys.executable, "-P", "-m", "tests.grader.machines", "--become", machine, *words]
        with subprocess.Popen(
            command, env=environment, cwd="/", stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        ) as running:
            assert running.stdout is not None
            yield from (line.rstrip("\n") for line in running.stdout)
        if running.returncode:
            yield f"{FAILED} with exit code {running.returncode}"


SKIPPED: Final = "skipped:"
FAILED: Final = "the catalogue ended"
ABSENT: Final = "absent"
"""Follows a level that such a machine does not have."""


def unheld(lines: list[str]) -> list[str]:
    """Returns the lines that say that something is wrong."""
    return [line for line in lines if "NOT HELD" in line or line.startswith(FAILED)]


def _run_here(machine: str, words: tuple[str, ...]) -> None:
    """Turns this process into one on such a machine, and runs the catalogue."""
    from tests.grader import attacks

    problem = MACHINES[machine]()
    if problem:
        print(SKIPPED, problem)
        return
    print(f"user {os.geteuid()}, Landlock version {landlock.abi()}")
    levels = []
    for support in probe_levels():
        held = "" if support.is_available else f" {ABSENT}"
        print(f"level {int(support.level)}{held}: {support.reason}")
        levels += [support.level] if support.is_available else []
    assert (Level.FILTERED in levels) == (landlock.abi() > 0), "level 1 is there if and only if Landlock is"
    for line in attacks.table(levels, words):
        print(line, flush=True)


@click.command(help=__doc__)
@click.argument("words", nargs=-1)
@click.option("--only", default=",".join(MACHINES), show_default=True, help="Machines, separated by commas.")
@click.option("--become", type=click.Choice(list(MACHINES)), hidden=True)
def main(*, words: tuple[str, ...], only: str, become: str | None) -> None:
    if become is not None:
        _run_here(become, words)
        return
    wrong = []
    for machine in only.split(","):
        if machine not in MACHINES:
            raise click.UsageError(f"no machine {machine}: there are {', '.join(MACHINES)}")
        click.echo(f"== {machine}")
        lines = []
        for line in try_attacks(machine, words):
            click.echo(line)
            lines.append(line)
        wrong += unheld(lines)
    click.echo(f"{len(wrong)} not held")
    raise SystemExit(bool(wrong))


if __name__ == "__main__":
    main()
