"""The stage of a lesson: the moving picture beside its text, as the lesson's dialogue uses it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from kit.run.recording import Recording
    from kit.run.scenario import Scenario
    from kit.school.lessons.records import LearningScene, LessonStep


class RunStage(Protocol):
    """Shows a recorded run."""

    def play(self, recording: Recording, place: Scenario, *, still: bool = False) -> None:
        """Plays a recorded run. ``still``: it stands at its first instant until ``go``."""

    def go(self) -> None:
        """Lets it run."""

    def replay(self) -> None:
        """Runs it from its first instant."""


class Stage(RunStage, Protocol):
    """Shows the scene of a step, or a recorded run. Its owner calls the dialogue's ``on_scene_end`` each time the scene has come to
    its end."""

    @property
    def is_described(self) -> bool:
        """Whether it tells what is seen in words, at once, since nothing moves in it."""

    @property
    def is_roomy(self) -> bool:
        """Whether a run is seen beside everything that is said of it."""

    @property
    def is_open(self) -> bool:
        """Whether there is something to see."""

    @property
    def is_resting(self) -> bool:
        """Whether the scene has come to its end."""

    @property
    def is_recorded(self) -> bool:
        """Whether a recorded run is shown in place of the step's scene."""

    @property
    def is_paused(self) -> bool:
        """Whether what is played back stands still and could go on."""

    def open(self, step: LessonStep, *, still: bool) -> None:
        """Opens the scene of a step, if it has one. ``still``: it stands at its first instant until ``go``."""

    def learn(self, scene: LearningScene) -> None:
        """Plays tables that learn, in place of the step's scene."""

    def set_paused(self, paused: bool) -> None:
        """Has the scene stand still, or go on."""

    def step_once(self) -> None:
        """Makes one step of what is played back."""

    def close(self) -> None:
        """Shows nothing any more."""


class NoStage:
    """Shows nothing."""

    is_described = is_roomy = False
    is_open = is_resting = True
    is_recorded = is_paused = False

    def open(self, step: LessonStep, *, still: bool) -> None: ...

    def play(self, recording: Recording, place: Scenario, *, still: bool = False) -> None: ...

    def learn(self, scene: LearningScene) -> None: ...

    def go(self) -> None: ...

    def replay(self) -> None: ...

    def set_paused(self, paused: bool) -> None: ...

    def step_once(self) -> None: ...

    def close(self) -> None: ...
