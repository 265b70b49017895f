"""Line by line everything of another place is said, also what stood at the one before it."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, ClassVar

import pytest

from kit.cli.dialogue import run_dialogue
from kit.dialogue.dialogue import Dialogue, DialogueAction, help_action
from kit.dialogue.shared_actions import ACTIONS
from kit.document.blocks import Block, Text

QUESTION = "How many layers does this need?"


class Cards(Dialogue):
    """Two questions in the same words."""

    id = "cards"
    title = "Cards"

    def __init__(self) -> None:
        self.number = 1

    @property
    def place(self) -> object:
        return self.number

    @property
    def is_over(self) -> bool:
        return self.number > 2

    def blocks(self) -> Sequence[Block]:
        return [] if self.is_over else [Text(QUESTION)]

    def go_on(self) -> None:
        self.number += 1

    actions: ClassVar[Sequence[DialogueAction[Any]]] = (
        DialogueAction(ACTIONS["next"], go_on),
        help_action(),
    )


def test_a_question_in_the_words_of_the_one_before_is_asked(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    reader, writer = os.pipe()
    os.write(writer, b"n\nn\n")
    os.close(writer)
    with os.fdopen(reader) as typed:
        monkeypatch.setattr("sys.stdin", typed)
        run_dialogue(Cards())
    assert capfd.readouterr().out.count(QUESTION) == 2
