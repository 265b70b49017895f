"""Runs Python that an assignment brings along, its reference and its author's tests, apart from the grader and confined.

An assignment may be a stranger's: a lesson that was downloaded, a sheet that a colleague passed on. Its code runs in a copy of
the grader's process that may read Python, the kit and the assignment's folder, and write to a folder of its own that is then
removed. It starts no program, reaches no network, and inherits neither environment nor open files; what it says is JSON.
"""

from __future__ import annotations

import json
import os
import resource
import select
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Final, NoReturn

import grader
import kit
from kit.host.private_folder import private_folder
from kit.host.sandbox.confinement import confine_reader
from kit.host.sandbox.grants import find_grants
from kit.host.sandbox.limits import GIB, MIB
from kit.host.sandbox.privileges import NO_CORE
from kit.host.sandbox.sandbox_config import Level
from kit.host.wire import Json
from kit.world.catalogue import maps_folder

MAX_ANSWER_BYTES: Final = 64_000_000
"""Bytes of what it says."""
MORE_MEMORY: Final = 2 * GIB
"""Bytes of address space besides what the grader has."""
MAX_FILE_SIZE: Final = 256 * MIB
FIRST_OWN_DESCRIPTOR: Final = 3
UNINTELLIGIBLE: Final = "The assignment's own code said what is no answer."


class AuthorCodeError(Exception):
    """The code of an assignment's author failed, or took too long: the message is for the author."""


def run_author_code(work: Callable[[], Json], folder: Path, level: Level, limit_s: float) -> Json:
    """Returns what ``work`` returns. From level 1 on it runs confined, in a copy of this process that ends with it.

    ``folder``: the assignment's, which it may read. ``limit_s``: wall clock. At level 0, which somebody has asked for, it runs
    in this process, without a limit. Raises AuthorCodeError, and whatever ``work`` raises at level 0.
    """
    if level is Level.LIMITED:
        return work()
    with private_folder() as scratch:
        reader, writer = os.pipe()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # the copy goes on with this thread alone
            process = os.fork()
        if process == 0:
            _run_as_copy(work, folder, str(scratch), writer)
        os.close(writer)
        try:
            answer = _await_answer(reader, limit_s)
        finally:
            os.close(reader)
            with suppress(ProcessLookupError):
                os.kill(process, signal.SIGKILL)
            os.waitpid(process, 0)
    return _read_answer(answer)


def _read_answer(answer: bytes) -> Json:
    try:
        told = json.loads(answer)
    except (ValueError, RecursionError):  # nothing, a part, or what only looks like an answer
        raise AuthorCodeError("The assignment's own code ended before its last answer.") from None
    if not isinstance(told, dict) or "value" not in told:
        raise AuthorCodeError(str(told.get("error", "")) if isinstance(told, dict) else UNINTELLIGIBLE)
    return told["value"]


def _await_answer(reader: int, limit_s: float) -> bytes:
    ends, answer = time.monotonic() + limit_s, bytearray()
    while True:
        left_s = ends - time.monotonic()
        if left_s <= 0 or not select.select([reader], [], [], left_s)[0]:
            raise AuthorCodeError(f"The assignment's own code took longer than {limit_s:.0f} s.")
        more = os.read(reader, 1 << 20)
        if not more:
            return bytes(answer)
        answer += more
        if len(answer) > MAX_ANSWER_BYTES:
            raise AuthorCodeError(
                f"The assignment's own code said more than {MAX_ANSWER_BYTES // 1_000_000} MB."
            )


def _run_as_copy(work: Callable[[], Json], folder: Path, scratch: str, writer: int) -> NoReturn:
    """Runs in the copy, and never returns: nothing of the grader's own may go on twice."""
    code = 1
    try:
        try:
            _leave_behind(writer)
            _confine(folder, scratch)
            told = json.dumps({"value": work()})
        except BaseException:  # noqa: BLE001  # whatever it is, the grader is told and the copy ends
            told = json.dumps({"error": traceback.format_exc()})
        content = told.encode()
        while content:
            content = content[os.write(writer, content) :]
        code = 0
    finally:
        os._exit(code)


def _leave_behind(writer: int) -> None:
    """Gives up what the grader has open and in its environment, and its ways to end."""
    for each in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGALRM, signal.SIGCHLD):
        signal.signal(each, signal.SIG_DFL)
    signal.set_wakeup_fd(-1)
    os.setsid()
    nowhere = os.open(os.devnull, os.O_RDWR)
    for standard in range(FIRST_OWN_DESCRIPTOR):
        os.dup2(nowhere, standard)
    os.closerange(FIRST_OWN_DESCRIPTOR, writer)
    os.closerange(writer + 1, resource.getrlimit(resource.RLIMIT_NOFILE)[0])
    os.environ.clear()


def _confine(folder: Path, scratch: str) -> None:
    os.chdir(scratch)
    os.environ.update(TMPDIR=scratch, HOME=scratch)
    tempfile.tempdir = scratch
    sys.dont_write_bytecode = True
    with suppress(ValueError, OSError):
        resource.setrlimit(resource.RLIMIT_CORE, (NO_CORE, NO_CORE))
        resource.setrlimit(resource.RLIMIT_FSIZE, (MAX_FILE_SIZE, MAX_FILE_SIZE))
        used = _address_space()
        if used:
            resource.setrlimit(resource.RLIMIT_AS, (used + MORE_MEMORY, used + MORE_MEMORY))
    granted = find_grants([folder])
    readable = [*granted.readable, *kit.__path__, *grader.__path__, str(maps_folder()), str(folder.resolve())]
    confine_reader(readable, granted.listed, [scratch], starts_programs=False)


def _address_space() -> int:
    """Returns the bytes of address space of this process; 0 where the system does not say."""
    with suppress(OSError), Path("/proc/self/statm").open() as file:
        return int(file.read().split()[0]) * resource.getpagesize()
    return 0
