"""Actions of the screens: their keys, their words, and the record with which a screen says which it has.

An action that several screens have is in the table here, one that a single screen has in that screen's ``ScreenActions``.
A screen's bindings, the line of keys at its bottom and its help page are made from them; the line mode takes its letters and
words from the table. ``.github/CONTRIBUTING.md`` prints the shared ones, and a test compares the two.

Outside the screens where keys drive a robot, a letter of a shared action means nothing else anywhere.
No Textual here: the line mode imports this module.
"""

from __future__ import annotations

from dataclasses import dataclass

from kit.dialogue.screen_action import ScreenAction
from kit.dialogue.shared_actions import ACTIONS


@dataclass(frozen=True, slots=True)
class ScreenActions:
    """The actions of one screen. Its bindings, its bottom line and its help page are made from this record."""

    name: str
    """Name of the screen in the table of all keys."""
    footer: tuple[str, ...]
    """Ids of the actions in the bottom line, the most important first: a narrow line leaves out the last ones."""
    more: tuple[str, ...] = ()
    """On the help page alone."""
    own: tuple[ScreenAction, ...] = ()
    """Actions that no other screen has."""
    drives: bool = False
    """Whether letters drive a robot here, so that letters may mean something other than on other screens."""

    def __getitem__(self, action_id: str) -> ScreenAction:
        return next((each for each in self.own if each.id == action_id), None) or ACTIONS[action_id]

    @property
    def records(self) -> tuple[ScreenAction, ...]:
        return tuple(map(self.__getitem__, self.ids))

    @property
    def ids(self) -> tuple[str, ...]:
        return (*self.footer, *self.off_footer)

    @property
    def off_footer(self) -> tuple[str, ...]:
        """``more``, on every screen that has a help page the glossary, and everywhere the list of commands."""
        return (*self.more, *(("glossary",) if "help" in self.footer else ()), "palette")
