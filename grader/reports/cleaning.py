"""Cleans a student's text for reports, so that no reader of a report takes it for a command or markup.

Every report uses ``plain``; each further function removes what one format would interpret.
"""

from __future__ import annotations

import re
import unicodedata
from typing import Final

from grader.look_alikes import INVISIBLE
from kit.plain_text import without_formula

MAX_TEXT: Final = 4000
"""Characters of one text in a report."""
CUT_MARK: Final = " … (shortened)"

_COMMAND: Final = re.compile(r"::|##(?=[A-Za-z]*\[)")
_UNSEEN: Final = re.compile(f"[{INVISIBLE}]")
_MARKUP: Final = re.compile(r"([\\`*_{}\[\]()#+\-.!|~<>&@:$])")


def plain(text: str, limit: int = MAX_TEXT) -> str:
    """Returns lines of characters that are seen: no terminal escapes or other control characters, no marks that change
    the writing direction, no signs without a look, and nothing that a CI runner takes for a command (``::set-output``, ``##[error]``, ``##vso[``)."""
    text_left = "".join(
        c if c == "\n" or c.isprintable() or unicodedata.category(c) == "Zs" else "\N{REPLACEMENT CHARACTER}"
        for c in _UNSEEN.sub("\N{REPLACEMENT CHARACTER}", text[:limit])
    )
    previous = ""
    while text_left != previous:  # what is left of ":::" must not be a command either
        previous, text_left = text_left, _COMMAND.sub(lambda found: " ".join(found.group()), text_left)
    is_cut = max(len(text), len(text_left)) > limit  # the spaces in commands have made it longer
    return text_left[:limit] + CUT_MARK if is_cut else text_left


def clean_line(text: str, limit: int = 300) -> str:
    """Returns ``plain`` on one line."""
    return " ".join(plain(text, limit).split())


def escape_markdown(text: str, limit: int = 300) -> str:
    """Returns one line without Markdown, links, mentions or HTML."""
    return (
        _MARKUP.sub(r"\\\1", clean_line(text, limit))
        .replace("\\<", "&lt;")
        .replace("\\>", "&gt;")
        .replace("\\&", "&amp;")
        .replace("\\@", "&#64;")
    )


def fenced_block(text: str) -> str:
    """Returns a fenced code block that its content cannot close."""
    content = plain(text)
    longest = max((len(run) for run in re.findall(r"`+", content)), default=0)
    fence = "`" * max(3, longest + 1)
    return f"{fence}text\n{content}\n{fence}"


def spreadsheet_cell(text: str, limit: int = 300) -> str:
    """Returns one cell of a table that no spreadsheet takes for a formula."""
    return without_formula(clean_line(text, limit))


def xml_text(text: str) -> str:
    """Returns only characters that XML 1.0 allows; the XML library escapes the rest."""
    return "".join(
        c
        if c == "\n" or 0x20 <= ord(c) <= 0xD7FF or 0xE000 <= ord(c) <= 0xFFFD
        else "\N{REPLACEMENT CHARACTER}"
        for c in plain(text)
    )
