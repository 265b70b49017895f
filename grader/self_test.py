"""Tests an assignment on its own starter, solution and wrong solutions.

The starter must run without an error and must not pass. The solution must earn full points, twice with the same result.
Every ``wrong/ID`` (or ``wrong/ID+ID__comment``) must lose the criteria it is named for, those that depend on them, and no
others. Each is a file with the ending of a submission, a folder that holds it, or ``wrong/ID__comment.diff``: edits of the
solution, as ``diff -U1 solution.py wrong.py`` prints them, without need of line numbers. Lines that begin with ``-`` are
replaced by those that begin with ``+``, at the place where they stand together with the lines that begin with a space; parts
are separated by lines that begin with ``@@``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from enum import Enum
from itertools import groupby, repeat
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from grader.assignment import Assignment
from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from grader.scoring import required_passes, unfair_fail_probability
from grader.seeds import SeedSet
from grader.submission import read_submission
from grader.submitted_files import SubmissionRefused, SubmissionUnreadable
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import CriterionStatus, GradingResult, GradingVerdict
from kit.results.result_blocks import format_points

ENDING: Final = ".diff"


class EditsError(ValueError):
    """Edits that do not fit their solution."""


def apply_edits(solution: str, edits: str) -> str:
    """Returns the solution with the edits made, each after the one before.

    Raises EditsError where what an edit replaces does not stand there, or stands there more than once.

    >>> apply_edits("speed = 0.5\\nturn = 1.0\\n", "@@\\n speed = 0.5\\n-turn = 1.0\\n+turn = -1.0\\n")
    'speed = 0.5\\nturn = -1.0\\n'
    """
    lines, done = solution.split("\n"), 0
    for number, part in enumerate(_diff_parts(edits), 1):
        old = [line[1:] for line in part if line[:1] in ("", " ", "-")]
        new = [line[1:] for line in part if line[:1] in ("", " ", "+")]
        places = [
            start
            for start in range(done, len(lines) - len(old) + 1)
            if old and lines[start : start + len(old)] == old
        ]
        if len(places) != 1:
            shown = "\n".join(old) or "nothing: give a line beside it"
            count = "not in the solution" if not places else f"there {len(places)} times"
            raise EditsError(f"edit {number}: what it replaces is {count}:\n{shown}")
        lines[places[0] : places[0] + len(old)] = new
        done = places[0] + len(new)
    return "\n".join(lines)


def _diff_parts(edits: str) -> Iterator[list[str]]:
    """The lines of each part; the names of files above the first are no part."""
    lines = edits.removesuffix("\n").split("\n")
    first = next((i for i, line in enumerate(lines) if line.startswith("@@")), len(lines))
    for is_head, part in groupby(lines[first:], lambda line: line.startswith("@@")):
        if not is_head:
            yield [line for line in part if not line.startswith("\\")]


def list_wrong_works(folder: Path, ending: str) -> list[Path]:
    """The wrong works of a folder: files with the ending of what is handed in, folders, and edits of the solution."""
    return sorted(
        each
        for each in folder.glob("[!._]*")
        if each.name != "__pycache__" and (each.is_dir() or each.suffix in (ending, ENDING))
    )


def written_out(work: Path, solution: Path, into: Path) -> Path:
    """The work as it would be handed in: itself, or, for edits, a file in the folder ``into``. Raises EditsError."""
    if work.suffix != ENDING:
        return work
    file = into / f"{work.stem}{solution.suffix}"
    try:
        file.write_text(apply_edits(solution.read_text("utf-8"), work.read_text("utf-8")), "utf-8")
    except (OSError, UnicodeError, EditsError) as error:
        raise EditsError(f"{work.name}: {error}") from error
    return file


STARTER: Final = "starter"
SOLUTION: Final = "solution"
WRONG: Final = "wrong"

STARTER_SHARE: Final = 0.2
"""The most of an assignment's points that an untouched starter may earn: doing nothing does not pay."""
STARTER_RULE: Final = (
    "a starter is read and runs without an error, so that a student's first check says what to do: fill it in so far that "
    "nothing stops there, and that it earns next to nothing"
)
SUCCESS_RATES: Final = (0.9, 0.95, 0.99)
"""Success probabilities of a good work, for which the odds of a fail are computed."""


@dataclass(frozen=True, slots=True)
class WorkReport:
    """The result of testing one starter, solution or wrong solution."""

    name: str
    problems: tuple[str, ...]
    """What is wrong; empty if nothing is."""
    summary: str


@dataclass(frozen=True, slots=True)
class UnfairFailOdds:
    """The probabilities that a good work fails a criterion by bad luck."""

    criterion: str
    episodes: int
    required_passes: int
    """The number of episodes that must succeed."""
    probabilities: tuple[float, ...]
    """One for each of ``SUCCESS_RATES``."""


class WorkRole(Enum):
    """What a work of an assignment is there to show."""

    STARTER = "starter"
    SOLUTION = "solution"
    WRONG = "wrong"


@dataclass(frozen=True, slots=True)
class TestedWork:
    """One work that the self-test grades."""

    __test__ = False  # no class of tests

    role: WorkRole
    file: Path
    """A wrong work may be edits of the solution."""
    solution: Path


def works_of(assignment: Assignment, solutions: Path | None = None) -> tuple[TestedWork, ...]:
    """Returns the starter, the solution and the wrong solutions of an assignment.

    ``solutions``: the folder of the solution and the wrong solutions, if it is not the assignment's.
    """
    solutions = assignment.folder if solutions is None else solutions
    solution = _work_path(solutions, SOLUTION, assignment)
    wrong = list_wrong_works(solutions / WRONG, Path(assignment.submit).suffix)
    return (
        TestedWork(WorkRole.STARTER, _work_path(assignment.folder, STARTER, assignment), solution),
        TestedWork(WorkRole.SOLUTION, solution, solution),
        *(TestedWork(WorkRole.WRONG, each, solution) for each in wrong),
    )


def try_works(
    assignment: Assignment, options: GradingOptions, solutions: Path | None = None, *, jobs: int = 1
) -> Iterator[WorkReport]:
    """Yields the report on the starter, the solution and each wrong solution, in this order. Raises LevelTooLow.

    ``jobs``: how many are graded at once, each in a process of its own; what they are doing is shown only of one.
    """
    works = works_of(assignment, solutions)
    if jobs == 1:
        yield from (try_work(assignment, work, options) for work in works)
    else:
        silent = replace(options, show_progress=_show_nothing)
        with ProcessPoolExecutor(min(jobs, len(works)), mp_context=get_context("spawn")) as pool:
            yield from pool.map(
                _try_work_of, repeat(assignment.folder), repeat(assignment.level), works, repeat(silent)
            )
    if all(work.role is not WorkRole.WRONG for work in works):
        yield WorkReport(WRONG, ("there are no wrong solutions: nothing shows that points can be lost",), "")


def _show_nothing(text: str) -> None:
    """Takes the place of ``show_progress`` in a process of its own."""


def _try_work_of(folder: Path, level: Level, work: TestedWork, options: GradingOptions) -> WorkReport:
    return try_work(replace(read_assignment(folder), level=level), work, options)


def try_work(assignment: Assignment, work: TestedWork, options: GradingOptions) -> WorkReport:
    """Grades one work and reports what it does not show of what it is there for. Raises LevelTooLow."""
    if work.role is WorkRole.STARTER:
        return _try_starter(assignment, work.file, options)
    if work.role is WorkRole.SOLUTION:
        return _try_solution(assignment, work.file, options)
    with TemporaryDirectory(prefix="kit-wrong-") as folder:
        try:
            file = written_out(work.file, work.solution, Path(folder))
        except EditsError as error:
            return WorkReport(f"{WRONG}/{work.file.name}", (str(error),), "")
        return _try_wrong(assignment, file, options)


def unfair_fail_odds(assignment: Assignment, *, secret: bool) -> Iterator[UnfairFailOdds]:
    """Yields the odds for every criterion that is judged on seeds."""
    for criterion in assignment.criteria:
        count = 0
        for name in criterion.trials:
            trial = assignment.trial(name)
            count += len(trial.seeds) if criterion.seeds is not SeedSet.SECRET else 0
            count += len(trial.secret_seeds) if secret and criterion.seeds is not SeedSet.PUBLIC else 0
        if count:
            required = required_passes(count, criterion.need if criterion.need is not None else 1.0)
            yield UnfairFailOdds(
                criterion.id,
                count,
                required,
                tuple(unfair_fail_probability(success, count, required) for success in SUCCESS_RATES),
            )


def _work_path(folder: Path, stem: str, assignment: Assignment) -> Path:
    """Returns the path of a work: a folder of this name, or a file of this name with the submission's ending."""
    folder_path = folder / stem
    return folder_path if folder_path.is_dir() else folder / f"{stem}{Path(assignment.submit).suffix}"


def _try_starter(assignment: Assignment, file: Path, options: GradingOptions) -> WorkReport:
    result = _grade(assignment, file, options)
    if isinstance(result, str):
        return WorkReport(file.name, (result,), "")
    problems = _grader_errors(result)
    if result.verdict is GradingVerdict.PASS:
        problems.append("it passes: there is nothing left to do")
    elif (result.points or 0.0) > STARTER_SHARE * result.max_points + 1e-9:
        problems.append(
            f"untouched, it earns {format_points(result.points or 0.0)} of {format_points(result.max_points)} points, "
            f"more than {STARTER_SHARE:.0%}: let what it meets by doing nothing count only after the main criterion "
            '(after: ID in the sheet; after="ID" in the points mark of a test of your own)'
        )
    stopped = {
        CriterionStatus.STUDENT_ERROR,
        CriterionStatus.TIMEOUT,
        CriterionStatus.RESOURCE_LIMIT,
        CriterionStatus.PROTOCOL_ERROR,
    }
    errors = [
        f"{test.id}: {test.status.value}: {test.rationale}" for test in result.tests if test.status in stopped
    ]
    if errors:
        problems += [*errors, STARTER_RULE]
    return WorkReport(file.name, tuple(problems), _summary(result))


def _try_solution(assignment: Assignment, file: Path, options: GradingOptions) -> WorkReport:
    result = _grade(assignment, file, options)
    if isinstance(result, str):
        return WorkReport(file.name, (result,), "")
    problems = _grader_errors(result)
    problems += [
        f"{test.id}: {test.status.value}, {format_points(test.points)} of {format_points(test.max_points)} points: {test.rationale}"
        for test in result.tests
        if test.is_judged and test.status is not CriterionStatus.PASS
    ]
    problems += [
        f"{test.id}: not judged: {test.rationale}"
        for test in result.tests
        if test.status is CriterionStatus.SKIPPED
    ]
    again = _grade(assignment, file, options)
    if isinstance(again, GradingResult) and again.tests != result.tests:
        problems.append(
            "two runs give different results: does it use the wall clock, or unseeded randomness?"
        )
    return WorkReport(file.name, tuple(problems), _summary(result))


def _try_wrong(assignment: Assignment, file: Path, options: GradingOptions) -> WorkReport:
    name = f"{WRONG}/{file.name}"
    named = set((file.name if file.is_dir() else file.stem).partition("__")[0].split("+"))
    known = {each.id for each in assignment.tests}
    if not named <= known:
        return WorkReport(name, (f"its name must start with criteria: {', '.join(sorted(known))}",), "")
    result = _grade(assignment, file, options)
    if isinstance(result, str):
        return WorkReport(name, (result,), "")
    lost = {test.id for test in result.tests if test.status is not CriterionStatus.PASS}
    depending = {each.id for each in assignment.tests if _depends_on(assignment, each.id, named)}
    problems = _grader_errors(result)
    problems += [f"it should lose {each}, and does not" for each in sorted(named - lost)]
    problems += [f"it loses {each}, which it should not" for each in sorted(lost - named - depending)]
    return WorkReport(name, tuple(problems), _summary(result))


def _depends_on(assignment: Assignment, identity: str, named: set[str]) -> bool:
    after = {each.id: each.after for each in assignment.tests}
    at: str | None = identity
    while at is not None:
        if at in named:
            return True
        at = after[at]
    return False


def _grade(assignment: Assignment, file: Path, options: GradingOptions) -> GradingResult | str:
    if not file.exists():
        return "it is missing"

    def show_progress(text: str) -> None:
        options.show_progress(f"{file.name}: {text}")

    try:
        return grade(
            assignment,
            read_submission(file, assignment.submit),
            replace(options, show_progress=show_progress),
        )
    except SubmissionUnreadable as error:  # the reader may be the teacher's own
        return f"{error}\nThe reader's error: {error.error}"
    except SubmissionRefused as error:
        return str(error)


def _grader_errors(result: GradingResult) -> list[str]:
    return [
        f"{test.id}: the grader failed: {_error_line(test.log)}"
        for test in result.tests
        if test.status is CriterionStatus.GRADER_ERROR
    ]


def _error_line(log: str) -> str:
    """Returns the last line of a traceback with the innermost place in the code: ``IndexError: ..., in route/kind.py:77``."""
    error = (log.strip().splitlines() or ["?"])[-1]
    places = re.findall(r'^ *File "(.+)", line (\d+), in ', log, re.MULTILINE)
    if not places:
        return error
    file, line = places[-1]
    return f"{error}, in {'/'.join(Path(file).parts[-2:])}:{line}"


def _summary(result: GradingResult) -> str:
    points = (
        "no grade"
        if result.points is None
        else f"{format_points(result.points)} of {format_points(result.max_points)}"
    )
    lost = ", ".join(test.id for test in result.tests if test.status is not CriterionStatus.PASS)
    return f"{points} points" + (f"; lost: {lost}" if lost else "")
