"""The layers screen: through a case with the arrows, another one, one typed by hand, one saved."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest
from textual.app import App
from textual.pilot import Pilot

from kit.layers.case_sources import open_task
from kit.layers.requirements import ContactRequirement, SightRequirement
from kit.layers.requirements_file import read_requirements
from kit.tui.screens.layer_case_editor import CaseEditor
from kit.tui.screens.layers import LayersScreen
from kit.tui.terminal import TerminalFacts, TerminalOptions, decide_terminal
from kit.tui.theme import Theme
from tests.tui.lesson_stage import rows, text

Scene = Callable[[LayersScreen, Pilot[None]], Awaitable[None]]


def play(
    scene: Scene, name: str = "slides-lasers", *, folder: Path = Path("/nowhere"), size: tuple[int, int] = (80, 24),
    glyphs: str = "braille",
) -> None:  # fmt: skip
    terminal = decide_terminal(
        {"TERM": "xterm-256color"}, TerminalFacts(), TerminalOptions(False, glyphs, None)
    )  # type: ignore[arg-type]  # a word of its list

    async def run() -> None:
        app: App[None] = App()
        async with app.run_test(size=size) as pilot:
            screen = LayersScreen(Theme.of(terminal), open_task(name), name, saved_to=folder)
            await app.push_screen(screen)
            await solved(screen)
            await pilot.pause()
            await scene(screen, pilot)

    asyncio.run(run())


async def solved(screen: LayersScreen) -> None:
    async with asyncio.timeout(20):
        while not screen.is_solved:
            await asyncio.sleep(0.02)


def words(screen: LayersScreen) -> str:
    """The words beside the picture, as one line."""
    return " ".join(" ".join(row[45:] for row in rows(screen)[1:-2]).split())


@pytest.mark.long
def test_the_slides_method_step_by_step() -> None:
    async def scene(screen: LayersScreen, pilot: Pilot[None]) -> None:
        assert "What is asked" in rows(screen)[0]
        await pilot.press("2")
        assert "layer 1 of 6" in rows(screen)[0]
        assert "Of 12 edges left, take Map1 - M4.B1." in words(screen)
        assert all(f"[{name}]" in text(screen) for name in ("Map1", "M4.B1", "M4.B2"))
        await pilot.press("right", "right", "right", "right", "right")
        assert "layer 6 of 6" in rows(screen)[0]
        assert "no edge left." in words(screen)
        await pilot.press("right")
        assert "<Ls1>" in text(screen)
        await pilot.press("left")
        assert "layer 6 of 6" in rows(screen)[0]

    play(scene)


@pytest.mark.long
def test_the_optimum_and_its_certificate_beside_the_picture() -> None:
    async def scene(screen: LayersScreen, pilot: Pilot[None]) -> None:
        await pilot.press("3")
        assert "10 layers, and no plan has fewer." in words(screen)
        await pilot.press("4")
        assert "No two of these 10 fit one layer, so they need 10 layers:" in words(screen)
        assert "Map1 and M4.B2 collide" in words(screen)
        await pilot.press("right", "right")
        assert rows(screen)[0].endswith("23 of 23")

    play(scene)


@pytest.mark.long
def test_words_that_are_too_many_are_scrolled() -> None:
    async def scene(screen: LayersScreen, pilot: Pilot[None]) -> None:
        assert "more lines below" in text(screen)
        first = words(screen)
        await pilot.press("down")
        assert words(screen) != first
        await pilot.press("pagedown", "pagedown", "pagedown")
        assert "more lines below" not in text(screen)
        await pilot.press("pageup", "pageup", "pageup", "pageup")
        assert words(screen) == first

    play(scene, size=(80, 16))


@pytest.mark.long
def test_a_step_can_begin_with_another_edge() -> None:
    async def scene(screen: LayersScreen, pilot: Pilot[None]) -> None:
        await pilot.press("o")
        assert "the method chooses an edge where" in text(screen)
        await pilot.press("2", "o")
        await pilot.pause()
        await pilot.press("down", "enter")
        await pilot.pause()
        assert "take a - c." in words(screen)
        assert "ends with" in text(screen)

    play(scene, "greedy-trap")


@pytest.mark.long
def test_another_case_from_the_list() -> None:
    async def scene(screen: LayersScreen, pilot: Pilot[None]) -> None:
        await pilot.press("m")
        await pilot.pause()
        await pilot.press(*"three", "enter")
        await solved(screen)
        await pilot.pause()
        assert rows(screen)[0].startswith("three  1.")
        await pilot.press("3")
        assert "1 layer, and no plan has fewer." in words(screen)

    play(scene)


def test_a_world_of_the_kit_is_a_case_too() -> None:
    async def scene(screen: LayersScreen, pilot: Pilot[None]) -> None:
        await pilot.press("3")
        assert "no plan has fewer" in words(screen)

    play(scene, "maze")


@pytest.mark.long
def test_a_case_typed_by_hand_is_planned() -> None:
    async def scene(screen: LayersScreen, pilot: Pilot[None]) -> None:
        await pilot.press("e")
        await pilot.pause()
        editor = screen.app.screen
        assert isinstance(editor, CaseEditor)
        await pilot.press("d", "d")
        assert "nothing to plan yet" in text(screen)
        await pilot.press("1", *"walls", "enter", "2", *"robot", "enter", "space")
        assert "walls and robot must collide" in rows(screen)[-2]
        await pilot.press("right", "space")
        assert "there is only one robot" in rows(screen)[-2]
        await pilot.press("3", *"eye", "enter", "left", "space")
        assert "eye must see walls" in rows(screen)[-2]
        assert "<eye>" in text(screen)
        assert set(editor.editing.case.requirements) == {
            ContactRequirement("walls", "robot"),
            SightRequirement("eye", "walls"),
        }
        await pilot.press("2", *"a", "space", "escape")
        assert "walls" in text(screen)
        await pilot.press("escape")
        await solved(screen)
        await pilot.pause()
        assert rows(screen)[0].startswith("mine  1.")
        await pilot.press("3")
        assert "2 layers, and no plan has fewer." in words(screen)

    play(scene, "two")


@pytest.mark.long
def test_letters_of_names_are_not_taken_for_keys() -> None:
    async def scene(screen: LayersScreen, pilot: Pilot[None]) -> None:
        await pilot.press("e")
        await pilot.pause()
        await pilot.press("2", *"a123dufq", "enter")
        editor = screen.app.screen
        assert isinstance(editor, CaseEditor)
        assert editor.editing.case.names[-1] == "a123dufq"
        await pilot.press("u")
        assert "a123dufq" not in editor.editing.case.names

    play(scene, "two")


@pytest.mark.long
def test_what_cannot_be_is_said_and_the_field_stays() -> None:
    async def scene(screen: LayersScreen, pilot: Pilot[None]) -> None:
        await pilot.press("e")
        await pilot.pause()
        await pilot.press("1", *"robot", "enter")
        assert "named twice" in rows(screen)[-2]
        await pilot.press("2", "enter")
        assert "#robot2#" in text(screen)

    play(scene, "two")


@pytest.mark.long
def test_a_case_is_saved_and_no_file_is_overwritten(tmp_path: Path) -> None:
    async def scene(screen: LayersScreen, pilot: Pilot[None]) -> None:
        for expected in ("written:", "already exists"):
            await pilot.press("ctrl+s", *"test", "enter")
            assert expected in text(screen)
        await pilot.press("ctrl+s", *"../up", "enter")

    play(scene, folder=tmp_path / "worlds")
    saved = tmp_path / "worlds" / "test.layers.yaml"
    assert len(read_requirements(saved).case.requirements) == 22
    assert sorted(file.name for file in tmp_path.rglob("*.yaml")) == ["test.layers.yaml", "up.layers.yaml"]
    assert not list(tmp_path.glob("*.yaml"))


@pytest.mark.long
@pytest.mark.parametrize("size", [(200, 50), (60, 18), (40, 10), (20, 4)])
def test_any_size_will_do(size: tuple[int, int]) -> None:
    async def scene(screen: LayersScreen, pilot: Pilot[None]) -> None:
        for key in ("2", "3", "4", "e", "escape"):
            await pilot.press(key)
            assert len(rows(screen)) == size[1]

    play(scene, size=size)


@pytest.mark.long
@pytest.mark.long
def test_a_large_screen_keeps_what_is_asked_in_sight_in_its_place() -> None:
    async def scene(screen: LayersScreen, pilot: Pilot[None]) -> None:
        places = set()
        for part in ("2", "3"):
            await pilot.press(part)
            await pilot.pause()
            shown = rows(screen)
            places |= {number for number, line in enumerate(shown) if "── what is asked" in line}
            assert any("M4.B1 and M2 collide" in line for line in shown)
        assert len(places) == 1

    play(scene, size=(200, 50))


def test_in_plain_characters() -> None:
    async def scene(screen: LayersScreen, pilot: Pilot[None]) -> None:
        for key in ("1", "2", "right", "3", "4", "e"):
            await pilot.press(key)
            assert text(screen).isascii()

    play(scene, glyphs="ascii")
