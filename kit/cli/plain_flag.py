"""``--plain`` before a command holds for whichever command it is: under which key a click context remembers it."""

from __future__ import annotations

from typing import Final

PLAIN: Final = "kit.plain"
"""In a context's ``meta``: whether it was given."""
