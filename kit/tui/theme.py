"""How the kit looks in this terminal: what was decided, and the glyphs and colours that go with it."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, Self

from kit.render.encode import ENCODERS, Encoder
from kit.render.roles import PALETTES, Palette
from kit.tui.terminal import TerminalDecision

_PALETTE: Final = MappingProxyType({"none": "none", "ansi16": "16", "256": "256", "truecolour": "truecolor"})


@dataclass(frozen=True, slots=True)
class Theme:
    terminal: TerminalDecision
    encoder: Encoder
    palette: Palette

    @classmethod
    def of(cls, terminal: TerminalDecision) -> Self:
        """The look that the decision means."""
        colour = terminal.colour.value
        return cls(terminal, ENCODERS[terminal.glyphs.value](colour == "none"), PALETTES[_PALETTE[colour]])
