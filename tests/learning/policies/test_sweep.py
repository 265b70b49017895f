"""Sweeps of disturbances: what is tested, kept, resumed, and shown."""

from __future__ import annotations

import csv
import io
import json
from dataclasses import replace
from pathlib import Path

import pytest

from kit.document.layout import lines_of
from kit.learning.policies.confidence_intervals import wilson_interval
from kit.learning.policies.evaluation import Evaluator
from kit.learning.policies.policy import Policy
from kit.learning.policies.sweep import PolicySweep, SweepPoint, find_kinds, sweep_blocks, sweep_csv
from kit.learning.tasks.disturbances import DISTURBANCE_KINDS, DisturbanceError, Disturbances
from kit.learning.tasks.learning_task import StartVariation
from kit.render.encode import ENCODERS
from tests.learning.policies.test_evaluation import FORWARD, STRAIGHT

AHEAD = replace(STRAIGHT.resolve(), start=StartVariation(shifted=False))
DRIFT = find_kinds(["drift"])


def sweep(journal: Path | None = None, episodes: int = 20, policy: Policy = FORWARD) -> PolicySweep:
    return PolicySweep(policy, AHEAD, DRIFT, episodes=episodes, seed=1, journal=journal)


def test_a_robot_that_only_drives_ahead_fails_as_it_drifts() -> None:
    points = {point.value: point for point in sweep(episodes=5).points()}
    assert list(points) == list(DRIFT[0].sweep)
    assert points[0.0].share == 1.0
    for value in (DRIFT[0].sweep[0], DRIFT[0].sweep[-1]):
        assert points[value].share == 0.0
        assert points[value].collided == points[value].episodes == 10
    assert points[0.0].interval == wilson_interval(10, 10)


@pytest.mark.long
def test_one_kind_changes_and_the_tasks_own_disturbances_stay() -> None:
    slowed = replace(AHEAD, disturbances=Disturbances.from_dict({"wheel_radius": -0.9, "drift": 0.3}))
    points = PolicySweep(FORWARD, slowed, DRIFT, episodes=5, seed=1).points()
    assert all(
        point.reached == 0 for point in points
    )  # at a tenth of its speed it does not get there in time


@pytest.mark.long
def test_what_has_been_tested_is_kept_and_taken_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    journal = tmp_path / "sweep.jsonl"
    started = sweep(journal).points()
    first = [next(started) for _ in range(3)]
    started.close()
    with journal.open("a") as file:
        file.write('{"key": "half a li')  # killed while it wrote
    tested = []
    evaluate = Evaluator.test

    def counted(self: Evaluator, *arguments: object, **options: object) -> object:
        tested.append(self.task.disturbances)
        return evaluate(self, *arguments, **options)  # type: ignore[arg-type]  # handed on as they are

    monkeypatch.setattr(Evaluator, "test", counted)
    whole = list(sweep(journal).points())
    assert whole[:3] == first
    assert len(tested) == len(whole) - 3
    assert list(sweep(journal).points()) == whole
    count = len(tested)
    assert count == len(whole) - 3, "what was tested after the half line is kept too"
    assert list(sweep(journal, episodes=21).points()) != whole
    assert len(tested) == count + len(whole), "other settings are another sweep"


def test_a_chart_and_figures_for_each_kind() -> None:
    points = [
        SweepPoint("latency", value, reached, 10 - reached, 0, "a", 0.5)
        for value, reached in ((0, 10), (0.5, 3))
    ]
    lines = lines_of(sweep_blocks(points, ENCODERS["braille"](True), columns=70))
    assert max(map(len, lines)) <= 80
    assert any("latency [s]" in line for line in lines)
    assert any("0.300" in line and "0.108 to 0.603" in line for line in lines)


@pytest.mark.long
def test_tables_for_other_programs() -> None:
    points = list(sweep(episodes=5).points())
    rows = list(csv.DictReader(io.StringIO(sweep_csv(points))))
    assert [float(row["value"]) for row in rows] == list(DRIFT[0].sweep)
    assert {row["kind"] for row in rows} == {"drift"}
    data = json.loads(json.dumps([point.as_dict() for point in points]))
    assert [each["share"] for each in data] == [float(row["share"]) for row in rows]
    assert all(float(row["low"]) <= float(row["share"]) <= float(row["high"]) for row in rows)


def test_kinds_are_found_by_name() -> None:
    assert find_kinds([]) == DISTURBANCE_KINDS
    assert [kind.name for kind in find_kinds(["wheel-radius", "lidar_noise"])] == [
        "lidar_noise",
        "wheel_radius",
    ]
    with pytest.raises(DisturbanceError, match="latency"):
        find_kinds(["latncy"])


def test_the_journal_tells_apart_tasks_that_differ_in_a_record_of_theirs(tmp_path: Path) -> None:
    journal = tmp_path / "sweep.jsonl"
    for start in (StartVariation(), StartVariation(noise=0.01), StartVariation()):
        next(
            PolicySweep(
                FORWARD, replace(AHEAD, start=start), DRIFT, episodes=2, seed=1, journal=journal
            ).points()
        )
    assert len({json.loads(line)["key"] for line in journal.read_text().splitlines()}) == 2
