"""Shows a photograph of a sheet in the terminal, to click the sheet's corners or put them with the cursor."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, ClassVar, Final

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageFilter, ImageOps
from rich.style import Style
from textual import events
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.message import Message

from kit.arrays import BoolArray, FloatArray, Uint8Array
from kit.dialogue.actions import ScreenActions
from kit.dialogue.screen_action import ScreenAction
from kit.document.rows import row
from kit.mapmaking.pixels import Corners
from kit.mapmaking.sheet import order_corners
from kit.render import raster
from kit.render.encode import BLANK, Encoder
from kit.render.frame_text import write_text
from kit.render.role_looks import RoleStyle
from kit.render.roles import Role
from kit.render.xterm_colors import nearest_xterm_color
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.screens.dialogs import HelpDialog
from kit.tui.textual_patches import ActivePaintScreen
from kit.tui.widgets.frame_view import FrameView
from kit.tui.widgets.text_rows import TextRows

if TYPE_CHECKING:
    from kit.tui.theme import Theme

Point = tuple[float, float]
Part = tuple[float, float, float, float]
"""Left, top, right and bottom of a part of a photograph [pixels]."""
CORNERS: Final = 4
MAX_ZOOM: Final = 6
"""Each doubles the picture."""
CROSS_DOTS: Final = 4
"""Half the length of the cursor's cross."""
THRESHOLDS: Final = (
    np.array([[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]], dtype=np.float64) * 16 + 8
)
"""Brightness above which a dot is lit, by its place in a square of four (Bayer's matrix): many thresholds look like grey."""
UPPER_HALF: Final = ord("▀")
PARTS: Final = 3
"""A dot is looked at in so many parts along each side: a line is thinner than a dot."""
AROUND: Final = 9
"""Dots along a side of the surroundings that a line is compared with."""
LINE_SHARE: Final = 0.75
"""What is darker than this share of its surroundings is a line."""
LEAST_PAPER: Final = 60
"""Brightness of 255 above which surroundings can be paper."""
FIRST_SHADE, SHADES = 200, 32
"""What stands for black in a frame, where a role's number does elsewhere, and how many greys there are."""


class PhotoView(FrameView):
    """A photograph with the corners so far and a cross at the cursor: in greys, two above each other in a character, and as dots
    where the terminal has no colours of its own for them."""

    DEFAULT_CSS = "PhotoView { width: 1fr; height: 1fr; }"

    class Clicked(Message):
        """The mouse was pressed."""

        def __init__(self, place: Point) -> None:
            super().__init__()
            self.place = place
            """Position in the photograph [pixels]."""

    def __init__(self, theme: Theme, photo: Image.Image) -> None:
        super().__init__(theme.palette)
        self._encoder: Encoder = theme.encoder
        terminal = theme.terminal
        self._has_greys = not terminal.ansi and terminal.glyphs.value != "ascii"
        self._is_reduced = terminal.colour.value == "256"
        self._grey = ImageOps.autocontrast(photo.convert("L"), cutoff=1)
        self.zoom = 0
        self._left_top: Point = (0.0, 0.0)
        self._scale = 1.0
        """Pixels of the photograph to a character's width."""

    @property
    def step(self) -> float:
        """How far the cursor moves at once [pixels]: a character's width."""
        return self._scale

    def draw(self, cursor: Point, corners: list[Point]) -> None:
        """Shows the part around the cursor, or the whole photograph where it is not enlarged."""
        columns, rows = self.size
        if not columns or not rows:
            return
        (width, height), encoder = self._grey.size, self._encoder
        self._scale = max(width / columns, height / (2 * rows)) / 2**self.zoom
        seen = self._scale * columns, self._scale * 2 * rows
        self._left_top = left, top = (
            _first_seen(cursor[0], seen[0], width),
            _first_seen(cursor[1], seen[1], height),
        )
        dots = columns * encoder.across, rows * encoder.down
        inside = (max(0.0, left), max(0.0, top), min(width, left + seen[0]), min(height, top + seen[1]))
        grid = np.full(dots[::-1], np.uint8(Role.EMPTY))
        if not self._has_greys:
            grid[self._placed(lit_dots, inside, dots) > 0] = Role.PEN_WHITE
        places = [self._dot(corner, dots) for corner in corners]
        lines = [
            (*one, *other)
            for one, other in zip(places, [*places[1:], *places[:1]], strict=True)
            if len(places) > 2 or one is places[0]
        ]
        x, y = self._dot(cursor, dots)
        cross = [
            (x - CROSS_DOTS, y, x + CROSS_DOTS, y),
            (x, y - CROSS_DOTS, x, y + CROSS_DOTS),
        ]
        for segments, role in ((lines, Role.TARGET), (cross, Role.CONTACT)):
            found = raster.line_dots(np.array(segments, dtype=np.float64).reshape(-1, 4), *dots)
            grid[found] = role
        frame = encoder.encode(grid)
        if self._has_greys:
            above, below = (
                self._placed(shades, inside, (columns, 2 * rows)).reshape(rows, 2, columns).swapaxes(0, 1)
            )
            is_free = frame.glyphs == BLANK
            frame.glyphs[is_free & (above > 0)] = UPPER_HALF
            frame.fg[is_free] = above[is_free]
            frame.bg[:] = np.where(is_free, below, FIRST_SHADE)  # lines stand out from white paper too
        for number, (x, y) in enumerate(places, 1):
            row_, column = int(y // encoder.down), int(x // encoder.across)
            if 0 <= column < columns:
                write_text(frame, row_, column, str(number), Role.TARGET)
        self.show_frame(frame)

    def _placed(
        self,
        drawn: Callable[[Image.Image, Part, tuple[int, int]], NDArray[Any]],
        inside: Part,
        dots: tuple[int, int],
    ) -> Uint8Array:
        """A part of the photograph [pixels] where it is on the screen, (rows, columns) of ``dots``; 0 beyond it."""
        (x1, y1), (x2, y2) = self._dot(inside[:2], dots), self._dot(inside[2:], dots)
        size = max(1, round(x2 - x1)), max(1, round(y2 - y1))
        placed = Image.new("L", dots)
        shown = drawn(self._grey, inside, size).astype(np.uint8)
        placed.paste(Image.fromarray(shown), (round(x1), round(y1)))
        return np.asarray(placed)

    def _style(self, foreground: int, background: int) -> Style | None:
        looks = foreground, background
        if max(looks) >= FIRST_SHADE and looks not in self._styles:
            self._styles[looks] = self._made_style(self._look(foreground), self._look(background))
        return super()._style(foreground, background)

    def _look(self, number: int) -> RoleStyle:
        """Of a grey, or of a role."""
        if number < FIRST_SHADE:
            return self._palette[Role(number)]
        grey = (number - FIRST_SHADE) * 255 // (SHADES - 1)
        rgb = grey, grey, grey
        return RoleStyle(nearest_xterm_color(rgb) if self._is_reduced else rgb)

    def _dot(self, place: Point, dots: tuple[int, int]) -> Point:
        """Converts a place of the photograph to a place on the screen [dots]."""
        columns, rows = self.size
        across, down = self._scale * columns / dots[0], self._scale * 2 * rows / dots[1]
        return (place[0] - self._left_top[0]) / across, (place[1] - self._left_top[1]) / down

    def on_mouse_down(self, event: events.MouseDown) -> None:
        left, top = self._left_top
        self.post_message(
            self.Clicked((left + (event.x + 0.5) * self._scale, top + (event.y + 0.5) * 2 * self._scale))
        )


def lit_dots(grey: Image.Image, inside: Part, size: tuple[int, int]) -> BoolArray:
    """The dots (rows, columns) that show a part of a grey picture [pixels] in ``size`` columns and rows of dots. As many are lit as
    it is bright. A line that is darker than its surroundings stays dark between lit dots, however thin it is.

    >>> picture = Image.new("L", (100, 100), 128)
    >>> picture.paste(0, (50, 0, 52, 100))
    >>> lit_dots(picture, (0, 0, 100, 100), (20, 20))[10, 9:12].tolist()
    [True, False, True]
    """
    columns, rows = size
    levels, _, is_line, is_paper = _levels_and_lines(grey, inside, size)
    is_beside = np.asarray(Image.fromarray(is_line).convert("L").filter(ImageFilter.MaxFilter(3))) > 0
    tiles = np.tile(THRESHOLDS, (-(-rows // 4), -(-columns // 4)))[:rows, :columns]
    lit: BoolArray = ((levels > tiles) | (is_beside & is_paper)) & ~is_line
    return lit


def shades(grey: Image.Image, inside: Part, size: tuple[int, int]) -> Uint8Array:
    """The greys (rows, columns) of a part of a grey picture [pixels], from ``FIRST_SHADE`` for black on. A line that is darker than
    its surroundings has all of its darkness, however thin it is.

    >>> picture = Image.new("L", (100, 100), 255)
    >>> picture.paste(0, (50, 0, 52, 100))
    >>> (shades(picture, (0, 0, 100, 100), (20, 20))[10, 9:12] - FIRST_SHADE).tolist()
    [31, 0, 31]
    """
    levels, darkest, is_line, _ = _levels_and_lines(grey, inside, size)
    shown = np.where(is_line, darkest, levels) * (SHADES - 1) / 255
    return (FIRST_SHADE + np.rint(shown)).astype(np.uint8)


def _levels_and_lines(
    grey: Image.Image, inside: Part, size: tuple[int, int]
) -> tuple[FloatArray, FloatArray, BoolArray, BoolArray]:
    """Of each dot (rows, columns) its brightness and that of its darkest part, from 0 to 255, whether a line goes through it, and
    whether paper is around it."""
    columns, rows = size
    fine = grey.resize((PARTS * columns, PARTS * rows), Image.Resampling.BOX, inside)
    parts = np.asarray(fine, dtype=np.float64).reshape(rows, PARTS, columns, PARTS)
    levels, darkest = parts.mean(axis=(1, 3)), parts.min(axis=(1, 3))
    around = np.asarray(Image.fromarray(levels.astype(np.uint8)).filter(ImageFilter.MedianFilter(AROUND)))
    is_paper = around > LEAST_PAPER
    return levels, darkest, is_paper & (darkest < LINE_SHARE * around), is_paper


def _first_seen(middle: float, seen: float, length: int) -> float:
    """Returns where the visible part of a length begins; a length that is visible as a whole is centred."""
    if seen >= length:
        return (length - seen) / 2
    return min(max(0.0, middle - seen / 2), length - seen)


class PhotoCornersScreen(ActivePaintScreen["Corners | None"]):
    """Returns the sheet's four corners in the photograph [pixels]; None if it was left without them."""

    AUTO_FOCUS = ""
    screen_actions = ScreenActions(
        "photo corners",
        ("put_corner", "next", "move_cursor", "zoom", "fit", "undo", "help", "back"),
        own=(
            ScreenAction("put_corner", "Space", "corner", "put a corner of the sheet under the cross", (("space", "put"),)),
        ),
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    uses_mouse: ClassVar[bool] = True
    DEFAULT_CSS = """
    PhotoCornersScreen { layout: vertical; }
    PhotoCornersScreen #heading, PhotoCornersScreen #note, PhotoCornersScreen #keys { height: 1; }
    """

    def __init__(self, theme: Theme, name: str, photo: Image.Image) -> None:
        super().__init__()
        self._name = name
        self._photo_size = photo.size
        self._cursor: Point = (photo.width / 2, photo.height / 2)
        self.placed: list[Point] = []
        """The corners so far [pixels], in the order in which they were put."""
        self._view = PhotoView(theme, photo)
        self._found: Corners | None = None

    @property
    def found(self) -> Corners | None:
        """The four corners, once they have been accepted."""
        return self._found

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        yield self._view
        yield TextRows(id="note")
        yield TextRows(id="keys")

    def on_mount(self) -> None:
        self.call_after_refresh(self._show)

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._show)

    def _show(self) -> None:
        count = len(self.placed)
        heading = row((f"{self._name}", "title"), (f"  {count} of {CORNERS} corners of the sheet", "dim"))
        self.query_one("#heading", TextRows).show([heading])
        note = (
            "Enter goes on. The corners are moved to the sheet's edges where those are seen."
            if count == CORNERS
            else "Click the sheet's corners, or move the cross and press Space. + enlarges."
        )
        self.query_one("#note", TextRows).show([row((note[: self.size.width], "warn"))])
        without = self.unavailable_actions
        keys = footer(self.screen_actions, self.size.width, without=without, labels={"next": "go on"})
        self.query_one("#keys", TextRows).show([keys])
        self._view.draw(self._cursor, self.placed)

    @property
    def unavailable_actions(self) -> tuple[str, ...]:
        return () if len(self.placed) == CORNERS else ("next",)

    # Keys and mouse

    def on_photo_view_clicked(self, event: PhotoView.Clicked) -> None:
        self._cursor = self._inside(event.place)
        self.action_put()

    def action_move(self, columns: int, rows: int) -> None:
        x, y = self._cursor
        self._cursor = self._inside((x + columns * self._view.step, y + rows * self._view.step))
        self._show()

    def _inside(self, place: Point) -> Point:
        width, height = self._photo_size
        return min(max(place[0], 0.0), width - 1.0), min(max(place[1], 0.0), height - 1.0)

    def action_put(self) -> None:
        if len(self.placed) < CORNERS:
            self.placed.append(self._cursor)
        else:  # the nearest one was meant
            apart: FloatArray = np.array(self.placed) - self._cursor
            self.placed[int(np.hypot(*apart.T).argmin())] = self._cursor
        self._show()

    def action_undo(self) -> None:
        del self.placed[-1:]
        self._show()

    def action_zoom(self, steps: int) -> None:
        self._view.zoom = max(0, min(MAX_ZOOM, self._view.zoom + steps))
        self._show()

    def action_fit(self) -> None:
        self._view.zoom = 0
        self._show()

    def action_next(self) -> None:
        if len(self.placed) == CORNERS:
            self._found = order_corners(self.placed)
            self.app.exit()

    def action_help(self) -> None:
        notes = (("mouse", "puts a corner; of four, it moves the nearest"),)
        self.app.push_screen(HelpDialog("The sheet's corners", self.screen_actions, notes))

    def action_back(self) -> None:
        self.app.exit()
