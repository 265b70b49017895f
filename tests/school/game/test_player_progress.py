"""Who earns what: the reference is a master on every level, a tape of its commands nothing, and everybody else has a rung in reach."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from kit.geometry import Pose, wrap_angle
from kit.msg.nav_msgs import Odometry
from kit.plain_text import wrap
from kit.ros.node.node import create_graph_node
from kit.run.session import Session
from kit.school.game.levels import GameLevel, all_worlds, find_level
from kit.school.game.medal import RUNGS, SHARES, Medal, medal_of, medal_time, rung_in_reach
from kit.school.game.player_progress import BELTS, LevelProgress, belt_of
from kit.school.game.race import DriverKind, RaceFinish, judge_recording, run_race
from kit.school.game.references import drive_reference, load_drives, reference_seconds
from kit.school.lessons.reading import lesson_names
from tests.kit_content import kit_levels
from tests.school.game.measured_drivers import DRIVERS, best_keys_drive, judged, measured, tape_drives
from tests.school.game.ordinary import targets_of
from tests.school.game.tidy import TidyDriver

LEVELS = kit_levels()
TIDY_LEVELS = [each for each in LEVELS if each.goal.has_standing_targets]
"""Where there is a way to follow."""


@cache
def tidy_finish(level: GameLevel) -> RaceFinish:
    targets = targets_of(level)
    finish, _ = run_race(
        level,
        level.find_scenario(),
        lambda session: session.runner.participants.append(TidyDriver(session, targets)),
    )
    return finish


def tidy_medal(level: GameLevel) -> Medal:
    return medal_of(tidy_finish(level), reference_seconds(level))


def test_every_level_has_a_reference_a_world_and_a_lesson() -> None:
    assert len(LEVELS) >= 30
    assert set(load_drives()) == {level.id for level in LEVELS}
    assert {level.world for level in LEVELS} == {world.id for world in all_worlds()}
    assert {level.opened_by_lesson for level in LEVELS} == set(lesson_names()), "each lesson opens a level"
    for level in LEVELS:
        assert level.id == level.title.lower().replace(" ", "-"), "the name to type is the one in the list"
        for text in (level.skill, level.hint):
            assert text
            assert len(text) <= 73, "it stands on one row of a small screen"
        for text in (level.story, level.ending):
            assert text
            assert len(wrap(text, 78 - len(level.title))) <= 2, "it stands beside the title on a small screen"


@pytest.mark.parametrize("driver", DriverKind)
def test_the_rung_in_reach_is_what_a_drive_earns_that_ends_now(driver: DriverKind) -> None:
    for seconds in np.arange(9.0, 25.0, 0.37):
        for collisions in (0, 1):
            finish = RaceFinish(True, float(seconds), collisions)
            earned = medal_of(finish, 10.0, driver)
            assert (rung_in_reach(driver, 10.0, float(seconds), collisions) or Medal.NONE) is earned


@pytest.mark.sampled(8)
@pytest.mark.parametrize("level", [pytest.param(each, id=each.id) for each in LEVELS])
def test_the_reference_drive_is_a_masters(level: GameLevel) -> None:
    finish, recording = drive_reference(level)
    assert finish.seconds == pytest.approx(load_drives()[level.id].seconds, abs=0.02)
    assert medal_of(finish, reference_seconds(level)) is Medal.MASTER
    assert judge_recording(level, recording) == replace(finish, failure=None, sensors=None)


@pytest.mark.sampled(3)
@pytest.mark.parametrize("level", [pytest.param(each, id=each.id) for each in LEVELS])
def test_a_tape_of_the_reference_drive_earns_bronze_at_most(level: GameLevel) -> None:
    """What is right for one start is wrong for four others. Nobody waits for those that come too late for silver."""
    bar = SHARES[DriverKind.PROGRAM][Medal.SILVER] * reference_seconds(level)
    _, medal = judged(level, DriverKind.PROGRAM, tape_drives(replace(level, time_limit=bar)))
    assert medal <= Medal.BRONZE


@pytest.mark.sampled(4)
@pytest.mark.parametrize("level", [pytest.param(each, id=each.id) for each in LEVELS])
def test_ordinary_skill_at_the_keys_has_a_rung_in_reach_and_is_no_master(level: GameLevel) -> None:
    """But for a leader that is to be followed for a given time, which everybody needs who keeps with it."""
    finish, medal = judged(level, DriverKind.HAND, [best_keys_drive(level)])
    assert medal >= Medal.BRONZE
    assert finish.seconds == pytest.approx(measured()[level.id, "keys"].seconds, abs=0.02), "measure it again"
    assert medal < Medal.MASTER or level.leader


def test_no_driver_has_gold_everywhere_and_every_level_has_a_rung_in_reach() -> None:
    """Of what was measured on every level; a tape is not measured to win."""
    drives = measured()
    assert set(drives) == {(level.id, driver) for level in LEVELS for driver in DRIVERS}
    medals = {driver: [drives[level.id, driver].medal(level) for level in LEVELS] for driver in DRIVERS}
    assert max(medals.pop("tape")) <= Medal.BRONZE
    for driver, won in medals.items():
        assert sum(medal >= Medal.GOLD for medal in won) <= len(LEVELS) / 2, driver
        assert {Medal.BRONZE, Medal.SILVER} <= set(won), driver
    assert {Medal.NONE, Medal.BRONZE, Medal.SILVER, Medal.GOLD} <= set(medals["laser"])
    for level in LEVELS:
        won = {driver: drives[level.id, driver].medal(level) for driver in medals}
        assert won["keys"] >= Medal.BRONZE, level.id
        assert max(won["laser"], won["map"]) >= Medal.BRONZE, level.id
        assert won["agent"] >= Medal.BRONZE, level.id
        assert min(won.values()) < Medal.GOLD, level.id


NEEDS_MORE_THAN_TIDINESS = (
    ("crossing", "rush-hour", "corridor-traffic"),  # what moves
    ("black-ice", "frozen-slalom"),  # braking
    ("low-battery", "the-long-night"),  # docking
    ("lights-out",),  # exploring
)


@pytest.mark.long
@pytest.mark.parametrize(
    "level",
    [find_level(name) for names in NEEDS_MORE_THAN_TIDINESS for name in names],
    ids=lambda each: each.id,
)
def test_a_tidy_driver_without_the_skill_of_a_level_fails_it(level: GameLevel) -> None:
    assert tidy_medal(level) <= Medal.BRONZE
    assert tidy_finish(level).collisions or not tidy_finish(level).reached


class OdometryDriver(TidyDriver):
    """The tidy driver, but it believes the odometry, from the place on where it knows that it stands."""

    def __init__(self, session: Session, targets: Sequence[tuple[float, float]]) -> None:
        super().__init__(session, targets)
        self._start = self._believed = super()._pose()
        self._first: Pose | None = None
        node = create_graph_node(session.graph, "odometry_driver")
        for end in session.runner.simulation.model_endpoints(session.scenario.partners[0]):
            if end.direction == "publish" and end.type is Odometry and not end.is_ground_truth:
                node.create_subscription(Odometry, end.topic, self._hear, 10)

    def _hear(self, message: Odometry) -> None:
        place, turn = message.pose.pose.position, message.pose.pose.orientation
        odometry = Pose(place.x, place.y, 2.0 * math.atan2(turn.z, turn.w))
        self._first = self._first or odometry
        turned = self._start.theta - self._first.theta
        x, y = odometry.x - self._first.x, odometry.y - self._first.y
        self._believed = Pose(
            self._start.x + math.cos(turned) * x - math.sin(turned) * y,
            self._start.y + math.sin(turned) * x + math.cos(turned) * y,
            wrap_angle(odometry.theta + turned),
        )

    def _pose(self) -> Pose:
        return self._believed


@pytest.mark.long
def test_who_believes_wheels_that_lie_gets_lost() -> None:
    """Where the wheels are true the same driver arrives."""
    lying = find_level("wheels-that-lie")
    true = replace(lying, conditions=replace(lying.conditions, wheel_error=0.0))
    finishes = [
        run_race(
            level,
            level.find_scenario(),
            lambda session, level=level: session.runner.participants.append(  # type: ignore[misc]  # mypy on lambdas
                OdometryDriver(session, targets_of(level))
            ),
        )[0]
        for level in (lying, true)
    ]
    assert [finish.reached for finish in finishes] == [False, True]


@pytest.mark.long
@pytest.mark.parametrize(
    "level",
    [each for each in LEVELS if each.targets or not each.goal.has_standing_targets],
    ids=lambda each: each.id,
)
def test_driving_to_one_place_finishes_no_level_that_asks_for_more(level: GameLevel) -> None:
    case = level.find_scenario().case
    assert case is not None
    finish, _ = run_race(
        replace(level, time_limit=min(level.time_limit, 45.0)),
        level.find_scenario(),
        lambda session: session.runner.participants.append(TidyDriver(session, [case.target])),
    )
    assert not finish.reached


def test_the_time_that_is_shown_for_a_medal_earns_it() -> None:
    for reference in (each.seconds for each in load_drives().values()):
        for driver in DriverKind:
            times = [medal_time(medal, reference, driver) for medal in RUNGS]
            assert times == sorted(times, reverse=True)
            for medal, time in zip(RUNGS, times, strict=True):
                shown = float(f"{time:.2f}")
                assert medal_of(RaceFinish(True, shown, 0), reference, driver) is medal
                assert medal_of(RaceFinish(True, round(shown + 0.01, 2), 0), reference, driver) < medal


def test_hands_get_more_time_for_gold_than_programs_and_nobody_for_the_record() -> None:
    hand, program, agent = (SHARES[driver] for driver in DriverKind)
    assert hand[Medal.GOLD] > program[Medal.GOLD]
    assert agent == program
    assert hand[Medal.MASTER] == program[Medal.MASTER]
    assert medal_time(Medal.RECORD, 10.0) < 10.0


@pytest.mark.parametrize("driver", DriverKind)
def test_no_rung_asks_for_much_more_than_a_third_off_the_time_of_the_one_below(driver: DriverKind) -> None:
    shares = [SHARES[driver][medal] for medal in RUNGS]
    assert all(above > 0.6 * below for below, above in pairwise(shares))


@pytest.mark.parametrize(("collisions", "medal"), [(0, Medal.MASTER), (1, Medal.BRONZE)])
def test_who_touches_something_gets_bronze_at_best(collisions: int, medal: Medal) -> None:
    assert medal_of(RaceFinish(True, 10.0, collisions), 10.0) is medal
    assert medal_of(RaceFinish(False, 1.0, collisions), 10.0) is Medal.NONE
    assert medal_of(RaceFinish(True, 25.0, collisions), 10.0) is Medal.NONE


def test_belts_rise_with_the_medals_of_a_world() -> None:
    levels = [level for level in kit_levels() if level.world == "pair"]
    nothing = [LevelProgress(each, True, {}, frozenset(), {}) for each in levels]

    def belt(*medals: Medal) -> str:
        found = [
            replace(each, medals={DriverKind.HAND: medal})
            for each, medal in zip(nothing, medals, strict=False)
        ]
        return belt_of([each.best_medal for each in (*found, *nothing[len(found) :])])

    gold, silver, bronze, none = Medal.GOLD, Medal.SILVER, Medal.BRONZE, Medal.NONE
    found = [
        belt(none),
        belt(gold),
        belt(bronze, bronze, bronze, bronze),
        belt(silver, silver, bronze, bronze),
        belt(silver, silver, silver, gold),
        belt(silver, silver, gold, gold),
        belt(gold, gold, gold, gold),
    ]
    assert found == ["no", *(each.name for each in BELTS)]
