"""A lesson's scene as a widget: a world that runs for some seconds and then rests, the same each time it is shown.

A lesson's learning scene as a widget: tables that learn, values and best moves on the floor.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final

from textual import events
from textual.message import Message
from textual.timer import Timer

from kit.controllers import find_controller
from kit.render.scene import Scene as Picture
from kit.run.lockstep import Observer
from kit.run.view import View
from kit.school.lessons.records import LearningScene, LessonScene
from kit.tui.session_host import SessionHost
from kit.tui.theme import Theme
from kit.tui.widgets.frame_view import FrameView
from kit.tui.widgets.world_view import ErrorEvent, WorldView

if TYPE_CHECKING:
    from pathlib import Path

    from kit.run.recording import Recording
    from kit.run.runner import Runner
    from kit.run.scenario import Scenario
    from kit.run.session import Session
    from kit.school.lessons.learning_playback import LearningPlayback
    from kit.sim.simulation import Simulation


TELEOP: Final = "teleop"
UNSEEN_FACTOR: Final = 10.0
"""Simulated seconds a second of a scene of which the beginning and the end alone are shown."""


class LessonSceneView(WorldView):
    """Shows one scene at a time. ``folder``: the student's controllers; ``socket_dir``: where other terminals look in."""

    class Moved(Message):
        """There is a newer view."""

    DEFAULT_CSS = "LessonSceneView { width: 1fr; height: 1fr; }"

    def __init__(self, theme: Theme, folder: Path, socket_dir: Path | None = None) -> None:
        super().__init__(lambda: theme.encoder, theme.palette, id="scene")
        self.view: View | None = None
        """The newest; None before the first of a scene."""
        self.scene: LessonScene | None = None
        self._folder = folder
        self._reduces_motion = theme.terminal.reduce_motion.value
        self._is_drawn = False
        """Whether any view of this scene was drawn."""
        self._picture: Picture | None = None
        self._announced = self._opening = False
        self._recording: tuple[Recording, Scenario] | None = None
        """What is played again, where the scene is a recorded run."""
        self._host = SessionHost(
            on_view=self._view_arrived, on_error=self._error_arrived, socket_dir=socket_dir
        )

    @property
    def is_recorded(self) -> bool:
        """Whether it is a recorded run that is played again."""
        return self._recording is not None

    @property
    def by_hand(self) -> bool:
        """Whether the student drives in it. Then it never rests."""
        return self.scene is not None and self.scene.controller == TELEOP

    @property
    def is_resting(self) -> bool:
        """Whether it has run for as long as it is to run."""
        return (
            self.scene is not None
            and self.view is not None
            and self.view.paused
            and not self.by_hand
            and self.view.time_s >= self.scene.seconds - 1e-6
        )

    @property
    def is_open(self) -> bool:
        """Whether there is a view."""
        return self.view is not None and self.view.failure is None

    @property
    def caption(self) -> str:
        """What it does, in a few words."""
        if self.scene is None:
            return ""
        if self.view is None:
            return "opening ..."
        if self.view.failure is not None:
            return "the controller has stopped"
        if self.is_resting:
            return "your run: w shows it again" if self.is_recorded else "finished"
        run = "your run: " if self.is_recorded else ""
        return f"{run}{int(self.view.time_s)} of {self.scene.seconds:.3g} s"

    def open(self, scene: LessonScene, *, still: bool) -> None:
        """Another scene, from its first instant on. ``still``: it stands there until ``go``."""
        if self.scene is None or (scene.map_name, scene.case) != (self.scene.map_name, self.scene.case):
            self.clear()  # not the place of the step before
        self._recording = None
        self.scene, self.view, self._opening = scene, None, True
        folder, by_hand = self._folder, self.by_hand

        def make() -> Session:
            """Called in the helper thread, which imports the physics while the words are on the screen already."""
            from kit.run.scenario import find_scenario
            from kit.run.session import Session
            from kit.school.lessons.records import scene_level

            session = Session(
                find_scenario(scene.map_name, scene.case),
                seed=scene.seed,
                always_scan=True,
                level=scene_level(scene),
            )
            try:
                if scene.controller:
                    session.drive_with(find_controller(scene.controller, folder))
                    session.wait_until_driven()  # it drives from the first tick on, so that each time is the same
            except BaseException:  # also a cancelled worker: the world is closed; raised again
                session.close()
                raise
            runner = session.runner
            if not by_hand:
                runner.observers.append(
                    _PauseAtEnd(runner, round(scene.seconds / runner.simulation.step_size))
                )
            runner.paused = still
            self._opening = False
            return session

        self._is_drawn = False
        self._host.open_session(make, lambda session: self._factor)

    @property
    def _factor(self) -> float:
        """How much faster than real time it runs: a scene that is not seen to move need not take as long."""
        return UNSEEN_FACTOR if self._reduces_motion and not self.by_hand else 1.0

    def play(self, recording: Recording, place: Scenario, *, still: bool = False) -> None:
        """A recorded run from its first instant to its last. ``still``: it stands there until ``go``."""
        seconds = recording.ticks * recording.step_size
        if self.scene is None or (place.name, recording.case) != (self.scene.map_name, self.scene.case):
            self.clear()
        self.scene = LessonScene(place.name, recording.case, "", recording.seed, seconds)
        self._recording = recording, place
        self.view, self._opening = None, True

        def make() -> Session:
            """Called in the helper thread."""
            from kit.run.session import Session

            session = Session(place, seed=recording.seed, step_size=recording.step_size, always_scan=True)
            session.play_back(recording)
            session.runner.tick()  # what was put elsewhere before it began stands there now
            session.runner.paused = still
            self._opening = False
            return session

        self._is_drawn = False
        self._host.open_session(make, lambda session: self._factor)

    def go(self) -> None:
        """Lets it run."""
        self._host.set_paused(False)

    def hold(self, held: bool) -> None:
        """Stands still while something else is looked at."""
        if self.view is not None and not self.is_resting:
            self._host.set_paused(held)

    def again(self) -> None:
        """The same from its first instant on, running."""
        if self._recording is not None:
            self.play(*self._recording)
        elif self.scene is not None:
            self.open(self.scene, still=False)

    def close_session(self) -> None:
        """No scene any more."""
        self.scene = self.view = self._recording = None
        self._host.close_session()

    def press(self, messages: tuple[str, ...], strength: float) -> None:
        """Hands driving keys to whoever listens in the scene."""
        self._host.post(lambda session: session.keys.publish(messages, strength))

    def draw(self) -> None:
        """The newest view, as soon as the link has room."""
        if self.view is not None:
            self.offer(self._newest)

    def on_unmount(self) -> None:
        self._host.close()

    def _newest(self) -> Picture:
        assert self._picture is not None  # nothing is offered before the first view
        return self._picture

    def _view_arrived(self, view: View) -> None:
        """In the world's thread."""
        if self._opening:  # still of the one before
            return
        self.view = view
        if not self._reduces_motion or self.by_hand or view.paused or not self._is_drawn:
            self._picture, self._is_drawn = view.scene, True
        if not self._announced:  # the newest wins: one announcement at a time is enough
            self._announced = True
            self.post_message(self.Moved())

    def _error_arrived(self, text: str) -> None:
        if self._opening:  # the one before would run on
            self._host.close_session()
        self.post_message(ErrorEvent(text))

    def on_lesson_scene_view_moved(self) -> None:
        self._announced = False
        if self.screen.is_active:
            self.draw()


class _PauseAtEnd(Observer):
    """Watches a runner, and has it stand still from a tick on."""

    def __init__(self, runner: Runner, ticks: int) -> None:
        self._runner = runner
        self._ticks = ticks

    def on_step(self, simulation: Simulation) -> None:
        if simulation.tick >= self._ticks:
            self._runner.pause()


FRAME_S: Final = 0.1
"""Between two pictures [s]: as many as a slow link carries."""


class LearningSceneView(FrameView):
    """Shows one scene at a time, the same each time it is shown."""

    class Updated(Message):
        """There is a newer picture."""

    DEFAULT_CSS = "LearningSceneView { width: 1fr; height: 1fr; }"

    by_hand: Final = False
    """Nobody drives in it."""

    def __init__(self, theme: Theme) -> None:
        super().__init__(theme.palette, id="learning")
        self.scene: LearningScene | None = None
        self.playback: LearningPlayback | None = None
        self._encoder = theme.encoder
        self._reduces_motion = theme.terminal.reduce_motion.value
        self._timer: Timer | None = None
        self._shown_at = 0.0
        """When the last picture was shown [s]."""

    @property
    def is_open(self) -> bool:
        """Whether there is a picture."""
        return self.playback is not None

    @property
    def is_resting(self) -> bool:
        """Whether all is learned that is to be learned."""
        return self.playback is not None and self.playback.is_over

    @property
    def is_paused(self) -> bool:
        """Whether it stands still and could go on."""
        return self.is_open and self._timer is None and not self.is_resting

    @property
    def caption(self) -> str:
        """What it does, in a few words."""
        if self.playback is None:
            return ""
        if self.is_resting:
            return "finished"
        seconds = f"{int(self.playback.time_s)} of {self.playback.scene.seconds:g} s"
        return f"still, {seconds}" if self.is_paused else seconds

    def open(self, scene: LearningScene, *, still: bool) -> None:
        """Another scene, from its first update on. ``still``: it stands there until ``go``."""
        from kit.school.lessons.learning_playback import LearningPlayback  # of no use to the first frame

        self.scene, self.playback = scene, LearningPlayback(scene)
        self.hold(still)
        self.draw()

    def go(self) -> None:
        """Lets it learn."""
        self.hold(False)

    def hold(self, held: bool) -> None:
        """Stands still, or goes on."""
        if held or self.playback is None or self.is_resting:
            self._stop_timer()
        elif self._reduces_motion:
            self.playback.advance_to(self.playback.scene.seconds)
            self.draw()
            self.post_message(self.Updated())
        elif self._timer is None:
            self._shown_at = time.monotonic()
            self._timer = self.set_interval(FRAME_S, self._advance)

    def step(self) -> None:
        """Stands still, and makes one update of each table."""
        if self.playback is not None:
            self.hold(True)
            self.playback.step()
            self.draw()
            self.post_message(self.Updated())

    def again(self) -> None:
        """The same from its first update on, running."""
        if self.scene is not None:
            self._stop_timer()
            self.open(self.scene, still=False)

    def close_session(self) -> None:
        """No scene any more."""
        self._stop_timer()
        self.scene = self.playback = None
        self.show_nothing()

    def draw(self) -> None:
        """The tables as they are now."""
        columns, rows = self.size
        if self.playback is not None and columns and rows > 1:
            self.show_frame(self.playback.frame(columns, rows, self._encoder))

    def on_resize(self, event: events.Resize) -> None:
        self.draw()

    def _advance(self) -> None:
        """A slow terminal gets fewer pictures, and the scene takes as long."""
        if self.playback is None:
            return
        now = time.monotonic()
        self.playback.advance_to(self.playback.time_s + now - self._shown_at)
        self._shown_at = now
        if self.is_resting:
            self._stop_timer()
        self.draw()
        self.post_message(self.Updated())

    def _stop_timer(self) -> None:
        if self._timer is not None:
            self._timer.stop()
            self._timer = None
