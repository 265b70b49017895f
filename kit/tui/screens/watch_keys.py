"""The keys of the screens with a running world, in words: the line at the bottom and the help page."""

from __future__ import annotations

from typing import Final

from kit.tui.text_rows import Row, row

_Table = tuple[tuple[str, str], ...]


def _line(*keys: tuple[str, str]) -> Row:
    parts = [part for key, text in keys for part in ((key, "bold"), f" {text} ")]
    return row(*parts)


def _page(*tables: _Table) -> tuple[Row, ...]:
    rows = [row()]
    for table in tables:
        rows += [*(row((f" {key:<17}", "bold"), text) for key, text in table), row()]
    return tuple(rows)


_DRIVE: Final[_Table] = (
    ("arrows, W A S D", "drive: you take over from the controller"),
    ("g", "the controller drives again"),
    ("x", "how keys drive: automatic, latch, repeat"),
    ("Q E F Space Esc", "for your own nodes, on /teleopkeys; Space stops"),
)
_TIME: Final[_Table] = (
    ("p", "pause and go on"),
    (".", "one step while paused"),
    ("1  2  3", "real time, ten times faster, as fast as it goes"),
    ("r", "from the start again"),
)
_CHOICE: Final[_Table] = (
    ("m", "another map"),
    ("c", "another controller; a saved file is read again"),
)
_PICTURE: Final[_Table] = (
    ("+  -  0", "nearer, farther, everything"),
    ("h j k l", "look left, down, up, right"),
    ("v", "follow the robot"),
    ("b", "show the laser's beams"),
    ("Ctrl-C", "leave"),
)

PLAY_KEYS: Final = _line(
    ("←↑↓→", "drive"),
    ("p", "pause"),
    (".", "step"),
    ("123", "speed"),
    ("m", "map"),
    ("c", "controller"),
    ("r", "reset"),
    ("?", "help"),
    ("^C", "leave"),
)
PLAY_HELP: Final = _page(_DRIVE, _TIME, _CHOICE, _PICTURE)

REPLAY_KEYS: Final = _line(
    ("p", "pause"),
    (".", "step"),
    ("123", "speed"),
    ("r", "from the start"),
    ("+ -", "zoom"),
    ("?", "help"),
    ("^C", "leave"),
)
REPLAY_HELP: Final = _page(_TIME, _PICTURE)
