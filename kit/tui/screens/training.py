"""The screen that watches a training: its newest policy driving and its charts; pause, stop, go on."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar, Final

from textual import work
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.containers import Horizontal, Vertical
from textual.message import Message

from kit.dialogue.actions import ScreenActions
from kit.dialogue.screen_action import letter
from kit.document.rows import row
from kit.render.scene import Scene
from kit.tui.rows import training_rows
from kit.tui.rows.agent_rows import AGENT_WIDTH
from kit.tui.rows.key_rows import bindings
from kit.tui.screens.dialogs import HelpDialog, MessageDialog
from kit.tui.screens.picker import Picker, PickerItem
from kit.tui.theme import Theme
from kit.tui.training_follower import TrainingFollower
from kit.tui.widgets.chart_view import CurveView, StackedChartView
from kit.tui.widgets.text_rows import RowsScreen, TextRows
from kit.tui.widgets.world_view import ErrorEvent, WorldView

if TYPE_CHECKING:
    from kit.learning.training.demonstration import DemonstrationView
    from kit.learning.training.run_status import RunStatus
    from kit.learning.training.runs import TrainingRun


ALL: Final = ""
"""The choice of all cases, one after the other."""
PARTS: Final = (
    ("the curve", "success, dashed: the goal; tests on fresh episodes"),
    ("the columns", "how the episodes of each batch in training ended"),
    ("the robot", "has the newest policy; after the training, the best"),
    ("arcs, lines", "with i: sectors and rays as the agent gets them"),
    ("train, test", "% reached: recently in training; in the last test"),
    ("Esc", "the training continues; `kit watch` opens this again"),
)
PANEL_ROWS: Final = 9
SIDE_WIDTH: Final = 48


class StatusChanged(Message):
    """Posted when the run's files have changed."""


class MomentChanged(Message):
    """Posted when the robot has moved."""


ROW_IDS = frozenset(
    ["heading", "figures", "agent_over", "caption", "agent_beside", "panel", "side", "note", "keys"]
)


class TrainingScreen(RowsScreen[None]):
    """One run. Draws what has changed: the figures twice a second at most, the robot as it drives."""

    AUTO_FOCUS = ""
    screen_actions = ScreenActions(
        "training",
        ("pause", "stop", "agent_view", "figures", "curve", "choose_map", "help", "back"),
        ("zoom", "next", "fit", "follow", "quit"),
        own=(
            letter("stop", "k", "stop", "stop the training; what it has learned is kept"),
            letter("figures", "Tab", "figures", "show the other figures: cases, reward by term", name="tab"),
            letter("curve", "y", "curve", "change the curve: success, reward, reward terms"),
        ),
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = f"""
    TrainingScreen {{ layout: vertical; }}
    TrainingScreen #heading, TrainingScreen #figures, TrainingScreen #caption {{ height: 1; }}
    TrainingScreen #note, TrainingScreen #keys {{ height: 1; }}
    TrainingScreen #middle {{ height: 1fr; }}
    TrainingScreen #left {{ width: 1fr; }}
    TrainingScreen #right {{ width: 1fr; padding: 0 0 0 1; }}
    TrainingScreen CurveView {{ height: 11fr; }}
    TrainingScreen StackedChartView {{ height: 9fr; }}
    TrainingScreen #scene {{ height: 1fr; }}
    TrainingScreen #agent_over {{ height: 1fr; display: none; }}
    TrainingScreen #agent_beside {{ width: {AGENT_WIDTH}; padding: 0 0 0 1; display: none; }}
    TrainingScreen.-agent.-roomy #agent_beside, TrainingScreen.-agent.-wide #agent_beside {{ display: block; }}
    TrainingScreen.-agent.-narrow #agent_over, TrainingScreen.-agent.-usual #agent_over {{ display: block; }}
    TrainingScreen.-agent.-narrow CurveView, TrainingScreen.-agent.-usual CurveView {{ display: none; }}
    TrainingScreen.-agent.-usual StackedChartView {{ display: none; }}
    TrainingScreen #panel {{ height: {PANEL_ROWS}; }}
    TrainingScreen #side {{ width: {SIDE_WIDTH}; padding: 0 0 0 2; display: none; }}
    TrainingScreen.-narrow #middle {{ layout: vertical; }}
    TrainingScreen.-narrow #left, TrainingScreen.-narrow #right {{ width: 1fr; height: 1fr; padding: 0; }}
    TrainingScreen.-narrow StackedChartView, TrainingScreen.-narrow #panel {{ display: none; }}
    TrainingScreen.-low StackedChartView, TrainingScreen.-low #panel {{ display: none; }}
    TrainingScreen.-wide #panel {{ display: none; }}
    TrainingScreen.-wide #side {{ display: block; }}
    """
    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (74, "-usual"), (100, "-roomy"), (140, "-wide")]  # noqa: RUF012 - Textual's own
    VERTICAL_BREAKPOINTS = [(0, "-low"), (20, "-high")]  # noqa: RUF012 - Textual's own

    def __init__(self, theme: Theme, run: TrainingRun) -> None:
        super().__init__()
        self.run_name = run.name
        self.status: RunStatus | None = None
        self.view: DemonstrationView | None = None
        ascii_only = theme.terminal.glyphs.value == "ascii"
        self._curve = CurveView(encoder=theme.encoder, palette=theme.palette)
        self._shares = StackedChartView(
            training_rows.ASCII_OUTCOMES if ascii_only else training_rows.OUTCOMES,
            theme.palette,
            theme.encoder.symbols,
            margin=training_rows.MARGIN,
        )
        self._world = WorldView(lambda: theme.encoder, theme.palette)
        self._follower = TrainingFollower(
            run,
            on_status=self._status_arrived,
            on_view=self._view_arrived,
            on_error=self._error_arrived,
        )
        self._announced: set[type[Message]] = set()
        self._page = 0
        self._kind = 0
        self._case = ALL
        self._shows_agent = False

    @property
    def state(self) -> str:
        """As ``kit.learning.training.training_summary.RunState``; new until the files have been read."""
        return "new" if self.status is None else self.status.summary.state

    @property
    def farewell(self) -> str:
        """How the run stands and how to come back, for the terminal that the screen was left to."""
        return training_rows.farewell(self.run_name, self.state)

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        yield TextRows(id="figures")
        with Horizontal(id="middle"):
            with Vertical(id="left"):
                yield TextRows(id="agent_over")
                yield self._curve
                yield self._shares
            with Vertical(id="right"):
                yield TextRows(id="caption")
                with Horizontal(id="scene"):
                    yield self._world
                    yield TextRows(id="agent_beside")
                yield TextRows(id="panel")
            yield TextRows(id="side")
        yield TextRows(id="note")
        yield TextRows(id="keys")

    def on_mount(self) -> None:
        self._rows("heading").show([row((self.run_name, "title"), ("  opening ...", "dim"))])
        self._rows("keys").show([training_rows.keys(self.screen_actions, self.state, self.size.width)])
        self._follower.start()

    def on_unmount(self) -> None:
        self._follower.close()

    # What arrives from the threads behind: the newest wins, one announcement at a time is enough

    def _status_arrived(self, status: RunStatus) -> None:
        self.status = status
        self._announce(StatusChanged())

    def _view_arrived(self, view: DemonstrationView) -> None:
        self.view = view
        self._announce(MomentChanged())

    def _error_arrived(self, text: str) -> None:
        self.post_message(ErrorEvent(text))

    def _announce(self, message: Message) -> None:
        if type(message) not in self._announced:
            self._announced.add(type(message))
            self.post_message(message)

    def on_status_changed(self) -> None:
        self._announced.discard(StatusChanged)
        self._show_status()

    def on_moment_changed(self) -> None:
        self._announced.discard(MomentChanged)
        self._show_moment()

    def on_error_event(self, event: ErrorEvent) -> None:
        self.app.push_screen(MessageDialog("That did not work", event.text))

    def on_resize(self) -> None:
        self.call_after_refresh(self._show)  # when everything has its new size

    def on_screen_resume(self) -> None:
        self._show()

    # What is shown

    def _show(self) -> None:
        self._show_status()
        self._show_moment()

    def _show_status(self) -> None:
        status, width = self.status, self.size.width
        if status is None or not self._can_show:
            return
        kinds = training_rows.curve_kinds(status)
        kind = kinds[self._kind % len(kinds)]
        self._rows("heading").show([training_rows.heading(self.run_name, status, width)])
        self._rows("figures").show([training_rows.figures(status, width)])
        self._rows("note").show([training_rows.note(self.run_name, status, width)])
        self._rows("keys").show([training_rows.keys(self.screen_actions, self.state, self.size.width)])
        self._curve.show(
            training_rows.curves(status, kind, self._curve.size.width), training_rows.axes(status, kind)
        )
        self._shares.show(training_rows.shares(status))
        pages = training_rows.pages(status, self._rows("panel").size.width, PANEL_ROWS)
        self._rows("panel").show(pages[self._page % len(pages)])
        side = self._rows("side").content_size
        self._rows("side").show(training_rows.pages(status, side.width, max(PANEL_ROWS, side.height))[0])

    @property
    def _can_show(self) -> bool:
        """Whether it is seen, with all its rows. News can arrive while it closes, when some of them are gone already."""
        return self.is_active and {each.id for each in self.query(TextRows)} >= ROW_IDS

    def _show_moment(self) -> None:
        if not self._can_show:
            return
        caption = self._rows("caption")
        if self.view is None:
            caption.show([row(("shown driving after its first test", "dim"))])
        else:
            caption.show([training_rows.caption(self.view, caption.size.width)])
            self._world.offer(self._newest_scene)
            for name in ("agent_over", "agent_beside") if self._shows_agent else ():
                panel = self._rows(name)
                if panel.display:
                    panel.show(training_rows.agent(self.run_name, self.view, *panel.content_size))

    def _newest_scene(self) -> Scene:
        assert self.view is not None  # nothing is offered before the first moment
        scene = self.view.scene
        return replace(scene, paths=(*scene.paths, *self.view.agent.sight)) if self._shows_agent else scene

    # Keys

    def action_pause(self) -> None:
        if self.state == "running":
            self._follower.send_order("pause")
        elif self.state == "paused":
            self._follower.send_order("go")
        elif self.state in ("stopped", "interrupted"):
            self._rows("note").show([row(("starting again ...", "dim"))])
            self._follower.resume()

    def action_stop(self) -> None:
        if self.state in ("running", "paused"):
            self._follower.send_order("stop")

    def action_figures(self) -> None:
        self._page += 1
        self._show_status()

    def action_agent_view(self) -> None:
        self._shows_agent = not self._shows_agent
        self.set_class(self._shows_agent, "-agent")
        self.call_after_refresh(self._show)  # when everything has its new size

    def action_curve(self) -> None:
        self._kind += 1
        self._show_status()

    @work
    async def action_choose_map(self) -> None:
        if self.status is not None:
            names = self.status.plan.cases
            choices = [
                PickerItem(ALL, "all", "one after the other"),
                *(PickerItem(name, name) for name in names),
            ]
            chosen = await self.app.push_screen_wait(Picker("Which case to drive", choices, self._case))
            if chosen is not None:
                self._case = chosen
                self._follower.show_case(chosen or None)

    def action_next(self) -> None:
        self._follower.skip_episode()

    def action_zoom(self, steps: int) -> None:
        self._world.zoom(steps)

    def action_fit(self) -> None:
        self._world.fit()

    def action_follow(self) -> None:
        self._world.follow(None if self._world.followed is not None else 0)

    def action_help(self) -> None:
        self.app.push_screen(HelpDialog("Training", self.screen_actions, PARTS))
