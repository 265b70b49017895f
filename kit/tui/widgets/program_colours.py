"""The colours of a program's words: of Python and YAML, from pygments, which Textual brings along."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from itertools import groupby
from types import MappingProxyType
from typing import Final

from pygments.token import Token  # type: ignore[import-untyped]  # no stubs; only its names are used
from textual.content import Span
from textual.highlight import HighlightTheme, TokenType, highlight

from kit.document.rows import PLAIN, Row
from kit.tui.widgets.text_rows import SYNTAX_STYLES

MOST_COLOURED: Final = 20_000
"""Characters of a text that is shown in colours: a longer one is read anew at each key, which would be felt."""
LANGUAGES: Final[Mapping[str, str]] = MappingProxyType({".py": "python", ".yaml": "yaml", ".yml": "yaml"})
"""The language of a file by its ending, as pygments calls it; others are shown without colours."""


class TokenStyleNames(HighlightTheme):
    """Names of ``SYNTAX_STYLES`` by kind of token."""

    STYLES: dict[TokenType, str] = {  # noqa: RUF012 - as Textual declares it
        Token.Comment: "comment",
        Token.Keyword: "keyword",
        Token.Keyword.Constant: "constant",
        Token.Operator.Word: "keyword",
        Token.Literal.String: "string",
        Token.Literal.Number: "number",
        Token.Name.Function: "definition",
        Token.Name.Class: "definition",
        Token.Name.Decorator: "decorator",
        Token.Name.Builtin: "constant",
        Token.Name.Tag: "definition",
    }


def coloured_spans(text: str, language: str | None) -> Sequence[Span]:
    """The parts of a text that have a style, by characters from its beginning; none where the language has no colours."""
    if language is None or len(text) > MOST_COLOURED:
        return ()
    return highlight(text, language=language, theme=TokenStyleNames, tab_size=0).spans


def coloured_rows(lines: Sequence[str], language: str | None) -> list[Row]:
    """The lines of a program, each as a row whose parts have the names of their styles.

    >>> coloured_rows(["import math  # all"], "python")
    [(('import', 'keyword'), (' math  ', ''), ('# all', 'comment'))]
    """
    return list(_coloured(tuple(lines), language))


@lru_cache(maxsize=8)  # a screen shows the same lines again at each key
def _coloured(lines: tuple[str, ...], language: str | None) -> tuple[Row, ...]:
    text = "\n".join(lines)
    styles = [PLAIN] * len(text)
    for first, last, style in coloured_spans(text, language):
        if style in SYNTAX_STYLES:
            styles[first:last] = [str(style)] * (min(last, len(text)) - first)
    rows, start = [], 0
    for line in lines:
        rows.append(_joined(line, styles[start : start + len(line)]))
        start += len(line) + 1
    return tuple(rows)


def _joined(line: str, styles: Sequence[str]) -> Row:
    """Characters beside each other that have one style as one part."""
    return tuple(
        ("".join(char for char, _ in part), style)
        for style, part in groupby(zip(line, styles, strict=True), key=lambda each: each[1])
    )
