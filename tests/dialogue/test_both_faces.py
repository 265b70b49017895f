"""Each dialogue through both of its faces: the same actions are offered, allowed, refused with the same sentence, and have the
same effect."""

from __future__ import annotations

import io
import random
import re
import sys
from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Final

import numpy as np
import pytest
from textual.pilot import Pilot

from kit.cli.dialogue import run_dialogue
from kit.cli.lesson import LineStage
from kit.dialogue.dialogue import SIGNS, Dialogue, DialogueAction, Turn
from kit.dialogue.effects import Effect, Leave, Tell
from kit.document.layout import lines_of
from kit.mapmaking.doubts import Doubt, JudgedStrokes
from kit.mapmaking.doubts_dialogue import DoubtsDialogue
from kit.render.encode import AsciiEncoder
from kit.school.form_dialogue import FormDialogue
from kit.school.form_reading import read_form
from kit.school.form_session import FormSession
from kit.school.lessons.defence import Defence, DefenceQuestion
from kit.school.lessons.defence_dialogue import DefenceDialogue
from kit.school.lessons.lesson_dialogue import LessonDialogue
from kit.school.lessons.lesson_session import LessonSession
from kit.school.lessons.reading import read_lesson
from kit.school.progress import ProgressJournal
from kit.school.quiz.quiz_dialogue import QuizDialogue
from kit.school.quiz.quiz_session import QuizSession, quiz_plan
from kit.school.survey import SurveyPhase
from kit.tui.screens.dialogue import DialogueScreen
from kit.tui.screens.lesson import LessonScreen
from kit.tui.theme import Theme
from kit.workspace import open_workspace
from tests.kit_content import kit_bank
from tests.tui.lesson_folder import write_lessons
from tests.tui.lesson_stage import rows, stage, until

KEYS_OF_SIGNS: Final = {sign: key for key, sign in SIGNS.items()}


class QuizCase:
    """The quiz of twelve."""

    unused: Collection[str] = ()
    """Keys that lead to an editor, a program or another dialogue."""

    def dialogue(self, journal: ProgressJournal, folder: Path) -> Dialogue:
        """For the lines."""
        return QuizDialogue(QuizSession(journal, kit_bank(), quiz_plan(kit_bank()), seed=1))

    def screen(self, theme: Theme, journal: ProgressJournal, folder: Path) -> DialogueScreen:
        return DialogueScreen(self.dialogue(journal, folder))

    def shown(self, dialogue: Dialogue) -> list[str]:
        """What is the same in both faces."""
        return lines_of(dialogue.blocks())

    def is_settled(self, dialogue: Dialogue) -> bool:
        """Whether nothing goes on."""
        return True


class FormCase(QuizCase):
    def dialogue(self, journal: ProgressJournal, folder: Path) -> Dialogue:
        return FormDialogue(FormSession(read_form(), SurveyPhase.BEFORE, journal))


class LessonCase(QuizCase):
    """A lesson with a prediction, commands, a text, and two exercises."""

    unused = ("e", "o", "w", "k")

    def session(self, journal: ProgressJournal, folder: Path) -> LessonSession:
        lesson = read_lesson(write_lessons(folder / "lessons") / "01-colours")
        return LessonSession(lesson, journal, open_workspace(folder / "home"))

    def dialogue(self, journal: ProgressJournal, folder: Path) -> Dialogue:
        dialogue = LessonDialogue(self.session(journal, folder))
        dialogue.begin(LineStage())
        return dialogue

    def screen(self, theme: Theme, journal: ProgressJournal, folder: Path) -> DialogueScreen:
        return LessonScreen(theme, self.session(journal, folder), open_workspace(folder / "home"))

    def shown(self, dialogue: Dialogue) -> list[str]:
        assert isinstance(dialogue, LessonDialogue)
        return [dialogue.position, *lines_of(dialogue.prediction_blocks())]

    def is_settled(self, dialogue: Dialogue) -> bool:
        assert isinstance(dialogue, LessonDialogue)
        return not dialogue.busy and (dialogue.is_answer_shown or dialogue.is_waiting)


class DefenceCase(LessonCase):
    """Three questions about a program, without the picture of its run."""

    unused = ()

    def dialogue(self, journal: ProgressJournal, folder: Path) -> Dialogue:
        session = self.session(journal, folder)
        run = SimpleNamespace(track=lambda robot: [(1.0, 2.0, 0.5)])
        questions = tuple(
            DefenceQuestion(f"What about {number}?", ("this", "that", "neither")[: 2 + number % 2], 1)
            for number in range(3)
        )
        defence = Defence(run, SimpleNamespace(robot="robot"), questions)  # type: ignore[arg-type]  # stand-ins
        return DefenceDialogue(session, session.lesson.exercises[-1], defence)

    def screen(self, theme: Theme, journal: ProgressJournal, folder: Path) -> DialogueScreen:
        return DialogueScreen(self.dialogue(journal, folder))

    def shown(self, dialogue: Dialogue) -> list[str]:
        return lines_of(dialogue.blocks())

    def is_settled(self, dialogue: Dialogue) -> bool:
        return True


class DoubtsCase(QuizCase):
    """Three kinds of strokes that may be no walls."""

    def dialogue(self, journal: ProgressJournal, folder: Path) -> Dialogue:
        walls = np.zeros((60, 80), dtype=np.bool_)
        walls[[5, 54], 5:75] = walls[5:55, [5, 74]] = True
        doubts = []
        for number, kind in enumerate(("pale", "small", "thin")):
            strokes = np.zeros_like(walls)
            strokes[20 + 5 * number, 20:40] = True
            doubts.append(Doubt(kind, strokes))
        return DoubtsDialogue(JudgedStrokes(walls, tuple(doubts)), AsciiEncoder())


CASES: Final = {
    "quiz": QuizCase(),
    "form": FormCase(),
    "lesson": LessonCase(),
    "defence": DefenceCase(),
    "doubts": DoubtsCase(),
}


def walk(case: QuizCase, dialogue: type[Dialogue], seed: int, count: int = 25) -> list[str]:
    """Lines at random: keys of the dialogue, some of them twice, and some that mean nothing; in the end it is left."""
    chance = random.Random(seed)
    actions = [each for each in dialogue.actions if each.is_for_lines]
    names = {key for each in actions for key in each.keys.key_names} - {
        "escape",
        "q",
        "backspace",
        *case.unused,
    }
    keys = sorted(KEYS_OF_SIGNS.get(key, key) for key in names)
    usual = [key for key in keys if key.isdecimal() or key == "n"] * 3
    drawn: list[str] = []
    while len(drawn) < count:
        drawn += [chance.choice([*keys, *usual])] * chance.choice([1, 1, 2])
    return [*drawn, "q"]


@dataclass(frozen=True)
class Step:
    """What a turn did, in whatever face."""

    action: str
    args: tuple[object, ...]
    effect: str
    said: str
    """The sentence."""
    possible: list[str]
    """The words of what is possible then."""
    shown: list[str]


@pytest.fixture
def log(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> list[Step]:
    """What every turn does."""
    steps: list[Step] = []
    do, case = Turn.do, CASES[request.getfixturevalue("name")]

    def logged(turn: Turn, action_id: str, *args: object, pressed: str = "") -> Effect:
        effect = do(turn, action_id, *args, pressed=pressed)
        said = "" if turn.remark is None else re.sub(r"[\d.:-]+", "#", turn.remark.text)
        words = [word(each, turn.dialogue) for each in turn.possible() if each.is_for_lines]
        steps.append(Step(action_id, args, type(effect).__name__, said, words, case.shown(turn.dialogue)))
        return effect

    monkeypatch.setattr(Turn, "do", logged)
    return steps


def word(action: DialogueAction[Any], dialogue: Dialogue) -> str:
    return action.word(dialogue) if action.word else action.keys.label


def by_line(case: QuizCase, lines: list[str], folder: Path, monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Returns what is in the journal then. A list of steps is left without a choice."""
    text = "".join(f"{line}\n\n" if line == "l" else f"{line}\n" for line in lines)
    monkeypatch.setattr(sys, "stdin", io.StringIO(text))
    with ProgressJournal(folder) as journal:
        run_dialogue(case.dialogue(journal, folder))
        return [(each.kind, each.subject, each.content) for each in journal.events()]


def on_screen(case: QuizCase, lines: list[str], folder: Path) -> list[Any]:
    """Presses the key of each line, and after it the one that the line's end is, as a person at the screen would."""

    def scene_of(journal: ProgressJournal) -> Callable[[Pilot[None]], Any]:
        async def scene(pilot: Pilot[None]) -> None:
            app = pilot.app
            screen = app.screen
            assert isinstance(screen, DialogueScreen)
            for line in lines:
                screen.set_focus(None)
                key = SIGNS.get(line, line)
                found = screen.turn.find(key)
                await pilot.press(key)
                await pilot.pause()
                if app.screen is not screen and screen.is_attached:
                    await pilot.press("escape")
                    await pilot.pause()
                if not screen.is_attached or screen not in app.screen_stack:
                    return
                await until(pilot, lambda: case.is_settled(screen.dialogue), "what goes on")
                await pilot.pause()
                assert_shown(screen)
                if found is not None and screen.turn.allowed_then(found[0]):
                    (name, *_), *_ = screen.dialogue.action(found[0].then).keys.bindings
                    await pilot.press(name.split(",")[-1])
                    await pilot.pause()
                if screen.dialogue.is_over:  # there a line's end is the end
                    return

        return scene

    with ProgressJournal(folder) as journal:
        stage(lambda theme: case.screen(theme, journal, folder), scene_of(journal), size=(200, 50))
        return [(each.kind, each.subject, each.content) for each in journal.events()]


def assert_shown(screen: DialogueScreen) -> None:
    """What was said stands on the screen, and its last row names what is possible."""
    *above, keys = rows(screen)
    if screen.turn.remark is not None:
        assert any(screen.turn.remark.text in each for each in above), (screen.turn.remark, *above)
    for each in screen.turn.possible():
        if each.is_listed:
            assert word(each, screen.dialogue) in keys


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize(
    "name", [*(each for each in CASES if each != "lesson"), pytest.param("lesson", marks=pytest.mark.long)]
)
def test_both_faces_agree(
    name: str,
    seed: int,
    tmp_path: Path,
    log: list[Step],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    case = CASES[name]
    folders = [tmp_path / each for each in ("none", "lines", "screen")]
    for folder in folders:
        folder.mkdir()
    with ProgressJournal(folders[0]) as journal:
        lines = walk(case, type(case.dialogue(journal, folders[0])), seed)
    kept_by_line = by_line(case, lines, folders[1], monkeypatch)
    steps, log[:] = list(log), []
    printed = " ".join(capsys.readouterr().out.split())
    kept_on_screen = on_screen(case, lines, folders[2])
    assert log == steps
    assert _without_times(kept_on_screen) == _without_times(kept_by_line)
    assert steps, "the walk went nowhere"
    for step in steps:
        assert " ".join(step.said.split()) in re.sub(r"[\d.:-]+", "#", printed)


def _without_times(events: list[Any]) -> list[Any]:
    return [
        (kind, subject, {key: value for key, value in content.items() if key != "seconds"})
        for kind, subject, content in events
    ]


@pytest.mark.parametrize("name", CASES)
def test_at_most_one_action_of_a_key_is_possible(name: str, tmp_path: Path) -> None:
    case = CASES[name]
    with ProgressJournal(tmp_path) as journal:
        dialogue = case.dialogue(journal, tmp_path)
        turn = Turn(dialogue)
        for line in walk(case, type(dialogue), 3, count=120)[:-1]:
            possible = [key for each in turn.possible() for key in each.keys.key_names]
            assert len(possible) == len(set(possible))
            effect, then = turn.enter(line)
            if isinstance(effect, Leave):
                assert dialogue.is_over
                break
            if isinstance(effect, Tell):
                assert effect.blocks
            if dialogue.busy:
                dialogue.stop()
            if then:
                turn.do(then)
        dialogue.close()


@pytest.mark.parametrize("name", CASES)
def test_a_key_that_does_nothing_is_named_as_it_was_pressed(name: str, tmp_path: Path) -> None:
    case = CASES[name]
    with ProgressJournal(tmp_path) as journal:
        dialogue = case.dialogue(journal, tmp_path)
        turn = Turn(dialogue)
        idle = [
            key
            for key in turn._keys()
            if len(key) == 1 and (found := turn.find(key)) is not None and turn.allowed(found[0]) is False
        ]
        for key in idle:
            turn.press(key)
            assert turn.remark is not None
            assert turn.remark.text.startswith(f"{key} does nothing here")
        dialogue.close()
