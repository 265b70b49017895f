"""The keys of the screen of fields in words, and how to read its picture."""

from __future__ import annotations

from typing import Final

from kit.tui.rows.key_rows import key_line, key_page
from kit.tui.screens.watch_keys import PLAY_HELP

FIELDS_KEYS: Final = key_line(
    ("i", "which"),
    ("[ ]", "less, more"),
    ("o", "other"),
    ("c", "controller"),
    ("m", "map"),
    ("p", "pause"),
    ("r", "reset"),
    ("?", "help"),
    ("^C", "leave"),
)
FIELDS_HELP: Final = (
    *key_page(
        (
            ("i", "the next intensity: walls, target, robot, tension"),
            ("[  ]", "less of it, more of it; the controller hears of it at once"),
            ("o", "other arrows: the forces, the planner's ways, or no arrows"),
            ("→ ⇒  · ", "which way, strong, next to nothing"),
            ("-  !", "a charge on a wall; a trap, where forces cancel"),
            ("lines at robots", "the force on each, and on their middle"),
        )
    ),
    *PLAY_HELP[1:],
)
