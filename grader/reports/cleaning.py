"""What a student's text must lose before it stands in a report. Text is data here: it gives no orders.

Every report starts from ``plain``; what a format reads as an order on top of that is its own function.
"""

from __future__ import annotations

import re
import unicodedata
from typing import Final

MAX_TEXT: Final = 4000
"""Characters of one text in a report."""
CUT_MARK: Final = " … (shortened)"

_COMMAND: Final = re.compile(r"::|##(?=[A-Za-z]*\[)")
_FORMULA: Final = ("=", "+", "-", "@", "\t", "\r", "|", "%")
_MARKUP: Final = re.compile(r"([\\`*_{}\[\]()#+\-.!|~<>&@:$])")


def plain(text: str, limit: int = MAX_TEXT) -> str:
    """Lines of printable characters: no control characters, so no terminal escapes; no marks that turn the
    direction of writing; nothing that a CI runner takes for a command (``::set-output``, ``##[error]``, ``##vso[``)."""
    cut = text if len(text) <= limit else text[:limit] + CUT_MARK
    kept = "".join(
        c if c == "\n" or c.isprintable() or unicodedata.category(c) == "Zs" else "\N{REPLACEMENT CHARACTER}"
        for c in cut
    )
    previous = ""
    while kept != previous:  # what is left of ":::" must not be a command either
        previous, kept = kept, _COMMAND.sub(lambda found: " ".join(found.group()), kept)
    return kept


def clean_line(text: str, limit: int = 300) -> str:
    """``plain``, on one line."""
    return " ".join(plain(text, limit).split())


def indented_text(text: str, margin: str) -> str:
    """``plain`` with something before every line, so that no line starts with what the student wrote."""
    return "\n".join(margin + line for line in plain(text).split("\n"))


def escape_markdown(text: str, limit: int = 300) -> str:
    """One line in which nothing is markup, a link, a mention or HTML."""
    return (
        _MARKUP.sub(r"\\\1", clean_line(text, limit))
        .replace("\\<", "&lt;")
        .replace("\\>", "&gt;")
        .replace("\\&", "&amp;")
        .replace("\\@", "&#64;")
    )


def fenced_block(text: str) -> str:
    """A block of code that its content cannot leave."""
    content = plain(text)
    longest = max((len(run) for run in re.findall(r"`+", content)), default=0)
    fence = "`" * max(3, longest + 1)
    return f"{fence}text\n{content}\n{fence}"


def spreadsheet_cell(text: str) -> str:
    """One cell of a table that a spreadsheet will not compute."""
    shown = clean_line(text)
    return f"'{shown}" if shown.startswith(_FORMULA) else shown


def xml_text(text: str) -> str:
    """Only characters that XML 1.0 allows; the XML library escapes the rest."""
    return "".join(
        c
        if c == "\n" or 0x20 <= ord(c) <= 0xD7FF or 0xE000 <= ord(c) <= 0xFFFD
        else "\N{REPLACEMENT CHARACTER}"
        for c in plain(text)
    )
