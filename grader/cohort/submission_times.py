"""When works were handed in, and by which students: read from a table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime, tzinfo
from pathlib import Path
from typing import Final

from grader.cohort.csv_file import read_csv_file
from grader.cohort.lateness import EXAMPLE, parse_time


@dataclass(frozen=True, slots=True)
class SubmissionTime:
    """When a submission was handed in, and by which student."""

    at: datetime
    student: str
    """By default the submission's own name."""


def read_submission_times(file: Path, zone: tzinfo | None = None) -> Mapping[str, SubmissionTime]:
    """Reads a CSV file with the columns ``name`` and ``submitted``, and ``student`` if some submit more than once; or Moodle's
    grading worksheet, by its participants.

    ``zone``: of times that name none. Raises ValueError, OSError.
    """
    arrivals: dict[str, SubmissionTime] = {}
    titles, *rows = read_csv_file(file) or [[]]
    of_moodle = MOODLE_SUBMITTED in titles
    for number, fields in enumerate(rows, 2):
        if not fields:
            continue
        row = dict(zip(titles, fields, strict=False))
        name = (
            (row.get("Identifier") or "").removeprefix("Participant ") if of_moodle else row.get("name") or ""
        )
        submitted = (row.get(MOODLE_SUBMITTED if of_moodle else "submitted") or "").strip()
        if of_moodle and submitted in ("", "-"):
            continue  # who handed in nothing
        if not name:
            raise ValueError(f"{file}:{number}: a row needs a name, and a time such as {EXAMPLE}")
        try:
            at = parse_time(submitted, zone)
        except ValueError as problem:
            raise ValueError(f"{file}:{number}: submitted {problem}") from None
        if name in arrivals:
            raise ValueError(f"{file}:{number}: {name} is there twice")
        arrivals[name] = SubmissionTime(at, (row.get("student") or "").strip() or name)
    return arrivals


MOODLE_SUBMITTED: Final = "Last modified (submission)"
