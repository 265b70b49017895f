"""Reading a class's files: each student once, nothing that is wrong stops the rest, nobody is named unasked."""

from __future__ import annotations

import json
import os
from datetime import timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from kit.school import progress_export
from kit.school.progress import FORMAT, VERSION, EventKind, ProgressJournal
from kit.school.report.class_data import read_roster, started_lessons, student_work
from tests.cases import every_case
from tests.school.report.class_builder import NAMES, START, Diary, classroom, student


def diary(name: str) -> Diary:
    made = Diary(name)
    made.note(EventKind.ABOUT, "name", {"value": name})
    return made


def test_a_folder_stands_for_its_files(tmp_path: Path) -> None:
    classroom(tmp_path, 3)
    (tmp_path / "notes.txt").write_text("no export")
    roster = read_roster([tmp_path])
    assert (len(roster.students), roster.file_count, roster.warnings) == (3, 3, ())


def test_students_have_numbers_unless_names_are_wanted(tmp_path: Path) -> None:
    classroom(tmp_path, 11)
    without = [each.label for each in read_roster([tmp_path]).students]
    assert without == [f"S{number:02}" for number in range(1, 12)]
    assert {each.label for each in read_roster([tmp_path], use_names=True).students} == set(NAMES[:11])


def test_the_numbers_do_not_follow_names_or_files(tmp_path: Path) -> None:
    files = classroom(tmp_path, 12)
    forwards, backwards = read_roster(files), read_roster(files[::-1])
    assert [each.files for each in forwards.students] == [each.files for each in backwards.students]
    assert [each.files[0] for each in forwards.students] != sorted(files)


def test_the_file_names_who_gave_no_name(tmp_path: Path) -> None:
    nameless = Diary("x")
    nameless.note(EventKind.STEP, "01-drive/1")
    nameless.export(tmp_path, "a17.json")
    assert [each.label for each in read_roster([tmp_path], use_names=True).students] == ["a17"]


def test_two_exports_of_one_student_are_one(tmp_path: Path) -> None:
    ada = diary("Ada")
    early = ada.export(tmp_path, "early.json")
    ada.note(EventKind.STEP, "01-drive/1")
    late = ada.export(tmp_path, "late.json")
    roster = read_roster([early, late])
    assert len(roster.students) == 1
    assert len(roster.students[0].events) == 2
    assert "same student" in roster.warnings[0]


def test_a_file_named_twice_is_read_once(tmp_path: Path) -> None:
    file = diary("Ada").export(tmp_path)
    (tmp_path / "link.json").symlink_to(file)
    roster = read_roster([file, tmp_path])
    assert len(roster.students) == 1
    assert len(roster.warnings) == 2


def test_somebody_elses_progress_taken_over_stays_two(tmp_path: Path) -> None:
    ada, ben = diary("Ada"), Diary("Ben")
    ben.events += ada.events
    ben.note(EventKind.ABOUT, "name", {"value": "Ben"}, minutes=99)
    roster = read_roster([ada.export(tmp_path), ben.export(tmp_path)])
    assert len(roster.students) == 2
    assert "different students" in roster.warnings[0]


def test_one_name_without_a_shared_entry_is_pointed_out(tmp_path: Path) -> None:
    first = diary("Ada")
    second = Diary("another")
    second.note(EventKind.ABOUT, "name", {"value": "ada "})
    roster = read_roster([first.export(tmp_path), second.export(tmp_path)], use_names=True)
    assert len(roster.students) == 2
    assert "same name" in roster.warnings[0]
    assert len({each.label for each in roster.students}) == 2


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"{",
        b"[]",
        b"null",
        b'"text"',
        b"\xff\xfe\x00",
        b"[" * 100_000,
        json.dumps({"format": "another"}).encode(),
        json.dumps({"format": FORMAT, "version": 99, "events": []}).encode(),
        json.dumps({"format": FORMAT, "version": VERSION, "events": []}).encode(),
        json.dumps({"format": FORMAT, "version": VERSION, "events": [1]}).encode(),
        json.dumps({"format": FORMAT, "version": VERSION, "events": {}}).encode(),
        json.dumps(
            {"format": FORMAT, "version": VERSION, "events": [{"uid": "1", "at": "noon", "kind": "step"}]}
        ).encode(),
    ],
    ids=[
        "empty",
        "cut-off",
        "list",
        "null",
        "text",
        "bytes",
        "deep",
        "another-format",
        "newer",
        "no-entry",
        "entry-of-1",
        "entries-no-list",
        "odd-time",
    ],
)
def test_what_is_no_export_is_named_and_the_rest_goes_on(tmp_path: Path, content: bytes) -> None:
    diary("Ada").export(tmp_path)
    (tmp_path / "wrong.json").write_bytes(content)
    roster = read_roster([tmp_path])
    assert len(roster.students) == 1
    assert len(roster.warnings) == 1
    assert "wrong.json" in roster.warnings[0]


def test_files_that_are_not_there_or_not_files(tmp_path: Path) -> None:
    (tmp_path / "folder.json").mkdir()
    (tmp_path / "empty").mkdir()
    file = diary("Ada").export(tmp_path)
    roster = read_roster([file, tmp_path / "gone.json", tmp_path / "folder.json", tmp_path / "empty"])
    assert len(roster.students) == 1
    assert len(roster.warnings) == 3


def test_a_file_larger_than_any_export_is_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = diary("Ada").export(tmp_path)
    assert len(read_roster([file]).students) == 1
    monkeypatch.setattr(progress_export, "MAX_EXPORT_BYTES", file.stat().st_size - 1)
    roster = read_roster([file])
    assert not roster.students
    assert "larger than" in roster.warnings[0]


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_a_file_that_may_not_be_read(tmp_path: Path) -> None:
    file = diary("Ada").export(tmp_path)
    file.chmod(0)
    assert "cannot be read" in read_roster([file]).warnings[0]


def test_what_the_kit_itself_exports_is_read(tmp_path: Path) -> None:
    with ProgressJournal(tmp_path) as progress:
        progress.add(EventKind.ABOUT, "name", {"value": "Ada"}, now=START)
        progress.add(EventKind.STEP, "01-drive/1", now=START + timedelta(minutes=1))
        progress.export(tmp_path / "ada.json")
    roster = read_roster([tmp_path / "ada.json"], use_names=True)
    assert [(each.label, len(each.events)) for each in roster.students] == [("Ada", 2)]


def test_a_name_cannot_command_the_terminal(tmp_path: Path) -> None:
    wicked = Diary("x")
    wicked.note(EventKind.ABOUT, "name", {"value": "\x1b[2J" + "A" * 500})
    label = read_roster([wicked.export(tmp_path)], use_names=True).students[0].label
    assert "\x1b" not in label
    assert len(label) <= 40


def test_events_come_in_the_order_of_time(tmp_path: Path) -> None:
    made = student("Ada", 0.5, np.random.default_rng(0))
    made.events.reverse()
    times = [event.time for event in read_roster([made.export(tmp_path)]).students[0].events]
    assert times == sorted(times)


def test_attempts_points_and_what_was_lost() -> None:
    diary = Diary("Ada")
    diary.attempt("01-drive/flag", 2.0, "fail", ["reached", "clear"])
    diary.attempt("01-drive/flag", 1.0, "fail", ["reached"])
    diary.attempt("01-drive/flag", 0.0, "broken")
    diary.attempt("01-drive/flag", 5.0, "pass")
    diary.attempt("01-drive/flag", 3.0, "fail", ["clear"])
    exercise = student_work(diary.events)["01-drive"].exercises["flag"]
    assert (exercise.attempts, exercise.points, exercise.max_points) == (4, 5.0, 5.0)
    assert (exercise.is_passed, exercise.tries_to_pass) == (True, 3)
    assert exercise.lost_criteria == {"reached": 2, "clear": 2}


def test_steps_hints_predictions_and_solutions() -> None:
    diary = Diary("Ada")
    for step in ("1", "2", "1"):
        diary.note(EventKind.STEP, f"01-drive/{step}")
    diary.note(EventKind.PREDICTION, "01-drive/3", {"chosen": 0, "right": True})
    diary.note(EventKind.PREDICTION, "01-drive/4", {"chosen": 0, "right": False})
    diary.note(EventKind.HINT, "01-drive/flag/reached", {"step": 1})
    diary.note(EventKind.SOLUTION, "01-drive/flag")
    lesson = student_work(diary.events)["01-drive"]
    assert len(lesson.steps) == 2
    assert (lesson.predictions, lesson.predicted_right, lesson.hint_count) == (2, 1, 1)
    assert lesson.exercises["flag"].has_seen_solution
    assert (lesson.attempt_count, lesson.passed_count) == (0, 0)


def test_time_stops_in_pauses_and_between_lessons() -> None:
    diary = Diary("Ada")
    for lesson, minutes in (("a", 1), ("a", 3), ("b", 4), ("b", 9), ("b", 60), ("b", 2), ("a", 5)):
        diary.note(EventKind.STEP, f"{lesson}/1", minutes=minutes)
    work = student_work(diary.events)
    assert (work["a"].minutes, work["b"].minutes) == (3, 11)
    assert started_lessons([work, {}]) == ("a", "b")


def test_what_is_not_of_lessons_is_passed_over() -> None:
    diary = Diary("Ada")
    diary.note(EventKind.ABOUT, "name", {"value": "Ada"})
    diary.note(EventKind.FINISH, "level-1", {"reached": True})
    assert student_work(diary.events) == {}


@every_case(
    "content",
    [
        {},
        {"verdict": "pass", "points": "many", "max_points": None, "lost": "reached"},
        {"verdict": "pass", "points": float("nan"), "max_points": float("inf"), "lost": [1, None]},
        {"verdict": "pass", "points": 10**400, "max_points": -5, "lost": {"a": 1}},
        {"verdict": ["pass"], "points": True},
        {"verdict": "pass", "points": 99, "max_points": 5},
    ],
)
def test_damaged_entries_count_as_little_as_they_say(content: dict[str, Any]) -> None:
    diary = Diary("Ada")
    diary.note(EventKind.ATTEMPT, "01-drive/flag", content)
    lesson = student_work(diary.events)["01-drive"]
    assert 0 <= lesson.points <= lesson.max_points <= 5
