"""Frames of characters as an asciicast (version 2): what ``asciinema play`` and its web player show.

Format: https://docs.asciinema.org/manual/asciicast/v2/
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator

from kit.render.encode import Frame, changed_spans
from kit.render.roles import Palette, Role, RoleStyle

_ANSI_NAMES = ("black", "red", "green", "yellow", "blue", "magenta", "cyan", "white")
_BEGIN = "\x1b[?25l\x1b[2J"
_END = "\x1b[0m\x1b[?25h"


def asciicast_lines(
    frames: Iterable[tuple[float, Frame]], palette: Palette, title: str = ""
) -> Iterator[str]:
    """The lines of the file: a header, then for each frame its time [s] and the characters that have changed.

    ``frames``: times [s] that never fall, and frames of one size. ValueError without a frame.

    >>> from kit.render.roles import ANSI_PALETTE
    >>> header, first, *_ = asciicast_lines([(0.0, Frame.empty(80, 24))], ANSI_PALETTE, "A blank screen")
    >>> json.loads(header)["width"], json.loads(first)[:2]
    (80, [0.0, 'o'])
    """
    before, time_s = None, 0.0
    for time_s, frame in frames:
        text = _changes_text(before, frame, palette)
        if before is None:
            rows, columns = frame.shape
            yield json.dumps({"version": 2, "width": columns, "height": rows, "title": title})
            text = _BEGIN + text
        if text:
            yield json.dumps([round(time_s, 3), "o", text], ensure_ascii=False)
        before = frame
    if before is None:
        raise ValueError("no frames")
    yield json.dumps([round(time_s, 3), "o", _END])


def _changes_text(before: Frame | None, after: Frame, palette: Palette) -> str:
    """Moves the cursor to each span that differs and writes it there."""
    parts = []
    for span in changed_spans(before, after):
        cells = slice(span.row, span.row + 1), slice(span.start, span.stop)
        part = Frame(after.glyphs[cells], after.fg[cells], after.bg[cells])
        parts.append(f"\x1b[{span.row + 1};{span.start + 1}H")
        parts += [
            f"\x1b[{_graphic_codes(palette[Role(run.fg)], palette[Role(run.bg)])}m{run.text}"
            for run in part.runs(0)
        ]
    return "".join(parts)


def _graphic_codes(foreground: RoleStyle, background: RoleStyle) -> str:
    """The parameters of SGR: everything off, then what the two styles say."""
    codes = ["0", *(["1"] if foreground.bold else []), *(["2"] if foreground.dim else [])]
    for style, first in ((foreground, 30), (background, 40)):
        color = style.color
        if isinstance(color, str):
            codes.append(str(first + _ANSI_NAMES.index(color)))
        elif isinstance(color, int):
            codes.append(f"{first + 8};5;{color}")
        elif color is not None:
            codes.append(f"{first + 8};2;{';'.join(map(str, color))}")
    return ";".join(codes)
