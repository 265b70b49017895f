"""Each defence can be taken away, and its test then fails."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.grader.conftest import LOCKS
from tests.grader.controls import CONTROLS, ROOT, Control, Seen, see


def test_each_takes_away_what_is_there_once() -> None:
    for control in CONTROLS:
        text = (ROOT / control.file).read_text("utf-8")
        assert text.count(control.defence) == 1, control.name
        file, _, function = control.test.partition("::")
        assert not function or f"\ndef {function}(" in (ROOT / "tests" / file).read_text("utf-8"), (
            control.name
        )


@LOCKS
@pytest.mark.nightly
@pytest.mark.long
@pytest.mark.parametrize("control", CONTROLS, ids=lambda control: control.name)
def test_its_test_fails_without_it(control: Control, tmp_path: Path) -> None:
    assert see(control, tmp_path) in (Seen.FAILS, Seen.SKIPPED)
