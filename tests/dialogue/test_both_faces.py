"""Each dialogue through both of its faces: the same actions are offered, allowed, refused with the same sentence, and have the
same effect."""

from __future__ import annotations

import asyncio
import io
import random
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import pytest
from textual.app import App

from kit.cli.dialogue import run_dialogue
from kit.dialogue.dialogue import SIGNS, Dialogue, Turn
from kit.dialogue.effects import Effect, Leave, Tell
from kit.document.layout import lines_of
from kit.school.form_dialogue import FormDialogue
from kit.school.form_session import FormSession
from kit.school.progress import ProgressJournal
from kit.school.quiz.quiz_dialogue import QuizDialogue
from kit.school.quiz.quiz_session import QuizSession, quiz_plan
from kit.school.survey import SurveyPhase, read_form
from kit.tui.screens.dialogue import DialogueScreen
from tests.kit_content import kit_bank
from tests.tui.lesson_stage import rows

KEYS_OF_SIGNS: Final = {sign: key for key, sign in SIGNS.items()}


@dataclass
class Seen:
    """What happened in one face."""

    steps: list[tuple[object, ...]] = field(default_factory=list)
    """Of each key: the action, what came of it, the sentence that was said, what is possible then, and what is shown."""
    events: list[tuple[object, ...]] = field(default_factory=list)
    """What is in the journal."""


def quiz(journal: ProgressJournal) -> Dialogue:
    return QuizDialogue(QuizSession(journal, kit_bank(), quiz_plan(kit_bank()), seed=1))


def form(journal: ProgressJournal) -> Dialogue:
    return FormDialogue(FormSession(read_form(), SurveyPhase.BEFORE, journal))


DIALOGUES: Final[dict[str, Callable[[ProgressJournal], Dialogue]]] = {"quiz": quiz, "form": form}


def walk(dialogue: type[Dialogue], seed: int, count: int = 25) -> list[str]:
    """Lines at random: keys of the dialogue, some of them twice, and some that mean nothing; in the end it is left."""
    chance = random.Random(seed)
    keys = sorted(
        {
            KEYS_OF_SIGNS.get(key, key)
            for each in dialogue.actions
            if each.is_for_lines
            for key in each.keys.key_names
        }
        - {"escape", "q", "backspace"}
    )
    usual = [key for key in keys if key.isdecimal()] * 3
    drawn: list[str] = []
    while len(drawn) < count:
        drawn += [chance.choice([*keys, *usual])] * chance.choice([1, 1, 2])
    return [*drawn, "q"]


@pytest.fixture
def log(monkeypatch: pytest.MonkeyPatch) -> list[tuple[object, ...]]:
    """What every turn does, in whatever face."""
    steps: list[tuple[object, ...]] = []
    do = Turn.do

    def logged(turn: Turn, action_id: str, *args: object) -> Effect:
        effect = do(turn, action_id, *args)
        said = turn.remark.text if turn.remark is not None else ""
        words = [each.word(turn.dialogue) if each.word else each.keys.label for each in turn.possible()]
        shown = lines_of(turn.dialogue.blocks())
        steps.append((action_id, args, type(effect).__name__, said, words, shown))
        return effect

    monkeypatch.setattr(Turn, "do", logged)
    return steps


def by_line(
    make: Callable[[ProgressJournal], Dialogue], lines: list[str], folder: Path
) -> tuple[Dialogue, list[Any]]:
    with ProgressJournal(folder) as journal:
        dialogue = make(journal)
        run_dialogue(dialogue)
        return dialogue, [(each.kind, each.subject, each.content) for each in journal.events()]


def on_screen(make: Callable[[ProgressJournal], Dialogue], lines: list[str], folder: Path) -> list[Any]:
    """Presses the key of each line, and after it the one that the line's end is, as a person at the screen would."""

    async def run(journal: ProgressJournal) -> None:
        app: App[None] = App()
        async with app.run_test(size=(200, 50)) as pilot:
            screen = DialogueScreen(make(journal))
            await app.push_screen(screen)
            await pilot.pause()
            for line in lines:
                screen.set_focus(None)
                key = SIGNS.get(line, line)
                found = screen.turn.find(key)
                await pilot.press(key)
                await pilot.pause()
                if app.screen is not screen:
                    await pilot.press("escape")
                    await pilot.pause()
                if not screen.is_attached or not screen.is_active:
                    return
                assert_shown(screen)
                if found is not None and screen.turn.allowed_then(found[0]):
                    (name, *_), *_ = screen.dialogue.action(found[0].then).keys.bindings
                    await pilot.press(name.split(",")[-1])
                    await pilot.pause()
                if screen.dialogue.is_over:  # there a line's end is the end
                    return

    with ProgressJournal(folder) as journal:
        asyncio.run(run(journal))
        return [(each.kind, each.subject, each.content) for each in journal.events()]


def assert_shown(screen: DialogueScreen) -> None:
    """What was said stands on the screen, and its last row names what is possible."""
    *_, remark, keys = rows(screen)
    if screen.turn.remark is not None:
        assert screen.turn.remark.text in remark
    for each in screen.turn.possible():
        if each.is_listed:
            assert (each.word(screen.dialogue) if each.word else each.keys.label) in keys


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("name", DIALOGUES)
def test_both_faces_agree(
    name: str,
    seed: int,
    tmp_path: Path,
    log: list[tuple[object, ...]],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    make = DIALOGUES[name]
    for folder in ("none", "lines", "screen"):
        (tmp_path / folder).mkdir()
    with ProgressJournal(tmp_path / "none") as journal:
        lines = walk(type(make(journal)), seed)
    monkeypatch.setattr(sys, "stdin", io.StringIO("".join(f"{line}\n" for line in lines)))
    _, kept_by_line = by_line(make, lines, tmp_path / "lines")
    steps, log[:] = list(log), []
    printed = " ".join(capsys.readouterr().out.split())
    kept_on_screen = on_screen(make, lines, tmp_path / "screen")
    assert log == steps
    assert kept_on_screen == kept_by_line
    assert kept_by_line, "the walk went nowhere"
    for _, _, _, said, _, _ in steps:
        assert " ".join(str(said).split()) in printed


@pytest.mark.parametrize("name", DIALOGUES)
def test_at_most_one_action_of_a_key_is_possible(name: str, tmp_path: Path) -> None:
    with ProgressJournal(tmp_path) as journal:
        dialogue = DIALOGUES[name](journal)
        turn = Turn(dialogue)
        for line in walk(type(dialogue), 3, count=120)[:-1]:
            possible = [key for each in turn.possible() for key in each.keys.key_names]
            assert len(possible) == len(set(possible))
            effect, then = turn.enter(line)
            assert not isinstance(effect, Leave)
            if isinstance(effect, Tell):
                assert effect.blocks
            if then:
                turn.do(then)
