"""A picture in a terminal that is painted again where it is, without a full screen: for scripts, also over SSH."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from typing import TextIO

from kit.render.encode import ENCODERS
from kit.render.scene import Scene
from kit.render.world_text import scene_rows

UP, CLEAR_LINE, CLEAR_BELOW = "\x1b[{}A", "\x1b[2K", "\x1b[0J"
MAX_ROWS = 30
"""Of a world; a larger terminal stays free below."""


class TerminalPicture:
    """Paints a scene with a line of text below it, each time over the last one.

    Where the output is not a terminal, one picture follows another. Where it cannot say braille, they are in ASCII.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._is_terminal = stream.isatty()
        self._painted = 0
        try:
            "⣿".encode(stream.encoding or "ascii")
            self._encoder = ENCODERS["braille"](True)
        except UnicodeEncodeError:
            self._encoder = ENCODERS["ascii"](True)

    def paint(self, scene: Scene, caption: str) -> None:
        """Paints the scene as large as the terminal is, and leaves the cursor on the line below the caption."""
        columns, lines = shutil.get_terminal_size()
        rows = scene_rows(scene, max(10, columns - 1), min(MAX_ROWS, max(4, lines - 2)), self._encoder)
        self._write([*rows, caption[: columns - 1]])

    def _write(self, lines: Sequence[str]) -> None:
        if not self._is_terminal:
            self._stream.write("".join(f"{line}\n" for line in lines))
        else:
            start = UP.format(self._painted) if self._painted else ""
            self._stream.write(start + "".join(f"{CLEAR_LINE}{line}\r\n" for line in lines) + CLEAR_BELOW)
        self._stream.flush()
        self._painted = len(lines)
