"""One training beside the list of all: its curve, and the robot on its map with the newest policy."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Final

from textual.app import ComposeResult
from textual.containers import Vertical
from textual.message import Message
from textual.timer import Timer

from kit.document.rows import row
from kit.tui.rows import training_rows
from kit.tui.theme import Theme
from kit.tui.training_follower import TrainingFollower
from kit.tui.widgets.chart_view import CurveView
from kit.tui.widgets.text_rows import TextRows
from kit.tui.widgets.world_view import WorldView

if TYPE_CHECKING:
    from kit.learning.training.demonstration import DemonstrationView
    from kit.learning.training.run_status import RunStatus
    from kit.learning.training.runs import TrainingRun

REST_S: Final = 0.4
"""How long a run is the chosen one before its files are opened: whoever scrolls past opens none."""


class TrainingPreview(Vertical):
    """Follows the run that it was given last; opens nothing while it is not displayed."""

    DEFAULT_CSS = """
    TrainingPreview TextRows { height: 1; }
    TrainingPreview CurveView { height: 2fr; }
    TrainingPreview WorldView { height: 3fr; }
    """

    class Arrived(Message):
        """The run's files tell more, or the robot has moved."""

    def __init__(self, theme: Theme, *, id: str | None = None) -> None:  # noqa: A002 - Textual's own name
        super().__init__(id=id)
        self._run: TrainingRun | None = None
        self._follower: TrainingFollower | None = None
        self._opening: Timer | None = None
        self.status: RunStatus | None = None
        """What its files told last."""
        self._view: DemonstrationView | None = None
        self._problem = ""
        self._is_announced = False
        self._title, self._caption = TextRows(), TextRows()
        self._curve = CurveView(encoder=theme.encoder, palette=theme.palette)
        self._world = WorldView(lambda: theme.encoder, theme.palette)

    def compose(self) -> ComposeResult:
        yield self._title
        yield self._curve
        yield self._caption
        yield self._world

    def on_unmount(self) -> None:
        self.follow(None)

    def on_resize(self) -> None:
        self._show()

    def follow(self, run: TrainingRun | None) -> None:
        """Shows this run from now on; None ends the looking."""
        if run == self._run:
            return
        self._run = run
        if self._opening is not None:
            self._opening.stop()
            self._opening = None
        if self._follower is not None:  # it waits for its threads: not here
            threading.Thread(target=self._follower.close, name="closing", daemon=True).start()
            self._follower = None
        self.status = self._view = None
        self._problem = ""
        if run is not None:
            self._world.clear()
            self._curve.show(())
            self._opening = self.set_timer(REST_S, self._open)
        self._show()

    def _open(self) -> None:
        run = self._run
        if run is None:
            return

        def status_arrived(status: RunStatus) -> None:
            if self._run is run:
                self.status = status
                self._announce()

        def view_arrived(view: DemonstrationView) -> None:
            if self._run is run:
                self._view = view
                self._announce()

        def error_arrived(text: str) -> None:
            if self._run is run:
                self._problem = text
                self._announce()

        self._follower = TrainingFollower(
            run, on_status=status_arrived, on_view=view_arrived, on_error=error_arrived
        )
        self._follower.start()

    # In the threads behind: the newest wins, one announcement at a time is enough

    def _announce(self) -> None:
        if not self._is_announced:
            self._is_announced = True
            self.post_message(self.Arrived())

    def on_training_preview_arrived(self) -> None:
        self._is_announced = False
        self._show()

    def _show(self) -> None:
        run, width = self._run, self.size.width
        if run is None or not width:
            return
        status, view = self.status, self._view
        self._title.show(
            [row((run.name, "bold")) if status is None else training_rows.heading(run.name, status, width)]
        )
        if status is not None:
            self._curve.show(
                training_rows.curves(status, "success", self._curve.size.width),
                training_rows.axes(status, "success"),
            )
        if self._problem:
            self._caption.show([row((self._problem[:width], "warn"))])
        elif view is None:
            text = (
                "reading its policy ..."
                if run.best_policy.exists()
                else "no policy yet: it drives here after the first test"
            )
            self._caption.show([row((text[:width], "dim"))])
        else:
            self._caption.show([training_rows.caption(view, width)])
            self._world.offer(lambda: view.scene)
