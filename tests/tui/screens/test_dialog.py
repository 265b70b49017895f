"""What is seen behind a dialog: the screen below, fainter than the box, in every depth of colour."""

from __future__ import annotations

import asyncio

import pytest
from rich.style import Style
from textual.screen import Screen

from kit.document.rows import row
from kit.tui.app import KitApp
from kit.tui.screens.dialogs import MessageDialog, NameDialog
from kit.tui.screens.picker import Picker, PickerItem
from kit.tui.screens.text_screen import TextScreen
from kit.tui.terminal import TerminalFacts, TerminalOptions, decide_terminal
from kit.tui.textual_patches import FITTING_S
from tests.render.test_roles import contrast

BELOW, ABOVE = "what lies behind", "what is asked"
DIALOGS = {
    "message": lambda: MessageDialog("Title", [row(ABOVE)]),
    "name": lambda: NameDialog("Title", ABOVE),
    "list": lambda: Picker("Title", [PickerItem("a", ABOVE)]),
}


def shown_cells(app: KitApp) -> list[list[tuple[str, Style]]]:
    """Each row of the terminal, character by character."""
    update = app.screen._compositor.render_update(full=True, screen_stack=app._background_screens)
    return [
        [
            (char, segment.style or Style.null())
            for strip in line
            for segment in strip
            for char in segment.text
        ]
        for line in update.strips
    ]


def style_of(cells: list[list[tuple[str, Style]]], words: str) -> Style:
    """The look of words that are on the screen."""
    for line in cells:
        text = "".join(char for char, _ in line)
        if words in text:
            return line[text.index(words)][1]
    raise AssertionError(f"{words!r} is not on the screen")


@pytest.mark.parametrize("color", ["none", "16", "256", "true"])
@pytest.mark.parametrize("name", DIALOGS)
def test_a_dialog_dims_what_lies_behind_instead_of_wiping_it(name: str, color: str) -> None:
    terminal = decide_terminal({"TERM": "xterm-256color"}, TerminalFacts(), TerminalOptions(color=color))
    app = KitApp(terminal)
    below: Screen[None] = TextScreen("Heading", [row((BELOW, "bold"))])

    async def run() -> tuple[Style, Style, Style]:
        async with app.run_test(size=(100, 40)) as pilot:
            app.push_screen(below)
            await pilot.pause()
            before = style_of(shown_cells(app), BELOW)
            app.push_screen(DIALOGS[name]())
            await pilot.pause()
            cells = shown_cells(app)
            return before, style_of(cells, BELOW), style_of(cells, ABOVE)

    before, behind, asked = asyncio.run(asyncio.wait_for(run(), 30))
    if terminal.ansi:
        assert (before.dim or False, before.bold) == (False, True)
        assert (behind.dim, behind.bold) == (True, False)
        assert not asked.dim
    else:
        papers = [each.bgcolor.get_truecolor() for each in (before, behind, asked) if each.bgcolor]
        inks = [each.color.get_truecolor() for each in (before, behind, asked) if each.color]
        clear, faint, box = (contrast(ink, paper) for ink, paper in zip(inks, papers, strict=True))
        assert 1.2 < faint < 0.6 * min(clear, box)


def test_what_lies_behind_a_dialog_is_fitted_to_a_terminal_that_is_resized() -> None:
    terminal = decide_terminal({"TERM": "xterm-256color"}, TerminalFacts(), TerminalOptions(color="16"))
    app = KitApp(terminal)
    below: Screen[None] = TextScreen("Heading", [row(f"line {number}") for number in range(60)])

    def text() -> list[str]:
        return ["".join(char for char, _ in line).rstrip() for line in shown_cells(app)]

    async def run() -> None:
        async with app.run_test(size=(100, 40)) as pilot:
            app.push_screen(below)
            await pilot.pause(2.0 * FITTING_S)
            app.push_screen(MessageDialog("Title", [row(ABOVE)]))
            await pilot.pause()
            for columns, rows in ((50, 12), (120, 35)):
                assert not below.is_current
                await pilot.resize_terminal(columns, rows)
                assert below.is_current  # it is painted once
                for _ in range(100):
                    await pilot.pause(0.05)
                    if text()[0].endswith(f"lines 1 to {rows - 3} of 60"):
                        break
                assert len(text()[0]) == columns
                assert text()[rows - 3].startswith(f"line {rows - 4}")
                assert not text()[rows - 2], "an empty row above the keys"
                assert any(ABOVE in line for line in text())
                for _ in range(100):
                    await pilot.pause(0.05)
                    if not below.is_current:
                        break

    asyncio.run(asyncio.wait_for(run(), 60))


def test_a_long_row_of_a_dialog_goes_on_below_in_a_narrow_terminal() -> None:
    terminal = decide_terminal({"TERM": "xterm-256color"}, TerminalFacts(), TerminalOptions(color="16"))
    app = KitApp(terminal)
    words = [f"word{number}" for number in range(12)]

    async def run() -> None:
        async with app.run_test(size=(40, 12)) as pilot:
            app.push_screen(MessageDialog("Title", [row(" ".join(words)[:70])]))
            await pilot.pause()
            page = "".join(line.strip(" │") for line in map(row_of, shown_cells(app)))
            assert "".join(words)[:50] in page.replace(" ", "")

    asyncio.run(asyncio.wait_for(run(), 60))


def row_of(cells: list[tuple[str, Style]]) -> str:
    return "".join(char for char, _ in cells)
