"""Drawing a map with cursor and mouse, without a terminal: what is on the sheet is what is written."""

from __future__ import annotations

from pathlib import Path

import pytest
from textual.pilot import Pilot

from kit.mapmaking.map_drawing import read_drawing
from kit.mapmaking.map_sketch import MapSketch
from kit.mapmaking.new_map import NewMap, write_map
from kit.tui.screens import map_drawing
from kit.tui.screens.map_drawing import MapDrawingScreen, SketchView
from kit.tui.theme import Theme
from kit.world.catalogue import WORLD_FILE, own_card
from tests.tui.lesson_stage import rows, seen, stage, text, until


class Desk:
    """Makes the screen, and keeps what was saved."""

    def __init__(self, folder: Path, sketch: MapSketch) -> None:
        self.folder = folder
        self.sketch = sketch
        self.made: list[NewMap] = []

    def save(self, sketch: MapSketch) -> NewMap:
        plan = read_drawing(sketch.text, cell=sketch.cell)
        self.made.append(write_map(self.folder, plan, title="Mine", source="drawn"))
        return self.made[-1]

    def open(self, theme: Theme) -> MapDrawingScreen:
        return MapDrawingScreen(theme, "mine", self.sketch, self.save)


def drawing(pilot: Pilot[None]) -> MapDrawingScreen:
    screen = pilot.app.screen
    assert isinstance(screen, MapDrawingScreen)
    return screen


@pytest.fixture
def desk(tmp_path: Path) -> Desk:
    return Desk(tmp_path / "mine", MapSketch.room(10, 6))


@pytest.mark.long
def test_a_map_is_drawn_with_the_keys_and_written(desk: Desk) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "New map mine")
        await pilot.press("3", "space", "1", "right", "right", "right")
        await pilot.press("space", "shift+down", "shift+down", "shift+down")
        await pilot.press("up", "3", "space")
        await seen(pilot, "there is a wall here")
        await pilot.press("4", "end", "left", "space", "ctrl+s")  # the target is behind the wall
        await seen(pilot, "Not saved")
        await seen(pilot, "There is no path")
        await pilot.press("escape", "u", "1", "home", "right", "right", "right", "right", "2", "space")
        assert drawing(pilot).sketch.rows[3][4] == " "
        await pilot.press("4", "end", "left", "space", "right_square_bracket", "ctrl+s")
        await until(pilot, lambda: desk.made, "the map")

    stage(desk.open, scene)
    card = own_card(desk.made[0].folder / WORLD_FILE)
    assert card is not None
    cell = 0.6
    assert card.cases[0].start[:2] == pytest.approx((1.5 * cell, 4.5 * cell))
    assert card.cases[0].target == pytest.approx((8.5 * cell, 2.5 * cell))


@pytest.mark.parametrize("ascii_only", [False, True])
def test_the_way_is_shown_while_one_draws_and_why_there_is_none(desk: Desk, ascii_only: bool) -> None:
    dot = "+" if ascii_only else "•"

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "m from start to target")
        way = [line for line in rows(pilot) if dot in line]
        assert way
        assert not any(dot in line for line in drawing(pilot).sketch.rows), "nothing of it is drawn"
        await pilot.press("3", "space", "4", "end", "left", "space")
        await until(
            pilot, lambda: dot in text(pilot) and "chosen" not in text(pilot), "the way between those set"
        )
        await pilot.press("1", "home", "right", "right", "right", "right", "up", *["shift+down"] * 5)
        await seen(pilot, "There is no path")
        assert dot not in text(pilot)
        await pilot.press("u")
        await seen(pilot, "m from start to target")

    stage(desk.open, scene, size=(120, 35), ascii_only=ascii_only)


def test_a_sheet_too_large_for_a_quick_look_says_that_saving_looks(tmp_path: Path) -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "Saving looks for one")

    stage(Desk(tmp_path / "mine", MapSketch.room(200, 200)).open, scene, size=(120, 35))


@pytest.mark.long
@pytest.mark.parametrize("ascii_only", [False, True])
@pytest.mark.parametrize(("size", "side"), [((80, 24), 2), ((80, 12), 1), ((120, 35), 4)])
def test_the_mouse_draws_and_clears_in_squares_that_use_the_room(
    desk: Desk, size: tuple[int, int], side: int, ascii_only: bool
) -> None:
    def at(column: int, line: int) -> tuple[int, int]:
        return 2 * side * column + side, side * line + side - 1

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "New map mine")
        await pilot.mouse_down(SketchView, offset=at(3, 1))
        await pilot.hover(SketchView, offset=at(3, 4))
        await pilot.mouse_up(SketchView, offset=at(3, 4))
        await pilot.pause()
        assert [line[3] for line in drawing(pilot).sketch.rows] == ["#"] * 6
        wall = ("#" if ascii_only else "█") * 2 * side
        for line in range(1 + side, 1 + 2 * side):
            assert rows(pilot)[line][6 * side : 8 * side] == wall
            assert rows(pilot)[line][4 * side : 6 * side] != wall
        await pilot.press("4")
        await pilot.click(SketchView, offset=at(5, 3))
        assert drawing(pilot).sketch.find("T") == (5, 3)
        await pilot.press("1")
        await pilot.click(SketchView, offset=at(3, 1), button=3)
        assert drawing(pilot).sketch.rows[1][3] == " "
        await pilot.press("u", "u", "u")
        assert "T" not in drawing(pilot).sketch.text
        assert text(pilot).isascii() == ascii_only

    stage(desk.open, scene, size=size, ascii_only=ascii_only)


@pytest.mark.long
def test_so_many_changes_can_be_undone(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(map_drawing, "MAX_UNDO", 3)

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "New map mine")
        await pilot.press("1", "home")
        for _ in range(4):
            await pilot.press("right", "space")
        drawn = drawing(pilot).sketch.text.count("#")
        await pilot.press(*"uuu")
        assert drawing(pilot).sketch.text.count("#") == drawn - 3
        await pilot.press("u")  # the oldest is kept
        assert drawing(pilot).sketch.text.count("#") == drawn - 3

    stage(desk.open, scene)


@pytest.mark.long
def test_a_sheet_larger_than_the_terminal_follows_the_cursor(tmp_path: Path) -> None:
    desk = Desk(tmp_path / "mine", MapSketch.room(60, 40))

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "New map mine")
        await pilot.press("end", "pagedown", "pagedown", "pagedown", "pagedown")
        assert drawing(pilot).cursor == (59, 39)
        assert rows(pilot)[-2].startswith("█")
        await pilot.press("space", "2", "space")
        await pilot.press("escape")
        await seen(pilot, "The map is not saved")
        await pilot.press("escape")
        assert drawing(pilot).sketch.rows[39][59] == " "

    stage(desk.open, scene)
    assert not desk.made
