"""The keys of the screens with a running world, in words: the line at the bottom and the help page."""

from __future__ import annotations

from typing import Final

from kit.tui.rows.key_rows import KeyTable, key_line, key_page

_DRIVE: Final[KeyTable] = (
    ("arrows, W A S D", "drive: you take over from the controller"),
    ("g", "the controller drives again"),
    ("x", "how keys drive: automatic, latch, repeat"),
    ("Q E F Space Esc", "for your own nodes, on /teleopkeys; Space stops"),
)
_TIME: Final[KeyTable] = (
    ("p", "pause and go on"),
    (".", "one step while paused"),
    ("1  2  3", "real time, ten times faster, as fast as it goes"),
    ("r", "from the start again"),
)
_CHOICE: Final[KeyTable] = (
    ("m", "another map"),
    ("c", "another controller; a saved file is read again"),
    ("n", "nodes and topics: who says what to whom"),
    ("t", "trainings: their curves, the robot with the newest policy"),
)
_PICTURE: Final[KeyTable] = (
    ("+  -  0", "nearer, farther, everything"),
    ("h j k l", "look left, down, up, right"),
    ("v", "follow the robot"),
    ("b", "show the laser's beams"),
    ("Ctrl-C", "leave"),
)

PLAY_KEYS: Final = key_line(
    ("←↑↓→", "drive"),
    ("p", "pause"),
    (".", "step"),
    ("123", "speed"),
    ("m", "map"),
    ("c", "code"),
    ("n", "nodes"),
    ("r", "reset"),
    ("?", "help"),
    ("^C", "leave"),
)
PLAY_HELP: Final = key_page(_DRIVE, _TIME, _CHOICE, _PICTURE)

LAUNCH_KEYS: Final = key_line(
    ("←↑↓→", "keys"),
    ("p", "pause"),
    (".", "step"),
    ("123", "speed"),
    ("n", "nodes"),
    ("r", "reset"),
    ("+ -", "zoom"),
    ("?", "help"),
    ("^C", "leave"),
)
LAUNCH_HELP: Final = key_page(
    (
        ("arrows, W A S D", "for programs that listen to /teleopkeys"),
        ("x", "how keys count: automatic, latch, repeat"),
        ("Q E F Space Esc", "likewise, on /teleopkeys"),
        ("n", "nodes and topics: who says what to whom"),
    ),
    _TIME,
    _PICTURE,
)

REPLAY_KEYS: Final = key_line(
    ("p", "pause"),
    (".", "step"),
    ("123", "speed"),
    ("r", "from the start"),
    ("+ -", "zoom"),
    ("?", "help"),
    ("^C", "leave"),
)
REPLAY_HELP: Final = key_page(_TIME, _PICTURE)
