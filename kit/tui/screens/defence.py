"""The defence of a program on the full screen: where the robot starts, three questions below, and then the run."""

from __future__ import annotations

from textual.app import ComposeResult

from kit.document.layout import Page, rows_of
from kit.document.rows import MARGIN, Row, at_both_edges, row, text_width
from kit.school.lessons.defence_dialogue import DefenceDialogue
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.dialogue import DialogueScreen
from kit.tui.theme import Theme
from kit.tui.widgets.lesson_scene_view import LessonSceneView
from kit.tui.widgets.text_rows import TextRows
from kit.tui.widgets.world_view import ErrorEvent
from kit.workspace import Workspace


class DefenceScreen(DialogueScreen):
    """Asks about the student's own program, and shows the run once every question is answered."""

    dialogue: DefenceDialogue
    DEFAULT_CSS = """
    DefenceScreen { layout: vertical; }
    DefenceScreen #heading, DefenceScreen #remark, DefenceScreen #keys { height: 1; }
    DefenceScreen #body { height: auto; }
    DefenceScreen #scene { display: block; }
    """

    def __init__(self, dialogue: DefenceDialogue, theme: Theme, workspace: Workspace) -> None:
        super().__init__(dialogue)
        self._scene = LessonSceneView(theme, workspace.controllers)

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        yield self._scene
        yield TextRows(id="body")
        yield TextRows(id="remark")
        yield TextRows(id="keys")

    def on_mount(self) -> None:
        self.dialogue.open_stage(self._scene)

    def _heading(self) -> Row:
        is_running = self.dialogue.is_answered and not self._scene.is_resting
        right = self._scene.caption if is_running else self.dialogue.position
        return at_both_edges(row((self.dialogue.title, "title")), row((right, "dim")), self.size.width)

    def _show_body(self) -> None:
        page = Page(text_width(self.size.width), MARGIN)
        self._rows("body").show_all(rows_of(self.dialogue.blocks(), page))

    def on_lesson_scene_view_moved(self) -> None:
        self.show()

    def on_error_event(self, event: ErrorEvent) -> None:
        self.app.push_screen(MessageDialog("The run cannot be shown", event.text))
