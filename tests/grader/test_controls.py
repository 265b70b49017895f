"""Each defence can be taken away, and its test then fails."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.cases import every_case
from tests.grader.attacks import FOURTH_ROUND, THIRD_ROUND, WORKED_ONCE
from tests.grader.conftest import LOCKS
from tests.grader.controls import CONTROLS, ROOT, Control, Seen, project_copy, see


def function_of(control: Control) -> str:
    """Returns the test without its parameters."""
    return control.test.partition("[")[0]


def test_each_takes_away_what_is_there_once() -> None:
    for control in CONTROLS:
        text = (ROOT / control.file).read_text("utf-8")
        assert text.count(control.defence) == 1, control.name
        file, _, function = function_of(control).partition("::")
        assert not function or f"\ndef {function}(" in (ROOT / "tests" / file).read_text("utf-8"), (
            control.name
        )


HOLDING = {
    **WORKED_ONCE,
    **{name: (*held, *others) for name, (held, others) in (THIRD_ROUND | FOURTH_ROUND).items()},
}
BY_MANY_SHEETS = frozenset(
    name for name in FOURTH_ROUND if name.startswith("the commands of a solution's drive")
)
"""Held by what each exercise asks for and by starts that move: no single defence can be taken away."""


@every_case("name", sorted(HOLDING.keys() - BY_MANY_SHEETS))
def test_what_worked_once_has_a_test_that_fails_without_its_defence(name: str) -> None:
    assert {function_of(control) for control in CONTROLS}.intersection(HOLDING[name])


@pytest.fixture(scope="module")
def folder() -> Iterator[Path]:
    with project_copy() as copied:
        yield copied


@LOCKS
@pytest.mark.nightly
@pytest.mark.long
@pytest.mark.parametrize("control", CONTROLS, ids=lambda control: control.name)
def test_its_test_fails_without_it(control: Control, folder: Path) -> None:
    assert see(control, folder) in (Seen.FAILS, Seen.SKIPPED)
