"""The starts of a race: the own one is the level's, the others differ from it and from each other, and are told by the seed."""

from __future__ import annotations

import math
from random import Random

import pytest

from kit.run.recording import rerun
from kit.school.game.levels import GameLevel
from kit.school.game.race import RaceFinish, judge_recording, middle_drive
from kit.school.game.starts import (
    MAX_PAIR,
    OWN_SEED,
    SHIFT_M,
    SHIFT_RAD,
    STARTS,
    are_drawn,
    draw_seeds,
    scenario_from,
)
from kit.sim.simulation import Simulation
from tests.kit_content import kit_levels
from tests.school.game.measured_drivers import drive

LEVELS = [pytest.param(each, id=each.id) for each in kit_levels()]


@pytest.mark.sampled(8)
@pytest.mark.parametrize("level", LEVELS)
def test_starts_differ_by_little_and_are_free(level: GameLevel) -> None:
    own = level.find_scenario()
    assert scenario_from(level, OWN_SEED).starts == own.starts
    middles = set()
    for seed in draw_seeds(level, Random(7))[1:]:
        scenario = scenario_from(level, seed)
        assert scenario.starts == scenario_from(level, seed).starts
        for before, after in zip(own.starts, scenario.starts, strict=True):
            assert SHIFT_RAD[0] <= abs(after.theta - before.theta) <= SHIFT_RAD[1]
        shift = [
            sum(getattr(pose, axis) for pose in scenario.starts) / len(own.starts)
            - sum(getattr(pose, axis) for pose in own.starts) / len(own.starts)
            for axis in "xy"
        ]
        assert all(SHIFT_M[0] - 1e-9 <= abs(each) <= SHIFT_M[1] + 1e-9 for each in shift)
        middles.add((round(shift[0], 6), round(shift[1], 6)))
        simulation = Simulation(scenario.world, seed=seed, has_subscribers=lambda topic: False)
        simulation.step()
        assert not any(simulation.is_touching(name) for name in scenario.partners)
    assert len(middles) == STARTS - 1, "every start is another"


def test_two_and_two_starts_lie_on_opposite_sides_of_the_own_one() -> None:
    level = kit_levels()[0]
    (own,) = level.find_scenario().starts
    for pair in (1, 12, MAX_PAIR):
        (one,), (other,) = (scenario_from(level, 2 * pair + side).starts for side in (0, 1))
        middle = [(getattr(one, axis) + getattr(other, axis)) / 2 for axis in ("x", "y", "theta")]
        assert middle == pytest.approx([own.x, own.y, own.theta])


def test_starts_are_drawn_by_the_generator_alone() -> None:
    level = kit_levels()[0]
    assert draw_seeds(level, Random(1)) == draw_seeds(level, Random(1)) != draw_seeds(level, Random(2))


@pytest.mark.parametrize(
    ("seeds", "drawn"),
    [
        ((1, 4, 5, 8, 9), True),
        ((1, 4, 5, 4, 5), False),
        ((1, 4, 6, 8, 10), False),
        ((1, 5, 6, 9, 10), False),
        ((1, 4, 5), False),
        ((2, 4, 5, 8, 9), False),
        ((1,), False),
        ((), False),
    ],
)
def test_what_can_have_been_drawn(seeds: tuple[int, ...], drawn: bool) -> None:
    assert are_drawn(kit_levels()[0], seeds) is drawn


def test_traffic_is_elsewhere_at_every_start() -> None:
    level = next(each for each in kit_levels() if each.id == "crossing")
    places = set()
    for seed in draw_seeds(level, Random(7)):
        simulation = Simulation(
            scenario_from(level, seed).world, seed=seed, has_subscribers=lambda topic: False
        )
        simulation.step()
        places.add(round(simulation.pose("lorry").x, 3))
    assert len(places) == STARTS


def test_a_drive_from_another_start_runs_again_to_the_bit() -> None:
    level = next(each for each in kit_levels() if each.id == "crossing")
    finish, recording = drive(level, 12, lambda session: None)
    assert recording.seed == 12
    again = rerun(recording, scenario_from(level, recording.seed).world)
    assert again.poses.tobytes() == recording.poses.tobytes()
    assert judge_recording(level, recording).seconds == pytest.approx(finish.seconds)


def test_a_seed_of_no_start_is_refused() -> None:
    level = kit_levels()[0]
    with pytest.raises(ValueError, match="seed"):
        scenario_from(level, 2 * MAX_PAIR + 2)


@pytest.mark.parametrize(
    ("finishes", "counts"),
    [
        ([(True, 9.0, 0), (True, 7.0, 0), (True, 8.0, 0), (True, 6.0, 0), (True, 5.0, 0)], 1),
        ([(True, 9.0, 0), (False, 1.0, 0), (False, 1.0, 0), (False, 1.0, 0), (True, 5.0, 0)], None),
        ([(True, 9.0, 0), (False, 1.0, 0), (False, 1.0, 0), (True, 8.0, 0), (True, 5.0, 0)], 0),
        ([(True, 9.0, 0), (True, 1.0, 1), (True, 1.0, 1), (True, 8.0, 0), (True, 5.0, 0)], 0),
        ([(True, 4.0, 0)], 0),
    ],
)
def test_the_middle_drive_counts(finishes: list[tuple[bool, float, int]], counts: int | None) -> None:
    found = [RaceFinish(*each) for each in finishes]
    middle = middle_drive(found)
    if counts is None:
        assert not found[middle].reached, "three of five have to arrive"
    else:
        assert middle == counts
    assert math.isfinite(found[middle].seconds)
