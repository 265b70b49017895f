"""Late work: a pure function of when it came and what it earned, applied when a gradebook is written, never before."""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from kit.world.documents import WorldDocuments
from kit.world.files import AllowedRoot
from kit.world.problems import ProblemCollector
from kit.world.records import SourceLocation

DAY = 86400.0
"""s"""


@dataclass(frozen=True, slots=True)
class LatePolicy:
    """What lateness costs."""

    due: datetime
    grace_s: float = 0.0
    per_day: float = 0.1
    """Share of the points lost for each day begun."""
    least: float = 0.0
    """Share that is always kept, until it is too late."""
    latest_days: float | None = None
    """After so many days nothing counts; None: it always does."""

    def kept(self, submitted: datetime) -> float:
        """The share of its points that a work keeps."""
        late = (submitted - self.due).total_seconds() - self.grace_s
        if late <= 0:
            return 1.0
        if self.latest_days is not None and late > self.latest_days * DAY:
            return 0.0
        return max(self.least, 1.0 - self.per_day * math.ceil(late / DAY), 0.0)


def read_policy(file: Path) -> LatePolicy:
    """``due``, ``grace_minutes``, ``per_day``, ``least``, ``latest_days`` from a YAML file. Raises WorldError."""
    problems = ProblemCollector()
    section = WorldDocuments(AllowedRoot.containing(file), {}, problems).section(file, SourceLocation(file))
    problems.raise_if_any()
    assert section is not None  # None is noted as a problem
    due = parse_time(section.name("due"))
    if due is None:
        section.error("must be a date and time such as 2026-11-30T23:59:00+01:00", "due")
    policy = LatePolicy(
        due or datetime.now(UTC),
        60 * section.number("grace_minutes", 0.0, minimum=0),
        section.number("per_day", 0.1, minimum=0, maximum=1),
        section.number("least", 0.0, minimum=0, maximum=1),
        section.number("latest_days", minimum=0) if section.has("latest_days") else None,
    )
    section.finish()
    problems.raise_if_any()
    return policy


@dataclass(frozen=True, slots=True)
class SubmissionTime:
    """When a submission came, and whose it is."""

    at: datetime
    student: str
    """By default its own name."""


def read_submission_times(file: Path) -> Mapping[str, SubmissionTime]:
    """A CSV file with the columns ``name`` and ``submitted``, and ``student`` where some hand in more than once.

    Raises ValueError, OSError.
    """
    arrivals = {}
    with file.open(newline="", encoding="utf-8-sig") as opened:
        for number, row in enumerate(csv.DictReader(opened), 2):
            name, at = row.get("name") or "", parse_time(row.get("submitted") or "")
            if at is None or not name:
                raise ValueError(
                    f"{file}:{number}: a row needs a name and a time such as 2026-11-30T23:59:00+01:00"
                )
            if name in arrivals:
                raise ValueError(f"{file}:{number}: {name} is there twice")
            arrivals[name] = SubmissionTime(at, (row.get("student") or "").strip() or name)
    return arrivals


def parse_time(text: str) -> datetime | None:
    """A date and time; one without a zone is UTC."""
    try:
        at = datetime.fromisoformat(text.strip())
    except ValueError:
        return None
    return at if at.tzinfo is not None else at.replace(tzinfo=UTC)
