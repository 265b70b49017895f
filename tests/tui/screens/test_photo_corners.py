"""Putting the corners of a photographed sheet with the cursor or the mouse, without a terminal."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PIL import Image, ImageDraw
from textual.pilot import Pilot

from kit.mapmaking.photo import PhotoScale, plan_from_photo
from kit.mapmaking.sheet import SheetNotFound, find_sheet, order_corners, refine_corners
from kit.tui.screens.photo_corners import FIRST_SHADE, SHADES, PhotoCornersScreen, PhotoView, lit_dots
from kit.tui.terminal import Colour
from kit.tui.theme import Theme
from tests.tui.lesson_stage import rows, seen, stage, text, until

CORNERS = ((100.0, 60.0), (700.0, 90.0), (680.0, 520.0), (80.0, 500.0))


def photo(table: int = 60) -> Image.Image:
    """A sheet with a room drawn on it, on a table of that brightness."""
    image = Image.new("L", (800, 600), table)
    draw = ImageDraw.Draw(image)
    draw.polygon(CORNERS, fill=220)
    draw.rectangle((200, 180, 560, 420), outline=30, width=6)
    return image.convert("RGB")


def screen_of(pilot: Pilot[None]) -> PhotoCornersScreen:
    screen = pilot.app.screen
    assert isinstance(screen, PhotoCornersScreen)
    return screen


def place_on_screen(pilot: Pilot[None], place: tuple[float, float]) -> tuple[int, int]:
    """The character of the view in which a place of the whole photograph is."""
    size = screen_of(pilot).query_one(PhotoView).size
    scale = max(800 / size.width, 600 / (2 * size.height))
    left, top = (800 - scale * size.width) / 2, (600 - scale * 2 * size.height) / 2
    return int((place[0] - left) / scale), int((place[1] - top) / (2 * scale))


@pytest.mark.parametrize("colour", ["truecolour", "256", "ansi16"])
def test_a_photograph_is_in_greys_where_the_terminal_has_them_and_in_dots_elsewhere(colour: Colour) -> None:
    def screen(theme: Theme) -> PhotoCornersScreen:
        facts = theme.terminal
        facts = replace(
            facts,
            colour=replace(facts.colour, value=colour),
            theme_name=replace(facts.theme_name, value="dark"),
        )
        return PhotoCornersScreen(Theme.of(facts), "plan.jpg", photo())

    async def scene(pilot: Pilot[None]) -> None:
        view = screen_of(pilot).query_one(PhotoView)
        await until(pilot, lambda: view.frame is not None, "the photograph")
        frame = view.frame
        assert frame is not None
        has_greys = bool((frame.bg >= FIRST_SHADE).any())
        assert has_greys is (colour != "ansi16")
        if not has_greys:
            return
        column, row = place_on_screen(pilot, (390.0, 120.0))
        assert frame.bg[row, column] > FIRST_SHADE + SHADES // 2, "paper"
        column, row = place_on_screen(pilot, (40.0, 300.0))
        assert frame.bg[row, column] < FIRST_SHADE + SHADES // 2, "the table"
        assert frame.bg[0, 0] == 0, "beyond the photograph"
        style = view._style(FIRST_SHADE + SHADES - 1, FIRST_SHADE)
        assert style is not None
        assert style.color is not None
        assert style.color.get_truecolor().red > 230

    stage(screen, scene)


@pytest.mark.long
def test_clicked_corners_are_moved_to_the_edges_of_the_sheet() -> None:
    image = photo()
    screens = []

    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "0 of 4 corners")
        screens.append(screen_of(pilot))
        assert "go on" not in rows(pilot)[-1]
        for number, place in enumerate((CORNERS[2], CORNERS[0], CORNERS[1], CORNERS[3]), start=1):
            await pilot.click(PhotoView, offset=place_on_screen(pilot, place))
            await seen(pilot, f"{number} of 4 corners")
        await seen(pilot, "Enter goes on")
        await pilot.press("enter")

    stage(lambda theme: PhotoCornersScreen(theme, "plan.jpg", image), scene)
    clicked = screens[0].found
    assert clicked is not None
    assert np.abs(np.array(clicked) - CORNERS).max() < 12  # a character is about ten pixels wide
    found = plan_from_photo(image, PhotoScale(sheet_width=5.0), corners=clicked, are_rough=True)
    assert np.abs(np.array(found.corners) - CORNERS).max() < 1.5


def test_the_cursor_puts_moves_and_takes_back_corners() -> None:
    async def scene(pilot: Pilot[None]) -> None:
        await seen(pilot, "0 of 4 corners")
        screen = screen_of(pilot)
        await pilot.press("enter")  # nothing to go on with
        await pilot.press("space", "right", "space", "down", "space", "left", "space")
        await until(pilot, lambda: len(screen.placed) == 4, "four corners")
        (x, y), (right, _), (_, below), (left, _) = screen.placed
        assert (x, y) == (400, 300)
        assert right > x
        assert below > y
        assert left == pytest.approx(x)
        await pilot.press("plus", "left", "space")  # the nearest one moves, half as far as before
        await until(pilot, lambda: screen.placed[3][0] < x, "the fourth corner has moved")
        assert x - screen.placed[3][0] == pytest.approx((right - x) / 2)
        await pilot.press("u")
        await seen(pilot, "3 of 4 corners")
        assert "go on" not in text(pilot)

    stage(lambda theme: PhotoCornersScreen(theme, "plan.jpg", photo()), scene)


def test_corners_stay_where_they_were_put_if_no_edge_is_seen() -> None:
    bright = photo(table=225)
    with pytest.raises(SheetNotFound, match="--click"):
        find_sheet(bright)
    rough = tuple((x + 3, y - 2) for x, y in CORNERS)
    assert refine_corners(bright, order_corners(rough)) == rough


@pytest.mark.parametrize("paper", [110, 240], ids=["in shadow", "in light"])
@pytest.mark.parametrize("columns", [160, 320])
def test_a_line_thinner_than_a_dot_is_seen_on_paper_in_shadow_and_in_light(paper: int, columns: int) -> None:
    image = Image.new("L", (1000, 750), 20)
    draw = ImageDraw.Draw(image)
    draw.rectangle((100, 100, 900, 650), fill=paper)
    draw.line((500, 200, 500, 500), fill=paper // 3, width=2)
    dots = lit_dots(image, (0.0, 0.0, 1000.0, 750.0), (columns, columns * 3 // 4))
    scale = columns / 1000
    across = dots[int(350 * scale) : int(370 * scale), int(500 * scale) - 2 : int(500 * scale) + 3]
    (dark,) = np.flatnonzero(~across.any(axis=0))
    assert across[:, [dark - 1, dark + 1]].all(), "and what is beside it lit"
    assert dots[int(350 * scale), int(150 * scale) : int(450 * scale)].mean() == pytest.approx(
        paper / 255, abs=0.15
    )
    assert not dots[: int(90 * scale)].any(axis=1).all(), "the table stays dark"
