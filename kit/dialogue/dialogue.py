"""A dialogue asks a person something, on a screen and line by line: what it shows, which actions there are, what each does.

A feature describes its dialogue once, without any face: ``kit/tui/screens/dialogue.py`` shows it on the full screen,
``kit/cli/dialogue.py`` line by line. Both ask a ``Turn`` what a key or a line does, and nothing else decides.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, ClassVar, Final, Generic, TypeVar

from kit.dialogue.actions import ScreenActions
from kit.dialogue.effects import Effect, Help, Leave, Remark
from kit.dialogue.screen_action import ScreenAction
from kit.dialogue.shared_actions import ACTIONS
from kit.document.blocks import Block, Text, Tone

D = TypeVar("D", bound="Dialogue")

SIGNS: Final[Mapping[str, str]] = MappingProxyType(
    {"": "enter", "?": "question_mark", ",": "comma", ".": "full_stop"}
)
"""What is typed in a line for a key whose name is not the sign itself; a line without a sign is Enter."""


class Refused(Exception):
    """An action cannot be done now; the message is the sentence that says why."""


def always(dialogue: Dialogue) -> bool:
    """The condition of an action that is always possible."""
    return True


@dataclass(frozen=True, slots=True)
class DialogueAction(Generic[D]):
    """One thing that can be done in a dialogue."""

    keys: ScreenAction
    """Its id, keys, word and help."""
    run: Callable[..., Effect]
    """Gets the dialogue, and what the key stands for: ``1`` of ``answer(1)``. May raise Refused."""
    when: Callable[[D], bool | str] = always
    """Whether it is possible now; False: it does not belong here; a sentence: why it is not possible yet."""
    confirm: str = ""
    """Said first; doing the same once more does it."""
    then: str = ""
    """Id of the action that a line does next, because it ends with Enter, which on the screen is a key of its own."""
    word: Callable[[D], str] | None = None
    """Its word in the line of keys now, where that is not always the same."""
    shown_keys: Callable[[D], str] | None = None
    """Its keys in that line now."""
    takes_text: bool = False
    """Whether a line may say more after its key or word; ``run`` then gets that as a text too."""
    is_listed: bool = True
    """Whether it is in the line of keys; else on the help page alone."""
    is_for_lines: bool = True
    """Whether it means something line by line."""
    while_busy: bool = False
    """Whether it is possible while the dialogue is busy."""

    @property
    def id(self) -> str:
        return self.keys.id


@dataclass(frozen=True, slots=True)
class Panel:
    """Something that a screen with room shows beside what is asked, or below it."""

    title: str
    blocks: tuple[Block, ...]
    is_below: bool = False
    """Whether it stands below what is asked where the others stand beside that."""


class Dialogue:
    """Subclasses give ``name``, ``title``, ``actions`` and ``blocks``; everything else has a default."""

    name: ClassVar[str]
    """Of the dialogue in the table of all keys."""
    help_title: ClassVar[str]
    help_notes: ClassVar[Sequence[Sequence[tuple[str, str]]]] = ()
    """Signs or terms and what they mean, on the help page."""
    actions: ClassVar[Sequence[DialogueAction[Any]]]
    failures: ClassVar[Mapping[type[Exception], str]] = MappingProxyType({})
    """Errors that an action may raise, and how they are said: ``Not saved: {}``."""
    has_entry: ClassVar[bool] = False
    """Whether texts are typed in it."""
    has_scenes: ClassVar[bool] = False
    """Whether ``scene_shown`` may give one."""

    # What is shown

    @property
    def title(self) -> str:
        raise NotImplementedError

    @property
    def position(self) -> str:
        """Where one is: ``question 3 of 12``."""
        return ""

    def blocks(self) -> Sequence[Block]:
        """What is shown now. A screen shows all of it, line by line only what is new is said."""
        raise NotImplementedError

    def possible_blocks(self) -> Sequence[Sequence[Block]]:
        """All that ``blocks`` may come to be at this place: what a screen shows below them keeps its place."""
        return ()

    @property
    def has_panels(self) -> bool:
        """Whether ``panels`` gives any now."""
        return False

    def panels(self) -> Sequence[Panel]:
        """What a screen shows to the right of the others where it is wide enough, else at its bottom, as many as there is room
        for, the last one cut where it must be; line by line they are not said. Where all are at the bottom the first is the lowest."""
        return ()

    @property
    def scene_shown(self) -> object:
        """The scene of a lesson of which a large screen shows a picture below what is asked; None: none belongs to it."""
        return None

    def figure(self) -> Panel | None:
        """What such a screen shows below the picture, before all panels there; None: nothing."""
        return None

    def arrival_blocks(self) -> Sequence[Block]:
        """What is said line by line when one comes to a place, and stands elsewhere on a screen."""
        return ()

    @property
    def place(self) -> object:
        """Is another at another question or step: line by line the position and ``arrival_blocks`` are said there."""
        return None

    @property
    def block_in_view(self) -> Block | None:
        """The block that was just said, which a screen brings into sight; None: it shows the beginning."""
        return None

    @property
    def note(self) -> Text | None:
        """Stands where remarks do, while there is none; said line by line when it is another than before."""
        return None

    def opening(self) -> Sequence[Block]:
        """Said line by line before anything else."""
        return ()

    def farewell(self) -> Sequence[Block]:
        """Said line by line when one has left."""
        return ()

    @property
    def is_over(self) -> bool:
        """Whether nothing is left to ask: line by line one need not leave, then."""
        return False

    # Typed text

    @property
    def entry(self) -> str | None:
        """The text that is typed, as it is so far; None: none is typed now."""
        return None

    def take_draft(self, text: str) -> None:
        """Takes the text as it is typed."""

    def take_line(self, line: str) -> Effect:
        """Does what a line means that is no action's. Raises Refused."""
        raise Refused(f"{line!r} does nothing here; ? lists what does.")

    # Something that goes on

    @property
    def busy(self) -> str:
        """What it is doing, while few actions are possible; empty while it does nothing."""
        return ""

    @property
    def polls(self) -> bool:
        """Whether ``poll`` is to be called a few times a second."""
        return False

    def poll(self) -> Effect:
        """Looks whether something has happened by itself."""
        return None

    def stop(self) -> Effect:
        """Ends what it is doing."""
        return None

    def close(self) -> None:
        """Is called when a face is done with it."""

    # Actions

    @classmethod
    def action(cls, action_id: str) -> DialogueAction[Any]:
        return next(each for each in cls.actions if each.id == action_id)

    @classmethod
    def screen_actions(cls) -> ScreenActions:
        """The record of its keys, like a screen's."""
        return ScreenActions(
            cls.name,
            tuple(each.id for each in cls.actions if each.is_listed),
            tuple(
                each.id
                for each in cls.actions
                if not each.is_listed and each.id not in ("glossary", "palette")
            ),
            own=tuple(each.keys for each in cls.actions if each.id not in ACTIONS),
        )


def help_action() -> DialogueAction[Any]:
    """``?``"""
    return DialogueAction(ACTIONS["help"], lambda dialogue: Help(), while_busy=True)


def leave_action(
    run: Callable[..., Effect] = lambda dialogue: Leave(), word: Callable[[Any], str] | None = None
) -> DialogueAction[Any]:
    """Esc and ``q``."""
    return DialogueAction(ACTIONS["back"], run, word=word, while_busy=True)


class Turn:
    """Decides what a key or a line does in a dialogue: whether it is possible, what is said if it is not, what is asked first."""

    def __init__(self, dialogue: Dialogue) -> None:
        self.dialogue = dialogue
        self.remark: Remark | None = None
        """What was said last; None: nothing that still counts."""
        self._asked: tuple[str, tuple[object, ...]] | None = None
        """What was to be done when it was asked whether it is meant."""

    def allowed(self, action: DialogueAction[Any]) -> bool | str:
        """Whether an action is possible now; False: it does not belong here; a sentence: why not yet."""
        if self.dialogue.busy and not action.while_busy:
            return False
        return action.when(self.dialogue)

    def possible(self) -> list[DialogueAction[Any]]:
        """The actions that are possible now."""
        return [each for each in self.dialogue.actions if self.allowed(each) is True]

    def press(self, key: str) -> Effect:
        """Does what a key means, by Textual's name of it; of several actions that have it the first that is possible."""
        found = self.find(key)
        if found is None:
            self._asked = None
            return None
        action, args = found
        return self.do(action.id, *args, pressed=key if len(key) == 1 else key.capitalize())

    def find(self, key: str) -> tuple[DialogueAction[Any], tuple[object, ...]] | None:
        """The action that a key means now, and what the key stands for."""
        candidates = [
            (action, _call_arguments(call))
            for action in self.dialogue.actions
            for keys, call in action.keys.bindings
            if key in keys.split(",")
        ]
        return min(candidates, key=lambda each: _availability_rank(self.allowed(each[0])), default=None)

    def hidden_by_others(self) -> list[DialogueAction[Any]]:
        """The actions all of whose keys now mean another one."""
        meant = [found[0] for key in self._keys() if (found := self.find(key)) is not None]
        return [each for each in self.dialogue.actions if each.keys.key_names and each not in meant]

    def _keys(self) -> set[str]:
        return {key for each in self.dialogue.actions for key in each.keys.key_names}

    def enter(self, line: str) -> tuple[Effect, str]:
        """Does what a line means: a key, an action's word, perhaps with more behind it, or a text that is typed.

        Returns what comes of it, and the id of the action that the line's end does then; empty: of none.
        """
        words = line.strip()
        found = self._find_line(words)
        if found is None:
            self._asked = None
            return self.attempt(self.dialogue.take_line, line.strip()), ""
        action, args = found
        return self.do(action.id, *args), action.then if self.allowed_then(action) else ""

    def allowed_then(self, action: DialogueAction[Any]) -> bool:
        """Whether what a line's end does after an action is possible now."""
        return bool(action.then) and self.allowed(self.dialogue.action(action.then)) is True

    def _find_line(self, words: str) -> tuple[DialogueAction[Any], tuple[object, ...]] | None:
        first, _, rest = words.partition(" ")
        key = SIGNS.get(first, first.lower())
        found = self.find(key)
        if found is not None and found[0].is_for_lines and (not rest or found[0].takes_text):
            action, args = found
            return (action, (*args, rest.strip())) if rest else (action, args)
        lowered = words.lower()
        for action in self.dialogue.actions:
            if not action.is_for_lines or (len(action.keys.bindings) != 1):
                continue
            if lowered == action.keys.label or (
                action.takes_text and lowered.startswith(f"{action.keys.label} ")
            ):
                rest = words[len(action.keys.label) :].strip()
                return (action, (rest,)) if rest else (action, ())
        return None

    def do(self, action_id: str, *args: object, pressed: str = "") -> Effect:
        """Does an action, or says why not; ``pressed``: its key that was pressed, if it has several."""
        action = self.dialogue.action(action_id)
        allowed, asked = self.allowed(action), self._asked
        self.remark = self._asked = None
        if allowed is not True:
            sentence = (
                allowed or f"{pressed or action.keys.keys.split()[0]} does nothing here; ? lists what does."
            )
            return self.set_remark(Remark(str(sentence), Tone.WARN))
        if action.confirm and asked != (action_id, args):
            self._asked = action_id, args
            return self.set_remark(Remark(action.confirm, Tone.WARN))
        return self.attempt(action.run, self.dialogue, *args)

    def attempt(self, run: Callable[..., Effect], *args: object) -> Effect:
        """Calls what may be refused or fail; the sentence then stands as a remark."""
        self.remark = None
        try:
            effect = run(*args)
        except Refused as refusal:
            effect = Remark(str(refusal), Tone.WARN)
        except tuple(self.dialogue.failures) as error:
            words = next(text for kind, text in self.dialogue.failures.items() if isinstance(error, kind))
            effect = Remark(words.format(error), Tone.BAD)
        return self.set_remark(effect) if isinstance(effect, Remark) else effect

    def set_remark(self, remark: Remark) -> Remark:
        """Lets a remark stand."""
        self.remark = remark
        return remark


def _availability_rank(allowed: bool | str) -> int:
    """Orders actions of one key: what is possible, what could become possible, what does not belong here."""
    return 0 if allowed is True else 1 if allowed else 2


def _call_arguments(call: str) -> tuple[object, ...]:
    """``(1,)`` of ``answer(1)``."""
    inside = call.partition("(")[2].rstrip(")")
    return tuple(ast.literal_eval(f"({inside},)")) if inside else ()
