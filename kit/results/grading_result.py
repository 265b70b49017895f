"""The result of grading one submission.

A run of the grader ends in one of three verdicts: the work passes, the work fails, or the grader is broken. A broken
grader neither gives nor takes points: the run has no grade.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from datetime import datetime
from enum import StrEnum
from typing import Any, Final, TypeVar

from kit.field_types import check_field_types

R = TypeVar("R")

SCHEMA: Final = 1

PUBLIC_SEEDS: Final = "public"
"""The name of the public sets of seeds; see ``GradingResult.seeds``."""
WITH_SECRET: Final = "public+secret"
"""The same with the secret ones."""

MAX_LOG_LENGTH: Final = 4000
"""Characters of a program's output that are kept with a criterion."""
_OWN_READING: Final = ("tests", "notices", "timing")
"""Fields of a result that ``from_dict`` does not take as they are."""


class CriterionStatus(StrEnum):
    """The status of one criterion after judging."""

    PASS = "pass"
    PARTIAL = "partial"
    FAIL = "fail"
    STUDENT_ERROR = "student_error"
    TIMEOUT = "timeout"
    RESOURCE_LIMIT = "resource_limit"
    PROTOCOL_ERROR = "protocol_error"
    SKIPPED = "skipped"
    """Not judged: a criterion that it depends on did not pass, or something that it needs is missing here."""
    GRADER_ERROR = "grader_error"
    """An error of the grader, not of the student."""


PUBLIC_CASES: Final = "public cases: "
"""Begins the line of a check's progress that tells what the public cases came to, before any secret one is run."""


class GradingVerdict(StrEnum):
    """The verdict on a whole submission."""

    PASS = "pass"
    FAIL = "fail"
    BROKEN = "broken"


class Visibility(StrEnum):
    """When a student may see the result of a criterion."""

    VISIBLE = "visible"
    AFTER_DUE = "after_due"
    AFTER_PUBLISHED = "after_published"
    HIDDEN = "hidden"


@dataclass(frozen=True, slots=True)
class EpisodeSummary:
    """One episode that a criterion was judged by."""

    name: str
    """Identifies the episode without giving a secret away: ``maze, secret seed 2``."""
    outcome: str
    steps: int
    measure: float | None
    """The value that the criterion measured; None where there was nothing to measure."""
    secret: bool = False
    """Whether it was run with a secret seed; no student sees it then."""


@dataclass(frozen=True, slots=True)
class CriterionResult:
    """The result of one criterion. ``points`` are clipped to 0 .. ``max_points``; NaN counts as 0."""

    id: str
    title: str
    status: CriterionStatus
    points: float
    max_points: float
    visibility: Visibility = Visibility.VISIBLE
    rationale: str = ""
    """The reason for lost points, in one or two sentences."""
    hints: tuple[str, ...] = ()
    """Steps of help, from the vaguest to the most specific."""
    knows_mistake: bool = False
    """Whether the first of them is for the very mistake that was made."""
    expected: str = ""
    actual: str = ""
    metrics: Mapping[str, float] = field(default_factory=dict)
    episodes: tuple[EpisodeSummary, ...] = ()
    log: str = ""
    """Output of the student's program."""
    depends_on: str | None = None
    replay: str = ""
    """The worst public episode as a picture in characters; may be empty."""
    uses_secrets: bool = False
    """Whether secret evidence counts in the points. All texts but ``teacher_note`` are made from public evidence, but in a
    student's own check where that shows no mistake."""
    teacher_note: str = ""
    """What went wrong with secret evidence; no student sees it."""
    is_withheld: bool = False
    """Whether status and points are left out because a student may not see them yet."""

    def __post_init__(self) -> None:
        most = self.max_points if math.isfinite(self.max_points) and self.max_points > 0 else 0.0
        # Not min(max(...)): that lets NaN through.
        points = self.points if 0.0 <= self.points <= most else (most if self.points > most else 0.0)
        if not self.is_judged:
            points = 0.0
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "max_points", most)
        object.__setattr__(self, "log", self.log[:MAX_LOG_LENGTH])

    @property
    def is_judged(self) -> bool:
        return self.status not in (CriterionStatus.SKIPPED, CriterionStatus.GRADER_ERROR)

    @property
    def is_passed(self) -> bool:
        return self.status is CriterionStatus.PASS

    def without_secrets(self) -> CriterionResult:
        """A copy without what secret evidence showed, except the points: they are paid in whole steps."""
        if not self.uses_secrets:
            return self
        return replace(
            self,
            episodes=tuple(each for each in self.episodes if not each.secret),
            teacher_note="",
            # A traceback of the grader's may show what it worked on.
            log="" if self.status is CriterionStatus.GRADER_ERROR else self.log,
        )

    def for_student(self) -> CriterionResult:
        """A copy that a student may see now: of a criterion that is not visible only its title."""
        if self.visibility is Visibility.VISIBLE:
            return self.without_secrets()
        is_broken = self.status is CriterionStatus.GRADER_ERROR
        return CriterionResult(
            self.id,
            self.title,
            # An error of the grader is none of the student's results: it says that there is no grade.
            CriterionStatus.GRADER_ERROR if is_broken else CriterionStatus.SKIPPED,
            0.0,
            0.0,
            self.visibility,
            rationale="This test's outcome is shown later.",
            is_withheld=True,
        )


@dataclass(frozen=True, slots=True)
class GradingTiming:
    """Start and duration: the only part of a result that differs from run to run."""

    started: str = ""
    """UTC, ISO 8601."""
    wall_s: float = 0.0


@dataclass(frozen=True, slots=True)
class GradingResult:
    """The result of grading one submission."""

    assignment: str
    assignment_version: str
    """A digest of the assignment's folder."""
    submission: str
    """A digest of the submitted files."""
    grader_version: str
    seeds: str
    """The sets of seeds that were used: ``public``, or ``public+secret``."""
    level: int
    """Confinement level of the student's program, 0 to 3."""
    platform: str
    tests: tuple[CriterionResult, ...]
    """One per criterion, in the assignment's order."""
    notices: tuple[str, ...] = ()
    steps: int = 0
    """Simulated steps, summed over all episodes."""
    secret_steps: int = 0
    """Those of episodes with secret seeds."""
    public_version: str = ""
    """A digest of the assignment's folder without its secrets; takes the place of ``assignment_version`` for students."""
    timing: GradingTiming = GradingTiming()
    schema: int = SCHEMA

    @property
    def verdict(self) -> GradingVerdict:
        if any(test.status is CriterionStatus.GRADER_ERROR for test in self.tests):
            return GradingVerdict.BROKEN
        judged = [test for test in self.tests if test.status is not CriterionStatus.SKIPPED]
        withheld = any(
            test.status is CriterionStatus.SKIPPED and test.depends_on is not None for test in self.tests
        )
        has_passed = bool(judged) and all(test.is_passed for test in judged) and not withheld
        return GradingVerdict.PASS if has_passed else GradingVerdict.FAIL

    @property
    def points(self) -> float | None:
        """The sum of the points; None when the grader is broken, since nothing is known then."""
        if self.verdict is GradingVerdict.BROKEN:
            return None
        return round(math.fsum(test.points for test in self.tests), 6)

    @property
    def max_points(self) -> float:
        return round(math.fsum(test.max_points for test in self.tests), 6)

    def as_dict(self) -> dict[str, Any]:
        """The result as JSON-able data, with the verdict and the sums."""
        content = asdict(self)
        for test in content["tests"]:
            test["status"] = test["status"].value
            test["visibility"] = test["visibility"].value
            if test["is_withheld"]:
                is_broken = test["status"] == CriterionStatus.GRADER_ERROR.value
                test |= {"status": test["status"] if is_broken else None, "points": None, "max_points": None}
        return content | {
            "verdict": self.verdict.value,
            "points": self.points,
            "max_points": self.max_points,
        }

    @classmethod
    def from_dict(cls, content: Mapping[str, Any]) -> GradingResult:
        """The result that ``as_dict`` wrote. Raises KeyError, TypeError or ValueError for other data."""
        if content["schema"] != SCHEMA:
            raise ValueError(f"a result of schema {content['schema']}; this version reads schema {SCHEMA}")
        given = {key: content[key] for key in cls.__slots__ if key not in _OWN_READING}
        check_field_types(cls, {**given, "notices": content["notices"]})
        return cls(
            **given,
            tests=tuple(_criterion_from_dict(each) for each in content["tests"]),
            notices=tuple(content["notices"]),
            timing=_timing_from_dict(content["timing"]),
        )

    def without_secrets(self) -> GradingResult:
        """A copy without what secret evidence showed, except the points: no measure, step count or duration."""
        if self.seeds == PUBLIC_SEEDS:
            return replace(self, assignment_version=self.public_version or self.assignment_version)
        return replace(
            self,
            assignment_version=self.public_version,
            tests=tuple(test.without_secrets() for test in self.tests),
            steps=self.steps - self.secret_steps,
            secret_steps=0,
            timing=replace(self.timing, wall_s=0.0),
        )

    def for_student(self) -> GradingResult:
        """A copy that a student may see now. The sums and the verdict leave out what is withheld."""
        return replace(self.without_secrets(), tests=tuple(test.for_student() for test in self.tests))


def _timing_from_dict(content: Mapping[str, Any]) -> GradingTiming:
    timing = _checked_record(GradingTiming, content)
    if timing.started:
        datetime.fromisoformat(timing.started)
    return timing


def _criterion_from_dict(content: Mapping[str, Any]) -> CriterionResult:
    if content["is_withheld"]:
        status = content["status"] or CriterionStatus.SKIPPED
        content = {**content, "status": status, "points": 0.0, "max_points": 0.0}
    read = {
        **content,
        "status": CriterionStatus(content["status"]),
        "visibility": Visibility(content["visibility"]),
        "episodes": tuple(_checked_record(EpisodeSummary, each) for each in content["episodes"]),
    }
    check_field_types(CriterionResult, read)
    criterion = CriterionResult(**{**read, "hints": tuple(content["hints"])})
    if criterion.points != content["points"] or criterion.max_points != content["max_points"]:
        raise ValueError(f"{content['points']} of {content['max_points']} points")
    return criterion


def _checked_record(record: type[R], content: Mapping[str, Any]) -> R:
    check_field_types(record, content)
    return record(**content)
