"""Grades one submission: gives points for each criterion by the scores of its evidence, and says why."""

from __future__ import annotations

import math
import sys
import time
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from typing import Final

from grader.assignment import Assignment, Criterion
from grader.criterion_feedback import CriterionFeedback, public_failure
from grader.evidence.contract import Evidence, EvidenceCollector, EvidenceOptions
from grader.evidence.evidence_scores import EvidenceScores, ScoredEvidence
from grader.evidence.findings import (
    Findings,
    FindingsRecorder,
    KeptFindings,
    NotKept,
    original_of,
)
from grader.evidence.submission_clock import SubmissionClock
from grader.failure_status import status_of_failure
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
from kit.host.failure import Failure, FailureKind
from kit.host.sandbox.process_control import shield_this_process
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import (
    PUBLIC_SEEDS,
    WITH_SECRET,
    CriterionResult,
    CriterionStatus,
    EpisodeSummary,
    GradingResult,
    GradingTiming,
    GradingVerdict,
)

OUTSIDE_SIGNALS: Final = frozenset({FailureKind.KILLED, FailureKind.CRASH})
"""Failures caused by a signal, which may have been meant for every process on this machine."""
SHUTDOWN_WAIT_S: Final = 0.5
"""Seconds to wait before such a failure is reported: a shutdown ends the grader too, a moment later, and then costs the
student nothing."""
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
        with admitting(assignment.packages):
            kind = find_kind(assignment.kind)
        self._checks = kind.checks
        self.scores = EvidenceScores(
            assignment,
            submission.name,
            self._collector,
            kind.checks,
            clock,
            secret=secret,
            examples=examples,
        )
        self._feedback = CriterionFeedback(
            assignment, self.scores, kind.checks, kind.seed_decides, examples=examples
        )
        self._tests: dict[str, CriterionResult] = {}
        self.has_given_secrets = False
        """Whether ``evidence`` has returned any secret evidence."""
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
        evidence = self._collector.evidence(self.assignment.criterion(criterion_id))
        self.has_given_secrets |= any(each.secret for each in evidence)
        return [original_of(each) for each in evidence]

    def first_failure(self) -> Failure | None:
        """Returns the first failure of the program so far, as a student may read it; None if there was none."""
        failed = sorted(
            (each for each in self._collector.collected() if each.failure is not None),
            key=lambda each: each.secret,
        )
        return public_failure(failed[0]) if failed else None

    def _judge(self, criterion: Criterion) -> CriterionResult:
        blank = CriterionResult(
            criterion.id,
            criterion.title,
            CriterionStatus.SKIPPED,
            0.0,
            criterion.points,
            criterion.visibility,
        )
        if self.scores.looks_afterwards and not self.scores.is_its_turn(criterion):
            return self._not_its_turn(criterion, blank)
        scored = self.scores.of(criterion)
        if not scored or (
            criterion.after is not None and not self.scores.of(self.assignment.criterion(criterion.after))
        ):
            return replace(blank, rationale="Graded with secret seeds when you hand in.")
        broken = next(
            (each for each in scored if status_of_failure(each.failure) is CriterionStatus.GRADER_ERROR), None
        )
        if broken is not None:
            return self._broken_result(criterion, str(broken.failure))
        if not self.scores.is_its_turn(criterion):
            return self._not_its_turn(criterion, blank)
        share = _earned_share(criterion, scored)
        full = share == 1.0
        shown = self.scores.shown(criterion, full=full)
        worst = min(shown, key=lambda each: each.share, default=None)
        status = (
            CriterionStatus.PASS if full else (CriterionStatus.PARTIAL if share > 0 else CriterionStatus.FAIL)
        )
        if worst is not None and worst.failure is not None and share == 0.0:
            status = status_of_failure(worst.failure)
        check = self._checks[criterion.check]
        rationale = "" if full else self._feedback.rationale(criterion, shown, worst)
        hints = () if full else self._feedback.hints(criterion, rationale, worst)
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
            teacher_note="" if full else self._feedback.teacher_note(criterion, scored),
        )

    def _not_its_turn(self, criterion: Criterion, blank: CriterionResult) -> CriterionResult:
        assert criterion.after is not None  # else it is always its turn
        title = self.assignment.criterion(criterion.after).title
        return replace(blank, rationale=NOT_ITS_TURN.format(title), depends_on=criterion.after)

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


def _earned_share(criterion: Criterion, scored: Sequence[ScoredEvidence]) -> float:
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


def _summarize_episode(scored: ScoredEvidence) -> EpisodeSummary:
    evidence = scored.evidence
    measure = None if scored.measure is None else _finite_or_none(scored.measure)
    return EpisodeSummary(evidence.label, evidence.outcome, scored.steps, measure, evidence.secret)


def _finite_or_none(measure: float | None) -> float | None:
    """Returns None for infinity and NaN, which JSON cannot represent."""
    return round(measure, 6) if measure is not None and math.isfinite(measure) else None


def _platform() -> str:
    return f"{sys.platform}, Python {sys.version_info.major}.{sys.version_info.minor}"
