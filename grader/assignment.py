"""Records of one assignment. ``grader.reading`` reads them from its folder."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from grader.driving.service_calls import ServiceCall
from grader.scoring import Anchors
from grader.seeds import SeedSet
from kit.geometry import Pose
from kit.host.sandbox.limits import Limits
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import Visibility
from kit.run.scenario import Scenario

TEACHERS_STEMS: Final = ("secret", "solution", "solutions", "wrong", "reference")
"""Files and folders of an assignment, without their endings, that stay with the teacher."""
MAX_HINTS: Final = 3
"""The most hints a criterion may have, from the vaguest to the most specific."""
MAX_COUNTERPARTS: Final = 4
"""The most pieces of public evidence that are collected for one criterion to show why secret ones lost points."""
DEFAULT_SUBMISSION_LIMIT_S: Final = 600.0
"""The longest wall clock of one submission unless the assignment sets another: well below a CI runner's patience."""


@dataclass(frozen=True, slots=True)
class Shift:
    """The most that a seed moves the start to either side: m, m, rad."""

    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0


@dataclass(frozen=True, slots=True)
class Trial:
    """One set-up of episodes: the scenario, the time limit and the seeds."""

    name: str
    scenario: Scenario
    time_s: float
    """Simulated."""
    seeds: tuple[int, ...]
    """Public seeds, for practice."""
    secret_seeds: tuple[int, ...]
    """Seeds for the grade; empty on a student's machine."""
    shift: Shift
    noise: float | None
    """Standard deviation of every laser's readings [m]; None keeps that of the world file."""
    until_reached: bool
    """Whether the episode ends when the target is reached."""
    services: frozenset[str]
    """The world services that the program may call. ``move_model`` only ever sends the robot home."""
    parameters: tuple[str, ...] = ()
    """Each ``name:=value``, as on a command line."""
    topics: frozenset[str] = frozenset()
    """The ground-truth topics that the program may read, such as ``odometry/ground_truth``; without a leading slash
    those of every robot."""
    calls: tuple[ServiceCall, ...] = ()
    """Calls that the grader makes to the program's own services during the episode."""
    laser_range: float | None = None
    """Range of every laser [m]; None keeps that of the world file."""

    def home(self) -> Pose:
        """Returns the robot's start before a seed shifts it."""
        return self.scenario.start or Pose()


@dataclass(frozen=True, slots=True)
class KnownMistake:
    """A mistake that can be told from how a criterion was lost, and the hint that helps with it."""

    hint: str
    when: str = ""
    """A part of what the feedback says, in any case, and no part of a longer number; empty for any."""
    low: float = -math.inf
    high: float = math.inf
    """The range of the measure, both ends included."""
    passed: str | None = None
    """Id of an earlier criterion that earned everything; None for any."""


@dataclass(frozen=True, slots=True)
class Criterion:
    """One graded property of the work, worth points."""

    id: str
    title: str
    check: str
    """Name of the check that measures it."""
    points: float
    anchors: Anchors
    params: Any
    """The check's own params record."""
    trials: tuple[str, ...]
    seeds: SeedSet
    need: float | None
    """The share of episodes that must earn full points; None takes the mean over all episodes. Episodes with secret seeds must
    do so by themselves too."""
    after: str | None
    """Id of a criterion: only episodes that earned full points there count."""
    visibility: Visibility
    hints: tuple[str, ...]
    feedback: str
    """The check's sentence, with placeholders for the measured values."""
    share_steps: int | None = None
    """The number of steps in which the points are paid once secret evidence counts; None where none is stated."""
    mistakes: tuple[KnownMistake, ...] = ()
    """The first that was made puts its hint before the others."""


@dataclass(frozen=True, slots=True)
class TeacherTest:
    """One test function of a teacher's, as its file declares it."""

    id: str
    points: float
    feedback: str = ""
    visibility: Visibility = Visibility.VISIBLE
    hints: tuple[str, ...] = ()
    after: str | None = None
    """Id of a criterion, or of an earlier test, that must earn everything first."""

    @property
    def title(self) -> str:
        words = self.id.removeprefix("test_").replace("_", " ").strip()
        return words[:1].upper() + words[1:]


@dataclass(frozen=True, slots=True)
class GridTask:
    """The grid on which a reward's optimal behaviour is computed; see ``grader.kinds.reward.task_model``."""

    rows: tuple[str, ...]
    """``#`` wall, ``.`` floor, ``G`` target."""
    discount: float
    max_steps: int


@dataclass(frozen=True, slots=True)
class Assignment:
    """One assignment, as its folder describes it."""

    folder: Path
    id: str
    title: str
    kind: str
    """The kind of submission: a module of ``grader.kinds``."""
    submit: str
    """Name of the submitted file."""
    level: Level
    """The lowest confinement level at which secret seeds are used. 0 allows the check of one's own work to use them; it
    does not lower the level of a program, which is 0 only where that is requested."""
    limits: Limits
    trials: tuple[Trial, ...]
    criteria: tuple[Criterion, ...]
    task: Any
    """The kind's own record: a ``GridTask`` for a reward."""
    version: str
    """Digest of the folder's files that decide a grade."""
    has_secrets: bool
    evidence_version: str = ""
    """Digest of what decides what is found about a submission: the same files without words, points and what else only
    decides what that is worth."""
    secret_seeds: tuple[int, ...] = ()
    """All of its secret seeds."""
    public_version: str = ""
    """Digest of the same files without the secret one, for students: a digest of short secrets gives them away."""
    packages: tuple[str, ...] = ()
    """Packages whose devices, checks and kinds are loaded while its submissions are graded."""
    teacher_tests: tuple[TeacherTest, ...] = ()
    """Tests in the order of their files."""
    teacher_test_files: tuple[Path, ...] = ()
    submission_limit_s: float = DEFAULT_SUBMISSION_LIMIT_S
    """Wall clock of everything that is run of one submission."""

    @property
    def max_points(self) -> float:
        return sum(each.points for each in self.tests)

    @property
    def tests(self) -> tuple[Criterion | TeacherTest, ...]:
        """Everything that earns points, in grading order."""
        return (*self.criteria, *self.teacher_tests)

    def trial(self, name: str) -> Trial:
        return next(trial for trial in self.trials if trial.name == name)

    def criterion(self, identity: str) -> Criterion:
        return next(each for each in self.criteria if each.id == identity)
