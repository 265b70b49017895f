"""The confinement level is decided before a submission runs, and nothing that it says changes it."""

from __future__ import annotations

from pathlib import Path

import pytest

from grader.grading import GradingOptions, grade
from grader.grading_level import LevelUnavailable
from grader.reading import read_assignment
from grader.submission import Submission
from kit.host.sandbox import probe
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import CriterionStatus, GradingResult, GradingVerdict
from tests.grader.conftest import FORWARD, LOCKS, QUICK, write_assignment

REFUSING = """
import json, os, stat, struct

def say(content):
    data = json.dumps(content).encode()
    for fd in range(3, 64):
        try:
            if stat.S_ISSOCK(os.fstat(fd).st_mode): os.write(fd, struct.pack(">I", len(data)) + data)
        except OSError: pass

try: print("GOT", open("/etc/passwd").readline())
except OSError: say(["refused", "no Landlock here"])
while True: os.sched_yield()
"""
"""Says, as if it were the machine, that it cannot be locked in; and steals, where it then is not."""

ASSIGNMENTS = {
    "controller": QUICK,
    "reward": """
title: Pay
kind: reward
submit: controller.py
grid: {discount: 0.95, max_steps: 40, map: "#####\\n#...#\\n#..G#\\n#####"}
checks: [{check: contract, points: 1}]
""",
    "function": """
title: Halve
kind: function
submit: controller.py
functions: [{name: half}]
checks: [{check: agrees, points: 1}]
""",
}

REFERENCE = """
def half(x): return x / 2
def half_cases(random): yield {"x": random.random()}
"""


def graded(folder: Path, kind: str, level: Level, source: str, terms: GradingOptions) -> GradingResult:
    sheet = ASSIGNMENTS[kind].replace("level: 0", "").rstrip() + f"\nlevel: {int(level)}\n"
    write_assignment(folder, sheet)
    (folder / "reference.py").write_text(REFERENCE)
    return grade(
        read_assignment(folder), Submission("ada", "controller.py", {"controller.py": source.encode()}), terms
    )


@pytest.mark.sampled(3)
@LOCKS
@pytest.mark.parametrize("kind", ASSIGNMENTS)
@pytest.mark.parametrize("may_lower_level", [True, False])
def test_a_program_that_blames_the_machine_is_confined_and_fails(
    tmp_path: Path, kind: str, may_lower_level: bool
) -> None:
    source = REFUSING + "\ndef reward(reached): return 1.0\n"
    result = graded(tmp_path, kind, Level.FILTERED, source, GradingOptions(may_lower_level=may_lower_level))
    assert (result.level, result.verdict, result.points) == (1, GradingVerdict.FAIL, 0.0)
    assert result.tests[0].status is CriterionStatus.PROTOCOL_ERROR
    assert not any("GOT" in test.log + test.rationale for test in result.tests)


@LOCKS
def test_practice_falls_loudly(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(probe, "_known_levels", set())
    monkeypatch.setattr(probe, "is_level_available", lambda level: level <= Level.FILTERED)
    result = graded(tmp_path, "controller", Level.SEPARATE, FORWARD, GradingOptions())
    assert result.level == 1
    assert any("level 1" in notice and "level 2" in notice for notice in result.notices)
    assert "WARNING: This machine does not reach confinement level 2" in capsys.readouterr().err


@pytest.mark.usefixtures("no_level_1")
@pytest.mark.parametrize(
    "terms",
    [GradingOptions(secret=True), GradingOptions(Level.FILTERED), GradingOptions(may_lower_level=False)],
    ids=["secret", "asked", "class"],
)
def test_a_grade_never_falls(tmp_path: Path, terms: GradingOptions) -> None:
    with pytest.raises(LevelUnavailable, match="does not reach confinement level 1"):
        graded(tmp_path, "controller", Level.FILTERED, FORWARD, terms)


@pytest.mark.usefixtures("no_level_1")
@pytest.mark.parametrize("asked_by_sheet", Level)
def test_nothing_falls_to_level_0(tmp_path: Path, asked_by_sheet: Level) -> None:
    with pytest.raises(LevelUnavailable, match="use --level 0"):
        graded(tmp_path, "controller", asked_by_sheet, FORWARD, GradingOptions())
    assert graded(tmp_path, "controller", asked_by_sheet, FORWARD, GradingOptions(Level.LIMITED)).level == 0


@LOCKS
def test_the_highest_level_up_to_one(monkeypatch: pytest.MonkeyPatch) -> None:
    tried: list[Level] = []

    def is_level_available(level: Level) -> bool:
        tried.append(level)
        return level <= Level.FILTERED

    monkeypatch.setattr(probe, "_known_levels", set())
    monkeypatch.setattr(probe, "is_level_available", is_level_available)
    assert [probe.highest_level_up_to(level) for level in Level] == [0, 1, 1, 1]
    assert tried == [Level.FILTERED, Level.SEPARATE, Level.ANOTHER_USER, Level.SEPARATE]
