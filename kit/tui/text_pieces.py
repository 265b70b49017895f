"""Pieces of text with their styles, as the shortest sequence of characters that shows them on a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import Final, NamedTuple

from rich.color import ColorSystem
from rich.segment import Segment
from rich.style import Style

NULL_STYLE: Final = Style.null()
_ATTRIBUTES: Final = {
    "1": "bold", "2": "dim", "3": "italic", "4": "underline", "5": "blink", "7": "reverse", "9": "strike",
}  # fmt: skip
_SEEN_ON_BLANKS: Final = frozenset("479")
_WEIGHTS: Final = frozenset("12")
"""Attributes that one short code takes away, leaving the colours."""
_NORMAL_WEIGHT: Final = "22"
_UNSURE_WIDTHS: Final = "\u2900"
"""From here on, behind letters, boxes and braille, terminals do not agree how wide a character is."""


class _StyleCodes(NamedTuple):
    """SGR codes of a style."""

    background: str
    attributes: tuple[str, ...]
    """Bold, dim and so on."""
    foreground: str | None
    """None: there is nothing to see of it, nor of the attributes."""


_DEFAULT_CODES: Final = _StyleCodes("49", (), "39")


@lru_cache(maxsize=4096)
def style_codes(style: Style, system: ColorSystem, is_blank: bool) -> _StyleCodes:
    attributes = tuple(
        code for code, name in _ATTRIBUTES.items() if getattr(style, name)
    )  # rich keeps the colours' codes apart from these
    foreground, background = (
        ";".join(color.downgrade(system).get_ansi_codes(foreground=is_foreground)) if color else default
        for color, is_foreground, default in ((style.color, True, "39"), (style.bgcolor, False, "49"))
    )
    if is_blank and _SEEN_ON_BLANKS.isdisjoint(attributes):
        return _StyleCodes(background, (), None)
    return _StyleCodes(background, attributes, foreground)


class TextPiece(NamedTuple):
    """Text of one style in a row."""

    y: int
    x: int
    width: int
    """Width of the text, in cells."""
    text: str
    codes: _StyleCodes


def piece_of_segment(y: int, x: int, segment: Segment, system: ColorSystem) -> TextPiece:
    text, style, _ = segment
    if style is None:
        style = Style.null()
    if style.link:
        return TextPiece(y, x, segment.cell_length, style.render(text, color_system=system), _DEFAULT_CODES)
    codes = style_codes(style, system, is_blank=not text.strip(" "))
    return TextPiece(y, x, segment.cell_length, text, codes)


def joined_pieces(one: TextPiece, other: TextPiece) -> TextPiece | None:
    """One piece of two, if the other goes on where the one ends and a style does for both."""
    if (one.y, one.x + one.width) != (other.y, other.x) or one.codes.background != other.codes.background:
        return None
    codes = other.codes if one.codes.foreground is None else one.codes
    if one.codes != other.codes:
        if None not in (one.codes.foreground, other.codes.foreground):
            return None
        if not _SEEN_ON_BLANKS.isdisjoint(codes.attributes):
            return None
    return TextPiece(one.y, one.x, one.width + other.width, one.text + other.text, codes)


def _by_style(piece: TextPiece) -> tuple[object, ...]:
    background, attributes, foreground = piece.codes
    return background, foreground or "", attributes, piece.y, piece.x


def shortest_text(pieces: Sequence[TextPiece], screen_width: int) -> str:
    """The pieces from the top down, or style by style where that is shorter, since to name a style in true colours costs
    more bytes than to move the cursor."""
    in_order = _escape_codes(pieces, screen_width)
    if len({piece.codes for piece in pieces}) == len(pieces):
        return in_order
    return min(in_order, _escape_codes(sorted(pieces, key=_by_style), screen_width), key=len)


def _escape_codes(pieces: Iterable[TextPiece], screen_width: int) -> str:
    """The pieces in this order, each at its place. Of a style only what differs from the one before is sent."""
    sequences: list[str] = []
    held = _DEFAULT_CODES
    cursor: tuple[int, int] | None = None
    for y, x, width, text, codes in pieces:
        if cursor != (y, x):
            sequences.append(_move(cursor, y, x))
        if codes != held:
            changes, held = _style_change(held, codes)
            sequences.append(changes)
        sequences.append(text)
        is_known = x + width < screen_width and text and max(text) < _UNSURE_WIDTHS
        cursor = (y, x + width) if is_known else None
    if held != _DEFAULT_CODES:
        sequences.append("\x1b[0m")
    return "".join(sequences)


def _move(cursor: tuple[int, int] | None, y: int, x: int) -> str:
    """The shortest way from the cursor's row and column, None if not known, to row ``y`` and column ``x``."""
    absolute = f"\x1b[{y + 1};{x + 1}H"
    down = y - cursor[0] if cursor else -1
    if cursor is None or down not in (0, 1):
        return absolute
    right = x - cursor[1]
    relative = "\x1b[B" if down else ""
    if right > 0:
        relative += f"\x1b[{right}C" if right > 1 else "\x1b[C"
    elif right < 0:
        relative += "\b" * -right if right >= -4 else f"\x1b[{-right}D"
    return relative if len(relative) < len(absolute) else absolute


@lru_cache(maxsize=4096)
def _style_change(held: _StyleCodes, wanted: _StyleCodes) -> tuple[str, _StyleCodes]:
    """Returns the sequence that changes a terminal's style from the held one to the wanted one, and the style it then has."""
    if wanted.foreground is None:
        if _SEEN_ON_BLANKS.isdisjoint(held.attributes):
            wanted = held._replace(background=wanted.background)
        else:
            wanted = _DEFAULT_CODES._replace(background=wanted.background)
    now, changes = held, []
    dropped = set(held.attributes) - set(wanted.attributes)
    if wanted == _DEFAULT_CODES or not dropped <= _WEIGHTS:
        now, changes = _DEFAULT_CODES, ["0"]
    elif dropped:
        now = held._replace(attributes=tuple(code for code in held.attributes if code not in _WEIGHTS))
        changes = [_NORMAL_WEIGHT]
    changes += [code for code in wanted.attributes if code not in now.attributes]
    changes += [wanted.foreground] if wanted.foreground and wanted.foreground != now.foreground else []
    changes += [wanted.background] if wanted.background != now.background else []
    return (f"\x1b[{';'.join(changes)}m" if changes else ""), wanted
