"""A message as text, as ``ros2 topic echo`` writes it: YAML, short enough to be looked at."""

from __future__ import annotations

import json
import re
import textwrap
from collections.abc import Iterator, Mapping
from typing import Any, Final

from kit.msg.conversion import to_dict
from kit.msg.message import Message

INDENT: Final = "  "
MOST_ROWS_OF_NUMBERS: Final = 4

_PLAIN: Final = re.compile(r"[^\W\d_][\w ./-]*")
_NO_TEXTS: Final = frozenset({"true", "false", "yes", "no", "on", "off", "null", "y", "n"})
"""What YAML takes for something else."""


def message_rows(message: Message, width: int, *, compact: bool = False) -> list[str]:
    """Rows of at most ``width`` characters. ``compact``: what fits on one row stands on one, in braces.

    Long lists of numbers are cut off after a few rows, with their length.
    """
    return [row[:width] for row in _fields(to_dict(message), width, "", compact)]


def _fields(data: Mapping[str, Any], width: int, indent: str, compact: bool) -> Iterator[str]:
    if not data:
        yield f"{indent}{{}}"
    for name, value in data.items():
        yield from _entry(f"{indent}{name}:", value, width, indent, compact)


def _entry(head: str, value: Any, width: int, indent: str, compact: bool) -> Iterator[str]:
    if isinstance(value, Mapping):
        line = f"{head} {_flow(value)}"
        if compact and len(line) <= width:
            yield line
        else:
            yield head
            yield from _fields(value, width, indent + INDENT, compact)
    elif isinstance(value, list) and value and isinstance(value[0], Mapping):
        yield head
        for entry in value:
            first, *rest = _fields(entry, width, indent + INDENT, compact)
            yield f"{indent}- {first.lstrip()}"
            yield from rest
    elif isinstance(value, list):
        yield from _numbers(head, value, width, indent)
    else:
        yield f"{head} {_scalar(value)}"


def _numbers(head: str, values: list[Any], width: int, indent: str) -> Iterator[str]:
    text = f"{head} {_flow(values)}"
    rows = textwrap.wrap(text, width, subsequent_indent=indent + INDENT) or [text]
    if len(rows) > MOST_ROWS_OF_NUMBERS:
        note = f" ... {len(values)} in all]"
        rows = rows[:MOST_ROWS_OF_NUMBERS]
        rows[-1] = rows[-1][: width - len(note)].rpartition(",")[0] + "," + note
    yield from rows


def _flow(value: Any) -> str:
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{name}: {_flow(entry)}' for name, entry in value.items())}}}"
    if isinstance(value, list):
        return f"[{', '.join(_flow(entry) for entry in value)}]"
    return _scalar(value)


def _scalar(value: Any) -> str:
    """A number or a text as YAML has it; a float in no more than six digits after the point."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return _float(value)
    return _text(value) if isinstance(value, str) else str(value)


def _float(value: float) -> str:
    if value != value or value in (float("inf"), float("-inf")):
        return ".nan" if value != value else ".inf" if value > 0 else "-.inf"
    short = repr(round(value, 6))
    return short if float(short) or not value else repr(value)


def _text(value: str) -> str:
    """In quotes unless it can be taken for nothing but a text."""
    if _PLAIN.fullmatch(value) and value.lower() not in _NO_TEXTS:
        return value
    return json.dumps(value, ensure_ascii=False) if value else "''"
