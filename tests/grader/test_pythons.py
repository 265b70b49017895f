"""The same points wherever a class is graded: at every confinement level, by every Python, one by one and at once, in a
checkout and from a wheel. ``python -m tests.grader.points`` does it with all works."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.host.sandbox.sandbox_config import Level
from tests.grader.conftest import LOCKS
from tests.grader.points import (
    PointsGrader,
    all_settings,
    all_works,
    differences,
    find_pythons,
    reference_setting,
    sample_works,
)


def test_the_sample_is_thirty_works_of_six_kinds() -> None:
    works = sample_works()
    assert len({(work.exercise, work.name) for work in works}) == 30
    assert {work.name for work in works if not work.name.startswith("wrong")} == {"solution"}
    assert set(works) <= set(all_works())
    assert len(all_works()) > 200


def test_a_difference_is_told() -> None:
    table = {"a": [1.0, {"runs": 1.0}, {"runs": "pass"}]}
    assert list(differences(table, dict(table))) == []
    assert len(list(differences(table, {"a": [1.0, {"runs": 1.0}, {"runs": "fail"}]}))) == 1
    assert len(list(differences(table, {}))) == 1


@pytest.mark.nightly
@pytest.mark.timeout(3600)
@LOCKS
def test_levels_pythons_jobs_and_installs_do_not_change_points(tmp_path: Path) -> None:
    pythons, works = find_pythons(), sample_works()
    settings = all_settings(pythons)
    assert settings[0] == reference_setting()
    assert {setting.level for setting in settings} >= {Level.LIMITED, Level.FILTERED}
    grader = PointsGrader(tmp_path, pythons)
    first = grader.grade(works, settings[0])
    assert len(first) == len(works)
    assert len({points for points, _, _ in first.values()}) >= 4, "good, middling and bad ones"
    for setting in settings[1:]:
        assert list(differences(first, grader.grade(works, setting))) == [], str(setting)
    if len(pythons) == 1:
        pytest.skip(f"only Python {next(iter(pythons))} is here with what the grader needs; the rest agrees")
