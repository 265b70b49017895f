"""The keys of the play screen in words: the line at the bottom and the help page."""

from __future__ import annotations

from typing import Final

from kit.tui.text_rows import Row, row

KEYS: Final[Row] = row(
    ("←↑↓→", "bold"),
    " drive ",
    ("p", "bold"),
    " pause ",
    (".", "bold"),
    " step ",
    ("123", "bold"),
    " speed ",
    ("m", "bold"),
    " map ",
    ("c", "bold"),
    " controller ",
    ("r", "bold"),
    " reset ",
    ("?", "bold"),
    " help ",
    ("^C", "bold"),
    " leave",
)
"""Always in sight, in a line of 80."""

_TABLE: Final = (
    ("arrows, W A S D", "drive: you take over from the controller"),
    ("g", "the controller drives again"),
    ("x", "how keys drive: automatic, latch, repeat"),
    ("Q E F Space Esc", "for your own nodes, on /teleopkeys; Space stops"),
    ("", ""),
    ("p", "pause and go on"),
    (".", "one step while paused"),
    ("1  2  3", "real time, ten times faster, as fast as it goes"),
    ("r", "the world back to its start"),
    ("", ""),
    ("m", "another map"),
    ("c", "another controller; a saved file is read again"),
    ("", ""),
    ("+  -  0", "nearer, farther, everything"),
    ("h j k l", "look left, down, up, right"),
    ("v", "follow the robot"),
    ("b", "show the laser's beams"),
    ("Ctrl-C", "leave"),
)

HELP: Final[tuple[Row, ...]] = tuple(row((f"{key:<17}", "bold"), text) for key, text in _TABLE)
"""Every key of the screen."""
