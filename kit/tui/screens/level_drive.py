"""One level, driven by hand against its ghosts: the clock starts with the first key and stops at the target."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar, Final

import numpy as np
from textual import events
from textual.binding import BindingType
from textual.containers import Vertical
from textual.message import Message

from kit.controllers import find_controller
from kit.inspection.world_sockets import sockets_folder
from kit.render.scene import Scene, SceneMark, ScenePath
from kit.run.view import format_clock
from kit.school.game.drive_records import DriveRecord, record_drive
from kit.school.game.ghosts import Ghost
from kit.school.game.levels import GameLevel
from kit.school.game.race import SEED, TIME_LIMIT_PARS, DriverKind, RaceFinish, RaceReferee
from kit.school.progress import ProgressError, ProgressJournal
from kit.tui.input.drive import DriveState
from kit.tui.input.keys import base_key, drive_key, named
from kit.tui.rows import level_rows
from kit.tui.rows.key_rows import bindings
from kit.tui.screens.message_dialog import MessageDialog, wrapped
from kit.tui.screens.watch import WatchScreen
from kit.tui.widgets.text_rows import Row, row, spread

if TYPE_CHECKING:
    from kit.run.scenario import Scenario
    from kit.run.session import Session
    from kit.tui.theme import Theme
    from kit.workspace import Workspace

ONE, TWO = "teleop", "teleop_pair"
LETTERS: Final = {"reference": "R", "keys": "K", "controller": "C", "agent": "A"}
LETTER_NOTES: Final = (
    ("R", "the reference"),
    ("K  C  A", "your best so far by hand, by program, by agent"),
)
WAY: Final = 0.15
"""m between two points of a ghost's way, as it is drawn."""


class DriveEnded(Message):
    """The drive has ended."""

    def __init__(self, finish: RaceFinish, noted: DriveRecord | None, problem: str) -> None:
        super().__init__()
        self.finish = finish
        self.noted = noted
        self.problem = problem


class DriveResultDialog(MessageDialog):
    """What a drive earned. A driving key that is still held does not close it."""

    LEAVE: ClassVar = ("enter", "escape", "r", "q", "backspace")

    def on_mount(self) -> None:
        self.query_one(Vertical).border_subtitle = "Enter closes"

    def on_key(self, event: events.Key) -> None:
        if base_key(event.key) not in self.LEAVE:
            event.stop()
            event.prevent_default()  # or the page below would be asked too


class LevelDrive(WatchScreen):
    """A letter shows where each ghost was at this time of its drive; its way is dotted."""

    name_of_actions = "level"
    help_notes = (LETTER_NOTES,)
    BINDINGS: ClassVar[list[BindingType]] = bindings("level")

    def __init__(
        self,
        theme: Theme,
        level: GameLevel,
        ghosts: Sequence[Ghost],
        journal: ProgressJournal,
        workspace: Workspace,
    ) -> None:
        super().__init__(
            theme, level.title, seed=SEED, socket_dir=sockets_folder(workspace.folder), records=True
        )
        self._level = level
        self._ghosts = tuple(ghosts)
        self._ghost_paths = tuple(way for ghost in self._ghosts for way in _ghost_paths(ghost))
        self._with_ghosts = True
        self._progress = journal
        self._workspace = workspace
        self._referee: RaceReferee | None = None
        self._is_over = False
        self._strength = 1.0
        self._result_row: Row = ()

    @property
    def has_started(self) -> bool:
        return self._referee is not None

    def open_world(self) -> None:
        self._referee, self._is_over, self.view, self._result_row = None, False, None, ()
        scenario = self._level.find_scenario()
        self.host.open(
            lambda: scenario, find_controller(TWO if len(scenario.partners) > 1 else ONE), paused=True
        )
        self._scenario: Scenario = scenario

    def is_drive_key(self, key: str) -> bool:
        found = drive_key(key)
        return found is not None and (found.moves or found.name == "space")

    def drive_keys_changed(self, messages: tuple[str, ...], state: DriveState) -> None:
        strength = max((push for name, push in state.held.items() if named(name).moves), default=1.0)
        if self.view is None or self._is_over or (not messages and strength == self._strength):
            return
        self._strength = strength
        if self._referee is None and any(message.startswith("p_") for message in messages):
            self._referee = referee = RaceReferee(self._scenario)
            self.host.post(lambda session: session.runner.observers.append(referee))
            self.host.set_paused(False)
        self.host.post(lambda session: session.keys.publish(messages, strength))

    # What is shown

    def _newest_scene(self) -> Scene:
        scene = super()._newest_scene()
        if not self._with_ghosts or self.view is None:
            return scene
        marks = tuple(
            SceneMark(x, y, LETTERS.get(ghost.name, "G"))
            for ghost in self._ghosts
            for x, y, _ in ghost.poses_at(self.view.time_s)
        )
        return replace(scene, paths=self._ghost_paths, marks=marks)

    def _show(self) -> None:
        super()._show()
        view, referee = self.view, self._referee
        if view is None or not self.is_active:
            return
        left = row((self._level.title, "bold"), f"  par {self._level.par:g} s")
        bumps = 0 if referee is None else referee.finish.collisions
        self._rows("heading").show(
            [spread(left, row(f"bumps {bumps}  ", (format_clock(view.time_s), "bold")), self.size.width)]
        )
        if referee is None:
            ghosts = ", ".join(f"{LETTERS.get(each.name, 'G')} {each.seconds:.1f} s" for each in self._ghosts)
            self._rows("messages").show(
                [
                    row((" The clock starts with your first key.", "bold"), f" {self._level.hint}"),
                    row((f" Ghosts: {ghosts}" if ghosts else "", "dim")),
                ]
            )
        elif self._is_over:
            self._rows("messages").show([self._result_row])
        elif self._has_ended(referee.finish, view.time_s):
            self._is_over = True
            self.stop_driving()
            self.host.set_paused(True)
            self.host.post(self._end)

    def _has_ended(self, finish: RaceFinish, time_s: float) -> bool:
        return finish.reached or bool(finish.foul) or time_s > TIME_LIMIT_PARS * self._level.par

    def _end(self, session: Session) -> None:
        """In the world's thread, between two ticks: nothing moves any more."""
        recording = self.host.recording()
        assert self._referee is not None  # the drive had begun
        finish, noted, problem = self._referee.finish, None, ""
        if recording is not None:
            try:
                noted = record_drive(
                    self._progress, self._workspace, self._level, DriverKind.KEYS, finish, recording
                )
            except ProgressError as error:
                problem = str(error)
        self.post_message(DriveEnded(finish, noted, problem))

    def on_drive_ended(self, event: DriveEnded) -> None:
        if event.noted is None:
            self.app.push_screen(MessageDialog("The drive could not be kept", wrapped(event.problem)))
            return
        reference = next((each for each in self._ghosts if each.name == "reference"), None)
        rows = level_rows.result(self._level.title, self._level.par, event.finish, event.noted, reference)
        self._result_row = row(
            (" ".join(level_rows.STAR if has else level_rows.NO_STAR for has in event.noted.stars), "warn"),
            "  r restarts, Esc goes back to the levels.",
        )
        self.app.push_screen(DriveResultDialog("The end of this drive", rows))

    # Keys

    def action_restart(self) -> None:
        """A new drive, recorded from its first tick."""
        self.stop_driving()
        self.open_world()

    def action_ghosts(self) -> None:
        self._with_ghosts = not self._with_ghosts
        self._show()

    def action_pause(self) -> None:
        if self.has_started and not self._is_over:
            super().action_pause()

    def action_step(self) -> None:
        """Time is not for sale in a race."""

    def action_speed(self, key: str) -> None:
        """Likewise."""

    def action_back(self) -> None:
        self.dismiss()


def _ghost_paths(ghost: Ghost) -> list[ScenePath]:
    """The ways of a ghost's robots, thinned out."""
    made = []
    for track in ghost.tracks:
        points = track[:, :2]
        if len(points) < 2:
            continue
        along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
        steps = np.arange(0.0, float(along[-1]) + WAY, WAY)
        at = np.searchsorted(along, steps).clip(0, len(points) - 1)
        if math.isfinite(float(along[-1])):
            made.append(ScenePath(points[np.unique(at)], "dotted"))
    return made
