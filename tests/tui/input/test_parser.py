"""Every kind of sequence a terminal sends, through the parser, whole and in pieces."""

from __future__ import annotations

import time
from typing import Any

import pytest
from textual import events
from textual._xterm_parser import _MAX_SEQUENCE_SEARCH_THRESHOLD, XTermParser

from kit.tui.input.parser import KeyboardAnswer, KeyParser, KeyReleased, KeyRepeated
from tests.cases import every_case

PRESSES = {
    "w": "w",
    "W": "W",
    " ": "space",
    "\r": "enter",
    "\x03": "ctrl+c",
    "\x1b[A": "up",
    "\x1bOA": "up",
    "\x1b[1;2A": "shift+up",
    "\x1b[1;5D": "ctrl+left",
    "\x1b[97u": "a",
    "\x1b[97;;97u": "a",
    "\x1b[97;2;65u": "A",
    "\x1b[97;5u": "ctrl+a",
    "\x1b[97;1:1;97u": "a",
    "\x1b[97:65;2:1;65u": "A",
    "\x1b[97:65:113;2;65u": "A",
    "\x1b[32;1:1;32u": "space",
    "\x1b[27u": "escape",
    "\x1b[1;1:1A": "up",
    "\x1b[1;2:1C": "shift+right",
    "\x1b[3;1:1~": "delete",
    "\x1b[57441;2u": "left_shift",
    "\x1b[57447;2:1u": "right_shift",
    "\x1b[57442;5:1u": "left_control",
    "\x1b[57448;5:1u": "right_control",
}
RELEASES = {
    "\x1b[119;1:3u": "w",
    "\x1b[119;5:3u": "w",
    "\x1b[119:87;2:3u": "w",
    "\x1b[1;1:3A": "up",
    "\x1b[1;2:3D": "left",
    "\x1b[32;1:3u": "space",
    "\x1b[57441;1:3u": "left_shift",
    "\x1b[57448;1:3u": "right_control",
    "\x1b[27;1:3u": "escape",
    "\x1b[3;1:3~": "delete",
}
REPEATS = {
    "\x1b[119;1:2;119u": ("w", "w"),
    "\x1b[1;1:2B": ("down", None),
    "\x1b[32;1:2;32u": ("space", " "),
    "\x1b[57447;2:2u": ("right_shift", None),
}
ANSWERS = {
    "\x1b[?62;52;c": None,
    "\x1b[?6c": None,
    "\x1b[?1;2c": None,
    "\x1b[?61;4;6;7;14;21;22;23;24;28;32;42;52c": None,
    "\x1b[?64;1;2;6;9;15;16;17;18;21;22;28c": None,
    "\x1b[?0u\x1b[?62c": 0,
    "\x1b[?27u\x1b[?62;c": 27,
    "\x1b[?27u\x1b[?61;4;6;7;14;21;22;23;24;28;32;42;52c": 27,
}


def parse(text: str, *, piecewise: bool = False) -> list[object]:
    """What comes out, and is passed on, when the terminal sends this and then nothing."""
    parser = KeyParser()
    out: list[object] = []
    for piece in text if piecewise else [text]:
        out += parser.feed(piece)
    parser._timeout_time = 0.0 if parser._timeout_time is not None else None
    out += parser.tick()
    return out


def summary(text: str, *, piecewise: bool = False) -> list[object]:
    def one(event: object) -> object:
        match event:
            case KeyReleased():
                return ("up", event.key)
            case KeyRepeated():
                return ("again", event.key, event.character)
            case KeyboardAnswer():
                return ("answer", event.flags)
            case events.Key():
                return ("down", event.key)
        return type(event).__name__

    return [one(event) for event in parse(text, piecewise=piecewise)]


CASES: dict[str, Any] = (
    {text: [("down", key)] for text, key in PRESSES.items()}
    | {text: [("up", key)] for text, key in RELEASES.items()}
    | {text: [("again", *what)] for text, what in REPEATS.items()}
    | {text: [("answer", flags)] for text, flags in ANSWERS.items()}
    | {
        "\x1b[12;34R": ["CursorPosition"],
        "\x1b[I": ["AppFocus"],
        "\x1b[O": ["AppBlur"],
        "\x1b[?2026;2$y": ["TerminalSupportsSynchronizedOutput"],
        "\x1b[200~wasd\x1b[201~x": ["Paste", ("down", "x")],
        "\x1b[<35;10;5M": ["MouseMove"],
        "\x1b[48;24;80;480;800t": ["Resize"],
        "\x1b": [("down", "escape")],
        "\x1b[?31u": [],
        "w\x1b[?62;c\x1b[?27uw": [("down", "w"), ("answer", None), ("down", "w")],
    }
)


@every_case("piecewise", [False, True], ids=["whole", "piecewise"])
@every_case("text", CASES, ids=repr)
def test_a_sequence_becomes_what_it_means(text: str, piecewise: bool) -> None:
    assert summary(text, piecewise=piecewise) == CASES[text]


@every_case("answer", ANSWERS, ids=repr)
def test_an_answer_never_types_and_swallows_nothing_after_it(answer: str) -> None:
    assert summary(answer + "w\x1b[A")[-2:] == [("down", "w"), ("down", "up")]
    assert len(summary(answer + "w\x1b[A")) == 3


def test_a_long_answer_that_breaks_off_does_not_swallow_keys() -> None:
    cut = "\x1b[?61;4;6;7;14;21;22;23;24;28;32;42;5"
    assert summary(cut + "\x1b[A" + "5w") == [("down", "up"), ("down", "5"), ("down", "w")]


def test_a_release_bears_the_name_of_its_press() -> None:
    """Shift+1 types an exclamation mark; when 1 goes up, shift may be long gone."""
    assert summary("\x1b[49;2;33u\x1b[49;2:2;33u\x1b[49;1:3u\x1b[49;1:3u") == [
        ("down", "exclamation_mark"),
        ("again", "exclamation_mark", "!"),
        ("up", "exclamation_mark"),
        ("up", "1"),
    ]
    assert summary("\x1b[A\x1b[1;2:3A") == [("down", "up"), ("up", "up")]


def test_parsers_do_not_share_what_they_remember() -> None:
    """XTermParser caches parsed sequences for the whole process; our events must not be those."""
    assert summary("\x1b[119;1:3u") == summary("\x1b[119;1:3u") == [("up", "w")]
    one, other = parse("\x1b[119;;119u"), parse("\x1b[119;;119u")
    assert one[0] is not other[0]


# What we use of Textual beyond its public names. When one of these fails after an update of Textual, look here.


def test_textual_still_raises_at_event_types() -> None:
    """The reason for KeyParser. If this fails, Textual has learned them: see what can go."""
    with pytest.raises(ValueError, match="1:3"):
        list(XTermParser().feed("\x1b[97;1:3u"))


def test_textual_gives_up_on_a_sequence_beyond_the_threshold() -> None:
    """The reason for the long answer's own path."""
    sequence = "\x1b[?" + "1" * (_MAX_SEQUENCE_SEARCH_THRESHOLD - 3)
    assert not list(XTermParser().feed(sequence))
    assert len(list(XTermParser().feed(sequence + "1"))) > 1


def test_textual_passes_every_sequence_and_character_through_one_method() -> None:
    seen: list[str] = []

    class Spy(XTermParser):
        def _sequence_to_key_events(self, sequence: str, alt: bool = False) -> list[events.Key]:
            seen.append(sequence)
            return []

    list(Spy().feed("w\x1b[1;1:3A"))
    assert seen[0] == "w"
    assert seen[-1] == "\x1b[1;1:3A"


def test_textual_finds_an_escape_key_by_waiting() -> None:
    parser = KeyParser()
    assert list(parser.feed("\x1b")) == []
    end = time.monotonic() + 2
    found: list[object] = []
    while not found and time.monotonic() < end:
        found = list(parser.tick())
    assert isinstance(found[0], events.Key)
