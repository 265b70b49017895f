"""Where and how the grader is started decides no grade: the same work earns the same in every environment."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any, Final

import pytest

from kit.host.sandbox.probe import highest_level_up_to
from kit.host.sandbox.sandbox_config import Level
from tests.grader.conftest import FORWARD, write_assignment

ROOT: Final = Path(__file__).parents[2]

SURROUNDINGS: Final[dict[str, dict[str, str]]] = {
    "a relative folder for temporary files": {"TMPDIR": "."},
    "a folder for temporary files that is not there": {"TMPDIR": "/nonexistent"},
    "no home": {"HOME": "/nonexistent"},
    "kernels that shall not be compiled": {"NUMBA_DISABLE_JIT": "1"},
    "a cache that cannot be written": {"NUMBA_CACHE_DIR": "/proc/1"},
    "assertions taken out": {"PYTHONOPTIMIZE": "2"},
    "warnings as errors": {"PYTHONWARNINGS": "error"},
    "other hashes": {"PYTHONHASHSEED": "77"},
    "plain ASCII": {
        "LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0", "PYTHONIOENCODING": "ascii",
    },
    "a time zone that is a file": {"TZ": ":/etc/passwd"},
    "threads that are no number": {"OMP_NUM_THREADS": "many"},
}  # fmt: skip


def checked(folder: Path, before: str, environment: dict[str, str]) -> dict[str, Any]:
    """What `grader check` says of a work. ``before``: shell commands that its process runs first."""
    task, work, result = folder / "task", folder / "forward.py", folder / "result.json"
    write_assignment(task)
    work.write_text(FORWARD)
    level = int(highest_level_up_to(Level.FILTERED))
    command = f"{before}; exec {sys.executable} -P -m grader check {work} --assignment {task} --level {level}"
    subprocess.run(
        ["sh", "-c", f"{command} --json --output {result}"],
        env={**os.environ, "PYTHONPATH": str(ROOT), **environment},
        cwd=folder,
        stdin=subprocess.DEVNULL,
        check=False,
        timeout=100,
    )
    content: dict[str, Any] = json.loads(result.read_bytes())
    return content


def verdict(result: dict[str, Any]) -> tuple[Any, ...]:
    return result["verdict"], result["points"], [(each["id"], each["status"]) for each in result["tests"]]


FORWARD_VERDICT: Final = ("fail", 3.0, [("runs", "pass"), ("moves", "pass"), ("reached", "fail")])


@pytest.mark.long
@pytest.mark.parametrize("name", SURROUNDINGS)
def test_no_environment_decides_a_grade(name: str, tmp_path: Path) -> None:
    assert verdict(checked(tmp_path, "true", SURROUNDINGS[name])) == FORWARD_VERDICT


@pytest.mark.long
@pytest.mark.parametrize(
    "before", ["umask 000", "exec <&-", "exec >&-", "ulimit -n 64", "ulimit -c unlimited"]
)
def test_nothing_that_a_process_inherits_decides_a_grade(before: str, tmp_path: Path) -> None:
    assert verdict(checked(tmp_path, before, {})) == FORWARD_VERDICT


JUMPING: Final = """
import datetime, random, time

def jumping(told, unit):
    return lambda: told() + random.choice((-1, 1)) * 864_000 * unit

time.time, time.time_ns = jumping(time.time, 1), jumping(time.time_ns, 10**9)

class Date(datetime.datetime):
    @classmethod
    def now(cls, tz=None):
        return datetime.datetime.fromtimestamp(time.time(), tz)

datetime.datetime = Date
"""
"""A machine whose date jumps by ten days whenever it is asked for."""


@pytest.mark.long
def test_a_clock_that_jumps_decides_no_grade(tmp_path: Path) -> None:
    (tmp_path / "sitecustomize.py").write_text(JUMPING)
    path = os.pathsep.join((str(tmp_path), str(ROOT)))
    asked = f"import time; assert abs(time.time() - {time.time()}) > 86_400"
    subprocess.run([sys.executable, "-c", asked], env={**os.environ, "PYTHONPATH": path}, check=True)
    assert verdict(checked(tmp_path, "true", {"PYTHONPATH": path})) == FORWARD_VERDICT


@pytest.mark.long
def test_no_git_is_run_in_a_students_checkout(tmp_path: Path) -> None:
    """A repository's settings name programs that git runs."""
    marker, programs = tmp_path / "git was run", tmp_path / "programs"
    programs.mkdir()
    (programs / "git").write_text(f"#!/bin/sh\ntouch '{marker}'\n")
    (programs / "git").chmod(0o755)
    path = os.pathsep.join((str(programs), os.environ["PATH"]))
    assert verdict(checked(tmp_path, "mkdir -p .git", {"PATH": path})) == FORWARD_VERDICT
    assert not marker.exists()
    subprocess.run(["git", "status"], env={**os.environ, "PATH": path}, check=True)
    assert marker.exists()
