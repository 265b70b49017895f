"""Levels driven by the reference, by programs, unfairly; what is kept of it, and the leaderboard."""

from __future__ import annotations

import json
import os
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import pytest

from kit.controllers import find_controller
from kit.host.sandbox.confinement import Level as Confinement
from kit.host.sandbox.probe import is_level_available
from kit.school.game import leaderboard
from kit.school.game.drive_records import record_drive
from kit.school.game.ghosts import load_ghosts, load_reference_ghost
from kit.school.game.levels import GameLevel, UnknownLevel, all_levels, find_level
from kit.school.game.player_progress import completed_lessons, level_progress
from kit.school.game.race import DriverKind, RaceFinish, drive_reference, judge_recording, race_controller
from kit.school.lessons.reading import find_lesson, lesson_names
from kit.school.progress import EventKind, ProgressEvent, ProgressJournal
from kit.workspace import open_workspace
from kit.world.problems import WorldError

LEVELS = all_levels()
FIRST = LEVELS[0]

FORWARD = """
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Forward(Node):
    def __init__(self):
        super().__init__("forward")
        self.drive = self.create_publisher(Twist, "cmd_vel", 1)
        self.create_timer(0.1, self.go)

    def go(self):
        command = Twist()
        command.linear.x = {speed}
        self.drive.publish(command)


rclpy.init()
rclpy.spin(Forward())
"""

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


@pytest.mark.parametrize(
    "level",
    [pytest.param(each, marks=[pytest.mark.long] if each.par > 16 else [], id=each.id) for each in LEVELS],
)
def test_the_reference_earns_every_star(level: GameLevel) -> None:
    finish, recording = drive_reference(level)
    assert finish.earned_stars(level.par) == (True, True, True)
    assert level.par < 2.5 * finish.seconds  # a par that anybody makes is none
    assert judge_recording(level, recording) == replace(finish, failure=None)


def test_every_level_can_be_opened_one_after_the_other() -> None:
    opened: set[str] = set()
    for level in LEVELS:
        assert not level.opened_by or set(level.opened_by) & opened, level.id
        opened.add(level.id)


@pytest.mark.long
@pytest.mark.parametrize(("speed", "reached"), [(0.4, True), (0.0, False)], ids=["drives", "stands"])
def test_a_program_races(tmp_path: Path, speed: float, reached: bool) -> None:
    file = tmp_path / "mine.py"
    file.write_text(FORWARD.format(speed=speed))
    finish, recording = race_controller(replace(FIRST, par=2.0), find_controller(str(file)))
    assert finish.reached is reached
    assert finish.failure is None
    assert recording.ticks > 0


@pytest.mark.long
@pytest.mark.parametrize("source", [FORWARD.format(speed=30.0), JUMP], ids=["too fast", "moves the world"])
def test_what_is_not_fair_does_not_count(tmp_path: Path, source: str) -> None:
    file = tmp_path / "mine.py"
    file.write_text(source)
    finish, _ = race_controller(replace(FIRST, par=1.0), find_controller(str(file)))
    assert finish.foul
    assert finish.earned_stars(10.0) == (False, False, False)


WRITER = """
import pathlib

for place in {places!r}:
    try:
        pathlib.Path(place).write_text("three stars")
    except OSError:
        pass
""" + FORWARD.format(speed=0.4)


@pytest.mark.skipif(
    not is_level_available(Confinement.FILTERED), reason="this machine cannot lock programs in"
)
def test_who_races_writes_nothing_of_the_player_s(tmp_path: Path) -> None:
    desk = tmp_path / "desk"
    (desk / "controllers").mkdir(parents=True)
    file = desk / "controllers" / "mine.py"
    places = [str(desk / "progress.db"), str(desk / "levels.npz")]
    file.write_text(WRITER.replace("{places!r}", repr(places)))
    finish, _ = race_controller(replace(FIRST, par=2.0), find_controller(str(file)))
    assert finish.failure is None
    assert finish.reached
    assert not any(Path(place).exists() for place in places)


def test_a_program_that_stops_says_why(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text("1/0\n")
    finish, _ = race_controller(FIRST, find_controller(str(file)))
    assert finish.failure is not None
    assert not finish.reached


def drive(level: str, driver: str, seconds: float, *, reached: bool = True, bumps: int = 0) -> ProgressEvent:
    content = {"driver": driver, "reached": reached, "seconds": seconds, "bumps": bumps, "recording": None}
    return ProgressEvent(
        f"{level}{driver}{seconds}{bumps}", datetime.now(UTC).isoformat(), EventKind.FINISH, level, content
    )


def test_stars_add_up_over_drives_and_open_levels() -> None:
    events = [
        drive(FIRST.id, "keys", FIRST.par + 3.0),
        drive(FIRST.id, "agent", FIRST.par - 1.0, bumps=2),
        drive("the-door", "keys", 3.0, reached=False),
        ProgressEvent("x", datetime.now(UTC).isoformat(), EventKind.FINISH, FIRST.id, {"driver": "horse"}),
    ]
    found = {each.level.id: each for each in level_progress(LEVELS, events)}
    assert found[FIRST.id].stars == (True, True, True)
    assert found[FIRST.id].best_times == {DriverKind.KEYS: FIRST.par + 3.0, DriverKind.AGENT: FIRST.par - 1.0}
    assert found["left-turn"].is_open
    assert not found["two-doors"].is_open
    assert found["the-door"].star_count == 0


def test_the_best_drive_is_kept_as_a_ghost(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(leaderboard.FOLDER_VARIABLE, str(tmp_path / "board"))
    workspace = open_workspace(tmp_path / "desk")
    finish, recording = drive_reference(FIRST)
    with ProgressJournal(workspace.folder) as progress:
        first = record_drive(progress, workspace, FIRST, DriverKind.KEYS, finish, recording)
        slower = record_drive(
            progress, workspace, FIRST, DriverKind.KEYS, replace(finish, seconds=99.0), recording
        )
    assert (first.is_best, slower.is_best) == (True, False)
    assert first.recording is not None
    (own,) = load_ghosts(workspace, FIRST)
    known = load_reference_ghost(workspace, FIRST)
    assert known is not None
    assert own.seconds == pytest.approx(known.seconds)
    assert own.poses_at(0.0)[0] == pytest.approx(tuple(FIRST.find_scenario().starts[0]), abs=0.02)
    assert own.poses_at(1e9) == own.poses_at(own.seconds)
    first.recording.write_bytes(b"damaged")
    assert load_ghosts(workspace, FIRST) == ()


def test_the_leaderboard_lists_only_users_who_joined(tmp_path: Path) -> None:
    board = tmp_path / "board"
    found = level_progress(LEVELS, [drive(FIRST.id, "keys", 5.0)])
    assert not leaderboard.has_joined(board)
    leaderboard.publish_entry(board, "Ada\x1b[31m", found)
    (entry,) = leaderboard.read_entries(board)
    assert (entry.seconds, entry.is_mine, "\x1b" in entry.name) == (5.0, True, False)
    own = board / f"{os.getuid()}.json"
    (board / "123456.json").write_text(own.read_text())  # written for somebody else
    (board / "999.json").symlink_to(own)
    (board / "0.txt").write_text("x")
    assert len(leaderboard.read_entries(board)) == 1
    leaderboard.remove_own_entry(board)
    leaderboard.remove_own_entry(board)
    assert leaderboard.read_entries(board) == []


@pytest.mark.parametrize(
    "content",
    [
        "",
        "[]",
        "{}",
        "[" * 100_000,
        '{"name": "x", "levels": {"a": {"stars": 1e999, "best": {"keys": 1}}}}',
        json.dumps({"name": "x", "levels": {"a": {"stars": 1, "best": {"keys": "inf"}}}}),
    ],
)
def test_a_damaged_entry_is_passed_over(tmp_path: Path, content: str) -> None:
    (tmp_path / f"{os.getuid()}.json").write_text(content)
    assert leaderboard.read_entries(tmp_path) == []


def test_a_folder_in_which_others_can_replace_files_is_refused(tmp_path: Path) -> None:
    board = tmp_path / "board"
    board.mkdir()
    board.chmod(0o777)
    with pytest.raises(leaderboard.LeaderboardError, match="chmod"):
        leaderboard.publish_entry(board, "Ada", level_progress(LEVELS, []))


def test_a_level_is_found_by_name_and_number(tmp_path: Path) -> None:
    assert find_level("1") is not None
    assert find_level(FIRST.id).id == FIRST.id
    with pytest.raises(UnknownLevel, match="first-drive"):
        find_level("first-drve")
    (tmp_path / "levels.yaml").write_text(
        "levels: [{id: a, title: A, place: nowhere, case: x, par: 0, hint: h, after: [b]}]\n"
    )
    with pytest.raises(WorldError) as raised:
        all_levels(tmp_path)
    assert all(word in str(raised.value) for word in ("nowhere", "par", '"b"'))


def test_a_finish_that_is_no_finish_is_not_one() -> None:
    assert RaceFinish(False, 3.0, 0).earned_stars(10.0) == (False, False, False)


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
