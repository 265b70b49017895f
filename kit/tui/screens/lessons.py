"""All lessons: what each is about, what is done of it; Enter opens one."""

from __future__ import annotations

from asyncio import to_thread
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import chain
from typing import TYPE_CHECKING, ClassVar, Final

from textual import events, work
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Container, Horizontal

from kit.dialogue.actions import ScreenActions
from kit.document.rows import Row, at_both_edges, lines_shown, row, row_text
from kit.school.game.levels import GameLevel, levels_of_lesson
from kit.school.lessons.catalogue import LessonEntry
from kit.school.lessons.graph_playback import graph_rows
from kit.school.lessons.records import Lesson
from kit.school.news import take_news
from kit.school.progress import ProgressError
from kit.tui.rows import lesson_list_rows
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.screens.dialogs import HelpDialog, MessageDialog
from kit.tui.student_store import StudentOverview, StudentStore
from kit.tui.theme import Theme
from kit.tui.widgets.text_rows import RowClicked, RowsScreen, TextRows
from kit.tui.widgets.world_view import WorldView
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from kit.render.scene import Scene


SUMMARY_ROWS: Final = 6
LIST_WIDTH: Final = 76
"""Columns of the list where the chosen lesson is shown beside it."""
LEAST_DETAILS: Final = 42
"""Columns beside the list from which on the chosen lesson is shown there, not below it."""
LEAST_PICTURE, MOST_PICTURE = 6, 24
"""Rows of a picture of the lesson's world."""
DETAILS_WIDTH: Final = 60
"""Columns of the chosen lesson's words where its pictures stand beside them."""
LEAST_PICTURES: Final = 42
"""Columns beside the words from which on the pictures stand there, not below them."""
LEVEL_ROWS: Final = 17
"""Rows of the maps of the levels that a lesson opens, with their titles, where its world is above them."""
MARKS: Final = (("[x] [~] [ ]", "done, begun, not begun"), ("[!]", "cannot be read"))


@dataclass(frozen=True, slots=True)
class LessonSight:
    """What is shown beside the list of a lesson, and takes a moment to read."""

    scene: Scene | None = None
    """Its world; where it has none, of the first level that it opens."""
    has_world: bool = False
    picture: tuple[str, ...] = ()
    """Where it has no world, the first picture of its steps."""
    levels: tuple[GameLevel, ...] = ()
    """The levels that it opens."""


class LessonsScreen(RowsScreen[None]):
    """Draws nothing but what a key has changed."""

    AUTO_FOCUS = ""
    screen_actions = ScreenActions("lessons", ("choose", "open", "help", "back"))
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    HORIZONTAL_BREAKPOINTS = [  # noqa: RUF012 - Textual's own attribute
        (0, "-narrow"),
        (LIST_WIDTH + LEAST_DETAILS, "-wide"),
        (LIST_WIDTH + DETAILS_WIDTH + LEAST_PICTURES, "-broad"),
    ]
    DEFAULT_CSS = f"""
    LessonsScreen {{ layout: vertical; }}
    LessonsScreen #heading {{ height: 2; }}
    LessonsScreen #keys {{ height: 1; }}
    LessonsScreen #middle, LessonsScreen #about {{ height: 1fr; }}
    LessonsScreen #list {{ width: {LIST_WIDTH}; }}
    LessonsScreen #side {{ padding: 0 2 0 0; }}
    LessonsScreen #about, LessonsScreen #levels {{ display: none; }}
    LessonsScreen #picture, LessonsScreen #shown {{ height: 1fr; }}
    LessonsScreen #picture {{ margin: 1 0 0 0; }}
    LessonsScreen.-narrow #middle {{ height: auto; }}
    LessonsScreen.-narrow #list {{ width: 1fr; }}
    LessonsScreen.-narrow #side {{ display: none; }}
    LessonsScreen.-narrow #about {{ display: block; }}
    LessonsScreen.-broad #side {{ layout: horizontal; }}
    LessonsScreen.-broad #details {{ width: {DETAILS_WIDTH}; }}
    LessonsScreen.-broad #picture {{ margin: 0 0 1 0; max-height: {MOST_PICTURE}; }}
    LessonsScreen.-broad #levels {{ display: block; height: auto; }}
    """

    def __init__(self, theme: Theme, store: StudentStore, overview: StudentOverview) -> None:
        super().__init__()
        self._theme = theme
        self._store = store
        self._overview = overview
        self._news = ""
        """What is new here, at the first visit."""
        self._listed: list[LessonEntry | None] = []
        first = overview.going_on
        self._at = overview.shelf.index(first) if first is not None else 0
        self._picture = WorldView(lambda: theme.encoder, theme.palette, id="picture")
        self._sights: dict[str, LessonSight] = {}
        self._maps: dict[tuple[str, int, int], list[Row]] = {}
        """The maps of the levels that a lesson opens, in so many columns and rows."""

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        with Horizontal(id="middle"):
            yield TextRows(id="list")
            with Container(id="side"):
                yield TextRows(id="details")
                with Container(id="shown"):
                    yield self._picture
                    yield TextRows(id="levels")
        yield TextRows(id="about")
        yield TextRows(id="keys")

    def on_mount(self) -> None:
        with suppress(ProgressError):
            self._news = take_news(self._store.progress(), self.screen_actions.name)

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._show)

    @property
    def chosen(self) -> LessonEntry | None:
        """The lesson that Enter opens."""
        shelf = self._overview.shelf
        return shelf[self._at] if shelf else None

    def _show(self) -> None:
        if not self.size.width:
            return
        shelf, chosen = self._overview.shelf, self.chosen
        told = f"  {self._overview.done} of {len(shelf)} done" if shelf else "  none were installed"
        is_wide = not self.has_class("-narrow")
        room = max(1, self.size.height - 3 - (0 if is_wide else SUMMARY_ROWS))
        lines = lesson_list_rows.lines(shelf, chosen)
        at = next((number for number, (entry, _) in enumerate(lines) if entry is chosen), 0)
        top = max(0, min(at - room // 2, len(lines) - room))
        self._listed = [entry for entry, _ in lines[top : top + room]]
        where = lines_shown(top, len(self._listed), len(lines))
        news = (f"   {self._news}", "good")
        heading = at_both_edges(
            row(("Lessons", "title"), (told, "dim"), news), row((where, "dim")), self.size.width
        )
        self._rows("heading").show([heading, row((lesson_list_rows.HEADER, "dim"))])
        self._rows("list").show_all([line for _, line in lines[top : top + room]])
        if is_wide:
            self._show_beside()
        else:
            about = (
                () if chosen is None else lesson_list_rows.summary(chosen, SUMMARY_ROWS - 1, self.size.width)
            )
            self._rows("about").show([row(), *about])
        self._rows("keys").show([footer(self.screen_actions, self.size.width, keys={"choose": "↑↓"})])

    @work(exclusive=True, group="beside")
    async def _show_beside(self) -> None:
        """The chosen lesson beside the list: its words at once, its pictures as soon as they are read."""
        chosen = self.chosen
        if chosen is None:
            return
        is_broad = self.has_class("-broad")
        sight = self._sights.get(chosen.name, LessonSight())
        width, room = self.size.width - LIST_WIDTH - 2, self.size.height - 3
        columns = width - DETAILS_WIDTH
        # Beside the words the levels have maps and titles of their own.
        details = lesson_list_rows.details(
            chosen, () if is_broad else sight.levels, min(width, DETAILS_WIDTH - 2) if is_broad else width
        )
        self._rows("details").show_all(details[:room])
        has_picture = sight.scene is not None and (
            sight.has_world if is_broad else room - len(details) >= LEAST_PICTURE
        )
        self._picture.display = has_picture
        if has_picture and sight.scene is not None:
            self._picture.show(sight.scene)
        if is_broad:
            above = [] if sight.has_world or not sight.picture else [*map(row, sight.picture), row()]
            left = room - len(above)
            rows = min(LEVEL_ROWS, left) if sight.has_world else min(MOST_PICTURE, left)
            maps = self._maps.get((chosen.name, columns, rows), [])
            self._rows("levels").show_all([*above, *maps])
            if sight.levels and not maps:
                glyphs = self._theme.terminal.glyphs.value
                maps = await to_thread(_level_maps, sight.levels, columns, rows, glyphs)
                self._maps[chosen.name, columns, rows] = maps
                if self.query(TextRows):
                    self._rows("levels").show_all([*above, *maps])
        if chosen.lesson is not None and chosen.name not in self._sights:
            self._sights[chosen.name] = await to_thread(_read_sight, chosen.lesson)
            if self.query(TextRows):
                self._show_beside()

    # The mouse

    def on_row_clicked(self, event: RowClicked) -> None:
        """A lesson is chosen; a click on the chosen one opens it."""
        number = event.number
        if event.rows.id == "list" and 0 <= number < len(self._listed):
            entry = self._listed[number]
            if entry is not None:
                if entry is self.chosen:
                    self.action_open()
                self._at = self._overview.shelf.index(entry)
                self._show()

    # Keys

    def action_choose(self, columns: int, rows: int) -> None:
        self._at = max(0, min(self._at + rows, len(self._overview.shelf) - 1))
        self._show()

    @work
    async def action_open(self) -> None:
        entry = self.chosen
        if entry is None or not self.is_active:
            return
        if entry.lesson is None:
            self.app.push_screen(MessageDialog("This lesson cannot be read", entry.problem))
            return
        from kit.tui.screens.lesson import LessonScreen  # of no use to the first frame

        try:
            session = self._store.open_lesson(entry.lesson)
        except ProgressError as error:
            self.app.push_screen(MessageDialog("Progress cannot be saved", str(error)))
            return
        await self.app.push_screen_wait(LessonScreen(self._theme, session, self._store.workspace))
        self._overview = await to_thread(self._store.read_overview)
        self._at = min(self._at, max(0, len(self._overview.shelf) - 1))
        self._show()

    def action_help(self) -> None:
        self.app.push_screen(HelpDialog("Lessons", self.screen_actions, MARKS))


def _read_sight(lesson: Lesson) -> LessonSight:
    """The lesson's world or picture and the levels that it opens; what cannot be read is told when the lesson is opened."""
    # of no use to the first frame
    from kit.tui.screens.level_pictures import scene_of, scene_of_lesson

    levels: tuple[GameLevel, ...] = ()
    scene, has_world = None, False
    with suppress(WorldError, FileNotFoundError):
        levels = levels_of_lesson(lesson.name)
    with suppress(WorldError, LookupError, OSError):
        scene = scene_of_lesson(lesson)
        has_world = scene is not None
        scene = scene_of(levels[0]) if scene is None and levels else scene
    return LessonSight(scene, has_world, _first_picture(lesson), levels)


def _first_picture(lesson: Lesson) -> tuple[str, ...]:
    """The picture of the lesson's first step that has one, of messages or of characters."""
    graphs = (graph_rows(each.graph, at_end=False) for each in lesson.steps if each.graph is not None)
    pictures = (each.picture.splitlines() for each in lesson.steps if each.picture)
    return tuple(next(chain(graphs, pictures), []))


def _level_maps(levels: Sequence[GameLevel], columns: int, rows: int, glyphs: str) -> list[Row]:
    """The maps of the levels that a lesson opens, with a line that says so."""
    from kit.tui.screens.level_pictures import pictures_of  # of no use to the first frame

    drawn = pictures_of(levels, columns, rows - 2, glyphs)
    return [row(("Opens in the game", "title")), row(), *(each for each in drawn if row_text(each))]
