"""Watch a world: the screen with the picture, the figures beside it, what was said below, and the keys."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING, ClassVar, Final

from textual.app import ComposeResult
from textual.containers import Horizontal
from textual.message import Message

from kit.dialogue.actions import ScreenActions
from kit.dialogue.shared_actions import ACTIONS
from kit.document.rows import Row, broken, row
from kit.kernels.compilation_progress import PROGRESS
from kit.run.pacing import MAXIMUM, REAL_TIME
from kit.tui.input.screen import DriveScreen
from kit.tui.rows.agent_rows import AGENT_WIDTH, agent_panel
from kit.tui.rows.instrument_rows import (
    CARD_WIDTH,
    CODE_WIDTH,
    MARGIN,
    Listing,
    PanelWidths,
    SpeedHistory,
    figure_rows,
    figures_below,
    instruments,
    panel_widths,
    plain_width,
    tells_messages,
    with_charts,
)
from kit.tui.rows.key_rows import footer
from kit.tui.rows.readout_rows import PANEL_WIDTH, failure_or_messages, heading, readout
from kit.tui.screens.dialogs import HelpDialog, MessageDialog
from kit.tui.session_host import SessionHost
from kit.tui.theme import Theme
from kit.tui.widgets.text_rows import RowsScreen, TextRows
from kit.tui.widgets.world_view import ErrorEvent, WorldView

if TYPE_CHECKING:
    from pathlib import Path

    from kit.arrays import FloatArray
    from kit.learning.policies.agent_view import AgentView
    from kit.learning.policies.policy import Policy
    from kit.render.scene import Scene, SceneCells
    from kit.run.laser_map import LaserMapper
    from kit.run.lockstep import Observer
    from kit.run.recording import Recording, RecordingStore
    from kit.run.session import Session
    from kit.run.view import View

SPEEDS: Final = {"1": REAL_TIME, "2": 10.0, "3": MAXIMUM}
PANNED: Final = {"h": (-8, 0), "j": (0, -4), "k": (0, 4), "l": (8, 0)}
MESSAGE_ROWS: Final = 2
ROWS_AROUND: Final = 2 + MESSAGE_ROWS
"""Of the picture: the heading, the messages and the keys."""
BREAKPOINTS: Final = [(0, "-narrow"), (74, "-wide"), (100, "-roomy")]
"""From which width on: without and with the figures beside the world, and with what an agent perceives beside both."""
LOADING_S: Final = 1.5
"""Seconds from which on a world that does not move yet says why."""
LOADING_EVERY_S: Final = 0.5
"""Seconds between two looks at how far that is."""
LOADING: Final = "Getting ready. The first time takes longer: code is compiled for this machine."
"""Seconds for which a notice stands in place of the messages."""
MAP_COLUMNS: Final = 70
MAP_ROWS: Final = 18
"""Size in characters of the robot's map, as it is shown before it is shared."""
POLL_INTERVAL: Final = 0.5
"""Seconds between two looks at the controller's file while the world is paused."""


class ViewChanged(Message):
    """The world's thread has a newer view."""


class WatchScreen(RowsScreen[None], DriveScreen):
    """What every screen with a running world has. Subclasses open a world and add what can be done in it."""

    screen_actions: ClassVar[ScreenActions]
    help_title: ClassVar[str] = "Keys"
    key_labels: ClassVar[Mapping[str, str]] = MappingProxyType({})
    """Words of the line at the bottom that differ from the actions', by id."""
    shows_mode = True
    """Whether keys drive here, so that the panel says how."""
    has_instruments: ClassVar[bool] = True
    """Whether a large screen has charts, messages and the program in its panel."""
    escape_leaves: ClassVar[bool] = False
    """Whether Esc ends the kit where there is no screen to go back to: no program of the student's hears it."""
    has_card: ClassVar[bool] = False
    """Whether the panel has a card as well: of a level, of two players."""

    DEFAULT_CSS = f"""
    WatchScreen {{ layout: vertical; }}
    WatchScreen #heading {{ height: 1; }}
    WatchScreen #middle {{ height: 1fr; }}
    WatchScreen #panel {{ width: {PANEL_WIDTH}; padding: 0 0 0 1; }}
    WatchScreen #messages {{ height: {MESSAGE_ROWS}; }}
    WatchScreen #keys {{ height: 1; }}
    WatchScreen #agent {{ width: {AGENT_WIDTH}; padding: 0 0 0 1; display: none; }}
    WatchScreen.-agent #agent {{ display: block; }}
    WatchScreen.-agent.-wide #panel {{ display: none; }}
    WatchScreen.-narrow #panel {{ display: none; }}
    """
    HORIZONTAL_BREAKPOINTS = BREAKPOINTS

    def __init__(
        self,
        theme: Theme,
        place_name: str,
        *,
        seed: int = 0,
        socket_dir: Path | None = None,
        records: bool = False,
        store: RecordingStore | None = None,
    ) -> None:
        """``socket_dir``: where other terminals find the world; see ``kit.inspection``. ``records``: the drive is kept.
        ``store``: where it is written as it goes on."""
        super().__init__(theme.terminal)
        self.place_name = place_name
        self.world = WorldView(lambda: theme.encoder, theme.palette)
        self.view: View | None = None
        self.driver_name = ""
        """What the title says drives, where no controller does."""
        self.length_s: float | None = None
        """Of what is replayed [s]."""
        self.host: SessionHost
        self._history = SpeedHistory()
        self._notice: Row | None = None
        self._tells_of_loading = False
        self._program: tuple[Path | None, Sequence[Row]] = (None, ())
        self._announced = False
        self._beams = (
            self.world.is_shaded
        )  # a lit floor costs next to nothing; lines of dots would hide the picture
        self._seed = seed
        self._socket_dir = socket_dir
        self._records = records or store is not None
        self._recording_store = store
        self.agent_name = ""
        """Name of the agent that drives; empty if none does."""
        self.agent_view: AgentView | None = None
        self._policy: Policy | None = None
        self._shows_agent = False
        self.shows_laser_map = False
        self.laser_cells: SceneCells | None = None
        """What the robot's laser has seen of the world; None before it has been asked for, and in a new world."""
        self._mapper: LaserMapper | None = None
        self._no_walls: FloatArray | None = None
        self._widths = PanelWidths()
        """Of the panel with instruments; nothing where it has none."""
        self._tells_messages = False
        """Whether the panel has the newest messages."""

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        with Horizontal(id="middle"):
            yield self.world
            yield TextRows(id="panel")
            yield TextRows(id="agent")
        yield TextRows(id="messages")
        yield TextRows(id="keys")

    def open_world(self) -> None:
        """Has ``host`` open what this screen is to show first."""

    def on_mount(self) -> None:
        self._show_keys()
        self._rows("heading").show([row((f"opening {self.place_name} ...", "dim"))])
        self.host = SessionHost(
            on_view=self._view_arrived,
            on_error=self._error_arrived,
            seed=self._seed,
            socket_dir=self._socket_dir,
            records=self._records,
            store=self._recording_store,
        )
        self.host.show_beams(self._beams)
        self.open_world()
        self.set_interval(POLL_INTERVAL, self._poll_files)

    def on_unmount(self) -> None:
        self.host.close()

    def recording(self) -> Recording | None:
        """The drive, once the screen has been left; None where none is kept, or no world was opened."""
        if not self._records or not hasattr(self, "host"):
            return None
        self.host.close()  # a second signal has ended the app with the world still running
        return self.host.recording()

    # The agent that drives

    def follow_agent(self, name: str, policy: Policy | None) -> None:
        """Has ``agent_view`` show what this policy perceives, in the world that is open by then; None: no agent drives."""
        self.agent_name, self._policy = name, policy
        self.observe_agent()

    def observe_agent(self) -> None:
        """Has the chosen agent observed in a world that was opened after it was chosen."""
        self.agent_view, policy = None, self._policy
        if policy is None:
            return

        def keep(view: AgentView) -> None:
            """Keeps it, in the world's thread; does nothing once another one drives."""
            if self._policy is policy:
                self.agent_view = view

        def make(session: Session) -> Observer:
            from kit.learning.policies.agent_view import AgentObserver

            scenario = session.scenario
            case = scenario.case
            return AgentObserver(
                policy,
                scenario.partners,
                keep,
                None if case is None else case.target,
                route=scenario.targets,
                radius=0.0 if case is None else case.target_radius,
                leader=scenario.leader,
                heading=scenario.target_heading or 0.0,
            )

        self.host.observe(make)

    # The map that the robot draws

    def renew_laser_map(self, *, draws: bool = False) -> None:
        """Begins with nothing in another world, where the map is shown already or ``draws``."""
        self.laser_cells = self._mapper = None
        self._no_walls = None  # another array, so that the picture is fitted again
        if draws or self.shows_laser_map:
            self._observe_laser_map()

    def _observe_laser_map(self) -> None:
        """Has the robot draw its map in the world that is open by then."""

        def make(session: Session) -> Observer:
            from kit.run.laser_map import LaserMapper  # of no use to the first frame

            def keep(cells: SceneCells) -> None:
                """Keeps it, in the world's thread; does nothing once another map is drawn."""
                if self._mapper is mapper:
                    self.laser_cells = cells

            self._mapper = mapper = LaserMapper(session.scenario.world, session.scenario.partners, keep)
            return mapper

        self.host.observe(make)

    def as_the_robot_knows_it(self, scene: Scene, cells: SceneCells) -> Scene:
        """The scene with the robot's map in place of walls and of everything that is not a robot."""
        import numpy as np

        if self._no_walls is None:
            self._no_walls = np.empty((0, 4))
        robots = tuple(body for body in scene.bodies if body.is_robot)
        return replace(scene, walls=self._no_walls, bodies=robots, cells=cells)

    def save_laser_map(self, folder: Path, name: str) -> None:
        """Saves the robot's map as files and shows it; says how to begin one where there is none."""
        from kit.render.scene import Scene
        from kit.render.world_text import scene_rows
        from kit.run.laser_map import save_laser_map

        cells, view = self.laser_cells, self.view
        if cells is None or view is None:
            text = f"There is no map yet: {ACTIONS['laser_map'].keys} has the robot draw one."
            self.app.push_screen(MessageDialog("The robot's map", text))
            return
        scene = self.as_the_robot_knows_it(Scene(walls=view.scene.walls, trails=view.scene.trails), cells)
        try:
            saved = save_laser_map(cells, folder, name)
            text = (
                f"Saved as {saved.image.name}, and {saved.layer.name} for ROS's map_server and for a layer of a world, "
                f"in {folder}"
            )
        except OSError as error:
            text = f"It could not be saved: {error.strerror}."
        columns = max(1, min(MAP_COLUMNS, self.size.width - 4))
        told = broken(row(text), columns)
        rows_left = self.size.height - len(told) - 3  # the dialog's frame and a blank row
        picture = scene_rows(scene, columns, max(1, min(MAP_ROWS, rows_left)), self.world.encoder)
        self.app.push_screen(
            MessageDialog("The robot's map", [*(row(each) for each in picture), row(), *told])
        )

    # What arrives from the world's threads

    def _view_arrived(self, view: View) -> None:
        self.view = view
        if not self._announced:  # the newest wins: one announcement at a time is enough
            self._announced = True
            self.post_message(ViewChanged())

    def _error_arrived(self, text: str) -> None:
        self.post_message(ErrorEvent(text))

    def on_view_changed(self) -> None:
        self._announced = False
        if self._tells_of_loading and not self._is_loading:
            self._tells_of_loading, self._notice = False, None
        elif self._is_loading:
            self.set_timer(LOADING_S, self._tell_of_loading)
        self._show()

    @property
    def _is_loading(self) -> bool:
        """Whether the world is shown and its first tick has not ended: it loads the kernels, or compiles them."""
        return self.view is not None and self.view.tick == 0 and not self.view.paused

    def _tell_of_loading(self) -> None:
        if self._is_loading:
            self._tells_of_loading = True
            self._notice = row((PROGRESS.text or LOADING, "dim"))
            self._show()
            self.set_timer(LOADING_EVERY_S, self._tell_of_loading)

    def message_rows(self, view: View) -> tuple[Row, ...]:
        """The rows below the picture."""
        if self._notice is not None:
            return (self._notice,)
        if self._tells_messages and view.failure is None:
            return ()
        return failure_or_messages(view, MESSAGE_ROWS, self.size.width)

    def on_error_event(self, event: ErrorEvent) -> None:
        self.app.push_screen(MessageDialog("That did not work", event.text))
        if self.view is None:
            self._rows("heading").show([row(("nothing is open", "dim"))])

    def on_resize(self) -> None:
        self._fit_panel()
        self._show_keys()
        self._show()

    def on_screen_resume(self) -> None:
        self._show()

    def drive_status_changed(self) -> None:
        self._show()

    def _poll_files(self) -> None:
        """Checks the files also while the world stands still: they may be saved all the same."""
        if self.view is not None and self.view.paused:
            self.host.post(_do_nothing)

    def _show(self) -> None:
        width = self.size.width
        view = self.view
        if view is None or not self.is_current:
            return
        self._fit_panel()
        self.world.offer(self._newest_scene)
        self._rows("heading").show([heading(view, self.host.pacing, width, self.driver_name, self.length_s)])
        panel = self._panel_rows(view)
        self._rows("panel").show(panel)
        self._tells_messages = self._widths.total > 0 and tells_messages(panel)
        self._rows("messages").show(self.message_rows(view))
        self._show_agent(view)

    def _show_agent(self, view: View) -> None:
        if not self._shows_agent:
            return
        panel, agent = self._rows("agent"), self.agent_view
        if agent is None:
            panel.show([row(("no agent drives", "dim"))])
            return
        about = (("agent", self.agent_name), ("environment", view.title))
        panel.show(agent_panel(agent, about, *panel.content_size))

    def _fit_panel(self) -> None:
        """Gives the panel what the picture does not need of the screen."""
        if not self.has_instruments:
            return
        bounds = None if self.view is None else self.view.scene.bounds
        shape = math.inf if bounds is None else bounds.width / bounds.height
        has_program = self.view is not None and self.view.program is not None and self.shows_program
        wanted = CARD_WIDTH if self.has_card else CODE_WIDTH if has_program else 0
        widths = panel_widths(*self.size, shape, wanted)
        if self.has_card and not widths.total:
            plain = plain_width(self.size.width, self.size.height - ROWS_AROUND, shape)
            widths = replace(widths, plain=max(self.least_panel, plain))
        if widths != self._widths:
            self._widths = widths
            self.query_one("#panel").styles.width = widths.total + MARGIN if widths.total else widths.plain

    @property
    def least_panel(self) -> int:
        """Columns of a panel without instruments, with its margin."""
        return PANEL_WIDTH

    def _panel_rows(self, view: View) -> tuple[Row, ...]:
        mode = self.drive.mode_name if self.shows_mode else None
        self._history.add(view)
        panel, widths = self._rows("panel").content_size, self._widths
        title, figures = self._figures(view, mode)
        if not widths.total:
            width, height = panel.width - 1, panel.height
            if self.has_card:
                card = self._card(width, height)
                return (*card, *figures_below(figures, width, height - len(card)))
            return tuple(
                with_charts(view, self._history, figures, (width, height))
                if self.has_instruments
                else figures
            )
        figures = figure_rows(title, figures, widths.instruments)
        card = self._card(widths.card, panel.height - (0 if widths.beside else len(figures)))
        if view.program != self._program[0]:
            self._program = view.program, _lines_of(view.program)
        program = Listing(self._program[1] if self.shows_program else (), self.program_note)
        return instruments(view, self._history, figures, program, card, widths, panel.height)

    @property
    def shows_program(self) -> bool:
        """Whether the program's code fills the rest of a large screen's panel."""
        return True

    @property
    def program_note(self) -> str:
        """What is said beside the program's name."""
        return "^E edits it"

    def _figures(self, view: View, mode: str | None) -> tuple[str, Sequence[Row]]:
        """What the panel begins with and its title, which a large screen shows. ``mode``: how keys drive; None: they do not."""
        return "robot", readout(view, mode)

    def _card(self, width: int, room: int) -> list[Row]:
        """The panel's card: below the figures of a large screen, where charts and the program get the room that it leaves, else
        above them. ``room``: rows."""
        return []

    def _newest_scene(self) -> Scene:
        assert self.view is not None  # nothing is offered before the first view
        scene, agent = self.view.scene, self.agent_view
        if self._shows_agent and agent is not None:
            scene = replace(scene, paths=(*scene.paths, *agent.sight))
        if self.shows_laser_map and self.laser_cells is not None:
            scene = self.as_the_robot_knows_it(scene, self.laser_cells)
        return scene

    # Keys

    def _show_keys(self) -> None:
        without = ("quit" if self._has_way_back else "back", *self.unavailable_actions)
        line = footer(self.screen_actions, self.size.width or 80, without=without, labels=self.key_labels)
        self._rows("keys").show([line])

    @property
    def help_notes(self) -> tuple[tuple[tuple[str, str], ...], ...]:
        """Blocks of signs and terms below the keys on the help page."""
        return ()

    @property
    def unavailable_actions(self) -> tuple[str, ...]:
        """What does nothing here."""
        return ()

    @property
    def not_over(self) -> str:
        """What has begun here and would end if the screen were left, as a sentence; empty: nothing."""
        return ""

    def is_drive_key(self, key: str) -> bool:
        """Esc goes back where there is a screen to go back to; else it is a key for the student's nodes."""
        return super().is_drive_key(key) and not (key == "escape" and self._has_way_back)

    @property
    def _is_above_another(self) -> bool:
        """Whether there is a screen to go back to."""
        return len(self.app.screen_stack) > 2

    @property
    def _has_way_back(self) -> bool:
        return self._is_above_another or self.escape_leaves

    def action_back(self) -> None:
        if self._is_above_another:
            self.dismiss()
        elif self.escape_leaves:
            self.app.exit()

    def action_pause(self) -> None:
        paused = self.view is not None and self.view.paused
        if not paused:
            self.stop_driving()
        self.host.set_paused(not paused)

    def action_step(self) -> None:
        if self.view is not None and not self.view.paused:
            self.host.set_paused(True)
        else:
            self.host.step()

    def action_speed(self, key: str) -> None:
        self.host.set_factor(SPEEDS[key])

    def action_restart(self) -> None:
        self.host.post(lambda session: session.reset())

    def action_pan(self, key: str) -> None:
        self.world.pan(*PANNED[key])

    def action_zoom(self, steps: int) -> None:
        self.world.zoom(steps)

    def action_fit(self) -> None:
        self.world.fit()

    def action_follow(self) -> None:
        self.world.follow(None if self.world.followed is not None else 0)

    def action_beams(self) -> None:
        self._beams = not self._beams
        self.host.show_beams(self._beams)

    def action_laser_map(self) -> None:
        """The robot's own map in place of the world, or the world again; it goes on being drawn unseen."""
        self.shows_laser_map = not self.shows_laser_map
        if self._mapper is None:
            self._observe_laser_map()
        self._show()

    def action_agent_view(self) -> None:
        self._shows_agent = not self._shows_agent
        self.set_class(self._shows_agent, "-agent")
        self.call_after_refresh(self._show)  # when everything has its new size

    def action_help(self) -> None:
        without = (*(() if self._has_way_back else ("back",)), *self.unavailable_actions)
        self.app.push_screen(
            HelpDialog(self.help_title, self.screen_actions, *self.help_notes, without=without)
        )


def _lines_of(file: Path | None) -> Sequence[Row]:
    """A program in colours."""
    from kit.tui.widgets.program_colours import LANGUAGES, coloured_rows  # of no use to the first frame

    try:
        lines = [] if file is None else file.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return ()
    language = None if file is None else LANGUAGES.get(file.suffix)
    return coloured_rows([line.expandtabs(4) for line in lines], language)


def _do_nothing(session: Session) -> None:
    """Changes nothing: a request that only refreshes the picture of the world."""
