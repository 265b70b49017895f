"""Functions compared with ours: what counts as the same, what is said of the first difference, and hostile files."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from grader.evidence.contract import EvidenceRecord
from grader.grading import GradingOptions, grade
from grader.kinds.function.kind import (
    CALL_LIMITS,
    MAX_CASES,
    CaseDifference,
    FunctionsTask,
    _as_json,
    cases_of,
    failed_record,
    format_value,
    is_close,
    load_reference,
)
from grader.new_assignment import example_of_kind, make_assignment
from grader.reading import read_assignment
from grader.submission import Submission, read_submission
from kit.host.failure import Failure, FailureKind
from kit.host.sandbox.limits import GRADER_LIMITS
from kit.host.sandbox.sandbox_config import Level
from kit.host.student_functions import StudentFunctions
from kit.host.wire import Json
from kit.results.grading_result import PUBLIC_CASES, CriterionStatus, GradingResult, GradingVerdict
from kit.school.lessons.reading import lessons_folder
from kit.world.problems import WorldError
from tests.cases import every_case
from tests.grader.conftest import LOCKS

ASSIGNMENT_TEXT = """
title: Two functions
kind: function
submit: scans.py
level: 0
functions:
  - {name: nearest, within: 0.001}
  - {name: halves}
checks:
  - {check: agrees, id: nearest, points: 2, with: {function: nearest}}
  - {check: agrees, id: halves, points: 1, with: {function: halves}, share: {none: 0.9, full: 1}}
budget: {reply: 1.0}
"""
REFERENCE = """
import math

def nearest(ranges):
    return min((each for each in ranges if not math.isnan(each)), default=2.0)

def nearest_cases(chance):
    yield {"ranges": [1.0, 0.5]}
    yield {"ranges": [float("nan"), 0.5, 2.0]}
    for _ in range(8):
        yield {"ranges": [chance.uniform(0.1, 2.0) for _ in range(91)]}

def halves(ranges, side):
    middle = len(ranges) // 2
    return [side, ranges[:middle] if side == "right" else ranges[middle:]]

def halves_cases(chance):
    for _ in range(5):
        yield {"ranges": [chance.random() for _ in range(4)], "side": chance.choice(["left", "right"])}
"""
NEAREST = "import math\ndef nearest(ranges):\n    return min((r for r in ranges if not math.isnan(r)), default=2.0)\n"
HALVES = "def halves(ranges, side):\n    return side, ranges[:2] if side == 'right' else ranges[2:]\n"
DESK = GradingOptions(Level.LIMITED)
GRADE = GradingOptions(Level.LIMITED, secret=True, examples=True)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "scans"
    made.mkdir()
    (made / "assignment.yaml").write_text(ASSIGNMENT_TEXT)
    (made / "reference.py").write_text(REFERENCE)
    (made / "secret.yaml").write_text("seed: 77\n")
    return made


def graded(folder: Path, source: str, options: GradingOptions = DESK) -> GradingResult:
    return grade(
        read_assignment(folder), Submission("ada", "scans.py", {"scans.py": source.encode()}), options
    )


@pytest.mark.parametrize("options", [DESK, GRADE], ids=["practice", "grade"])
def test_a_good_one_earns_everything(folder: Path, options: GradingOptions) -> None:
    result = graded(folder, NEAREST + HALVES, options)
    assert (result.points, result.verdict) == (3.0, GradingVerdict.PASS)


@pytest.mark.long
@LOCKS
def test_it_runs_locked_in(folder: Path) -> None:
    assert graded(folder, NEAREST + HALVES, GradingOptions(Level.FILTERED, secret=True)).points == 3.0


def test_numpy_is_taken_for_what_it_is(folder: Path) -> None:
    source = "import numpy as np\ndef nearest(ranges):\n    return np.nanmin(np.array(ranges))\n"
    source += "def halves(ranges, side):\n    a = np.array(ranges)\n    return [side, a[:2] if side == 'right' else a[2:]]\n"
    assert graded(folder, source).points == 3.0


def test_the_first_difference_is_told(folder: Path) -> None:
    result = graded(folder, "def nearest(ranges):\n    return ranges[0] if ranges[0] > 0 else 2.0\n" + HALVES)
    test = result.tests[0]
    assert test.status is CriterionStatus.FAIL
    assert "nearest(ranges=[1, 0.5]) should be 0.5, and is 1." in test.rationale
    assert result.tests[1].status is CriterionStatus.PASS


@pytest.mark.long
def test_of_secret_cases_nothing_is_told(folder: Path) -> None:
    (folder / "assignment.yaml").write_text(
        ASSIGNMENT_TEXT.replace("share: {none: 0.9, full: 1}", "seeds: secret")
    )
    source = NEAREST + "def halves(ranges, side):\n    return [side, [0.0, 0.0]]\n"
    test = graded(folder, source, GRADE).tests[1]
    assert test.status is CriterionStatus.FAIL
    secret_cases = cases_of(load_reference(folder / "reference.py"), "halves", 77)
    for number in (each for case in secret_cases for each in case["ranges"]):
        assert format_value(number) not in test.rationale
    assert "should be" in test.rationale, "a public case that differs is shown instead"
    assert graded(folder, source, DESK).tests[1].status is CriterionStatus.SKIPPED


@pytest.mark.long_cases("while True: pass-timeout-scans.py:2")
@pytest.mark.parametrize(
    ("body", "status", "word"),
    [
        ("return None", CriterionStatus.FAIL, "returns nothing"),
        ("print(3)", CriterionStatus.FAIL, "return gives it to the caller"),
        ("return [0.5]", CriterionStatus.FAIL, "should be 0.5"),
        ("return str(min(ranges))", CriterionStatus.FAIL, "'0.5'"),
        ("return min(ranges) == 0.5", CriterionStatus.FAIL, "True"),
        ("return 1 / 0", CriterionStatus.STUDENT_ERROR, "with ranges=[1, 0.5]"),
        ("return float('nan')", CriterionStatus.STUDENT_ERROR, "finite"),
        ("return object()", CriterionStatus.STUDENT_ERROR, "not <object object>"),
        ("return [[[[1]]]]", CriterionStatus.STUDENT_ERROR, "must return"),
        ("return [1.0, [float('nan')]]", CriterionStatus.STUDENT_ERROR, "not a list with nan in it"),
        ("while True: pass", CriterionStatus.TIMEOUT, "scans.py:2"),
        ("while ranges: pass", CriterionStatus.TIMEOUT, "with ranges=[1, 0.5]"),
        ("import sys; sys.exit()", CriterionStatus.STUDENT_ERROR, "exited"),
        ("exit()", CriterionStatus.STUDENT_ERROR, "exited"),
        ("import os; os._exit(0)", CriterionStatus.STUDENT_ERROR, ""),
        ("return 'x' * 10**7", CriterionStatus.PROTOCOL_ERROR, ""),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_mistake_in_one_costs_no_other(folder: Path, body: str, status: CriterionStatus, word: str) -> None:
    result = graded(folder, f"def nearest(ranges):\n    {body}\n" + HALVES)
    assert result.tests[0].status is status
    assert word in result.tests[0].rationale
    assert result.tests[1].status is CriterionStatus.PASS


@pytest.mark.parametrize(
    "source", ["def nearest(", "def neerest(ranges):\n    return 1.0\n", ""], ids=["syntax", "name", "empty"]
)
def test_what_cannot_be_called_is_the_students_error(folder: Path, source: str) -> None:
    test = graded(folder, source).tests[0]
    assert test.status is CriterionStatus.STUDENT_ERROR
    assert "scans.py" in test.rationale
    assert "/tmp" not in test.rationale


def test_a_file_cannot_reach_the_reference_through_the_grader(folder: Path) -> None:
    source = "import sys\ndef nearest(ranges):\n    ours = [n for n in sys.modules if 'reference' in n or 'grader' in n]\n"
    result = graded(folder, source + "    return len(ours) + 100.0\n" + HALVES)
    assert "and is 100." in result.tests[0].rationale


def test_of_cases_without_end_the_first_are_called(folder: Path) -> None:
    text = REFERENCE.replace("for _ in range(5):", "while True:")
    (folder / "reference.py").write_text(text)
    result = graded(folder, NEAREST + HALVES)
    assert result.points == result.max_points
    assert len(cases_of(load_reference(folder / "reference.py"), "halves", 1)) == MAX_CASES


@pytest.mark.parametrize(
    ("file", "old", "new", "message"),
    [
        ("reference.py", "def halves(", "def halve(", r"no function halves\(\)"),
        ("reference.py", "def halves_cases(", "def cases(", r"no function halves_cases\(\)"),
        ("reference.py", "import math", "import (", "cannot be read"),
        ("assignment.yaml", "name: halves", "name: nearest", "already required"),
        ("assignment.yaml", "name: halves", "name: two halves", "function's name"),
    ],
)
def test_a_teachers_mistake_is_told_when_read(
    folder: Path, file: str, old: str, new: str, message: str
) -> None:
    path = folder / file
    path.write_text(path.read_text().replace(old, new, 1))
    with pytest.raises(WorldError, match=message):
        read_assignment(folder)


@every_case(
    ("expected", "actual", "same"),
    [
        (1.0, 1.0005, True),
        (1.0, 1.01, False),
        (1000.0, 1000.5, True),
        ([1.0, [2.0]], [1.0, [2.0]], True),
        ([1.0], [1.0, 1.0], False),
        (True, True, True),
        (True, 1.0, False),
        ("left", "Left", False),
        (None, None, True),
        (0.0, None, False),
    ],
)
def test_what_is_the_same(expected: object, actual: object, same: bool) -> None:
    assert is_close(expected, actual, 0.001) is same


def test_long_lists_are_shortened() -> None:
    assert format_value([0.5] * 91) == "[0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5, ... 91 in all]"
    assert format_value([-0.0, -0.25]) == "[0, -0.25]"


def test_a_number_that_is_none_reaches_the_student_wherever_it_stands(tmp_path: Path) -> None:
    """JSON knows neither nan nor infinity."""
    file = tmp_path / "scans.py"
    file.write_text("def told(rows, best, named):\n    return [repr(rows), repr(best), repr(named)]\n")
    given = {
        "rows": [[math.nan, 1.5], [2, "a"], []],
        "best": -math.inf,
        "named": {"left": [math.inf], "right": None},
    }
    with StudentFunctions(file) as functions:
        assert functions.call_json("told", given) == [repr(value) for value in given.values()]


def functions_of_lessons() -> list[Path]:
    sheets = sorted(lessons_folder().glob("*/*/assignment.yaml"))
    return [each.parent for each in sheets if "kind: function" in each.read_text("utf-8")]


def answer_without_idea(
    module: ModuleType, name: str, asked: Sequence[Mapping[str, Json]]
) -> Iterator[Callable[..., Json]]:
    """Yields functions that compute nothing: one of the most frequent answers, an argument as it came, and a table of the
    answers to the public cases."""
    known = {json.dumps(case, sort_keys=True): right_answer(module, name, case) for case in asked}
    for answer, _ in Counter(map(json.dumps, known.values())).most_common(3):
        yield partial(lambda text, **_: json.loads(text), answer)
    for argument in asked[0]:
        yield partial(lambda key, **case: case.get(key), argument)
    yield lambda **case: known.get(json.dumps(case, sort_keys=True))


def right_answer(module: ModuleType, name: str, case: Mapping[str, Json]) -> Json:
    return _as_json(getattr(module, name)(**json.loads(json.dumps(case))))


@every_case("folder", functions_of_lessons())
def test_no_function_earns_points_that_computes_nothing(folder: Path) -> None:
    """What earns nothing lies above what guessing agrees with: share: {none: ...}."""
    assignment = read_assignment(folder)
    task: FunctionsTask = assignment.task
    module = load_reference(task.reference)
    assert task.secret_seed is not None
    for criterion in assignment.criteria:
        spec = next(each for each in task.functions if each.name == criterion.params.function)
        asked, hidden = (cases_of(module, spec.name, seed) for seed in (task.seed, task.secret_seed))
        if all(case in asked for case in hidden):
            continue  # there are no other cases
        for answer in answer_without_idea(module, spec.name, asked):
            agreed = min(
                sum(
                    is_close(right_answer(module, spec.name, case), _as_json(answer(**case)), spec.within)
                    for case in cases
                )
                / len(cases)
                for cases in (asked, hidden)
            )
            assert agreed <= criterion.anchors.none, (criterion.id, answer)


@LOCKS
def test_the_folder_may_be_named_from_where_one_stands(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    make_assignment(example_of_kind("function"), tmp_path / "new")
    monkeypatch.chdir(tmp_path)
    work = read_submission(Path("new/solution.py"), "heard.py")
    options = GradingOptions(Level.FILTERED)
    assert grade(read_assignment(Path("new")), work, options).points == 6


@pytest.mark.parametrize(
    ("source", "processes"),
    [
        pytest.param(NEAREST + HALVES, 2, id="public and secret"),
        pytest.param(
            NEAREST.replace("return", "return 1 / 0 or") + HALVES, 4, id="a new one after a failure"
        ),
        pytest.param("def nearest(:\n", 1, id="a file that cannot be loaded"),
    ],
)
def test_public_cases_share_a_process_and_secret_ones_another(
    folder: Path, monkeypatch: pytest.MonkeyPatch, source: str, processes: int
) -> None:
    (folder / "secret.yaml").write_text("seed: 4611686018427387903\n")
    starts = 0
    opened: list[Any] = []

    class Counted(StudentFunctions):
        def __init__(self, *arguments: object, **settings: object) -> None:
            nonlocal starts
            starts += 1
            assert all(each.is_closed for each in opened), "two run at once"
            super().__init__(*arguments, **settings)  # type: ignore[arg-type]  # as they came
            opened.append(self)
            self.is_closed = False

        def close(self) -> None:
            self.is_closed = True
            super().close()

    monkeypatch.setattr("grader.kinds.function.kind.StudentFunctions", Counted)
    graded(folder, source, GradingOptions(Level.LIMITED, secret=True))
    assert starts == processes
    assert all(each.is_closed for each in opened)


@pytest.mark.parametrize("body", ["while True: pass", "raise ValueError('no')"])
@pytest.mark.parametrize("is_own_check", [True, False])
def test_in_a_students_own_check_a_function_that_failed_is_not_called_with_secret_cases(
    folder: Path, monkeypatch: pytest.MonkeyPatch, body: str, is_own_check: bool
) -> None:
    calls: list[str] = []

    class Counted(StudentFunctions):
        def call_json(self, name: str, record: Mapping[str, Json]) -> Json:
            calls.append(name)
            return super().call_json(name, record)

    monkeypatch.setattr("grader.kinds.function.kind.StudentFunctions", Counted)
    told: list[str] = []
    options = GradingOptions(Level.LIMITED, secret=True, examples=is_own_check, show_progress=told.append)
    result = graded(folder, f"def nearest(ranges):\n    {body}\n{HALVES}", options)
    assert calls.count("nearest") == (1 if is_own_check or "while" in body else 2)
    assert calls.count("halves") >= 2
    assert "nearest" in result.tests[0].rationale
    assert "secret" not in result.tests[0].rationale
    if is_own_check:
        assert result.tests[1].status is CriterionStatus.PASS
        verdict = next(each for each in told if each.startswith(PUBLIC_CASES))
        assert told.index(verdict) < told.index("halves() on secret cases")
        assert "1 of 2" in verdict


def test_functions_that_take_too_long_cost_no_other(folder: Path) -> None:
    endless = "".join(f"def {name}(ranges):\n    while True: pass\n" for name in ("nearest", "third"))
    sheet = folder / "assignment.yaml"
    text = (
        sheet.read_text()
        .replace("  - {name: halves}\n", "  - {name: halves}\n  - {name: third}\n")
        .replace("budget:", "  - {check: agrees, id: third, points: 1, with: {function: third}}\nbudget:")
    )
    sheet.write_text(text)
    reference = folder / "reference.py"
    reference.write_text(
        reference.read_text()
        + "\n\ndef third(ranges):\n    return nearest(ranges)\n\ndef third_cases(chance):\n    yield from nearest_cases(chance)\n"
    )
    result = graded(folder, endless + HALVES, GradingOptions(Level.LIMITED, secret=True, examples=True))
    statuses = {each.id: each.status for each in result.tests}
    assert statuses["halves"] is CriterionStatus.PASS, statuses
    assert CriterionStatus.PASS not in (statuses["nearest"], statuses["third"])


def test_a_mistake_that_only_a_secret_case_shows_is_shown_in_ones_own_check(folder: Path) -> None:
    case = cases_of(load_reference(folder / "reference.py"), "nearest", 77)[-1]
    source = f"{NEAREST.replace('nearest', 'right')}def nearest(ranges):\n    return 7.0 if ranges == {case['ranges']!r} else right(ranges)\n{HALVES}"
    own = graded(folder, source, GradingOptions(Level.LIMITED, secret=True, examples=True)).tests[0]
    assert own.status is not CriterionStatus.PASS
    assert "and is 7" in own.rationale
    assert "the secret one" in own.rationale
    others = graded(folder, source, GradingOptions(Level.LIMITED, secret=True)).tests[0]
    assert "and is 7" not in others.rationale
    assert "and is 7" in others.teacher_note


def test_a_call_has_less_time_than_an_episodes_reply_unless_the_sheet_says_otherwise(folder: Path) -> None:
    sheet = folder / "assignment.yaml"
    assert read_assignment(folder).limits.reply_s == 1.0
    sheet.write_text(sheet.read_text().replace("budget: {reply: 1.0}", "budget: {total: 60}"))
    assert read_assignment(folder).limits == replace(CALL_LIMITS, total_s=60.0)
    assert CALL_LIMITS.reply_s < GRADER_LIMITS.reply_s


def test_the_call_is_a_sentence_of_its_own_after_what_failed() -> None:
    for message, start in (
        ("division by zero", "division by zero. "),
        ("Did you mean x?", "Did you mean x? "),
    ):
        failed = failed_record(EvidenceRecord(), Failure(FailureKind.EXCEPTION, message), {"a": 1})
        assert failed.failure is not None
        assert failed.failure.message.startswith(f"{start}It was called")


@pytest.mark.parametrize(
    ("expected", "actual", "asks"),
    [
        ([1.0, 3.6], [1.0], True),
        ([1.0, 3.6], [2.0], False),
        ([1.0, 3.6, 2.0], [1.0, 3.6], False),
        ([1.0], [1.0, 2.0], False),
    ],
)
def test_a_list_with_its_first_entry_alone_is_asked_about_its_loop(
    expected: Json, actual: Json, asks: bool
) -> None:
    assert ("inside the loop" in str(CaseDifference({}, expected, actual))) is asks
