"""The status that a criterion has when the submitted program failed."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from kit.host.failure import Failure, FailureKind
from kit.results.grading_result import CriterionStatus

STATUS_BY_FAILURE: Final[Mapping[FailureKind, CriterionStatus]] = MappingProxyType(
    {
        FailureKind.TIMEOUT: CriterionStatus.TIMEOUT,
        FailureKind.MEMORY: CriterionStatus.RESOURCE_LIMIT,
        FailureKind.DISK: CriterionStatus.RESOURCE_LIMIT,
        FailureKind.KILLED: CriterionStatus.RESOURCE_LIMIT,
        FailureKind.FLOOD: CriterionStatus.RESOURCE_LIMIT,
        FailureKind.PROTOCOL: CriterionStatus.PROTOCOL_ERROR,
        FailureKind.CONFINEMENT: CriterionStatus.GRADER_ERROR,
    }
)
"""The status that a failure of the program gives a criterion; any other kind is a student error."""


def status_of_failure(failure: Failure | None) -> CriterionStatus:
    """Returns the status of a criterion that earns nothing, by how the program failed; None if it did not."""
    return (
        CriterionStatus.FAIL
        if failure is None
        else STATUS_BY_FAILURE.get(failure.kind, CriterionStatus.STUDENT_ERROR)
    )
