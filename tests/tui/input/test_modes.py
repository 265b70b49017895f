"""The key state machine, on a clock that stands still until told."""

from __future__ import annotations

import itertools

from kit.tui.input.drive_keys import DRIVE_KEYS, base_key, drive_key
from kit.tui.input.key_rhythm import KeyState, KeyTransition
from tests.cases import every_case


@every_case(
    ("steps", "transitions", "held"),
    [
        (["press w"], ["w down 0"], ["w"]),
        (["press w", "release w"], ["w down 0", "w up 1"], []),
        (["press w", "press w", "release w"], ["w down 0", "w up 2"], []),
        (["press w", "repeat w", "repeat w", "release w"], ["w down 0", "w up 3"], []),
        (["repeat w", "release w"], [], []),
        (["release w"], [], []),
        (["press W", "release w"], ["w down 0", "w up 1"], []),
        (["press shift+up", "release up"], ["up down 0", "up up 1"], []),
        (["press up", "release ctrl+shift+up"], ["up down 0", "up up 1"], []),
        (["press left_shift", "press W", "release left_shift", "release w"],
         ["left_shift down 0", "w down 1", "left_shift up 2", "w up 3"], []),
        (["press w", "press a", "release w"], ["w down 0", "a down 1", "w up 2"], ["a"]),
        (["press w", "press up", "release w"], ["w down 0", "up down 1", "w up 2"], ["up"]),
        (["press w", "press a", "clear", "repeat w", "release w"],
         ["w down 0", "a down 1", "w up 2", "a up 2"], []),
        (["clear"], [], []),
    ],
)  # fmt: skip
def test_transitions(steps: list[str], transitions: list[str], held: list[str]) -> None:
    now = itertools.count()
    time = [0.0]
    state = KeyState(lambda: time[0])
    happened: list[KeyTransition] = []
    for step in steps:
        time[0] = float(next(now))
        verb, _, key = step.partition(" ")
        happened += getattr(state, verb)(*[key] if key else [])
    assert [f"{one.key} {'down' if one.down else 'up'} {one.time:.0f}" for one in happened] == transitions
    assert list(state.held) == held


def test_since_when_a_key_is_held() -> None:
    time = [1.5]
    state = KeyState(lambda: time[0])
    state.press("w")
    time[0] = 2.5
    state.press("w")
    assert dict(state.held) == {"w": 1.5}


@every_case(
    ("key", "base"),
    [
        ("w", "w"),
        ("W", "w"),
        ("shift+up", "up"),
        ("ctrl+shift+left", "left"),
        ("left_shift", "left_shift"),
        ("É", "é"),
    ],
)
def test_the_key_under_a_chord(key: str, base: str) -> None:
    assert base_key(key) == base


def test_the_key_table_is_the_dissertations() -> None:
    names = "up down left right q e f space shift_l shift_r ctrl_l ctrl_r esc"
    assert " ".join(row.name for row in DRIVE_KEYS) == names
    assert (DRIVE_KEYS[0].pressed, DRIVE_KEYS[0].released) == ("p_up", "r_up")
    sends = {key: row.name for row in DRIVE_KEYS for key in row.keys}
    assert [sends[key] for key in ("up", "w", "down", "s", "left", "a", "right", "d")] == [
        *("up", "up", "down", "down", "left", "left", "right", "right")
    ]
    assert sum(len(row.keys) for row in DRIVE_KEYS) == len(sends)  # no key twice


@every_case(
    ("key", "name"),
    [("W", "up"), ("shift+up", "up"), ("ctrl+w", "up"), ("ctrl+shift+d", "right"), ("right_control", "ctrl_r"),
     ("alt+w", None), ("super+left", None), ("k", None), ("enter", None), ("plus", None)],
)  # fmt: skip
def test_which_chords_drive(key: str, name: str | None) -> None:
    row = drive_key(key)
    assert (row and row.name) == name
