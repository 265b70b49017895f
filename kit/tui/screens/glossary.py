"""The glossary: a list of all terms, and beside it the chosen one with what belongs to it."""

from __future__ import annotations

import re
from typing import Any, ClassVar, Final

from textual import events
from textual.app import App, ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal

from kit.dialogue.actions import ScreenActions
from kit.dialogue.dialogue import Panel
from kit.document.layout import Page, rows_of
from kit.document.rows import MARGIN, TEXT_WIDTH, Row, at_both_edges, row
from kit.school.lessons.glossary import GlossaryTerm, glossary_blocks, read_glossary
from kit.school.lessons.reading import lesson_number
from kit.tui.rows.key_rows import FOOTER_ROWS, bindings, footer
from kit.tui.rows.panel_rows import panel_rows
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.picker import NOTHING_FOUND, WAY_ON, PickerItem
from kit.tui.widgets.filter_field import FilteredScreen, FilterField
from kit.tui.widgets.text_rows import RowClicked, TextRows
from kit.world.problems import WorldError

LEAST_MEANING: Final = 60
"""Columns of the chosen term, before the list takes a second column."""
AROUND_TERM: Final = 3
"""Columns of the list before a term and behind it."""


def open_glossary(app: App[Any], term: GlossaryTerm | None = None) -> None:
    """Opens the glossary over any screen, at ``term``; says so where it cannot be read."""
    try:
        app.push_screen(GlossaryScreen(term))
    except (WorldError, FileNotFoundError) as error:
        app.push_screen(MessageDialog("The glossary cannot be read", str(error)))


class GlossaryScreen(FilteredScreen):
    """Draws nothing but what a key has changed. Raises what ``read_glossary`` does when it is made."""

    AUTO_FOCUS = ""
    screen_actions = ScreenActions("glossary", ("choose", "filter", "back"), ("close",))
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = """
    GlossaryScreen { layout: vertical; }
    GlossaryScreen #heading { height: 2; }
    GlossaryScreen #middle { height: 1fr; }
    GlossaryScreen #list { width: auto; }
    GlossaryScreen #meaning { width: 1fr; }
    GlossaryScreen #keys { height: 1; }
    """

    def __init__(self, term: GlossaryTerm | None = None) -> None:
        super().__init__()
        self._terms = read_glossary()
        self._numbers = {each: lesson_number(each) for each in {each.lesson for each in self._terms}}
        self._found = self._terms
        """Those that match what is typed, the nearest first."""
        self._at = 0 if term is None else self._terms.index(term)
        """Which of them is chosen."""
        self._first = 0
        """Which of them begins the page of the list."""

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        with Horizontal(id="middle"):
            yield TextRows(id="list")
            yield TextRows(id="meaning")
        yield TextRows(id="keys")
        yield FilterField()

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._show)

    # What is shown

    @property
    def _room(self) -> int:
        """Rows of the list."""
        return max(1, self.size.height - 2 - FOOTER_ROWS)

    @property
    def _term_width(self) -> int:
        longest = max(len(each.term) for each in self._terms)
        return longest + 1 + max(map(len, self._numbers.values()))

    @property
    def _columns(self) -> int:
        """Columns of the list: as many as there is room for beside a term, or as it takes."""
        fitting = (self.size.width - LEAST_MEANING) // (self._term_width + AROUND_TERM)
        return max(1, min(fitting, -(-len(self._terms) // self._room)))

    def _show(self) -> None:
        width, found, room = self.size.width, self._found, self._room
        self._first = self._at // (room * self._columns) * room * self._columns
        where = f"term {self._at + 1} of {len(found)}" if found else ""
        filtered = (f"  with {self.filter_text!r}", "dim") if self.filter_text else ("", "")
        heading = at_both_edges(row(("Glossary", "title"), filtered), row((where, "dim")), width)
        self._rows("heading").show([heading])
        self._rows("list").show(self._list_rows())
        used = self._columns * (self._term_width + AROUND_TERM)
        self._rows("list").styles.width = used
        meaning = self._meaning_rows(min(width - used - 2 * MARGIN, TEXT_WIDTH))
        self._rows("meaning").show([row(" " * MARGIN, *each) for each in meaning])
        self._rows("keys").show([footer(self.screen_actions, width, keys={"choose": "↑↓ PgUp PgDn"})])

    def _list_rows(self) -> list[Row]:
        """One page of the terms, which goes on at the top of the next column, and then on the next page."""
        last = min(len(self._found), self._first + self._room * self._columns)
        return [
            row(*(part for number in range(first, last, self._room) for part in self._entry(number)))
            for first in range(self._first, min(last, self._first + self._room))
        ]

    def _entry(self, number: int) -> Row:
        term, chosen = self._found[number], number == self._at
        lesson = self._numbers[term.lesson]
        name = f"{term.term:{self._term_width - len(lesson)}}"
        return row(
            ("> " if chosen else "  ", "bold"),
            (name, "chosen" if chosen else ""),
            (lesson, "chosen" if chosen else "dim"),
            " ",
        )

    def _meaning_rows(self, width: int) -> list[Row]:
        """The chosen term, the terms that its meaning uses, and those that its lesson introduces too."""
        if not self._found:
            return [row(NOTHING_FOUND), row(WAY_ON)]
        term = self._found[self._at]
        rows = rows_of(term.blocks(), Page(width))
        used = [each for each in self._terms if each is not term and _is_used(each, term.meaning)]
        beside = [each for each in self._terms if each.lesson == term.lesson and each not in (term, *used)]
        panels = [
            Panel("terms used above", tuple(glossary_blocks(used))),
            Panel(f"lesson {self._numbers[term.lesson]} explains too", tuple(glossary_blocks(beside))),
        ]
        shown = [each for each in panels if each.blocks]
        return [*rows, *panel_rows(shown, width, self._room - len(rows))]

    # Keys and the mouse

    def on_filter(self) -> None:
        chosen = self._found[self._at] if self._found else None
        wanted = self.filter_text.casefold().split()
        items = [(_item(each).rank(wanted), each) for each in self._terms]
        ranked = sorted(((rank, each) for rank, each in items if rank is not None), key=lambda each: each[0])
        self._found = tuple(each for _, each in ranked)
        # With a text the nearest is chosen, and without one it stays.
        self._at = self._found.index(chosen) if not wanted and chosen is not None else 0
        self._show()

    def on_row_clicked(self, event: RowClicked) -> None:
        if event.rows.id == "list":
            column = event.column // (self._term_width + AROUND_TERM)
            self._choose(self._first + column * self._room + event.number)

    def action_choose(self, columns: int, rows: int) -> None:
        self._choose(self._at + rows + columns * self._room)

    def _choose(self, number: int) -> None:
        self._at = max(0, min(number, len(self._found) - 1))
        self._show()

    def action_back(self) -> None:
        """Leaves the innermost open view: field, filter, and at last the screen."""
        if self.leave_field():
            return
        if self.filter_text:
            self.show_all()
        else:
            super().action_back()


def _item(term: GlossaryTerm) -> PickerItem:
    return PickerItem(term.term, term.term, term.meaning, " ".join(term.also).casefold())


def _is_used(term: GlossaryTerm, meaning: str) -> bool:
    """Whether one of the term's spellings, in the plural too, is among the words."""
    names = "|".join(map(re.escape, term.spellings))
    return re.search(rf"\b(?:{names})(?:s|es)?\b", meaning, re.IGNORECASE) is not None
