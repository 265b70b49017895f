"""Watch a training: its files read in one thread, its newest policy driving in another, and its charts; pause, stop, go on."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import replace
from queue import Empty, SimpleQueue
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
from kit.tui.rows import readout_rows, training_rows
from kit.tui.rows.key_rows import bindings
from kit.tui.screens.dialogs import HelpDialog, MessageDialog, Picker, PickerItem, wrapped
from kit.tui.theme import Theme
from kit.tui.widgets.chart_view import CurveView, StackedChartView
from kit.tui.widgets.text_rows import RowsScreen, TextRows
from kit.tui.widgets.world_view import ErrorEvent, WorldView

if TYPE_CHECKING:
    from kit.learning.training.demonstration import Demonstration, DemonstrationView
    from kit.learning.training.events import TrainingEvent
    from kit.learning.training.run_status import RunPlan, RunStatus
    from kit.learning.training.runs import RunCommand, TrainingRun


POLL_S: Final = 0.5
"""Between two looks at the run's files, which may lie on a slow network drive."""
HOLD_S: Final = 1.0
"""How long the end of an episode stands still, to be read."""


class TrainingFollower:
    """Callbacks are called in other threads."""

    def __init__(
        self,
        run: TrainingRun,
        *,
        on_status: Callable[[RunStatus], None],
        on_view: Callable[[DemonstrationView], None],
        on_error: Callable[[str], None],
    ) -> None:
        self._run = run
        self._on_status = on_status
        self._on_view = on_view
        self._on_error = on_error
        self._last_error = ""
        self._jobs: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self._closed = threading.Event()
        self._skip_requested = threading.Event()
        self._case: str | None = None
        self._has_ended = False
        self._reader = threading.Thread(target=self._read, name="reader", daemon=True)
        self._driver: threading.Thread | None = None

    def start(self) -> None:
        self._reader.start()

    def send_order(self, order: RunCommand) -> None:
        """Tells the learner, which obeys between two updates."""
        self._jobs.put(lambda: self._run.send_command(order))

    def resume(self) -> None:
        """Starts a learner that goes on where the last one left off."""

        def job() -> None:
            from kit.learning.training.worker import start_worker

            start_worker(self._run)

        self._jobs.put(job)

    def show_case(self, case: str | None) -> None:
        """The case to drive from now on; None: one after the other."""
        self._case = case
        self.skip_episode()

    def skip_episode(self) -> None:
        """Goes on to the next episode at once."""
        self._skip_requested.set()

    def close(self) -> None:
        """Ends the looking, not the training."""
        self._closed.set()
        self._skip_requested.set()
        self._jobs.put(None)
        for thread in (self._reader, self._driver):
            if thread is not None and thread.is_alive():
                thread.join(timeout=2)

    # The reader's thread

    def _read(self) -> None:
        from kit.learning.tasks.learning_task import UnknownTask
        from kit.learning.training.algorithms import UnknownAlgorithm
        from kit.learning.training.events import EventReader
        from kit.learning.training.run_config import RunError
        from kit.learning.training.run_status import RunTracker, plan_of_run

        try:
            plan = plan_of_run(self._run.config())
        except (RunError, UnknownTask, UnknownAlgorithm) as error:
            self._on_error(str(error))
            return
        tracker, reader, shown = RunTracker(plan), EventReader(self._run.events_file), None
        while not self._closed.is_set():
            try:
                # Asked first: whatever is written before the end is read below.
                present = self._run.is_active, self._run.read_command()
                new: list[TrainingEvent] = list(reader.read_new())
            except OSError as error:  # a network drive that is away comes back
                self._report_once(f"{self._run.folder}: {error.strerror}. Looking again.")
            else:
                for event in new:
                    tracker.add(event)
                self._has_ended = not present[0]
                if new or present != shown:
                    shown = present
                    self._on_status(tracker.status(alive=present[0], order=present[1]))
                if self._driver is None:
                    self._start_driver(plan)
            self._run_jobs()

    def _run_jobs(self) -> None:
        """Waits for one, but not for long."""
        from kit.learning.training.run_config import RunError

        try:
            job = self._jobs.get(timeout=POLL_S)
        except Empty:
            return
        if job is not None:
            try:
                job()
            except (RunError, OSError) as error:
                self._on_error(str(error))

    def _report_once(self, trouble: str) -> None:
        """Reports an error, once."""
        if trouble != self._last_error:
            self._last_error = trouble
            self._on_error(trouble)

    def _start_driver(self, plan: RunPlan) -> None:
        self._driver = threading.Thread(target=self._drive, args=(plan,), name="driver", daemon=True)
        self._driver.start()

    # The driver's thread

    def _drive(self, plan: RunPlan) -> None:
        from kit.learning.policies.policy import PolicyError
        from kit.learning.training.demonstration import Demonstration
        from kit.learning.training.run_config import RunError

        demonstration = Demonstration(self._run, greedy=plan.greedy)
        while not self._closed.is_set():
            self._skip_requested.clear()
            demonstration.case = self._case
            wait = POLL_S
            try:
                if demonstration.begin_episode(kept=self._has_ended):
                    self._drive_episode(demonstration)
                    wait = HOLD_S
            except (PolicyError, RunError, OSError) as error:
                self._report_once(str(error))
            self._skip_requested.wait(wait)

    def _drive_episode(self, demonstration: Demonstration) -> None:
        """One episode, as fast as the robot would drive."""
        due = time.monotonic()
        self._on_view(demonstration.view())
        while not demonstration.is_over:
            due = max(due + demonstration.step_time, time.monotonic())
            if self._skip_requested.wait(due - time.monotonic()) or self._closed.is_set():
                return
            demonstration.step()
            self._on_view(demonstration.view())


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
            letter("stop", "x", "stop", "stop the training; what it has learned is kept"),
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
    TrainingScreen #agent_beside {{ width: {readout_rows.AGENT_WIDTH}; padding: 0 0 0 1; display: none; }}
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
        """As ``kit.learning.training.runs.RunState``; new until the files have been read."""
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
        self._rows("heading").show([row((self.run_name, "bold"), ("  opening ...", "dim"))])
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
        self.app.push_screen(MessageDialog("That did not work", wrapped(event.text)))

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
