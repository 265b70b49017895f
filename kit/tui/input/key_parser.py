"""Textual's key parser, with the release and the repetition of keys where a terminal reports them."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Final

from textual import events
from textual._xterm_parser import _MAX_SEQUENCE_SEARCH_THRESHOLD, XTermParser
from textual.keys import Keys

from kit.tui.input.drive_keys import base_key

_REPEAT, _RELEASE = "2", "3"
"""What a terminal says of a key besides that it was pressed."""

_KEY: Final = re.compile(
    r"\x1b\[(?P<code>\d*)(?::[\d:]*)?(?:;(?P<modifiers>\d*)(?::(?P<kind>\d*))?(?P<text>;[\d:]*)?)?"
    r"(?P<end>[u~ABCDEFHPQRS])"
)
_ANSWER: Final = re.compile(r"\x1b\[\?(?P<numbers>[\d;]*)(?P<end>[uc])")
_LONG_ANSWER: Final = re.compile(r"\x1b\[\?[\d;]*")


class KeyReleased(events.InputEvent):
    """A key went up. ``key`` is the name under which its press arrived, whatever the modifiers are by now.

    Textual hands presses to the widget in focus and these to the screen, so they may arrive before their press;
    ``time`` tells.
    """

    def __init__(self, key: str) -> None:
        super().__init__()
        self.key = key


class KeyRepeated(events.InputEvent):
    """A key is still down and the keyboard repeats it.

    Not a subclass of ``events.Key``: Textual names handlers after classes, so ``on_key`` would not see it.
    """

    def __init__(self, key: str, character: str | None = None) -> None:
        super().__init__()
        self.key = key
        self.character = character


class KeyboardAnswer(events.InputEvent):
    """The terminal's answer to ``CSI ? u CSI c``: its keyboard flags, None if it knows no such thing."""

    key: Final = ""
    """The parser looks at the key of whatever it passes on."""

    def __init__(self, flags: int | None) -> None:
        super().__init__()
        self.flags = flags


class KeyParser(XTermParser):
    """Yields what XTermParser yields, and KeyReleased, KeyRepeated and KeyboardAnswer."""

    def __init__(self, debug: bool = False) -> None:
        self._names: dict[str, str] = {}
        self._flags: int | None = None
        self._in_long_answer = False
        super().__init__(debug)

    def _sequence_to_key_events(  # type: ignore[override]  # XTermParser reads only .key of what comes out of here
        self, sequence: str, alt: bool = False
    ) -> Iterable[events.InputEvent]:
        if self._in_long_answer and not sequence.startswith("\x1b"):
            if sequence not in "0123456789;":
                self._in_long_answer = False
                yield self._answer(sequence, "")
            return
        self._in_long_answer = False
        if match := _ANSWER.fullmatch(sequence):
            yield self._answer(match["end"], match["numbers"])
        elif len(sequence) == _MAX_SEQUENCE_SEARCH_THRESHOLD and _LONG_ANSWER.fullmatch(sequence):
            # One more character and XTermParser would type all of it out. Windows Terminal's answer is 38 long.
            self._in_long_answer = True
            yield _ignored(sequence)
        elif match := _KEY.fullmatch(sequence):
            yield from self._key_events(match, sequence, alt)
        else:
            yield from super()._sequence_to_key_events(sequence, alt)

    def _key_events(self, match: re.Match[str], sequence: str, alt: bool) -> Iterable[events.InputEvent]:
        """The events of one key sequence. XTermParser would raise ValueError at a kind or an alternate."""
        code, kind = match["code"], match["kind"]
        if ":" in sequence:
            sequence = f"\x1b[{code};{match['modifiers'] or ''}{match['text'] or ''}{match['end']}"
        place = (code or "1") + match["end"]  # an arrow goes down as CSI A and up as CSI 1;1:3A
        for event in super()._sequence_to_key_events(sequence, alt):
            if kind == _RELEASE:
                yield KeyReleased(self._names.pop(place, base_key(event.key)))
            elif kind == _REPEAT:
                yield KeyRepeated(self._names.get(place, event.key), event.character)
            else:
                self._names[place] = event.key
                yield event

    def _answer(self, end: str, numbers: str) -> events.InputEvent:
        """Keyboard flags are kept until the device attributes, asked for last, say that all has been answered."""
        if end == "u":
            self._flags = int(numbers.partition(";")[0] or 0)
        elif end == "c":
            flags, self._flags = self._flags, None
            return KeyboardAnswer(flags)
        return _ignored(numbers + end)


def _ignored(sequence: str) -> events.Key:
    """What XTermParser itself yields for a sequence that means nothing to the app."""
    return events.Key(Keys.Ignore, sequence)
