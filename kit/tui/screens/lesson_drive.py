"""Screens of recorded drives: one that is driven by hand for a lesson, and the replay of a run."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, ClassVar, Final

from textual.binding import BindingType
from textual.message import Message

from kit.controllers import find_controller
from kit.dialogue.actions import ScreenActions
from kit.dialogue.screen_action import ScreenAction
from kit.dialogue.shared_actions import VIEW_IDS
from kit.document.rows import Row, row
from kit.inspection.sockets import sockets_folder
from kit.run.recording import Recording
from kit.run.scenario import Scenario, find_scenario
from kit.tui.input.drive import DriveState
from kit.tui.input.drive_keys import drive_key, named
from kit.tui.rows.key_rows import bindings
from kit.tui.screens.watch import WatchScreen
from kit.tui.theme import Theme
from kit.workspace import Workspace

if TYPE_CHECKING:
    from kit.learning.policies.policy import Policy
    from kit.run.recording_file import RecordingFile
    from kit.run.session import Session
    from kit.run.view import View
    from kit.school.lessons.records import LessonScene


SEEK_S: Final = 5.0
"""A replay goes so far back or ahead at a key [s]."""


class ReplayScreen(WatchScreen):
    """Plays a recording from its first tick, and stands still at its end."""

    screen_actions = ScreenActions(
        "replay",
        ("pause", "seek", "step", "speed", "restart", "zoom", "help", "back", "quit"),
        ("agent_view", *VIEW_IDS),
        own=(
            ScreenAction("seek", "Left Right", "seek", f"go {SEEK_S:.0f} s back or ahead",
                         (("left", f"seek({-SEEK_S})"), ("right", f"seek({SEEK_S})")), "←→"),
        ),
        drives=True,
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)
    shows_mode = False
    escape_leaves = True

    def __init__(self, theme: Theme, place: Scenario, recording: Recording, title: str) -> None:
        super().__init__(theme, f"{place.title}, {title}", seed=recording.seed)
        self.driver_name = title
        self._place = place
        self._recording = recording
        self.length_s = recording.ticks * recording.step_size
        self._first = 0
        """The tick from which on it is shown."""
        self._is_halted = False
        """Whether it stands still there."""
        self._is_sought = False
        """Whether a view of that tick is still to come."""

    def watch_agent(self, name: str, policy: Policy | None) -> None:
        """Shows from the first moment on what this agent perceives on the way; None: no agent drove."""
        self.agent_name, self._policy = name, policy
        self._shows_agent = policy is not None

    def on_mount(self) -> None:
        super().on_mount()
        self.set_class(self._shows_agent, "-agent")

    def open_world(self) -> None:
        self.host.open_session(self._session, lambda session: self.host.pacing.factor)
        self.observe_agent()

    def _session(self) -> Session:
        """Called in the helper thread."""
        from kit.run.episode import run_until
        from kit.run.session import Session
        from kit.school.game.replayed_goal import show_goal

        told = self._recording
        session = Session(self._place, seed=told.seed, step_size=told.step_size, always_scan=True)
        show_goal(session)
        session.play_back(told)
        run_until(session.runner, ticks=self._first)
        session.runner.paused |= self._is_halted
        return session

    def is_drive_key(self, key: str) -> bool:
        """What is over cannot be driven."""
        return False

    def _view_arrived(self, view: View) -> None:
        self._is_sought = False
        super()._view_arrived(view)

    def action_seek(self, seconds: float) -> None:
        """Goes back or ahead; stands still there if it does now."""
        if self.view is None:
            return
        if not self._is_sought:
            self._first = self.view.tick
            self._is_halted = self.view.paused and self.view.tick < self._recording.ticks
        ahead = round(seconds / self._recording.step_size)
        self._first = max(0, min(self._first + ahead, self._recording.ticks))
        self.open_world()
        self._is_sought = True

    def action_restart(self) -> None:
        """Starts the drive from the beginning."""
        self._first, self._is_halted = 0, False
        self.open_world()


TELEOP: Final = "teleop"


class DriveSaved(Message):
    """The drive is on the disk, or could not be put there."""


class RecordedDriveScreen(WatchScreen):
    """The student drives; the clock starts with the first key. Leaving keeps the drive, and so does the target."""

    key_labels: ClassVar = {"back": "save and check"}
    help_title = "A drive that is recorded"
    help_notes = (
        (
            ("the clock", "starts with the first key that drives"),
            ("Esc  Enter", "save this drive, go back and check it"),
        ),
    )

    screen_actions = ScreenActions(
        "recorded drive",
        ("drive_keys", "stop_robot", "restart", "pause", "help", "back"),
        ("close", "step", "speed", "drive_mode", "zoom", *VIEW_IDS, "interrupt"),
        own=(
            ScreenAction("interrupt", "Ctrl-C", "back", "save the drive and go back to the lesson", (("ctrl+c,ctrl+q", "interrupt"),),
                   "^C", has_priority=True),
        ),
        drives=True,
    )  # fmt: skip
    BINDINGS: ClassVar[list[BindingType]] = bindings(screen_actions)

    def __init__(self, theme: Theme, scene: LessonScene, kept: RecordingFile, workspace: Workspace) -> None:
        """``kept``: where the drive is written as it goes on; closed with the screen."""
        super().__init__(
            theme,
            scene.case or scene.map_name,
            seed=scene.seed,
            socket_dir=sockets_folder(workspace.folder),
            store=kept,
        )
        self._scene = scene
        self._kept = kept
        self._notices = [each.removeprefix(f"{kept.file.parent}{os.sep}") for each in kept.notices]
        self._teleop = find_controller(TELEOP)
        self._strength = 1.0
        self._started = self._saving = self._reached = False
        self._is_open = False
        """Whether what is seen is the drive that is to be kept, and not the one before."""
        self.was_kept = False
        self.problem = ""
        """Why the drive could not be kept."""

    def open_world(self) -> None:
        self._started = self._reached = self._is_open = False
        self.host.set_paused(True)
        self.host.open(self._find_place, self._teleop, paused=True)

    def _find_place(self) -> Scenario:
        """Finds the scenario; runs in the helper thread."""
        return find_scenario(self._scene.map_name, self._scene.case)

    def is_drive_key(self, key: str) -> bool:
        found = drive_key(key)
        return found is not None and (found.moves or found.name == "space")

    def drive_keys_changed(self, messages: tuple[str, ...], state: DriveState) -> None:
        strength = max((push for name, push in state.held.items() if named(name).moves), default=1.0)
        if not self._is_open or self._reached or (not messages and strength == self._strength):
            return
        self._strength = strength
        if not self._started and any(message.startswith("p_") for message in messages):
            self._started = True
            self.host.resume_when_driven()
        self.host.post(lambda session: session.keys.publish(messages, strength))

    def _show(self) -> None:
        super()._show()
        view = self.view
        self._is_open = self._is_open or (view is not None and view.tick == 0)
        if view is None or not self._is_open or view.failure is not None:
            return
        if view.metrics.reached_s is not None and not self._reached:
            self._reached = True
            self.stop_driving()
            self.host.set_paused(True)
            self.host.post(self._save_between_ticks)
        if (remark := self._remark_row()) and self.is_active:
            told = [] if self._started else [row((f" {each}", "warn")) for each in self._notices]
            self._rows("messages").show([*told, remark])

    def _remark_row(self) -> Row:
        if self._reached:
            return row(
                (" The target is reached, and the drive is saved.", "good"),
                " Esc checks it, r restarts.",
            )
        if not self._started:
            return row((" The clock starts with your first key.", "bold"))
        return ()

    def _save_between_ticks(self, session: Session) -> None:
        """Saves the drive; runs in the world's thread, between two ticks."""
        self._save()

    def _save(self) -> None:
        recording = self.host.recording()
        if recording is None or not recording.ticks:
            return
        try:
            self._kept.complete(recording)
            self.was_kept, self.problem = True, ""
        except OSError as error:
            self.problem = f"{self._kept.file}: {error.strerror}." if error.strerror else str(error)

    def on_unmount(self) -> None:
        """Saves the drive also when the whole kit is quit."""
        self.host.close()
        if self._started and not self._saving and not self._reached:
            self._save()
        self._kept.close()

    # Keys

    def action_restart(self) -> None:
        """A new drive, recorded from its first tick."""
        if self._started and not self._saving:
            self.open_world()

    def action_back(self) -> None:
        if self._saving:
            return
        if self._started and self.view is not None and not self._reached:
            self._saving = True
            self.stop_driving()
            self.host.post(self._keep_and_leave)
        else:
            self.dismiss()

    def action_interrupt(self) -> None:
        """Ctrl-C ends the drive, not the kit around it."""
        self.action_back()

    def _keep_and_leave(self, session: Session) -> None:
        session.runner.pause()
        self._save_between_ticks(session)
        self.post_message(DriveSaved())

    def on_drive_saved(self) -> None:
        self.dismiss()


class RecordingScreen(ReplayScreen):
    """A run of a check, looked at again; Esc goes back to the lesson."""

    def action_back(self) -> None:
        self.dismiss()
