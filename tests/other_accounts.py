"""Runs commands as other accounts of this machine, where the tests are root's: accounts that only a test knows."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import mkdtemp
from typing import Final

ROOT: Final = Path(__file__).parents[1]
FIRST_ACCOUNT: Final = 54_321
_OPEN_INTERPRETER: Final = """
set -e
if [ "$1" != "" ]; then
    held=$(mktemp -d)
    mount --bind "$1" "$held"
    mount -t tmpfs -o mode=755 none "$2"
    mkdir -p "$1"
    mount --bind "$held" "$1"
    umount "$held"
    rmdir "$held"
fi
shift 2
exec "$@"
"""
"""Where Python lies in a home that only its owner may enter, others see it there in a mount namespace of their own."""


def why_impossible() -> str:
    """Says why no command can be run as another account here; empty if it can."""
    if sys.platform != "linux" or os.geteuid() != 0:
        return "only root of a Linux machine runs commands as other accounts"
    for tool in ("unshare", "setpriv"):
        if shutil.which(tool) is None:
            return f"there is no {tool} here"
    tried = subprocess.run(
        [*as_account(FIRST_ACCOUNT), sys.executable, "-c", ""], capture_output=True, text=True, check=False
    )
    return "" if tried.returncode == 0 else f"a command as another account fails: {tried.stderr.strip()}"


def with_interpreter() -> list[str]:
    """A command's beginning after which every account may run this Python."""
    prefix = Path(sys.base_prefix)
    closed = [each for each in (prefix, *prefix.parents) if not each.stat().st_mode & 0o001]
    hidden = (str(prefix), str(closed[-1])) if closed else ("", "")
    return ["unshare", "--mount", "sh", "-c", _OPEN_INTERPRETER, "sh", *hidden]


def as_account(user: int) -> list[str]:
    """A command's beginning after which it runs as this account, which need not have a name."""
    number = str(user)
    return [*with_interpreter(), "setpriv", "--reuid", number, "--regid", number, "--clear-groups"]


@contextmanager
def open_installation() -> Iterator[Path]:
    """A copy of the kit that root owns, and everybody may read; removed afterwards."""
    folder = Path(mkdtemp(prefix="kit-for-all-"))
    try:
        folder.chmod(0o755)
        ignored = shutil.ignore_patterns(".git", "__pycache__", "tests", ".*_cache")
        shutil.copytree(ROOT, folder / "kit", ignore=ignored, symlinks=True)
        subprocess.run(["chmod", "-R", "go+rX,go-w", folder], check=True)
        yield folder / "kit"
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def warm_installation(installation: Path) -> None:
    """Compiles the kernels for all accounts, as an administrator does."""
    with home_of(0) as home:
        made = subprocess.run(
            [sys.executable, "-m", "kit", "warm", "--shared"],
            cwd=home,
            env=environment_of(installation, home),
            capture_output=True,
            text=True,
            check=False,
        )
    assert made.returncode == 0, made.stderr


def run_as(
    user: int, installation: Path, home: Path, command: Sequence[str], limit_s: float
) -> subprocess.CompletedProcess[str]:
    """Runs Python with these arguments as an account, in its home. Raises subprocess.TimeoutExpired."""
    return subprocess.run(
        [*as_account(user), sys.executable, *command],
        cwd=home,
        env=environment_of(installation, home),
        capture_output=True,
        text=True,
        check=False,
        timeout=limit_s,
    )


def environment_of(installation: Path, home: Path) -> Mapping[str, str]:
    return {
        "HOME": str(home),
        "PATH": os.environ["PATH"],
        "PYTHONPATH": str(installation),
        "PYTHONDONTWRITEBYTECODE": "1",
        "LANG": "C.UTF-8",
    }


@contextmanager
def home_of(user: int) -> Iterator[Path]:
    """A home that only this account may enter; removed afterwards."""
    home = Path(mkdtemp(prefix=f"home-{user}-"))
    try:
        os.chown(home, user, user)
        yield home
    finally:
        shutil.rmtree(home, ignore_errors=True)
