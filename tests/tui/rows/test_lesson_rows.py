"""A step as rows of text: what fits on 80 columns, and what is said of a check."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest
from rich.cells import cell_len

from grader.evidence.submission_clock import SubmissionClock, TrainingProgressReport
from kit.document.blocks import Block, Code, Marked
from kit.document.layout import Page, rows_of
from kit.document.rows import MARGIN, Row, row, text_width
from kit.results.grading_result import CriterionResult, CriterionStatus, GradingResult, GradingVerdict
from kit.school.lessons.catalogue import LessonProgress, lesson_progress_from_events
from kit.school.lessons.checking import CheckReport
from kit.school.lessons.lesson_session import LessonHint
from kit.school.lessons.lesson_text import (
    ending_blocks,
    feedback_blocks,
    question_blocks,
    status_text,
    verdict_blocks,
)
from kit.school.lessons.reading import find_lesson, lesson_names, lessons_folder, read_lesson
from kit.school.lessons.records import Lesson
from kit.tui.rows import lesson_rows
from kit.tui.widgets.lesson_page import LEAST_PICTURE
from tests.tui.lesson_folder import write_lessons
from tests.tui.lesson_stage import row_text

PASSED = CriterionResult("runs", "It runs", CriterionStatus.PASS, 1, 1)
LOST = CriterionResult(
    "near",
    "It comes near " * 12,
    CriterionStatus.FAIL,
    0.5,
    3,
    rationale="It stood. " * 20,
    expected="0.2 m",
    actual="1.7 m",
    hints=("Go.", "Look at the wall. " * 9, "Turn."),
)
RESULT = GradingResult("near", "v", "digest", "0.1", "public", 1, "linux", (PASSED, LOST))
REPORT = CheckReport(GradingVerdict.FAIL, RESULT, 1.25)


@pytest.fixture
def lesson(tmp_path: Path) -> Lesson:
    return read_lesson(write_lessons(tmp_path) / "01-colours")


@pytest.fixture
def stand(lesson: Lesson) -> LessonProgress:
    return lesson_progress_from_events(lesson, [])


def as_a_shell_takes(lines: list[str]) -> list[str]:
    """The arguments of the command of the kit that somebody pastes."""
    pasted = "kit() { printf '%s\\n' \"$@\"; }\n" + "\n".join(lines)
    return subprocess.run(
        ["sh", "-c", pasted], capture_output=True, text=True, check=True
    ).stdout.splitlines()


def shown(blocks: Sequence[Block], width: int = 80) -> list[Row]:
    """The blocks as a lesson's screen shows them."""
    return rows_of(blocks, Page(text_width(width), MARGIN))


def widest(rows: list[Row]) -> int:
    return max(cell_len(row_text(row)) for row in rows)


@pytest.mark.parametrize("width", [60, 80, 200])
def test_nothing_is_wider_than_the_screen(lesson: Lesson, stand: LessonProgress, width: int) -> None:
    predict, *_, make = lesson.steps
    hints = (LessonHint(LOST, 1, LOST.hints[0]), LessonHint(LOST, 2, LOST.hints[1]))
    assert (
        widest(
            [
                lesson_rows.heading(stand, make, width),
                lesson_rows.title(make, row(("12 of 30 s", "dim")), width),
            ]
        )
        <= width
    )
    assert widest(shown([Marked("word " * 99 + "\n\n    " + "x" * 300)], width)) <= width
    assert widest(shown(question_blocks(predict, predict.options[0], is_told=True), width)) <= width
    assert widest(shown(feedback_blocks(predict, predict.options[1]), width)) <= width
    assert widest(shown(verdict_blocks(REPORT, hints), width)) <= width
    assert widest(lesson_rows.file_rows("/home/" + "ada" * 60, False, True, width)) <= width
    assert widest(shown(ending_blocks(stand), width)) <= width


def test_a_long_path_is_there_to_the_last_character() -> None:
    path = "/home/" + "ada" * 60 + "/controller.py"
    rows = lesson_rows.file_rows(path, False, False, 80)
    assert "".join(row_text(row)[6:] for row in rows) == path


def test_a_long_command_can_be_copied_and_typed_as_it_stands() -> None:
    line = "kit drive simple --controller /home/" + "ada/" * 12 + "controller.py --seed 1"
    rows = [row_text(each) for each in shown([Code((line,))])]
    assert len(rows) > 1
    assert all(len(part) <= 78 for part in rows)
    assert as_a_shell_takes(rows) == line.split()[1:]
    path = "/home/" + "ada" * 40 + "/controller.py"
    torn = [row_text(each) for each in shown([Code((f"kit run {path} --steps 3",))])]
    assert as_a_shell_takes(torn) == ["run", path, "--steps", "3"]
    code = "x = " + "1 + " * 30 + "1"
    assert "".join(row_text(each) for each in shown([Code((code,))])).split() == code.split()


def test_a_lessons_title_is_whole_however_long_the_goal(lesson: Lesson) -> None:
    """The bar gives way first, then the goal."""
    title = "Services, parameters and looking inside"
    stand = lesson_progress_from_events(replace(lesson, title=title), [])

    def heading(goal: str) -> str:
        return row_text(lesson_rows.heading(stand, replace(lesson.steps[0], goal=goal), 80)).rstrip()

    assert heading("Be told").endswith("□····")
    assert "Foresee what is told" in heading("Foresee what is told")
    assert "□" not in heading("Foresee what is told")
    assert "..." in heading("Foresee what the robot is told by others")
    assert all(title in heading("a" * count) for count in range(1, 60))


def test_the_kits_titles_and_goals_are_whole_on_80_columns() -> None:
    cut = []
    for name in lesson_names():
        lesson = read_lesson(lessons_folder() / name)
        stand = lesson_progress_from_events(lesson, [])
        for step in lesson.steps:
            shown = row_text(lesson_rows.heading(stand, step, 80))
            assert f"{lesson.number} {lesson.title}" in shown
            assert f"step {step.number} of {len(lesson.steps)}" in shown
            assert len(shown.rstrip()) <= 80
            if step.goal not in shown:
                cut.append(f"{lesson.number} step {step.number}: {step.goal}")
    assert cut == []


def test_a_verdict_names_points_and_what_was_wanted() -> None:
    told = "\n".join(map(row_text, shown(verdict_blocks(REPORT, (LessonHint(LOST, 1, "Go."),)))))
    assert "[ok] It runs: 1 of 1" in told
    assert "[no] It comes near" in told
    assert "0.5 of 3" in told
    assert "expected: 0.2 m" in told
    assert "actual:   1.7 m" in told
    assert told.index("actual:") < told.index("Hint 1 of 3: Go.")


def test_one_mistake_that_loses_many_criteria_is_said_once(lesson: Lesson) -> None:
    def lost(name: str, rationale: str) -> CriterionResult:
        return CriterionResult(name, name, CriterionStatus.STUDENT_ERROR, 0, 1, rationale=rationale)

    again = "The same mistake as in “first”."
    criteria = (lost("first", "It stopped."), *(lost(name, again) for name in ("second", "third", "fourth")))
    told = "\n".join(
        map(row_text, shown(verdict_blocks(replace(REPORT, result=replace(RESULT, tests=criteria)), ())))
    )
    assert all(name in told for name in ("second: 0 of 1", "third: 0 of 1", "fourth: 0 of 1", "It stopped."))
    assert told.count("The same mistake") == 1


def test_a_broken_check_is_nobodys_fault(lesson: Lesson, stand: LessonProgress) -> None:
    broken = replace(REPORT, verdict=GradingVerdict.BROKEN, result=None, problem="The check broke: no disk")
    assert "The check broke: no disk" in "\n".join(map(row_text, shown(verdict_blocks(broken, ()))))
    assert "itself failed" in status_text(broken, stand, lesson.exercises[-1]).text


def test_a_right_prediction_and_a_wrong_one(lesson: Lesson) -> None:
    step = lesson.steps[0]
    right = "\n".join(map(row_text, shown(feedback_blocks(step, step.options[0]))))
    assert "It goes ahead while there is room." in right
    assert "Only a wall" not in right
    wrong = "\n".join(map(row_text, shown(feedback_blocks(step, step.options[1]))))
    assert wrong.index("Only a wall") < wrong.index("It goes ahead")


@pytest.mark.parametrize("name", lesson_names())
def test_every_question_is_in_sight_at_80x24_with_the_scene_and_some_words(name: str) -> None:
    for step in find_lesson(name).steps:
        asked = len(shown(question_blocks(step, None, is_told=False))) + 1 if step.options else 0
        picture = LEAST_PICTURE if step.scene is not None else len(step.picture.splitlines())
        fixed = 3 + (2 if step.exercise is not None else 0)  # heading, title, keys; file and status
        assert 24 - fixed - asked - picture >= 3, f"{name} step {step.number}: no room for the words"


def test_a_running_check_fits_into_a_line() -> None:
    lines: list[str] = []
    progress = TrainingProgressReport(SubmissionClock(show_progress=lines.append), 10, 10, 120_000)
    for steps in range(10_000, 120_000, 10_000):
        progress.add_test(steps, 1.0)
    line = row_text(lesson_rows.checking(123.4, lines[-1], 80))
    assert "training 10 of 10" in line
    assert len(line) <= 80
    assert "Checking" in row_text(lesson_rows.checking(0.4, "", 80))


def test_what_does_not_fit_of_a_running_check_gives_way_in_whole_words() -> None:
    doing = "public cases: 3 of 6 criteria passed; episode 3 of 3: around, secret seed 1"
    assert row_text(lesson_rows.checking(10.4, doing, 120)).endswith("secret seed 1")
    assert row_text(lesson_rows.checking(10.4, doing, 80)).endswith("episode 3 of 3: around")


def test_what_is_not_graded_is_explained_once_for_neighbours() -> None:
    waits = [
        CriterionResult(name, name, CriterionStatus.SKIPPED, 0, 1, rationale="First pass “It runs”.")
        for name in ("near", "quick", "neat")
    ]
    broken = replace(LOST, id="runs", title="It runs", hints=())
    result = replace(RESULT, tests=(broken, *waits))
    rows = shown(verdict_blocks(CheckReport(GradingVerdict.FAIL, result, 1.25), []))
    assert [row_text(each).strip() for each in rows[-4:]] == [
        *(f"[--] {each.title}: 0 of 1" for each in waits),
        "First pass “It runs”.",
    ]


def test_one_mistake_that_several_criteria_lose_by_is_told_once_for_neighbours() -> None:
    broken = replace(LOST, id="a", title="A", hints=(), rationale="mine.yaml:2:1: no YAML.")
    same = [replace(broken, id=name, title=name, rationale="The same mistake as in “A”.") for name in "bcd"]
    other = replace(broken, id="e", title="e", rationale="Another one.")
    result = replace(RESULT, tests=(broken, *same, other))
    told = " ".join(
        row_text(each).strip()
        for each in shown(verdict_blocks(CheckReport(GradingVerdict.FAIL, result, 1.25), []))
    )
    assert told.count("The same mistake") == 1
    places = [
        told.index(each) for each in ("no YAML", " b:", " c:", " d:", "The same mistake", "Another one")
    ]
    assert places == sorted(places)


def test_what_has_passed_moves_from_left_to_right_once() -> None:
    def written(seconds: float) -> str:
        return "".join(part for part, _ in lesson_rows.passing(seconds))

    times = [lesson_rows.PASSED_S * number / 20 for number in range(22)]
    lines = [written(each) for each in times]
    stars = [line.count("*") for line in lines]
    assert stars == sorted(stars)
    assert stars[0] == 0
    assert stars[-1] == stars[-2] == lesson_rows.PASSED_CELLS
    assert all(line.startswith("  Passed: ") and line.endswith(">") and line.isascii() for line in lines)


def test_that_a_criterion_was_not_graded_is_said_of_the_first_of_a_chain_alone() -> None:
    def skipped(name: str, after: str) -> CriterionResult:
        told = f"Not graded: pass {after} first."
        return CriterionResult(
            name, name, CriterionStatus.SKIPPED, 0.0, 1.0, rationale=told, depends_on=after
        )

    chain = (LOST, skipped("b", LOST.id), skipped("c", "b"), skipped("d", "c"))
    told = "\n".join(
        map(row_text, shown(verdict_blocks(replace(REPORT, result=replace(REPORT.result, tests=chain)), ())))
    )
    assert told.count("Not graded") == 1
    assert told.index("[--] b") < told.index("Not graded") < told.index("[--] c") < told.index("[--] d")
