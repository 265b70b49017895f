"""All lessons: what each is about, what is done of it; Enter opens one."""

from __future__ import annotations

from asyncio import to_thread
from contextlib import suppress
from typing import TYPE_CHECKING, ClassVar, Final

from textual import events, work
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, Vertical

from kit.dialogue.actions import ScreenActions
from kit.document.rows import at_both_edges, lines_shown, row
from kit.school.game.levels import GameLevel, levels_of_lesson
from kit.school.lessons.catalogue import LessonEntry
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
LEAST_PICTURE: Final = 8
"""Rows that a picture of the lesson's world must have at least."""
MARKS: Final = (("[x] [~] [ ]", "done, begun, not begun"), ("[!]", "cannot be read"))


class LessonsScreen(RowsScreen[None]):
    """Draws nothing but what a key has changed."""

    AUTO_FOCUS = ""
    screen_actions = ScreenActions("lessons", ("choose", "open", "help", "back"))
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (LIST_WIDTH + LEAST_DETAILS, "-wide")]  # noqa: RUF012 - Textual's own attribute
    DEFAULT_CSS = f"""
    LessonsScreen {{ layout: vertical; }}
    LessonsScreen #heading {{ height: 2; }}
    LessonsScreen #middle {{ height: auto; }}
    LessonsScreen #side {{ display: none; }}
    LessonsScreen #about {{ height: 1fr; }}
    LessonsScreen #keys {{ height: 1; }}
    LessonsScreen.-wide #middle {{ height: 1fr; }}
    LessonsScreen.-wide #list {{ width: {LIST_WIDTH}; }}
    LessonsScreen.-wide #side {{ display: block; padding: 0 2 0 0; }}
    LessonsScreen.-wide #picture {{ height: 1fr; margin: 1 0; }}
    LessonsScreen.-wide #about {{ display: none; }}
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
        self._beside: dict[str, tuple[Scene | None, tuple[GameLevel, ...]]] = {}
        """Of a lesson what is shown beside the list and takes a moment to read: its world, the levels that it opens."""

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        with Horizontal(id="middle"):
            yield TextRows(id="list")
            with Vertical(id="side"):
                yield TextRows(id="details")
                yield self._picture
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
        is_wide = self.has_class("-wide")
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
        """The chosen lesson beside the list: its words at once, its world as soon as it is read."""
        chosen = self.chosen
        if chosen is None:
            return
        scene, levels = self._beside.get(chosen.name, (None, ()))
        width = self.size.width - LIST_WIDTH - 2
        details = lesson_list_rows.details(chosen, levels, width)
        room = self.size.height - 3
        self._rows("details").show_all(details[:room])
        self._picture.display = scene is not None and room - len(details) >= LEAST_PICTURE
        if scene is not None:
            self._picture.show(scene)
        elif chosen.lesson is not None and chosen.name not in self._beside:
            self._beside[chosen.name] = await to_thread(_read_world_and_levels, chosen.lesson)
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


def _read_world_and_levels(lesson: Lesson) -> tuple[Scene | None, tuple[GameLevel, ...]]:
    """The lesson's world and the levels that it opens; what cannot be read is told when the lesson is opened."""
    # of no use to the first frame
    from kit.tui.screens.level_pictures import scene_of_lesson

    try:
        levels = levels_of_lesson(lesson.name)
    except (WorldError, FileNotFoundError):
        levels = ()
    try:
        return scene_of_lesson(lesson), levels
    except (WorldError, LookupError, OSError):
        return None, levels
