"""Lets ticks pass while a program waits for another process, which may wait for the world itself (``os.popen("ros2 ...")``)."""

from __future__ import annotations

import io
import os
from collections.abc import Callable
from contextlib import AbstractContextManager
from functools import wraps
from typing import Any

from kit.host.child.import_hooks import on_import

Waiting = Callable[[], AbstractContextManager[None]]


def answer_ticks_meanwhile(waiting: Waiting) -> None:
    """Marks waits for other processes by ``waiting``: ticks are answered without the thread, at most in real time."""

    def change(module: Any) -> None:
        for name in ("wait", "communicate"):
            setattr(module.Popen, name, _marked(getattr(module.Popen, name), waiting))

    on_import("subprocess", change)
    os.popen = _open_pipe


def _marked(function: Callable[..., Any], waiting: Waiting) -> Callable[..., Any]:
    @wraps(function)
    def marked(*args: Any, **kwargs: Any) -> Any:
        with waiting():
            return function(*args, **kwargs)

    return marked


def _open_pipe(cmd: str, mode: str = "r", buffering: int = -1) -> Any:
    """Does what ``os.popen`` does; to be read from, the command is run to its end first."""
    import subprocess  # few programs need it, and each start would pay for it

    if mode != "r":
        return subprocess.Popen(cmd, shell=True, text=True, stdin=subprocess.PIPE, bufsize=buffering).stdin
    done = subprocess.run(cmd, shell=True, text=True, stdout=subprocess.PIPE, check=False)
    return _Pipe(done.stdout, done.returncode)


class _Pipe(io.StringIO):
    """What a command has printed; closing it tells its exit status, as closing a pipe does."""

    def __init__(self, text: str, status: int) -> None:
        super().__init__(text)
        self._status = status

    def close(self) -> Any:
        super().close()
        return None if self._status == 0 else self._status << 8 if self._status > 0 else self._status
