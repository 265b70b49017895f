"""Two players in one world: the host's screen, which runs it, and the guest's, which only sees it and sends its keys."""

from __future__ import annotations

from asyncio import to_thread
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import ClassVar, Final

from textual import work
from textual.binding import BindingType
from textual.message import Message

from kit.controllers import ControllerFile
from kit.dialogue.actions import ScreenActions
from kit.dialogue.shared_actions import VIEW_IDS
from kit.document.rows import Row, row
from kit.geometry import Pose
from kit.plain_text import wrap
from kit.render.scene import Disc, Scene, ScenePath
from kit.run.recording import Recorder, Recording, save_recording
from kit.run.scenario import Scenario
from kit.run.scene_bodies import scene_bodies
from kit.run.session import Session
from kit.run.view import View
from kit.school.game.ghosts import Ghost, level_ghosts
from kit.school.game.league.tag_opponent import TagOpponent
from kit.school.game.levels import GameLevel, find_level
from kit.school.game.shared_server import SharedGameClient, SharedGameServer
from kit.school.game.shared_sockets import Audience
from kit.school.game.two_players import (
    SharedGame,
    SharedGameState,
    SharedMode,
    SharedPhase,
    shared_scenario,
)
from kit.sim.simulation import Simulation
from kit.tui.input.drive import DriveState
from kit.tui.rows.instrument_rows import LARGE_PANEL_WIDTH
from kit.tui.rows.key_rows import bindings
from kit.tui.rows.shared_game_rows import (
    HOST,
    RULES,
    RobotMotion,
    game_end,
    players_card,
    shared_heading,
    shared_message,
)
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.level_drive import LETTER_NOTES
from kit.tui.screens.level_pictures import ghost_marks, ghost_paths
from kit.tui.screens.watch import WatchScreen
from kit.tui.theme import Theme
from kit.workspace import Workspace

GUEST_PLAYER: Final = 1
NOT_OVER: Final = "The game is not over"
GIVES_UP: Final = row((f" {NOT_OVER}.", "bold"), " Once more: the key leaves it, and the other player wins.")
WARNED_S: Final = 5.0
"""For so long a key that leaves is waited for once more [s]."""
RULE_WIDTH: Final = 56
"""Columns of the rule on the page of keys."""
FOOTER: Final = ("drive_keys", "stop_robot", "restart", "help", "back", "quit")
OFF_FOOTER: Final = ("ghosts", "drive_mode", "zoom", *VIEW_IDS)
"""The actions of both players' screens."""


class SharedScreen(WatchScreen):
    """What both screens show: the game's state above and below the picture, and in a race the level's ghosts.

    Ghosts do not travel: each side has its own best drives and the kit's reference, which began where the host's robot does.
    """

    help_title = "Two players"
    has_card = True
    escape_leaves = True
    player: int | None = None
    """The player at this screen; None watches."""
    join_command = ""

    def __init__(self, theme: Theme, level: GameLevel, mode: SharedMode, workspace: Workspace | None) -> None:
        """``workspace``: whose best drives are ghosts; None: only the reference and classmates are. Raises CannotShare,
        LookupError and WorldError for a level that is not for two."""
        super().__init__(theme, level.title)
        self._level, self._mode, self._workspace = level, mode, workspace
        self._scenario = shared_scenario(level)
        self.state: SharedGameState | None = None
        self.ghosts: tuple[Ghost, ...] = ()
        """In a race those of the level, as soon as they are known."""
        self._ghost_paths: tuple[ScenePath, ...] = ()
        self._with_ghosts = True
        self.ended = ""
        """Why the game is over for this screen; empty while it goes on."""
        self.has_left = False
        """Whether this player has left a game that was not over."""
        self._has_warned = False
        """Whether it has just been said that a key leaves a game that is not over."""
        self._phase_of_keys: SharedPhase | None = None
        """For which the keys at the bottom are."""
        self._race_s = 0.0
        """How long the race has taken so far [s]; at its end it stands still."""

    def on_mount(self) -> None:  # besides the base class's, which Textual calls too
        if self._mode is SharedMode.RACE:
            self._load_ghosts()

    @work(group="ghosts")
    async def _load_ghosts(self) -> None:
        self.ghosts = await to_thread(level_ghosts, self._workspace, self._level)
        if not self._level.conditions.fog:
            self._ghost_paths = tuple(path for ghost in self.ghosts for path in ghost_paths(ghost))
        self._show()

    def _with_targets_and_ghosts(self, scene: Scene) -> Scene:
        """The scene, and in it the targets that are next, and where each ghost was at this time of its drive."""
        state, case = self.state, self._scenario.case
        if state is None or self._mode is SharedMode.TAG or case is None:
            standing = tuple(body for body in scene.bodies if not body.is_target)
            return replace(scene, targets=(), bodies=standing)
        places = state.next_targets(self._scenario.targets or (case.target,), self.player)
        scene = replace(scene, targets=tuple(Disc(x, y, case.target_radius) for x, y in places))
        if not self.ghosts or not self._with_ghosts:
            return scene
        if state.phase is not SharedPhase.OVER:
            self._race_s = state.seconds if state.phase is SharedPhase.RUNNING else 0.0
        marks = ghost_marks(self.ghosts, self._race_s)
        return replace(scene, paths=(*self._ghost_paths, *scene.paths), marks=(*scene.marks, *marks))

    @property
    def help_notes(self) -> tuple[tuple[tuple[str, str], ...], ...]:
        """The rule, and what is on the map."""
        robots = ("1  2", "on the map: the players' robots")
        letters = LETTER_NOTES[:3] if self._mode is SharedMode.RACE else ()
        lines = wrap(RULES[self._mode], RULE_WIDTH)
        rule = tuple((self._mode.value if line == lines[0] else "", line) for line in lines)
        return rule, (robots, *letters)

    @property
    def unavailable_actions(self) -> tuple[str, ...]:
        """Another game begins after one that is over, and only a race has ghosts."""
        phase = None if self.state is None else self.state.phase
        plays = self.player is not None and not self.ended
        again = () if phase is SharedPhase.OVER and plays else ("restart",)
        drives = () if plays else ("drive_keys", "stop_robot", "drive_mode")
        return (*drives, *again, *(() if self._mode is SharedMode.RACE else ("ghosts",)))

    def action_back(self) -> None:
        """Once says first that a game would be lost by it, which goes on meanwhile, in sight."""
        loses = bool(self.not_over) and self.loses_by_leaving
        if loses and not self._has_warned:
            self._has_warned = True
            self.set_timer(WARNED_S, self._forget_warning)
            self._show()
            return
        self.has_left = loses
        super().action_back()

    def _forget_warning(self) -> None:
        self._has_warned = False
        self._show()

    @property
    def not_over(self) -> str:
        runs = self.state is not None and self.state.phase is SharedPhase.RUNNING and not self.ended
        return NOT_OVER if runs and self.player is not None else ""

    @property
    def loses_by_leaving(self) -> bool:
        """Whether somebody else's game ends when this player leaves it."""
        return True

    @property
    def _is_over(self) -> bool:
        return self.state is not None and self.state.phase is SharedPhase.OVER

    @property
    def least_panel(self) -> int:
        """What is told of the end takes more room than a panel that goes on beside a game."""
        return LARGE_PANEL_WIDTH if self._is_over else super().least_panel

    @property
    def _leaving(self) -> str:
        """What Esc does after the end."""
        return "Esc goes back"

    def _told_of_players(self, width: int) -> list[Row]:
        """The players while they play, and how it ended."""
        if self.state is None:
            return []
        if self._is_over:
            return game_end(self._mode, self.state, self.player, width, self._leaving)
        return players_card(self._mode, self.state, self.player, width)

    def action_ghosts(self) -> None:
        self._with_ghosts = not self._with_ghosts
        self._show()

    def _show_state(self) -> None:
        state = self.state
        if not self.is_active:
            return
        if state is None:  # the world has not begun
            self._rows("heading").show([row((self._level.title, "title"), f"  {self._mode.value}")])
            return
        rows = shared_heading(self._level.title, self._mode, state, self.player, self.size.width)
        self._rows("heading").show([rows])
        told = shared_message(self._mode, state, self.player, self.join_command)
        if self._has_warned and self.not_over:
            told = GIVES_UP, *told[1:]
        if self._is_over and self.query_one("#panel").display:
            told = told[:1]  # the scores stand beside the picture
        self._rows("messages").show(told)
        if state.phase is not self._phase_of_keys:
            self._phase_of_keys = state.phase
            self._show_keys()


class SharedHostScreen(SharedScreen, inherit_bindings=False):
    """Runs the world, drives the first robot and lets guests in."""

    screen_actions = ScreenActions("hosted game", FOOTER, OFF_FOOTER, drives=True)
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)

    def __init__(
        self,
        theme: Theme,
        level: GameLevel,
        mode: SharedMode,
        name: str,
        folder: Path,
        audience: Audience,
        workspace: Workspace | None = None,
        program: ControllerFile | None = None,
    ) -> None:
        """``folder``: where hosts are found; see ``kit.school.game.shared_sockets``. ``name``: of the host's player.
        ``workspace``: as of ``SharedScreen``. ``program``: plays the second robot at tag, and nobody joins; None: a guest does."""
        super().__init__(theme, level, mode, workspace)
        self._player_name, self._folder, self._audience = name, folder, audience
        self._opposing = program
        self._opponent: TagOpponent | None = None
        self._game: SharedGame | None = None
        self._server: SharedGameServer | None = None
        self._phase = SharedPhase.WAITING
        self._recorder: Recorder | None = None
        self._film: Recording | None = None
        self.player = HOST

    def open_world(self) -> None:
        self.host.open_session(self._open, lambda session: 1.0)

    def _open(self) -> Session:
        """Opens the game; runs in the helper thread."""
        session = Session(self._scenario, always_scan=True)
        self._game = game = SharedGame(self._scenario, self._mode, session.runner)
        session.runner.observers.append(game)
        self.host.set_listener(self._publish)
        if self._opposing is not None:
            self._opponent = TagOpponent(session, game, self._opposing)
            return session
        try:
            self._server = SharedGameServer(
                self._folder, self._level.id, self._player_name, game, self._audience
            )
        except Exception:
            session.close()
            raise
        self.join_command = f"kit game guest {self._server.path.stem}"
        return session

    def _publish(self, session: Session) -> None:
        """Sends the state to the guest; runs in the world's thread, as often as there are views."""
        if self._game is not None and (self._server is not None or self._opposing is not None):
            state = self._game.state
            if self._server is not None:
                state = self._server.publish(state)
            elif self._opposing is not None:
                state = replace(state, names=(self._player_name, self._opposing.name))
            self.state = state
            if state.phase is not self._phase:
                self._phase = state.phase
                self._record_phase(session, state.phase)

    def _record_phase(self, session: Session, phase: SharedPhase) -> None:
        """The film begins with the countdown, from which on the world is as new, and ends when the game is over."""
        observers = session.runner.observers
        if phase is SharedPhase.OVER and self._recorder is not None:
            self._film = self._recorder.recording()
        if phase is not SharedPhase.RUNNING and self._recorder is not None:
            observers.remove(self._recorder)
            self._recorder = None
        if phase is SharedPhase.COUNTDOWN:
            session.reset()
            self._recorder = Recorder.for_scenario(session.scenario, session.runner.simulation)
            observers.insert(0, self._recorder)  # before the game, which hands on pushes at the end of a tick
            if self._opponent is not None:
                self._opponent.begin()

    def action_restart(self) -> None:
        """Another game, after one that is over."""
        game = self._game
        if game is not None:
            self.host.post(lambda session: game.rematch())

    @property
    def has_won(self) -> bool:
        """Whether this player has won a game here."""
        return self.state is not None and self.state.wins[HOST] > 0

    def save_film(self) -> Path | None:
        """Writes the recording of the last game that was over into the workspace, once the screen has been left, and returns its
        file; None where there is none. Raises OSError."""
        if self._film is None or self._workspace is None:
            return None
        file = self._workspace.recordings / f"{self._level.id}.{self._mode.value}.npz"
        file.parent.mkdir(exist_ok=True)
        save_recording(self._film, file)
        return file

    def drive_keys_changed(self, messages: tuple[str, ...], state: DriveState) -> None:
        if self._game is not None:
            self._game.push(HOST, state.linear, state.angular)

    def _show(self) -> None:
        super()._show()
        self._show_state()

    def _panel_rows(self, view: View) -> tuple[Row, ...]:
        """The players, and the robot's figures where there is room for both; tag has no target."""
        if self._mode is SharedMode.TAG:
            metrics = replace(view.metrics, target_m=None, reached_s=None)
            view = replace(view, metrics=metrics, scene=replace(view.scene, targets=()))
        return super()._panel_rows(view)

    def _card(self, width: int, room: int) -> list[Row]:
        return self._told_of_players(width)[:room]

    @property
    def _leaving(self) -> str:
        return "Esc goes back and keeps a recording of it" if self._workspace else super()._leaving

    def _newest_scene(self) -> Scene:
        return self._with_targets_and_ghosts(super()._newest_scene())

    def _show_state(self) -> None:
        super()._show_state()
        if self._opponent is not None and self._opponent.failure and self.is_active:
            told = wrap(f"The program has stopped: {self._opponent.failure}", self.size.width - 2, most=2)
            self._rows("messages").show([row((f" {line}", "bad")) for line in told])

    @property
    def loses_by_leaving(self) -> bool:
        return self._opposing is None

    def on_unmount(self) -> None:
        """A game that nobody has ended is kept as far as it was played: the terminal may have been closed, or the kit quit."""
        if self._phase is SharedPhase.RUNNING and self._recorder is not None:
            self._film = self._recorder.recording()
            with suppress(OSError):  # whoever can still be told is told by ``save_film``
                self.save_film()
        if self._server is not None:
            self._server.close()
        if self._opponent is not None:
            self._opponent.disconnect()  # or the world's thread would wait for a program that loops
            self.host.close()
            self._opponent.close()


class SharedStateArrived(Message):
    """The host has said how things stand."""


class SharedGameEnded(Message):
    """The connection is gone; ``reason`` says why."""

    def __init__(self, reason: str) -> None:
        super().__init__()
        self.reason = reason


class SharedGuestScreen(SharedScreen, inherit_bindings=False):
    """Shows what the host says, drawn from this machine's own files, and sends the keys of the second player."""

    screen_actions = ScreenActions("joined game", FOOTER, OFF_FOOTER, drives=True)
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)

    def __init__(self, theme: Theme, client: SharedGameClient, workspace: Workspace | None = None) -> None:
        """``workspace`` and what it raises: as of ``SharedScreen``."""
        offer = client.offer
        super().__init__(theme, find_level(offer.level), offer.mode, workspace)
        self._client = client
        self._shapes = _Shapes(self._scenario)
        self._announced_state = False
        self.player = GUEST_PLAYER if offer.plays else None
        self._motion = RobotMotion(HOST if self.player is None else self.player)

    def open_world(self) -> None:
        self._client.follow(self._state_arrived, lambda reason: self.post_message(SharedGameEnded(reason)))

    def _state_arrived(self, state: SharedGameState) -> None:
        """Keeps the newest state; called in the client's thread."""
        self.state = state
        self._motion.take(state)
        if not self._announced_state:
            self._announced_state = True
            self.post_message(SharedStateArrived())

    def on_shared_state_arrived(self) -> None:
        self._announced_state = False
        self._show()

    def on_shared_game_ended(self, event: SharedGameEnded) -> None:
        self.ended = event.reason
        self.stop_driving()
        self._show_keys()
        if self.state is None or self.state.phase is not SharedPhase.OVER:
            self.app.push_screen(MessageDialog("The game has ended", f"It ended: {event.reason}."))
        self._rows("messages").show([row((f" It ended: {event.reason}.", "warn"))])

    def is_drive_key(self, key: str) -> bool:
        """Whoever watches drives nothing."""
        return self.player is not None and super().is_drive_key(key)

    def drive_keys_changed(self, messages: tuple[str, ...], state: DriveState) -> None:
        if self.player is not None:
            self._client.push(state.linear, state.angular)

    def action_restart(self) -> None:
        """Asks for another game, after one that is over."""
        if self.player is not None and self.state is not None and self.state.phase is SharedPhase.OVER:
            self._client.ask_again()

    def _show(self) -> None:
        if self.state is not None and self.is_active and not self.ended:
            self.world.offer(self._newest_scene)
            self._show_state()
            self._fit_panel()
            panel = self._rows("panel")
            width, height = panel.content_size.width - 1, panel.content_size.height
            card = self._told_of_players(width)
            figures = self._motion.rows(width) if card else []
            panel.show([*figures, *card] if len(figures) + len(card) <= height else card)

    def _newest_scene(self) -> Scene:
        assert self.state is not None  # nothing is offered before the first state
        return self._with_targets_and_ghosts(self._shapes.scene(self.state))

    def on_unmount(self) -> None:
        self._client.close()


class _Shapes:
    """A level's walls and both robots' outlines, to be drawn where the host says they are."""

    def __init__(self, scenario: Scenario) -> None:
        simulation = Simulation(scenario.world)
        self._walls = scenario.world.wall_segments
        outlines = simulation.outlines()
        self._robots = tuple(
            (name, simulation.pose(name), tuple(each for each in outlines if each.model == name))
            for name in (scenario.robot or "", scenario.world.models[-1].name)
        )

    def scene(self, state: SharedGameState) -> Scene:
        """The world at this instant."""
        poses = {name: pose for (name, _, _), pose in zip(self._robots, state.poses, strict=True)}
        outlines = [
            replace(outline, points=_move_points(outline.points, start, poses[name]))
            for name, start, own in self._robots
            for outline in own
        ]
        return Scene(walls=self._walls, bodies=scene_bodies(outlines, poses, poses))


def _move_points(
    points: tuple[tuple[float, float], ...], start: Pose, pose: Pose
) -> tuple[tuple[float, float], ...]:
    """The points of a body that stood at ``start``, now that it stands at ``pose``."""
    local = [start.relative(Pose(x, y)) for x, y in points]
    return tuple(pose.transform_point(each.x, each.y) for each in local)
