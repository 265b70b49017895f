"""Grades one submission: collects the evidence that each criterion needs, measures it and gives points."""

from __future__ import annotations

import math
import sys
import time
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from types import MappingProxyType
from typing import Final

from grader.assignment import MAX_HINTS, Assignment, Criterion, KnownMistake
from grader.author_code import AuthorCodeError
from grader.evidence.contract import Evidence, EvidenceCollector, EvidenceOptions
from grader.evidence.findings import (
    Findings,
    FindingsRecorder,
    KeptFindings,
    NotKept,
    failure_before,
    measure_of,
    original_of,
    state_after,
)
from grader.evidence.submission_clock import SubmissionClock
from grader.failure_status import status_of_failure
from grader.file_formats import YAML_ENDINGS
from grader.grading_level import grading_level, level_for_untrusted
from grader.kinds.contract import find_kind
from grader.scoring import DEFAULT_STEPS, round_share
from grader.seeds import SeedSet
from grader.submission import Submission
from grader.submitted_files import SubmissionRefused, reading_submission
from grader.teacher_tests.reading import tests_digest
from grader.teacher_tests.result import teacher_test_result
from grader.teacher_tests.running import TestOutcome, run_teacher_tests
from grader.version import grader_version
from kit.extensions import admitting
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.sandbox.process_control import shield_this_process
from kit.host.sandbox.sandbox_config import Level
from kit.plain_text import counted, holds_text
from kit.results.grading_result import (
    PUBLIC_CASES,
    PUBLIC_SEEDS,
    WITH_SECRET,
    CriterionResult,
    CriterionStatus,
    EpisodeSummary,
    GradingResult,
    GradingTiming,
    GradingVerdict,
    Visibility,
)

SAME_MISTAKE: Final = "The same mistake as in"
"""How the feedback on a mistake begins that an earlier criterion has described."""

OUTSIDE_SIGNALS: Final = frozenset({FailureKind.KILLED, FailureKind.CRASH})
"""Failures caused by a signal, which may have been meant for every process on this machine."""
SHUTDOWN_WAIT_S: Final = 0.5
"""Seconds to wait before such a failure is reported: a shutdown ends the grader too, a moment later, and then costs the
student nothing."""

COARSE_RATIONALES: Final[Mapping[CriterionStatus, str]] = MappingProxyType(
    {
        CriterionStatus.TIMEOUT: "Your program took too long",
        CriterionStatus.RESOURCE_LIMIT: "Your program used too much memory or disk",
        CriterionStatus.PROTOCOL_ERROR: "Your program disturbed its communication with the kit",
        CriterionStatus.STUDENT_ERROR: "Your program stopped with an error",
    }
)
"""The whole note on a failure with a secret seed: an error's own text could hold what the program saw."""


NOT_ITS_TURN: Final = "Not graded: pass “{}” first."


@dataclass(frozen=True, slots=True)
class GradingOptions:
    """How to grade a submission."""

    level: Level | None = None
    """Confinement level of programs; None takes the assignment's, and at least 1."""
    secret: bool = False
    """Whether to use the secret seeds too, for the grade."""
    examples: bool = False
    """Whether to look for public runs that lose points too, for a student to read where only secret seeds show a mistake.
    From level 1 on they are made of every submission, before anything secret is run: up to ``MAX_COUNTERPARTS`` for each
    criterion."""
    may_lower_level: bool = True
    """Whether practice, without secret seeds, may go on at a lower level, at least 1, where this machine supports none
    higher, if no level was requested."""
    show_progress: Callable[[str], None] = lambda text: None
    """Called with what is being done, whenever that changes."""


@dataclass(frozen=True, slots=True)
class _ScoredEvidence:
    """One piece of evidence with its measure and the share of points it earned."""

    evidence: Evidence
    measure: float | None
    share: float
    failure: Failure | None
    """How the program failed, in a run or while it was measured; None if it did not."""
    steps: int
    """How many had been simulated then."""


class Grading:
    """Grades criteria one by one, in any order; used by the pytest plugin and the command line."""

    def __init__(
        self,
        assignment: Assignment,
        submission: Submission,
        collector: EvidenceCollector,
        *,
        secret: bool,
        clock: SubmissionClock,
        examples: bool = False,
        is_recorded: bool = False,
        kept: Findings | None = None,
    ) -> None:
        """``is_recorded``: whether to note what is found. ``kept``: what was found before, from which ``collector`` is made."""
        self.assignment = assignment
        self.submission = submission
        self.recorder = FindingsRecorder(collector) if is_recorded else None
        self._kept = kept
        self._collector = collector if self.recorder is None else self.recorder
        self._clock = clock
        self._secret = secret
        self._examples = examples
        self._has_run_public = not secret
        """Whether everything public was run. Nothing secret is run before: what a program says after that is not shown."""
        with admitting(assignment.packages):
            kind = find_kind(assignment.kind)
        self._checks, self._seed_decides = kind.checks, kind.seed_decides
        self._scored: dict[str, tuple[_ScoredEvidence, ...]] = {}
        self._public_scored: dict[str, tuple[_ScoredEvidence, ...]] = {}
        self._tests: dict[str, CriterionResult] = {}
        self._counterexamples: dict[str, _ScoredEvidence | None] = {}
        self._tried_counts: dict[str, int] = {}
        """By criterion: the counterparts that earned everything."""
        self.has_given_secrets = False
        """Whether ``evidence`` has returned any secret evidence."""
        self._first_shown: dict[str, Criterion] = {}
        """Criterion that showed each text first: a mistake is described once."""
        self._began = time.perf_counter()
        self._started = datetime.now(UTC).isoformat(timespec="seconds")

    def judge(self, criterion: Criterion) -> CriterionResult:
        """Grades one criterion. An error in here becomes a result with the status GRADER_ERROR.

        Raises nothing but SubmissionRefused, where what was handed in is read only now, and cannot be.
        """
        if criterion.id not in self._tests:
            try:
                test = self._judge(criterion)
            except SubmissionRefused:
                raise
            except Exception:  # noqa: BLE001  # any error in here is the grader's and must not cost the student a point
                test = self._broken_result(criterion, traceback.format_exc())
            self._tests[criterion.id] = test
        return self._tests[criterion.id]

    def result(self) -> GradingResult:
        """Grades all criteria and teacher tests, and returns the complete result."""
        tests = tuple(self.judge(criterion) for criterion in self.assignment.criteria)
        outcomes = self._outcomes_of_own_tests()
        for own in self.assignment.teacher_tests:
            tests += (self._after_its_turn(teacher_test_result(own, outcomes.get(own.id, ())), tests),)
        collected = self._collector.collected()
        is_from_outside = any(
            each.failure is not None and each.failure.kind in OUTSIDE_SIGNALS for each in collected
        )
        if is_from_outside and self._kept is None:
            time.sleep(SHUTDOWN_WAIT_S)
        return GradingResult(
            assignment=self.assignment.id,
            assignment_version=self.assignment.version,
            public_version=self.assignment.public_version,
            submission=self.submission.digest,
            grader_version=grader_version(),
            seeds=WITH_SECRET if self._secret else PUBLIC_SEEDS,
            level=int(self._collector.level),
            platform=_platform(),
            tests=tests,
            notices=tuple(self._notices(tests)),
            steps=sum(each.steps for each in collected),
            secret_steps=sum(each.steps for each in collected if each.secret),
            timing=GradingTiming(self._started, round(time.perf_counter() - self._began, 3)),
        )

    def _outcomes_of_own_tests(self) -> Mapping[str, Sequence[TestOutcome]]:
        """Runs the teacher's tests; where the evidence was kept, returns what they came to before."""
        files = self.assignment.teacher_test_files
        if self._kept is not None:
            if not files:
                return {}
            if self._kept.own_tests != tests_digest(files):
                raise NotKept("tests")
            return {
                name: [
                    TestOutcome(CriterionStatus(status), message, uses_secrets=secret)
                    for status, message, secret in each
                ]
                for name, each in self._kept.outcomes.items()
            }
        found = run_teacher_tests(
            self,
            self.assignment.folder,
            self.assignment.teacher_tests,
            files,
            self.first_failure,
            self._clock,
            self._collector.level,
        )
        if self.recorder is not None and files:
            self.recorder.findings.own_tests = tests_digest(files)
            self.recorder.findings.outcomes = {
                name: [[each.status.value, each.message, each.uses_secrets] for each in outcomes]
                for name, outcomes in found.items()
            }
        return found

    def _after_its_turn(self, test: CriterionResult, earlier: Sequence[CriterionResult]) -> CriterionResult:
        """Returns a teacher test's result, or that it was not graded where what comes before it did not earn everything."""
        after = next(each.after for each in self.assignment.teacher_tests if each.id == test.id)
        before = next((each for each in earlier if each.id == after), None)
        if before is None or before.is_passed or test.status is CriterionStatus.GRADER_ERROR:
            return test
        return replace(
            CriterionResult(
                test.id, test.title, CriterionStatus.SKIPPED, 0.0, test.max_points, test.visibility
            ),
            rationale=NOT_ITS_TURN.format(before.title),
            depends_on=before.id,
        )

    def evidence(self, criterion_id: str) -> Sequence[Evidence]:
        """Returns the evidence of a criterion, by its id; for teacher tests."""
        evidence = self._collector.evidence(self._criterion(criterion_id))
        self.has_given_secrets |= any(each.secret for each in evidence)
        return [original_of(each) for each in evidence]

    def first_failure(self) -> Failure | None:
        """Returns the first failure of the program so far, as a student may read it; None if there was none."""
        failed = sorted(
            (each for each in self._collector.collected() if each.failure is not None),
            key=lambda each: each.secret,
        )
        return _public_failure(failed[0]) if failed else None

    def worst_evidence(self) -> Evidence | None:
        """Returns the public evidence that lost the most points; in a student's own check, where that lost none, the secret; None
        if nothing lost any. Criteria that a student sees later do not count."""
        shares: dict[int, tuple[float, Evidence]] = {}
        examples = {name: (each,) for name, each in self._counterexamples.items() if each is not None}
        for name, scored in (*self._scored.items(), *examples.items()):
            for each in scored if self._criterion(name).visibility is Visibility.VISIBLE else ():
                if not each.evidence.secret or self._looks_afterwards:
                    before = shares.get(id(each.evidence), (0.0, each.evidence))[0]
                    shares[id(each.evidence)] = before + 1.0 - each.share, each.evidence
        lost = [each for each in shares.values() if each[0] > 0]
        return max(lost, key=lambda each: (not each[1].secret, each[0]), default=(0.0, None))[1]

    def first_public_evidence(self) -> Evidence | None:
        """Returns the first evidence of the first criterion that is not secret: the run to show where nothing was lost."""
        seen = (each.evidence for scored in self._scored.values() for each in scored)
        return next((each for each in seen if not each.secret), None)

    def _judge(self, criterion: Criterion) -> CriterionResult:
        blank = CriterionResult(
            criterion.id,
            criterion.title,
            CriterionStatus.SKIPPED,
            0.0,
            criterion.points,
            criterion.visibility,
        )
        if self._looks_afterwards and not self._is_its_turn(criterion):
            return self._not_its_turn(criterion, blank)
        scored = self._score(criterion)
        if not scored or (criterion.after is not None and not self._score(self._criterion(criterion.after))):
            return replace(blank, rationale="Graded with secret seeds when you hand in.")
        broken = next(
            (each for each in scored if status_of_failure(each.failure) is CriterionStatus.GRADER_ERROR), None
        )
        if broken is not None:
            return self._broken_result(criterion, str(broken.failure))
        if not self._is_its_turn(criterion):
            return self._not_its_turn(criterion, blank)
        share = _earned_share(criterion, scored)
        full = share == 1.0
        shown = self._public_evidence(criterion, scored, full=full)
        worst = min(shown, key=lambda each: each.share, default=None)
        status = (
            CriterionStatus.PASS if full else (CriterionStatus.PARTIAL if share > 0 else CriterionStatus.FAIL)
        )
        if worst is not None and worst.failure is not None and share == 0.0:
            status = status_of_failure(worst.failure)
        check = self._checks[criterion.check]
        rationale = "" if full else self._rationale(criterion, shown, worst)
        hints = () if full else self._hints(criterion, rationale, worst)
        return replace(
            blank,
            status=status,
            points=round(criterion.points * share, 6),
            rationale=rationale,
            hints=hints,
            knows_mistake=bool(hints) and hints[0] not in criterion.hints,
            expected=check.format(criterion.anchors.full),
            actual=""
            if worst is None or worst.measure is None or check.is_explained
            else check.format(worst.measure, beside=criterion.anchors.full),
            metrics={"share": round(share, 6)},
            episodes=tuple(map(_summarize_episode, scored)),
            log="" if worst is None or worst.evidence.secret else "\n".join(worst.evidence.printed),
            replay="" if full or worst is None else worst.evidence.picture(criterion.check),
            uses_secrets=any(each.evidence.secret for each in scored),
            teacher_note="" if full else self._teacher_note(criterion, scored),
        )

    def _not_its_turn(self, criterion: Criterion, blank: CriterionResult) -> CriterionResult:
        assert criterion.after is not None  # else it is always its turn
        title = self._criterion(criterion.after).title
        return replace(blank, rationale=NOT_ITS_TURN.format(title), depends_on=criterion.after)

    def _is_its_turn(self, criterion: Criterion) -> bool:
        """Whether every criterion that it comes after, one behind the other, was earned in full in some episode: they may be
        measured in different ones."""
        if criterion.after is None:
            return True
        before = self._criterion(criterion.after)
        return self._is_its_turn(before) and any(each.share == 1.0 for each in self._score(before))

    def _public_evidence(
        self, criterion: Criterion, scored: Sequence[_ScoredEvidence], *, full: bool
    ) -> Sequence[_ScoredEvidence]:
        """Returns the evidence that a student is told of: the public, or where only secret evidence lost points, a
        counterpart that loses points too; in a student's own check, where none loses half as much, the secret itself: what is told must
        be why the points are lost. Empty if none of these was found."""
        public = [each for each in scored if not each.evidence.secret]
        if full or any(each.share < 1.0 for each in public):
            return public
        if self._looks_afterwards and criterion.id not in self._counterexamples:
            self._counterexamples[criterion.id] = self._find_counterexample(criterion)
        found = self._counterexamples.get(criterion.id)
        if self._looks_afterwards:
            lost = 1.0 - min(each.share for each in scored)
            if found is not None and 1.0 - found.share < lost / 2.0:
                found = self._counterexamples[criterion.id] = None
            if found is None:
                return scored
        return [] if found is None else [found]

    @property
    def _looks_afterwards(self) -> bool:
        """Whether examples are looked for after secret runs, and only where these lose points: at level 0, where a program can
        read the secrets themselves."""
        return self._examples and self._collector.level is Level.LIMITED

    def _run_public(self) -> None:
        """Runs everything public once, before the first secret run. A program that has seen a secret can hand it to a later
        one in ways that no level closes, such as the page cache: so no later one's words may be shown."""
        if self._has_run_public:
            return
        self._has_run_public = True
        with reading_submission(self.submission.name, AuthorCodeError):
            for criterion in self.assignment.criteria:
                if self._may_get_its_turn(criterion):
                    self._collector.public_evidence(criterion)
            if self._examples and self._secret and self._collector.collected():
                self._clock.show_progress(f"{PUBLIC_CASES}{self._public_verdict()}")
        if not self._examples or self._looks_afterwards:
            return
        for criterion in self.assignment.criteria:
            with suppress(Exception):  # a check that fails here fails again where its criterion is judged
                scored = self._score_public(criterion)
                if criterion.seeds is not SeedSet.PUBLIC and all(each.share == 1.0 for each in scored):
                    self._counterexamples[criterion.id] = self._find_counterexample(criterion)

    def _public_verdict(self) -> str:
        """Says in a few words what the public evidence comes to: all that a student need wait for to go on."""
        scored = [
            public
            for each in self.assignment.criteria
            if each.visibility is Visibility.VISIBLE and (public := self._score_public(each))
        ]
        passed = sum(all(each.share == 1.0 for each in public) for public in scored)
        return (
            "all passed"
            if passed == len(scored)
            else f"{passed} of {counted(len(scored), 'criterion', 'criteria')} passed"
        )

    def _score_public(self, criterion: Criterion) -> tuple[_ScoredEvidence, ...]:
        """Scores the public evidence of a criterion alone, once."""
        if criterion.id not in self._public_scored:
            before = () if criterion.after is None else self._score_public(self._criterion(criterion.after))
            full = {id(each.evidence): each.share == 1.0 for each in before}
            self._public_scored[criterion.id] = (
                tuple(
                    self._score_evidence(criterion, each, is_ready=full.get(id(each), True))
                    for each in self._collector.public_evidence(criterion)
                )
                if self._may_get_its_turn(criterion)
                else tuple(replace(each, share=0.0) for each in before)
            )
        return self._public_scored[criterion.id]

    def _may_get_its_turn(self, criterion: Criterion) -> bool:
        """Whether what a criterion comes after may still be earned, by its public evidence. In a student's own check, who mends
        that first, nothing else is run."""
        if criterion.after is None or not self._looks_afterwards:
            return True
        public = self._score_public(self._criterion(criterion.after))
        return not public or any(each.share == 1.0 for each in public)

    def _find_counterexample(self, criterion: Criterion) -> _ScoredEvidence | None:
        """Returns the first public counterpart that loses points; None if all that the collector makes earn everything."""
        for number, evidence in enumerate(self._collector.counterparts(criterion), 1):
            scored = self._score_counterpart(criterion, evidence)
            if scored.share < 1.0:
                return scored
            self._tried_counts[criterion.id] = number
        return None

    def _score_counterpart(self, criterion: Criterion, evidence: Evidence) -> _ScoredEvidence:
        before = None if criterion.after is None else self._criterion(criterion.after)
        is_ready = before is None or self._score_counterpart(before, evidence).share == 1.0
        return self._score_evidence(criterion, evidence, is_ready=is_ready)

    def _score(self, criterion: Criterion) -> tuple[_ScoredEvidence, ...]:
        """Measures and scores each piece of evidence for a criterion."""
        if criterion.id in self._scored:
            return self._scored[criterion.id]
        self._run_public()
        ready = self._full_points_predicate(criterion)
        # An error in here was brought to light by this work: it must look like no fault of the grader's.
        with reading_submission(self.submission.name, AuthorCodeError):
            collected = self._collector.evidence(criterion)
        self._scored[criterion.id] = tuple(
            self._score_evidence(criterion, each, is_ready=ready(each)) for each in collected
        )
        return self._scored[criterion.id]

    def _score_evidence(self, criterion: Criterion, evidence: Evidence, *, is_ready: bool) -> _ScoredEvidence:
        name, params = criterion.check, criterion.params
        failure = failure_before(evidence, name, params)
        if failure is not None or not is_ready:
            return _ScoredEvidence(evidence, None, 0.0, failure, evidence.steps)
        try:
            measure = measure_of(evidence, name, params, self._checks[name].measure)
        except StudentCodeError as error:  # what it returned takes longer to measure than a submission may
            return _ScoredEvidence(evidence, None, 0.0, self._clock.explain(error.failure), evidence.steps)
        failure, steps = state_after(evidence, name, params)
        return _ScoredEvidence(evidence, measure, criterion.anchors.share(measure), failure, steps)

    def _full_points_predicate(self, criterion: Criterion) -> Callable[[Evidence], bool]:
        """Returns a predicate: did this evidence earn full points in the criterion that comes first?"""
        if criterion.after is None:
            return lambda evidence: True
        before = self._score(self._criterion(criterion.after))
        full = {id(each.evidence) for each in before if each.share == 1.0}
        scored_ids = {id(each.evidence) for each in before}
        return lambda evidence: id(evidence) in full or id(evidence) not in scored_ids

    def _rationale(
        self, criterion: Criterion, shown: Sequence[_ScoredEvidence], worst: _ScoredEvidence | None
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

    def _lost_first(self, criterion: Criterion, evidence: Evidence) -> Criterion:
        """Returns the first of those that a criterion comes after which this evidence has not earned in full."""
        if criterion.after is None:
            return criterion
        before = self._criterion(criterion.after)
        earlier = self._lost_first(before, evidence)
        return earlier if self._score_counterpart(earlier, evidence).share < 1.0 else before

    def _what_differs(self, criterion: Criterion, shown: Sequence[_ScoredEvidence]) -> str:
        """Says of points that secret evidence alone has lost, which is shown, what may be the reason; once, and not to a teacher."""
        secret = [each for each in shown if each.evidence.secret]
        if len(secret) == len(shown) or not self._looks_afterwards:
            return ""
        lost = sum(each.share < 1.0 for each in secret)
        tried = self._tried_counts.get(criterion.id, 0)
        more = f" and with {counted(tried, 'further seed')} that were tried" if tried else ""
        lost_seeds = "the secret one" if len(secret) == 1 else f"{lost} of {len(secret)} secret ones"
        counts = f"It is met with all public seeds{more}, but not with {lost_seeds}."
        text = f"{counts} {self._seed_decides}".strip()
        return "" if self._shown_before(criterion, text) else text

    def _hints(self, criterion: Criterion, rationale: str, worst: _ScoredEvidence | None) -> tuple[str, ...]:
        """Returns the criterion's hints, that for the mistake that was made first; none where a file cannot be read or
        uses a name that there is not, the mistake was described before, or what comes before was lost: then that is all
        there is to mend."""
        if worst is not None and worst.failure is None and worst.measure is None:
            return ()
        if worst is None or worst.evidence.secret:
            return criterion.hints
        failure = worst.failure
        if failure is not None and (
            self.assignment.submit.endswith(YAML_ENDINGS) or rationale.startswith(SAME_MISTAKE)
        ):
            return ()
        measure = math.nan if worst.measure is None else worst.measure
        made = next(
            (each.hint for each in criterion.mistakes if self._is_made(each, rationale, measure)), None
        )
        if made is None:
            return () if failure is not None and _is_slip(failure) else criterion.hints
        return (made, *criterion.hints)[:MAX_HINTS]

    def _is_made(self, mistake: KnownMistake, rationale: str, measure: float) -> bool:
        has_range = (mistake.low, mistake.high) != (-math.inf, math.inf)
        return (
            holds_text(rationale, mistake.when)
            and (not has_range or mistake.low <= measure <= mistake.high)
            and (
                mistake.passed is None
                or all(each.share == 1.0 for each in self._score(self._criterion(mistake.passed)))
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

    def _teacher_note(self, criterion: Criterion, scored: Sequence[_ScoredEvidence]) -> str:
        """Says what the worst secret evidence showed; empty if none lost points."""
        secret = [each for each in scored if each.evidence.secret]
        worst = min(secret, key=lambda each: each.share, default=None)
        if worst is None or worst.share == 1.0:
            return ""
        return self._rationale(criterion, secret, worst)

    def _broken_result(self, criterion: Criterion, log: str) -> CriterionResult:
        return CriterionResult(
            criterion.id,
            criterion.title,
            CriterionStatus.GRADER_ERROR,
            0.0,
            criterion.points,
            criterion.visibility,
            rationale="The grader failed here. This is not your fault and costs no points; your teacher will be informed.",
            log=log,
            uses_secrets=self._secret,
        )

    def _notices(self, tests: Sequence[CriterionResult]) -> Sequence[str]:
        later = [test for test in tests if test.status is CriterionStatus.SKIPPED and test.depends_on is None]
        seeds = any(criterion.seeds is not SeedSet.PUBLIC for criterion in self.assignment.criteria)
        notices = []
        if later:
            notices.append(f"{len(later)} more tests run when you hand in.")
        if not self._secret and self.assignment.trials and seeds:
            notices.append("These are the practice seeds; the grade uses others.")
        class_level = level_for_untrusted(self.assignment, None)
        if not self._secret and self._collector.level < class_level:
            notices.append(
                f"Run at confinement level {int(self._collector.level)}. A class is graded at level {int(class_level)} or higher."
            )
        return notices

    def _criterion(self, identity: str) -> Criterion:
        return next(each for each in self.assignment.criteria if each.id == identity)


@contextmanager
def open_grading(
    assignment: Assignment, submission: Submission, options: GradingOptions, *, is_recorded: bool = False
) -> Iterator[Grading]:
    """Opens a grading of one submission. ``is_recorded``: whether it notes what is found. Raises LevelTooLow, and
    SubmissionRefused for files that cannot be read."""
    available = grading_level(
        assignment, options.level, secret=options.secret, may_lower_level=options.may_lower_level
    )
    with suppress(OSError, AttributeError):  # a C library without prctl: then level 1 is out of reach as well
        shield_this_process()
    with submission.in_temporary_folder() as file:
        clock = SubmissionClock(assignment.submission_limit_s, options.show_progress)
        evidence_options = EvidenceOptions(
            available,
            options.secret,
            clock,
            stops_at_death=options.examples and available is Level.LIMITED,
        )
        with ExitStack() as stack:
            stack.enter_context(admitting(assignment.packages))
            with reading_submission(submission.name):
                collector = stack.enter_context(
                    find_kind(assignment.kind).collect(assignment, file, evidence_options)
                )
            yield Grading(
                assignment,
                submission,
                collector,
                secret=options.secret,
                clock=clock,
                examples=options.examples,
                is_recorded=is_recorded,
            )


def grade(assignment: Assignment, submission: Submission, options: GradingOptions) -> GradingResult:
    """Grades one submission completely. Raises LevelTooLow, and SubmissionRefused for files that cannot be read."""
    with open_grading(assignment, submission, options) as grading:
        return grading.result()


def grade_and_keep(
    assignment: Assignment, submission: Submission, options: GradingOptions
) -> tuple[GradingResult, Findings | None]:
    """Grades one submission completely, and returns what was found too; None where it would not give the same result again,
    since something of it was known only while it ran. Raises as ``grade``."""
    with open_grading(assignment, submission, options, is_recorded=True) as grading:
        result = grading.result()
        assert grading.recorder is not None  # it is recorded
        findings = grading.recorder.finish()
    if result.verdict is GradingVerdict.BROKEN:
        return result, None
    again = judge_findings(assignment, submission, options, findings)
    return result, findings if again is not None and again.tests == result.tests else None


def judge_findings(
    assignment: Assignment, submission: Submission, options: GradingOptions, findings: Findings
) -> GradingResult | None:
    """Judges a submission by what was found about it, and runs nothing; None where more would have to be known."""
    try:
        grading = Grading(
            assignment,
            submission,
            KeptFindings(findings),
            secret=options.secret,
            clock=SubmissionClock(assignment.submission_limit_s),
            examples=options.examples,
            kept=findings,
        )
        result = grading.result()
    except (NotKept, SubmissionRefused):
        return None
    return None if result.verdict is GradingVerdict.BROKEN else result


def _earned_share(criterion: Criterion, scored: Sequence[_ScoredEvidence]) -> float:
    """Returns the share of a criterion's points that its evidence earns together, 0 to 1.

    Where secret evidence counts, all of it together earns no more than the secret alone: what only repeats the cases it was
    tried on has earned nothing. The share is one of a few steps then, so that its digits carry no measure of a secret
    episode out. Of secret evidence alone, each piece earns all or nothing unless the assignment states the steps.
    """
    shares = [each.share for each in scored]
    secret = [each.share for each in scored if each.evidence.secret]
    if len(secret) == len(scored) and criterion.share_steps is None:
        shares = secret = [float(share == 1.0) for share in shares]
    if not secret:
        return _joint_share(shares, criterion.need)
    share = min(_joint_share(each, criterion.need) for each in (shares, secret))
    return round_share(share, criterion.share_steps or DEFAULT_STEPS)


def _joint_share(shares: Sequence[float], need: float | None) -> float:
    """Returns the mean of shares, or how near the share of full ones comes to what is needed."""
    if need is None:
        return math.fsum(shares) / len(shares)
    passed = sum(share == 1.0 for share in shares) / len(shares)
    return 1.0 if passed >= need - 1e-9 else passed / need


def _summarize_episode(scored: _ScoredEvidence) -> EpisodeSummary:
    evidence = scored.evidence
    measure = None if scored.measure is None else _finite_or_none(scored.measure)
    return EpisodeSummary(evidence.label, evidence.outcome, scored.steps, measure, evidence.secret)


SLIPS: Final = ("NameError:", "ImportError:", "ModuleNotFoundError:")
"""How the message of an error begins that says itself what to mend."""


def _is_slip(failure: Failure) -> bool:
    """Whether it was not the task that was misunderstood, so that no hint about the task helps."""
    return failure.kind is FailureKind.SYNTAX or failure.message.startswith(SLIPS)


def _public_failure(evidence: Evidence) -> Failure:
    """Returns a failure as a student may read it: without its own text on a secret seed."""
    failure = evidence.failure
    assert failure is not None  # only called for one
    status = status_of_failure(failure)
    if not evidence.secret or status not in COARSE_RATIONALES:
        return failure
    return Failure(failure.kind, f"{COARSE_RATIONALES[status]} ({evidence.label}).")


def _finite_or_none(measure: float | None) -> float | None:
    """Returns None for infinity and NaN, which JSON cannot represent."""
    return round(measure, 6) if measure is not None and math.isfinite(measure) else None


def _platform() -> str:
    return f"{sys.platform}, Python {sys.version_info.major}.{sys.version_info.minor}"
