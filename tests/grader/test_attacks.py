"""Every row of the catalogue of attacks, at level 0 where that can hold and at level 1."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from grader.reports import FORMATS
from kit.host.sandbox.confinement import Level
from kit.school.result import GradingVerdict
from tests.grader.attacks import ATTACKS, TOKEN, Attack, attempt
from tests.grader.conftest import LOCKS

CASES = [
    pytest.param(
        attack,
        Level(level),
        id=f"L{level}-{attack.row}-{attack.name.replace(' ', '_')}",
        marks=[LOCKS] * level,
    )
    for attack in ATTACKS
    for level in ((1,) if attack.least else (0, 1))
]


def _children() -> set[int]:
    """Processes below this one, and those that nobody is above any more."""
    found = set()
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            fields = (entry / "stat").read_text().rpartition(")")[2].split()
            if int(fields[1]) in (1, os.getpid()) and b"bootstrap.py" in (entry / "cmdline").read_bytes():
                found.add(int(entry.name))
        except OSError:
            continue
    return found


@pytest.mark.long_cases(
    "L0-16-never_come_back_while_loading",
    "L0-17-ignore_signals",
    "L0-18-sleep_without_using_time",
    "L1-16-never_come_back_while_loading",
    "L1-17-ignore_signals",
    "L1-18-sleep_without_using_time",
)
@pytest.mark.parametrize(("attack", "level"), CASES)
def test_nobody_gains_anything(
    attack: Attack, level: Level, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("GRADER_TOKEN", TOKEN)
    victim = tmp_path / "victim.txt"
    victim.write_text("untouched")
    before = _children() if sys.platform == "linux" else set()
    outcome = attempt(attack, level, tmp_path)
    assert outcome.got == ""
    assert (outcome.points, outcome.status) == (attack.end.points, attack.end.status)
    if outcome.result is None:
        assert outcome.refused
    else:
        assert outcome.result.verdict is not GradingVerdict.BROKEN
        stopped = [test for test in outcome.result.tests if test.points < test.max_points]
        assert all(test.rationale for test in stopped), "what was lost is explained"
        for form in FORMATS:
            report = FORMATS[form](outcome.result)
            assert TOKEN not in report
            assert "::" not in report
            assert all(sign.isprintable() or sign == "\n" for sign in report)
    assert victim.read_text() == "untouched"
    assert {path.name for path in tmp_path.iterdir()} <= {
        *("victim.txt", "assignment", "handed", "handed.zip", "handed.tar", "workspace"),
    }
    if sys.platform == "linux":
        assert _children() - before == set()


def test_every_row_is_there() -> None:
    assert {attack.row for attack in ATTACKS} == set(range(1, 51))


@LOCKS
def test_without_a_cage_the_secrets_lie_open(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """So the attacks are not clumsy: what is said to need level 1 does work at level 0."""
    monkeypatch.setenv("GRADER_TOKEN", TOKEN)
    attack = next(attack for attack in ATTACKS if attack.row == 1)
    assert TOKEN in attempt(attack, Level.LIMITED, tmp_path).got
