"""Late rules, applied when a gradebook is written and never before."""

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
    """How many points lateness costs."""

    due: datetime
    grace_s: float = 0.0
    per_day: float = 0.1
    """Share of the points lost for each day begun."""
    least: float = 0.0
    """Share that is always kept, until ``latest_days``."""
    latest_days: float | None = None
    """Days after which nothing counts; None for no such limit."""

    def kept(self, submitted: datetime) -> float:
        """Returns the share of its points that a submission keeps."""
        late = (submitted - self.due).total_seconds() - self.grace_s
        if late <= 0:
            return 1.0
        if self.latest_days is not None and late > self.latest_days * DAY:
            return 0.0
        return max(self.least, 1.0 - self.per_day * math.ceil(late / DAY), 0.0)


def read_policy(file: Path) -> LatePolicy:
    """Reads ``due``, ``grace_minutes``, ``per_day``, ``least`` and ``latest_days`` from a YAML file. Raises WorldError."""
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
    """When a submission was handed in, and by which student."""

    at: datetime
    student: str
    """By default the submission's own name."""


def read_submission_times(file: Path) -> Mapping[str, SubmissionTime]:
    """Reads a CSV file with the columns ``name`` and ``submitted``, and ``student`` if some submit more than once.

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
    """Parses a date and time; without a zone it is UTC. Returns None for anything else."""
    try:
        at = datetime.fromisoformat(text.strip())
    except ValueError:
        return None
    return at if at.tzinfo is not None else at.replace(tzinfo=UTC)
