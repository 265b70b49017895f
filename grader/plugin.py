"""The pytest plugin: ``pytest FOLDER --submission FILE -p grader.plugin``.

Collects ``assignment.yaml`` as one item per criterion, and nothing of the student's: the submission is data that another
process runs. A criterion that is not met is a failure; an error of the grader is a pytest error; what needs secret seeds
is skipped. Points are in the items' properties, and so in a JUnit report.

Teacher tests beside the assignment (``test_*.py``) get the fixture ``grading``, with the recordings the grader made;
``@pytest.mark.points(3)`` sets their worth. See ``grader.teacher_tests.reading``.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from grader.assignment import Assignment, Criterion
from grader.evidence_digest import ASSIGNMENT_FILE
from grader.grading import Grading, GradingOptions, open_grading
from grader.grading_level import LevelTooLow, LevelUnavailable, level_for_untrusted
from grader.reading import read_assignment
from grader.reports.cleaning import plain
from grader.submission import read_submission
from grader.submitted_files import SubmissionRefused
from grader.teacher_tests.reading import MARK, MARK_HELP
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import CriterionResult, CriterionStatus
from kit.results.result_blocks import format_points
from kit.world.problems import WorldError


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("grader", "grading a student's work")
    group.addoption("--submission", metavar="FILE", help="the submission: a file, a folder or an archive")
    group.addoption(
        "--grading-level", type=int, metavar="N", help="confinement level of the program (0 to 3)"
    )
    group.addoption("--secret-seeds", action="store_true", help="use the secret seeds too: for the grade")


class CriterionFailed(Exception):
    """A criterion is not met; the message is for the student."""


class GraderError(Exception):
    """The grader itself failed."""


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> AssignmentNode | None:
    if file_path.name != ASSIGNMENT_FILE or parent.config.getoption("--submission") is None:
        return None
    file: AssignmentNode = AssignmentNode.from_parent(parent, path=file_path)
    return file


class AssignmentNode(pytest.File):
    """Collects an item for each criterion of one assignment."""

    def collect(self) -> Iterator[CriterionItem]:
        try:
            assignment = read_assignment(self.path.parent)
        except WorldError as error:
            raise self.CollectError(str(error)) from None
        for criterion in assignment.criteria:
            yield CriterionItem.from_parent(
                self, name=criterion.id, assignment=assignment, criterion=criterion
            )


class CriterionItem(pytest.Item):
    """One criterion, graded on the recordings that the session shares."""

    def __init__(self, *, assignment: Assignment, criterion: Criterion, **keywords: Any) -> None:
        super().__init__(**keywords)
        self._assignment = assignment
        self._criterion = criterion

    def runtest(self) -> None:
        try:
            test = self.config.stash[GRADING_SESSION_KEY].open(self._assignment).judge(self._criterion)
        except SubmissionRefused as refused:
            raise CriterionFailed(str(refused)) from None
        self.user_properties += [
            ("points", format_points(test.points)),
            ("max_points", format_points(test.max_points)),
            ("status", test.status.value),
        ]
        if test.status is CriterionStatus.SKIPPED:
            pytest.skip(plain(test.rationale))
        if test.status is CriterionStatus.GRADER_ERROR:
            raise GraderError(plain(f"{test.rationale}\n{test.log}"))
        if test.status is not CriterionStatus.PASS:
            raise CriterionFailed(_feedback(test))

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> str:
        """Shows the rationale instead of a traceback through the grader."""
        return str(excinfo.value)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        return self.path, None, f"{self._assignment.title}: {self._criterion.title}"


def _feedback(test: CriterionResult) -> str:
    parts = [
        f"{format_points(test.points)} of {format_points(test.max_points)} points",
        test.rationale,
        f"expected {test.expected}, got {test.actual}" if test.actual else "",
        *(f"hint: {hint}" for hint in test.hints[:1]),
    ]
    return plain("\n".join(part for part in parts if part))


class GradingSession:
    """Keeps the open gradings of a pytest session, so that each assignment's episodes run once."""

    def __init__(self, config: pytest.Config) -> None:
        self._config = config
        self._stack = ExitStack()
        self._open: dict[str, Grading] = {}

    def open(self, assignment: Assignment) -> Grading:
        key = str(assignment.folder)
        if key not in self._open:
            level = self._config.getoption("--grading-level")
            secret = bool(self._config.getoption("--secret-seeds"))
            requested = None if level is None else Level(level)
            options = GradingOptions(level_for_untrusted(assignment, requested), secret=secret)
            try:
                submission = read_submission(
                    Path(str(self._config.getoption("--submission"))), assignment.submit
                )
                self._open[key] = self._stack.enter_context(open_grading(assignment, submission, options))
            except LevelUnavailable as error:
                raise GraderError(str(error)) from None
            except (SubmissionRefused, LevelTooLow) as error:
                raise CriterionFailed(str(error)) from None
        return self._open[key]

    def close(self) -> None:
        self._stack.close()


GRADING_SESSION_KEY = pytest.StashKey[GradingSession]()


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", MARK_HELP)
    config.stash[GRADING_SESSION_KEY] = GradingSession(config)


def pytest_unconfigure(config: pytest.Config) -> None:
    if GRADING_SESSION_KEY in config.stash:
        config.stash[GRADING_SESSION_KEY].close()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Reports an error of the grader as a pytest error (as in a fixture), never as a failure of the student's."""
    report = yield
    mark = item.get_closest_marker(MARK)
    if mark is not None and mark.args and report.when == "call":
        item.user_properties += [
            ("points", format_points(mark.args[0] if report.passed else 0.0)),
            ("max_points", format_points(mark.args[0])),
        ]
        report.user_properties = list(item.user_properties)
    if (
        isinstance(item, CriterionItem)
        and call.excinfo is not None
        and call.excinfo.errisinstance(GraderError)
    ):
        report.when = "setup"
    return report


@pytest.fixture(scope="session")
def grading(request: pytest.FixtureRequest) -> Grading:
    """The grading of the assignment in the session's root folder, for teacher tests."""
    folder = request.config.rootpath
    if request.config.getoption("--submission") is None:
        pytest.skip("no submission: give --submission FILE")
    return request.config.stash[GRADING_SESSION_KEY].open(read_assignment(folder))
