"""Level 2 by bubblewrap holds what level 2 promises; it is taken where namespaces are refused, and nowhere else."""

from __future__ import annotations

import dataclasses
import errno
import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from kit.host.failure import FailureKind, StudentCodeError
from kit.host.private_folder import PREFIX
from kit.host.sandbox import bubblewrap
from kit.host.sandbox.probe import is_level_available
from kit.host.sandbox.reaper import descendants
from kit.host.sandbox.sandbox_config import Level
from kit.host.student_functions import StudentFunctions
from tests.host.conftest import QUICK, Student
from tests.host.sandbox import test_confinement, test_grants
from tests.host.sandbox.test_grants import library
from tests.waiting import wait_until

pytestmark = pytest.mark.usefixtures("cold_start")

__all__ = ["library"]  # a fixture, used by its name


def _reason_to_skip() -> str:
    command = ["bwrap", "--unshare-all", "--ro-bind", "/", "/", sys.executable, "-S", "-c", ""]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=20, check=False)
    except OSError:
        return "bubblewrap is not installed"
    except subprocess.TimeoutExpired:
        return "bubblewrap does not answer"
    return f"bubblewrap may not make namespaces here: {done.stderr.strip()}" if done.returncode else ""


@pytest.fixture
def by_bubblewrap(monkeypatch: pytest.MonkeyPatch) -> Level:
    """Has level 2 be reached by bubblewrap, as on a machine that lets nobody else make namespaces."""
    reason = _reason_to_skip()
    if reason:
        pytest.skip(reason)
    monkeypatch.setattr(bubblewrap, "is_needed", lambda: True)
    return Level.SEPARATE


def test_no_attack_gets_anywhere(student: Student, tmp_path: Path, by_bubblewrap: Level) -> None:
    test_confinement.test_no_attack_gets_anywhere(student, tmp_path, by_bubblewrap)


def test_honest_work_goes_on(student: Student, by_bubblewrap: Level) -> None:
    test_confinement.test_honest_work_goes_on(student, by_bubblewrap)
    test_confinement.test_a_controller_runs_on_every_level(student, by_bubblewrap)


def test_every_package_but_ours_can_be_read(
    student: Student,
    library: Path,
    by_bubblewrap: Level,
) -> None:
    test_grants.test_every_package_but_ours_can_be_read(student, library, by_bubblewrap)


@pytest.mark.long
def test_every_failure_is_still_told(student: Student, by_bubblewrap: Level) -> None:
    test_confinement.test_every_failure_is_still_told(student, by_bubblewrap)


def test_it_is_alone_and_its_disk_is_small(student: Student, by_bubblewrap: Level) -> None:
    file = student(
        """
        import os
        def alone():
            return sum(map(os.path.exists, ("/etc/passwd", "/home", "/proc/1", "/bin/sh", "/dev/shm")))
        def fill():
            try:
                for i in range(100):
                    with open(f"file{i}", "wb") as out: out.write(bytes(2**20))
            except OSError as full:
                return full.errno
        def litter():
            for i in range(300): open(f"empty{i}", "w").close()
            while True: pass
        """
    )
    limits = dataclasses.replace(QUICK, scratch=8 << 20, files=200, reply_s=30)
    with StudentFunctions(file, limits=limits, level=by_bubblewrap) as functions:
        assert functions.call_batch("alone", [{}]) == [0.0]
        assert functions.call_batch("fill", [{}]) == [errno.ENOSPC]
        with pytest.raises(StudentCodeError) as caught:
            functions.call_batch("litter", [{}])
    assert caught.value.failure.kind is FailureKind.DISK


def test_nothing_is_left_of_it(student: Student, by_bubblewrap: Level) -> None:
    """Neither at its end nor when bubblewrap itself is killed."""
    temporary = Path(tempfile.gettempdir())
    before = {path.name for path in temporary.glob(f"{PREFIX}*")}
    functions = StudentFunctions(student("def f(): return 1"), limits=QUICK, level=by_bubblewrap)
    outermost = functions._process.pid
    inside = descendants(outermost)
    assert inside
    os.kill(outermost, signal.SIGKILL)
    wait_until(lambda: all(map(_is_dead, inside)), "the end of what bubblewrap has started")
    functions.close()
    left = {path.name for path in temporary.glob(f"{PREFIX}*-{os.getpid()}-*")} - before
    assert left == set()


def _is_dead(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] in ("Z", "X")
    except OSError:
        return True


def test_it_is_not_needed_where_namespaces_can_be_had() -> None:
    bubblewrap.is_needed.cache_clear()
    if is_level_available(Level.SEPARATE) and not bubblewrap.is_needed():
        return
    assert _reason_to_skip() or bubblewrap.is_needed(), "level 2 by bubblewrap, or none at all"


def test_it_is_needed_where_only_bubblewrap_may(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bubblewrap.shutil, "which", lambda name: f"/usr/bin/{name}")
    monkeypatch.setattr(bubblewrap, "_succeeds", lambda command: command[0].endswith("bwrap"))
    bubblewrap.is_needed.cache_clear()
    assert bubblewrap.is_needed()
    monkeypatch.setattr(bubblewrap, "_succeeds", lambda command: False)
    bubblewrap.is_needed.cache_clear()
    assert not bubblewrap.is_needed()
    monkeypatch.setattr(bubblewrap.shutil, "which", lambda name: None)
    bubblewrap.is_needed.cache_clear()
    assert not bubblewrap.is_needed()
    bubblewrap.is_needed.cache_clear()


def test_a_program_in_the_current_folder_is_not_taken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    mark = tmp_path / "mark"
    (tmp_path / bubblewrap.PROGRAM).write_text(f"#!/bin/sh\n: > '{mark}'\n")
    (tmp_path / bubblewrap.PROGRAM).chmod(0o755)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", f":{os.environ['PATH']}")
    monkeypatch.setattr(bubblewrap, "_succeeds", _ran)
    bubblewrap.is_needed.cache_clear()
    try:
        bubblewrap.is_needed()
    finally:
        bubblewrap.is_needed.cache_clear()
    assert not mark.exists()


def _ran(command: list[str]) -> bool:
    """Runs the command unless it is the trial of the system's own namespaces, which counts as failed."""
    if command[0] == sys.executable:
        return False
    return subprocess.run(command, capture_output=True, timeout=20, check=False).returncode == 0
