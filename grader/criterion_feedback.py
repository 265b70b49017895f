"""What a student reads of a criterion that has not earned everything: why, and what to try."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Final

from grader.assignment import MAX_HINTS, Assignment, Criterion, KnownMistake
from grader.check import Check
from grader.evidence.contract import Evidence
from grader.evidence.evidence_scores import EvidenceScores, ScoredEvidence
from grader.failure_status import status_of_failure
from grader.file_formats import YAML_ENDINGS
from kit.host.failure import Failure, FailureKind
from kit.plain_text import counted, holds_text
from kit.results.grading_result import CriterionStatus, Visibility

SAME_MISTAKE: Final = "The same mistake as in"
"""How the feedback on a mistake begins that an earlier criterion has described."""

COARSE_RATIONALES: Final[Mapping[CriterionStatus, str]] = MappingProxyType(
    {
        CriterionStatus.TIMEOUT: "Your program took too long",
        CriterionStatus.RESOURCE_LIMIT: "Your program used too much memory or disk",
        CriterionStatus.PROTOCOL_ERROR: "Your program disturbed its communication with the kit",
        CriterionStatus.STUDENT_ERROR: "Your program stopped with an error",
    }
)
"""The whole note on a failure with a secret seed: an error's own text could hold what the program saw."""

SLIPS: Final = ("NameError:", "ImportError:", "ModuleNotFoundError:")
"""How the message of an error begins that says itself what to mend."""


class CriterionFeedback:
    """Words on one submission, criterion by criterion. A text is said once: later criteria refer to the first."""

    def __init__(
        self,
        assignment: Assignment,
        scores: EvidenceScores,
        checks: Mapping[str, Check],
        seed_decides: str,
        *,
        examples: bool,
    ) -> None:
        """``seed_decides``: a sentence on what differs between seeds. ``examples``: whether public runs were looked for that lose
        points where only secret ones do."""
        self._assignment = assignment
        self._scores = scores
        self._checks = checks
        self._seed_decides = seed_decides
        self._examples = examples
        self._first_shown: dict[str, Criterion] = {}
        """Criterion that showed each text first: a mistake is described once."""

    def rationale(
        self, criterion: Criterion, shown: Sequence[ScoredEvidence], worst: ScoredEvidence | None
    ) -> str:
        """Says why points are lost. ``shown``: only evidence that the reader may know of, ``worst`` among it."""
        if worst is None:
            return (
                f"“{criterion.title}” is not met with the secret seeds of the grade. No public seed was found with which "
                "it is not met either."
                if self._examples
                else f"“{criterion.title}” is not met with the secret seeds of the grade. No example was looked for."
            )
        evidence, failure = worst.evidence, worst.failure
        if failure is not None:
            if evidence.secret:
                text = f"{COARSE_RATIONALES[status_of_failure(failure)]} ({evidence.label})."
                return f"{text} {self._what_differs(criterion, shown)}".strip()
            # That a file cannot be read has nothing to do with where it would have been used.
            is_unread = failure.kind in (FailureKind.SYNTAX, FailureKind.IMPORT)
            is_named = evidence.label.removesuffix("()") in f"{failure}"  # a function by its own line
            text = f"{failure}" if is_unread or is_named else f"{failure} ({evidence.label})"
            first = self._shown_before(criterion, text)
            return text if first is None else f"{SAME_MISTAKE} “{first.title}”."
        check = self._checks[criterion.check]
        if worst.measure is None:
            text = f"{evidence.label} does not count here: “{self._lost_first(criterion, evidence).title}” comes first."
            return (
                f"{evidence.label} does not count here either."
                if self._shown_before(criterion, text)
                else text
            )
        text = criterion.feedback.format(
            actual=check.format(worst.measure, beside=criterion.anchors.full),
            full=check.format(criterion.anchors.full),
            where=evidence.label,
            passed=sum(each.share == 1.0 for each in shown),
            count=len(shown),
        )
        explanation = evidence.explain(criterion.check, criterion.params)
        if check.is_explained and explanation:
            text = ""
        if evidence.secret:
            return " ".join(filter(None, (text, explanation, self._what_differs(criterion, shown))))
        if self._shown_before(criterion, explanation):
            return text
        return f"{text} {explanation}".strip()

    def hints(self, criterion: Criterion, rationale: str, worst: ScoredEvidence | None) -> tuple[str, ...]:
        """Returns the criterion's hints, that for the mistake that was made first; none where a file cannot be read or
        uses a name that there is not, the mistake was described before, or what comes before was lost: then that is all
        there is to mend."""
        if worst is not None and worst.failure is None and worst.measure is None:
            return ()
        if worst is None or worst.evidence.secret:
            return criterion.hints
        failure = worst.failure
        if failure is not None and (
            self._assignment.submit.endswith(YAML_ENDINGS) or rationale.startswith(SAME_MISTAKE)
        ):
            return ()
        measure = math.nan if worst.measure is None else worst.measure
        made = next(
            (each.hint for each in criterion.mistakes if self._is_made(each, rationale, measure)), None
        )
        if made is None:
            return () if failure is not None and _is_slip(failure) else criterion.hints
        return (made, *criterion.hints)[:MAX_HINTS]

    def teacher_note(self, criterion: Criterion, scored: Sequence[ScoredEvidence]) -> str:
        """Says what the worst secret evidence showed; empty if none lost points."""
        secret = [each for each in scored if each.evidence.secret]
        worst = min(secret, key=lambda each: each.share, default=None)
        if worst is None or worst.share == 1.0:
            return ""
        return self.rationale(criterion, secret, worst)

    def _lost_first(self, criterion: Criterion, evidence: Evidence) -> Criterion:
        """Returns the first of those that a criterion comes after which this evidence has not earned in full."""
        if criterion.after is None:
            return criterion
        before = self._assignment.criterion(criterion.after)
        earlier = self._lost_first(before, evidence)
        return earlier if self._scores.of_counterpart(earlier, evidence).share < 1.0 else before

    def _what_differs(self, criterion: Criterion, shown: Sequence[ScoredEvidence]) -> str:
        """Says of points that secret evidence alone has lost, which is shown, what may be the reason; once, and not to a teacher."""
        secret = [each for each in shown if each.evidence.secret]
        if len(secret) == len(shown) or not self._scores.looks_afterwards:
            return ""
        lost = sum(each.share < 1.0 for each in secret)
        tried = self._scores.tried_count(criterion)
        more = f" and with {counted(tried, 'further seed')} that were tried" if tried else ""
        lost_seeds = "the secret one" if len(secret) == 1 else f"{lost} of {len(secret)} secret ones"
        counts = f"It is met with all public seeds{more}, but not with {lost_seeds}."
        text = f"{counts} {self._seed_decides}".strip()
        return "" if self._shown_before(criterion, text) else text

    def _is_made(self, mistake: KnownMistake, rationale: str, measure: float) -> bool:
        has_range = (mistake.low, mistake.high) != (-math.inf, math.inf)
        return (
            holds_text(rationale, mistake.when)
            and (not has_range or mistake.low <= measure <= mistake.high)
            and (
                mistake.passed is None
                or all(
                    each.share == 1.0 for each in self._scores.of(self._assignment.criterion(mistake.passed))
                )
            )
        )

    def _shown_before(self, criterion: Criterion, text: str) -> Criterion | None:
        """Returns the earlier criterion whose feedback has this text already; None if this one is the first.

        Criteria that a student may not see do not count.
        """
        if criterion.visibility is not Visibility.VISIBLE:
            return None
        first = self._first_shown.setdefault(text, criterion)
        return None if first is criterion else first


def public_failure(evidence: Evidence) -> Failure:
    """Returns a failure as a student may read it: without its own text on a secret seed."""
    failure = evidence.failure
    assert failure is not None  # only called for one
    status = status_of_failure(failure)
    if not evidence.secret or status not in COARSE_RATIONALES:
        return failure
    return Failure(failure.kind, f"{COARSE_RATIONALES[status]} ({evidence.label}).")


def _is_slip(failure: Failure) -> bool:
    """Whether it was not the task that was misunderstood, so that no hint about the task helps."""
    return failure.kind is FailureKind.SYNTAX or failure.message.startswith(SLIPS)
