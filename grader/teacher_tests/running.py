"""Runs tests of a teacher's under pytest, apart from the grader."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from grader.assignment import TeacherTest
from grader.author_code import AuthorCodeError, run_author_code
from grader.evidence.contract import EvidenceSource
from grader.evidence.submission_clock import SubmissionClock
from grader.failure_status import status_of_failure
from grader.teacher_tests.deadline import TestDeadline, TestTimeUsedUp
from grader.teacher_tests.reading import MARK_HELP
from kit.host.failure import Failure
from kit.host.sandbox.sandbox_config import Level
from kit.host.wire import Json
from kit.results.grading_result import CriterionStatus

if TYPE_CHECKING:
    import pytest

MIN_TIME_S: Final = 30.0
"""Wall clock that all tests together get at least [s], also where the program has used up the submission's."""
PYTEST_START_S: Final = 60.0
"""Wall clock granted besides to pytest itself [s]."""
TIME_USED_UP: Final = "The time was used up before this test of what your program did had ended."


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


def _run_pytest(session: _Session, folder: Path, files: Sequence[Path]) -> dict[str, list[list[Json]]]:
    """Returns the outcomes of each test: status, message, whether it may have seen secret evidence."""
    with _isolated_environment():
        import pytest

        options = ["-p", "no:terminal", "-p", "no:cacheprovider", "-p", "no:faulthandler", "--capture=sys"]
        options += ["-c", os.devnull, "--rootdir", str(folder), "--confcutdir", str(folder)]
        options += ["--import-mode=importlib"]
        options += ["--noconftest"]  # one above the assignment's folder may be a student's
        pytest.main([*options, *map(str, files)], plugins=[_make_plugin(session)])
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


def _make_plugin(session: _Session) -> object:
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
                # The solution of the assignment does not take that long: a self-test would have shown it.
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


def _assertion_message(message: str) -> str:
    """Returns an assertion's own message without what pytest adds, which is the test's source."""
    return message.partition("\nassert ")[0] if not message.startswith("assert ") else ""
