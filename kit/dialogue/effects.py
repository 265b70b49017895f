"""What an action of a dialogue leads to, beside what the dialogue shows next: a face carries it out in its own way."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from kit.document.blocks import Block, Tone

if TYPE_CHECKING:
    from kit.dialogue.dialogue import Dialogue

ShowProgress: TypeAlias = Callable[[str], None]
"""Takes a sentence on how far something is."""


@dataclass(frozen=True, slots=True)
class Remark:
    """A sentence that stands until the next key or line."""

    text: str
    tone: Tone = Tone.PLAIN


@dataclass(frozen=True, slots=True)
class Leave:
    """The dialogue is over."""


@dataclass(frozen=True, slots=True)
class Help:
    """All actions, with their keys."""


@dataclass(frozen=True, slots=True)
class StartTyping:
    """Keys are for the text that is typed from now on."""


@dataclass(frozen=True, slots=True)
class Tell:
    """A page to read; it is closed before anything else is done."""

    title: str
    blocks: Sequence[Block]


class Option(NamedTuple):
    """An entry of a ``Choose``."""

    name: str
    text: str = ""


@dataclass(frozen=True, slots=True)
class Choose:
    """One of several entries; ``then`` gets its number, from 0, or None where none was chosen."""

    title: str
    options: Sequence[Option]
    then: Callable[[int | None], Effect]
    selected: int = 0


@dataclass(frozen=True, slots=True)
class Open:
    """Another dialogue, from which one comes back to this one."""

    dialogue: Dialogue
    then: Callable[[], Effect] = lambda: None


@dataclass(frozen=True, slots=True)
class Work:
    """A job that takes a moment, in a thread of its own; ``then`` gets what it returned."""

    note: str
    """Said meanwhile."""
    job: Callable[[ShowProgress], Any]
    """May say how far it is, in the note's place."""
    then: Callable[[Any], Effect]


@dataclass(frozen=True, slots=True)
class Show:
    """Something that each face has a way of its own for: a drive, a replay, an editor. ``then`` gets what came of it."""

    request: object
    """A record; a face finds its way by the record's class."""
    then: Callable[[Any], Effect] = lambda result: None


Effect = Remark | Leave | Help | StartTyping | Tell | Choose | Open | Work | Show | None
