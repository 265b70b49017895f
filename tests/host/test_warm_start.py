"""Students' processes that are forked: the same as started ones, and none is lost with the interpreter that forks them."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import pytest

from grader.cli.check import _own_starts
from kit.host import program_start
from kit.host.program_start import start_cold, started_by
from kit.host.sandbox.sandbox_config import Level
from kit.host.student_functions import StudentFunctions
from kit.host.warm_start import ForkedProcess, WarmInterpreter, is_possible

pytestmark = pytest.mark.skipif(not is_possible(), reason="no process can be forked beside another here")

SEEN = """
import os, sys

def seen(known):
    return [
        sorted(set(sys.modules) - set(known)),
        [f"{key}={value}" for key, value in sorted(os.environ.items()) if key not in ("HOME", "TMPDIR")],
        sorted(os.listdir("/proc/self/fd")),
        os.getcwd() == os.environ["HOME"],
    ]

def loaded():
    return sorted(sys.modules)

def ancestors():
    with open(f"/proc/{os.getppid()}/stat") as stat:
        return [float(stat.read().rpartition(")")[2].split()[1])]
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    made = tmp_path / "seen.py"
    made.write_text(SEEN)
    return made


def test_what_is_forked_is_as_if_it_had_been_started(file: Path) -> None:
    with started_by(start_cold), StudentFunctions(file, level=Level.LIMITED) as cold:
        assert not isinstance(cold._process._process, ForkedProcess)
        known = cold.call_json("loaded", {})
        expected = cold.call_json("seen", {"known": known})
    with (
        WarmInterpreter() as interpreter,
        started_by(interpreter.start),
        StudentFunctions(file, level=Level.LIMITED) as warm,
    ):
        assert isinstance(warm._process._process, ForkedProcess)
        found: Any = warm.call_json("seen", {"known": known})
        assert warm.call_json("ancestors", {}) == [float(os.getpid())]
    assert isinstance(expected, list)
    assert found[1:] == expected[1:]
    assert {each.partition(".")[0] for each in found[0]} <= {"kit", *sys.stdlib_module_names}


def test_without_its_interpreter_a_process_is_started_after_all(file: Path) -> None:
    with WarmInterpreter() as interpreter, started_by(interpreter.start):
        interpreter._process.kill()
        interpreter._process.wait()
        with StudentFunctions(file, level=Level.LIMITED) as functions:
            assert not isinstance(functions._process._process, ForkedProcess)
            assert functions.names


@pytest.mark.parametrize(
    ("name", "level", "for_student", "is_warm"),
    [
        ("mine.py", "0", True, True),
        ("mine.py", "1", True, False),
        ("mine.py", None, True, False),
        ("mine.py", "0", False, False),
        ("mine.yaml", "0", True, False),
    ],
)
def test_only_the_check_of_ones_own_program_forks(
    name: str, level: str | None, for_student: bool, is_warm: bool
) -> None:
    before = program_start.STARTS[-1]
    with _own_starts(Path(name), level, for_student=for_student):
        assert (program_start.STARTS[-1] is not before) == is_warm
    assert program_start.STARTS[-1] is before
