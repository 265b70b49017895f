"""A screen's bindings, the line of keys at its bottom and its help page, made from the record of its actions."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from types import MappingProxyType
from typing import Final

from textual.binding import Binding, BindingType

from kit.dialogue.actions import ScreenActions
from kit.document.blocks import Tone, ToneText, labelled_table
from kit.document.layout import Page, rows_of
from kit.document.rows import Row, row

FOOTER_ROWS: Final = 2
"""Rows of a line of keys below a text: an empty one sets it apart."""
HELP_WIDTH: Final = 69
"""Columns of a help page."""
NOTHING: Final = ToneText("", Tone.PLAIN)
"""In the place of a key in the row between two blocks of a help page."""
KEPT: Final = frozenset(("help", "back", "quit", "palette"))
"""Actions that a narrow line of keys leaves out last."""
MORE: Final = "more"
"""What the key of all commands is called where keys that work are left out; no longer than its usual word."""
_NO_LABELS: Final[Mapping[str, str]] = MappingProxyType({})


def bindings(screen: ScreenActions) -> list[BindingType]:
    """All bindings of a screen."""
    return [
        Binding(keys, call, show=False, priority=action.has_priority)
        for action in screen.records
        for keys, call in action.bindings
    ]


def footer(
    screen: ScreenActions,
    width: int,
    *,
    without: Collection[str] = (),
    labels: Mapping[str, str] = _NO_LABELS,
    keys: Mapping[str, str] = _NO_LABELS,
) -> Row:
    """One row of at most ``width`` columns, which ends in the key of all commands where there is one; that key says so where
    others are left out. ``without``: ids of actions that do nothing now. ``labels``, ``keys``: other words and keys than the
    actions', by id."""
    parts = {
        each: (keys.get(each, screen[each].footer_keys), labels.get(each, screen[each].label))
        for each in (*screen.footer, *(each for each in screen.off_footer if each == "palette"))
        if each not in without
    }
    while sum(len(key) + len(label) + 2 for key, label in parts.values()) - 1 > width:
        dropped = next((each for each in reversed(parts) if each not in KEPT), None)
        if dropped is None:
            break
        del parts[dropped]
        if "palette" in parts:
            parts["palette"] = (parts["palette"][0], MORE)
    return key_row(*parts.values())


def key_row(*keys: tuple[str, str]) -> Row:
    """Keys and their words in one row."""
    return row(*(part for key, label in keys for part in ((key, "press"), f" {label} ")))


def help_page(
    screen: ScreenActions, *notes: Sequence[tuple[str, str]], without: Collection[str] = ()
) -> tuple[Row, ...]:
    """All keys of a screen, and below them blocks of ``notes``: signs or terms, and what they mean."""
    blocks = [
        [(screen[each].keys, screen[each].help) for each in ids if each not in without and each != "help"]
        for ids in (screen.footer, screen.off_footer)
    ]
    told: list[tuple[ToneText, str]] = []
    for block in (*blocks, *notes):
        told += [(NOTHING, "")] if block else []
        told += [(ToneText(key, Tone.TITLE), text) for key, text in block]
    return tuple(rows_of([labelled_table(told)], Page(HELP_WIDTH, margin=1)))
