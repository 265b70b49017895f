"""The goal to patrol: its targets in their order, and again."""

from __future__ import annotations

import pytest

from kit.learning.environment.episode_stats import EpisodeOutcome
from tests.learning.tasks.tasks_for_tests import AHEAD, HALL, achieved, drive, one_world


def test_a_patrol_reaches_its_targets_in_their_order() -> None:
    batch = one_world(
        HALL + "targets: [[0.625, 1.0], [0.625, 1.6], [0.625, 2.2]]}\n"
        "goal: {kind: patrol}\ntarget: {radius: 0.1, measured_to: axle}"
    )
    steps = drive(batch, AHEAD)
    shares = [achieved(step) for step in steps]
    assert sorted(set(shares)) == pytest.approx([0.0, 1 / 3, 2 / 3, 1.0])
    assert [step.transition.reached[0] for step in steps] == [False] * (len(steps) - 1) + [True]
    assert EpisodeOutcome.of(steps[-1].transition, 0) is EpisodeOutcome.REACHED
    aims = [tuple(step.transition.target[0].tolist()) for step in steps]
    assert list(dict.fromkeys(aims)) == [(0.625, 1.0), (0.625, 1.6), (0.625, 2.2)]
    progress = sum(float((step.transition.previous_to_go - step.transition.to_go)[0, 0]) for step in steps)
    assert progress == pytest.approx(2.2 - 0.5 - 0.1, abs=0.12)  # nothing is lost where the target changes
    assert sum(float(step.terms["achieving"][0]) for step in steps) == pytest.approx(1.0)


def test_a_patrol_of_two_rounds_comes_back_to_its_first_target() -> None:
    batch = one_world(
        HALL
        + "targets: [[0.625, 0.8], [0.625, 1.4]]}\ngoal: {kind: patrol, rounds: 2}\ntarget: {radius: 0.2}"
    )
    there = drive(batch, AHEAD, 16)
    back = drive(batch, [-1.0, 0.0], 16)
    again = drive(batch, AHEAD, 30)
    assert [achieved(steps[-1]) for steps in (there, back, again)] == pytest.approx([0.5, 0.75, 1.0])
