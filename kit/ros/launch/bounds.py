"""Bounds of a launch file, so that one that repeats or contains itself is told its line before time and memory are used up."""

from __future__ import annotations

from typing import Final

MAX_DEPTH: Final = 100
"""Levels of actions, elements, lists and substitutions inside each other."""
MAX_ACTIONS: Final = 100_000
"""Actions that are carried out, or elements that a file has, until the launch file's process answers."""
MAX_PROCESSES: Final = 1000
"""Processes that are started until it answers."""
MAX_LOGGED: Final = 256 * 1024
"""Characters that are logged until it answers."""
LOG_LINE: Final = 64
"""Characters that each line counts besides its text."""
MAX_TEXT_LENGTH: Final = 4 * 1024 * 1024
"""Characters of one text that substitutions make: a robot's description has some hundred thousand."""
NESTED_TOO_DEEPLY: Final = f"more than {MAX_DEPTH} levels inside each other; does something contain itself?"
