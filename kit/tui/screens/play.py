"""Watch a robot, drive it, change what drives it: the screen the kit opens with."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import ClassVar, Final

from textual import work
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal
from textual.message import Message

from kit.controllers import ControllerFile, find, in_folder, shipped
from kit.live import MAXIMUM, REAL_TIME
from kit.picture.encode import Encoder
from kit.picture.roles import Palette
from kit.picture.scene import Scene
from kit.places import Place, find_place
from kit.session import Session
from kit.showing import View
from kit.tui.input.drive import DriveState
from kit.tui.input.keys import named
from kit.tui.input.screen import DriveScreen
from kit.tui.readout import PANEL_WIDTH, heading, readout, said
from kit.tui.running import Running
from kit.tui.screens.help import Help
from kit.tui.screens.picker import Choice, Picker
from kit.tui.screens.play_keys import HELP, KEYS
from kit.tui.terminal import TerminalDecision
from kit.tui.text_rows import TextRows, row
from kit.tui.world_view import WorldView
from kit.world.catalogue import all_maps

SPEEDS: Final = {"1": REAL_TIME, "2": 10.0, "3": MAXIMUM}
PANNED: Final = {"h": (-8, 0), "j": (0, -4), "k": (0, 4), "l": (8, 0)}
TELEOP: Final = "teleop"
MESSAGE_ROWS: Final = 2
LOOK_INTERVAL: Final = 0.5
"""Seconds between two looks at the controller's file while the world is paused."""


class NewView(Message):
    """The world's thread has a newer view."""


class Trouble(Message):
    """Something could not be done; ``text`` says what and why."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.text = text


class PlayScreen(DriveScreen):
    """The world, the figures beside it, what was said below, and the keys."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("p", "pause", "pause"),
        Binding("full_stop", "step", "one step"),
        *(Binding(key, f"speed('{key}')", show=False) for key in SPEEDS),
        *(Binding(key, f"pan('{key}')", show=False) for key in PANNED),
        Binding("plus,equals_sign", "zoom(1)", show=False),
        Binding("minus", "zoom(-1)", show=False),
        Binding("0", "fit", show=False),
        Binding("v", "follow", show=False),
        Binding("b", "beams", show=False),
        Binding("m", "maps", "map"),
        Binding("c", "controllers", "controller"),
        Binding("g", "hand_back", show=False),
        Binding("r", "reset", "reset"),
        Binding("x", "next_drive_mode", show=False),
        Binding("question_mark", "help", "help"),
        Binding("ctrl+c,ctrl+q", "app.quit", "leave", priority=True),
    ]
    DEFAULT_CSS = f"""
    PlayScreen {{ layout: vertical; }}
    PlayScreen #heading {{ height: 1; }}
    PlayScreen #middle {{ height: 1fr; }}
    PlayScreen #panel {{ width: {PANEL_WIDTH}; padding: 0 0 0 1; }}
    PlayScreen #said {{ height: {MESSAGE_ROWS}; }}
    PlayScreen #keys {{ height: 1; }}
    PlayScreen.-narrow #panel {{ display: none; }}
    """
    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (74, "-wide")]

    def __init__(
        self,
        place: str,
        controller: str,
        *,
        case: str | None = None,
        folder: Path,
        terminal: TerminalDecision,
        encoder: Encoder,
        palette: Palette,
        seed: int,
    ) -> None:
        super().__init__(terminal)
        self._folder = folder
        self._place_name = case or place
        self._find: Callable[[], Place] = partial(find_place, place, case)
        self._controller = find(controller, folder)
        self._before_takeover: ControllerFile | None = None
        self._world = WorldView(encoder, palette)
        self._view: View | None = None
        self._announced = False
        self._trouble: str | None = None
        self._beams = False
        self._strength = 1.0
        self._teleop = find(TELEOP)
        self._seed = seed
        self._behind: Running

    def compose(self) -> ComposeResult:
        yield TextRows(id="heading")
        with Horizontal(id="middle"):
            yield self._world
            yield TextRows(id="panel")
        yield TextRows(id="said")
        yield TextRows(id="keys")

    def on_mount(self) -> None:
        self._rows("keys").show([KEYS])
        self._rows("heading").show([row((f"opening {self._place_name} ...", "dim"))])
        self._behind = Running(on_view=self._view_arrived, on_trouble=self._trouble_arrived, seed=self._seed)
        self._behind.open(self._find, self._controller)
        self.set_interval(LOOK_INTERVAL, self._look_around)

    def on_unmount(self) -> None:
        self._behind.close()

    # What arrives from the world's threads

    def _view_arrived(self, view: View) -> None:
        self._view = view
        if not self._announced:  # the newest wins: one announcement at a time is enough
            self._announced = True
            self.post_message(NewView())

    def _trouble_arrived(self, text: str) -> None:
        self.post_message(Trouble(text))

    def on_new_view(self) -> None:
        self._announced = False
        self._show()

    def on_trouble(self, event: Trouble) -> None:
        self._trouble = event.text
        self._show()

    def on_cursor_position(self) -> None:
        self._world.answered()

    def on_resize(self) -> None:
        self._show()

    def mode_changed(self) -> None:
        self._show()

    def _look_around(self) -> None:
        """While the world stands still, files may be saved all the same."""
        if self._view is not None and self._view.paused:
            self._behind.wish(lambda session: None)

    def _show(self) -> None:
        width = self.size.width
        if self._trouble is not None:
            lines = self._trouble.splitlines()[:MESSAGE_ROWS]
            self._rows("said").show([row((line[:width], "bad")) for line in lines])
        view = self._view
        if view is None:
            return
        self._world.offer(self._newest_scene)
        self._rows("heading").show([heading(self._place_name, view, self._behind.pacing, width)])
        self._rows("panel").show(readout(view, self._drive_mode()))
        if self._trouble is None:
            self._rows("said").show(said(view, MESSAGE_ROWS, width))

    def _newest_scene(self) -> Scene:
        assert self._view is not None  # nothing is offered before the first view
        return self._view.scene

    def _rows(self, name: str) -> TextRows:
        return self.query_one(f"#{name}", TextRows)

    def _drive_mode(self) -> str:
        return self.drive.choice.mode

    # Keys

    def drove(self, messages: tuple[str, ...], state: DriveState) -> None:
        strength = max((push for name, push in state.held.items() if named(name).moves), default=1.0)
        moves = any(named(message[2:]).moves for message in messages if message.startswith("p_"))
        held = tuple(named(name).pressed for name in state.held)

        def press(session: Session) -> None:
            if moves and not session.keys.has_listener and session.controller != self._teleop:
                self._before_takeover = session.controller
                session.drive_with(self._teleop, then=lambda: session.keys.publish(held, strength))
            session.keys.publish(messages, strength)

        if messages or strength != self._strength:
            self._strength = strength
            self._behind.wish(press)

    def action_pause(self) -> None:
        paused = self._view is not None and self._view.paused
        if not paused:
            self.stop_driving()
        self._behind.set_paused(not paused)

    def action_step(self) -> None:
        if self._view is not None and not self._view.paused:
            self._behind.set_paused(True)
        else:
            self._behind.step()

    def action_speed(self, key: str) -> None:
        self._behind.set_factor(SPEEDS[key])

    def action_reset(self) -> None:
        self._trouble = None
        self._behind.wish(lambda session: session.reset())

    def action_hand_back(self) -> None:
        """The controller that drove before the keys took over drives again."""
        controller = self._before_takeover or self._controller
        self._behind.wish(lambda session: session.drive_with(controller))

    def action_pan(self, key: str) -> None:
        self._world.pan(*PANNED[key])

    def action_zoom(self, steps: int) -> None:
        self._world.zoom(steps)

    def action_fit(self) -> None:
        self._world.fit()

    def action_follow(self) -> None:
        self._world.follow(None if self._world.followed is not None else 0)

    def action_beams(self) -> None:
        self._beams = not self._beams
        self._behind.show_beams(self._beams)

    def action_help(self) -> None:
        self.app.push_screen(Help("Keys", HELP))

    @work
    async def action_maps(self) -> None:
        cards = {card.name: card for card in all_maps()}
        choices = [
            Choice(f"{card.name}/{case.name}", case.name if len(card.cases) > 1 else card.name, card.summary)
            for card in cards.values()
            for case in card.cases
        ]
        chosen = await self.app.push_screen_wait(Picker("Maps", choices))
        if chosen is not None:
            name, _, case = chosen.partition("/")
            self._place_name, self._find, self._trouble = (
                case if len(cards[name].cases) > 1 else name,
                partial(find_place, name, case),
                None,
            )
            self._behind.open(self._find, self._controller)

    @work
    async def action_controllers(self) -> None:
        files = {str(each.file): each for each in (*in_folder(self._folder), *shipped())}
        choices = [Choice(key, each.name, each.title) for key, each in files.items()]
        chosen = await self.app.push_screen_wait(Picker(f"Controllers; yours are in {self._folder}", choices))
        if chosen is not None:
            self._controller, self._before_takeover = files[chosen], None
            self._behind.wish(lambda session: session.drive_with(self._controller))
