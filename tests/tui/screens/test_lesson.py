"""A lesson's screen, without a terminal: each kind of step, and what its keys do."""

from __future__ import annotations

import shutil
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path

import pytest
from textual import events
from textual.pilot import Pilot
from textual.screen import Screen

from kit.run.view import View
from kit.school.lessons import aside, checking
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.reading import read_lesson
from kit.school.lessons.records import StepKind
from kit.school.progress import EventKind, ProgressJournal
from kit.tui.rows import lesson_rows
from kit.tui.screens.lesson import LessonScreen
from kit.tui.theme import Theme
from kit.tui.widgets.lesson_scene_view import LessonSceneView
from kit.tui.widgets.program_colours import MOST_COLOURED
from kit.tui.widgets.program_editor import MAX_BYTES, ProgramEditor
from kit.workspace import Workspace, open_workspace
from tests.kit_content import kit_lesson
from tests.tui.lesson_folder import STILL, TURNING, write_lessons, write_solutions
from tests.tui.lesson_stage import ROBOT, Scene, rows, seen, stage, text, until
from tests.tui.tape import painted

WHY, COLOUR, CORNER = 3, 4, 5
LAST_WORDS = "It goes round."
"""Of the step that is read."""
"""Numbers of the steps with exercises."""


class Student:
    """A student in the lesson of the tests."""

    def __init__(self, folder: Path) -> None:
        self.workspace: Workspace = open_workspace(folder / "home")
        self.progress = ProgressJournal(self.workspace.folder)
        self.lesson = write_lessons(folder / "lessons") / "01-colours"

    @property
    def file(self) -> Path:
        return self.workspace.lessons / "01-colours" / "colour" / "answers.yaml"

    def screen(self, theme: Theme) -> Screen[None]:
        return LessonScreen(
            theme, LessonSession(read_lesson(self.lesson), self.progress, self.workspace), self.workspace
        )

    def goes_to(self, step: int) -> None:
        """Has gone through all steps before, but for their exercises."""
        for number in range(1, step):
            self.progress.add(EventKind.STEP, f"01-colours/{number}")
            if number == COLOUR:
                self.passes()

    def passes(self) -> None:
        points = {"points": 2.0, "max_points": 2.0, "verdict": "pass"}
        self.progress.add(EventKind.ATTEMPT, "01-colours/colour", points)

    def kinds(self) -> list[EventKind]:
        return [event.kind for event in self.progress.events()]


@pytest.fixture
def student(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Student]:
    solutions = write_solutions(tmp_path / "solutions")
    monkeypatch.setattr(checking, "solutions_folder", lambda: solutions)
    made = Student(tmp_path)
    yield made
    made.progress.close()


class HeldChecks:
    """Checks that say nothing while they are held: what is shown meanwhile does not depend on how long one takes."""

    def __init__(self) -> None:
        self.is_held = False

    def hold(self) -> None:
        self.is_held = True

    def let_go(self) -> None:
        self.is_held = False


@pytest.fixture
def checks(monkeypatch: pytest.MonkeyPatch) -> HeldChecks:
    held, poll, progress = HeldChecks(), checking.ExerciseCheck.poll, vars(checking.ExerciseCheck)["progress"]
    silent = property(lambda check: "" if held.is_held else progress.fget(check))
    monkeypatch.setattr(checking.ExerciseCheck, "progress", silent)
    monkeypatch.setattr(checking.ExerciseCheck, "poll", lambda check: None if held.is_held else poll(check))
    return held


Play = Callable[[Scene], None]


@pytest.fixture
def play(student: Student) -> Play:
    def run(scene: Scene) -> None:
        stage(student.screen, scene)

    return run


@pytest.mark.long
def test_a_prediction_is_kept_before_anything_moves(student: Student, play: Play) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        assert "step 1 of 5" in rows(pilot)[0]
        assert "Foresee a walk" in rows(pilot)[0]
        await seen(pilot, "waiting for your prediction")
        await seen(pilot, "▲")
        assert "Only a wall makes it turn." not in text(pilot)
        await pilot.press("n")
        assert "step 1 of 5" in rows(pilot)[0]
        assert "Predict first" in rows(pilot)[1]
        assert "1-3 predict" in rows(pilot)[-1], "the keys that work stay in sight"
        await pilot.resize_terminal(60, 24)
        await pilot.press("n")
        title = read_lesson(student.lesson).steps[0].title
        assert title in rows(pilot)[1], "what is said has a row of its own where it would cut the title"
        assert "Predict first" in rows(pilot)[-3]
        await pilot.resize_terminal(80, 24)
        await pilot.press("2")
        await seen(pilot, "finished")
        await seen(pilot, "Only a wall makes it turn.")
        assert "It goes ahead while there is room." in text(pilot)
        assert "+ 1  It drives ahead." in text(pilot)
        assert "x 2  It turns on the spot." in text(pilot)
        await pilot.press("1")
        assert "x 2  It turns on the spot." in text(pilot)
        await pilot.press("n")
        assert "step 2 of 5" in rows(pilot)[0]
        await pilot.press("b")
        assert "x 2  It turns on the spot." in text(pilot)

    play(scene)
    [noted] = student.progress.events(EventKind.PREDICTION)
    assert noted.content == {"chosen": 1, "right": False}
    assert [event.subject for event in student.progress.events(EventKind.STEP)] == ["01-colours/1"]


@pytest.mark.long
def test_what_passed_is_said_in_its_own_step_alone(
    student: Student, play: Play, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(lesson_rows, "PASSED_S", 3600.0)
    student.goes_to(COLOUR)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "Save the file")
        student.file.write_text("colour: green\n")
        await seen(pilot, "Passed: >")
        await pilot.press("n")
        assert f"step {CORNER} of 5" in rows(pilot)[0]
        assert "Passed" not in text(pilot)
        await pilot.press("b")
        assert "Passed: >" in text(pilot)

    play(scene)


@pytest.mark.long
def test_who_does_not_want_to_wait_is_told_at_once(student: Student, play: Play) -> None:
    sheet = student.lesson / "lesson.yaml"
    sheet.write_text(sheet.read_text().replace("seconds: 1}", "seconds: 600}"))

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "waiting for your prediction")
        await pilot.press("1", "n")
        assert "It goes ahead while there is room." in text(pilot)
        assert "step 1 of 5" in rows(pilot)[0]
        await pilot.press("n")
        assert "step 2 of 5" in rows(pilot)[0]

    play(scene)


def test_commands_a_picture_and_words(student: Student, play: Play) -> None:
    student.goes_to(2)

    async def scene(pilot: Pilot[None]) -> None:
        assert "(o) red" in text(pilot)
        assert "    kit maps" in text(pilot)
        assert "    kit keys" in text(pilot)
        await pilot.press("n")
        assert "- green" in text(pilot)

    play(scene)


@pytest.mark.long
@pytest.mark.parametrize(
    ("size", "words"), [((80, 24), 1), ((80, 24), 6), ((120, 35), 1), ((200, 50), 1)], ids=str
)
def test_a_step_that_is_read_has_the_last_world_beside_it_where_there_is_room(
    student: Student, size: tuple[int, int], words: int
) -> None:
    sheet = student.lesson / "lesson.yaml"
    sheet.write_text(sheet.read_text().replace(LAST_WORDS, "\n\n      ".join([LAST_WORDS] * words)))
    is_large, is_seen = size[0] > 80, words == 1
    read = next(each for each in read_lesson(student.lesson).steps if each.kind is StepKind.EXPLAIN)
    student.goes_to(read.number)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, read.title)
        if is_seen:
            await until(pilot, lambda: set(text(pilot)) & set(ROBOT), "the robot of the first step")
            assert LAST_WORDS in " ".join(text(pilot).split()), "the words are whole"
        assert bool(set(text(pilot)) & set(ROBOT)) is is_seen
        assert bool(steps_row(pilot)) is is_large
        assert all(len(line) <= size[0] for line in rows(pilot))

    stage(student.screen, scene, size=size)


@pytest.mark.long
def test_enter_after_the_last_step_opens_the_next_lesson(student: Student, play: Play) -> None:
    following = shutil.copytree(student.lesson, student.lesson.parent / "02-shapes")
    sheet = following / "lesson.yaml"
    sheet.write_text(sheet.read_text().replace("title: Colours", "title: Shapes", 1))
    student.goes_to(CORNER)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "step 5 of 5")
        await pilot.press("n")
        await seen(pilot, "Enter opens the next lesson, 2 Shapes.")
        await pilot.press("enter")
        await seen(pilot, "step 1 of 5")
        assert "Shapes" in rows(pilot)[0]

    play(scene)


@pytest.mark.long
def test_a_save_is_checked_and_a_pass_goes_nowhere_by_itself(student: Student, play: Play) -> None:
    student.goes_to(COLOUR)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "Save the file")
        await pilot.press("h")
        await seen(pilot, "Check first")
        await pilot.press("s")
        await seen(pilot, "once yours passes")
        student.file.write_text("colour: red\n")
        await seen(pilot, "Checking ...")
        await pilot.press("c", "x", "h")  # a check has the keys for itself
        await seen(pilot, "[no] The colour")
        assert "That one means stop." in text(pilot)
        assert "expected:" not in text(pilot), "the sentence has said it"
        for number, hint in enumerate(("Look up.", "It grows on trees.", "It is green."), 1):
            await pilot.press("h")
            await seen(pilot, f"Hint {number}")
            assert hint in text(pilot)
        await pilot.press("h")
        await seen(pilot, "seen all hints")
        student.file.write_text("colour: green\n")
        await seen(pilot, "Passed:")
        assert "step 4 of 5" in rows(pilot)[0]
        await pilot.press("s")
        await seen(pilot, "# go")
        await pilot.press("escape")
        await seen(pilot, "Passed:")
        await pilot.press("n")
        assert "step 5 of 5" in rows(pilot)[0]

    play(scene)
    told = [
        (each.kind, dict(each.content)) for each in student.progress.events() if "/colour" in each.subject
    ]
    assert [kind for kind, _ in told] == [
        EventKind.ATTEMPT,
        *[EventKind.HINT] * 3,
        EventKind.ATTEMPT,
        EventKind.SOLUTION,
    ]
    assert told[0][1]["lost"] == ["colour"]
    assert told[4][1]["verdict"] == "pass"


@pytest.mark.long
def test_beginning_again_is_asked_for_and_keeps_what_was_there(student: Student, play: Play) -> None:
    student.goes_to(COLOUR)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "Save the file")
        student.file.write_text("colour: mine\n")
        await seen(pilot, "[no]")
        await pilot.press("x")
        await seen(pilot, "x once more starts this exercise over")
        await pilot.press("u")  # something else: not meant
        assert "step 4 of 5" in rows(pilot)[0]
        await pilot.press("x")
        assert "mine" in student.file.read_text()
        await pilot.press("x")
        await seen(pilot, "Started over.")

    play(scene)
    assert student.file.read_text() == "colour:\n"
    [kept] = [each for each in student.file.parent.parent.iterdir() if each.name.startswith("colour.")]
    assert (kept / "answers.yaml").read_text() == "colour: mine\n"


@pytest.mark.long
def test_what_went_wrong_moves_again_and_what_was_printed_is_shown(student: Student, play: Play) -> None:
    student.goes_to(CORNER)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "controller.py")
        await pilot.press("c")
        await seen(pilot, "[no] It reaches the target")
        await pilot.press("u")
        await seen(pilot, "here I stand")
        await pilot.press("escape")
        await pilot.press("w")
        await seen(pilot, "to target")
        await pilot.press("escape")
        await seen(pilot, "[no] It reaches the target")

    play(scene)


@pytest.mark.long
def test_a_check_goes_on_while_another_step_is_looked_at(
    student: Student, play: Play, checks: HeldChecks
) -> None:
    student.goes_to(CORNER)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "controller.py")
        checks.hold()
        await pilot.press("c")
        assert "Checking ..." in text(pilot), "at once, and not when the check says its first word"
        await pilot.press("b", "b")
        assert "step 3 of 5" in rows(pilot)[0]
        assert "Step 5 is being checked" in text(pilot)
        checks.let_go()
        await seen(pilot, "The check of step 5 has ended: not yet passed.")
        await pilot.press("n", "n")
        await seen(pilot, "It reaches the target: 0 of 3")

    play(scene)
    assert any(event.subject.endswith("/corner") for event in student.progress.events())


@pytest.mark.long
def test_the_end_says_what_is_open_and_any_step_can_be_gone_to(student: Student, play: Play) -> None:
    student.goes_to(CORNER)

    async def scene(pilot: Pilot[None]) -> None:
        await pilot.press("n")
        await seen(pilot, "Not done yet:")
        assert "5  Round the corner" in text(pilot)
        await pilot.press("l")
        await seen(pilot, "[x] 3")
        await pilot.press("up", "enter")
        await seen(pilot, "step 4 of 5")

    play(scene)


def test_a_journal_that_cannot_be_written_is_told_and_the_step_stays(
    student: Student, play: Play, monkeypatch: pytest.MonkeyPatch
) -> None:
    student.goes_to(3)
    monkeypatch.setattr("kit.school.progress.LOCK_TIMEOUT_S", 0.0)

    async def scene(pilot: Pilot[None]) -> None:
        with closing(sqlite3.connect(student.workspace.folder / "progress.db")) as other:
            other.execute("DROP TABLE events")
            other.commit()
        await pilot.press("n")
        await seen(pilot, "could not be saved")
        await pilot.press("space")
        assert "step 3 of 5" in rows(pilot)[0]

    play(scene)


@pytest.mark.parametrize("size", [(60, 18), (80, 24), (200, 50)], ids=lambda size: f"{size[0]}x{size[1]}")
@pytest.mark.parametrize("step", [1, 2, 4])
def test_where_one_is_and_the_keys_are_always_in_sight(
    student: Student, step: int, size: tuple[int, int]
) -> None:
    student.goes_to(step)

    async def scene(pilot: Pilot[None]) -> None:
        await pilot.pause(0.1)
        shown = rows(pilot)
        assert len(shown) == size[1]
        assert f"step {step} of 5" in shown[0]
        assert "help" in shown[-1]
        assert "back" in shown[-1]
        if step == 1:
            assert all(f"{number}  " in text(pilot) for number in (1, 2, 3))
            assert "A robot stands in a corridor." in text(pilot)
        if step == COLOUR:
            assert str(student.file) in "".join(row.strip() for row in shown)

    stage(student.screen, scene, size=size)


@pytest.mark.long
def test_ascii_means_ascii_everywhere(student: Student) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "waiting for your prediction")
        await seen(pilot, "^")
        assert text(pilot).isascii()
        await pilot.press("2")
        await seen(pilot, "finished")
        assert text(pilot).isascii()

    stage(student.screen, scene, ascii_only=True)


@pytest.mark.long
@pytest.mark.parametrize(("program", "is_played"), [(TURNING, True), (STILL, False)])
def test_a_pass_plays_the_students_own_run_which_stays(
    student: Student, play: Play, program: str, *, is_played: bool
) -> None:
    """A robot that stands still is nothing to see: its run takes no room from the text."""
    (student.lesson / "corner" / "starter.py").write_text(program)
    student.goes_to(CORNER)
    assignment = student.lesson / "corner" / "assignment.yaml"
    assignment.write_text(
        "\n".join(line for line in assignment.read_text().splitlines() if "check: reached" not in line)
    )

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "step 5 of 5")
        await pilot.press("c")
        await seen(pilot, "Passed: ***")
        if is_played:
            await seen(pilot, "your run: r shows it again")
            assert pilot.app.screen.query_one(LessonSceneView).display
        assert "[ok] It runs" in text(pilot)
        await pilot.press("w")
        await seen(pilot, "your last run")
        await pilot.press("escape")
        await seen(pilot, "step 5 of 5")
        assert ("your run" in text(pilot)) == is_played

    async def again(pilot: Pilot[None]) -> None:
        await pilot.press("l", "end", "enter")
        await seen(pilot, "Passed before.")
        await pilot.press("w")
        await seen(pilot, "your last run")

    play(scene)
    play(again)


@pytest.mark.long
def test_a_hint_and_the_first_lost_criterion_come_into_sight(
    student: Student, play: Play, checks: HeldChecks
) -> None:
    student.goes_to(COLOUR)
    sheet = student.lesson / "lesson.yaml"
    sheet.write_text(
        sheet.read_text().replace("text: Write", "text: |\n" + "      word\n\n" * 8 + "      Write")
    )
    student_hint = "A long hint. " * 12 + "Its end."
    assignment = student.lesson / "colour" / "assignment.yaml"
    assignment.write_text(assignment.read_text().replace("Look up.", student_hint))

    async def scene(pilot: Pilot[None]) -> None:
        await pilot.press("c")
        await seen(pilot, "[no] The colour")
        checks.hold()
        await pilot.press("c")
        assert "[no] The colour" not in text(pilot), "an old verdict while the new check runs"
        checks.let_go()
        await seen(pilot, "[no] The colour")
        for number in range(1, 4):
            await pilot.press("h")
            await seen(pilot, f"Hint {number} of 3")

    play(scene)


def test_a_page_down_passes_over_no_line(student: Student) -> None:
    sheet = student.lesson / "lesson.yaml"
    words = [f"word{number}" for number in range(9)]
    listed = "".join(f"      - {word}\n" for word in words)
    sheet.write_text(sheet.read_text().replace("text: |\n      A robot", f"text: |\n{listed}\n      A robot"))
    found: set[str] = set()

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "waiting for your prediction")
        await seen(pilot, "more lines: down")
        for _ in words:
            found.update(text(pilot).split())
            await pilot.press("pagedown")
            await painted(pilot.app)

    stage(student.screen, scene, size=(80, 19))
    assert set(words) <= found


@pytest.mark.sampled(2)
@pytest.mark.parametrize("size", [(120, 30), (120, 35), (200, 50)])
def test_a_large_terminal_shows_the_file_beside_the_words(student: Student, size: tuple[int, int]) -> None:
    student.goes_to(COLOUR)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "1 colour:")
        assert "what is checked, and its points" in text(pilot)
        student.file.write_text("# mine\ncolour: red\n")
        await seen(pilot, "1 # mine")
        words = next(number for number, line in enumerate(rows(pilot)) if "Write the colour into" in line)
        mine = next(number for number, line in enumerate(rows(pilot)) if "# mine" in line)
        assert mine < words + 3, "beside the words, which have all rows for what is said to the work"
        assert f"step {COLOUR - 1}: Why" in text(pilot), "the step that was read before"

    async def below(pilot: Pilot[None]) -> None:
        await seen(pilot, "1 # mine")
        shown = text(pilot)
        assert shown.index("Write the colour into") < shown.index("# mine")

    async def small(pilot: Pilot[None]) -> None:
        await seen(pilot, "Write the colour into")
        assert "# mine" not in text(pilot)
        await pilot.press("tab")
        await seen(pilot, "# mine")
        assert "Write the colour into" not in text(pilot)
        await pilot.press("tab")
        await seen(pilot, "Write the colour into")

    stage(student.screen, scene, size=size)
    stage(student.screen, below)
    stage(student.screen, small, size=(80, 14))


@pytest.mark.long
def test_a_large_terminal_shows_the_world_below_a_short_file_and_then_what_the_program_did(
    student: Student,
) -> None:
    """Also of a check that failed; a still scene does not say that anything is shown again."""
    (student.lesson / "corner" / "starter.py").write_text(TURNING)
    student.goes_to(CORNER)

    async def scene(pilot: Pilot[None]) -> None:
        await until(pilot, lambda: any(each in text(pilot) for each in ROBOT), "the robot")
        shown = rows(pilot)
        robot = next(number for number, line in enumerate(shown) if any(each in line for each in ROBOT))
        assert robot > next(number for number, line in enumerate(shown) if line.startswith(" 1 "))
        assert "r restart" not in shown[-1]
        titles = [(number, line.index("── ")) for number, line in enumerate(shown) if "── " in line]
        assert len(titles) >= 2
        await pilot.press("c")
        await seen(pilot, "[no] It reaches the target")
        shown = rows(pilot)
        assert titles == [(number, line.index("── ")) for number, line in enumerate(shown) if "── " in line]
        await seen(pilot, "your run: r shows it again")
        assert "[no] It reaches the target" in text(pilot)

    async def checks(pilot: Pilot[None]) -> None:
        await seen(pilot, "what is checked, and its points")
        lines = rows(pilot)
        checked = next(line for line in lines if "what is checked" in line)
        told = next(line for line in lines if "── steps ─" in line)
        assert checked.index("what is checked") == told.index("steps"), (
            "above the steps, where the words leave room"
        )

    async def small(pilot: Pilot[None]) -> None:
        await pilot.press("c")
        await seen(pilot, "[no] It reaches the target")
        await pilot.pause(0.5)
        assert not pilot.app.screen.query_one(LessonSceneView).display, "the words need the room"

    stage(student.screen, checks, size=(200, 50))
    stage(student.screen, scene, size=(200, 50))
    stage(student.screen, small)


@pytest.mark.long
def test_few_rows_below_the_words_show_where_the_program_begins(student: Student) -> None:
    head = '"""What it does."""\n\n' + "import math\n" * 30
    (student.lesson / "corner" / "starter.py").write_text(f"{head}\n{TURNING}")
    student.goes_to(CORNER)
    begins = next(line for line in TURNING.splitlines() if line.startswith(("class", "def")))

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, begins)

    stage(student.screen, scene)


@pytest.mark.long
def test_a_world_that_stands_beside_a_step_says_which_steps_it_is(student: Student) -> None:
    student.goes_to(WHY)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "the world of step 1")
        assert pilot.app.screen.query_one(LessonSceneView).display

    stage(student.screen, scene, size=(200, 50))
    stage(student.screen, scene)


LONG_LINE = f"LONGEST = {'7 + ' * 16}7 + 7"
"""79 columns of code, as many as a line of a program usually has at most."""


@pytest.mark.long
@pytest.mark.parametrize("size", [(120, 35), (200, 50)], ids=str)
def test_a_long_program_is_whole_in_its_width_with_the_world_near_it_before_a_check(
    student: Student, size: tuple[int, int]
) -> None:
    numbered = "".join(f"N{number} = {number}\n" for number in range(60))
    (student.lesson / "corner" / "starter.py").write_text(f"{LONG_LINE}\n{numbered}{TURNING}")
    student.goes_to(CORNER)
    assert len(LONG_LINE) == 79

    async def scene(pilot: Pilot[None]) -> None:
        await until(pilot, lambda: any(each in text(pilot) for each in ROBOT), "the robot")
        await pilot.press("tab", "home")
        await seen(pilot, LONG_LINE)
        seen_lines = {line.split()[0] for line in rows(pilot) if line.strip()}
        while "N59" not in text(pilot):  # each key goes on, and passes over no line
            await pilot.press("pagedown")
            seen_lines |= {line.split()[0] for line in rows(pilot) if line.strip()}
        assert {str(number) for number in range(1, 62)} <= seen_lines
        words = text(pilot)
        await pilot.press("tab")
        await until(
            pilot, lambda: "Tab" in text(pilot) and text(pilot) != words, "the task is scrolled again"
        )
        assert "N59" in text(pilot), "the program stays where it was scrolled to"

    stage(student.screen, scene, size=size)


@pytest.mark.long
@pytest.mark.parametrize("size", [(80, 24), (120, 35)], ids=str)
def test_a_program_that_python_cannot_read_shows_the_line_and_where_it_stops(
    student: Student, size: tuple[int, int]
) -> None:
    student.goes_to(CORNER)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "step 5")
        file = student.workspace.lessons / "01-colours" / "corner" / "controller.py"
        text_before = file.read_text()
        file.write_text(f"{text_before}\nwrong = = 1\n")
        await seen(pilot, "SyntaxError")
        if size == (80, 24):
            await pilot.press("tab")
        await until(pilot, lambda: any("^ SyntaxError" in line for line in rows(pilot)), "the caret")
        shown = rows(pilot)
        at = next(number for number, line in enumerate(shown) if "^ SyntaxError" in line)
        assert "wrong = = 1" in shown[at - 1]
        assert shown[at].index("^") == shown[at - 1].index("= 1")

    stage(student.screen, scene, size=size)


def steps_row(pilot: Pilot[None]) -> int:
    """The row in which the list of steps begins; 0 without one."""
    return next((number for number, line in enumerate(rows(pilot)) if "── steps ─" in line), 0)


@pytest.mark.long
def test_a_large_terminal_lists_the_steps_which_stay_where_they_are(student: Student) -> None:
    student.progress.add(EventKind.STEP, "01-colours/2")

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "waiting for your prediction")
        await seen(pilot, "▲")
        lines, at = rows(pilot), steps_row(pilot)
        assert at
        steps = read_lesson(student.lesson).steps
        for step, line in zip(steps, lines[at + 1 :], strict=False):
            mark = {1: "[>]", 2: "[x]"}.get(step.number, "[ ]")
            assert mark in line
            assert step.title in line
        await pilot.press("2")
        await seen(pilot, "finished")
        await seen(pilot, "Only a wall makes it turn.")
        assert steps_row(pilot) == at, "the answer has its place above"

    async def small(pilot: Pilot[None]) -> None:
        await seen(pilot, "step 1 of")
        assert not steps_row(pilot)

    stage(student.screen, scene, size=(200, 50))
    stage(student.screen, small)


@pytest.mark.long
def test_code_to_read_is_not_broken_where_the_screen_has_room(student: Student) -> None:
    file = student.lesson / "lesson.yaml"
    code = "self.create_subscription(LaserScan, 'static_laser', self.on_scan, 10)"
    before = "      It goes round.\n"
    assert before in file.read_text()
    file.write_text(file.read_text().replace(before, f"{before}\n          {code}\n"))
    read = next(each for each in read_lesson(student.lesson).steps if each.kind is StepKind.EXPLAIN)
    student.goes_to(read.number)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, read.title)
        assert any(code in line for line in rows(pilot)), text(pilot)

    stage(student.screen, scene, size=(120, 35))


@pytest.mark.long
def test_a_passed_program_is_defended(student: Student, play: Play) -> None:
    student.goes_to(CORNER)
    assignment = student.lesson / "corner" / "assignment.yaml"
    assignment.write_text(
        "\n".join(line for line in assignment.read_text().splitlines() if "check: reached" not in line)
    )

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "step 5 of 5")
        await pilot.press("y")
        assert "Question" not in text(pilot)
        await pilot.press("c")
        await seen(pilot, "Passed: ***")
        await pilot.press("y")
        await seen(pilot, "question 1 of 3")
        assert pilot.app.screen.query_one(LessonSceneView).size.height > 10, "where the robot starts"
        await pilot.press("3", "1")  # there is no third answer
        await seen(pilot, "question 2 of 3")
        await pilot.press("3")
        await seen(pilot, "question 3 of 3")
        await pilot.press("1")
        await seen(pilot, "All correct: one more star.")
        await pilot.press("escape")
        await seen(pilot, "step 5 of 5")

    play(scene)
    [event] = student.progress.events(EventKind.DEFENCE)
    assert (event.subject, dict(event.content)) == ("01-colours/corner", {"asked": 3, "right": 3})


@pytest.mark.long
def test_reduced_motion_shows_the_beginning_and_the_end_alone(
    student: Student, monkeypatch: pytest.MonkeyPatch
) -> None:
    sheet = student.lesson / "lesson.yaml"
    sheet.write_text(sheet.read_text().replace("seconds: 1}", "seconds: 20}"))
    arrived: list[View] = []
    drawn: list[object] = []
    before = LessonSceneView._view_arrived

    def arrive(self: LessonSceneView, view: View) -> None:
        before(self, view)
        arrived.append(view)
        if self._picture not in drawn:
            drawn.append(self._picture)

    monkeypatch.setattr(LessonSceneView, "_view_arrived", arrive)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "waiting for your prediction")
        await pilot.press("1")
        await seen(pilot, "finished")

    stage(student.screen, scene, environ={"KIT_REDUCE_MOTION": "1"})
    assert len({view.time_s for view in arrived}) > 3
    assert {view.time_s for view in arrived if view.scene in drawn} == {0.0, 20.0}


@pytest.mark.parametrize("is_still", [False, True])
def test_passed_moves_once_unless_motion_is_reduced(
    student: Student, monkeypatch: pytest.MonkeyPatch, is_still: bool
) -> None:
    student.goes_to(COLOUR)
    told: list[float] = []
    before = lesson_rows.passing
    monkeypatch.setattr(lesson_rows, "passing", lambda seconds: told.append(seconds) or before(seconds))

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "Save the file")
        student.file.write_text("colour: green\n")
        await seen(pilot, "Passed: *** 2 of 2 points")

    stage(student.screen, scene, environ={"KIT_REDUCE_MOTION": "1"} if is_still else {})
    assert bool(told) is not is_still
    assert told == sorted(told), "it moved more than once"


# The kit's own editor


def editor_of(pilot: Pilot[None]) -> ProgramEditor:
    return pilot.app.screen.query_one(ProgramEditor)


async def opened_editor(pilot: Pilot[None], key: str = "ctrl+e") -> ProgramEditor:
    """Opens the editor of the exercise and waits until one writes in it."""
    await seen(pilot, "Save the file")
    await pilot.press(key)
    await seen(pilot, "^S save and check")
    return editor_of(pilot)


@pytest.mark.long
@pytest.mark.parametrize("size", [(80, 24), (120, 35), (160, 50)])
def test_who_writes_in_the_editor_sees_task_and_verdict(student: Student, size: tuple[int, int]) -> None:
    student.goes_to(COLOUR)

    async def scene(pilot: Pilot[None]) -> None:
        before = (await opened_editor(pilot)).area.text
        assert "Write the colour into" in text(pilot)
        await pilot.press("end", "space", *"red")
        assert "not saved" in text(pilot)
        assert f"step {COLOUR} of 5" in rows(pilot)[0], "letters are the program's, not keys of the lesson"
        await pilot.press("ctrl+s")
        await seen(pilot, "That one means stop.")
        assert student.file.read_text() == before.replace("\n", " red\n", 1)
        await pilot.press("ctrl+z", "ctrl+z")
        assert "not saved" in text(pilot)
        await pilot.press("ctrl+e")
        await seen(pilot, "^E write")
        await pilot.press("ctrl+e")
        await seen(pilot, "as you left it, not saved")

    stage(student.screen, scene, size=size)


@pytest.mark.long
def test_the_editor_opens_at_the_first_question_without_an_answer(student: Student) -> None:
    """Also where it is opened for the first time."""
    student.goes_to(COLOUR)
    student.file.parent.mkdir(parents=True)
    student.file.write_text("# a comment\n\ncolour:\n")

    async def scene(pilot: Pilot[None]) -> None:
        editor = await opened_editor(pilot)
        await until(pilot, lambda: editor.area.cursor_location == (2, len("colour:")), "the cursor there")
        await pilot.press("space", *"red", "ctrl+s")
        await seen(pilot, "That one means stop.")

    stage(student.screen, scene)


@pytest.mark.long
def test_the_line_of_an_error_is_marked_and_brought_into_sight(student: Student) -> None:
    student.goes_to(CORNER)

    async def scene(pilot: Pilot[None]) -> None:
        editor = await opened_editor(pilot)
        editor.area.load_text("\n" * 60 + "go = (\n" + "\n" * 30)
        await pilot.press("ctrl+s")
        await seen(pilot, "line 61: SyntaxError")
        assert editor.area._failed_line == 61
        await seen(pilot, "go = (")

    stage(student.screen, scene)


@pytest.mark.long
def test_the_editor_follows_the_file_and_overwrites_nothing_unasked(student: Student) -> None:
    student.goes_to(COLOUR)

    async def scene(pilot: Pilot[None]) -> None:
        editor = await opened_editor(pilot)
        student.file.write_text("colour: blue\n")
        await seen(pilot, "read again: it was saved elsewhere")
        assert editor.area.text == "colour: blue\n"
        await pilot.press("end", "x")
        student.file.write_text("colour: green\n")
        await pilot.press("ctrl+s")
        await seen(pilot, "changed elsewhere meanwhile")
        assert student.file.read_text() == "colour: green\n"
        await pilot.press("ctrl+s")
        await seen(pilot, "saved")
        assert student.file.read_text() == "colour: bluex\n"
        student.file.chmod(0o444)
        await pilot.press("y", "ctrl+s")
        await seen(pilot, "is read-only")
        assert student.file.read_text() == "colour: bluex\n"

    stage(student.screen, scene)


@pytest.mark.long
def test_in_the_editor_only_keys_that_work_there_are_named(student: Student) -> None:
    student.goes_to(COLOUR)

    async def scene(pilot: Pilot[None]) -> None:
        await opened_editor(pilot)
        assert "press c" not in text(pilot)
        assert "^S saves and checks" in text(pilot)
        await pilot.press("end", "space", "x", "ctrl+s")
        await seen(pilot, "[no] The colour")
        assert "Esc, then h" in text(pilot)
        await pilot.press("escape")
        await seen(pilot, "Press h for a hint")
        await pilot.press("h")
        await seen(pilot, "Hint 1 of 3")

    stage(student.screen, scene)


@pytest.mark.long
def test_what_was_typed_can_be_undone_after_the_file_was_read_again_and_the_editor_closed(
    student: Student,
) -> None:
    student.goes_to(COLOUR)

    async def scene(pilot: Pilot[None]) -> None:
        editor = await opened_editor(pilot)
        first = editor.area.text
        await pilot.press("end", "space", "a", "ctrl+s")
        typed = editor.area.text
        await until(pilot, lambda: editor.is_saved, "the saved text")
        student.file.write_text("colour: blue\n")
        await seen(pilot, "read again: it was saved elsewhere")
        await pilot.press("ctrl+z")
        assert editor.area.text == typed
        await pilot.press("ctrl+y")
        assert editor.area.text == "colour: blue\n"
        await pilot.press("ctrl+e")
        await seen(pilot, "^E write")
        await pilot.press("ctrl+e")
        await seen(pilot, "^S save and check")
        await pilot.press(*["ctrl+z"] * 5)
        assert editor.area.text == first

    stage(student.screen, scene)


@pytest.mark.long
def test_a_huge_paste_is_refused_and_a_large_one_is_not_coloured(student: Student) -> None:
    student.goes_to(CORNER)

    async def scene(pilot: Pilot[None]) -> None:
        editor = await opened_editor(pilot)
        before = editor.area.text
        pilot.app.post_message(events.Paste("x" * (MAX_BYTES + 1)))
        await seen(pilot, "not pasted")
        assert editor.area.text == before
        pilot.app.post_message(events.Paste("def go(): pass\n" * (MOST_COLOURED // 10)))
        await until(pilot, lambda: len(editor.area.text) > MOST_COLOURED, "what was pasted")
        assert not any(editor.area._highlights.values())
        await pilot.press("ctrl+z")
        await until(pilot, lambda: editor.area.text == before, "the text before")

    stage(student.screen, scene)


@pytest.mark.long
def test_without_an_easy_editor_e_opens_the_kits_own(
    student: Student, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("VISUAL", "EDITOR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(aside.shutil, "which", lambda name: None if name == "nano" else f"/usr/bin/{name}")
    student.goes_to(COLOUR)

    async def scene(pilot: Pilot[None]) -> None:
        await opened_editor(pilot, "e")
        await pilot.press("escape")
        await seen(pilot, "^E write")
        await pilot.press("n")
        assert f"step {CORNER} of 5" in rows(pilot)[0]
        assert not editor_of(pilot).display, "it was another exercise's file"

    stage(student.screen, scene)


@pytest.mark.long
def test_a_maze_in_ascii_is_seen_from_so_near_that_its_passages_are_open(student: Student) -> None:
    """All of it on nine rows would be a block of wall."""

    def screen(theme: Theme) -> Screen[None]:
        session = LessonSession(kit_lesson("01-drive"), student.progress, student.workspace)
        return LessonScreen(theme, session, student.workspace)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "waiting for your prediction")
        view = pilot.app.screen.query_one(LessonSceneView)

        def picture() -> list[str]:
            return [each.strip() for each in rows(pilot)[view.region.y : view.region.bottom]]

        await until(pilot, lambda: any("#" in each for each in picture()), "the maze")
        drawn = "".join(picture())
        assert drawn.count("#") < 0.6 * len(drawn)
        assert any(robot in drawn for robot in "v<>^")

    stage(screen, scene, ascii_only=True)
