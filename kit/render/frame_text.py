"""Text and frames written into a frame of characters."""

from __future__ import annotations

from kit.render.encode import BLANK, Frame
from kit.render.roles import Role


def write_text(frame: Frame, row: int, column: int, text: str, role: Role = Role.WALL) -> None:
    """Writes a text into a frame; what does not fit is cut off."""
    rows, columns = frame.shape
    if not 0 <= row < rows:
        return
    for at, glyph in enumerate(text[: max(0, columns - column)], column):
        frame.glyphs[row, at] = ord(glyph)
        frame.fg[row, at] = Role.EMPTY if glyph == chr(BLANK) else role
        frame.bg[row, at] = Role.EMPTY


def paste_frame(frame: Frame, part: Frame, top: int, left: int) -> None:
    """Copies a frame into another, its corner at ``top`` and ``left``; what does not fit is cut off."""
    rows, columns = part.shape
    for whole, piece in ((frame.glyphs, part.glyphs), (frame.fg, part.fg), (frame.bg, part.bg)):
        room = whole[top : top + rows, left : left + columns]
        room[:] = piece[: room.shape[0], : room.shape[1]]
