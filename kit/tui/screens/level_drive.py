"""One level, driven by hand, a program or an agent against its ghosts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Final

from textual.binding import BindingType
from textual.message import Message

from kit.controllers import ControllerFile, find_controller
from kit.dialogue.actions import ScreenActions
from kit.dialogue.shared_actions import VIEW_IDS
from kit.document.rows import Row, at_both_edges, row, row_width
from kit.inspection.sockets import sockets_folder
from kit.plain_text import format_clock
from kit.render.scene import CellState, Scene, SceneMark
from kit.run.laser_map import LaserMap, world_bounds
from kit.run.recording import Recorder, Recording, RecordingError, save_recording
from kit.run.scenario import Scenario
from kit.run.session import Session
from kit.run.view import View
from kit.school.game.daily import DAILY_PREFIX, has_run
from kit.school.game.drive_records import DriveRecord, begin_run, record_drive
from kit.school.game.ghosts import (
    REFERENCE,
    Ghost,
    GhostComparison,
    compare_tracks,
    load_unfinished,
    unfinished_file,
)
from kit.school.game.levels import GameLevel
from kit.school.game.medal import medal_of
from kit.school.game.player_progress import BY_HAND, DriverFacts, facts_of_program, level_progress
from kit.school.game.race import (
    DriverKind,
    RaceFinish,
    RaceReferee,
    open_again,
    open_race,
    race_from_all_starts,
    sensors_in_use,
)
from kit.school.game.references import reference_seconds
from kit.school.game.starts import OWN_SEED
from kit.school.progress import EventKind, ProgressError, ProgressJournal
from kit.tui.input.drive import DriveState
from kit.tui.input.drive_keys import drive_key, named
from kit.tui.rows import level_rows
from kit.tui.rows.drive_end_rows import lead_rows, speed_rows
from kit.tui.rows.instrument_rows import TWO_COLUMNS
from kit.tui.rows.key_rows import bindings
from kit.tui.rows.ladder_rows import in_reach_row
from kit.tui.rows.level_card_rows import Standing, level_card
from kit.tui.rows.medal_signs import MEDAL_STYLES
from kit.tui.screens.dialogs import MessageDialog
from kit.tui.screens.file_editor import EditsFile, edit_file
from kit.tui.screens.level_pictures import (
    GHOST_LOOKS,
    company_of,
    ghost_driver,
    ghost_look,
    ghost_marks,
    ghost_paths,
    level_beside,
)
from kit.tui.screens.level_result import DriveResult, DriveResultScreen, Wish, speeds_along
from kit.tui.screens.watch import WatchScreen
from kit.tui.theme import Theme
from kit.tui.widgets.world_view import FloorClicked
from kit.workspace import Workspace

if TYPE_CHECKING:
    from kit.learning.policies.policy import Policy


ONE, TWO = "teleop", "teleop_pair"
EDITS: Final = "e edits it."
PACE: Final = GHOST_LOOKS[REFERENCE][0]
LETTER_NOTES: Final = (
    (f"on the map: {PACE}", "the reference, which sets the pace"),
    ("K  C  A", "your best so far by hand, by program, by agent"),
    ("other letters", "classmates who have joined the leaderboard"),
    ("D", "a dock: stand still for a second to charge"),
)
ROWS_OF_FIGURES: Final = {False: 7, True: 4}
"""Rows of a small panel that its card leaves to the robot's figures, which stand in one column or in two."""
LEAD_INTERVAL: Final = 0.2
"""Between two values of the curve of the lead [s]."""
SIGHT: Final = 1.5
"""Distance within which the target is drawn in fog [m]."""


class LeftError(Exception):
    """Nobody waits for the result any more: the screen was left."""


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


class LevelDrive(EditsFile, WatchScreen):
    """A letter shows where each ghost was at this time of its drive; its way is dotted.

    Leaves with ``next`` where the player wants the next level.
    """

    has_card = True
    screen_actions = ScreenActions(
        "level",
        ("drive_keys", "stop_robot", "restart", "edit_file", "pause", "speed", "help", "back"),
        ("editor", "ghosts", "agent_view", "laser_map", "share", "drive_mode", "zoom", *VIEW_IDS, "quit"),
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
        driver: DriverKind = DriverKind.HAND,
        program: ControllerFile | None = None,
        facts: DriverFacts = BY_HAND,
        agent: tuple[str, Policy] | None = None,
    ) -> None:
        """``program``: what drives; None: the keys do. ``facts``, ``agent``: what is known of an agent, and its name and policy,
        where the program is one."""
        super().__init__(
            theme, level.title, seed=OWN_SEED, socket_dir=sockets_folder(workspace.folder), records=True
        )
        self._theme = theme
        self._level = level
        self._ghosts = tuple(ghosts)
        self._reference = next((each for each in self._ghosts if each.name == "reference"), None)
        self._company = company_of(self._ghosts)
        self._ghost_paths = tuple(way for ghost in self._ghosts for way in ghost_paths(ghost))
        self._with_ghosts = True
        self._progress = journal
        self._workspace = workspace
        self._driver = driver
        self._race_program = program
        self.shows_mode = program is None
        self.agent_name, self._policy = agent or ("", None)
        self._facts = facts
        self._referee: RaceReferee | None = None
        self._recorder: Recorder | None = None
        self._comparison: GhostComparison | None = None
        self._behind: float | None = None
        self._leads: list[float] = []
        """How far ahead of the reference the drive was, from interval to interval [s]."""
        self._curve: tuple[tuple[int, int, int], list[Row]] = ((0, 0, 0), [])
        """What is drawn below the card, for so many of them and in so many columns and rows."""
        self._is_over = False
        self._strength = 1.0
        self._told_beside: frozenset[str] = frozenset()
        """The parts of the card beside the picture."""
        self._result_row: Row = ()
        self._finishes: list[RaceFinish] = []
        """The ends of a program's drives from all starts."""
        driven = journal.events(EventKind.FINISH, level.id)
        self._kept = level_progress([level], driven)[0].rules
        """The rules that a drive has kept before."""
        cut_short = load_unfinished(workspace) if program is None else None
        is_of_level = cut_short is not None and cut_short.level == level.find_scenario().level
        self._cut_short = cut_short if is_of_level else None
        """The drive that goes on here, until it does."""
        has_begun = has_run(journal.events(subject=level.id), level)
        self._is_practice = has_begun and self._cut_short is None
        """Whether a run of this day's level has begun before: only the first one counts."""
        self._is_left = self._has_warned = self._waits = False
        if self._is_daily and not self._is_practice:
            self._ghost_paths = ()  # finding the way is what the first run is about
        self.wish: Wish = "back"
        self.has_given_up = False
        """Whether the run that counted for today was left."""

    @property
    def has_started(self) -> bool:
        return self._referee is not None

    @property
    def not_over(self) -> str:
        return "The drive is not over" if self.has_started and not self._is_over else ""

    @property
    def _is_daily(self) -> bool:
        return self._level.id.startswith(DAILY_PREFIX)

    @property
    def _is_driven(self) -> bool:
        """Whether a hand drives: the clock has started, and the drive is neither at its end nor still to go on."""
        is_by_hand = self._race_program is None
        return is_by_hand and self.has_started and not self._is_over and self._cut_short is None

    @property
    def _own_program(self) -> Path | None:
        """The player's own program, where one drives."""
        is_own = self._driver is DriverKind.PROGRAM and not self._facts.is_shipped
        return self._race_program.file if self._race_program is not None and is_own else None

    def open_world(self) -> None:
        self._referee, self._is_over, self._result_row = None, False, ()
        self._recorder, self._behind, self._notice, self._has_warned = None, None, None, False
        self._leads = []
        self._waits = False
        self._comparison = None if self._reference is None else GhostComparison(self._reference)
        scenario = self._level.find_scenario()
        self._scenario: Scenario = scenario
        self._nothing_seen = LaserMap(world_bounds(scenario.world)).cells
        self._preview = RaceReferee(self._level, scenario)
        if self._race_program is not None:
            self.host.open_session(self._open_race, lambda session: self.host.pacing.factor)
            self.observe_agent()
        elif self._cut_short is not None:
            self.host.open_session(self._open_again, lambda session: self.host.pacing.factor)
        else:
            self.host.open(lambda: scenario, self._teleop, paused=True)
        self.view = None  # only now: until another world was asked for, there were views of the one before
        self.world.withdraw()
        self.renew_laser_map(draws=self._level.conditions.fog)

    def _open_race(self) -> Session:
        """Opens the race in the helper thread, after the program has started and before the first tick."""
        assert self._race_program is not None  # else the keys drive
        if self._driver is DriverKind.PROGRAM:
            self._facts = facts_of_program(
                self._race_program.file
            )  # it may have been edited since the last drive
        session, self._referee, self._recorder = open_race(
            self._level, self._scenario, self._race_program, EDITS if self._may_edit else ""
        )
        return session

    @property
    def _teleop(self) -> ControllerFile:
        return find_controller(TWO if len(self._scenario.partners) > 1 else ONE)

    def _open_again(self) -> Session:
        """Opens the drive that was cut short, in the helper thread; another one where it cannot go on, as in another version."""
        assert self._cut_short is not None
        try:
            session, self._referee, self._recorder = open_again(self._level, self._cut_short, self._teleop)
        except (RecordingError, ValueError):
            self._cut_short = None
            session = Session(self._scenario, seed=OWN_SEED, always_scan=True)
            self._recorder = Recorder.for_scenario(self._scenario, session.runner.simulation)
            session.runner.observers.append(self._recorder)
            session.drive_with(self._teleop)
            session.runner.paused = True
        return session

    def _begin(self) -> None:
        """The clock starts: from now on, the run of a day is used up."""
        with suppress(ProgressError):  # it is told at the end, when the drive cannot be saved either
            self._is_practice = begin_run(self._progress, self._level)
        self._referee = referee = RaceReferee(self._level, self._scenario)
        self.host.post(lambda session: session.runner.observers.append(referee))
        self.host.resume_when_driven()

    def _take_cut_short(self) -> None:
        """The drive that was cut short goes on now, or is given up."""
        self._cut_short = None
        with suppress(OSError):
            unfinished_file(self._workspace).unlink(missing_ok=True)

    def on_unmount(self) -> None:
        """Keeps a drive that nobody has ended: a dropped link, or the kit that is quit, has."""
        if not self._is_driven or self._is_left or (self._is_daily and self._is_practice):
            return
        recording = self.recording() if self._recorder is None else self._recorder.recording()
        if recording is not None and recording.ticks:
            file = unfinished_file(self._workspace)
            with suppress(OSError):
                file.parent.mkdir(parents=True, exist_ok=True)
                save_recording(recording, file)

    def is_drive_key(self, key: str) -> bool:
        found = drive_key(key)
        return self._race_program is None and found is not None and (found.moves or found.name == "space")

    def drive_keys_changed(self, messages: tuple[str, ...], state: DriveState) -> None:
        strength = max((push for name, push in state.held.items() if named(name).moves), default=1.0)
        if self.view is None or self._is_over or (not messages and strength == self._strength):
            return
        self._strength = strength
        if any(message.startswith("p_") for message in messages):
            if self._referee is None:
                self._begin()
            elif self._cut_short is not None:
                self._take_cut_short()
                self.host.resume_when_driven()
        self.host.post(lambda session: session.keys.publish(messages, strength))

    def on_screen_suspend(self) -> None:
        """Behind a dialog the drive waits: its clock would run on unseen."""
        runs = self.has_started and not self._is_over and self.view is not None and not self.view.paused
        if runs and self._cut_short is None:
            self._waits = True
            self.host.set_paused(True)

    def on_screen_resume(self) -> None:
        if self._waits:
            self._waits = False
            self.host.set_paused(False)

    # What is shown

    @property
    def shows_program(self) -> bool:
        """One that drives the level; nobody reads the code that turns keys into speeds."""
        return self._driver is DriverKind.PROGRAM

    @property
    def help_notes(self) -> tuple[tuple[tuple[str, str], ...], ...]:
        notes = *super().help_notes, LETTER_NOTES
        return notes if self._race_program is None else (*notes, level_rows.PROGRAM_NOTES)

    @property
    def program_note(self) -> str:
        return "e edits it" if self._may_edit else ""

    def _card(self, width: int, room: int) -> list[Row]:
        reference, standing = reference_seconds(self._level), Standing(0.0, False)
        if self._referee is not None and self.view is not None:
            standing = Standing(self.view.time_s, self._referee.finish.is_flawed)
        if not self._widths.total:
            room -= ROWS_OF_FIGURES[width >= TWO_COLUMNS]
        card = level_card(
            self._level, self._driver, reference, self._kept, width, room, self._company, standing
        )
        self._told_beside = frozenset(card) if self.query_one("#panel").display else frozenset()
        rows = [each for part in card.values() for each in part]
        has_room = self._widths.beside and not self.shows_program
        return [*rows, *self._curve_rows(width, room - len(rows))] if has_room else rows

    def _curve_rows(self, width: int, room: int) -> list[Row]:
        """A curve of how far ahead of the reference the drive was until now, before its start of the reference's speed; drawn anew
        only with a new value."""
        wanted, reference = (len(self._leads), width, room), self._reference
        if wanted != self._curve[0] and reference is not None:
            at, drawn = (width, room, self._theme.encoder), []
            if self._leads:
                drawn = lead_rows(self._leads, (len(self._leads) - 1) * LEAD_INTERVAL, *at)
            elif reference.tracks:
                speeds = speeds_along(reference.tracks[0], reference.step_size)
                drawn = speed_rows(speeds, reference.seconds, *at, title="speed of the reference")
            self._curve = wanted, drawn
        return self._curve[1]

    def _view_arrived(self, view: View) -> None:
        """Replaces the targets and bumps of the map's case by the level's, in the world's thread."""
        view = (self._referee or self._preview).shown(view)
        distance = view.metrics.target_m
        if self._level.conditions.fog and distance is not None and distance > SIGHT:
            view = replace(view, metrics=replace(view.metrics, target_m=None))
        if self._race_program is None:  # a player knows no node that turns keys into speeds
            named = (each._replace(name="robot") for each in view.messages)
            view = replace(view, messages=tuple(named))
        super()._view_arrived(view)

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
        if (seen := scene.cells) is not None and self._level.conditions.fog:  # a ghost shows nobody the way
            marks = tuple(mark for mark in marks if seen.state_at(mark.x, mark.y) is CellState.FREE)
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
        if view is None or not self.is_current:
            return
        if (
            referee is not None
            and view.pose is not None
            and self._comparison is not None
            and not self._is_over
        ):
            self._behind = self._comparison.update(view.time_s, view.pose.x, view.pose.y)
            if self._behind is not None:
                newest = round(view.time_s / LEAD_INTERVAL) + 1 - len(self._leads)
                self._leads += [-self._behind] * max(0, newest)
        self._rows("heading").show([self._heading(view.time_s)])
        if self._cut_short is not None:
            going_on = level_rows.before_it_goes_on(view.time_s)
            self._rows("messages").show(going_on if self._notice is None else [self._notice])
        elif referee is None:
            ghosts = [
                f"{ghost_driver(each)} ({ghost_look(each)[0]}) {each.seconds:.1f} s" for each in self._ghosts
            ]
            rows = level_rows.before_the_start(
                self._level,
                ghosts,
                self.size.width,
                task_in_sight="task" in self._told_beside,
                is_practice=self._is_practice,
            )
            self._rows("messages").show(rows)
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
        width, clock = self.size.width, (format_clock(time_s), "bold")
        left = [(self._level.title, "title")]
        if self._race_program is not None:
            left.append((f"  {self.agent_name or self._race_program.name} drives", "dim"))
        if referee is None:
            return at_both_edges(row(*left), row(clock), width)
        conditions, finish = self._level.conditions, referee.finish
        if referee.objective.progress:
            left.append((f"  {referee.objective.progress}", ""))
        right: list[str | tuple[str, str]] = [f"bumps {finish.collisions}  ", clock]
        if conditions.charge:
            right.insert(0, f"battery {max(0.0, referee.battery.charge):.1f} m  ")
        if self._behind is not None:
            behind = row((f"{self._behind:+.2f}", "good" if self._behind <= 0.0 else "warn"), f" to {PACE}  ")
            if row_width(row(*left, *behind, *right)) + 2 <= width:
                right = [*behind, *right]
        reference = reference_seconds(self._level) if self._level.has_medals else None
        if reference is not None and not self._is_over and "ladder" not in self._told_beside:
            reach = in_reach_row(self._driver, reference, time_s, finish.is_flawed)
            if row_width(row(*left, *reach, *right)) + 4 <= width:
                left += [("  ", ""), *reach]
        return at_both_edges(row(*left), row(*right), width)

    def _end(self, session: Session) -> None:
        """Ends the drive in the world's thread, between two ticks: nothing moves any more."""
        recording = self.host.recording() if self._recorder is None else self._recorder.recording()
        assert self._referee is not None  # the drive had begun
        finish, record, problem = self._referee.finish, None, ""
        if self._race_program is not None:
            finish = replace(finish, failure=session.failure, sensors=sensors_in_use(session))
        if recording is not None:
            # The world went on until this screen had seen the end.
            recording = recording.first(round(finish.seconds / recording.step_size))
            try:
                drives = self._other_starts((finish, recording))
                record = record_drive(
                    self._progress,
                    self._workspace,
                    self._level,
                    self._driver,
                    drives,
                    self._facts,
                    is_practice=self._is_practice,
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
            self.app.push_screen(MessageDialog("The drive could not be saved", event.problem))
            return
        reference = reference_seconds(self._level)
        if finish.reached and reference is not None:
            self._behind = finish.seconds - reference  # as the result says it
            self._rows("heading").show([self._heading(finish.seconds)])
        medal = medal_of(finish, reference, self._driver)
        earned = (f" {medal.title}", MEDAL_STYLES[medal]) if self._level.has_medals else ""
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
            self._own_program,
        )
        self.app.push_screen(DriveResultScreen(self._theme, result, self._workspace), self._do_choice)

    def _do_choice(self, wish: Wish | None) -> None:
        """Does what the player chose in the dialog."""
        if wish == "restart":
            self.action_restart()
        elif wish is not None:
            self.wish = wish
            self.dismiss()

    # Keys

    @property
    def unavailable_actions(self) -> tuple[str, ...]:
        if self._race_program is None:
            return "speed", "edit_file", "editor"
        return "drive_keys", "stop_robot", *(() if self._may_edit else ("edit_file", "editor"))

    @property
    def _may_edit(self) -> bool:
        """Whether a program of the player's drives; not in the run that counts for today, which a change would end."""
        return self._own_program is not None and not self._is_run_of_the_day

    def edit(self, *, is_here: bool) -> None:
        """Opens the program that drives; once it is another one, it drives again."""
        program = self._own_program
        if program is not None and self._may_edit:
            edit_file(
                self.app,
                program,
                self._theme.terminal,
                self.action_restart,
                is_here=is_here,
                beside=partial(level_beside, self._level, self._driver),
            )

    def action_restart(self) -> None:
        """A new drive, recorded from its first tick."""
        if self._warns_of_the_end():
            return
        self.stop_driving()
        if self._cut_short is not None:
            self._take_cut_short()
        self._is_practice = has_run(self._progress.events(subject=self._level.id), self._level)
        self.open_world()

    @property
    def _is_run_of_the_day(self) -> bool:
        """Whether the run that counts for today goes on."""
        return self._is_daily and not self._is_practice and self.has_started and not self._is_over

    def _warns_of_the_end(self) -> bool:
        """Says once that a key would end the run that counts for today; whether it has just said so."""
        if not self._is_run_of_the_day or self._has_warned:
            return False
        self._has_warned = True
        self._notice = level_rows.GIVES_UP
        self._show()
        return True

    def action_share(self) -> None:
        """The map that the robot has drawn, as files."""
        self.save_laser_map(self._workspace.folder / "cards", self._level.id)

    def on_floor_clicked(self, event: FloorClicked) -> None:
        """Clicks drive where nothing is judged."""
        if not self._is_over:
            self._notice = row((" In a level the keys drive, not clicks.", "dim"))
            self._show()

    def action_ghosts(self) -> None:
        self._with_ghosts = not self._with_ghosts
        self._show()

    def action_pause(self) -> None:
        if self.has_started and not self._is_over:
            super().action_pause()

    def action_step(self) -> None:
        """Time is not for sale in a race."""

    def action_speed(self, key: str) -> None:
        """Changes the speed at which a program's drive is shown; its own clock is the world's."""
        if self._race_program is not None:
            super().action_speed(key)

    def action_back(self) -> None:
        if self._cut_short is not None or not self._warns_of_the_end():
            self._is_left = True
            self.has_given_up = self._is_run_of_the_day and self._cut_short is None
            self.dismiss()
