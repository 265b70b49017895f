"""Answers to questions, in a YAML file: numbers, words, lists of words. No program runs.

The sheet's ``questions`` names each key and what kind of answer it wants; its ``answers``, which may stand in
``secret.yaml`` instead, hold what is right::

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
from typing import TYPE_CHECKING, Final

from grader.assignment import Assignment
from grader.checks.contract import check
from grader.kinds.contract import Conditions, Look, Looks, Sheet, Sort, Task, from_yaml
from kit.host.failure import Failure
from kit.world.problems import quoted, suggestion
from kit.world.yaml_section import Section

if TYPE_CHECKING:
    from grader.grading import Gatherer

LONGEST: Final = 200
"""Characters of one answer."""


@dataclass(frozen=True, slots=True)
class Key:
    """What is right for one question."""

    right: tuple[str, ...]
    """Any of these; for a list, all of these in any order."""
    within: float
    """How far a number may be off."""
    is_list: bool
    feedback: Mapping[str, str]
    """What to say to a certain wrong answer."""


@dataclass(frozen=True, slots=True)
class Question:
    """One question of the sheet."""

    name: str
    ask: str
    choices: tuple[str, ...]
    """What may be answered; empty: anything."""
    is_list: bool


@dataclass(frozen=True, slots=True)
class Questions:
    """The kind's task."""

    questions: tuple[Question, ...]
    keys: Mapping[str, Key]
    is_secret: bool
    """Whether the keys stand in ``secret.yaml``."""


@dataclass(frozen=True, slots=True)
class Answered:
    """What was found: each answer as it was written, each with whether it is right."""

    given: Mapping[str, tuple[str, ...]]
    task: Questions

    def is_right(self, name: str) -> bool:
        given, key = self.given.get(name, ()), self.task.keys[name]
        if key.is_list:
            return sorted(map(_plain, given)) == sorted(map(_plain, key.right))
        return len(given) == 1 and any(_same(given[0], right, key.within) for right in key.right)

    def first_wrong(self, names: Sequence[str]) -> str:
        """What to say of the first question that is not answered rightly."""
        for question in self.task.questions:
            if question.name not in names or self.is_right(question.name):
                continue
            given = self.given.get(question.name, ())
            if not given:
                return f"{quoted(question.name)} is not answered yet: {question.ask}"
            said = self.task.keys[question.name].feedback.get(_plain(", ".join(given)), "")
            return f"{quoted(question.name)}: {', '.join(given)} is not right. {said}".strip()
        return ""


@dataclass(frozen=True, slots=True)
class Which:
    """Which questions a criterion is about: by default all."""

    keys: tuple[str, ...] = ()


@check(none=0, full=1, unit="%", params=Which)
def answers(look: Look, params: Which) -> float:
    """Of these questions {actual} are answered rightly."""
    seen: Answered = look.found
    names = params.keys or tuple(seen.task.keys)
    if not set(names) <= set(seen.task.keys):
        raise LookupError(f"no question {sorted(set(names) - set(seen.task.keys))}")
    return sum(map(seen.is_right, names)) / len(names)


def read(sheet: Sheet) -> Task:
    """The questions, and what is right."""
    questions = tuple(_questions(sheet.public.section("questions")))
    in_secret = not sheet.public.has("answers") and sheet.secret is not None
    holder = sheet.secret if in_secret and sheet.secret is not None else sheet.public
    section = holder.section("answers")
    keys = {each.name: _key(section, each) for each in questions}
    section.finish()
    return Task(content=Questions(questions, keys, in_secret))


def _questions(section: Section) -> Iterator[Question]:
    for name in tuple(section.keys()):
        each = section.section(name)
        made = Question(name, each.text("ask"), each.texts("choices", ()), each.flag("list", False))
        each.finish()
        yield made
    section.finish()


def _key(section: Section, question: Question) -> Key:
    each = section.section(question.name)
    right = each.texts("right")
    for value in right:
        if question.choices and value not in question.choices:
            each.error(f"{quoted(value)} is none of the choices", "right")
    given = each.section("feedback", None)
    feedback = {} if given is None else {_plain(name): given.text(name) for name in tuple(given.keys())}
    made = Key(right, each.number("within", 0.0, minimum=0), question.is_list, feedback)
    each.finish()
    return made


def gather(assignment: Assignment, file: Path, conditions: Conditions) -> AbstractContextManager[Gatherer]:
    """Reads the file once; not at all where what is right is for the teacher's machine alone."""
    task: Questions = assignment.task
    withheld = task.is_secret and not conditions.secret
    return nullcontext(Looks([] if withheld else [_look(task, file)], conditions.level))


def _look(task: Questions, file: Path) -> Look:
    found = from_yaml(file, lambda section: Answered(_given(section, task.questions), task))
    if isinstance(found, Failure):
        return Look(failure=found)
    return Look(found, remarks=lambda check, params: found.first_wrong(params.keys or tuple(task.keys)))


def _given(section: Section, questions: Sequence[Question]) -> Mapping[str, tuple[str, ...]]:
    """What was answered to each question; nothing where its key is missing or left empty."""
    known = {each.name: each for each in questions}
    given = {}
    for name, value in section.rest().items():
        question = known.get(name)
        if question is None:
            section.error(f"no question {quoted(name)}: {suggestion(name, known)}", name)
            continue
        values = value if isinstance(value, tuple) else () if value is None else (value,)
        words = [_written(each) for each in values]
        given[name] = tuple(each for each in words if each)
        if any(len(each) > LONGEST for each in words):
            section.error(f"the answer is longer than {LONGEST} characters", name)
        for each in given[name]:
            if question.choices and _plain(each) not in map(_plain, question.choices):
                section.error(
                    f"no choice {quoted(each[:LONGEST])}: {suggestion(each, question.choices)}", name
                )
    return given


def _written(value: object) -> str:
    """A plain value as one writes it in YAML."""
    return str(value).lower() if isinstance(value, bool) else "" if value is None else str(value).strip()


def _same(given: str, right: str, within: float) -> bool:
    """Numbers compare as numbers, words without case and with single blanks."""
    try:
        return math.isclose(float(given), float(right), rel_tol=1e-9, abs_tol=within)
    except ValueError:
        return _plain(given) == _plain(right)


def _plain(word: str) -> str:
    return " ".join(word.split()).casefold()


SORT: Final = Sort((".yaml", ".yml"), {answers.name: answers}, read, gather)
