"""Levels driven by the reference, by programs, unfairly; what is kept of it, and the leaderboard."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime
from itertools import combinations
from pathlib import Path

import pytest

from kit.controllers import find_controller, kit_controllers
from kit.host.sandbox.probe import is_level_available
from kit.host.sandbox.sandbox_config import Level as Confinement
from kit.learning.tasks.goals.target import REACH_TARGET
from kit.msg.geometry_msgs import Twist, Vector3
from kit.run.episode import EndCondition, EndReason, run_until
from kit.run.recording import Recording
from kit.run.session import Session
from kit.school.game import leaderboard, references
from kit.school.game.daily import daily_level, today
from kit.school.game.drive_records import join_leaderboard, record_drive
from kit.school.game.ghosts import classmate_ghosts, load_ghosts, load_reference_ghost
from kit.school.game.league.house import house_programs
from kit.school.game.levels import GameLevel, UnknownLevel, all_levels, all_worlds, find_level
from kit.school.game.medal import Medal, medal_of
from kit.school.game.player_progress import (
    BY_HAND,
    DriverFacts,
    ExtraRule,
    completed_lessons,
    facts_of_program,
    level_progress,
)
from kit.school.game.race import (
    STUCK_TIME,
    DriverKind,
    RaceFinish,
    RaceReferee,
    finish_order,
    race_controller,
)
from kit.school.game.references import drive_reference, load_drives
from kit.school.game.starts import OWN_SEED
from kit.school.lessons.reading import find_lesson, lesson_names
from kit.school.progress import EventKind, ProgressEvent, ProgressJournal
from kit.workspace import open_workspace
from kit.world.problems import WorldError
from tests.driving_program import driving_program
from tests.kit_content import kit_levels
from tests.school.game.measured_drivers import drive as drive_from
from tests.school.game.measured_drivers import keys_drive
from tests.school.game.ordinary import targets_of
from tests.school.game.tidy import TidyDriver

LEVELS = kit_levels()
FIRST = LEVELS[0]
STRAIGHT = replace(FIRST, goal=REACH_TARGET, targets=())
"""The same level, one way only."""

JUMP = """
import rclpy
from flatland_msgs.srv import MoveModel
from geometry_msgs.msg import Pose2D
from rclpy.node import Node


class Jump(Node):
    def __init__(self):
        super().__init__("jump")
        self.client = self.create_client(MoveModel, "/move_model")
        self.create_timer(0.5, self.go)

    def go(self):
        request = MoveModel.Request()
        request.name = "serp"
        request.pose = Pose2D(x=0.625, y=2.4, theta=1.57)
        self.client.call_async(request)


rclpy.init()
rclpy.spin(Jump())
"""


def test_every_level_can_be_opened_one_after_the_other() -> None:
    opened: set[str] = set()
    for level in LEVELS:
        assert not level.opened_by or set(level.opened_by) & opened, level.id
        opened.add(level.id)


@pytest.mark.long
@pytest.mark.parametrize(("speed", "reached"), [(0.4, True), (0.0, False)], ids=["drives", "stands"])
def test_a_program_races(tmp_path: Path, speed: float, reached: bool) -> None:
    file = tmp_path / "mine.py"
    file.write_text(driving_program(speed))
    finish, recording = race_controller(replace(STRAIGHT, time_limit=12.0), find_controller(str(file)))
    assert finish.reached is reached
    assert finish.failure is None
    assert recording.ticks > 0


@pytest.mark.long
def test_no_program_drives_faster_than_the_motors(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text(driving_program(30.0))
    finish, _ = race_controller(replace(STRAIGHT, time_limit=6.0), find_controller(str(file)))
    assert finish.reached
    assert finish.seconds > 3.0


@pytest.mark.long
def test_what_is_not_fair_does_not_count(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text(JUMP)
    finish, _ = race_controller(replace(STRAIGHT, time_limit=6.0), find_controller(str(file)))
    assert finish.foul
    assert not finish.reached


WRITER = """
import pathlib

for place in {places!r}:
    try:
        pathlib.Path(place).write_text("three stars")
    except OSError:
        pass
""" + driving_program(0.4)


@pytest.mark.skipif(
    not is_level_available(Confinement.FILTERED), reason="this machine cannot lock programs in"
)
def test_who_races_writes_nothing_of_the_player_s(tmp_path: Path) -> None:
    desk = tmp_path / "desk"
    (desk / "controllers").mkdir(parents=True)
    file = desk / "controllers" / "mine.py"
    places = [str(desk / "progress.db"), str(desk / "levels.npz")]
    file.write_text(WRITER.replace("{places!r}", repr(places)))
    finish, _ = race_controller(replace(STRAIGHT, time_limit=12.0), find_controller(str(file)))
    assert finish.failure is None
    assert finish.reached
    assert not any(Path(place).exists() for place in places)


def test_a_program_that_stops_says_why(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text("1/0\n")
    finish, _ = race_controller(FIRST, find_controller(str(file)))
    assert finish.failure is not None
    assert not finish.reached


def drive(
    level: str, driver: str, seconds: float, *, reached: bool = True, bumps: int = 0, **more: object
) -> ProgressEvent:
    """A drive that keeps no rule and wins no medal, unless ``more`` says otherwise."""
    content = {
        "driver": driver,
        "reached": reached,
        "seconds": seconds,
        "bumps": bumps,
        "recording": None,
        **more,
    }
    return ProgressEvent(
        f"{level}{driver}{seconds}{bumps}", datetime.now(UTC).isoformat(), EventKind.FINISH, level, content
    )


def test_medals_are_counted_by_driver_beside_them() -> None:
    events = [
        drive(FIRST.id, "hand", 7.0, medal=1, rules=["clean", "levitation"]),
        drive(FIRST.id, "hand", 6.5, medal=2, rules=["no stop"]),
        drive(FIRST.id, "program", 6.1, medal=3, shipped=True),
        drive(FIRST.id, "agent", 9.0, medal=99, rules="clean"),
        drive("the-door", "program", 6.1, medal=3, shipped=True),
        drive("the-door", "hand", 3.0, reached=False),
        ProgressEvent("x", datetime.now(UTC).isoformat(), EventKind.FINISH, FIRST.id, {"driver": "horse"}),
    ]
    found = {each.level.id: each for each in level_progress(LEVELS, events)}
    first = found[FIRST.id]
    assert first.medals == {DriverKind.HAND: Medal.SILVER, DriverKind.AGENT: Medal.NONE}
    assert first.best_times == {DriverKind.HAND: 6.5, DriverKind.AGENT: 9.0}
    assert first.rules == {ExtraRule.CLEAN, ExtraRule.NO_STOP}
    assert found["left-turn"].is_open
    assert not found["two-doors"].is_open  # only a controller of the kit was through the door


def test_no_two_levels_are_won_by_the_same_drive() -> None:
    drives = load_drives()

    def is_won(level: GameLevel, name: str) -> bool:
        finish, _ = drive_reference(level, drives[name])
        return finish.reached and finish.seconds < 1.5 * drives[level.id].seconds

    twins = [
        (level, other)
        for level, other in combinations(LEVELS, 2)
        if level.targets and (level.targets, level.world) == (other.targets, other.world)
    ]
    assert twins
    for level, other in twins:
        assert not (is_won(level, other.id) and is_won(other, level.id)), (level.id, other.id)


def test_a_newcomer_can_try_the_first_level_of_each_world_and_no_later_one() -> None:
    found = level_progress(LEVELS, ())
    for world in all_worlds():
        first, *later = (each for each in found if each.level.world == world.id)
        assert first.is_open
        assert {each.level.id for each in later if each.is_open} == {
            each.level.id for each in later if not each.level.opened_by
        }


def test_every_controller_of_the_kit_and_its_copies_earn_nothing(tmp_path: Path) -> None:
    copy = tmp_path / "mine.py"
    for controller in kit_controllers():
        assert facts_of_program(controller.file).is_shipped
        copy.write_text(f"# my own work\n{controller.file.read_text()}")
        assert facts_of_program(copy).is_shipped, controller.name
    for program in house_programs().values():
        copy.write_bytes(program)
        assert facts_of_program(copy).is_shipped, "of the league's house"
    copy.write_text('"""Two lines."""\n\nx = 1  # one\n# not this one\ny = 2\n')
    facts = facts_of_program(copy)
    assert not facts.is_shipped
    assert facts.code_lines == 2


def test_a_drive_is_recorded_with_its_medal_stars_and_ghost(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(leaderboard.FOLDER_VARIABLE, str(tmp_path / "board"))
    workspace = open_workspace(tmp_path / "desk")
    finish, recording = drive_reference(FIRST)
    slow = replace(finish, seconds=1.9 * finish.seconds)
    shipped = DriverFacts(is_shipped=True)
    of_today = daily_level(today())
    with ProgressJournal(workspace.folder) as progress:
        nothing = record_drive(progress, workspace, FIRST, DriverKind.PROGRAM, [(finish, recording)], shipped)
        first = record_drive(progress, workspace, FIRST, DriverKind.HAND, [(finish, recording)], BY_HAND)
        slower = record_drive(progress, workspace, FIRST, DriverKind.HAND, [(slow, recording)], BY_HAND)
        (of_level,) = level_progress([FIRST], progress.events())
        daily = record_drive(progress, workspace, of_today, DriverKind.HAND, [(finish, recording)])
    assert (daily.streak, first.streak) == (1, 0)
    assert (nothing.medal, nothing.rules, nothing.is_best, nothing.unlocked) == (Medal.NONE, (), False, ())
    assert (first.medal, slower.medal) == (Medal.MASTER, Medal.BRONZE)
    assert {each.id for each in first.unlocked} == {"left-turn", "right-turn"}
    assert (first.belt, slower.belt, slower.unlocked) == ("white", "", ())
    assert (first.is_best, slower.is_best, slower.previous_best) == (True, False, finish.seconds)
    assert ExtraRule.CLEAN in first.new_rules
    assert ExtraRule.CLEAN not in slower.new_rules
    assert of_level.medals == {DriverKind.HAND: Medal.MASTER}
    assert first.recording is not None
    (own,) = load_ghosts(workspace, FIRST)
    known = load_reference_ghost(FIRST)
    assert known is not None
    assert own.seconds == pytest.approx(known.seconds)
    assert own.poses_at(0.0)[0] == pytest.approx(tuple(FIRST.find_scenario().starts[0]), abs=0.02)
    assert own.poses_at(1e9) == own.poses_at(own.seconds)
    first.recording.write_bytes(b"damaged")
    assert load_ghosts(workspace, FIRST) == ()


def test_a_reference_drive_says_how_far_it_is_and_is_driven_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(references, "_RECORDINGS", type(references._RECORDINGS)())
    shares: list[float] = []
    recording = references.reference_recording(FIRST, shares.append)
    assert recording is not None
    assert len(shares) > 5
    assert shares == sorted(shares)
    assert 0.0 <= shares[0] < 0.5 < shares[-1] <= 1.0
    assert references.reference_recording(FIRST, pytest.fail) is recording


def test_a_best_drive_that_does_not_run_again_gives_its_place_to_a_slower_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    board = tmp_path / "board"
    monkeypatch.setenv(leaderboard.FOLDER_VARIABLE, str(board))
    workspace = open_workspace(tmp_path / "desk")
    (slow, slower), (best, quicker) = keys_drive(FIRST), drive_tidily(FIRST)
    of_another_kit = replace(quicker, poses=quicker.poses + 0.001)
    with ProgressJournal(workspace.folder) as progress:
        record_drive(progress, workspace, FIRST, DriverKind.HAND, [(best, of_another_kit)])
        join_leaderboard(progress, workspace, "Ada")
        assert leaderboard.read_entries(board, [FIRST]) == []
        records = [
            record_drive(progress, workspace, FIRST, DriverKind.HAND, [(slow, slower)]) for _ in range(2)
        ]
    assert [each.replaces for each in records] == [True, False], "told once"
    (entry,) = leaderboard.read_entries(board, [FIRST])
    assert entry.seconds == slow.seconds > best.seconds


def test_classmates_who_joined_leave_ghosts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    board = tmp_path / "board"
    monkeypatch.setenv(leaderboard.FOLDER_VARIABLE, str(board))
    workspace = open_workspace(tmp_path / "desk")
    finish, recording = keys_drive(FIRST)
    with ProgressJournal(workspace.folder) as progress:
        record_drive(progress, workspace, FIRST, DriverKind.HAND, [(finish, recording)])
        join_leaderboard(progress, workspace, "Ada")
        (entry,) = leaderboard.read_entries(board, [FIRST])
        assert (entry.medal, entry.seconds, entry.is_same_platform) == (Medal.BRONZE, finish.seconds, True)
        better, quicker = drive_tidily(FIRST)
        record_drive(progress, workspace, FIRST, DriverKind.HAND, [(better, quicker)])
    (entry,) = leaderboard.read_entries(board, [FIRST])
    assert entry.seconds == better.seconds < finish.seconds, (
        "a better drive takes the place of the one before"
    )
    assert entry.step_size * len(entry.tracks[0]) == pytest.approx(better.seconds, abs=0.5)
    assert classmate_ghosts(FIRST) == ()  # one's own is none
    monkeypatch.setattr(leaderboard, "read_entries", lambda folder, levels: [replace(entry, is_mine=False)])
    (ghost,) = classmate_ghosts(FIRST)
    assert (ghost.name, ghost.seconds) == ("Ada", entry.seconds)


def drive_tidily(level: GameLevel) -> tuple[RaceFinish, Recording]:
    targets = targets_of(level)
    return drive_from(
        level, OWN_SEED, lambda session: session.runner.participants.append(TidyDriver(session, targets))
    )


def test_a_level_is_found_by_name_and_number(tmp_path: Path) -> None:
    assert find_level("1") is not None
    assert find_level(FIRST.id).id == FIRST.id
    with pytest.raises(UnknownLevel, match="first-drive"):
        find_level("first-drve")
    (tmp_path / "levels.yaml").write_text(
        "levels: [{id: a, title: A, world: w, place: nowhere, case: x, time_limit: -1, hint: h, story: s, skill: s, after: [b]}]\n"
    )
    with pytest.raises(WorldError) as raised:
        all_levels(tmp_path)
    assert all(word in str(raised.value) for word in ("nowhere", "time_limit", '"b"'))


def test_every_lesson_that_opens_a_level_exists_and_opens_it_once_completed(tmp_path: Path) -> None:
    named = [level.opened_by_lesson for level in LEVELS if level.opened_by_lesson]
    assert set(named) <= set(lesson_names())
    level = next(each for each in LEVELS if each.opened_by_lesson and each.opened_by)
    lesson = find_lesson(level.opened_by_lesson)
    with ProgressJournal(tmp_path) as journal:
        for step in lesson.steps[1:]:
            if step.exercise is not None:
                journal.add(EventKind.ATTEMPT, lesson.exercise_subject(step.exercise), {"verdict": "pass"})
            else:
                journal.add(EventKind.STEP, lesson.step_subject(step))
        assert level.opened_by_lesson not in completed_lessons(LEVELS, journal.events())
        journal.add(EventKind.STEP, lesson.step_subject(lesson.steps[0]))
        events = journal.events()
    found = level_progress(LEVELS, events, completed_lessons(LEVELS, events))
    assert next(each for each in found if each.level is level).is_open
    assert not next(each for each in level_progress(LEVELS, events) if each.level is level).is_open


def test_a_bump_is_no_way_home() -> None:
    """Who is put back to the start, which is the last target, has all targets before them again."""
    scenario = FIRST.find_scenario()
    robot = scenario.partners[0]
    with Session(scenario) as session:
        referee = RaceReferee(FIRST, scenario)
        session.runner.observers.append(referee)
        for topic in session.command_topics(robot):
            session.runner.accept(topic, Twist(linear=Vector3(x=0.5)))
        is_there = EndCondition(EndReason.REACHED, lambda: len(referee.objective.splits) == 1)
        run_until(session.runner, ends=[is_there], ticks=800)
        assert referee.objective.progress == "1 of 2 targets"
        session.runner.call_service("move_model", robot, scenario.starts[0])
        run_until(session.runner, ticks=20)
        assert referee.finish.foul == ""
        assert not referee.finish.reached
        assert referee.objective.progress == "0 of 2 targets"
        assert referee.finish.splits == ()


def test_a_robot_that_is_pressed_against_a_wall_ends_the_drive_and_one_that_turns_there_does_not() -> None:
    scenario = FIRST.find_scenario()
    for turn in (0.0, 0.3):
        with Session(scenario) as session:
            referee = RaceReferee(FIRST, scenario)
            session.runner.observers.append(referee)
            for topic in session.command_topics(scenario.partners[0]):
                session.runner.accept(topic, Twist(linear=Vector3(x=-0.5), angular=Vector3(z=turn)))
            run_until(session.runner, ticks=1500)
        assert referee.finish.collisions
        assert referee.finish.is_stuck is referee.is_over is (turn == 0.0)
        assert not referee.finish.reached
    assert referee.finish.seconds > STUCK_TIME
    with Session(scenario) as session:
        referee = RaceReferee(FIRST, scenario)
        session.runner.observers.append(referee)
        run_until(session.runner, ticks=1500)
    assert not referee.is_over, "standing in the open may be waiting"


def test_what_happens_after_the_time_is_over_is_not_counted() -> None:
    level = replace(STRAIGHT, time_limit=2.0)
    scenario = level.find_scenario()
    with Session(scenario) as session:
        referee = RaceReferee(level, scenario)
        session.runner.observers.append(referee)
        run_until(session.runner, ticks=300)
        for topic in session.command_topics(scenario.partners[0]):
            session.runner.accept(topic, Twist(linear=Vector3(x=0.5)))
        run_until(session.runner, ticks=800)
    assert referee.is_over
    assert not referee.finish.reached
    assert referee.finish.seconds == 2.0


def test_a_pair_that_is_apart_gets_bronze_at_best() -> None:
    """One after the other both come to the target: as quick as it may be, on a level that asks them to stay side by side."""
    pair = next(level for level in LEVELS if level.id == "two-wheelchairs")
    here = replace(pair, goal=REACH_TARGET, targets=())
    for level, medal in ((here, Medal.BRONZE), (replace(here, abreast=0.0), Medal.RECORD)):
        scenario = level.find_scenario()
        with Session(scenario) as session:
            referee = RaceReferee(level, scenario)
            session.runner.observers.append(referee)
            for robot in scenario.partners:
                for topic in session.command_topics(robot):
                    session.runner.accept(topic, Twist(linear=Vector3(x=0.5)))
                run_until(session.runner, ticks=380)
                for topic in session.command_topics(robot):
                    session.runner.accept(topic, Twist())
        finish = referee.finish
        assert finish.reached
        assert finish.is_apart is finish.is_flawed is (level is here)
        assert ("side by side" in referee.objective.progress) is (level is here)
        assert medal_of(finish, 2.0 * finish.seconds) is medal
        assert finish_order(finish) > finish_order(replace(finish, is_apart=False)) or level is not here
