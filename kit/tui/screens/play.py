"""Drive a robot, and change what drives it: the screen the kit opens with."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Final

from textual import work
from textual.binding import BindingType

from kit.controllers import ControllerFile, find_controller, kit_controllers, user_controllers
from kit.tui.input.drive import DriveState
from kit.tui.input.keys import named
from kit.tui.rows.key_rows import bindings
from kit.tui.screens.picker import Picker, PickerItem
from kit.tui.screens.watch import WatchScreen
from kit.tui.theme import Theme
from kit.world.catalogue import all_maps

if TYPE_CHECKING:
    from kit.run.scenario import Scenario
    from kit.run.session import Session

TELEOP: Final = "teleop"


class PlayScreen(WatchScreen):
    """The driving keys take over from the controller, as soon as one of them is pressed."""

    name_of_actions = "drive"

    BINDINGS: ClassVar[list[BindingType]] = bindings("drive")

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
        records: bool = False,
    ) -> None:
        super().__init__(theme, case or place, seed=seed, socket_dir=socket_dir, records=records)
        self._theme = theme
        self._runs = runs
        self._folder = folder
        self._find = partial(_find_scenario, place, case, root)
        self._controller = find_controller(controller, folder)
        self._before_takeover: ControllerFile | None = None
        self._teleop = find_controller(TELEOP)
        self._strength = 1.0

    def open_world(self) -> None:
        self.host.open(self._find, self._controller)

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

    @work
    async def action_choose_map(self) -> None:
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
            self.host.open(self._find, self._controller)

    @work
    async def action_controllers(self) -> None:
        files = {str(each.file): each for each in (*user_controllers(self._folder), *kit_controllers())}
        choices = [PickerItem(key, each.name, each.title) for key, each in files.items()]
        chosen = await self.app.push_screen_wait(Picker(f"Controllers; yours are in {self._folder}", choices))
        if chosen is not None:
            self._controller, self._before_takeover = files[chosen], None
            self.host.drive_with(self._controller)

    @work
    async def action_trainings(self) -> None:
        from kit.tui.screens.trainings import TrainingsScreen  # of no use to the first frame

        running = self.view is not None and not self.view.paused
        self.host.set_paused(True)  # two worlds at once would take their time from the training
        await self.app.push_screen_wait(TrainingsScreen(self._theme, self._runs))
        self.host.set_paused(not running)


def _find_scenario(name: str, case: str | None, root: Path | None = None) -> Scenario:
    """Called in the helper thread, which imports the physics while the frame is on the screen already."""
    from kit.run.scenario import find_scenario

    return find_scenario(name, case, root)
