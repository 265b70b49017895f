"""The defence of a program: what will it do from here? Three answers first, and then the run is seen."""

from __future__ import annotations

from asyncio import to_thread
from typing import TYPE_CHECKING, ClassVar

from textual import events, work
from textual.app import ComposeResult
from textual.binding import BindingType

from kit.school.lessons.defence import DefenceError
from kit.school.progress import ProgressError
from kit.tui.rows.defence_rows import defence_rows
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.screens.message_dialog import MessageDialog, wrapped
from kit.tui.textual_patches import ActivePaintScreen
from kit.tui.widgets.lesson_scene_view import LessonSceneView
from kit.tui.widgets.text_rows import TextRows, row, spread
from kit.tui.widgets.world_view import ErrorEvent

if TYPE_CHECKING:
    from kit.school.lessons.defence import Defence
    from kit.school.lessons.lesson_session import LessonSession
    from kit.school.lessons.records import Exercise
    from kit.tui.theme import Theme
    from kit.workspace import Workspace


class DefenceScreen(ActivePaintScreen[None]):
    """Asks about the student's own program, and shows the run once every question is answered."""

    AUTO_FOCUS = ""
    BINDINGS: ClassVar[list[BindingType]] = bindings("defence")
    DEFAULT_CSS = """
    DefenceScreen { layout: vertical; }
    DefenceScreen #heading, DefenceScreen #keys { height: 1; }
    DefenceScreen #words { height: auto; }
    """

    def __init__(
        self, theme: Theme, session: LessonSession, exercise: Exercise, workspace: Workspace
    ) -> None:
        super().__init__()
        self._session = session
        self._exercise = exercise
        self._scene = LessonSceneView(theme, workspace.controllers)
        self._defence: Defence | None = None
        self._answers: list[int] = []

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        yield self._scene
        yield TextRows(id="words")
        yield TextRows(id="keys")

    def on_mount(self) -> None:
        self._prepare()

    def on_resize(self, event: events.Resize) -> None:
        self.call_after_refresh(self._show)

    @work
    async def _prepare(self) -> None:
        try:
            self._defence = await to_thread(self._session.prepare_defence, self._exercise)
        except DefenceError as error:
            await self.app.push_screen_wait(MessageDialog("There is nothing to ask", wrapped(str(error))))
            self.dismiss()
            return
        if self.is_mounted:
            self._scene.play(self._defence.recording, self._defence.place, still=True)
            self._show()

    @property
    def _is_answered(self) -> bool:
        return self._defence is not None and len(self._answers) == len(self._defence.questions)

    def _show(self) -> None:
        if not self.size.width or not self.is_mounted:
            return
        width, defence = self.size.width, self._defence
        caption = self._scene.caption if self._is_answered and not self._scene.is_resting else ""
        title = row(("Defend your program: ", "dim"), (self._exercise.name, "bold"))
        self.query_one("#heading", TextRows).show([spread(title, row((caption, "dim")), width)])
        words = (
            [row(("  Your program drives once, out of sight, from a new start ...", "bold"))]
            if defence is None
            else defence_rows(defence, self._answers, width)
        )
        self.query_one("#words", TextRows).show_all(words)
        without = ("restart",) if not self._is_answered else ("defence_answer",)
        self.query_one("#keys", TextRows).show([footer("defence", width, without=without)])

    def on_lesson_scene_view_moved(self) -> None:
        self._show()

    def on_error_event(self, event: ErrorEvent) -> None:
        self.app.push_screen(MessageDialog("The run cannot be shown", wrapped(event.text)))

    def action_answer(self, number: int) -> None:
        defence = self._defence
        if defence is None or self._is_answered:
            return
        if number > len(defence.questions[len(self._answers)].options):
            return
        self._answers.append(number - 1)
        if self._is_answered:
            try:
                self._session.record_defence(self._exercise, defence, self._answers)
            except ProgressError as error:
                self.app.push_screen(MessageDialog("This could not be saved", wrapped(str(error))))
            self._scene.go()
        self._show()

    def action_restart(self) -> None:
        """The run once more."""
        if self._is_answered:
            self._scene.again()

    def action_back(self) -> None:
        self.dismiss()
