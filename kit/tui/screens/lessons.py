"""All lessons: what each is about, what is done of it; Enter opens one.

What a student has done so far: lessons, exercises, the quiz by topic, and how to take it along.
"""

from __future__ import annotations

from asyncio import to_thread
from typing import TYPE_CHECKING, Any, ClassVar, Final

from textual import events, work
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.screen import Screen

from kit.school.progress import ProgressError
from kit.tui.rows import lesson_rows
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.screens.dialogs import HelpDialog, MessageDialog, TextScreen, wrapped
from kit.tui.student_store import StudentOverview, StudentStore
from kit.tui.textual_patches import ActivePaintScreen
from kit.tui.theme import Theme
from kit.tui.widgets.text_rows import Row, RowClicked, TextRows, row

if TYPE_CHECKING:
    from kit.school.lessons.catalogue import LessonEntry


SUMMARY_ROWS: Final = 6
MARKS: Final = (("[x] [~] [ ]", "done, begun, not begun"), ("[!]", "cannot be read"))


class LessonsScreen(ActivePaintScreen[None]):
    """Draws nothing but what a key has changed."""

    AUTO_FOCUS = ""
    BINDINGS: ClassVar[list[BindingType]] = bindings("lessons")
    DEFAULT_CSS = """
    LessonsScreen { layout: vertical; }
    LessonsScreen #heading { height: 2; }
    LessonsScreen #about { height: 1fr; }
    LessonsScreen #keys { height: 1; }
    """

    def __init__(self, theme: Theme, store: StudentStore, overview: StudentOverview) -> None:
        super().__init__()
        self._theme = theme
        self._store = store
        self._overview = overview
        self._listed: list[LessonEntry | None] = []
        first = overview.going_on
        self._at = overview.shelf.index(first) if first is not None else 0

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        yield TextRows(id="list")
        yield TextRows(id="about")
        yield TextRows(id="keys")

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
        self._rows("heading").show([row(("Lessons", "bold"), (told, "dim"))])
        room = max(1, self.size.height - 3 - SUMMARY_ROWS)
        lines = lesson_rows.lines(shelf, chosen)
        at = next((number for number, (entry, _) in enumerate(lines) if entry is chosen), 0)
        top = max(0, min(at - room // 2, len(lines) - room))
        self._listed = [entry for entry, _ in lines[top : top + room]]
        self._rows("list").show_all([line for _, line in lines[top : top + room]])
        self._rows("about").show(
            [row(), *(lesson_rows.summary(chosen, SUMMARY_ROWS - 1) if chosen is not None else [])]
        )
        self._rows("keys").show([footer("lessons", self.size.width, keys={"choose": "up down"})])

    def _rows(self, name: str) -> TextRows:
        return self.query_one(f"#{name}", TextRows)

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
            self.app.push_screen(MessageDialog("This lesson cannot be read", wrapped(entry.problem)))
            return
        from kit.tui.screens.lesson import LessonScreen  # of no use to the first frame

        try:
            session = self._store.visit(entry.lesson)
        except ProgressError as error:
            self.app.push_screen(MessageDialog("Progress cannot be kept", wrapped(str(error))))
            return
        await self.app.push_screen_wait(LessonScreen(self._theme, session, self._store.workspace))
        self._overview = await to_thread(self._store.read_overview)
        self._at = min(self._at, max(0, len(self._overview.shelf) - 1))
        self._show()

    def action_help(self) -> None:
        self.app.push_screen(HelpDialog("Lessons", "lessons", MARKS))

    def action_back(self) -> None:
        if len(self.app.screen_stack) > 2:
            self.dismiss()
        else:
            self.app.exit()


async def show_progress(screen: Screen[Any], store: StudentStore) -> None:
    """Opens the page, and comes back when it is left. To be called in a worker."""
    found = await to_thread(_rows, store)
    if isinstance(found, str):
        screen.app.push_screen(MessageDialog("Progress cannot be read", wrapped(found)))
    else:
        await screen.app.push_screen_wait(TextScreen("Progress", found))


def _rows(store: StudentStore) -> list[Row] | str:
    """In another thread: there are many files. What is wrong, if something is."""
    overview = store.read_overview()
    if overview.problem:
        return overview.problem
    return lesson_rows.progress(overview.shelf, _quiz(store), str(store.workspace.folder))


def _quiz(store: StudentStore) -> list[str]:
    from kit.school.quiz.items import read_bank
    from kit.school.quiz.quiz_session import local_now
    from kit.school.quiz.quiz_text import scores_lines
    from kit.school.quiz.schedule import answers_from_events, build_schedule
    from kit.world.problems import WorldError

    events = store.progress().events()
    try:
        bank = read_bank()
    except (WorldError, FileNotFoundError) as error:
        return str(error).splitlines()
    answers = answers_from_events(events)
    if not answers:
        return ["Nothing answered yet."]
    return list(scores_lines(bank, answers, build_schedule(bank, events, local_now())))
