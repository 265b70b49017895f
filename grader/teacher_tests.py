"""Runs a teacher's own tests for points: functions ``test_*`` in files that ``assignment.yaml`` names under ``tests``.

They run under pytest, get the fixture ``grading``, and examine recordings that the grader made::

    @pytest.mark.points(3, after="reached", hints=["Drive on the right."])
    def test_keeps_to_the_right(grading):
        \"\"\"The robot left its side of the corridor.\"\"\"
        assert all((drive.track[:, 0] > 0.4).all() for drive in grading.evidence("runs"))

The docstring is the feedback, unless the assertion has a message of its own; a test's source is never shown. ``after`` names
the criterion or earlier test that must earn everything first. Only the files named are imported, since a student may work in the assignment's folder.
"""

from __future__ import annotations

import ast
import hashlib
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from grader.assignment import TeacherTest
from grader.author_code import AuthorCodeError, run_author_code
from grader.evidence.contract import EvidenceSource
from grader.evidence.submission_clock import SHORTEST_S, SubmissionClock
from grader.scoring import DEFAULT_STEPS, round_share, status_of_failure
from kit.host.failure import Failure
from kit.host.sandbox.confinement import Level
from kit.host.wire import Json
from kit.results.grading_result import CriterionResult, CriterionStatus, Visibility

if TYPE_CHECKING:
    import pytest

MARK: Final = "points"
MARK_HELP: Final = (
    f"{MARK}(number, after=None, visibility='visible', hints=()): what a teacher's test is worth"
)


def read_teacher_tests(file: Path) -> Iterator[TeacherTest]:
    """Yields the tests that a file declares, without running it. Raises ValueError, OSError, SyntaxError."""
    for node in ast.parse(file.read_text(encoding="utf-8"), file.name).body:
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test_"):
            marks = [each for each in node.decorator_list if isinstance(each, ast.Call) and _is_mark(each)]
            yield _read_test(node, marks[0] if marks else None, file)


def _is_mark(call: ast.Call) -> bool:
    return isinstance(call.func, ast.Attribute) and call.func.attr == MARK


def _read_test(node: ast.FunctionDef, mark: ast.Call | None, file: Path) -> TeacherTest:
    text = " ".join((ast.get_docstring(node) or "").split())
    if mark is None:
        return TeacherTest(node.name, 0.0, text)
    try:
        (points,) = map(ast.literal_eval, mark.args)
        keywords = {word.arg: ast.literal_eval(word.value) for word in mark.keywords}
        test = TeacherTest(
            node.name,
            float(points),
            text,
            Visibility(keywords.pop("visibility", Visibility.VISIBLE.value)),
            tuple(map(str, keywords.pop("hints", ()))),
            None if (after := keywords.pop("after", None)) is None else str(after),
        )
    except (ValueError, TypeError):
        keywords = {"?": None}
    if keywords or not 0.0 <= test.points <= 1e6:
        raise ValueError(
            f"{file.name}:{mark.lineno}: {MARK} takes a number from 0 on, and after, visibility and hints"
        )
    return test


def tests_digest(files: Sequence[Path]) -> str:
    """Returns a digest of what decides the outcomes of tests: their code, without what they are worth and what they say to
    whom. Empty without files. Raises OSError, SyntaxError."""
    digest = hashlib.sha256()
    for file in files:
        tree = ast.parse(file.read_text(encoding="utf-8"), file.name)
        for node in tree.body:
            if isinstance(node, ast.FunctionDef) and node.name.startswith("test_"):
                node.decorator_list = [
                    each
                    for each in node.decorator_list
                    if not (isinstance(each, ast.Call) and _is_mark(each))
                ]
                if ast.get_docstring(node) is not None:
                    node.body = [*node.body[1:], ast.Pass()]
        digest.update(ast.unparse(tree).encode())
    return digest.hexdigest()[:32] if files else ""


MIN_TIME_S: Final = 30.0
"""Wall clock that all tests together get at least [s], also where the program has used up the submission's."""


class TestTimeUsedUp(BaseException):
    """The tests have used up their time. No ``Exception``, so that no test takes it for one of its own."""

    __test__ = False  # no class of tests


class TestDeadline:
    """Ends tests that go on for too long: what they examine was made by the student's program, and may be anything."""

    __test__ = False  # no class of tests

    def __init__(self, limit_s: float) -> None:
        self._ends = time.monotonic() + limit_s

    @contextmanager
    def watch(self) -> Iterator[None]:
        """Raises TestTimeUsedUp in the block when the time is used up; afterwards, where signals cannot interrupt it."""
        if time.monotonic() >= self._ends:
            raise TestTimeUsedUp
        if not hasattr(signal, "setitimer") or threading.current_thread() is not threading.main_thread():
            yield
            if time.monotonic() >= self._ends:
                raise TestTimeUsedUp
            return
        began = time.monotonic()
        handler = signal.signal(signal.SIGALRM, _raise_time_used_up)
        outer_s, interval_s = signal.setitimer(signal.ITIMER_REAL, max(SHORTEST_S, self._ends - began))
        try:
            yield
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, handler)
            if outer_s:  # somebody else's alarm goes on
                left = max(SHORTEST_S, outer_s - (time.monotonic() - began))
                signal.setitimer(signal.ITIMER_REAL, left, interval_s)


def _raise_time_used_up(*_: object) -> None:
    raise TestTimeUsedUp


@dataclass(frozen=True, slots=True)
class TestOutcome:
    """The outcome of one run of a test function."""

    __test__ = False  # no class of tests

    status: CriterionStatus
    message: str
    uses_secrets: bool


@dataclass(eq=False)
class _Session:
    """State of the pytest run: the grading that tests get, and the outcomes of each test."""

    grading: EvidenceSource
    first_failure: Callable[[], Failure | None]
    """How the program failed; None if it did not."""
    deadline: TestDeadline
    outcomes: dict[str, list[TestOutcome]] = field(default_factory=dict)

    def note(self, item: Any, status: CriterionStatus, text: str) -> None:
        name = getattr(item, "originalname", None) or item.name
        # Secret evidence that an earlier test was given may be kept in a fixture.
        outcome = TestOutcome(status, text, uses_secrets=self.grading.has_given_secrets)
        self.outcomes.setdefault(name, []).append(outcome)


def run_teacher_tests(
    grading: EvidenceSource,
    folder: Path,
    tests: Sequence[TeacherTest],
    files: Sequence[Path],
    first_failure: Callable[[], Failure | None],
    clock: SubmissionClock,
    level: Level,
) -> Mapping[str, Sequence[TestOutcome]]:
    """Runs the tests apart from the grader, and returns the outcomes of each. An error in a test is the teacher's and costs
    no student a point.

    All evidence has been collected before. ``first_failure`` returns how the program failed: an error in a test that examines a
    failed program is the student's.
    The tests together may take what is left of the submission's time by ``clock``, and ``MIN_TIME_S`` in any case.
    """
    if not tests:
        return {}
    limit_s = max(MIN_TIME_S, clock.left_s)
    session = _Session(grading, first_failure, TestDeadline(limit_s))
    try:
        told = run_author_code(
            lambda: _run_pytest(session, folder, files), folder, level, limit_s + PYTEST_START_S
        )
        return {
            name: [TestOutcome(CriterionStatus(status), text, uses) for status, text, uses in each]
            for name, each in told.items()
        }
    except (AuthorCodeError, AttributeError, TypeError, ValueError) as error:  # or what is no answer
        broken = TestOutcome(CriterionStatus.GRADER_ERROR, str(error), uses_secrets=True)
        return {test.id: [broken] for test in tests}


PYTEST_START_S: Final = 60.0
"""Wall clock granted besides to pytest itself [s]."""


def _run_pytest(session: _Session, folder: Path, files: Sequence[Path]) -> dict[str, list[list[Json]]]:
    """Returns the outcomes of each test: status, message, whether it may have seen secret evidence."""
    with _isolated_environment():
        import pytest

        options = ["-p", "no:terminal", "-p", "no:cacheprovider", "-p", "no:faulthandler", "--capture=sys"]
        options += ["-c", os.devnull, "--rootdir", str(folder), "--confcutdir", str(folder)]
        options += ["--import-mode=importlib"]
        options += ["--noconftest"]  # one above the assignment's folder may be a student's
        pytest.main([*options, *map(str, files)], plugins=[_plugin(session)])
    _forget_modules(files)
    return {
        name: [[each.status.value, each.message, each.uses_secrets] for each in outcomes]
        for name, outcomes in session.outcomes.items()
    }


def _forget_modules(files: Sequence[Path]) -> None:
    """Removes the imported test files, so that another assignment's file of the same name is not taken for them."""
    paths = {str(file) for file in files}
    for name, module in list(sys.modules.items()):
        if getattr(module, "__file__", None) in paths:
            del sys.modules[name]


@contextmanager
def _isolated_environment() -> Iterator[None]:
    """Removes what would make pytest load plugins, whatever is installed or configured; restores it afterwards."""
    before = dict(os.environ)
    for name in ("PYTEST_ADDOPTS", "PYTEST_PLUGINS"):
        os.environ.pop(name, None)
    os.environ["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"
    try:
        yield
    finally:
        os.environ.clear()
        os.environ.update(before)


def _plugin(session: _Session) -> object:
    """Makes the plugin. A function, so that pytest is only imported where a teacher test runs."""
    import pytest

    class GradingPlugin:
        def pytest_configure(self, config: pytest.Config) -> None:
            config.addinivalue_line("markers", MARK_HELP)

        @pytest.fixture(scope="session")
        def grading(self) -> EvidenceSource:
            return session.grading

        @pytest.hookimpl(wrapper=True)
        def pytest_runtest_setup(self, item: pytest.Item) -> Generator[None, None, None]:
            with session.deadline.watch():
                return (yield)

        @pytest.hookimpl(wrapper=True)
        def pytest_runtest_call(self, item: pytest.Item) -> Generator[None, None, None]:
            with session.deadline.watch():
                return (yield)

        @pytest.hookimpl(wrapper=True)
        def pytest_runtest_makereport(
            self, item: pytest.Item, call: pytest.CallInfo[None]
        ) -> Generator[None, pytest.TestReport, pytest.TestReport]:
            report = yield
            if call.excinfo is None:
                if call.when == "call":
                    session.note(item, CriterionStatus.PASS, "")
            elif call.excinfo.errisinstance(TestTimeUsedUp):
                # The solution of the assignment does not take so long: a self-test would have shown it.
                session.note(item, CriterionStatus.TIMEOUT, TIME_USED_UP)
            elif call.excinfo.errisinstance(pytest.skip.Exception):
                session.note(item, CriterionStatus.SKIPPED, str(call.excinfo.value))
            elif call.when == "call" and call.excinfo.errisinstance((AssertionError, pytest.fail.Exception)):
                session.note(item, CriterionStatus.FAIL, _assertion_message(str(call.excinfo.value)))
            elif (failure := session.first_failure()) is not None:
                # Nothing that a program does may look like a fault of the test's, which would cost no points.
                session.note(item, status_of_failure(failure), str(failure))
            else:
                session.note(item, CriterionStatus.GRADER_ERROR, str(report.longrepr))
            return report

    return GradingPlugin()


TIME_USED_UP: Final = "The time was used up before this test of what your program did had ended."


def _assertion_message(message: str) -> str:
    """Returns an assertion's own message without what pytest adds, which is the test's source."""
    return message.partition("\nassert ")[0] if not message.startswith("assert ") else ""


def teacher_test_result(test: TeacherTest, outcomes: Sequence[TestOutcome]) -> CriterionResult:
    """Makes the result of one test; each outcome of a parametrized test is worth its share.

    A test that may have seen secret evidence pays in steps, and its own message is the teacher's alone.
    """
    statuses = [outcome.status for outcome in outcomes]
    uses_secrets = any(outcome.uses_secrets for outcome in outcomes)
    blank = CriterionResult(test.id, test.title, CriterionStatus.SKIPPED, 0.0, test.points, test.visibility)
    blank = replace(blank, uses_secrets=uses_secrets)
    if not outcomes or CriterionStatus.GRADER_ERROR in statuses:
        log = next(
            (each.message for each in outcomes if each.status is CriterionStatus.GRADER_ERROR),
            "It did not run.",
        )
        broken = "The grader failed here. This is not your fault and costs no points; your teacher will be informed."
        return replace(blank, status=CriterionStatus.GRADER_ERROR, rationale=broken, log=log)
    if set(statuses) == {CriterionStatus.SKIPPED}:
        reason = outcomes[0].message
        return replace(blank, teacher_note=reason) if uses_secrets else replace(blank, rationale=reason)
    judged = [status for status in statuses if status is not CriterionStatus.SKIPPED]
    share = judged.count(CriterionStatus.PASS) / len(judged)
    if uses_secrets:
        share = round_share(share, DEFAULT_STEPS)
    if share == 1.0:
        return replace(blank, status=CriterionStatus.PASS, points=test.points)
    message = next((each.message for each in outcomes if each.status not in NOT_LOST and each.message), "")
    text = test.feedback if uses_secrets else message or test.feedback
    return replace(
        blank,
        status=CriterionStatus.PARTIAL if share > 0 else _status_of_lost(statuses),
        points=round(test.points * share, 6),
        rationale=text or f"“{test.title}” does not hold.",
        hints=test.hints,
        teacher_note=message if uses_secrets else "",
    )


NOT_LOST: Final = (CriterionStatus.PASS, CriterionStatus.SKIPPED)


def _status_of_lost(statuses: Sequence[CriterionStatus]) -> CriterionStatus:
    """Returns why a test has earned nothing: the program's failure where all outcomes come from it."""
    lost = {status for status in statuses if status not in NOT_LOST}
    return lost.pop() if len(lost) == 1 else CriterionStatus.FAIL
