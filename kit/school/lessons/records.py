"""The records of a lesson: steps in order, one idea each, some with an exercise."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal

from kit.host.sandbox.sandbox_config import INTERACTIVE_LEVEL, Level
from kit.learning.grid.grid_learner import GridLearnerSettings
from kit.learning.grid.grid_world import GridWorld

if TYPE_CHECKING:
    from kit.host.sandbox.sandbox_config import Level
    from kit.school.lessons.own_learners import KeptLines

RECORDING_SUFFIX: Final = ".npz"


class StepKind(StrEnum):
    """The kind of activity of a step."""

    PREDICT = "predict"
    RUN = "run"
    EXPLAIN = "explain"
    MODIFY = "modify"
    MAKE = "make"


class CommandKind(StrEnum):
    """The way a command of a step is run, by students and by tests."""

    ALONE = "alone"
    """Runs and ends by itself."""
    SCREEN = "screen"
    """Opens a screen."""
    BESIDE = "beside"
    """Needs a world that runs in another terminal."""


@dataclass(frozen=True, slots=True)
class LessonScene:
    """A world shown in a step: map, controller and duration."""

    map_name: str
    """A map of the kit, or a world file in the lesson's folder."""
    case: str | None
    controller: str
    """Name of one of the kit's controllers, or a file in the lesson's folder; empty: nothing drives."""
    seed: int
    seconds: float
    """Simulated time [s], after which the scene stops."""
    is_foreign: bool = False
    """Whether its controller is somebody else's, and runs as confined as this machine can."""


LearningCurve = Literal["steps", "return"]


@dataclass(frozen=True, slots=True)
class LearningScene:
    """Learners of a grid world, shown in a step: values and best moves on the floor."""

    world: GridWorld
    learners: tuple[GridLearnerSettings, ...]
    titles: tuple[str, ...]
    """Title of each learner."""
    episodes: int
    """Episodes of each learner; 0: as many as fit into ``updates``."""
    seconds: float
    """Time in which it is shown [s]."""
    curve: LearningCurve = "steps"
    """What is drawn of each episode: its steps, or its return."""
    curve_low: float | None = None
    """The least value shown; None: a round number below the data's."""
    curve_high: float | None = None
    curve_mean: int = 1
    """Episodes whose mean is one point of the curve."""
    updates: int = 0
    """Updates of each learner; 0: as many as ``episodes`` need."""
    own: tuple[str, ...] = ()
    """The exercises of the lesson whose lines learn, in place of the kit's; see ``own_learners``."""
    lines: KeptLines | None = None
    """What those lines answered; None until they have learned."""


@dataclass(frozen=True, slots=True)
class GraphChannel:
    """A topic or a service in a graph scene, and when something is sent on it."""

    name: str
    """Its full name."""
    sender: str
    """Full name of the node that publishes, or that calls the service."""
    receivers: tuple[str, ...]
    """Full names of the nodes that subscribe; of a service, the one that answers."""
    rate: float | None
    """Messages per second; None: they are sent at ``times``."""
    times: tuple[float, ...] = ()
    """From the scene's beginning [s]."""
    is_service: bool = False
    undelivered: tuple[str, ...] = ()
    """Those of the receivers to whom nothing is delivered; a cross says so once the scene has begun."""
    asked: str = ""
    """Shown in place of the name until the scene begins: the name that a prediction asks for."""


@dataclass(frozen=True, slots=True)
class GraphScene:
    """Nodes and topics, shown in a step with messages on their way."""

    channels: tuple[GraphChannel, ...]
    seconds: float
    """Time in which it is shown [s]."""

    @property
    def least_rows(self) -> int:
        """Rows that its drawing, an empty one, and its words need at least."""
        receivers = {node for each in self.channels for node in each.receivers}
        return max(len(receivers), len(self.channels)) + 1 + len(self.channels)


@dataclass(frozen=True, slots=True)
class LessonCommand:
    """A command that a step shows."""

    line: str
    kind: CommandKind
    map_name: str
    """Map of the world that must run meanwhile, for ``BESIDE``."""
    shows: tuple[str, ...] = ()
    """Words that it prints, or that stand on the screen that it opens: what the step says of its output. Tests look for
    them."""


@dataclass(frozen=True, slots=True)
class PredictionOption:
    """One option of a prediction."""

    text: str
    is_right: bool
    feedback: str


@dataclass(frozen=True, slots=True)
class Exercise:
    """An exercise, checked by the grader."""

    name: str
    """Unique in its lesson: the folder beside the lesson's file, which is the grader's assignment."""
    folder: Path
    file: str
    """Name of the file that the student edits."""
    seconds: float
    """Upper limit of the time of one check on two cores [s]."""
    edited_first: str = ""
    """The file to change, where that is another one: a path from the folder of ``file``."""
    words: Mapping[str, str] = field(default_factory=dict, compare=False)
    """Titles and hints of its criteria, with single blanks, to what they are in the language of the lesson; see
    ``translation``. Empty in the original."""

    @property
    def is_driven(self) -> bool:
        """Whether a recording of a drive is submitted, not a file that the student writes."""
        return self.file.endswith(RECORDING_SUFFIX)

    @property
    def is_program(self) -> bool:
        """Whether one file of Python is submitted, which may be asked about; see ``defence``."""
        return self.file.endswith(".py")


@dataclass(frozen=True, slots=True)
class LessonClaim:
    """Words of a step that state a fact, and what proves them."""

    words: str
    """The words as written in the step, with single spaces."""
    derivation: str
    """Name of the tests' derivation that finds the same words out again."""


@dataclass(frozen=True, slots=True)
class LessonStep:
    """One step of a lesson, shown on one screen."""

    number: int
    """Counted from 1."""
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
    """Question of a prediction; else empty."""
    options: tuple[PredictionOption, ...]
    exercise: Exercise | None
    claims: tuple[LessonClaim, ...] = ()
    learning: LearningScene | None = None
    graph: GraphScene | None = None

    @property
    def playback_scene(self) -> LearningScene | GraphScene | None:
        """What is played without a world, if anything: tables that learn, or nodes that send messages."""
        return self.graph if self.own_agent is not None else self.learning or self.graph

    @property
    def own_agent(self) -> LearningScene | None:
        """What the student's own lines are to learn in this step, if anything."""
        return self.learning if self.learning is not None and self.learning.own else None

    @property
    def moves(self) -> bool:
        """Whether its picture moves: a world that runs, tables that learn, or messages on their way."""
        return self.scene is not None or self.playback_scene is not None

    @property
    def runnable_commands(self) -> list[LessonCommand]:
        """The step's commands; in place of each that inspects a world, the one that opens this world."""
        made = [each for each in self.commands if each.kind is not CommandKind.BESIDE]
        places = dict.fromkeys(each.map_name for each in self.commands if each.kind is CommandKind.BESIDE)
        worlds = [LessonCommand(f"kit drive {place}", CommandKind.SCREEN, place) for place in places]
        return list({each.line: each for each in (*made, *worlds)}.values())

    @property
    def wording(self) -> str:
        """Everything that the step says, in one line with single blanks and without the markup of bold words."""
        parts = [self.text, self.picture, self.question]
        parts += [part for option in self.options for part in (option.text, option.feedback)]
        return " ".join(" ".join(parts).replace("**", "").split())


@dataclass(frozen=True, slots=True)
class LessonUnit:
    """Lessons that belong together."""

    letter: str
    """Its place in the course: ``A`` for the first."""
    title: str
    opener: str
    """What they are about, in a few sentences."""
    lessons: tuple[str, ...]
    """The names of their folders, in the order in which to take them."""


@dataclass(frozen=True, slots=True)
class Lesson:
    """One lesson."""

    name: str
    """The name of its folder: ``01-drive``."""
    number: str
    """Its number in the course: ``A2``."""
    folder: Path
    title: str
    summary: str
    minutes: int
    """Expected duration of the whole lesson."""
    outcomes: tuple[str, ...]
    outcome_ids: tuple[str, ...]
    """Ids of outcomes and practical concepts in ``outcomes.yaml``."""
    steps: tuple[LessonStep, ...]
    is_foreign: bool = False
    """Whether it is not one of the kit's own."""
    missing_language: str = ""
    """The language that was asked for, by its two letters, where the lesson has no words in it."""

    @property
    def exercises(self) -> tuple[Exercise, ...]:
        return tuple(step.exercise for step in self.steps if step.exercise is not None)

    def scene_near(
        self, number: int, *, has_worlds: bool = True
    ) -> LessonScene | LearningScene | GraphScene | None:
        """What moves in a step, else in the nearest one before it that has such a picture, else in the nearest one after it.
        ``has_worlds``: whether a world is such a picture, or only tables and messages are."""
        steps = sorted(self.steps, key=lambda step: (step.number > number, abs(step.number - number)))
        return next(
            (scene for step in steps if (scene := (has_worlds and step.scene) or step.playback_scene)), None
        )

    def step_subject(self, step: LessonStep) -> str:
        """The journal's subject for a step."""
        return f"{self.name}/{step.number}"

    def exercise_subject(self, exercise: Exercise) -> str:
        """The journal's subject for an exercise."""
        return f"{self.name}/{exercise.name}"


def scene_confinement_level(scene: LessonScene) -> Level:
    """How far the controller of a lesson's scene is confined: the kit's own run as a student's do; somebody else's as
    confined as this machine can. Slow the first time: the machine is asked what it can."""
    from kit.host.sandbox.probe import highest_level_up_to

    return highest_level_up_to(max(Level)) if scene.is_foreign else INTERACTIVE_LEVEL
