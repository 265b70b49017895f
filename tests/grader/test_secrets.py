"""Secrets stay secret: no report for students holds anything of a secret episode, or of a test that is shown later."""

from __future__ import annotations

import json
import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner

from grader.__main__ import main
from grader.assignment import MAX_COUNTERPARTS, Assignment, Criterion
from grader.evidence.contract import EvidenceOptions, EvidenceRecord, FixedEvidence
from grader.evidence.submission_clock import SubmissionClock
from grader.grading import Grading, GradingOptions, grade
from grader.kinds.contract import find_kind
from grader.kinds.environment import kind as environment
from grader.kinds.function.kind import CaseDifference, FunctionComparison
from grader.reading import read_assignment
from grader.reports import FORMATS
from grader.reports.formats.text_report import write_text
from grader.scoring import round_share
from grader.seeds import counterpart_seed, short_seeds_warning
from grader.submission import Submission
from kit.host.failure import Failure, FailureKind
from kit.host.program_start import child_seed
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import (
    CriterionResult,
    CriterionStatus,
    GradingResult,
    GradingTiming,
    Visibility,
)
from kit.world.problems import WorldError
from tests.cases import every_case
from tests.grader.conftest import FORWARD, LOCKS, QUICK, write_assignment
from tests.grader.kinds.test_damaged_works import right_work

GRADE = GradingOptions(Level.LIMITED, secret=True, examples=True)
SECRET_SEED = 4_182_736_451_928_374_651
FOR_TEACHERS = ("json", "text", "gradescope")
"""Formats whose writers leave it to the caller, or to the service, what a student sees."""


def student_reports(result: GradingResult) -> Mapping[str, str]:
    """Everything that a student can be shown of a result."""
    shown = result.for_student()
    reports = {form: each.write(shown) for form, each in FORMATS.items()}
    reports["text with all hints"] = write_text(shown, hints=3)
    again = GradingResult.from_dict(json.loads(FORMATS["json"].write(shown)))
    reports |= {f"{form} of the written JSON": each.write(again) for form, each in FORMATS.items()}
    directly = {form: FORMATS[form].write(result) for form in FORMATS if form not in FOR_TEACHERS}
    if all(test.visibility is Visibility.VISIBLE for test in result.tests):
        directly["gradescope"] = FORMATS["gradescope"].write(result)
    return reports | {f"{form} without --for-student": report for form, report in directly.items()}


FUNCTION_TEXT = """
title: One function
kind: function
submit: scans.py
level: 0
functions: [{name: nearest}]
checks:
  - {check: agrees, points: 3.3, share: {none: 0, full: 1}, hints: [Try it by hand.]}
"""


@pytest.fixture
def function_assignment(tmp_path: Path) -> Assignment:
    folder = write_assignment(tmp_path / "f", FUNCTION_TEXT, secret=f"seed: {SECRET_SEED}")
    (folder / "reference.py").write_text(
        "def nearest(x): return x\ndef nearest_cases(chance): yield {'x': 1}\n"
    )
    return read_assignment(folder)


class MeasuredOnly:
    """A collector of finished evidence, of which one piece is secret."""

    level = Level.LIMITED

    def __init__(self, *evidence: EvidenceRecord) -> None:
        self._evidence = evidence

    def evidence(self, criterion: Criterion) -> Sequence[EvidenceRecord]:
        return self._evidence

    def collected(self) -> Sequence[EvidenceRecord]:
        return self._evidence

    def public_evidence(self, criterion: Criterion) -> Sequence[EvidenceRecord]:
        return [each for each in self._evidence if not each.secret]

    def counterparts(self, criterion: Criterion) -> Iterator[EvidenceRecord]:
        return iter(())


def comparison(differences: int, **more: object) -> EvidenceRecord:
    wrong = (CaseDifference({"x": 1.0}, 1.0, 2.0),) * differences
    return EvidenceRecord(FunctionComparison("nearest", 10_000, wrong), **more)  # type: ignore[arg-type]  # by name


def measured(assignment: Assignment, *evidence: EvidenceRecord, wall_s: float = 1.0) -> GradingResult:
    submission = Submission("ada", "scans.py", {"scans.py": b""})
    result = Grading(
        assignment, submission, MeasuredOnly(*evidence), secret=True, clock=SubmissionClock()
    ).result()
    return replace(result, timing=GradingTiming("2026-01-01T00:00:00+00:00", wall_s))


def secret_comparison(differences: int) -> EvidenceRecord:
    return comparison(
        differences,
        label="nearest() on secret cases",
        secret=True,
        outcome=f"ended at {differences}",
        steps=70_000 + differences,
        printed=(f"printed {differences}",),
        explain_with=lambda check, params: f"explained {differences}",
        draw_with=lambda check: f"drawn {differences}",
    )


@pytest.mark.parametrize("with_public", [True, False], ids=["beside public evidence", "alone"])
@pytest.mark.parametrize("steps", [None, 4], ids=["steps by default", "steps stated"])
def test_a_secret_measure_shows_in_whole_steps_alone(
    function_assignment: Assignment, with_public: bool, steps: int | None
) -> None:
    criterion = replace(function_assignment.criteria[0], share_steps=steps)
    assignment = replace(function_assignment, criteria=(criterion,))
    public = [comparison(0, label="nearest()", steps=10)] if with_public else []
    reports_by_points: dict[float | None, Mapping[str, str]] = {}
    for number, differences in enumerate((1, 37, 1041, 2957, 3211, 4993, 6007, 7919, 9973)):
        result = measured(assignment, *public, secret_comparison(differences), wall_s=1.5 + number)
        assert result.steps - result.secret_steps == (10 if with_public else 0)
        reports = student_reports(result)
        assert reports == reports_by_points.setdefault(result.points, reports)
        for form, report in reports.items():
            for trace in (str(differences), f"{(10_000 - differences) / 100:g}", "secret cases", "ended at"):
                assert len(trace) < 3 or trace not in report, (form, trace)
    if not with_public and steps is None:
        assert list(reports_by_points) == [0.0], "nothing between all and nothing comes from secrets alone"
    else:
        assert 2 <= len(reports_by_points) <= 4
    assert {points for points in reports_by_points if points is not None} <= {0, 0.825, 1.65, 2.475}


def test_how_a_program_fails_on_secrets_is_the_teachers_to_know(function_assignment: Assignment) -> None:
    public = comparison(0, label="nearest()")
    failures = [
        Failure(FailureKind.TIMEOUT, "2718 s"),
        Failure(FailureKind.EXCEPTION, "ValueError: 2718"),
        Failure(FailureKind.MEMORY, "2718 MB"),
        None,
    ]
    secrets = [EvidenceRecord(failure=each, label="secret 2718", secret=True) for each in failures[:-1]]
    results = [measured(function_assignment, public, each) for each in (*secrets, secret_comparison(10_000))]
    first, *others = map(student_reports, results)
    assert all(each == first for each in others)
    assert not any("2718" in report for report in first.values())
    assert "took too long (secret 2718)" in results[0].tests[0].teacher_note
    assert results[0].tests[0].hints == ("Try it by hand.",)
    assert "“agrees” is not met with the secret seeds" in results[0].tests[0].rationale


@pytest.mark.parametrize("level", [Level.LIMITED, Level.FILTERED])
def test_where_secret_runs_alone_lose_points_ones_own_check_says_what_was_seen(
    function_assignment: Assignment, monkeypatch: pytest.MonkeyPatch, level: Level
) -> None:
    monkeypatch.setattr(MeasuredOnly, "level", level)
    monkeypatch.setattr(
        MeasuredOnly, "counterparts", lambda *_: iter([comparison(0, label="another seed")] * 3), raising=True
    )
    found = MeasuredOnly(comparison(0, label="nearest()"), secret_comparison(2000), secret_comparison(0))
    submission = Submission("ada", "scans.py", {"scans.py": b""})
    grading = Grading(
        function_assignment, submission, found, secret=True, clock=SubmissionClock(), examples=True
    )
    [test] = grading.result().tests
    worst = grading.scores.worst()
    assert "printed 2000" not in test.log
    if level is Level.LIMITED:
        assert "80 %" in test.rationale
        assert "explained 2000" in test.rationale
        assert "all public seeds" in test.rationale
        assert "3 further seeds" in test.rationale
        assert "1 of 2 secret ones" in test.rationale
        assert "A seed decides" in test.rationale
        assert test.replay == "drawn 2000", "the picture is of the run that the verdict is about"
        assert worst is found.evidence(function_assignment.criteria[0])[1]
    else:
        assert "2000" not in f"{test.rationale}{test.replay}"
        assert worst is None


def test_an_example_that_loses_less_than_the_secret_run_is_not_told_as_why_points_are_lost(
    function_assignment: Assignment, monkeypatch: pytest.MonkeyPatch
) -> None:
    almost = comparison(1, label="another seed", explain_with=lambda *_: "explained 1")
    monkeypatch.setattr(MeasuredOnly, "counterparts", lambda *_: iter([almost]), raising=True)
    found = MeasuredOnly(comparison(0, label="nearest()"), secret_comparison(10_000))
    submission = Submission("ada", "scans.py", {"scans.py": b""})
    grading = Grading(
        function_assignment, submission, found, secret=True, clock=SubmissionClock(), examples=True
    )
    [test] = grading.result().tests
    assert test.points == 0, "what only the public cases earn is not earned"
    assert "explained 10000" in test.rationale
    assert "explained 1" not in test.rationale.replace("explained 10000", "")
    assert grading.scores.worst() is found.evidence(function_assignment.criteria[0])[1]


def test_a_broken_grader_tells_students_no_secret(function_assignment: Assignment) -> None:
    failure = Failure(FailureKind.CONFINEMENT, f"seed {SECRET_SEED}")
    result = measured(function_assignment, EvidenceRecord(failure=failure, label="it", secret=True))
    assert result.points is None
    assert str(SECRET_SEED) in result.tests[0].log
    assert not any(str(SECRET_SEED) in report for report in student_reports(result).values())


# Drives as fast as its own seed says: what it measures carries the seed out, if anything does.
SEED_READER = FORWARD.replace("SPEED = 0.3", "import random\nSPEED = 0.05 + random.random() / 10")


@pytest.mark.long
@pytest.mark.parametrize("level", [Level.LIMITED, pytest.param(Level.FILTERED, marks=LOCKS)])
def test_nothing_of_a_secret_drive_reaches_a_student(tmp_path: Path, level: Level) -> None:
    text = QUICK.replace("check: moves, points: 2", "check: moves, points: 2.1").replace(
        "full: 0.5", "full: 0.9"
    )
    folder = write_assignment(tmp_path / "s", text, secret=f"seeds: {{turn: [{SECRET_SEED}]}}")
    submission = Submission("ada", "controller.py", {"controller.py": SEED_READER.encode()})
    result = grade(read_assignment(folder), submission, GradingOptions(level, secret=True))
    (moved,) = (test for test in result.tests if test.id == "moves")
    public, secret = moved.episodes
    assert (public.secret, secret.secret, moved.status) == (False, True, CriterionStatus.PARTIAL)
    assert public.measure is not None
    assert secret.measure is not None
    assert f"{public.measure:.3f}" != f"{secret.measure:.3f}"
    seeds = {str(SECRET_SEED), str(child_seed(SECRET_SEED)), f"{SECRET_SEED:x}", str(SECRET_SEED)[:9]}
    for form, report in student_reports(result).items():
        for trace in (*seeds, f"{secret.measure:.3f}", "secret seed"):
            assert trace not in report, (form, trace)
    assert any(f"{public.measure:.2f}" in report for report in student_reports(result).values())
    assert moved.points in {2.1 * share for share in (0, 0.25, 0.5, 0.75)}


HIDDEN_OUTCOMES = [
    (CriterionStatus.PASS, 2.718),
    (CriterionStatus.PARTIAL, 1.618),
    (CriterionStatus.FAIL, 0.0),
    (CriterionStatus.TIMEOUT, 0.0),
    (CriterionStatus.SKIPPED, 0.0),
]


@pytest.mark.parametrize("visibility", [each for each in Visibility if each is not Visibility.VISIBLE])
def test_a_test_that_is_shown_later_is_blank_everywhere(visibility: Visibility) -> None:
    seen = CriterionResult("a", "Seen", CriterionStatus.PASS, 1.0, 1.0)
    all_reports = []
    for status, points in HIDDEN_OUTCOMES:
        later = CriterionResult(
            "b",
            "Later",
            status,
            points,
            2.718,
            visibility,
            rationale="why",
            actual="so",
            log="why",
            depends_on="x" if status is CriterionStatus.SKIPPED else None,
        )
        result = GradingResult(
            "reach",
            "v1",
            "abc",
            "0.1",
            "public",
            1,
            "linux",
            (seen, later),
            timing=GradingTiming(
                "2026-01-01T00:00:00+00:00", 1.0
            ),  # else one format takes the present second
        )
        shown = result.for_student()
        assert (shown.points, shown.max_points, shown.verdict.value) == (1.0, 1.0, "pass")
        all_reports.append(student_reports(result))
    assert all(reports == all_reports[0] for reports in all_reports)
    for form, report in all_reports[0].items():
        assert "2.7" not in report, form
        assert "Later" in report, form
    data = json.loads(all_reports[0]["json"])["tests"][1]
    assert (data["status"], data["points"], data["max_points"]) == (None, None, None)


def test_what_depends_on_a_hidden_test_is_hidden_too(tmp_path: Path) -> None:
    text = QUICK.replace("check: runs, points: 1", "check: runs, points: 1, visibility: hidden")
    assignment = read_assignment(write_assignment(tmp_path / "h", text))
    assert [each.visibility.value for each in assignment.criteria] == ["hidden"] * 3


def test_a_broken_hidden_test_gives_a_student_no_grade() -> None:
    broken = CriterionResult("b", "B", CriterionStatus.GRADER_ERROR, 0.0, 1.0, Visibility.HIDDEN, log="why")
    result = GradingResult("reach", "v1", "abc", "0.1", "public", 1, "linux", (broken,))
    shown = GradingResult.from_dict(json.loads(FORMATS["json"].write(result.for_student())))
    assert (shown.points, shown.tests[0].log) == (None, "")


def first_number(seed: int) -> float:
    """The first random number of a program in a run with this seed."""
    return random.Random(child_seed(seed)).random()


PICKY = FORWARD.replace("SPEED = 0.3", "import random\nSPEED = 0.0 if UNLUCKY else 0.3").replace(
    "UNLUCKY", "{condition}"
)
MOVES = QUICK.replace("time: 4", "time: 2").replace(
    "check: moves, points: 2", "check: moves, points: 2, hints: [Look at the wheels.]"
)


def moves_result(folder: Path, condition: str, secret: int, public: int) -> CriterionResult:
    text = MOVES.replace("seeds: [1]", f"seeds: [{public}]")
    assignment = read_assignment(write_assignment(folder, text, secret=f"seeds: {{turn: [{secret}]}}"))
    source = PICKY.replace("{condition}", condition)
    result = grade(assignment, Submission("ada", "controller.py", {"controller.py": source.encode()}), GRADE)
    return next(test for test in result.tests if test.id == "moves")


@pytest.mark.long
def test_a_public_seed_that_fails_too_is_shown_instead_of_a_secret_one(tmp_path: Path) -> None:
    numbers = [first_number(counterpart_seed(number)) for number in range(MAX_COUNTERPARTS)]
    limit = sorted(numbers)[1]  # at least one counterpart is below
    public = next(seed for seed in range(1, 1000) if first_number(seed) > limit)
    secret = next(seed for seed in range(2**40, 2**40 + 1000) if first_number(seed) < limit)
    test = moves_result(tmp_path / "m", f"random.random() < {limit!r}", secret, public)
    assert test.status is CriterionStatus.FAIL
    shown = next(
        seed for seed in map(counterpart_seed, range(MAX_COUNTERPARTS)) if first_number(seed) < limit
    )
    assert f"turn, seed {shown}" in test.rationale
    assert "turn, secret seed 1" in test.teacher_note
    assert test.replay


@pytest.mark.long
def test_without_a_public_seed_that_fails_the_secret_run_is_told_at_level_0(tmp_path: Path) -> None:
    secret = 2**40 + 5
    test = moves_result(tmp_path / "m", f"abs(random.random() - {first_number(secret)!r}) < 1e-12", secret, 1)
    assert test.status is CriterionStatus.FAIL
    assert "It is met with all public seeds" in test.rationale
    assert test.hints == ("Look at the wheels.",)
    assert test.replay


def test_an_environment_is_told_no_secret_seed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seeds: list[int] = []

    def examine(assignment: object, file: Path, options: EvidenceOptions, seed: int) -> EvidenceRecord:
        seeds.append(seed)
        return EvidenceRecord(label="the environment")

    task = replace_task(seed=1, secret_seed=SECRET_SEED)
    monkeypatch.setattr(environment, "_examine", examine)
    options = EvidenceOptions(Level.LIMITED, secret=True)
    with environment.KIND.collect(task, tmp_path, options) as collector:  # type: ignore[arg-type]  # only its task is used
        (record,) = collector.evidence(None)  # type: ignore[arg-type]  # the same for every criterion
        (counterpart,) = collector.counterparts(None)  # type: ignore[arg-type]  # likewise
    assert (record.secret, counterpart.secret) == (True, False)
    assert seeds == [child_seed(SECRET_SEED) % 2**31, 1]


def replace_task(seed: int, secret_seed: int) -> object:
    """An assignment of which only the seeds count."""
    task = type("Task", (), {"seed": seed, "secret_seed": secret_seed})()
    return type("OnlyTask", (), {"task": task, "secret_seeds": (secret_seed,)})()


def test_evidence_has_counterparts_only_where_it_is_secret() -> None:
    fixed = FixedEvidence([EvidenceRecord()], Level.LIMITED)
    assert list(fixed.counterparts(None)) == []  # type: ignore[arg-type]  # the same for every criterion


TEACHER_TEST = """
import pytest

@pytest.mark.points(3)
def test_it(grading):
    "It should move."
    (_, secret) = grading.evidence("runs")
    assert secret.steps < 0, f"measured {secret.steps}"
"""


@pytest.mark.long
def test_a_teachers_test_of_secret_episodes_says_only_its_docstring(tmp_path: Path) -> None:
    folder = tmp_path / "t"
    write_assignment(folder, QUICK + "tests: [test_own.py]\n", secret="seeds: {turn: [5]}")
    (folder / "test_own.py").write_text(TEACHER_TEST)
    submission = Submission("ada", "controller.py", {"controller.py": FORWARD.encode()})
    result = grade(read_assignment(folder), submission, GRADE)
    test = result.tests[-1]
    assert (test.rationale, test.teacher_note) == (
        "It should move.",
        f"measured {result.tests[0].episodes[1].steps}",
    )
    assert not any("measured" in report for report in student_reports(result).values())


@every_case(
    ("share", "steps", "paid"),
    [
        (1.0, 4, 1.0),
        (0.999, 4, 0.75),
        (0.7, 4, 0.75),
        (0.62, 4, 0.5),
        (0.1, 4, 0.0),
        (0.0, 4, 0.0),
        (0.99, 1, 0.0),
    ],
)
def test_a_share_is_rounded_to_steps_below_all(share: float, steps: int, paid: float) -> None:
    assert round_share(share, steps) == paid
    assert share - paid <= 1 / steps


def test_steps_are_read_from_the_assignment(tmp_path: Path) -> None:
    text = QUICK.replace("{none: 0, full: 0.5}", "{none: 0, full: 0.5, steps: 10}")
    made = read_assignment(write_assignment(tmp_path / "s", text))
    assert [each.share_steps for each in made.criteria] == [None, 10, None]
    folder = write_assignment(tmp_path / "t", text.replace("steps: 10", "steps: 1000"))
    with pytest.raises(WorldError, match="steps"):
        read_assignment(folder)


def test_a_long_seed_is_read_to_its_last_digit(tmp_path: Path) -> None:
    folder = write_assignment(tmp_path / "l", QUICK, secret=f"seeds: {{turn: [{SECRET_SEED}]}}")
    assert read_assignment(folder).secret_seeds == (SECRET_SEED,)


@pytest.mark.parametrize("verb", ["self-test", "cohort"])
def test_short_secret_seeds_are_warned_about(tmp_path: Path, verb: str) -> None:
    (tmp_path / "class").mkdir()
    for seed, is_short in ((5, True), (SECRET_SEED, False)):
        folder = write_assignment(tmp_path / f"s{seed}", QUICK, secret=f"seeds: {{turn: [{seed}]}}")
        arguments = ["self-test", str(folder)]
        if verb == "cohort":
            queue = tmp_path / f"q{seed}"
            arguments = [
                "cohort",
                str(tmp_path / "class"),
                "--assignment",
                str(folder),
                "--queue",
                str(queue),
            ]
            arguments += ["--secret", "--level", "0", "--executor", "none"]
        told = CliRunner().invoke(main, arguments)
        assert ("1 of 1 secret seeds are below 4294967296" in told.stderr) is is_short, told.output
    assert short_seeds_warning([]) == ""


def test_no_digest_of_the_secrets_is_shown(tmp_path: Path) -> None:
    """Anybody could compute it for all short seeds."""
    one, other = (
        read_assignment(write_assignment(tmp_path / name / "q", secret=f"seeds: {{turn: [{seed}]}}"))
        for name, seed in (("a", 5), ("b", 6))
    )
    assert one.version != other.version
    assert one.public_version == other.public_version
    (tmp_path / "a" / "q" / "secret.yaml").unlink()
    assert read_assignment(one.folder).version == one.public_version, "a student's copy has the same"
    for seeds in ("public", "public+secret"):
        result = GradingResult("q", one.version, "abc", "0.1", seeds, 1, "linux", (), public_version="p12345")
        assert not any(one.version[:8] in report for report in student_reports(result).values())


def test_a_teacher_reads_what_went_wrong_with_secret_seeds(function_assignment: Assignment) -> None:
    result = measured(function_assignment, comparison(0), secret_comparison(5000))
    assert "With secret seeds: It returns what it should in 50 % of the cases." in write_text(result)
    assert "With secret seeds" not in write_text(result.for_student())


class OrderedRuns(MeasuredOnly):
    """A collector that notes in which order it runs what: one public, one secret piece of evidence, and its counterparts.

    ``is_lost``: whether the secret piece loses points, and the counterparts with it.
    """

    def __init__(self, level: Level, *, is_lost: bool) -> None:
        self.level = level
        self.order: list[str] = []
        self._lost = int(is_lost)
        self._kept: dict[str, EvidenceRecord] = {}

    def _run(self, name: str, differences: int) -> EvidenceRecord:
        if name not in self._kept:
            self.order.append(name)
            self._kept[name] = comparison(differences * 10_000, label=name, secret=name == "secret")
        return self._kept[name]

    def evidence(self, criterion: Criterion) -> Sequence[EvidenceRecord]:
        return [self._run("public", 0), self._run("secret", self._lost)]

    def public_evidence(self, criterion: Criterion) -> Sequence[EvidenceRecord]:
        return [self._run("public", 0)]

    def collected(self) -> Sequence[EvidenceRecord]:
        return list(self._kept.values())

    def counterparts(self, criterion: Criterion) -> Iterator[EvidenceRecord]:
        for number in (1, 2):
            yield self._run(f"counterpart {number}", self._lost)


@pytest.mark.parametrize(
    ("level", "examples", "is_lost", "order"),
    [
        (Level.FILTERED, False, True, ["public", "secret"]),
        (Level.FILTERED, True, True, ["public", "counterpart 1", "secret"]),
        (Level.FILTERED, True, False, ["public", "counterpart 1", "counterpart 2", "secret"]),
        (Level.LIMITED, True, True, ["public", "secret", "counterpart 1"]),
        (Level.LIMITED, True, False, ["public", "secret"]),
    ],
)
def test_nothing_that_a_student_reads_of_is_run_after_a_secret_run(
    function_assignment: Assignment, level: Level, examples: bool, is_lost: bool, order: list[str]
) -> None:
    """But at level 0, where a program can read the secrets themselves."""
    collector, submission = (
        OrderedRuns(level, is_lost=is_lost),
        Submission("ada", "scans.py", {"scans.py": b""}),
    )
    result = Grading(
        function_assignment, submission, collector, secret=True, clock=SubmissionClock(), examples=examples
    ).result()
    assert collector.order == order
    assert ("It returns what it should in 0 %" in result.tests[0].rationale) == (is_lost and examples)


class RunsOfCriteria(MeasuredOnly):
    """A collector with one public piece of evidence for each criterion, that of the first wrong in so many cases."""

    def __init__(self, wrong: int) -> None:
        self._wrong = wrong
        self.run: dict[str, EvidenceRecord] = {}

    def evidence(self, criterion: Criterion) -> Sequence[EvidenceRecord]:
        is_first = criterion.after is None
        return [self.run.setdefault(criterion.id, comparison(self._wrong if is_first else 0))]

    def public_evidence(self, criterion: Criterion) -> Sequence[EvidenceRecord]:
        return self.evidence(criterion)

    def collected(self) -> Sequence[EvidenceRecord]:
        return list(self.run.values())


@pytest.mark.parametrize(
    ("wrong", "statuses", "run"),
    [
        (10_000, ["fail", "skipped", "skipped"], ["one"]),
        (0, ["pass", "pass", "pass"], ["one", "two", "three"]),
    ],
)
def test_an_own_check_runs_nothing_for_a_criterion_whose_turn_has_not_come(
    function_assignment: Assignment, wrong: int, statuses: list[str], run: list[str]
) -> None:
    """Nor for the one that comes after it."""
    first = function_assignment.criteria[0]
    criteria = tuple(
        replace(first, id=name, after=after)
        for name, after in (("one", None), ("two", "one"), ("three", "two"))
    )
    assignment = replace(function_assignment, criteria=criteria)
    collector, work = RunsOfCriteria(wrong), Submission("ada", "scans.py", {"scans.py": b""})
    grading = Grading(assignment, work, collector, secret=True, clock=SubmissionClock(), examples=True)
    assert [each.status.value for each in grading.result().tests] == statuses
    assert list(collector.run) == run


@pytest.mark.long
@pytest.mark.parametrize("kind", ["controller", "function", "launch", "environment"])
def test_every_kind_that_runs_programs_tells_public_evidence_from_secret(kind: str, tmp_path: Path) -> None:
    """``public_evidence`` of a real collector runs nothing secret, and ``evidence`` adds to it."""
    assignment, submission = right_work(kind, tmp_path)
    with submission.in_temporary_folder() as file:
        options = EvidenceOptions(Level.LIMITED, secret=True)
        with find_kind(kind).collect(assignment, file, options) as collector:
            assert not any(each.secret for each in collector.collected())
            for criterion in assignment.criteria:
                assert not any(each.secret for each in collector.public_evidence(criterion))
            assert not any(each.secret for each in collector.collected())
            collector.evidence(assignment.criteria[-1])
            assert any(each.secret for each in collector.collected())
