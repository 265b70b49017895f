"""Every row of the catalogue of attacks, at level 0 where that can hold and at level 1."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path

import pytest

from grader.reports import FORMATS
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import GradingVerdict
from tests.cases import every_case
from tests.grader.attack import TOKEN, Attack, attempt, works_undefended
from tests.grader.attacks import ATTACKS, FOURTH_ROUND, THIRD_ROUND, WITHSTOOD, WORKED_ONCE, table
from tests.grader.conftest import LOCKS
from tests.grader.further_attacks import FURTHER_ATTACKS
from tests.waiting import wait_until

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

ANNOTATION = re.compile(r"::(error|warning|notice) [^:]*::((?!::).)*")
"""A workflow command of the grader's own, in which no other begins."""


FURTHER = [
    pytest.param(attack, id=f"{attack.row}-{attack.name.replace(' ', '_')}", marks=LOCKS)
    for attack in FURTHER_ATTACKS
]

STARTED = frozenset({5, 6, 8, 9, 10, 29, 30, 31, 36, 39, 40, 44, 49})
"""Rows of what looks at what a process holds from its start: modules, memory, descriptors, environment."""


def _children(of: int) -> set[int]:
    """Student processes below this one; below 1: those that nobody is above any more, also of tests beside this one."""
    found = set()
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            fields = (entry / "stat").read_text().rpartition(")")[2].split()
            if int(fields[1]) == of and b"kit.host.child" in (entry / "cmdline").read_bytes():
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
    attack: Attack,
    level: Level,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    request: pytest.FixtureRequest,
) -> None:
    if attack.row in STARTED:
        request.getfixturevalue("cold_start")
    _gains_nothing(attack, level, tmp_path, monkeypatch)


def _gains_nothing(attack: Attack, level: Level, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GRADER_TOKEN", TOKEN)
    victim = tmp_path / "victim.txt"
    victim.write_text("untouched")
    before = {parent: _children(parent) for parent in (1, os.getpid())} if sys.platform == "linux" else {}
    outcome = attempt(attack, level, tmp_path)
    assert outcome.got == ""
    assert outcome.holds(attack, level), (outcome.points, outcome.status)
    if outcome.result is None:
        assert outcome.refused
    else:
        assert outcome.result.verdict is not GradingVerdict.BROKEN
        stopped = [test for test in outcome.result.tests if test.points < test.max_points]
        assert all(test.rationale for test in stopped), "what was lost is explained"
        for form in FORMATS:
            report = FORMATS[form].write(outcome.result)
            assert TOKEN not in report
            if form == "annotations":
                assert all(ANNOTATION.fullmatch(line) for line in report.splitlines()), report
            else:
                assert "::" not in report
            assert all(sign.isprintable() or sign == "\n" for sign in report)
    assert victim.read_text() == "untouched"
    assert {path.name for path in tmp_path.iterdir()} <= {
        *("victim.txt", "assignment", "handed", "handed.zip", "handed.tar", "workspace"),
    }
    if sys.platform == "linux":
        assert _children(os.getpid()) <= before[os.getpid()]
        wait_until(lambda: _children(1) <= before[1])


@pytest.mark.usefixtures("cold_start")
@pytest.mark.sampled(20)
@pytest.mark.parametrize("attack", FURTHER)
def test_nobody_gains_anything_in_other_ways(
    attack: Attack, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _gains_nothing(attack, Level.FILTERED, tmp_path, monkeypatch)


@pytest.mark.sampled(20)
@pytest.mark.parametrize("attack", FURTHER)
def test_where_the_defence_is_missing_it_works(
    attack: Attack, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """So the attacks are not clumsy."""
    monkeypatch.setenv("GRADER_TOKEN", TOKEN)
    assert works_undefended(attack, tmp_path) is True


def test_every_row_is_there() -> None:
    assert {attack.row for attack in ATTACKS} == set(range(1, 51))
    assert [attack.row for attack in FURTHER_ATTACKS] == list(range(51, 51 + len(FURTHER_ATTACKS)))
    names = [attack.name for attack in (*ATTACKS, *FURTHER_ATTACKS)]
    assert len(set(names)) == len(names)


HOLDING = {
    **WORKED_ONCE,
    **WITHSTOOD,
    **{name: (*held, *control) for name, (held, control) in (THIRD_ROUND | FOURTH_ROUND).items()},
}


@every_case("name", HOLDING)
def test_what_worked_once_has_tests_that_hold_it(name: str) -> None:
    for identity in HOLDING[name]:
        file, _, function = identity.partition("::")
        assert f"\ndef {function}(" in (Path(__file__).parents[1] / file).read_text(encoding="utf-8")


@LOCKS
def test_the_table_says_what_became_of_an_attack() -> None:
    head, row = table([Level.FILTERED], ["a link as the program"])
    assert head.split()[:3] == ["row", "attack", "kind"]
    assert "archive" in row
    assert "held (refused)" in row


@LOCKS
def test_without_a_cage_the_secrets_lie_open(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """So the attacks are not clumsy: what is said to need level 1 does work at level 0."""
    monkeypatch.setenv("GRADER_TOKEN", TOKEN)
    attack = next(attack for attack in ATTACKS if attack.row == 1)
    assert TOKEN in attempt(attack, Level.LIMITED, tmp_path).got
