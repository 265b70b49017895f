"""A reward function, graded by the behaviour that is optimal under it."""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Final

from grader.assignment import Assignment, GridTask
from grader.evidence.contract import EvidenceCollector, EvidenceOptions, FixedEvidence
from grader.kinds.contract import AssignmentFiles, KindSettings, SubmissionKind
from grader.kinds.reward.checks import CHECKS
from grader.kinds.reward.evidence import RewardEvidence
from grader.kinds.reward.sheet_keys import SHEET_KEYS
from kit.plain_text import quoted
from kit.world.yaml_section import Section

MAX_GRID_SIZE: Final = 40
"""Rows and columns of a grid."""


def read_settings(files: AssignmentFiles) -> KindSettings:
    """Reads the grid on which the reward is evaluated."""
    return KindSettings(task=_grid(files.public.section("grid")))


def collect(
    assignment: Assignment, file: Path, options: EvidenceOptions
) -> AbstractContextManager[EvidenceCollector]:
    """Evaluates the function once, for all criteria."""
    evidence = RewardEvidence(file, assignment, options.level, options.clock)
    return nullcontext(FixedEvidence([evidence], options.level))


def _grid(section: Section) -> GridTask:
    rows = tuple(line.rstrip() for line in section.text("map").splitlines() if line.strip())
    made = GridTask(
        rows,
        section.number("discount", 0.98, above=0, maximum=0.999),
        section.integer("max_steps", 200, minimum=1, maximum=10_000),
    )
    section.finish()
    if not rows or len({len(row) for row in rows}) != 1 or max(len(rows), len(rows[0])) > MAX_GRID_SIZE:
        section.error(
            f"{quoted('map')} must be rows of equal length, at most {MAX_GRID_SIZE} by {MAX_GRID_SIZE}", "map"
        )
    elif set("".join(rows)) - set("#.G") or "".join(rows).count("G") != 1:
        section.error(
            f"{quoted('map')} is drawn with # for a wall, . for floor and exactly one G, the target", "map"
        )
    elif any(row[0] + row[-1] != "##" for row in rows) or set(rows[0] + rows[-1]) != {"#"}:
        section.error(f"{quoted('map')} must have walls all around", "map")
    return made


KIND: Final = SubmissionKind((".py",), CHECKS, read_settings, collect, sheet_keys=SHEET_KEYS)
