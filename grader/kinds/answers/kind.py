"""Answers to questions, in a YAML file: numbers, words, lists of words. No program runs.

``questions`` in the assignment names each question and the kind of its answer; ``answers``, which may be in
``secret.yaml`` instead, holds the right answers::

    questions:
      topic: {ask: Which topic carries the commands?, choices: [cmd_vel, odom, scan]}
      scans: {ask: How many scans a second?}
    answers:
      topic: {right: [cmd_vel], feedback: {odom: That one comes from the robot.}}
      scans: {right: [10], within: 0.5}
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from grader.assignment import Assignment
from grader.check import check
from grader.evidence.contract import EvidenceCollector, EvidenceOptions, EvidenceRecord, FixedEvidence
from grader.kinds.answers.sheet_keys import SHEET_KEYS
from grader.kinds.contract import AssignmentFiles, KindSettings, SubmissionKind, read_submitted_yaml
from kit.host.failure import Failure
from kit.plain_text import counted, join_names, quoted, suggestion
from kit.world.yaml_section import Section

MAX_ANSWER: Final = 200
"""Characters of one answer."""
MIN_DECIMALS: Final = 2
"""Decimals from which on a number may be another one, rounded."""


@dataclass(frozen=True, slots=True)
class AnswerKey:
    """The right answer to one question."""

    right: tuple[str, ...]
    """Any of these; for a list, all of these in any order."""
    within: float
    """Absolute tolerance for a number."""
    is_list: bool
    feedback: Mapping[str, str]
    """Feedback by wrong answer."""

    def feedback_on(self, given: Sequence[str]) -> str:
        """Returns the feedback on a wrong answer, or, for a number, on the nearest wrong one that rounds to it."""
        exact = self.feedback.get(_normalize_word(", ".join(given)), "")
        if exact or len(given) != 1:
            return exact
        rounded = [wrong for wrong in self.feedback if _rounds_to(wrong, given[0])]
        nearest = min(rounded, key=lambda wrong: abs(float(wrong) - float(given[0])), default="")
        return self.feedback.get(nearest, "")


@dataclass(frozen=True, slots=True)
class AnswerQuestion:
    """One question of the assignment."""

    name: str
    ask: str
    choices: tuple[str, ...]
    """The allowed answers; empty for any."""
    is_list: bool


@dataclass(frozen=True, slots=True)
class AnswersTask:
    """The questions and their right answers."""

    questions: tuple[AnswerQuestion, ...]
    keys: Mapping[str, AnswerKey]
    is_secret: bool
    """Whether the right answers are in ``secret.yaml``."""


@dataclass(frozen=True, slots=True)
class SubmittedAnswers:
    """The submitted answers, as they were written."""

    given: Mapping[str, tuple[str, ...]]
    task: AnswersTask

    def is_right(self, name: str) -> bool:
        given, key = self.given.get(name, ()), self.task.keys[name]
        if key.is_list:
            return sorted(map(_normalize_word, given)) == sorted(map(_normalize_word, key.right))
        return len(given) == 1 and any(_is_same(given[0], right, key.within) for right in key.right)

    def explain(self, names: Sequence[str]) -> str:
        """Returns feedback: of several questions how many have a right answer, and on the first that has none."""
        wrong = self.first_wrong(names)
        if not wrong or len(names) == 1:
            return wrong
        return f"{sum(map(self.is_right, names))} of {counted(len(names), 'answer')} are right. {wrong}"

    def first_wrong(self, names: Sequence[str]) -> str:
        """Returns feedback on the first question without a right answer; empty if there is none."""
        for question in self.task.questions:
            if question.name not in names or self.is_right(question.name):
                continue
            given = self.given.get(question.name, ())
            if not given:
                return f"{quoted(question.name)} is not answered yet: {question.ask}"
            hint = self.task.keys[question.name].feedback_on(given) or self._form_mistake(question, given)
            return f"{quoted(question.name)}: {', '.join(given)} is not right. {hint}".strip()
        return ""

    def _form_mistake(self, question: AnswerQuestion, given: Sequence[str]) -> str:
        """Says that an answer is none of the choices, no number where one is asked for, or what is wrong with a list."""
        choices = {_normalize_word(choice) for choice in question.choices}
        for each in given:
            if choices and _normalize_word(each) not in choices:
                return f"There is no choice {quoted(each)}: {suggestion(each, question.choices)}"
        right = self.task.keys[question.name].right
        if question.is_list:
            return _list_mistake(given, right)
        if not all(map(_is_number, right)):
            return ""
        for each in given:
            if not _is_number(each):
                return _number_mistake(each)
            if any(_rounds_to(value, each) for value in right):
                return "It is rounded too far: write more digits."
        return ""


@dataclass(frozen=True, slots=True)
class AnswerKeysParams:
    """The questions that a criterion is about; none given means all."""

    keys: tuple[str, ...] = ()


@check(none=0, full=1, unit="%", params=AnswerKeysParams, is_explained=True)
def answers(evidence: EvidenceRecord, params: AnswerKeysParams) -> float:
    """Of these questions {actual} are answered rightly."""
    submitted: SubmittedAnswers = evidence.content
    names = params.keys or tuple(submitted.task.keys)
    if not set(names) <= set(submitted.task.keys):
        raise LookupError(f"no question {sorted(set(names) - set(submitted.task.keys))}")
    return sum(map(submitted.is_right, names)) / len(names)


def read_settings(files: AssignmentFiles) -> KindSettings:
    """Reads the questions and the right answers."""
    questions = tuple(_read_questions(files.public.section("questions")))
    in_secret = not files.public.has("answers") and files.secret is not None
    holder = files.secret if in_secret and files.secret is not None else files.public
    section = holder.section("answers")
    keys = {each.name: _read_key(section, each) for each in questions}
    section.finish()
    return KindSettings(task=AnswersTask(questions, keys, in_secret))


def _read_questions(section: Section) -> Iterator[AnswerQuestion]:
    for name in tuple(section.keys()):
        each = section.section(name)
        question = AnswerQuestion(name, each.text("ask"), each.texts("choices", ()), each.flag("list", False))
        each.finish()
        yield question
    section.finish()


def _read_key(section: Section, question: AnswerQuestion) -> AnswerKey:
    each = section.section(question.name)
    right = each.texts("right")
    for value in right:
        if question.choices and value not in question.choices:
            each.error(f"{quoted(value)} is none of the choices", "right")
    given = each.section("feedback", None)
    feedback = (
        {} if given is None else {_normalize_word(name): given.text(name) for name in tuple(given.keys())}
    )
    key = AnswerKey(right, each.number("within", 0.0, minimum=0), question.is_list, feedback)
    each.finish()
    return key


def collect(
    assignment: Assignment, file: Path, options: EvidenceOptions
) -> AbstractContextManager[EvidenceCollector]:
    """Reads the submitted file; collects nothing where the right answers are secret and not available."""
    task: AnswersTask = assignment.task
    withheld = task.is_secret and not options.secret
    return nullcontext(FixedEvidence([] if withheld else [_read_answers(task, file)], options.level))


def _read_answers(task: AnswersTask, file: Path) -> EvidenceRecord:
    found = read_submitted_yaml(file, lambda section: SubmittedAnswers(_given(section, task.questions), task))
    if isinstance(found, Failure):
        return EvidenceRecord(failure=found)
    return EvidenceRecord(
        found, explain_with=lambda check, params: found.explain(params.keys or tuple(task.keys))
    )


def _given(section: Section, questions: Sequence[AnswerQuestion]) -> Mapping[str, tuple[str, ...]]:
    """Returns the answers to each question; questions without an answer are left out or empty."""
    known = {each.name: each for each in questions}
    given = {}
    for name, value in section.remaining_values().items():
        if name not in known:
            section.error(f"no question {quoted(name)}: {suggestion(name, known)}", name)
            continue
        values = value if isinstance(value, tuple) else () if value is None else (value,)
        words = [_as_written(each) for each in values]
        given[name] = tuple(_as_choice(each, known[name].choices) for each in words if each)
        if any(len(each) > MAX_ANSWER for each in words):
            section.error(f"the answer is longer than {MAX_ANSWER} characters", name)
    return given


def _as_written(value: object) -> str:
    """Returns a scalar as it is written in YAML."""
    return str(value).lower() if isinstance(value, bool) else "" if value is None else str(value).strip()


def _as_choice(word: str, choices: Sequence[str]) -> str:
    """Returns the choice that a word is but for blanks, case and a slash in front: "ROS 2" for "ros2". Otherwise the word."""
    return next((each for each in choices if _bare(each) == _bare(word)), word)


def _bare(word: str) -> str:
    return "".join(word.split()).casefold().removeprefix("/")


def _is_same(given: str, right: str, within: float) -> bool:
    """True if two answers are equal: numbers within the tolerance, words without case and repeated blanks."""
    try:
        return math.isclose(float(given), float(right), rel_tol=1e-9, abs_tol=within)
    except ValueError:
        return _normalize_word(given) == _normalize_word(right)


def _list_mistake(given: Sequence[str], right: Sequence[str]) -> str:
    """Says what does not belong in a list, and how many entries are missing."""
    known = set(map(_normalize_word, right))
    odd = [each for each in given if _normalize_word(each) not in known]
    missing = len(known - set(map(_normalize_word, given)))
    parts = [f"{join_names(odd)} should not be there"] if odd else []
    parts += [f"{missing} {'is' if missing == 1 else 'are'} missing"] if missing else []
    return f"{' and '.join(parts)}." if parts else "One stands there twice."


def _is_number(word: str) -> bool:
    try:
        return math.isfinite(float(word))
    except ValueError:
        return False


def _rounds_to(value: str, given: str) -> bool:
    """True if a number, rounded to the decimals with which ``given`` is written, is ``given``. Fewer than two decimals
    are no rounding that could be recognized: 1 is not 0.95."""
    decimals = len(given.partition(".")[2])
    if decimals < MIN_DECIMALS or not (_is_number(value) and _is_number(given)):
        return False
    return math.isclose(float(value), float(given), rel_tol=0.0, abs_tol=0.500001 * 10.0**-decimals)


def _number_mistake(given: str) -> str:
    """Says how to write what was given for a number."""
    with_point = given.replace(",", ".")
    if _is_number(with_point):
        return f"Write a point in place of the comma: {with_point}"
    if any(sign in given for sign in "/*^="):
        return "Work it out, and write the number that it comes to: 0.25, say."
    return "A number is asked for: write it in digits, without a unit."


def _normalize_word(word: str) -> str:
    return " ".join(word.split()).casefold()


KIND: Final = SubmissionKind(
    (".yaml", ".yml"),
    {answers.name: answers},
    read_settings,
    collect,
    sheet_keys=SHEET_KEYS,
    exercise="20-q-learning/by_hand",
)
