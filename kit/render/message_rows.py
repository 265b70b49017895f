"""A message as rows of characters, field by field, as `ros2 topic echo` prints it."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from typing import Any, Final, NamedTuple

from kit.msg.conversion import to_dict
from kit.msg.message import Message
from kit.plain_text import wrap

INDENT: Final = "  "
MAX_NUMBER_ROWS: Final = 4
_PLAIN: Final = re.compile(r"[^\W\d_][\w ./-]*")

_RESERVED_WORDS: Final = frozenset({"true", "false", "yes", "no", "on", "off", "null", "y", "n"})
"""Words that YAML does not read as text."""


class MessageRow(NamedTuple):
    """One row of a message as text."""

    path: str
    """Of the field, such as ``pose.position.x`` or ``poses[0].x``; empty on a row that is no single value or list."""
    text: str


def message_rows(message: Message, width: int, *, compact: bool = False) -> list[str]:
    """Rows of at most ``width`` characters. ``compact``: what fits on one row stands on one, in braces.

    Long lists of numbers are cut off after a few rows, with their length.
    """
    return [row.text for row in message_field_rows(message, width, compact=compact)]


def message_field_rows(message: Message, width: int, *, compact: bool = False) -> list[MessageRow]:
    """The rows of ``message_rows``, each with the field that it shows."""
    return [
        MessageRow(path, text[:width]) for path, text in _field_rows(to_dict(message), width, "", compact, "")
    ]


def _field_rows(
    data: Mapping[str, Any], width: int, indent: str, compact: bool, prefix: str
) -> Iterator[MessageRow]:
    if not data:
        yield MessageRow("", f"{indent}{{}}")
    for name, value in data.items():
        yield from _rows_of_value(f"{indent}{name}:", value, width, indent, compact, f"{prefix}{name}")


def _rows_of_value(
    head: str, value: Any, width: int, indent: str, compact: bool, path: str
) -> Iterator[MessageRow]:
    if isinstance(value, Mapping):
        line = f"{head} {_inline_yaml(value)}"
        if compact and len(line) <= width:
            yield MessageRow("", line)
        else:
            yield MessageRow("", head)
            yield from _field_rows(value, width, indent + INDENT, compact, f"{path}.")
    elif isinstance(value, list) and value and isinstance(value[0], Mapping):
        yield MessageRow("", head)
        for number, entry in enumerate(value):
            first, *rest = _field_rows(entry, width, indent + INDENT, compact, f"{path}[{number}].")
            yield first._replace(text=f"{indent}- {first.text.lstrip()}")
            yield from rest
    elif isinstance(value, list):
        yield from (MessageRow(path, text) for text in _number_lines(head, value, width, indent))
    else:
        yield MessageRow(path, f"{head} {_scalar_text(value)}")


def _number_lines(head: str, values: list[Any], width: int, indent: str) -> Iterator[str]:
    text = f"{head} {_inline_yaml(values)}"
    blanks = " " * (len(text) - len(text.lstrip()))
    rows = wrap(text, width, blanks, indent + INDENT)
    if len(rows) > MAX_NUMBER_ROWS:
        note = f" ... {len(values)} in all]"
        rows = rows[:MAX_NUMBER_ROWS]
        rows[-1] = rows[-1][: width - len(note)].rpartition(",")[0] + "," + note
    yield from rows


def _inline_yaml(value: Any) -> str:
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{name}: {_inline_yaml(entry)}' for name, entry in value.items())}}}"
    if isinstance(value, list):
        return f"[{', '.join(_inline_yaml(entry) for entry in value)}]"
    return _scalar_text(value)


def _scalar_text(value: Any) -> str:
    """A number or a text as YAML has it; a float in no more than six digits after the point."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return _float_text(value)
    return _quote_if_needed(value) if isinstance(value, str) else str(value)


def _float_text(value: float) -> str:
    if value != value or value in (float("inf"), float("-inf")):
        return ".nan" if value != value else ".inf" if value > 0 else "-.inf"
    short = repr(round(value, 6))
    return short if float(short) or not value else repr(value)


def _quote_if_needed(value: str) -> str:
    """Quotes a text unless it can only be a text."""
    if _PLAIN.fullmatch(value) and value.lower() not in _RESERVED_WORDS:
        return value
    return json.dumps(value, ensure_ascii=False) if value else "''"
