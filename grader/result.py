"""What came of grading one submission: one record, from which every report is written.

Three verdicts: the work passes, the work fails, or the grader is broken. A broken grader costs no point and gives
none: the run has no grade, and somebody is told.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from enum import Enum
from typing import Any, Final

SCHEMA: Final = 1

LONGEST_LOG: Final = 4000
"""Characters of what a program printed that are kept with a test."""


class Status(Enum):
    """How one test ended."""

    PASS = "pass"
    PARTIAL = "partial"
    FAIL = "fail"
    STUDENT_ERROR = "student_error"
    TIMEOUT = "timeout"
    RESOURCE_LIMIT = "resource_limit"
    PROTOCOL_ERROR = "protocol_error"
    SKIPPED = "skipped"
    """Not judged: what it depends on did not pass, or what it needs is not here."""
    GRADER_ERROR = "grader_error"
    """Ours, not the student's."""


class Verdict(Enum):
    """What a run says of the work."""

    PASS = "pass"
    FAIL = "fail"
    BROKEN = "broken"


class Visibility(Enum):
    """When a student may see what came of a test."""

    VISIBLE = "visible"
    AFTER_DUE = "after_due"
    AFTER_PUBLISHED = "after_published"
    HIDDEN = "hidden"


@dataclass(frozen=True, slots=True)
class Episode:
    """One drive that a test looked at."""

    name: str
    """Which, in words that give no secret away: ``maze, secret seed 2``."""
    outcome: str
    steps: int
    measure: float | None
    """What the test measured; None where there was nothing to measure."""


@dataclass(frozen=True, slots=True)
class Test:
    """One criterion, judged."""

    __test__ = False  # for pytest: this is a record

    id: str
    title: str
    status: Status
    points: float
    max_points: float
    visibility: Visibility = Visibility.VISIBLE
    rationale: str = ""
    """What was wrong, in one or two sentences."""
    hints: tuple[str, ...] = ()
    """The way out, in steps: the first is the vaguest."""
    expected: str = ""
    actual: str = ""
    metrics: Mapping[str, float] = field(default_factory=dict)
    episodes: tuple[Episode, ...] = ()
    log: str = ""
    depends_on: str | None = None
    replay: str = ""
    """The worst episode as a picture in characters; may be empty."""

    def __post_init__(self) -> None:
        most = self.max_points if math.isfinite(self.max_points) and self.max_points > 0 else 0.0
        # Not min(max(...)): that lets NaN through.
        points = self.points if 0.0 <= self.points <= most else (most if self.points > most else 0.0)
        if self.status in (Status.SKIPPED, Status.GRADER_ERROR):
            points = 0.0
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "max_points", most)
        object.__setattr__(self, "log", self.log[:LONGEST_LOG])

    @property
    def is_judged(self) -> bool:
        return self.status not in (Status.SKIPPED, Status.GRADER_ERROR)

    def for_student(self) -> Test:
        """What a student may see at once: of a test that is not visible, no more than that there is one."""
        if self.visibility is Visibility.VISIBLE:
            return self
        return replace(
            self,
            rationale="This test's outcome is shown later.",
            hints=(),
            expected="",
            actual="",
            metrics={},
            episodes=(),
            log="",
            replay="",
        )


@dataclass(frozen=True, slots=True)
class Timing:
    """When, and how long: the only part of a result that differs from run to run."""

    started: str = ""
    """UTC, ISO 8601."""
    wall_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Result:
    """One submission, graded."""

    assignment: str
    assignment_version: str
    """A digest of what the assignment's folder says."""
    submission: str
    """A digest of what was handed in."""
    grader_version: str
    seeds: str
    """Which seed sets were used: ``public``, or ``public+secret``."""
    level: int
    """How far the program was locked in."""
    platform: str
    tests: tuple[Test, ...]
    notices: tuple[str, ...] = ()
    steps: int = 0
    """Of simulation, all episodes together."""
    timing: Timing = Timing()
    schema: int = SCHEMA

    @property
    def verdict(self) -> Verdict:
        if any(test.status is Status.GRADER_ERROR for test in self.tests):
            return Verdict.BROKEN
        judged = [test for test in self.tests if test.status is not Status.SKIPPED]
        withheld = any(test.status is Status.SKIPPED and test.depends_on is not None for test in self.tests)
        passed = all(test.status is Status.PASS for test in judged) and bool(judged) and not withheld
        return Verdict.PASS if passed else Verdict.FAIL

    @property
    def points(self) -> float | None:
        """The sum; None when the grader is broken, for then nothing is known."""
        if self.verdict is Verdict.BROKEN:
            return None
        return round(math.fsum(test.points for test in self.tests), 6)

    @property
    def max_points(self) -> float:
        return round(math.fsum(test.max_points for test in self.tests), 6)

    def as_dict(self) -> dict[str, Any]:
        """JSON-able, the sums included."""
        content = asdict(self)
        for test in content["tests"]:
            test["status"] = test["status"].value
            test["visibility"] = test["visibility"].value
        return content | {
            "verdict": self.verdict.value,
            "points": self.points,
            "max_points": self.max_points,
        }

    @classmethod
    def from_dict(cls, content: Mapping[str, Any]) -> Result:
        """What ``as_dict`` made. Raises KeyError, TypeError or ValueError if it is something else."""
        if content["schema"] != SCHEMA:
            raise ValueError(f"a result of schema {content['schema']}; this grader reads {SCHEMA}")
        given = {key: content[key] for key in cls.__slots__ if key not in ("tests", "timing", "notices")}
        return cls(
            **given,
            tests=tuple(_test(each) for each in content["tests"]),
            notices=tuple(content["notices"]),
            timing=Timing(**content["timing"]),
        )

    def for_student(self) -> Result:
        """What a student may see at once."""
        return replace(self, tests=tuple(test.for_student() for test in self.tests))


def _test(content: Mapping[str, Any]) -> Test:
    return Test(
        **{
            **content,
            "status": Status(content["status"]),
            "visibility": Visibility(content["visibility"]),
            "hints": tuple(content["hints"]),
            "episodes": tuple(Episode(**each) for each in content["episodes"]),
        }
    )


def amount(points: float) -> str:
    """Points as people write them: ``3``, ``2.5``."""
    return f"{points:.2f}".rstrip("0").rstrip(".")
