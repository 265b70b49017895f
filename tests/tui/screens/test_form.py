"""The evaluation form on a full screen: an answer chosen or typed, kept on going on, back and leaving."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest
from textual.pilot import Pilot

from kit.school.form_answers import FormAnswers
from kit.school.form_dialogue import FormDialogue
from kit.school.form_reading import read_form
from kit.school.form_session import PHASE_LABELS, FormSession
from kit.school.progress import EventKind, ProgressJournal
from kit.school.survey import AnswerShape, AnswerValue, SurveyPhase
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.dialogue import DialogueScreen
from kit.tui.screens.glossary import GlossaryScreen
from kit.tui.widgets.text_field import AnswerField
from tests.cases import every_case
from tests.tui.lesson_stage import rows, stage, text, until

FORM = read_form()
Act = Callable[[Pilot[None], FormSession], Awaitable[None]]


def play(
    tmp_path: Path,
    act: Act,
    *,
    phase: SurveyPhase = SurveyPhase.BEFORE,
    start: str = "",
    size: tuple[int, int] = (80, 24),
    ascii_only: bool = False,
) -> FormAnswers:
    """Plays with the form from the question ``start`` on, those before it left blank; returns what is kept. With a name
    that no question has, all are answered."""
    tmp_path.mkdir(exist_ok=True)
    with ProgressJournal(tmp_path) as journal:
        session = FormSession(FORM, phase, journal)
        while start and session.question is not None and session.question.id != start:
            session.answer(None)

        async def scene(pilot: Pilot[None]) -> None:
            await act(pilot, session)

        stage(lambda theme: DialogueScreen(FormDialogue(session)), scene, size=size, ascii_only=ascii_only)
        return FormAnswers.from_events(FORM, journal.events(EventKind.FORM))


def value(answers: FormAnswers, question: str, phase: SurveyPhase = SurveyPhase.BEFORE) -> AnswerValue:
    return answers.value(question, phase)


def _field(screen: DialogueScreen) -> AnswerField:
    return screen.query_one(AnswerField)


def test_a_number_chooses_and_enter_keeps_it_and_goes_on(tmp_path: Path) -> None:
    async def act(pilot: Pilot[None], session: FormSession) -> None:
        assert f"question 1 of {session.count}" in rows(pilot)[0]
        assert "leave blank" in rows(pilot)[-1]
        await pilot.press("3")
        assert sum(row.startswith("> 3") for row in rows(pilot)) == 1
        assert session.value is None
        await pilot.press("9", "6")  # there are five
        assert sum(row.startswith("> 3") for row in rows(pilot)) == 1
        await pilot.press("enter")
        assert f"question 2 of {session.count}" in rows(pilot)[0]
        await pilot.press("7", "enter", "enter")
        assert f"question 4 of {session.count}" in rows(pilot)[0]

    kept = play(tmp_path, act)
    assert value(kept, "education") == FORM.questions[0].options[2]
    assert value(kept, "experience.robotics") == 7
    assert kept.is_answered("experience.ros1", SurveyPhase.BEFORE)
    assert value(kept, "experience.ros1") is None
    assert not kept.is_answered("experience.ros2", SurveyPhase.BEFORE)


def test_arrows_choose_and_stop_at_the_ends(tmp_path: Path) -> None:
    async def act(pilot: Pilot[None], session: FormSession) -> None:
        await pilot.press("right")
        assert "[1]" in text(pilot)
        await pilot.press("left", "down", "right", "up")
        assert "[2]" in text(pilot)
        await pilot.press("end", "right")
        assert "[7]" in text(pilot)
        await pilot.press("x")
        assert "[" not in "".join(rows(pilot)[1:-2])
        await pilot.press("left")
        assert "[7]" in text(pilot)

    play(tmp_path, act, start="experience.robotics")


def test_yes_is_1_and_no_is_2(tmp_path: Path) -> None:
    async def act(pilot: Pilot[None], session: FormSession) -> None:
        await pilot.press("1", "enter")
        assert session.question is not None
        assert session.question.id == "setup.install"
        await pilot.press("b")
        assert any(row.startswith("> 1  yes") for row in rows(pilot))
        await pilot.press("2", "enter")
        assert "that is all" in text(pilot)

    assert value(play(tmp_path, act, start="installed"), "installed") is False


@every_case("key", ["b", "escape", "q", "ctrl+c"])
def test_what_is_chosen_is_kept_on_going_back_and_leaving(key: str, tmp_path: Path) -> None:
    async def act(pilot: Pilot[None], session: FormSession) -> None:
        await pilot.press("4", key)
        await pilot.pause()

    kept = play(tmp_path / key, act, start="experience.ros1")
    assert value(kept, "experience.ros1") == 4


def test_leaving_a_question_that_was_only_looked_at_leaves_it_open(tmp_path: Path) -> None:
    async def act(pilot: Pilot[None], session: FormSession) -> None:
        await pilot.press("b", "enter", "escape")

    kept = play(tmp_path, act, start="experience.ros1")
    assert not kept.is_answered("experience.ros1", SurveyPhase.BEFORE)


def test_an_answer_can_be_made_blank(tmp_path: Path) -> None:
    async def act(pilot: Pilot[None], session: FormSession) -> None:
        await pilot.press("4", "enter", "b")
        assert "x clear" in rows(pilot)[-1]
        await pilot.press("x", "enter")

    kept = play(tmp_path, act, start="experience.ros1")
    assert kept.is_answered("experience.ros1", SurveyPhase.BEFORE)
    assert value(kept, "experience.ros1") is None


def test_words_are_typed_and_letters_are_keys_only_outside_the_field(tmp_path: Path) -> None:
    async def act(pilot: Pilot[None], session: FormSession) -> None:
        number = session.number
        assert "stop typing" in rows(pilot)[-1]
        await pilot.press(*"bnqx", "space", "1", "question_mark")
        assert "│ bnqx 1?" in text(pilot)
        await pilot.press("escape")
        assert "e type" in rows(pilot)[-1]
        await pilot.press("e", *"!", "escape", "b")
        assert session.number == number - 1
        await pilot.press("enter")
        assert "│ bnqx 1?!" in text(pilot)
        assert "e type" in rows(pilot)[-1], "what was typed is not typed over"
        await pilot.press("enter")
        assert session.number == number + 1

    kept = play(tmp_path, act, phase=SurveyPhase.AFTER, start="driving_words")
    assert value(kept, "driving_words", SurveyPhase.AFTER) == "bnqx 1?!"


def test_an_answer_that_is_too_long_is_said_and_not_lost(tmp_path: Path) -> None:
    async def act(pilot: Pilot[None], session: FormSession) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, DialogueScreen)
        _field(screen).load_text("word " * 1000)
        await pilot.press("enter")
        assert "Not saved" in rows(pilot)[-3]
        await pilot.press("escape", "escape")
        assert pilot.app.screen is screen
        assert "Not saved" in rows(pilot)[-3]

    kept = play(tmp_path, act, phase=SurveyPhase.AFTER, start="driving_words")
    assert not kept.is_answered("driving_words", SurveyPhase.AFTER)


def test_an_answer_that_cannot_be_kept_is_said(tmp_path: Path) -> None:
    async def act(pilot: Pilot[None], session: FormSession) -> None:
        session._journal.close()
        await pilot.press("3", "enter")
        assert "Not saved" in rows(pilot)[-3]
        assert "question 1 of" in rows(pilot)[0]
        assert any(row.startswith("> 3") for row in rows(pilot))

    with pytest.raises(Exception, match="closed"):
        play(tmp_path, act)


def test_the_end_says_so_and_goes_back_to_the_answers(tmp_path: Path) -> None:
    async def act(pilot: Pilot[None], session: FormSession) -> None:
        assert "is answered" in text(pilot)
        assert rows(pilot)[-1].startswith("b change answers")
        await pilot.press("1", "enter", "x", "e")
        assert "is answered" in text(pilot)
        await pilot.press("b")
        assert f"question {session.count} of {session.count}" in rows(pilot)[0]
        await pilot.press("1", "enter")
        assert "setup.install" in {question.id for question in session.questions}

    play(tmp_path, act, start="nothing is called so")


def test_help(tmp_path: Path) -> None:
    async def act(pilot: Pilot[None], session: FormSession) -> None:
        await pilot.press("question_mark")
        assert isinstance(pilot.app.screen, MessageDialog)
        assert "your teacher" in text(pilot)
        await pilot.press("x")
        assert isinstance(pilot.app.screen, DialogueScreen)

    play(tmp_path, act)


@pytest.mark.nightly
@every_case("size", [(80, 24), (200, 50), (60, 18)])
def test_every_question_fits_and_nothing_jumps_when_an_answer_is_chosen(
    size: tuple[int, int], tmp_path: Path
) -> None:
    async def act(pilot: Pilot[None], session: FormSession) -> None:
        while (question := session.question) is not None:
            if question.shape is AnswerShape.TEXT:
                await pilot.press("escape")
            before = rows(pilot)
            assert all(len(row) <= size[0] for row in before)
            assert "Enter" in before[-1], question.id
            if question.values:
                await pilot.press("1")
                after = rows(pilot)
                flat = [row.replace("[1]", " 1 ").replace("> 1  ", "  1  ") for row in after[:-1]]
                assert [row.rstrip() for row in flat] == before[:-1]
                assert "1" in "".join(before[1:-2]), "the answers are in sight"
                assert after != before
            await pilot.press("enter")

    play(tmp_path / str(size[0]), act, phase=SurveyPhase.AFTER, size=size)


@pytest.mark.parametrize("size", [(120, 35), (200, 50)], ids=str)
def test_a_large_screen_says_what_each_later_part_asks(size: tuple[int, int], tmp_path: Path) -> None:
    async def act(pilot: Pilot[None], session: FormSession) -> None:
        later = (SurveyPhase.AFTER, SurveyPhase.QUIZZED)
        assert all(f"── asked {PHASE_LABELS[each]} ─" in text(pilot) for each in later)

    play(tmp_path, act, size=size)


def test_ascii_alone(tmp_path: Path) -> None:
    async def act(pilot: Pilot[None], session: FormSession) -> None:
        await pilot.press(*"abc")
        assert text(pilot).isascii()

    play(tmp_path, act, phase=SurveyPhase.AFTER, start="driving_words", ascii_only=True)


@pytest.mark.long
def test_a_text_is_kept_while_the_terminal_changes_its_size(tmp_path: Path) -> None:
    async def act(pilot: Pilot[None], session: FormSession) -> None:
        await pilot.press(*"walls")
        for size in ((10, 3), (30, 6), (200, 50), (1, 1), (80, 24)):
            await pilot.resize_terminal(*size)
            await pilot.pause()
        await until(pilot, lambda: "│ walls" in text(pilot), "what was typed")

    kept = play(tmp_path, act, phase=SurveyPhase.AFTER, start="driving_words")
    assert value(kept, "driving_words", SurveyPhase.AFTER) == "walls"


def test_pasted_lines_become_one_and_nothing_else_of_a_text_changes(tmp_path: Path) -> None:
    async def act(pilot: Pilot[None], session: FormSession) -> None:
        screen = pilot.app.screen
        assert isinstance(screen, DialogueScreen)
        _field(screen).load_text("two\n  lines,  so\n")
        await pilot.press("enter", "b", "escape")

    kept = play(tmp_path, act, phase=SurveyPhase.AFTER, start="driving_words")
    assert value(kept, "driving_words", SurveyPhase.AFTER) == "two lines,  so"


def test_the_glossary_is_the_screen_that_it_is_everywhere(tmp_path: Path) -> None:
    async def act(pilot: Pilot[None], session: FormSession) -> None:
        await pilot.press("comma")
        await until(pilot, lambda: isinstance(pilot.app.screen, GlossaryScreen), "the glossary")
        await pilot.press("escape")
        await until(pilot, lambda: isinstance(pilot.app.screen, DialogueScreen), "the form again")

    play(tmp_path, act)
