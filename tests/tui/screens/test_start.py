"""The start screen, the list of lessons and the progress page, without a terminal."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from pathlib import Path
from threading import Event

import pytest
from textual.pilot import Pilot
from textual.screen import Screen

from kit.controllers import prepare_workspace
from kit.document.rows import Row
from kit.school.game.daily import daily_id, today
from kit.school.progress import FILE, EventKind, ProgressJournal
from kit.tui.screens.start import MENU, StartScreen
from kit.tui.student_store import StudentOverview, StudentStore
from kit.tui.theme import Theme
from kit.tui.widgets.text_rows import TextRows
from tests.kit_content import kit_bank, kit_lesson
from tests.tui.lesson_folder import write_lessons
from tests.tui.lesson_stage import ROBOT, Scene, rows, seen, stage, text, until
from tests.waiting import LIMIT_S


class House:
    """A student's home, and three lessons to go through."""

    def __init__(self, folder: Path) -> None:
        self.lessons = write_lessons(folder / "lessons", more=2)
        self.workspace = prepare_workspace(folder / "home")

    def note(self, *events: tuple[EventKind, str]) -> None:
        with ProgressJournal(self.workspace.folder) as progress:
            for kind, subject in events:
                progress.add(kind, subject)

    def open(self, theme: Theme) -> Screen[None]:
        return StartScreen(theme, StudentStore(self.workspace, self.lessons))

    def play(self, scene: Scene, size: tuple[int, int] = (80, 24)) -> None:
        stage(self.open, scene, size=size)


@pytest.fixture
def house(tmp_path: Path) -> House:
    return House(tmp_path)


@pytest.mark.long
def test_a_new_student_is_in_the_first_lesson_with_one_key(house: House) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await pilot.press("enter")
        await seen(pilot, "step 1 of 5")
        await seen(pilot, "waiting for your prediction")
        await pilot.press("escape")
        await seen(pilot, "Lesson 1, Colours")

    house.play(scene)


@pytest.mark.long
def test_a_letter_drives_while_the_arrows_choose_in_the_menu(house: House) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await until(pilot, lambda: set(ROBOT) & set(text(pilot)), "the robot")
        assert "a program drives" in rows(pilot)[0]
        await pilot.press("down")
        await until(pilot, lambda: "> 2" in text(pilot), "the second line to be chosen")
        assert "a program drives" in rows(pilot)[0]
        await pilot.press("w")
        await seen(pilot, "you drive")
        assert all(item.title in text(pilot) for item in MENU[1:])
        await pilot.press("g")
        await seen(pilot, "a program drives")

    house.play(scene)


@pytest.mark.long
def test_it_says_what_is_opened_and_nothing_once_that_was_left(
    house: House, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []
    show = TextRows.show

    def heard(rows: TextRows, content: Sequence[Row]) -> None:
        told.extend(text for row in content for text, _ in row)
        show(rows, content)

    monkeypatch.setattr(TextRows, "show", heard)

    async def scene(pilot: Pilot[None]) -> None:
        start = pilot.app.screen
        await pilot.press("2")
        await until(pilot, lambda: pilot.app.screen is not start, "the lessons")
        assert "Opening Lessons ..." in told
        await pilot.press("escape")
        await until(pilot, lambda: pilot.app.screen is start, "the start")
        await seen(pilot, "0 of 3 done")
        assert "Opening" not in text(pilot)

    house.play(scene)


@pytest.mark.long
def test_it_goes_on_where_the_student_left_off(house: House) -> None:
    house.note((EventKind.STEP, "02-colours2/1"), (EventKind.STEP, "02-colours2/2"))

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "Lesson 2, Colours, step")
        await pilot.press("enter")
        await seen(pilot, "step 3 of 5")
        await pilot.press("n", "escape")
        await seen(pilot, "4 of 5")
        assert "Lesson 2, Colours" in text(pilot)
        assert "0 of 3 done" in text(pilot)

    house.play(scene)


@pytest.mark.long
@pytest.mark.parametrize(("key", "wanted"), [("2", "[~] Colours"), ("1", "step 3 of 5")])
def test_a_key_pressed_at_once_after_coming_back_opens_what_is_true_now(
    house: House, monkeypatch: pytest.MonkeyPatch, key: str, wanted: str
) -> None:
    """The key comes while the progress is read again."""
    is_read, may_read = Event(), Event()
    read = StudentStore.read_overview

    def read_when_allowed(
        store: StudentStore, on_lessons: Callable[[StudentOverview], None]
    ) -> StudentOverview:
        may_read.wait()
        overview = read(store, on_lessons)
        is_read.set()
        return overview

    monkeypatch.setattr(StudentStore, "read_overview", read_when_allowed)

    async def scene(pilot: Pilot[None]) -> None:
        start = pilot.app.screen
        may_read.set()
        await until(pilot, is_read.is_set, "the progress to be read")
        await pilot.press("enter")
        await seen(pilot, "waiting for your prediction")
        house.note((EventKind.STEP, "02-colours2/1"), (EventKind.STEP, "02-colours2/2"))
        may_read.clear()
        await pilot.press("escape")
        await until(pilot, lambda: pilot.app.screen is start, "the start")
        await pilot.press(key)
        may_read.set()
        await until(pilot, lambda: pilot.app.screen is not start, "what the key opens")
        await seen(pilot, wanted)

    house.play(scene)


@pytest.mark.long
def test_the_list_of_lessons_says_what_each_is_about_and_opens_it(house: House) -> None:
    house.note((EventKind.STEP, "02-colours2/1"))
    (house.lessons / "03-colours3" / "lesson.yaml").write_text("title: broken\n")

    async def scene(pilot: Pilot[None]) -> None:
        await pilot.press("2")
        await seen(pilot, "0 of 3 done")
        await seen(pilot, "[~] Colours")
        assert "[!] 03-colours3" in text(pilot)
        assert "What a traffic light says." in text(pilot)
        assert "- Say what it says" in text(pilot)
        await pilot.press("down")
        assert "lesson.yaml" in text(pilot)
        await pilot.press("enter")
        await seen(pilot, "This lesson cannot be read")
        await pilot.press("space", "up", "enter")
        await seen(pilot, "step 2 of 5")
        await pilot.press("n", "escape")
        await seen(pilot, "■■")
        await pilot.press("escape")
        await seen(pilot, "Lesson 2")

    house.play(scene)


@pytest.mark.long
@pytest.mark.parametrize(
    ("key", "wanted", "back"),
    [("3", "random_walk", "backspace"), ("4", "stars", "escape"), ("5", "No trainings yet", "escape"),
     ("6", "What is asked", "escape"), ("7", "The twelve ideas", "escape"), ("8", "highest education", "escape"), ("9", "export your progress", "escape"), ("l", "Nobody is entered", "escape")],
    ids=[item.name for item in MENU[2:]],
)  # fmt: skip
def test_every_line_of_the_menu_opens_and_comes_back(house: House, key: str, wanted: str, back: str) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "Lesson 1")
        await pilot.press(key)
        await seen(pilot, wanted)
        await pilot.press(back)
        await seen(pilot, "Progress")
        await seen(pilot, "Lesson 1, Colours")

    house.play(scene)


@pytest.mark.long
def test_lines_are_chosen_with_tab_too(house: House) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await pilot.press("tab")
        assert "> 2  Lessons" in text(pilot)
        await pilot.press("shift+tab", "shift+tab", "enter")
        await seen(pilot, "Nobody is entered")

    house.play(scene)


@pytest.mark.long
def test_progress_says_what_was_passed(house: House) -> None:
    with ProgressJournal(house.workspace.folder) as progress:
        points = {"points": 2.0, "max_points": 2.0, "verdict": "pass"}
        progress.add(EventKind.ATTEMPT, "01-colours/colour", points)
        progress.add(EventKind.ATTEMPT, "01-colours/corner", {**points, "points": 1.0, "verdict": "fail"})

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "Lesson 1")
        await pilot.press("9")
        await seen(pilot, "colour ***, corner **.")
        assert "1 of 6 exercises passed" in text(pilot)
        assert "kit progress export FILE" in text(pilot)
        assert text(pilot).index("the game") < text(pilot).index("exercises passed")

    house.play(scene, (80, 75))


def test_a_wide_screen_shows_what_was_won_in_the_game_beside_the_lessons(house: House) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "Lesson 1")
        await pilot.press("9")
        await seen(pilot, "exercises passed")
        lines = rows(pilot)
        game = next(line.index("the game") for line in lines if "the game" in line)
        lesson = next(line.index("[ ] Colours") for line in lines if "[ ] Colours" in line)
        assert lesson - game >= 90  # it stands beside the rest
        assert "gold 0" in text(pilot)
        assert "export your progress" in text(pilot)

    house.play(scene, (200, 50))


def test_a_window_that_grows_gets_the_next_levels_picture(house: House) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "today")
        await pilot.resize_terminal(200, 50)
        await seen(pilot, "next level")
        wall = next(at for at, line in enumerate(rows(pilot)) if "next level" in line) + 1
        await until(pilot, lambda: "▄▄▄" in rows(pilot)[wall][140:168], "the level's walls")

    house.play(scene, (80, 24))


@pytest.mark.long
def test_a_damaged_journal_is_told_once(house: House) -> None:
    (house.workspace.folder / FILE).write_bytes(b"no database at all" * 100)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "was damaged")
        await pilot.press("space")
        await pilot.press("9")
        await seen(pilot, "export your progress")
        await pilot.press("escape")
        await seen(pilot, "Lesson 1, Colours")
        assert "was damaged" not in text(pilot)

    house.play(scene)


@pytest.mark.long
def test_a_journal_that_cannot_be_opened_leaves_the_robot_to_drive(house: House) -> None:
    (house.workspace.folder / FILE).mkdir()

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "Progress cannot be read.")
        await pilot.press("enter")
        await seen(pilot, "any key closes")
        assert FILE in text(pilot)
        await pilot.press("space")
        await pilot.press("down")
        await until(pilot, lambda: "> 2" in text(pilot), "the second line to be chosen")
        assert "a program drives" in rows(pilot)[0]
        await pilot.press("w")
        await seen(pilot, "you drive")

    house.play(scene)


@pytest.mark.parametrize("size", [(60, 18), (80, 24), (200, 50)], ids=lambda size: f"{size[0]}x{size[1]}")
def test_the_whole_menu_is_in_sight(house: House, size: tuple[int, int]) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "Lesson 1")
        assert all(item.title in text(pilot) for item in MENU[1:])
        assert "quit" in rows(pilot)[-1]

    house.play(scene, size)


@pytest.mark.long
def test_questions_are_chosen_by_the_titles_of_lessons(house: House) -> None:
    shown: set[str] = set()
    """Lines of the list."""

    async def scene(pilot: Pilot[None]) -> None:
        await pilot.press("7")
        await seen(pilot, "Enter confirm")
        for _ in range(len(kit_bank().lessons) + 3):  # three lines stand above the lessons
            shown.update(
                line.split("│")[1].strip(" >▁▂▃▄▅▆▇█") for line in rows(pilot) if line.count("│") == 2
            )
            await pilot.press("down")

    house.play(scene, size=(200, 50))
    wanted = {f"lesson {lesson.number}": lesson.title for lesson in map(kit_lesson, kit_bank().lessons)}
    found = [line.split(maxsplit=2) for line in shown if line.startswith("lesson ")]
    assert {f"{word} {number}": title for word, number, title in found} == wanted


def test_where_to_go_on_is_told_before_the_rest_is_read(
    house: House, monkeypatch: pytest.MonkeyPatch
) -> None:
    may_go_on = threading.Event()
    count_due = StudentStore._count_due

    def wait(store: StudentStore) -> int | None:
        assert may_go_on.wait(LIMIT_S)
        return count_due(store)

    monkeypatch.setattr(StudentStore, "_count_due", wait)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "Lesson 1, Colours")
        assert "today" not in text(pilot), "nothing is said of what is not known yet"
        may_go_on.set()
        await seen(pilot, "not driven yet")

    house.play(scene, (120, 40))


def test_a_maze_that_was_driven_is_told_at_once_on_coming_back(
    house: House, monkeypatch: pytest.MonkeyPatch
) -> None:
    may_go_on = threading.Event()
    count_due = StudentStore._count_due

    def wait(store: StudentStore) -> int | None:
        assert may_go_on.wait(LIMIT_S)
        return count_due(store)

    monkeypatch.setattr(StudentStore, "_count_due", wait)

    async def scene(pilot: Pilot[None]) -> None:
        may_go_on.set()
        await seen(pilot, "not driven yet")
        await pilot.press("enter")
        await seen(pilot, "waiting for your prediction")
        house.note((EventKind.START, daily_id(today())))
        may_go_on.clear()
        await pilot.press("escape")
        await seen(pilot, "driven today")
        may_go_on.set()

    house.play(scene, (120, 40))


def test_the_kit_may_be_left_while_the_rest_is_read(house: House, monkeypatch: pytest.MonkeyPatch) -> None:
    is_left = threading.Event()
    count_due = StudentStore._count_due

    def wait(store: StudentStore) -> int | None:
        is_left.wait(LIMIT_S)
        return count_due(store)

    monkeypatch.setattr(StudentStore, "_count_due", wait)

    async def scene(pilot: Pilot[None]) -> None:
        start = pilot.app.screen
        assert isinstance(start, StartScreen)
        await seen(pilot, "Lesson 1, Colours")
        await start.query(TextRows).remove()  # as where the app ends
        is_left.set()
        await until(pilot, lambda: start._overview is not None and start._overview.is_whole, "the rest")

    house.play(scene)


def test_what_is_new_goes_once_it_was_seen_and_never_comes_back(house: House) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "New: ")
        screen = pilot.app.screen
        assert isinstance(screen, StartScreen)
        screen._forget_news()  # as the clock does after a while
        await until(pilot, lambda: "New: " not in text(pilot), "it goes")
        await screen._refresh_overview()
        await pilot.pause()
        assert "New: " not in text(pilot)

    house.play(scene)


@pytest.mark.long
def test_what_is_new_is_gone_on_coming_back(house: House) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "New: ")
        await pilot.press("enter")
        await seen(pilot, "waiting for your prediction")
        await pilot.press("escape")
        await until(pilot, lambda: isinstance(pilot.app.screen, StartScreen), "the menu")
        await pilot.app.screen._refresh_overview()  # type: ignore[attr-defined]
        await pilot.pause()
        assert "New: " not in text(pilot)

    house.play(scene, (120, 40))
