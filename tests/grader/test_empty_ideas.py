"""Works without an idea earn little in any exercise: functions next to nothing, the same answer to all questions at most half."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from itertools import combinations
from types import MappingProxyType
from typing import Any, Final

import numpy as np
import pytest
import yaml

from grader.grading import GradingOptions, grade
from grader.kinds.answers.kind import AnswersTask
from grader.kinds.function.kind import answer_cases, is_close
from grader.reading import read_assignment
from grader.submission import Submission
from kit.host.sandbox.sandbox_config import Level
from kit.school.lessons.reading import lesson_names, lessons_folder
from tests.kit_content import kit_lesson

IDEAS: Final = MappingProxyType(
    {
        "zero": "0.0", "one": "1", "half": "0.5", "true": "True", "false": "False", "none": "None", "empty": "[]",
        "the first": "given[0]", "the last": "given[-1]", "the most": "max(given)", "the least": "min(given)",
        "the sum": "sum(given)", "the most of the first": "max(given[0])", "the least of the first": "min(given[0])",
        "the sum of the first": "sum(given[0])", "the length of the first": "len(given[0])",
    }
)  # fmt: skip
"""By name: what such a function returns."""
FUNCTION: Final = """
def {name}(*given, **named):
    given = [*given, *named.values()]
    try:
        return {returned}
    except Exception:
        return 0
"""
MOST: Final = 0.1
"""The share of a criterion's points that may be hit by chance."""


MOST_OF_ANSWERS: Final = 0.5
"""The share of an exercise's points that one answer to all of its questions may earn."""


MOST_OF_PLANS: Final = 0.17
"""Likewise, of plans: everything that must happen happens where all is in one layer, which is the first of several criteria."""


def exercises_of(kind: str) -> Iterator[tuple[str, str]]:
    for name in lesson_names():
        for exercise in kit_lesson(name).exercises:
            text = (lessons_folder() / name / exercise.name / "assignment.yaml").read_text()
            if f"\nkind: {kind}\n" in text:
                yield name, exercise.name


@pytest.mark.daily(7)
@pytest.mark.long
@pytest.mark.parametrize(("name", "exercise"), list(exercises_of("function")))
def test_a_function_without_an_idea_earns_nothing(name: str, exercise: str) -> None:
    folder = lessons_folder() / name / exercise
    assignment = read_assignment(folder)
    functions = yaml.safe_load((folder / "assignment.yaml").read_text())["functions"]
    for idea, returned in IDEAS.items():
        source = "".join(FUNCTION.format(name=each["name"], returned=returned) for each in functions)
        work = Submission(idea, assignment.submit, {assignment.submit: source.encode()})
        result = grade(assignment, work, GradingOptions(Level.LIMITED))
        earned = {
            test.id: test.points for test in result.tests if (test.points or 0) > MOST * test.max_points
        }
        assert not earned, idea


def test_who_knows_the_public_cases_by_heart_earns_nothing() -> None:
    """Nor who gives the commonest answer to all others."""
    table = """
KNOWN = {known}
def beside(episodes): return KNOWN["beside"].get(repr(episodes))
def claim(one, other): return KNOWN["claim"].get(repr((one, other)))
def differs(one, other): return KNOWN["differs"].get(repr((one, other)))
def row(shares): return KNOWN["row"].get(repr(shares))
"""
    assignment = read_assignment(lessons_folder() / "28-a-papers-table" / "honest")
    wanted = [(each.name, assignment.task.seed) for each in assignment.task.functions]
    known = {
        name: {
            repr(tuple(case.values()) if len(case) > 1 else next(iter(case.values()))): answer
            for case, answer in cases
        }
        for (name, _), cases in zip(wanted, answer_cases(assignment.task.reference, wanted), strict=True)
    }
    work = Submission("known", assignment.submit, {assignment.submit: table.format(known=known).encode()})
    for secret, points in ((False, assignment.max_points), (True, 0.0)):
        assert grade(assignment, work, GradingOptions(Level.LIMITED, secret=secret)).points == points


SMALL: Final = frozenset({"mirrored_action"})
"""A function of three actions: its table is the idea."""


def numbers_of(value: Any, path: str = "") -> Iterator[tuple[str, float]]:
    """All numbers and letters of a case, by where they stand, and the lengths of its lists."""
    if isinstance(value, Mapping):
        for key, part in value.items():
            yield from numbers_of(part, f"{path}.{key}")
    elif isinstance(value, list):
        yield f"{path} length", len(value)
        for number, part in enumerate(value):
            yield from numbers_of(part, f"{path}.{number}")
    elif isinstance(value, str):
        yield from ((f"{path}.{number}", float(ord(letter))) for number, letter in enumerate(value))
    elif value is not None:
        yield path, float(np.nan_to_num(value, nan=-99, posinf=99, neginf=-99))


def signs_of(case: Mapping[str, Any]) -> Iterator[tuple[str, float]]:
    """Of a case with a drawing: the drawing's size, how many of each sign it has, and all other numbers."""
    yield from ((path, number) for path, number in numbers_of(case) if not path.startswith(".grid."))
    yield from Counter(str(case.get("grid", ""))).items()


def nearest(
    numbers: Callable[[Mapping[str, Any]], Iterator[tuple[str, float]]],
    known: list[Mapping[str, Any]],
    cases: list[Mapping[str, Any]],
) -> list[int]:
    """For each case the number of the known one that differs least from it, counted in how much known ones differ there."""
    rows = [dict(numbers(each)) for each in [*known, *cases]]
    paths = sorted({path for row in rows for path in row})
    table = np.array([[row.get(path, 1e9) for path in paths] for row in rows])
    one, other = table[: len(known)], table[len(known) :]
    scale = np.array([np.std(column[column < 1e9]) if (column < 1e9).any() else 0 for column in one.T])
    apart = np.abs(other[:, None] - one[None]) / np.where(scale > 0, scale, 1.0)
    found: list[int] = np.minimum(apart, 3.0).sum(axis=2).argmin(axis=1).tolist()
    return found


@pytest.mark.parametrize(("name", "exercise"), list(exercises_of("function")))
def test_who_knows_the_public_cases_alone_earns_nothing_with_others(name: str, exercise: str) -> None:
    """Cases that come again with another seed, and to the others the commonest answer, or that to the case which is most like them:
    at most a tenth of the points."""
    assignment = read_assignment(lessons_folder() / name / exercise)
    for criterion in assignment.criteria:
        spec = next(
            each for each in assignment.task.functions if criterion.params.function in ("", each.name)
        )
        if spec.name in SMALL:
            continue
        seeds = [(spec.name, seed) for seed in (assignment.task.seed, *range(11, 16))]
        first, *others = answer_cases(assignment.task.reference, seeds)
        known = {repr(case): answer for case, answer in first}
        counts = Counter(map(repr, (answer for _, answer in first)))
        commonest = max((answer for _, answer in first), key=lambda answer: counts[repr(answer)])
        asked = [each for cases in others for each in cases]
        guesses = {"commonest": [known.get(repr(case), commonest) for case, _ in asked]}
        for numbers in (numbers_of, signs_of):
            near = nearest(numbers, [case for case, _ in first], [case for case, _ in asked])
            guesses[numbers.__name__] = [first[each][1] for each in near]
        for idea, guessed in guesses.items():
            right = [
                is_close(answer, each, spec.within) for (_, answer), each in zip(asked, guessed, strict=True)
            ]
            share = criterion.anchors.share(sum(right) / len(right))
            assert share <= MOST, f"{spec.name}, {idea}: {share:.2f} of the points"


@pytest.mark.daily(7)
@pytest.mark.long
@pytest.mark.parametrize(("name", "exercise"), list(exercises_of("answers")))
def test_one_answer_to_all_questions_earns_little(name: str, exercise: str) -> None:
    assignment = read_assignment(lessons_folder() / name / exercise)
    task: AnswersTask = assignment.task
    words = {word for question in task.questions for word in question.choices} | {"0", "1", "2", "10"}
    earned = {}
    for word in sorted(words):
        given: dict[str, list[str] | str] = {}
        for question in task.questions:
            said = word if word in question.choices or not question.choices else question.choices[0]
            given[question.name] = [said] if question.is_list else said
        work = Submission(word, assignment.submit, {assignment.submit: yaml.safe_dump(given).encode()})
        earned[word] = grade(assignment, work, GradingOptions(Level.LIMITED, secret=True)).points or 0.0
    assert max(earned.values()) <= MOST_OF_ANSWERS * assignment.max_points, earned
    if exercise == "what-happens":
        assert max(earned.values()) > 0, "answers are read"


@pytest.mark.parametrize(("name", "exercise"), list(exercises_of("plan")))
def test_a_plan_without_an_idea_earns_little(name: str, exercise: str) -> None:
    """Everything in one layer, nothing in any, and each pair of things in a layer of its own."""
    assignment = read_assignment(lessons_folder() / name / exercise)
    things, lasers = list(assignment.task.names), list(assignment.task.laser)
    pairs = {f"L{number}": list(pair) for number, pair in enumerate(combinations(things, 2))}
    plans = (
        {"layers": {"A": things}, "lasers": {laser: ["A"] for laser in lasers}},
        {"layers": {"A": []}},
        {"layers": pairs, "lasers": {laser: list(pairs) for laser in lasers}},
    )
    for plan in plans:
        work = Submission("plan", assignment.submit, {assignment.submit: yaml.safe_dump(plan).encode()})
        earned = grade(assignment, work, GradingOptions(Level.LIMITED, secret=True)).points
        assert earned is not None
        assert earned <= MOST_OF_PLANS * assignment.max_points
