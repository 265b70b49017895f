"""A dialogue: one question."""

from __future__ import annotations

from collections.abc import Sequence

from kit.dialogue.dialogue import Dialogue, help_action, leave_action
from kit.dialogue.effects import Effect
from kit.document.blocks import Block, Text
from kit.workspace import Workspace


class AskMe(Dialogue):
    """Asks for a colour until it is green."""

    name = "ask-me"
    help_title = "Ask me"
    has_entry = True
    actions = (help_action(), leave_action())

    def __init__(self) -> None:
        self._colour = ""

    @property
    def title(self) -> str:
        return "Ask me"

    def blocks(self) -> Sequence[Block]:
        return [Text(f"{self._colour} it is." if self.is_over else "Which colour means go?")]

    @property
    def is_over(self) -> bool:
        return self._colour == "green"

    @property
    def entry(self) -> str | None:
        return None if self.is_over else self._colour

    def take_line(self, line: str) -> Effect:
        self._colour = line.strip()
        return None


def make_dialogue(workspace: Workspace) -> AskMe:
    """Ask which colour means go."""
    return AskMe()
