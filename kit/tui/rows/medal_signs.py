"""Signs and styles of medals and stars, which are also read where there is no colour."""

from __future__ import annotations

from typing import Final

from kit.document.blocks import Tone
from kit.school.game.medal import Medal

STAR, NO_STAR = "*", "."
"""A star that was earned, and one that was not."""
MEDAL_SIGNS: Final = {
    Medal.NONE: NO_STAR,
    Medal.BRONZE: "B",
    Medal.SILVER: "S",
    Medal.GOLD: "G",
    Medal.MASTER: "M",
    Medal.RECORD: "R",
}
MEDAL_STYLES: Final = {
    Medal.NONE: Tone.DIM,
    Medal.BRONZE: Tone.BRONZE,
    Medal.SILVER: Tone.BOLD,
    Medal.GOLD: Tone.WARN,
    Medal.MASTER: Tone.GOOD,
    Medal.RECORD: Tone.GOOD,
}
