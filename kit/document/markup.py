"""The little markup of marked texts: paragraphs, lists, ``code``, **bold**, and code blocks indented by four blanks.

Not a library, because the rows must wrap to a terminal's cells in the same way for the screen, the plain mode and
the check that a text fits.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Final

from kit.plain_text import wrap

BLOCK_INDENT: Final = "    "
BULLET: Final = "- "
_INLINE: Final = re.compile(r"`([^`]+)`|\*\*([^*]+)\*\*")


class MarkupError(ValueError):
    """A text is marked up wrongly; the message says where."""


class TextStyle(Enum):
    """The style of a piece of text."""

    PLAIN = "plain"
    CODE = "code"
    BOLD = "bold"


@dataclass(frozen=True, slots=True)
class StyledText:
    """Characters of one style."""

    text: str
    style: TextStyle


@dataclass(frozen=True, slots=True)
class MarkupBlock:
    """A paragraph, a list's entry, or a block of code whose lines stay as they are."""

    kind: str
    """``paragraph``, ``bullet`` or ``code``."""
    lines: tuple[str, ...]


StyledRow = tuple[StyledText, ...]


def parse_markup(text: str) -> tuple[MarkupBlock, ...]:
    """Parses a text into blocks. Raises MarkupError."""
    if text.count("`") % 2 or re.sub(r"`[^`]+`", "", text).count("**") % 2:
        raise MarkupError("a ` or ** is opened and not closed")
    blocks: list[MarkupBlock] = []
    for part in re.split(r"\n\s*\n", text.strip("\n")):
        blocks.extend(_parse_blocks(part.splitlines()))
    return tuple(blocks)


def _parse_blocks(lines: Sequence[str]) -> list[MarkupBlock]:
    if lines and all(line.startswith(BLOCK_INDENT) for line in lines):
        return [MarkupBlock("code", tuple(line.removeprefix(BLOCK_INDENT) for line in lines))]
    blocks: list[MarkupBlock] = []
    for line in lines:
        if line.startswith(BULLET):
            blocks.append(MarkupBlock("bullet", (line.removeprefix(BULLET),)))
        elif blocks:
            last = blocks.pop()
            blocks.append(MarkupBlock(last.kind, (*last.lines, line.strip())))
        else:
            blocks.append(MarkupBlock("paragraph", (line.strip(),)))
    return blocks


def wrap_blocks(blocks: Sequence[MarkupBlock], width: int) -> list[StyledRow]:
    """Wraps the blocks to rows of at most ``width`` characters, with an empty row between blocks but not between list
    entries."""
    rows: list[StyledRow] = []
    before: MarkupBlock | None = None
    for block in blocks:
        if before is not None and not (before.kind == block.kind == "bullet"):
            rows.append(())
        rows.extend(_wrap_block(block, width))
        before = block
    return rows


def plain_text(row: StyledRow) -> str:
    """The characters of a row, without styles."""
    return "".join(piece.text for piece in row)


def _wrap_block(block: MarkupBlock, width: int) -> list[StyledRow]:
    if block.kind == "code":
        spare = width - max(map(len, block.lines), default=0)
        # Less indented rather than that a line is broken for it.
        indent = BLOCK_INDENT[:spare] if spare >= 0 else BLOCK_INDENT
        return [(StyledText(indent + line, TextStyle.CODE),) for line in block.lines]
    first, rest = ("- ", "  ") if block.kind == "bullet" else ("", "")
    return _wrap_styled(styled_pieces(block), width, first, rest)


def styled_pieces(block: MarkupBlock) -> list[StyledText]:
    """The words of a paragraph or an entry, in pieces of one style."""
    return _split_styles(" ".join(block.lines))


def _split_styles(text: str) -> list[StyledText]:
    pieces: list[StyledText] = []
    at = 0
    for match in _INLINE.finditer(text):
        pieces.append(StyledText(text[at : match.start()], TextStyle.PLAIN))
        pieces.append(
            StyledText(match[1], TextStyle.CODE) if match[1] else StyledText(match[2], TextStyle.BOLD)
        )
        at = match.end()
    pieces.append(StyledText(text[at:], TextStyle.PLAIN))
    return [piece for piece in pieces if piece.text]


def _wrap_styled(pieces: Sequence[StyledText], width: int, first: str, rest: str) -> list[StyledRow]:
    """Wraps the characters, then gives them their styles back. Code is wrapped like a word: it moves down whole, and is broken
    at its blanks only where it is longer than a row."""
    longest = width - len(rest)
    held, placed = "", []
    for piece in pieces:
        if piece.style is TextStyle.CODE and len(piece.text) <= longest:
            held += piece.text.replace(" ", "\0")
        else:  # as ``wrap`` leaves it, so that a row is as wide as its line
            text = " ".join(f"|{piece.text}|".split())[1:-1]
            piece = StyledText(text.lstrip() if held.endswith(" ") else text, piece.style)
            held += piece.text
        placed.append(piece)
    rows: list[StyledRow] = []
    at = 0
    for index, line in enumerate(wrap(held, width, first, rest)):
        lead = first if index == 0 else rest
        row = [StyledText(lead, TextStyle.PLAIN)] if lead else []
        end = at
        for number, word in enumerate(line.removeprefix(lead).split()):
            start = held.index(word, end)
            at, end = (at if number else start), start + len(word)
        row += _slice_pieces(placed, at, end)
        at = end
        rows.append(_join_equal_styles(row))
    return rows


def _slice_pieces(pieces: Sequence[StyledText], begin: int, end: int) -> Iterator[StyledText]:
    """The characters ``begin`` to ``end`` of all pieces together."""
    at = 0
    for piece in pieces:
        cut = piece.text[max(0, begin - at) : max(0, end - at)]
        if cut:
            yield StyledText(cut, piece.style)
        at += len(piece.text)


def _join_equal_styles(pieces: Sequence[StyledText]) -> StyledRow:
    joined: list[StyledText] = []
    for piece in pieces:
        if joined and joined[-1].style is piece.style:
            joined[-1] = StyledText(joined[-1].text + piece.text, piece.style)
        else:
            joined.append(piece)
    return tuple(joined)
