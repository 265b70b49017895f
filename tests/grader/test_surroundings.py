"""Where and how the grader is started decides no grade: the same work earns the same in every environment."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any, Final

import pytest

from kit.host.sandbox.confinement import Level
from kit.host.sandbox.probe import highest_level_up_to
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
