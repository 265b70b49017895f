"""What a lesson is: steps in order, each for one idea, some with something to do."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path


class StepKind(StrEnum):
    """What a step asks of the student."""

    PREDICT = "predict"
    RUN = "run"
    EXPLAIN = "explain"
    MODIFY = "modify"
    MAKE = "make"


class CommandKind(StrEnum):
    """What a printed command needs, so that a test can run it."""

    ALONE = "alone"
    """It runs and ends by itself."""
    SCREEN = "screen"
    """It opens a screen."""
    BESIDE = "beside"
    """It asks a world that runs in another terminal."""


@dataclass(frozen=True, slots=True)
class LessonScene:
    """A world to look at: where, who drives, and for how long."""

    map_name: str
    """A map of the kit, or a world file in the lesson's folder."""
    case: str | None
    controller: str
    """One of the kit's by name, or a file in the lesson's folder; may be empty: nobody drives."""
    seed: int
    seconds: float
    """Simulated; then it rests."""


@dataclass(frozen=True, slots=True)
class LessonCommand:
    """A command that a step shows."""

    line: str
    kind: CommandKind
    map_name: str
    """The map of the world beside which it runs, for ``BESIDE``."""


@dataclass(frozen=True, slots=True)
class PredictionOption:
    """One thing that may be foreseen."""

    text: str
    is_right: bool
    feedback: str


@dataclass(frozen=True, slots=True)
class Exercise:
    """Something to write, checked by the grader."""

    name: str
    """Unique in its lesson: the folder beside the lesson's file, which is the grader's assignment."""
    folder: Path
    file: str
    """What the student edits."""
    seconds: float
    """Promised for one check on two cores."""


@dataclass(frozen=True, slots=True)
class LessonStep:
    """One screen of a lesson."""

    number: int
    """From 1."""
    kind: StepKind
    title: str
    goal: str
    """The subgoal's label, in a few words."""
    text: str
    scene: LessonScene | None
    picture: str
    """Fixed characters instead of a scene; may be empty."""
    commands: tuple[LessonCommand, ...]
    question: str
    """Of a prediction; else empty."""
    options: tuple[PredictionOption, ...]
    exercise: Exercise | None


@dataclass(frozen=True, slots=True)
class Lesson:
    """One lesson."""

    name: str
    """Its folder: ``01-drive``."""
    folder: Path
    title: str
    summary: str
    minutes: int
    """Promised, all in all."""
    outcomes: tuple[str, ...]
    outcome_ids: tuple[str, ...]
    """Which outcomes and practical concepts of ``outcomes.yaml``."""
    steps: tuple[LessonStep, ...]

    @property
    def exercises(self) -> tuple[Exercise, ...]:
        return tuple(step.exercise for step in self.steps if step.exercise is not None)

    def step_subject(self, step: LessonStep) -> str:
        """What the journal calls a step."""
        return f"{self.name}/{step.number}"

    def exercise_subject(self, exercise: Exercise) -> str:
        """What the journal calls an exercise."""
        return f"{self.name}/{exercise.name}"
