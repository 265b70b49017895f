"""One level, driven by hand, a program or an agent against its ghosts; and the end of the drive, with what it earned."""

from __future__ import annotations

import math
import os
from asyncio import to_thread
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar, Final, Literal, TypeAlias

import numpy as np
from textual import events, work
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.message import Message
from textual.screen import ModalScreen

from kit.controllers import ControllerFile, find_controller
from kit.dialogue.actions import ScreenActions
from kit.dialogue.shared_actions import VIEW_IDS
from kit.document.rows import Row, row, spread
from kit.inspection.sockets import sockets_folder
from kit.plain_text import format_clock
from kit.render.roles import PEN_ROLES, Role
from kit.render.scene import PenStroke, Scene, SceneMark, ScenePath
from kit.run.animation import ExportError
from kit.run.laser_map import LaserMap, world_bounds
from kit.run.recording import Recorder, Recording
from kit.run.scenario import Scenario
from kit.run.session import Session
from kit.run.view import View
from kit.school.game.drive_records import DriveRecord, card_rows, record_drive, save_card, save_film
from kit.school.game.ghosts import Ghost, GhostComparison, Split, compare_tracks, gains_along
from kit.school.game.levels import GameLevel
from kit.school.game.medal import Medal, medal_of
from kit.school.game.needed import histogram, seconds_needed
from kit.school.game.player_progress import BY_HAND, DriverFacts
from kit.school.game.race import (
    DriverKind,
    RaceFinish,
    RaceReferee,
    open_race,
    race_from_all_starts,
    sensors_in_use,
)
from kit.school.game.references import reference_seconds
from kit.school.game.starts import OWN_SEED, film_scenario
from kit.school.lessons.shell_lines import shell_path
from kit.school.progress import ProgressError, ProgressJournal
from kit.tui.input.drive import DriveState
from kit.tui.input.drive_keys import drive_key, named
from kit.tui.rows import drive_end_rows, level_rows
from kit.tui.rows.key_rows import bindings, footer
from kit.tui.screens.dialogs import MessageDialog, wrapped
from kit.tui.screens.lesson_drive import RecordingScreen
from kit.tui.screens.level_pictures import ghost_paths, scene_of
from kit.tui.screens.watch import WatchScreen
from kit.tui.theme import Theme
from kit.tui.widgets.text_rows import TextRows
from kit.tui.widgets.world_view import WorldView
from kit.workspace import Workspace

if TYPE_CHECKING:
    from kit.learning.policies.policy import Policy


REVEAL_INTERVAL: Final = 0.3
"""Between two rows that appear [s]."""
BELL_VARIABLE: Final = "KIT_BELL"
"""If set to 1, the terminal's bell rings for a new medal."""
WIDTH: Final = 74
FINISH_WIDTH: Final = 40
FINISH_ROWS: Final = 3
"""Columns of the photo finish, and how many are in it."""
ROWS_AROUND: Final = 2
"""Of the result: a note and the keys."""
WIDE: Final = 110
"""Columns from which on the map stands beside the result."""
LEAST_MAP_ROWS: Final = 7
"""Of the map below the result; where there are fewer it is left out."""
HIGH: Final = 30
"""Rows from which on the medal is drawn."""
SPARKS: Final = 10
"""Pictures of a first gold's second of joy."""
SPARK_INTERVAL: Final = 0.1
"""Between two of them [s]."""
QUICKER, SLOWER = 0.005, 0.03
"""A part of a drive is coloured as quicker than the ghost from this gain on, as slower from this loss on [s]."""

Wish: TypeAlias = Literal["next", "restart", "back"]
"""What the player wants after a drive."""


@dataclass(frozen=True, slots=True, eq=False)
class DriveResult:
    """Everything that is shown of a drive that has ended."""

    level: GameLevel
    driver: DriverKind
    finish: RaceFinish
    record: DriveRecord
    recording: Recording
    ghosts: Sequence[Ghost]
    reference: float | None
    splits: Sequence[Split]
    finishes: Sequence[RaceFinish] = ()
    """Of a program's drives from all starts; the middle one counts."""


class DriveResultScreen(ModalScreen[Wish]):
    """What a drive earned, beside its map. A driving key that is still held does not close it."""

    screen_actions = ScreenActions("level result", ("next", "restart", "replay", "share", "back"))
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    DEFAULT_CSS = f"""
    DriveResultScreen {{ layout: vertical; }}
    DriveResultScreen > TextRows {{ width: 1fr; height: 1fr; }}
    DriveResultScreen > WorldView {{ display: none; }}
    DriveResultScreen.-wide {{ layout: horizontal; }}
    DriveResultScreen.-wide > TextRows {{ width: {WIDTH}; }}
    DriveResultScreen.-wide > WorldView {{ display: block; width: 1fr; }}
    DriveResultScreen.-high > TextRows {{ height: auto; }}
    DriveResultScreen.-high > WorldView {{ display: block; height: 1fr; }}
    """

    def __init__(self, theme: Theme, result: DriveResult, workspace: Workspace) -> None:
        super().__init__()
        self._theme = theme
        self._result = result
        self._workspace = workspace
        finish, record = result.finish, result.record
        self._fixed = [
            row((f" {result.level.title}, {result.driver.phrase}", "bold")),
            *wrapped(f" {drive_end_rows.finish_sentence(finish)}"),
            row(),
        ]
        self._before_finish = [
            *drive_end_rows.earned(result.level, finish, record),
            *level_rows.ladder_of_drive(finish, record, result.driver, result.reference),
            *level_rows.starts_rows(result.finishes, record.counts),
            *drive_end_rows.compared(finish, record, result.reference, result.ghosts),
            *drive_end_rows.sector_rows(result.splits),
        ]
        self._photo_finish = photo_finish(result)
        self._after_finish = drive_end_rows.won_besides(result.level, record)
        self._needed: list[Row] = []
        """What all players needed, once that is known."""
        self._shown = 0
        self._note: Row = ()
        self._spark = SPARKS if self._is_joyful and not theme.terminal.reduce_motion.value else 0
        self._world = WorldView(lambda: theme.encoder, theme.palette)

    @property
    def _is_joyful(self) -> bool:
        """Whether this is the first gold of its driver here, or better."""
        record = self._result.record
        return record.medal >= Medal.GOLD > record.previous_medal

    def compose(self) -> ComposeResult:
        yield TextRows()
        yield self._world

    def on_mount(self) -> None:
        self._show()
        record = self._result.record
        if os.environ.get(BELL_VARIABLE) == "1" and record.medal > max(Medal.NONE, record.previous_medal):
            self.app.bell()
        self._timer = self.set_interval(REVEAL_INTERVAL, self._reveal)
        if self._spark:
            self._sparks = self.set_interval(SPARK_INTERVAL, self._twinkle)
        self._draw_map()

    @work(exclusive=True, group="map")
    async def _draw_map(self) -> None:
        result = self._result
        self._world.show(await to_thread(scene_of_drive, result))
        if not result.finish.reached:
            return
        seconds = await to_thread(seconds_needed, result.level, result.driver)
        was_all_shown = self._shown >= len(self._revealed)
        self._needed = drive_end_rows.needed_rows(histogram(seconds, result.finish.seconds))
        if was_all_shown:
            self._shown = len(self._revealed)
        self._show()

    def _twinkle(self) -> None:
        self._spark -= 1
        if self._spark <= 0:
            self._sparks.stop()
        self._show()

    def _reveal(self) -> None:
        self._shown += 1
        if self._shown >= len(self._revealed):
            self._timer.stop()
        self._show()

    def on_resize(self, event: events.Resize) -> None:
        rows = len(self._fixed) + len(self._revealed) + len(self._medal) + ROWS_AROUND
        self.set_class(event.size.width >= WIDE, "-wide")
        self.set_class(event.size.width < WIDE and event.size.height >= rows + LEAST_MAP_ROWS, "-high")
        self._show()

    @property
    def _medal(self) -> list[Row]:
        """The medal as a drawing, where there is room for it."""
        has_room = self.app.size.height >= HIGH and self._result.record.medal is not Medal.NONE
        return drive_end_rows.medal_drawing(self._result.record.medal, self._spark) if has_room else []

    @property
    def _revealed(self) -> list[Row]:
        """The rows that appear one after the other; without the photo finish, and then what others needed, where they would
        push others off the screen."""
        room = self.app.size.height - len(self._fixed) - len(self._medal) - ROWS_AROUND
        for photo_finish, needed in ((self._photo_finish, self._needed), ([], self._needed)):
            rows = [*self._before_finish, *photo_finish, *self._after_finish, *needed]
            if len(rows) <= room:
                return rows
        return [*self._before_finish, *self._after_finish]

    def _show(self) -> None:
        without = () if self._result.finish.reached else ("next",)
        keys = footer(self.screen_actions, WIDTH - 4, without=without, keys={"next": "Enter"})
        revealed = self._revealed
        hidden = [row()] * max(0, len(revealed) - self._shown)  # what is below keeps its place
        rows = [*self._fixed, *self._medal, *revealed[: self._shown], *hidden, self._note or row(), keys]
        for text in self.query(TextRows):  # none where the kit is left meanwhile
            text.show(rows)

    # Keys

    def action_next(self) -> None:
        """First everything is shown, then the next level comes."""
        if self._shown < len(self._revealed):
            self._shown = len(self._revealed)
            self._timer.stop()
            self._show()
        elif self._result.finish.reached:
            self.dismiss("next")

    def action_restart(self) -> None:
        self.dismiss("restart")

    def action_back(self) -> None:
        self.dismiss("back")

    def action_replay(self) -> None:
        """The film of this drive."""
        result = self._result
        scenario = film_scenario(result.level, result.recording.seed)
        self.app.push_screen(RecordingScreen(self._theme, scenario, result.recording, result.driver.phrase))

    @work(exclusive=True, group="share")
    async def action_share(self) -> None:
        """Copies the card of this drive, and writes it and a moving picture as files."""
        result = self._result
        rows = card_rows(result.level, result.driver, result.finish, result.record.medal, result.recording)
        self.app.copy_to_clipboard("\n".join(rows))
        self._note = row((" Writing the moving picture ...", "dim"))
        self._show()
        try:
            card = await to_thread(save_card, self._workspace, result.level, result.driver, rows)
            film = await to_thread(save_film, card, result.level, result.recording)
            said = f"Copied to the terminal's clipboard.\nThe card: {shell_path(card)}\nThe moving picture: {shell_path(film)}"
        except (OSError, ExportError) as error:
            said = f"It could not be saved: {error}"
        self._note = ()
        self._show()
        shown = [*(row(each) for each in rows), row(), *wrapped(said)]
        self.app.push_screen(MessageDialog("A card to share", shown))


def scene_of_drive(result: DriveResult) -> Scene:
    """The level with the way of a drive, each part of it coloured by what it gained on the reference; without one plain."""
    scene = scene_of(result.level)
    reference = next((each for each in result.ghosts if each.name == "reference"), None)
    track = result.recording.track(result.level.find_scenario().partners[0])
    if reference is None or len(track) < 2:
        return replace(scene, paths=(ScenePath(track[::5, :2]),) if len(track) > 1 else ())
    strokes = tuple(
        PenStroke(np.array([[x, y], [to_x, to_y]]), gain_color(gain))
        for x, y, to_x, to_y, gain in gains_along(track, result.recording.step_size, reference)
    )
    return replace(scene, paths=tuple(ghost_paths(reference)), strokes=strokes)


def gain_color(gain: float) -> tuple[int, int, int]:
    """Green where a part of a drive was quicker than the ghost [s], yellow where about as quick, red where slower, white away
    from its way."""
    if math.isnan(gain):
        return PEN_ROLES[Role.PEN_WHITE]
    if gain > QUICKER:
        return PEN_ROLES[Role.PEN_GREEN]
    return PEN_ROLES[Role.PEN_YELLOW if gain > -SLOWER else Role.PEN_RED]


def photo_finish(result: DriveResult) -> list[Row]:
    """Where everybody was when the first one was at the goal: a line each, the goal at its right end."""
    mine = result.level.find_scenario().partners
    tracks = [
        ("you", result.finish.seconds, result.recording.track(mine[0])[:, :2], result.recording.step_size)
    ]
    own = {each.value: f"best {each.phrase}" for each in DriverKind}
    tracks += [
        (own.get(ghost.name, ghost.name), ghost.seconds, ghost.tracks[0][:, :2], ghost.step_size)
        for ghost in result.ghosts
        if ghost.tracks
    ]
    if not result.finish.reached or len(tracks) < 2:
        return []
    first = min(seconds for _, seconds, _, _ in tracks)
    rows: list[Row] = [row(("   where each was when the first one arrived", "dim"))]
    in_order = sorted(tracks, key=lambda each: each[1])
    shown = in_order[:FINISH_ROWS]
    for name, seconds, track, step in shown if tracks[0] in shown else [*shown[:-1], tracks[0]]:
        missing = 0.0
        if seconds > first:
            rest = track[min(round(first / step), len(track) - 1) :]
            missing = float(sum(((rest[1:] - rest[:-1]) ** 2).sum(axis=1) ** 0.5))
        column = FINISH_WIDTH - 1 - min(FINISH_WIDTH - 1, round(missing * 10.0))
        line = "." * column + ">" + " " * (FINISH_WIDTH - 1 - column) + "|"
        rows.append(
            row(f"   {name:<15.15} ", (line, "good" if name == "you" else "dim"), f" {missing:.2f} m")
        )
    return rows


ONE, TWO = "teleop", "teleop_pair"
LETTERS: Final = {"reference": "R", "keys": "K", "controller": "C", "agent": "A"}
LETTER_NOTES: Final = (
    ("R", "the reference"),
    ("K  C  A", "your best so far by hand, by program, by agent"),
    ("other letters", "classmates who have joined the leaderboard"),
    ("D", "a dock: stand still for a second to charge"),
)
SIGHT: Final = 1.5
"""Distance within which the target is drawn in fog [m]."""


class LeftError(Exception):
    """Nobody waits for the end of the race any more."""


class OtherStart(Message):
    """A program is driving from another start."""

    def __init__(self, number: int, seconds: float) -> None:
        super().__init__()
        self.number = number
        self.seconds = seconds


class DriveEnded(Message):
    """The drive has ended."""

    def __init__(
        self, finish: RaceFinish, record: DriveRecord | None, recording: Recording | None, problem: str
    ) -> None:
        super().__init__()
        self.finish = finish
        self.record = record
        self.recording = recording
        self.problem = problem


class LevelDrive(WatchScreen):
    """A letter shows where each ghost was at this time of its drive; its way is dotted.

    Leaves with ``next`` where the player wants the next level.
    """

    help_notes = (LETTER_NOTES,)
    shows_program = False
    screen_actions = ScreenActions(
        "level",
        ("drive_keys", "stop_robot", "restart", "pause", "help", "back"),
        ("ghosts", "agent_view", "laser_map", "share", "speed", "drive_mode", "zoom", *VIEW_IDS, "quit"),
        drives=True,
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)

    def __init__(
        self,
        theme: Theme,
        level: GameLevel,
        ghosts: Sequence[Ghost],
        journal: ProgressJournal,
        workspace: Workspace,
        *,
        driver: DriverKind = DriverKind.KEYS,
        program: ControllerFile | None = None,
        facts: DriverFacts = BY_HAND,
        agent: tuple[str, Policy] | None = None,
    ) -> None:
        """``program``: what drives; None: the keys do. ``agent``: name and policy, where the program is an agent."""
        super().__init__(
            theme, level.title, seed=OWN_SEED, socket_dir=sockets_folder(workspace.folder), records=True
        )
        self._theme = theme
        self._level = level
        self._ghosts = tuple(ghosts)
        self._reference = next((each for each in self._ghosts if each.name == "reference"), None)
        self._ghost_paths = tuple(way for ghost in self._ghosts for way in ghost_paths(ghost))
        self._with_ghosts = True
        self._progress = journal
        self._workspace = workspace
        self._driver = driver
        self._race_program = program
        self.agent_name, self._policy = agent or ("", None)
        self._facts = facts
        self._referee: RaceReferee | None = None
        self._recorder: Recorder | None = None
        self._comparison: GhostComparison | None = None
        self._behind: float | None = None
        self._is_over = False
        self._strength = 1.0
        self._result_row: Row = ()
        self._finishes: list[RaceFinish] = []
        """The ends of a program's drives from all starts."""
        self.wish: Wish = "back"

    @property
    def has_started(self) -> bool:
        return self._referee is not None

    def open_world(self) -> None:
        self._referee, self._is_over, self.view, self._result_row = None, False, None, ()
        self._recorder, self._behind = None, None
        self._comparison = None if self._reference is None else GhostComparison(self._reference)
        scenario = self._level.find_scenario()
        self._scenario: Scenario = scenario
        self._nothing_seen = LaserMap(world_bounds(scenario.world)).cells
        self._preview = RaceReferee(self._level, scenario).objective
        if self._race_program is not None:
            self.host.open_session(self._open_race, lambda session: self.host.pacing.factor)
            self.observe_agent()
        else:
            self.host.open(
                lambda: scenario, find_controller(TWO if len(scenario.partners) > 1 else ONE), paused=True
            )
        self.renew_laser_map(draws=self._level.conditions.fog)

    def _open_race(self) -> Session:
        """Opens the race in the helper thread, after the program has started and before the first tick."""
        assert self._race_program is not None  # else the keys drive
        session, self._referee, self._recorder = open_race(self._level, self._scenario, self._race_program)
        return session

    def is_drive_key(self, key: str) -> bool:
        found = drive_key(key)
        return self._race_program is None and found is not None and (found.moves or found.name == "space")

    def drive_keys_changed(self, messages: tuple[str, ...], state: DriveState) -> None:
        strength = max((push for name, push in state.held.items() if named(name).moves), default=1.0)
        if self.view is None or self._is_over or (not messages and strength == self._strength):
            return
        self._strength = strength
        if self._referee is None and any(message.startswith("p_") for message in messages):
            self._referee = referee = RaceReferee(self._level, self._scenario)
            self.host.post(lambda session: session.runner.observers.append(referee))
            self.host.resume_when_driven()
        self.host.post(lambda session: session.keys.publish(messages, strength))

    # What is shown

    def _panel_rows(self, view: View) -> tuple[Row, ...]:
        """On a large screen the level's card fills the rest of the panel."""
        rows = super()._panel_rows(view)
        if not self._is_large:
            return rows
        panel = self._rows("panel").size
        card = level_rows.level_card(
            self._level, self._driver, reference_seconds(self._level), panel.width - 2
        )
        return (*rows, *card[: max(0, panel.height - len(rows))])

    def _view_arrived(self, view: View) -> None:
        """In the world's thread: the level's targets and bumps take the place of those of the map's case."""
        referee = self._referee
        objective = self._preview if referee is None else referee.objective
        distance = objective.target_m
        is_hidden = self._level.conditions.fog and distance is not None and distance > SIGHT
        metrics = replace(
            view.metrics,
            bumps=view.metrics.bumps if referee is None else referee.finish.collisions,
            target_m=None if is_hidden else distance,
            reached_s=objective.reached_s,
        )
        scene = replace(view.scene, targets=objective.discs)
        super()._view_arrived(replace(view, metrics=metrics, scene=scene))

    def _newest_scene(self) -> Scene:
        scene = super()._newest_scene()
        if self.view is None:
            return scene
        docks = tuple(SceneMark(x, y, "D") for x, y in self._level.conditions.docks)
        if self._level.conditions.fog:
            scene = self._in_fog(scene)
        if not self._with_ghosts:
            return replace(scene, marks=docks)
        marks = ghost_marks(self._ghosts, self.view.time_s)
        paths = () if self._level.conditions.fog else self._ghost_paths
        return replace(scene, paths=(*paths, *scene.paths), marks=(*docks, *marks))

    def _in_fog(self, scene: Scene) -> Scene:
        """The scene as far as the laser has seen it: the map that the robot has drawn."""
        pose = self.view.pose if self.view is not None else None
        targets = tuple(
            disc for disc in scene.targets if pose is not None and math.dist(pose[:2], disc[:2]) <= SIGHT
        )
        cells = self.laser_cells or self._nothing_seen
        return replace(self.as_the_robot_knows_it(scene, cells), targets=targets)

    def _show(self) -> None:
        super()._show()
        view, referee = self.view, self._referee
        if view is None or not self.is_active:
            return
        if (
            referee is not None
            and view.pose is not None
            and self._comparison is not None
            and not self._is_over
        ):
            self._behind = self._comparison.add(view.time_s, view.pose.x, view.pose.y)
        self._rows("heading").show([self._heading(view.time_s)])
        if referee is None:
            ghosts = [f"{LETTERS.get(each.name, each.name)} {each.seconds:.1f} s" for each in self._ghosts]
            self._rows("messages").show(level_rows.before_the_start(self._level, ghosts, self.size.width))
        elif self._is_over:
            self._rows("messages").show([self._result_row])
        elif referee.is_over or (self._race_program is not None and view.failure is not None):
            self._is_over = True
            self.stop_driving()
            self.host.set_paused(True)
            self.host.post(self._end)

    def _heading(self, time_s: float) -> Row:
        """The level and its goal, bumps, the difference to the reference where the robot is now, and the clock."""
        referee = self._referee
        left = [(self._level.title, "bold")]
        if self._race_program is not None:
            left.append((f"  {self.agent_name or self._race_program.name} drives", "dim"))
        right: list[str | tuple[str, str]] = []
        if referee is not None:
            if referee.objective.progress:
                left.append((f"  {referee.objective.progress}", ""))
            if self._level.conditions.charge:
                right.append(f"battery {max(0.0, referee.battery.charge):.1f} m  ")
            if self._behind is not None:
                right += [(f"{self._behind:+.2f}", "good" if self._behind <= 0.0 else "warn"), " to R  "]
            right.append(f"bumps {referee.finish.collisions}  ")
        return spread(row(*left), row(*right, (format_clock(time_s), "bold")), self.size.width)

    def _end(self, session: Session) -> None:
        """Ends the drive in the world's thread, between two ticks: nothing moves any more."""
        recording = self.host.recording() if self._recorder is None else self._recorder.recording()
        assert self._referee is not None  # the drive had begun
        finish, record, problem = self._referee.finish, None, ""
        if self._race_program is not None:
            finish = replace(finish, failure=session.failure, sensors=sensors_in_use(session))
        if recording is not None:
            try:
                drives = self._other_starts((finish, recording))
                record = record_drive(
                    self._progress, self._workspace, self._level, self._driver, drives, self._facts
                )
                finish, recording = drives[record.counts]
                self._finishes = [each for each, _ in drives]
            except (ProgressError, LeftError) as error:
                problem = str(error)
        self.post_message(DriveEnded(finish, record, recording, problem))

    def _other_starts(self, first: tuple[RaceFinish, Recording]) -> list[tuple[RaceFinish, Recording]]:
        """A program's drives from all its starts, of which ``first`` was seen. Raises LeftError if nobody waits for them."""
        if self._race_program is None or self._facts.is_shipped:
            return [first]

        def note(number: int, seconds: float) -> None:
            if not self.is_attached:
                raise LeftError("The drive was left.")
            self.post_message(OtherStart(number, seconds))

        return race_from_all_starts(self._level, self._race_program, first=first, on_second=note)

    def on_other_start(self, event: OtherStart) -> None:
        self._result_row = level_rows.other_start(event.number, event.seconds)
        self._show()

    def on_drive_ended(self, event: DriveEnded) -> None:
        record, recording, finish = event.record, event.recording, event.finish
        if record is None or recording is None:
            self.app.push_screen(MessageDialog("The drive could not be saved", wrapped(event.problem)))
            return
        reference = reference_seconds(self._level)
        if finish.reached and reference is not None:
            self._behind = finish.seconds - reference  # as the result says it
            self._rows("heading").show([self._heading(finish.seconds)])
        medal = medal_of(finish, reference, self._driver)
        earned = (f" {medal.title}", level_rows.MEDAL_STYLES[medal]) if self._level.has_medals else ""
        self._result_row = row(earned, "  r restarts, Esc goes back to the levels.")
        track = recording.track(self._scenario.partners[0])
        has_splits = finish.reached and self._reference is not None
        splits = (
            compare_tracks(track, recording.step_size, self._reference, finish.seconds)
            if has_splits and self._reference is not None
            else ()
        )
        result = DriveResult(
            self._level,
            self._driver,
            finish,
            record,
            recording,
            self._ghosts,
            reference,
            splits,
            self._finishes,
        )
        self.app.push_screen(DriveResultScreen(self._theme, result, self._workspace), self._act_on)

    def _act_on(self, wish: Wish | None) -> None:
        """Does what the player chose in the dialog."""
        if wish == "restart":
            self.action_restart()
        elif wish is not None:
            self.wish = wish
            self.dismiss()

    # Keys

    def _show_keys(self) -> None:
        """Where a program drives, the keys that drive are left out."""
        if self._race_program is None:
            super()._show_keys()
            return
        without = ("drive_keys", "stop_robot", "quit")
        self._rows("keys").show([footer(self.screen_actions, self.size.width or 80, without=without)])

    def action_restart(self) -> None:
        """A new drive, recorded from its first tick."""
        self.stop_driving()
        self.open_world()

    def action_share(self) -> None:
        """The map that the robot has drawn, as files."""
        self.save_laser_map(self._workspace.folder / "cards", self._level.id)

    def action_ghosts(self) -> None:
        self._with_ghosts = not self._with_ghosts
        self._show()

    def action_pause(self) -> None:
        if self.has_started and not self._is_over:
            super().action_pause()

    def action_step(self) -> None:
        """Time is not for sale in a race."""

    def action_speed(self, key: str) -> None:
        """A program may be watched faster: its own clock is the world's."""
        if self._race_program is not None:
            super().action_speed(key)

    def action_back(self) -> None:
        self.dismiss()


def ghost_marks(ghosts: Sequence[Ghost], time_s: float) -> tuple[SceneMark, ...]:
    """The letters of ghosts, each where it was at this time of its drive [s]."""
    return tuple(
        SceneMark(x, y, LETTERS.get(ghost.name, ghost.name[:1].lower()))
        for ghost in ghosts
        for x, y, _ in ghost.poses_at(time_s)
    )
