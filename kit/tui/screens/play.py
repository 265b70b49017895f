"""Drive a robot, and change what drives it: the screen the kit opens with."""

from __future__ import annotations

from asyncio import to_thread
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Final

from textual import work
from textual.binding import BindingType

from kit.controllers import ControllerFile, find_controller, kit_controllers, user_controllers
from kit.dialogue.actions import ScreenActions
from kit.dialogue.shared_actions import VIEW_IDS
from kit.tui.input.drive import DriveState
from kit.tui.input.drive_keys import named
from kit.tui.input.driver import key_driver
from kit.tui.rows.key_rows import bindings, key_row
from kit.tui.screens.agents import agent_items
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.picker import Picker, PickerItem
from kit.tui.screens.watch import WatchScreen
from kit.tui.theme import Theme
from kit.tui.widgets.world_view import FloorClicked
from kit.workspace import write_atomically

if TYPE_CHECKING:
    from kit.learning.policies.policy import Policy
    from kit.run.lockstep import Observer
    from kit.run.place_driver import PlaceDriver
    from kit.run.recording import RecordingStore
    from kit.run.scenario import Scenario
    from kit.run.session import Session
    from kit.tui.widgets.program_editor import ProgramEditor

TELEOP: Final = "teleop"
EDITOR_IDS: Final = frozenset(("editor", "save_program"))
EDITING: Final = "-editing"
"""The screen's class while the editor is beside the robot."""
AGENT: Final = "agent/"
"""Before a run's name in the list of controllers."""


class PlayScreen(WatchScreen):
    """The driving keys take over from the controller, as soon as one of them is pressed."""

    screen_actions = ScreenActions(
        "drive",
        (
            "drive_keys", "pause", "speed", "choose_map", "controllers", "nodes", "restart", "help", "back",
            "quit",
        ),
        (
            "editor", "save_program", "step", "trainings", "agent_view", "laser_map", "share", "hand_over",
            "drive_mode", "node_keys", "zoom", *VIEW_IDS,
        ),
        drives=True,
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = """
    PlayScreen ProgramEditor { display: none; }
    PlayScreen.-editing ProgramEditor { display: block; }
    PlayScreen.-editing #panel, PlayScreen.-editing #agent { display: none; }
    """

    def __init__(
        self,
        theme: Theme,
        place: str,
        controller: str,
        *,
        case: str | None = None,
        root: Path | None = None,
        folder: Path,
        runs: Path,
        seed: int = 0,
        socket_dir: Path | None = None,
        record: RecordingStore | None = None,
    ) -> None:
        super().__init__(theme, case or place, seed=seed, socket_dir=socket_dir, store=record)
        self._theme = theme
        self._runs = runs
        self._folder = folder
        self._find = partial(_find_scenario, place, case, root)
        self._controller = find_controller(controller, folder)
        self._before_takeover: ControllerFile | None = None
        self._teleop = find_controller(TELEOP)
        self._strength = 1.0
        self._place_driver: PlaceDriver | None = None
        self._editor: ProgramEditor | None = None
        self.draft_problem = ""
        """Why what was typed and not saved could not be kept, once the screen has been left."""
        self._editor_keys = {
            keys for each in self.screen_actions.records if each.id in EDITOR_IDS for keys, _ in each.bindings
        }

    def open_world(self) -> None:
        self.host.open(self._find, self._controller)
        self.observe_agent()
        self.renew_laser_map()

    def drive_keys_changed(self, messages: tuple[str, ...], state: DriveState) -> None:
        strength = max((push for name, push in state.held.items() if named(name).moves), default=1.0)
        if not messages and strength == self._strength:
            return
        self._strength = strength
        moves = any(named(message[2:]).moves for message in messages if message.startswith("p_"))

        def press(session: Session) -> None:
            if moves and not session.keys.has_listener and session.controller != self._teleop:
                self._before_takeover = session.controller
                session.drive_with(self._teleop)
            session.keys.publish(messages, strength)

        self.host.post(press)

    def action_hand_over(self) -> None:
        """The controller that drove before the keys took over drives again."""
        controller = self._before_takeover or self._controller
        self.host.drive_with(controller)

    def action_nodes(self) -> None:
        from kit.tui.screens.graph import GraphScreen  # of no use to the first frame

        if self.view is not None:
            self.app.push_screen(GraphScreen(self._theme, self.host, self.view.title))

    # The mouse

    def on_floor_clicked(self, event: FloorClicked) -> None:
        """Lets the robot drive to the place that was clicked."""
        if self._place_driver is not None:
            self._place_driver.cancel()
        if self._before_takeover is None and self.view is not None and self.view.controller is not None:
            self._before_takeover = self._controller
        self.follow_agent("", None)

        def make(session: Session) -> Observer:
            from kit.run.place_driver import PlaceDriver  # of no use to the first frame

            self._place_driver = driver = PlaceDriver(session, event.place)
            # This is not the world's thread, in which alone it may be changed.
            self.host.post(lambda session: session.drive_with(None))
            self.driver_name = "to where you clicked"
            return driver

        self.host.observe(make)

    # The editor

    def action_editor(self) -> None:
        """Opens the driving program beside the robot; in the editor, closes it."""
        if self._editor is not None and self._editor.area.has_focus:
            self._close_editor()
        else:
            self._open_editor()

    def _open_editor(self) -> None:
        from kit.tui.widgets.program_editor import (
            ProgramEditor,  # of no use to the first frame
            ProgramFile,
            ProgramFileError,
            editable_controller,
        )

        driving = self._before_takeover or self._controller
        try:
            controller = editable_controller(driving, self._folder, self._runs)
            if self._editor is None:
                self._editor = ProgramEditor(ProgramFile(controller.file))
                self.query_one("#middle").mount(self._editor)
            elif self._editor.program.file != controller.file:
                self._editor.open(controller.file)
        except ProgramFileError as error:
            self.app.push_screen(MessageDialog("This program cannot be edited here", str(error)))
            return
        if controller.file != driving.file:
            self.follow_agent("", None)
            self._drive_with(controller)
        self.stop_driving()
        self.add_class(EDITING)
        self.call_after_refresh(self._editor.area.focus)

    def _close_editor(self) -> None:
        self.remove_class(EDITING)
        self.set_focus(None)

    def action_save_program(self) -> None:
        if self._editor is not None and self.has_class(EDITING):
            self._editor.save()

    def on_program_saved(self) -> None:
        """The keys may have taken over: what was saved drives."""
        if self._before_takeover is not None:
            self.action_hand_over()
        self.host.post(_look_again)

    def on_editor_left(self) -> None:
        self.set_focus(None)

    def on_descendant_focus(self) -> None:
        """Keys are letters now: neither do they drive nor is their release of any use."""
        self._report_releases(False)
        self._show_keys()

    def on_descendant_blur(self) -> None:
        self._report_releases(self._terminal is None or bool(self._terminal.ask_keyboard.value))
        self._show_keys()

    def _show_keys(self) -> None:
        if self._editor is not None and self._editor.area.has_focus:
            self._rows("keys").show(
                [key_row(("^S", "save"), ("Esc", "drive"), ("^E", "close"), ("^P", "find"))]
            )
        else:
            super()._show_keys()

    def _report_releases(self, wanted: bool) -> None:
        driver = key_driver(self.app)
        if driver is not None:
            driver.report_releases(wanted)

    def is_drive_key(self, key: str) -> bool:
        """None while a text is being edited; E and S with Ctrl are the editor's."""
        return self.focused is None and key not in self._editor_keys and super().is_drive_key(key)

    def action_back(self) -> None:
        """Closes the editor if one is open, else the screen."""
        if self.has_class(EDITING):
            self._close_editor()
        else:
            super().action_back()

    def on_unmount(self) -> None:
        if self._editor is not None:
            self.draft_problem = self._editor.keep_draft()

    def _show(self) -> None:
        super()._show()
        if self._editor is not None and self.view is not None and self.has_class(EDITING):
            self._editor.show_failure(self.view.failure)

    def _poll_files(self) -> None:
        super()._poll_files()
        if self._editor is not None:
            self._editor.follow_file()

    def action_share(self) -> None:
        """The map that the robot has drawn, as files."""
        name = self.place_name if self.view is None else self.view.title
        self.save_laser_map(self._folder.parent / "cards", Path(name).stem)

    @work
    async def action_choose_map(self) -> None:
        from kit.world.catalogue import all_maps

        cards = {card.name: card for card in all_maps()}
        choices = [
            PickerItem(
                f"{card.name}/{case.name}", case.name if len(card.cases) > 1 else card.name, card.summary
            )
            for card in cards.values()
            for case in card.cases
        ]
        chosen = await self.app.push_screen_wait(Picker("Maps", choices))
        if chosen is not None:
            name, _, case = chosen.partition("/")
            self._find = partial(_find_scenario, name, case)
            self.open_world()

    @work
    async def action_controllers(self) -> None:
        files = {str(each.file): each for each in (*user_controllers(self._folder), *kit_controllers())}
        choices = [PickerItem(key, each.name, each.title) for key, each in files.items()]
        agents = await to_thread(agent_items, self._runs, AGENT)
        title = f"Controllers; yours are in {self._folder}"
        chosen = await self.app.push_screen_wait(Picker(title, [*choices, *agents]))
        if chosen is None:
            return
        self.follow_agent("", None)
        if chosen.startswith(AGENT):
            await self._choose_agent(chosen.removeprefix(AGENT))
        else:
            self._drive_with(files[chosen])

    def _drive_with(self, controller: ControllerFile) -> None:
        self._controller, self._before_takeover = controller, None
        self.host.drive_with(controller)

    async def _choose_agent(self, name: str) -> None:
        """Lets the best policy of a run drive, as the node that it would be on a robot."""
        try:
            controller, policy = await to_thread(_write_agent, self._runs, name)
        except Exception as error:  # noqa: BLE001 - no policy yet, a damaged one, one that no node can be: all of it is told
            self.app.push_screen(MessageDialog("This agent cannot drive here", str(error)))
            return
        self._drive_with(controller)
        self.follow_agent(name, policy)

    @work
    async def action_trainings(self) -> None:
        from kit.tui.screens.trainings import TrainingsScreen  # of no use to the first frame

        running = self.view is not None and not self.view.paused
        self.host.set_paused(True)  # two worlds at once would take their time from the training
        await self.app.push_screen_wait(TrainingsScreen(self._theme, self._runs))
        self.host.set_paused(not running)


def _look_again(session: Session) -> None:
    """Has a saved file read at once."""
    session.poll()


def _write_agent(folder: Path, name: str) -> tuple[ControllerFile, Policy]:
    """The node of a run's best policy, kept in the run's folder. Raises RunError, PolicyError and OSError."""
    from kit.learning.policies.policy_node import format_policy_node
    from kit.learning.training.run_folders import find_run

    run = find_run(folder, name)
    policy = run.policy()
    file = run.folder / f"{name}.py"
    write_atomically(file, format_policy_node(policy).encode())
    return find_controller(str(file)), policy


def _find_scenario(name: str, case: str | None, root: Path | None = None) -> Scenario:
    """Called in the helper thread, which imports the physics while the frame is on the screen already."""
    from kit.run.scenario import find_scenario

    return find_scenario(name, case, root)
