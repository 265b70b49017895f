"""The quiz on a full screen: an answer, how sure, what is said to it; nothing kept before, all kept after."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from textual.pilot import Pilot

from kit.dialogue.effects import Leave
from kit.document.rows import MARGIN, row_text, row_width
from kit.school.progress import EventKind, ProgressEvent, ProgressJournal
from kit.school.quiz.quiz_dialogue import QuizDialogue, QuizStage
from kit.school.quiz.quiz_session import QuizSession, lesson_plan, quiz_plan
from kit.tui.rows.panel_rows import panel_rows
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.dialogue import DialogueScreen
from kit.tui.widgets.world_view import WorldView
from tests.kit_content import kit_bank, kit_lesson
from tests.tui.lesson_stage import ROBOT, rows, seen, stage, text, until

BANK = kit_bank()
ROWS_OF_AN_EXPLANATION = 14
"""More than what is said to any answer takes on a large screen."""
Scene = Callable[[DialogueScreen, Pilot[None]], Awaitable[None]]


@pytest.fixture
def progress(tmp_path: Path) -> Iterator[ProgressJournal]:
    with ProgressJournal(tmp_path) as opened:
        yield opened


def play(
    scene: Scene, progress: ProgressJournal, *, lesson: str = "", size: tuple[int, int] = (80, 24)
) -> None:
    plan = lesson_plan(BANK, lesson) if lesson else quiz_plan(BANK)

    screen = DialogueScreen(QuizDialogue(QuizSession(progress, BANK, plan, seed=1)))
    stage(lambda theme: screen, lambda pilot: scene(screen, pilot), size=size)


def quiz(screen: DialogueScreen) -> QuizDialogue:
    assert isinstance(screen.dialogue, QuizDialogue)
    return screen.dialogue


def flat(screen: DialogueScreen) -> str:
    return " ".join(" ".join(rows(screen)).split())


def kept(progress: ProgressJournal) -> list[ProgressEvent]:
    return progress.events(EventKind.ANSWER)


def test_choose_say_how_sure_be_told_go_on(progress: ProgressJournal) -> None:
    async def scene(screen: DialogueScreen, pilot: Pilot[None]) -> None:
        item = quiz(screen).item
        assert item is not None
        assert "question 1 of 12" in rows(screen)[0]
        assert all(option.text in flat(screen) for option in item.options)
        wrong = (item.right_option + 1) % 3
        await pilot.press(str(wrong + 1))
        assert quiz(screen).stage is QuizStage.CHOSEN
        assert any(row.startswith(f"> {wrong + 1}") for row in rows(screen))
        assert "How sure are you?" in flat(screen)
        assert kept(progress) == []
        await pilot.press("4")
        (event,) = kept(progress)
        assert (event.content["chosen"], event.content["confidence"]) == (wrong, 4)
        assert " ".join(item.options[wrong].feedback.split()) in flat(screen)
        assert any(row.startswith(f"x {wrong + 1}") for row in rows(screen))
        assert any(row.startswith(f"+ {item.right_option + 1}") for row in rows(screen))
        await pilot.press("n")
        assert "question 2 of 12" in rows(screen)[0]
        assert quiz(screen).stage is QuizStage.ASKED

    play(scene, progress)


@pytest.mark.long
def test_another_answer_before_one_says_how_sure(progress: ProgressJournal) -> None:
    async def scene(screen: DialogueScreen, pilot: Pilot[None]) -> None:
        await pilot.press("1", "b", "3", "2")
        (event,) = kept(progress)
        assert (event.content["chosen"], event.content["confidence"]) == (2, 2)

    play(scene, progress)


@pytest.mark.long
def test_not_sure_and_blank_are_told_too(progress: ProgressJournal) -> None:
    async def scene(screen: DialogueScreen, pilot: Pilot[None]) -> None:
        await pilot.press("0")
        assert "not counted as wrong" in flat(screen)
        await pilot.press("enter", "x")
        assert "once more" in rows(screen)[-3]
        assert len(kept(progress)) == 1
        await pilot.press("x")
        assert "Left blank" in flat(screen)
        assert [event.content["not_sure"] for event in kept(progress)] == [True, False]

    play(scene, progress)


@pytest.mark.long
def test_a_key_too_many_changes_nothing(progress: ProgressJournal) -> None:
    async def scene(screen: DialogueScreen, pilot: Pilot[None]) -> None:
        await pilot.press("n", "4", "b")
        assert quiz(screen).stage is QuizStage.ASKED
        await pilot.press("1", "0", "x", "n")
        assert quiz(screen).stage is QuizStage.CHOSEN
        await pilot.press("1", "2", "3", "0", "x", "x")
        assert quiz(screen).stage is QuizStage.TOLD
        assert len(kept(progress)) == 1

    play(scene, progress)


@pytest.mark.long
def test_to_the_end_and_what_came_of_it(progress: ProgressJournal) -> None:
    count = len(BANK.lesson_items("08-fewest-layers"))

    async def scene(screen: DialogueScreen, pilot: Pilot[None]) -> None:
        for _ in range(count):
            item = quiz(screen).item
            assert item is not None
            await pilot.press(str(item.right_option + 1), "4", "n")
        assert quiz(screen).stage is QuizStage.OVER
        assert f"{count} of {count} right" in flat(screen)
        assert f"certain {count} of {count}" in flat(screen)
        assert "Next: tomorrow" in flat(screen)
        assert rows(screen)[-1].startswith("n close ? help Esc back")
        assert quiz(screen).go_on() == Leave()

    play(scene, progress, lesson="08-fewest-layers")


@pytest.mark.long
def test_the_keys_that_work_are_in_sight_all_the_time(progress: ProgressJournal) -> None:
    async def scene(screen: DialogueScreen, pilot: Pilot[None]) -> None:
        seen = []
        for key in ("1", "3", "n"):
            seen.append(rows(screen)[-1])
            await pilot.press(key)
        assert "0 not sure" in seen[0]
        assert "how sure" in seen[1]
        assert "n next" in seen[2]
        assert all(len(line) <= 80 for line in seen)

    play(scene, progress)


def test_an_answer_that_cannot_be_kept_is_said(progress: ProgressJournal) -> None:
    async def scene(screen: DialogueScreen, pilot: Pilot[None]) -> None:
        progress.close()
        await pilot.press("1", "1")
        assert "Not saved" in rows(screen)[-3]
        assert quiz(screen).stage is QuizStage.CHOSEN

    play(scene, progress)


def test_a_small_window_scrolls(progress: ProgressJournal) -> None:
    async def scene(screen: DialogueScreen, pilot: Pilot[None]) -> None:
        assert "more lines below" in flat(screen)
        before = rows(screen)
        await pilot.press("down")
        assert rows(screen)[1] == before[2]
        await pilot.press("up", "0")
        assert "See lesson" in flat(screen)  # what is said stands at the end

    play(scene, progress, size=(40, 12))


@pytest.mark.long
def test_help(progress: ProgressJournal) -> None:
    async def scene(screen: DialogueScreen, pilot: Pilot[None]) -> None:
        await pilot.press("question_mark")
        assert isinstance(screen.app.screen, MessageDialog)
        await pilot.press("x")
        assert screen.app.screen is screen

    play(scene, progress)


@pytest.mark.parametrize("size", [(80, 24), (200, 50)], ids=str)
def test_question_and_options_stay_where_they_are(size: tuple[int, int], progress: ProgressJournal) -> None:
    async def scene(screen: DialogueScreen, pilot: Pilot[None]) -> None:
        item = quiz(screen).item
        assert item is not None

        def places() -> list[tuple[int, int]]:
            words = [item.question[:20], *(option.text[:20] for option in item.options)]
            found = [(number, line.find(each)) for each in words for number, line in enumerate(rows(screen))]
            return [place for place in found if place[1] >= 0]

        asked = places()
        assert len(asked) == 1 + len(item.options)
        await pilot.press("1")
        assert places() == asked
        await pilot.press("2")
        assert places() == asked
        options = [number for number, _ in asked[1:]]
        assert all(later - one > 1 for one, later in pairwise(options)) is (size[1] == 50), (
            "a high screen has room between options"
        )

    play(scene, progress, size=size)


@pytest.mark.parametrize(
    ("size", "place"),
    [((80, 14), None), ((80, 24), "below"), ((120, 35), "beside"), ((200, 35), "beside")],
    ids=str,
)
def test_the_map_of_topics_stands_beside_a_question_or_below_it_where_there_is_room(
    progress: ProgressJournal, size: tuple[int, int], place: str | None
) -> None:
    async def scene(screen: DialogueScreen, pilot: Pilot[None]) -> None:
        item = quiz(screen).item
        assert item is not None
        count = sum(each.topic is item.topic for each in BANK.items)

        def topic_row() -> int | None:
            return next(
                (number for number, line in enumerate(rows(screen)) if "what you know, by" in line), None
            )

        at, option = (
            topic_row(),
            next(n for n, line in enumerate(rows(screen)) if item.options[0].text[:20] in line),
        )
        assert (at is not None) is (place is not None)
        if at is not None:
            assert (at < option) is (place == "beside")
        assert (f"0 of {count}" in flat(screen)) is (place is not None)
        assert item.question.split()[0] in flat(screen)
        await pilot.press(str(item.right_option + 1))
        await pilot.pause()
        assert topic_row() == at, "it stays where it is"
        await pilot.press("4")
        await pilot.pause()
        if place == "beside":
            assert f"1 of {count}" in flat(screen)

    play(scene, progress, size=size)


@pytest.mark.parametrize("size", [(120, 35), (200, 50)], ids=str)
def test_a_large_screen_shows_the_lessons_scene_and_then_the_step_that_teaches_the_answer(
    progress: ProgressJournal, size: tuple[int, int]
) -> None:
    async def scene(screen: DialogueScreen, pilot: Pilot[None]) -> None:
        item = quiz(screen).item
        assert item is not None
        await seen(pilot, "Nothing is learned yet.")  # below the floors of the lesson's learners
        folder, _, number = item.lesson_to_repeat.partition("/")
        step = kit_lesson(folder).steps[int(number) - 1]
        assert step.title not in flat(screen)
        await pilot.press("1", "4")
        await seen(pilot, step.title)
        told = [row_text(each) for each in panel_rows(quiz(screen).panels(), 100, 1000)]
        listed = "\n".join(told)
        assert all(each.title in listed for each in kit_lesson(folder).steps), "all, where there is room"

    play(scene, progress, lesson="20-q-learning", size=size)


@pytest.mark.parametrize("size", [(120, 35), (200, 50)], ids=str)
def test_what_was_answered_before_stands_below_the_next_question_with_the_reason(
    progress: ProgressJournal, size: tuple[int, int]
) -> None:
    async def scene(screen: DialogueScreen, pilot: Pilot[None]) -> None:
        item = quiz(screen).item
        assert item is not None
        right = item.options[item.right_option]
        reason = " ".join(right.feedback.split()[:4])
        assert f"lesson {kit_lesson(item.lesson).number}, " in flat(screen)
        assert reason not in flat(screen)
        await pilot.press("0", "n")
        assert reason in flat(screen)
        options = quiz(screen).item
        assert options is not None
        at = {
            name: next(number for number, line in enumerate(rows(screen)) if words[:20] in line)
            for name, words in (("option", options.options[0].text), ("earlier", right.text))
        }
        assert at["option"] < at["earlier"]

    play(scene, progress, lesson="25-generalisation", size=size)


@pytest.mark.parametrize("lesson", ["01-drive", "02-nodes-and-topics", "25-generalisation"])
def test_what_stands_below_the_answers_begins_where_the_longest_explanation_ends_and_stays_there(
    progress: ProgressJournal, lesson: str
) -> None:
    async def scene(screen: DialogueScreen, pilot: Pilot[None]) -> None:
        item = quiz(screen).item
        assert item is not None
        title = f"── lesson {kit_lesson(item.lesson).number}, "

        def below() -> int:
            """The row of what is told of the lesson: of the lesson itself, or the step of it that teaches the answer."""
            return next((number for number, line in enumerate(rows(screen)) if title in line), 0)

        await until(pilot, below, "the lesson")
        answers = [
            next(number for number, line in enumerate(rows(screen)) if each.text[:20] in line)
            for each in item.options
        ]
        at, view = below(), screen.query_one(WorldView)
        picture = view.region
        empty = [not line[:90].strip() for line in rows(screen)[answers[-1] : at]]
        assert not picture.height or picture.y > answers[-1]
        assert sum(empty) - picture.height < ROWS_OF_AN_EXPLANATION
        await pilot.press("1")
        assert below() == at
        await pilot.press("2")
        await until(pilot, lambda: "See lesson" in text(pilot), "the explanation")
        assert (below(), view.region) == (at, picture)
        assert [
            next(number for number, line in enumerate(rows(screen)) if each.text[:20] in line)
            for each in item.options
        ] == answers

    play(scene, progress, lesson=lesson, size=(200, 50))


def test_no_panel_is_wider_than_its_column(progress: ProgressJournal) -> None:
    async def scene(screen: DialogueScreen, pilot: Pilot[None]) -> None:
        for _ in range(3):
            for columns, is_below in ((screen._beside - MARGIN, False), (screen._widest - MARGIN, True)):
                panels = [each for each in quiz(screen).panels() if each.is_below is is_below]
                shown = panel_rows(panels, columns, 1000)
                assert [row_text(each) for each in shown if row_width(each) > columns] == []
            await pilot.press("1", "2", "n")

    play(scene, progress, lesson="20-q-learning", size=(120, 35))


@pytest.mark.parametrize(("lesson", "has_world"), [("01-drive", True), ("02-nodes-and-topics", False)])
def test_a_world_is_shown_only_beside_questions_about_worlds(
    progress: ProgressJournal, lesson: str, has_world: bool
) -> None:
    async def scene(screen: DialogueScreen, pilot: Pilot[None]) -> None:
        item = quiz(screen).item
        assert item is not None
        assert item.topic.has_worlds is has_world
        world = screen.query_one(WorldView)
        await until(pilot, lambda: world.display is has_world, "the world, or none")
        if has_world:
            await until(pilot, lambda: set(ROBOT) & set(text(pilot)), "the robot")

    play(scene, progress, lesson=lesson, size=(200, 50))


def test_the_end_lists_what_was_answered_with_the_right_answers(progress: ProgressJournal) -> None:
    async def scene(screen: DialogueScreen, pilot: Pilot[None]) -> None:
        asked = []
        while (item := quiz(screen).item) is not None and not quiz(screen).is_over:
            asked.append(item)
            await pilot.press("0", "n")
        assert all(each.options[each.right_option].text[:20] in flat(screen) for each in asked)

    play(scene, progress, lesson="20-q-learning", size=(200, 50))
