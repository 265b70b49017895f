"""Draws a map in the terminal, with the cursor or the mouse: walls, start, target, scale; saving proves that it has a way."""

from __future__ import annotations

from asyncio import sleep, to_thread
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, ClassVar, Final

from textual import events, work
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal
from textual.message import Message

from kit.dialogue.actions import ScreenActions
from kit.dialogue.screen_action import ScreenAction, digits
from kit.document.rows import Row, broken, row
from kit.mapmaking.map_sketch import MapSketch, SketchMark, Square
from kit.mapmaking.new_map import NewMap
from kit.render.encode import Frame
from kit.render.frame_text import write_text
from kit.render.roles import Role
from kit.tui.rows.key_rows import bindings, footer, help_page
from kit.tui.screens.dialogs import HelpDialog, MessageDialog
from kit.tui.screens.picker import Picker, PickerItem
from kit.tui.textual_patches import ActivePaintScreen
from kit.tui.widgets.frame_view import FrameView
from kit.tui.widgets.text_rows import RowClicked, TextRows

if TYPE_CHECKING:
    from kit.tui.theme import Theme

PANEL_WIDTH: Final = 24
PANEL_FROM: Final = 60
"""Columns of the terminal from which the panel is shown."""
CELL_COLUMNS: Final = 2
"""A character is about twice as high as wide: two of them make a square."""
WAY: Final = "+"
"""A square of the way, as it is drawn where there are no other characters."""
PENS: Final[tuple[tuple[SketchMark, str], ...]] = (
    ("#", "wall"),
    (" ", "floor"),
    ("S", "start"),
    ("T", "target"),
)
MAX_UNDO: Final = 200
"""Changes that can be undone, the newest ones."""
CALM_S: Final = 0.5
"""After a change, before a way is looked for [s]."""
LEAST_KEYS: Final = 40
"""Columns of the panel from which on it lists all keys, where they have room."""
LOOKING: Final = row(("Looking for a way ...", "dim"))


class SketchView(FrameView):
    """The sheet with the cursor. Tells the screen which squares the mouse draws in."""

    DEFAULT_CSS = "SketchView { height: 1fr; }"

    class Drawn(Message):
        """The mouse went from one square to another with a button down, or pressed it on one."""

        def __init__(self, first: Square, last: Square, *, erases: bool, is_new: bool) -> None:
            super().__init__()
            self.first = first
            self.last = last
            self.erases = erases
            self.is_new = is_new

    def __init__(self, theme: Theme) -> None:
        super().__init__(theme.palette)
        self._is_ascii = theme.terminal.glyphs.value == "ascii"
        self._origin = (0, 0)
        self._side = 1
        """Rows of characters to a square."""
        self._dragged: Square | None = None

    def draw(self, sketch: MapSketch, way: Sequence[Square], cursor: Square, columns: int, rows: int) -> None:
        """Shows as much of the sketch as the columns and rows have room for, the cursor with it, in the largest squares in
        which all of it fits. ``way``: the squares that a robot drives through, the start's first."""
        if columns < CELL_COLUMNS or rows < 1:
            return
        self._side = side = max(1, min(columns // (CELL_COLUMNS * sketch.columns), rows // len(sketch.rows)))
        wide, high = min(columns // (CELL_COLUMNS * side), sketch.columns), rows // side
        self._origin = left, top = (
            _first_shown(self._origin[0], cursor[0], wide, sketch.columns),
            _first_shown(self._origin[1], cursor[1], high, len(sketch.rows)),
        )
        across = CELL_COLUMNS * side
        frame = Frame.empty(across * wide, rows)
        signs: dict[Square, str] = dict.fromkeys(way, WAY)
        if way:
            signs |= {way[0]: "s", way[-1]: "t"}
        for y, line in enumerate(sketch.rows[top : top + high]):
            for x, mark in enumerate(line[left : left + wide]):
                mark = signs.get((x + left, y + top), mark) if mark == " " else mark
                texts, role = self._square_texts(mark, is_chosen=(x + left, y + top) == cursor)
                for number, text in enumerate(texts):
                    write_text(frame, y * side + number, across * x, text, role)
        self.styles.width = across * wide
        self.show_frame(frame)

    def _square_texts(self, mark: str, *, is_chosen: bool) -> tuple[list[str], Role]:
        """A square's rows of characters, in brackets where the cursor is."""
        across = CELL_COLUMNS * self._side
        match mark:
            case "#":
                texts, role = [("#" if self._is_ascii else "█") * across] * self._side, Role.WALL
            case "S" | "T" | "s" | "t":
                texts, role = self._in_middle(mark), Role.ROBOT if mark in "Ss" else Role.TARGET
            case "+":
                texts, role = self._in_middle(mark if self._is_ascii else "•"), Role.PATH
            case _:
                texts, role = self._in_middle("." if self._is_ascii else "·"), Role.BEAM
        if not is_chosen:
            return texts, role
        role = Role.CONTACT if mark == "#" else Role.TEXT
        if self._side == 1:  # too narrow for two brackets around a mark
            return [f"[{mark if mark in 'STst' else ']'}"], role
        return [f"[{text[1:-1]}]" for text in texts], role

    def _in_middle(self, glyph: str) -> list[str]:
        across = CELL_COLUMNS * self._side
        return [
            f"{glyph:^{across}}" if number == self._side // 2 else " " * across
            for number in range(self._side)
        ]

    def _square(self, event: events.MouseEvent) -> Square:
        return event.x // (CELL_COLUMNS * self._side) + self._origin[0], event.y // self._side + self._origin[
            1
        ]

    def on_mouse_down(self, event: events.MouseDown) -> None:
        self._dragged = self._square(event)
        self.capture_mouse()
        self.post_message(self.Drawn(self._dragged, self._dragged, erases=event.button == 3, is_new=True))

    def on_mouse_move(self, event: events.MouseMove) -> None:
        if self._dragged is not None and event.button:
            square = self._square(event)
            if square != self._dragged:
                self.post_message(self.Drawn(self._dragged, square, erases=event.button == 3, is_new=False))
                self._dragged = square

    def on_mouse_up(self, event: events.MouseUp) -> None:
        self._dragged = None
        self.release_mouse()


def _first_shown(first: int, cursor: int, room: int, total: int) -> int:
    """The first row or column shown, moved as little as keeps the cursor in sight."""
    first = max(cursor - room + 1, min(first, cursor))
    return max(0, min(first, total - room))


class MapDrawingScreen(ActivePaintScreen["NewMap | None"]):
    """Returns the map that was written; None if it was left without one."""

    AUTO_FOCUS = ""
    screen_actions = ScreenActions(
        "map drawing",
        (
            "move_cursor", "pen", "put", "save_map", "draw_along", "square_size", "undo_drawing", "help",
            "back",
        ),
        own=(
            ScreenAction("draw_along", "Shift+arrows", "draw", "draw with the pen while moving",
                   (("shift+up", "draw(0, -1)"), ("shift+down", "draw(0, 1)"), ("shift+left", "draw(-1, 0)"), ("shift+right", "draw(1, 0)")),
                   "Shift"),
            ScreenAction("put", "Space", "draw", "draw with the pen under the cursor", (("space", "draw(0, 0)"),)),
            ScreenAction("pen", "1 2 3 4", "pen", "choose the pen: wall, floor, start, target", digits("pen", 1, 4), "1-4"),
            ScreenAction("square_size", "[ ]", "scale", "make the squares smaller or larger (map scale)",
                   (("left_square_bracket", "scale(-1)"), ("right_square_bracket", "scale(1)")), "[ ]"),
            ScreenAction("undo_drawing", "u", "undo", "undo the last change of the drawing", (("u", "undo"),)),
            ScreenAction("save_map", "Ctrl-S", "save", "save the map, if the target can be reached", (("ctrl+s", "save"),), "^S"),
        ),
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    uses_mouse: ClassVar[bool] = True
    DEFAULT_CSS = """
    MapDrawingScreen { layout: vertical; }
    MapDrawingScreen #heading, MapDrawingScreen #keys { height: 1; }
    MapDrawingScreen #middle { height: 1fr; }
    MapDrawingScreen #panel { width: 1fr; padding: 0 0 0 1; }
    MapDrawingScreen.-narrow #panel { display: none; }
    """
    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (PANEL_FROM, "-wide")]  # noqa: RUF012 - Textual's own

    def __init__(
        self,
        theme: Theme,
        name: str,
        sketch: MapSketch,
        save: Callable[[MapSketch], NewMap],
        *,
        note: str = "",
        keep: Callable[[MapSketch], str] = lambda sketch: "",
    ) -> None:
        """``save`` writes the map, called in another thread; ValueError and OSError are told and nothing is lost. ``note``:
        what is said first. ``keep`` is called after each change, and returns what is to be said of it."""
        super().__init__()
        self._note = note
        self._keep = keep
        self.is_given_up = False
        """Whether the user has said that the drawing is not wanted."""
        self._name = name
        self._save = save
        self.sketch = sketch
        self.cursor: Square = (1, 1)
        self._pen: SketchMark = "#"
        self._before: list[MapSketch] = []
        self._saved: NewMap | None = None
        self._view = SketchView(theme)
        self._way: tuple[Square, ...] = ()
        """The squares from the start to the target through which a robot has a way."""
        self._proof: Sequence[Row] = (LOOKING,)
        """What is known of it."""
        self._is_proving = False

    @property
    def saved(self) -> NewMap | None:
        """The map that was written."""
        return self._saved

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        with Horizontal(id="middle"):
            yield self._view
            yield TextRows(id="panel")
        yield TextRows(id="keys")

    def on_mount(self) -> None:
        self.call_after_refresh(self._show, self._note)
        self._prove()

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._show)

    def _show(self, note: str = "") -> None:
        width = self.size.width
        sizes = f"  {self.sketch.size[0]:g} m x {self.sketch.size[1]:g} m"
        heading = row((f"New map {self._name}", "title"), (sizes, "dim"), (f"  {note}", "warn"))
        self.query_one("#heading", TextRows).show([heading])
        self.query_one("#panel", TextRows).show(self._panel())
        self.query_one("#keys", TextRows).show([footer(self.screen_actions, width)])
        room = width if width < PANEL_FROM else width - PANEL_WIDTH
        self._view.draw(self.sketch, self._way, self.cursor, room, self.size.height - 2)

    def _panel(self) -> list[Row]:
        sketch, (column, line) = self.sketch, self.cursor
        x, y = (column + 0.5) * sketch.cell, (len(sketch.rows) - line - 0.5) * sketch.cell
        rows = [row(("pen", "title"))]
        for number, (mark, name) in enumerate(PENS, 1):
            is_chosen = mark == self._pen
            where = "" if mark in "# " or sketch.find(mark) else "  not set"
            rows.append(
                row(
                    (f"{'>' if is_chosen else ' '}{number} {name}", "bold" if is_chosen else ""),
                    (where, "dim"),
                )
            )
        rows += [
            row(),
            row(("cursor", "title")),
            row(f" x {x:6.2f} m"),
            row(f" y {y:6.2f} m"),
            row(),
            row(("one square", "title")),
            row(f" {sketch.cell:g} m"),
            row(),
            row(("the way", "title")),
            *self._proof,
        ]
        width, height = self.query_one("#panel", TextRows).size
        keys = help_page(self.screen_actions) if width >= LEAST_KEYS else ()
        shown, listed = (
            [each for parts in told for each in broken(parts, max(1, width - 1))] for told in (rows, keys)
        )
        return [*shown, *listed] if len(shown) + len(listed) <= height else shown

    @work(exclusive=True, group="proof")
    async def _prove(self) -> None:
        """Looks for a way once nothing is drawn for a moment, in another thread, in one at a time."""
        await sleep(CALM_S)
        if self._is_proving:  # it looks again when it is done
            return
        self._is_proving, sketch = True, self.sketch
        self._await_proof(sketch)

    @work(group="proof of one sketch")
    async def _await_proof(self, sketch: MapSketch) -> None:
        found = await to_thread(_find_way, sketch)
        self._is_proving = False
        if sketch != self.sketch:
            self._prove()
        elif self.is_attached:
            self._way, self._proof = found
            self._show()

    def _change(self, sketch: MapSketch, *, remembers: bool = True) -> None:
        if remembers and sketch != self.sketch:
            self._before = [*self._before, self.sketch][-MAX_UNDO:]
        is_changed, self.sketch = sketch != self.sketch, sketch
        if is_changed:
            self._way, self._proof = (), (LOOKING,)
            self._prove()
        self._show(self._keep(sketch) if is_changed else "")

    # Keys and mouse

    def action_move(self, columns: int, rows: int) -> None:
        self.cursor = self._moved(columns, rows)
        self._show()

    def action_draw(self, columns: int, rows: int) -> None:
        """Draws with the pen from here to the next square, or here."""
        first, self.cursor = self.cursor, self._moved(columns, rows)
        self._put(self._pen, first, self.cursor)

    def _put(self, mark: SketchMark, first: Square, last: Square, *, remembers: bool = True) -> None:
        sketch = self.sketch
        if mark not in "ST":
            self._change(sketch.drawn_line(mark, first, last), remembers=remembers)
        elif sketch.rows[last[1]][last[0]] == "#":
            self._show("there is a wall here: pen 2 clears it")
        else:
            self._change(sketch.drawn(mark, last), remembers=remembers)

    def _moved(self, columns: int, rows: int) -> Square:
        column, line = self.cursor
        return (
            max(0, min(column + columns, self.sketch.columns - 1)),
            max(0, min(line + rows, len(self.sketch.rows) - 1)),
        )

    def action_pen(self, number: int) -> None:
        self._pen = PENS[number - 1][0]
        self._show()

    def on_row_clicked(self, event: RowClicked) -> None:
        """A click on a pen takes it."""
        if event.rows.id == "panel" and 1 <= event.number <= len(PENS):
            self.action_pen(event.number)

    def on_sketch_view_drawn(self, event: SketchView.Drawn) -> None:
        if self.sketch.is_inside(event.last):
            self.cursor = event.last
            self._put(" " if event.erases else self._pen, event.first, event.last, remembers=event.is_new)

    def action_scale(self, steps: int) -> None:
        self._change(self.sketch.scaled(steps))

    def action_undo(self) -> None:
        if self._before:
            self._change(self._before.pop(), remembers=False)

    @work(exclusive=True)
    async def action_save(self) -> None:
        self._show("looking for a way ...")
        try:
            self._saved = await to_thread(self._save, self.sketch)
        except (ValueError, OSError) as error:
            self._show()
            self.app.push_screen(MessageDialog("Not saved", str(error)))
            return
        self._leave()

    @property
    def not_over(self) -> str:
        return "The map is not saved" if self._before or self._note else ""

    @work(exclusive=True)
    async def action_back(self) -> None:
        if self.not_over:
            choices = [
                PickerItem("stay", "go on drawing"),
                PickerItem("save", "save and leave"),
                PickerItem("leave", "leave without saving"),
            ]
            chosen = await self.app.push_screen_wait(Picker(self.not_over, choices))
            if chosen == "save":
                self.action_save()
            if chosen != "leave":
                return
        self.is_given_up = True
        self._leave()

    def _leave(self) -> None:
        """Returns to the screen that opened this one, if there is one."""
        if len(self.app.screen_stack) > 2:  # Textual's own lies at the bottom
            self.dismiss(self._saved)
        else:
            self.app.exit()

    def action_help(self) -> None:
        notes = (("mouse", "draws with the pen; the right button clears"),)
        self.app.push_screen(HelpDialog("Drawing a map", self.screen_actions, notes))


def _find_way(sketch: MapSketch) -> tuple[tuple[Square, ...], Sequence[Row]]:
    """About the squares of the way that would prove a map, and what is to be said of it. Takes about a second."""
    from kit.mapmaking.map_drawing import read_drawing  # numpy, of no use to the first frame
    from kit.mapmaking.new_map import find_way
    from kit.mapmaking.route import ROBOT_RADIUS

    try:
        way = find_way(read_drawing(sketch.text, cell=sketch.cell))
    except ValueError as error:
        return (), (row((str(error), "warn")),)
    if way is None:
        return (), (row(("Saving looks for one: the map is large.", "dim")),)
    chosen = "" if sketch.find("S") and sketch.find("T") else "; s, t: chosen, as not set"
    return tuple(dict.fromkeys(sketch.square_at(*point) for point in way.points)), (
        row((f"{way.length:.1f} m from start to target", "good")),
        row(f"{way.width:.2f} m at its narrowest; a robot needs {2 * ROBOT_RADIUS:.2f} m"),
        row((f"dots show it{chosen}", "dim")),
    )
