"""Draws a case of layers by hand: robots, and who must collide with whom."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import ClassVar, Final

from textual import events
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal
from textual.widgets import Input

from kit.dialogue.actions import ScreenActions
from kit.dialogue.screen_action import ScreenAction, letter
from kit.document.rows import at_both_edges, row
from kit.layers.case_table import CaseTable, RowKind
from kit.layers.drawing.matrix import draw_matrix
from kit.layers.drawing.spans import GlyphStyle, drawn, to_plain_lines
from kit.layers.guided_tour import TourPage as Step
from kit.layers.requirements import LayerCase, LayerCaseError
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.rows.layer_rows import picture, words_width
from kit.tui.screens.dialogs import HelpDialog
from kit.tui.widgets.text_field import KitInput
from kit.tui.widgets.text_rows import RowsScreen, TextRows

KINDS: dict[RowKind, str] = {"map": "map", "body": "body, or part as MODEL.PART", "laser": "laser"}

CASE_SIGNS: Final = (
    ("#", "must collide; in a laser's row, must be seen"),
    ("~", "may share a layer, or be seen: it does not matter"),
    (".", "must not"),
)


class CaseEditor(RowsScreen[LayerCase]):
    """Returns the case as it is when it is left."""

    AUTO_FOCUS = ""
    screen_actions = ScreenActions(
        "case editor",
        (
            "choose", "mark", "add_map", "add_body", "add_laser", "delete", "undo", "one_model", "help",
            "back",
        ),
        own=(
            ScreenAction("mark", "Space Enter", "mark", "change the mark under the cursor", (("space,enter", "mark"),)),
            ScreenAction("add_map", "1", "map", "add a map, then type its name", (("1", "add('map')"),), has_priority=True),
            ScreenAction("add_body", "2", "body", "add a body, or a part of a model as MODEL.PART", (("2", "add('body')"),), has_priority=True),
            ScreenAction("add_laser", "3", "laser", "add a laser, then type its name", (("3", "add('laser')"),), has_priority=True),
            ScreenAction("delete", "d Del", "delete", "delete the row under the cursor", (("d,delete", "delete"),)),
            letter("one_model", "o", "one model", "assume that bodies of one model never collide"),
        ),
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = """
    CaseEditor { layout: vertical; }
    CaseEditor #heading, CaseEditor #remark, CaseEditor #keys { height: 1; }
    CaseEditor #middle { height: 1fr; }
    CaseEditor #picture { width: 1fr; }
    CaseEditor Input, CaseEditor Input:focus { border: none; padding: 0; height: 1; background: transparent; }
    """

    def __init__(self, case: LayerCase, glyphs: GlyphStyle) -> None:
        super().__init__()
        self._editing = CaseTable(case)
        self._glyphs = glyphs
        self._kind: RowKind = "body"
        self._problem = ""
        self._top = 0

    @property
    def editing(self) -> CaseTable:
        """The case, and where the cursor is."""
        return self._editing

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        with Horizontal(id="middle"):
            yield TextRows(id="picture")
            yield TextRows(id="table")
        yield TextRows(id="remark")
        yield TextRows(id="keys")
        yield KitInput(select_on_focus=False)

    def on_mount(self) -> None:
        self.query_one(Input).cursor_blink = False
        self._ask(None)
        self.call_after_refresh(self._show)

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._show)

    def _show(self) -> None:
        editing, case = self._editing, self._editing.case
        rows = max(1, self.size.height - 3)
        table = draw_matrix(case, cursor=(editing.row, editing.column) if editing.cell_names else None)
        head = len(table) - editing.rows
        wide = max([words_width(self.size.width), *(len(line) + 1 for line in to_plain_lines(table))])
        room = self.size.width - wide - 1
        beside = self._rows("picture")
        beside.display = room >= 24
        self._rows("table").styles.width = wide if beside.display else self.size.width
        self._top = min(max(self._top, editing.row - (rows - head) + 1), editing.row)
        self._rows("table").show([*drawn(table[:head]), *drawn(table[head + self._top :])])
        if beside.display:
            laser = editing.laser
            step = Step("case", "", (), laser=None if laser is None else laser.name)
            beside.show(picture(case, step, room, rows, self._glyphs))
        assumed = row(("bodies of one model never meet", "warn")) if editing.ignore_self_collisions else row()
        self._rows("heading").show(
            [at_both_edges(row(("a case by hand", "title")), assumed, self.size.width)]
        )
        self._rows("remark").show([row((self._problem, "bad")) if self._problem else row(editing.cell_text)])
        self._rows("keys").show([footer(self.screen_actions, self.size.width)])

    def _change(self, change: Callable[[CaseTable], CaseTable]) -> None:
        try:
            self._editing, self._problem = change(self._editing), ""
        except LayerCaseError as error:
            self._problem = str(error)
        self._show()

    # Keys

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        # Before all others, so that letters that come with it reach the field; in the field it is a letter itself.
        return action != "add" or (self.is_mounted and self.focused is None)

    def action_choose(self, right: int, down: int) -> None:
        self._change(lambda editing: editing.with_cursor_moved(down, right))

    def action_mark(self) -> None:
        self._change(CaseTable.with_mark_toggled)

    def action_delete(self) -> None:
        self._change(CaseTable.with_row_removed)

    def action_undo(self) -> None:
        self._change(CaseTable.undo)

    def action_one_model(self) -> None:
        self._change(
            lambda editing: replace(editing, ignore_self_collisions=not editing.ignore_self_collisions)
        )

    def action_add(self, kind: RowKind) -> None:
        self._ask(kind)

    def on_input_submitted(self, event: Input.Submitted) -> None:
        kind, name = self._kind, event.value.strip()
        if self.focused is None:
            return  # a second Enter that came with the first
        if name:
            self._change(lambda editing: editing.with_row_added(kind, name))
        if not self._problem:
            self._ask(None)

    def _ask(self, kind: RowKind | None) -> None:
        """Shows the field for a name in place of the keys, or the keys. It awaits nothing: the next letters may have arrived."""
        field = self.query_one(Input)
        field.display, self._rows("keys").display = kind is not None, kind is None
        field.value = ""
        if kind is not None:
            self._kind = kind
            field.placeholder = f"name of the {KINDS[kind]}; Enter adds it, Esc goes back"
        self.set_focus(field if kind is not None else None)

    def action_help(self) -> None:
        self.app.push_screen(HelpDialog("A case by hand", self.screen_actions, CASE_SIGNS))

    def action_back(self) -> None:
        """Leaves the field if one is open, else the table."""
        if self.focused is not None:
            self._problem = ""
            self._ask(None)
            self._show()
        else:
            self.dismiss(self._editing.case)
