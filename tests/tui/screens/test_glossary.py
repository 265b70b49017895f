"""The glossary's screen: every term is reached page by page, found by what is typed, and told beside the list."""

from __future__ import annotations

from pathlib import Path

import pytest
from textual.pilot import Pilot

from kit.school.lessons.glossary import read_glossary
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.glossary import GlossaryScreen, open_glossary
from kit.tui.screens.text_screen import TextScreen
from tests.tui.lesson_stage import rows, seen, stage, text, until

TERMS = read_glossary()


@pytest.mark.parametrize("size", [(80, 24), (120, 35), (200, 50)])
def test_its_list_goes_on_in_the_next_column_and_on_the_next_page(size: tuple[int, int]) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        names = [each.term for each in TERMS]
        listed = 0
        while listed < len(names):
            await seen(pilot, f"term {listed + 1} of")
            assert "PgDn" in rows(pilot)[-1]
            page, first = rows(pilot)[2:-2], listed
            assert page[0].startswith(f"> {names[first]}"), "the page begins with the chosen one"
            column, line = 2, 0
            for name in names[first:]:
                if line == len(page):
                    column, line = page[0].find(f" {name} ", column) + 1, 0
                if not column or not page[line][column:].startswith(name):
                    break
                listed, line = listed + 1, line + 1
            await pilot.press(*["down"] * (listed - first))
        assert f"term {len(names)} of" in rows(pilot)[0]

    stage(lambda theme: GlossaryScreen(), scene, size=size)


def test_a_term_is_told_beside_the_list_with_the_terms_that_it_uses() -> None:
    term = next(each for each in TERMS if each.term == "action")

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, term.meaning)
        used = text(pilot).partition("terms used above")[2].partition("explains too")[0]
        assert "agent  (lesson" in used
        assert "step  (lesson" in used

    stage(lambda theme: GlossaryScreen(term), scene, size=(200, 50))


def test_it_is_filtered_by_names_first_and_keeps_the_term_when_all_are_shown_again() -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "term 1 of")
        await pilot.press("slash", *"qos")
        await seen(pilot, "term 1 of 1")
        await seen(pilot, "quality of service or QoS")
        await pilot.press("enter", "escape")
        number = next(at for at, each in enumerate(TERMS, 1) if each.term == "quality of service")
        await seen(pilot, f"term {number} of {len(TERMS)}")
        await pilot.press("slash", *"policy")
        await until(pilot, lambda: rows(pilot)[2].startswith("> policy"), "the name before the meanings")
        await pilot.press(*"zzz")
        await seen(pilot, "Nothing here has these words.")
        await pilot.press("escape")
        await seen(pilot, f"of {len(TERMS)}")

    stage(lambda theme: GlossaryScreen(), scene)


def test_one_that_cannot_be_read_says_so_and_closes_nothing(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr("kit.school.lessons.glossary.lessons_folder", lambda: tmp_path)

    async def scene(pilot: Pilot[None]) -> None:
        open_glossary(pilot.app)
        await until(pilot, lambda: isinstance(pilot.app.screen, MessageDialog), "the message")
        await seen(pilot, "glossary.yaml")

    stage(lambda theme: TextScreen("Below", []), scene)
