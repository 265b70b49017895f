"""Shows what a launch file has started: its world, and the output of its programs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, ClassVar

from textual.binding import BindingType
from textual.message import Message

from kit.dialogue.actions import ScreenActions
from kit.dialogue.screen_action import ScreenAction
from kit.dialogue.shared_actions import VIEW_IDS
from kit.host.failure import StudentCodeError
from kit.inspection.sockets import sockets_folder, world_name
from kit.tui.input.drive import DriveState
from kit.tui.rows.key_rows import bindings
from kit.tui.screens.watch import WatchScreen
from kit.tui.theme import Theme
from kit.workspace import Workspace
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from kit.launch.launch_file_process import LaunchTarget
    from kit.launch.launch_run import Launch, LaunchOutputLine
    from kit.launch.plain_launch import LaunchSession
    from kit.run.session import Session


class LaunchRefused(Message):
    """The launch cannot be carried out."""


class LaunchScreen(WatchScreen):
    """The launch file's programs drive; keys reach those that listen to them."""

    screen_actions = ScreenActions(
        "launch",
        ("program_keys", "pause", "step", "speed", "nodes", "restart", "zoom", "help", "back", "quit"),
        ("node_keys", "drive_mode", *VIEW_IDS),
        own=(
            ScreenAction("program_keys", "arrows W A S D", "keys", "send keys to programs that listen to /teleopkeys", (), "←↑↓→"),
        ),
        drives=True,
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)

    def __init__(
        self,
        theme: Theme,
        target: LaunchTarget,
        arguments: Mapping[str, str],
        *,
        workspace: Workspace,
        seed: int = 0,
        speed: float | None = None,
    ) -> None:
        self._name = target.name
        super().__init__(theme, self._name, seed=seed, socket_dir=sockets_folder(workspace.folder))
        self.driver_name = "driven by what it starts"
        self._theme = theme
        self._target, self._arguments, self._workspace, self._speed = target, arguments, workspace, speed
        self._launch: Launch | None = None
        self._session: LaunchSession | None = None
        self._early: list[LaunchOutputLine] = []
        self._strength = 1.0
        self.refusal: str | None = None
        """Why the launch could not be carried out."""
        self.has_no_world = False
        """Whether the launch file starts no world, so that there is nothing to see."""

    @property
    def failures(self) -> list[str]:
        """What has gone wrong with the launch's programs."""
        return [] if self._launch is None else self._launch.failures

    def open_world(self) -> None:
        self.host.open_session(self._open, self._factor)

    def drive_keys_changed(self, messages: tuple[str, ...], state: DriveState) -> None:
        strength = max(state.held.values(), default=1.0)
        if messages or strength != self._strength:
            self._strength = strength
            self.host.post(lambda session: session.keys.publish(messages, strength))

    def on_launch_refused(self) -> None:
        self.app.exit()

    def action_nodes(self) -> None:
        from kit.tui.screens.graph import GraphScreen  # of no use to the first frame

        if self.view is not None:
            self.app.push_screen(GraphScreen(self._theme, self.host, self.place_name))

    # In the helper's thread

    def _open(self) -> Session:
        from kit.launch.launch_run import Launch
        from kit.launch.plain_launch import LaunchSession
        from kit.launch.processes import ProcessStartError
        from kit.ros.graph.graph import Graph

        self._launch = launch = Launch(
            self._target,
            Graph(),
            arguments=self._arguments,
            seed=self._seed,
            workspace=self._workspace.folder,
            name=world_name(self._target.name),
            on_output=self._show_output,
        )
        try:
            launch.load()
            self.has_no_world = launch.world is None
            if not self.has_no_world:
                self._session = session = LaunchSession(launch, seed=self._seed, always_scan=True)
                for line in self._early:
                    self._show_output(line)
                launch.start_processes()
                return session
        except StudentCodeError as error:
            self.refusal = str(error.failure)
        except (ProcessStartError, WorldError, OSError) as problem:
            self.refusal = str(problem)
        launch.close()
        self.post_message(LaunchRefused())
        raise LookupError(self.refusal or "This launch file starts no world.")

    def _factor(self, session: Session) -> float:
        assert self._launch is not None
        assert self._launch.world is not None
        return self._speed or self._launch.world.factor

    def _show_output(self, line: LaunchOutputLine) -> None:
        if self._session is None:
            self._early.append(line)
        else:
            self._session.log_line(line.text, line.program)
