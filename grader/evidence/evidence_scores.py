"""What of a submission is run, in which order, and what share of a criterion's points each of its runs earns.

Everything public runs before the first secret run, and nothing that a student reads of runs after it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

from grader.assignment import Assignment, Criterion
from grader.author_code import AuthorCodeError
from grader.check import Check
from grader.evidence.contract import Evidence, EvidenceCollector
from grader.evidence.findings import failure_before, measure_of, state_after
from grader.evidence.submission_clock import SubmissionClock
from grader.seeds import SeedSet
from grader.submitted_files import reading_submission
from kit.host.failure import Failure, StudentCodeError
from kit.host.sandbox.sandbox_config import Level
from kit.plain_text import counted
from kit.results.grading_result import PUBLIC_CASES, Visibility


@dataclass(frozen=True, slots=True)
class ScoredEvidence:
    """One piece of evidence with its measure and the share of points it earned."""

    evidence: Evidence
    measure: float | None
    share: float
    failure: Failure | None
    """How the program failed, in a run or while it was measured; None if it did not."""
    steps: int
    """How many had been simulated then."""


class EvidenceScores:
    """The scores of one submission's evidence, each made when it is first asked for."""

    def __init__(
        self,
        assignment: Assignment,
        submission_name: str,
        collector: EvidenceCollector,
        checks: Mapping[str, Check],
        clock: SubmissionClock,
        *,
        secret: bool,
        examples: bool,
    ) -> None:
        """``secret``: whether secret evidence is collected too. ``examples``: whether public runs that lose points are looked for
        where only secret ones do."""
        self._assignment = assignment
        self._submission_name = submission_name
        self._collector = collector
        self._checks = checks
        self._clock = clock
        self._examples = examples
        self._has_run_public = not secret
        """Whether everything public was run. Nothing secret is run before: what a program says after that is not shown."""
        self._scored: dict[str, tuple[ScoredEvidence, ...]] = {}
        self._public_scored: dict[str, tuple[ScoredEvidence, ...]] = {}
        self._counterexamples: dict[str, ScoredEvidence | None] = {}
        self._tried_counts: dict[str, int] = {}
        """By criterion: the counterparts that earned everything."""

    def of(self, criterion: Criterion) -> tuple[ScoredEvidence, ...]:
        """Measures and scores each piece of evidence for a criterion."""
        if criterion.id in self._scored:
            return self._scored[criterion.id]
        self._run_public()
        before = () if criterion.after is None else self.of(self._assignment.criterion(criterion.after))
        # An error in here was brought to light by this work: it must look like no fault of the grader's.
        with reading_submission(self._submission_name, AuthorCodeError):
            collected = self._collector.evidence(criterion)
        self._scored[criterion.id] = self._score_all(criterion, collected, before)
        return self._scored[criterion.id]

    def shown(self, criterion: Criterion, *, full: bool) -> Sequence[ScoredEvidence]:
        """Returns the evidence that a student is told of: the public, or where only secret evidence lost points, a
        counterpart that loses points too; in a student's own check, where none loses half as much, the secret itself: what is told must
        be why the points are lost. Empty if none of these was found."""
        scored = self.of(criterion)
        public = [each for each in scored if not each.evidence.secret]
        if full or any(each.share < 1.0 for each in public):
            return public
        if self.looks_afterwards and criterion.id not in self._counterexamples:
            self._counterexamples[criterion.id] = self._find_counterexample(criterion)
        found = self._counterexamples.get(criterion.id)
        if self.looks_afterwards:
            lost = 1.0 - min(each.share for each in scored)
            if found is not None and 1.0 - found.share < lost / 2.0:
                found = self._counterexamples[criterion.id] = None
            if found is None:
                return scored
        return [] if found is None else [found]

    def is_its_turn(self, criterion: Criterion) -> bool:
        """Whether every criterion that it comes after, one behind the other, was earned in full in some episode: they may be
        measured in different ones."""
        if criterion.after is None:
            return True
        before = self._assignment.criterion(criterion.after)
        return self.is_its_turn(before) and any(each.share == 1.0 for each in self.of(before))

    @property
    def looks_afterwards(self) -> bool:
        """Whether examples are looked for after secret runs, and only where these lose points: at level 0, where a program can
        read the secrets themselves."""
        return self._examples and self._collector.level is Level.LIMITED

    def tried_count(self, criterion: Criterion) -> int:
        """How many counterparts of a criterion were tried, and earned everything."""
        return self._tried_counts.get(criterion.id, 0)

    def worst(self) -> Evidence | None:
        """Returns the public evidence that lost the most points; in a student's own check, where that lost none, the secret; None
        if nothing lost any. Criteria that a student sees later do not count."""
        shares: dict[int, tuple[float, Evidence]] = {}
        examples = {name: (each,) for name, each in self._counterexamples.items() if each is not None}
        for name, scored in (*self._scored.items(), *examples.items()):
            for each in scored if self._assignment.criterion(name).visibility is Visibility.VISIBLE else ():
                if not each.evidence.secret or self.looks_afterwards:
                    before = shares.get(id(each.evidence), (0.0, each.evidence))[0]
                    shares[id(each.evidence)] = before + 1.0 - each.share, each.evidence
        lost = [each for each in shares.values() if each[0] > 0]
        return max(lost, key=lambda each: (not each[1].secret, each[0]), default=(0.0, None))[1]

    def first_public(self) -> Evidence | None:
        """Returns the first evidence of the first criterion that is not secret: the run to show where nothing was lost."""
        seen = (each.evidence for scored in self._scored.values() for each in scored)
        return next((each for each in seen if not each.secret), None)

    def of_counterpart(self, criterion: Criterion, evidence: Evidence) -> ScoredEvidence:
        before = None if criterion.after is None else self._assignment.criterion(criterion.after)
        is_ready = before is None or self.of_counterpart(before, evidence).share == 1.0
        return self._score_evidence(criterion, evidence, is_ready=is_ready)

    def _run_public(self) -> None:
        """Runs everything public once, before the first secret run. A program that has seen a secret can hand it to a later
        one in ways that no level closes, such as the page cache: so no later one's words may be shown."""
        if self._has_run_public:
            return
        self._has_run_public = True
        with reading_submission(self._submission_name, AuthorCodeError):
            for criterion in self._assignment.criteria:
                if self._may_get_its_turn(criterion):
                    self._collector.public_evidence(criterion)
            if self._examples and self._collector.collected():
                self._clock.show_progress(f"{PUBLIC_CASES}{self._public_verdict()}")
        if not self._examples or self.looks_afterwards:
            return
        for criterion in self._assignment.criteria:
            with suppress(Exception):  # a check that fails here fails again where its criterion is judged
                scored = self._score_public(criterion)
                if criterion.seeds is not SeedSet.PUBLIC and all(each.share == 1.0 for each in scored):
                    self._counterexamples[criterion.id] = self._find_counterexample(criterion)

    def _public_verdict(self) -> str:
        """Says in a few words what the public evidence comes to: all that a student need wait for to go on."""
        scored = [
            public
            for each in self._assignment.criteria
            if each.visibility is Visibility.VISIBLE and (public := self._score_public(each))
        ]
        passed = sum(all(each.share == 1.0 for each in public) for public in scored)
        return (
            "all passed"
            if passed == len(scored)
            else f"{passed} of {counted(len(scored), 'criterion', 'criteria')} passed"
        )

    def _score_public(self, criterion: Criterion) -> tuple[ScoredEvidence, ...]:
        """Scores the public evidence of a criterion alone, once."""
        if criterion.id not in self._public_scored:
            before = (
                ()
                if criterion.after is None
                else self._score_public(self._assignment.criterion(criterion.after))
            )
            self._public_scored[criterion.id] = (
                self._score_all(criterion, self._collector.public_evidence(criterion), before)
                if self._may_get_its_turn(criterion)
                else tuple(replace(each, share=0.0) for each in before)
            )
        return self._public_scored[criterion.id]

    def _may_get_its_turn(self, criterion: Criterion) -> bool:
        """Whether what a criterion comes after may still be earned, by its public evidence. In a student's own check, who mends
        that first, nothing else is run."""
        if criterion.after is None or not self.looks_afterwards:
            return True
        public = self._score_public(self._assignment.criterion(criterion.after))
        return not public or any(each.share == 1.0 for each in public)

    def _find_counterexample(self, criterion: Criterion) -> ScoredEvidence | None:
        """Returns the first public counterpart that loses points; None if all that the collector makes earn everything."""
        for number, evidence in enumerate(self._collector.counterparts(criterion), 1):
            scored = self.of_counterpart(criterion, evidence)
            if scored.share < 1.0:
                return scored
            self._tried_counts[criterion.id] = number
        return None

    def _score_all(
        self, criterion: Criterion, collected: Sequence[Evidence], before: Sequence[ScoredEvidence]
    ) -> tuple[ScoredEvidence, ...]:
        """``before``: the scores of the criterion that comes first. What has lost points there earns nothing here."""
        full = {id(each.evidence): each.share == 1.0 for each in before}
        return tuple(
            self._score_evidence(criterion, each, is_ready=full.get(id(each), True)) for each in collected
        )

    def _score_evidence(self, criterion: Criterion, evidence: Evidence, *, is_ready: bool) -> ScoredEvidence:
        name, params = criterion.check, criterion.params
        failure = failure_before(evidence, name, params)
        if failure is not None or not is_ready:
            return ScoredEvidence(evidence, None, 0.0, failure, evidence.steps)
        try:
            measure = measure_of(evidence, name, params, self._checks[name].measure)
        except StudentCodeError as error:  # what it returned takes longer to measure than a submission may
            return ScoredEvidence(evidence, None, 0.0, self._clock.explain(error.failure), evidence.steps)
        failure, steps = state_after(evidence, name, params)
        return ScoredEvidence(evidence, measure, criterion.anchors.share(measure), failure, steps)
