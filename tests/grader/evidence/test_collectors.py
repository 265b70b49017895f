"""Collectors of episodes: what is not run any more of a program that has died."""

from __future__ import annotations

import pytest

from grader.evidence.contract import EpisodeCollector, EpisodeSpec, EvidenceOptions, EvidenceRecord
from grader.evidence.submission_clock import MAX_TIMEOUTS
from grader.reading import read_assignment
from kit.host.failure import Failure, FailureKind
from kit.host.sandbox.sandbox_config import Level
from kit.school.lessons.reading import lessons_folder

DIED = Failure(FailureKind.EXCEPTION, "program.py:7: NameError: name 'ranges' is not defined")


@pytest.mark.parametrize("is_own_check", [True, False])
@pytest.mark.parametrize("kind", [FailureKind.EXCEPTION, FailureKind.EXIT, FailureKind.TIMEOUT])
def test_a_students_own_check_runs_no_further_episode_of_a_program_that_died(
    kind: FailureKind, is_own_check: bool
) -> None:
    assignment = read_assignment(lessons_folder() / "31-actions" / "order")
    started: list[str] = []

    def run(spec: EpisodeSpec) -> EvidenceRecord:
        started.append(spec.label)
        return EvidenceRecord(failure=Failure(kind, DIED.message), label=spec.label, secret=spec.secret)

    options = EvidenceOptions(Level.LIMITED, secret=True, stops_at_death=is_own_check)
    collector = EpisodeCollector(assignment, options, run)
    seen = [each for criterion in assignment.criteria for each in collector.evidence(criterion)]
    count = len({each.label for each in seen})
    assert count >= 3
    assert len(started) == (1 if is_own_check else MAX_TIMEOUTS if kind is FailureKind.TIMEOUT else count)
    if is_own_check or kind is not FailureKind.TIMEOUT:
        assert all(each.failure is not None and each.failure.message == DIED.message for each in seen)
    assert [each.outcome for each in seen].count("not run") > 0 or not is_own_check
