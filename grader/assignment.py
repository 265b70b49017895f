"""What a teacher asks for: one assignment, as records. ``grader.reading`` makes them of a folder."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from typing import Any

from grader.evidence.service_calls import ServiceCall
from grader.scoring import Anchors
from kit.geometry import Pose
from kit.host.sandbox.confinement import Level
from kit.host.sandbox.limits import Limits
from kit.run.scenario import Scenario
from kit.school.result import Visibility


class SeedSet(Enum):
    """Which seeds a criterion is judged on."""

    PUBLIC = "public"
    SECRET = "secret"
    ALL = "all"


@dataclass(frozen=True, slots=True)
class Shift:
    """How far a seed may move the start to either side: m, m, rad."""

    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0


@dataclass(frozen=True, slots=True)
class Trial:
    """A kind of episode: where, for how long, and with which seeds."""

    name: str
    place: Scenario
    time_s: float
    """Simulated."""
    seeds: tuple[int, ...]
    """For practice: everybody may know them."""
    secret_seeds: tuple[int, ...]
    """For the grade. Empty on a student's machine."""
    shift: Shift
    noise: float | None
    """Standard deviation of every laser's readings [m]; None: as the world file says."""
    until_reached: bool
    """Whether the episode ends when the target is reached."""
    services: frozenset[str]
    """Which of the world's services the program may change it with. ``move_model`` only ever sends the robot home."""
    parameters: tuple[str, ...] = ()
    """Each ``name:=value``, as one gives them on a command line."""
    calls: tuple[ServiceCall, ...] = ()
    """What the program is asked meanwhile, in services of its own."""

    def home(self) -> Pose:
        """Where the robot starts, before a seed shifts it."""
        return self.place.start or Pose()


@dataclass(frozen=True, slots=True)
class Criterion:
    """One thing that is judged, for points."""

    id: str
    title: str
    check: str
    """Its name in the table of checks."""
    points: float
    anchors: Anchors
    params: Any
    """The record that the check declares; whatever the check measures with."""
    trials: tuple[str, ...]
    seeds: SeedSet
    need: float | None
    """The share of episodes that must earn everything; None: the mean of what each earns counts."""
    after: str | None
    """Only episodes in which this criterion earned everything count."""
    visibility: Visibility
    hints: tuple[str, ...]
    feedback: str
    """The check's own sentence, to be filled with what was measured."""


@dataclass(frozen=True, slots=True)
class TeacherTest:
    """One test function of a teacher's, as its file declares it."""

    id: str
    points: float
    feedback: str = ""
    visibility: Visibility = Visibility.VISIBLE
    hints: tuple[str, ...] = ()

    @property
    def title(self) -> str:
        words = self.id.removeprefix("test_").replace("_", " ").strip()
        return words[:1].upper() + words[1:]


@dataclass(frozen=True, slots=True)
class GridTask:
    """The small model of a task that a reward is planned on. See ``grader.evidence.task_model``."""

    rows: tuple[str, ...]
    """``#`` wall, ``.`` floor, ``G`` target."""
    discount: float
    max_steps: int


@dataclass(frozen=True, slots=True)
class Assignment:
    """Everything of one folder."""

    folder: Path
    id: str
    title: str
    kind: str
    """What is handed in: a module of ``grader.kinds``."""
    submit: str
    """The name of the file that is handed in."""
    level: Level
    """The least confinement at which secrets are used."""
    limits: Limits
    trials: tuple[Trial, ...]
    criteria: tuple[Criterion, ...]
    task: Any
    """The kind's own record: a ``GridTask`` for a reward."""
    version: str
    """A digest of the folder's files: any change makes another one."""
    has_secrets: bool
    teacher_tests: tuple[TeacherTest, ...] = ()
    """The teacher's, in the order of their files."""
    teacher_test_files: tuple[Path, ...] = ()

    @property
    def max_points(self) -> float:
        return sum(each.points for each in self.tests)

    @property
    def tests(self) -> tuple[Criterion | TeacherTest, ...]:
        """Everything that earns points, in the order in which it is judged."""
        return (*self.criteria, *self.teacher_tests)

    def trial(self, name: str) -> Trial:
        return next(trial for trial in self.trials if trial.name == name)


MAX_HINTS = 3
"""A criterion has at most so many hints: the first says where to look, the last nearly how."""
