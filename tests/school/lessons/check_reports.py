"""Reports of checks that were not run."""

from __future__ import annotations

from kit.results.grading_result import CriterionResult, CriterionStatus, GradingResult, GradingVerdict
from kit.school.lessons.checking import CheckReport


def lost(name: str, *hints: str, knows_mistake: bool = False) -> CriterionResult:
    """A criterion that was not met."""
    status = CriterionStatus.FAIL
    return CriterionResult(name, name, status, 0.0, 1.0, hints=hints, knows_mistake=knows_mistake)


def report_of(*criteria: CriterionResult) -> CheckReport:
    """The report of a check that lost all of these."""
    result = GradingResult("colour", "", "", "", "public", 0, "", criteria)
    return CheckReport(GradingVerdict.FAIL, result, 1.0)
