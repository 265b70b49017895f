"""Python files that read otherwise in Python than in an editor."""

from __future__ import annotations

import codecs
import io
import tokenize
from typing import Final

from grader.shown_names import shown_name

READ_AS_SHOWN: Final = ("utf-8", "ascii", "iso8859-1", "iso8859-15", "cp1250", "cp1251", "cp1252")
"""Encodings in which a line of a program reads in Python as an editor shows it. In others a comment can hold a program."""
_DIRECTIONS: Final = frozenset("\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")
"""Marks that change the writing direction: what they enclose reads in another order than Python reads it."""


def hidden_code(name: str, content: bytes) -> str:
    """Returns how a Python file reads otherwise in Python than in an editor, and what to do; else an empty text.

    Who reviews a work must see what runs. Trojan Source: https://trojansource.codes, CVE-2021-42574.
    """
    shown = shown_name(name)[1:-1]
    try:
        encoding = codecs.lookup(tokenize.detect_encoding(io.BytesIO(content).readline)[0]).name
        text = content.decode(encoding)
    except (SyntaxError, LookupError, UnicodeError):
        return ""  # Python says what is wrong with it
    if encoding.removesuffix("-sig") not in READ_AS_SHOWN:
        return f"{shown} is written in the encoding {encoding}, which no editor shows as it runs: save it as UTF-8."
    for number, line in enumerate(text.replace("\r\n", "\n").split("\n"), 1):
        if not _DIRECTIONS.isdisjoint(line):
            return f"{shown}, line {number}: marks that change the writing direction hide what runs; remove them."
        if "\r" in line.rstrip("\r") and "\n" in text:
            return f"{shown}, line {number}: it ends in the middle for Python alone; save it with ordinary line ends."
    return ""
