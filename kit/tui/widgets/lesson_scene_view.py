"""A lesson's scene: a robot drives in a world, at a step's own view of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

from textual.message import Message

from kit.controllers import find_controller
from kit.render.encode import AsciiEncoder
from kit.render.roles import Role
from kit.render.scene import Scene as Picture
from kit.run.lockstep import Observer
from kit.run.view import View
from kit.school.lessons.records import LessonScene, scene_confinement_level
from kit.tui.session_host import SessionHost
from kit.tui.theme import Theme
from kit.tui.widgets.world_view import ErrorEvent, WorldView

if TYPE_CHECKING:
    from kit.render.camera import Camera
    from kit.run.recording import Recording
    from kit.run.runner import Runner
    from kit.run.scenario import Scenario
    from kit.run.session import Session
    from kit.sim.simulation import Simulation


TELEOP: Final = "teleop"
ASCII_WALL: Final = AsciiEncoder.shapes[Role.WALL]
MOST_WALL: Final = 0.6
"""The share of a picture in ASCII that may be wall: beyond it no passage is seen any more."""
READABLE_ROW: Final = 0.25
"""Height of a row in which passages of half a metre are seen [m]."""
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
        self._decided_for: object = None
        self._decided_size = (0, 0)
        """The walls and the size for which it was decided whether all of the world is shown."""
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
        """Says in a few words what it shows."""
        if self.scene is None:
            return ""
        if self.view is None:
            return "opening ..."
        if self.view.failure is not None:
            return "the controller has stopped"
        if self.is_resting:
            return "your run: r shows it again" if self.is_recorded else "finished"
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

            session = Session(
                find_scenario(scene.map_name, scene.case),
                seed=scene.seed,
                always_scan=True,
                level=scene_confinement_level(scene),
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

    def set_paused(self, paused: bool) -> None:
        """Stands still while something else is looked at."""
        if self.view is not None and not self.is_resting:
            self._host.set_paused(paused)

    def replay(self) -> None:
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

    def _current_camera(self, scene: Picture, columns: int, rows: int) -> Camera:
        """All of the world; where that is little but wall, a part that is large enough for its passages, with the robot."""
        if self.encoder.across * self.encoder.down > 1:
            return super()._current_camera(scene, columns, rows)
        if self._decided_for is scene.walls and self._decided_size == (columns, rows):
            return super()._current_camera(scene, columns, rows)
        self._decided_for, self._decided_size = scene.walls, (columns, rows)
        self.fit_again()
        self._camera = camera = super()._current_camera(scene, columns, rows)
        drawn = "".join(each.strip() for each in self._painter.paint(scene, camera).rows())
        if drawn and drawn.count(ASCII_WALL) > MOST_WALL * len(drawn):
            self.follow_at(READABLE_ROW / camera.aspect)
            camera = super()._current_camera(scene, columns, rows)
        return camera

    def on_unmount(self) -> None:
        self._host.close()

    def _newest(self) -> Picture:
        assert self._picture is not None  # nothing is offered before the first view
        return self._picture

    def _view_arrived(self, view: View) -> None:
        """Keeps a view and announces it; called in the world's thread."""
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
