"""What can be copied from the lessons' own pages and hints is no solution: a program, a reward or a task that is made of it
earns at most half."""

from __future__ import annotations

import ast
import re
import shutil
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from grader.submission import read_submission
from kit.document.markup import parse_markup
from kit.host.sandbox.sandbox_config import Level
from kit.school.lessons.checking import STARTER
from kit.school.lessons.reading import lesson_names
from kit.school.lessons.records import Exercise, Lesson
from tests.kit_content import kit_lesson

MOST = 0.5
PROGRAMS = ("controller", "environment", "function", "launch")
KINDS = ("reward", "task", *PROGRAMS)
EXERCISES = [
    pytest.param(lesson, exercise, id=f"{name}-{exercise.name}", marks=[pytest.mark.long])
    for name in lesson_names()
    for lesson in [kit_lesson(name)]
    for exercise in lesson.exercises
    if read_assignment(exercise.folder).kind in KINDS
]
LESSONS = [kit_lesson(name) for name in lesson_names()]
TO_WRITE = re.compile(r"^( *).*(?:# write this|TODO).*$", re.MULTILINE)
NUMBERED = re.compile(r"^( +)# 1\. .*\n(?:\1#.*\n)+", re.MULTILINE)
"""Comments of a starter that say step by step what stands there in the end."""
STATEMENT = re.compile(r"[\w.]+ = [-\w.]+")
PARAMETERS = "reached, collided, distance, previous_distance"


def printed(lesson: Lesson, exercise: Exercise) -> Iterator[str]:
    """The blocks of code of the lesson's texts, and what stands alone in a hint."""
    yield from code_of(lesson)
    for criterion in read_assignment(exercise.folder).criteria:
        yield from criterion.hints


def code_of(lesson: Lesson) -> Iterator[str]:
    """The blocks of code on the pages of a lesson."""
    for step in lesson.steps:
        yield from ("\n".join(block.lines) for block in parse_markup(step.text) if block.kind == "code")


def printed_anywhere(lesson: Lesson, exercise: Exercise) -> list[str]:
    """What is printed for an exercise, and the blocks of code of all other lessons; each text once."""
    others = (text for each in LESSONS if each is not lesson for text in code_of(each))
    return list(dict.fromkeys([*printed(lesson, exercise), *others]))


def copied_programs(lesson: Lesson, starter: str) -> Iterator[str]:
    """The starter with each block of Python of its lesson: in place of what is to be written, what it works out returned, or
    added at the end; below what its comments print themselves; and with all functions and classes that any lesson prints."""
    blocks = [(each, tree) for text in code_of(lesson) if (tree := parsed(each := textwrap.dedent(text)))]
    for block, tree in blocks:
        yield f"{starter}\n\n{block}\n"
        if NUMBERED.search(starter):
            yield in_place_of_comments(starter, block)
        if TO_WRITE.search(starter):
            yield in_place_of_marks(starter, block)
            last = tree.body[-1]
            if isinstance(last, (ast.Assign, ast.Expr)):
                returned = f"return {ast.unparse(last.value)}"
                yield in_place_of_marks(starter, returned)
    definitions = [
        block
        for each in LESSONS
        for text in code_of(each)
        if (tree := parsed(block := textwrap.dedent(text)))
        and all(isinstance(part, (ast.ClassDef, ast.FunctionDef)) for part in tree.body)
    ]
    yield "\n\n".join([starter, *definitions])


def in_place_of_marks(starter: str, block: str) -> str:
    """The starter with a block in place of each line that says that it is to be written."""
    return TO_WRITE.sub(lambda found: textwrap.indent(block, found[1]), starter)


def in_place_of_comments(starter: str, block: str) -> str:
    """The starter with the statements in its numbered comments, and then a block, in place of these comments."""

    def code(found: re.Match[str]) -> str:
        return textwrap.indent("\n".join([*STATEMENT.findall(found[0]), block, ""]), found[1])

    return NUMBERED.sub(code, starter)


def parsed(text: str) -> ast.Module | None:
    """The block as Python; None where it is none, or states nothing, as a command of one word."""
    try:
        tree = ast.parse(text)
    except SyntaxError:
        return None
    is_word = all(isinstance(each, ast.Expr) and isinstance(each.value, ast.Name) for each in tree.body)
    return None if is_word else tree


def copied_rewards(lesson: Lesson, exercise: Exercise) -> Iterator[str]:
    """Each expression that is printed, as a reward."""
    for text in printed_anywhere(lesson, exercise):
        first = text.splitlines()[0].strip().split("  ")[0]
        if "reached" in first or "distance" in first:
            source = f"def reward({PARAMETERS}):\n    return {first}\n"
            try:
                compile(source, "reward.py", "exec")
            except SyntaxError:
                continue
            yield source


def copied_tasks(lesson: Lesson, exercise: Exercise, starter: dict[str, Any]) -> Iterator[str]:
    """The starter, with the rewards that are printed, and with every part that is."""
    parts: dict[str, list[Any]] = {}
    for text in printed_anywhere(lesson, exercise):
        for candidate in (text, f"reward: {{terms: {{{text}}}}}"):
            try:
                found = yaml.safe_load(candidate)
            except yaml.YAMLError:
                continue
            if isinstance(found, dict):
                for key, value in found.items():
                    if key in ("cases", "actions", "observation", "target", "step", "start") or (
                        key == "reward"
                        and all(isinstance(each, (int, float)) for each in value["terms"].values())
                    ):
                        parts.setdefault(key, []).append(value)
    everything = {key: values[0] for key, values in parts.items()}
    rewards = [{"reward": value} for value in parts.get("reward", [])]
    for chosen in (*rewards, everything, *({**everything, **each} for each in rewards[1:])):
        yield yaml.safe_dump({**(starter or {}), **chosen}, sort_keys=False)


def copies(lesson: Lesson, exercise: Exercise, folder: Path) -> Iterator[Path]:
    """What is handed in, one work after the other."""
    whole = exercise.folder / STARTER
    if whole.is_dir():
        shutil.copytree(whole, folder, dirs_exist_ok=True)
    file = folder / exercise.file
    suffix = Path(exercise.file).suffix
    single = exercise.folder / f"{STARTER}{suffix}"
    starter = (single if single.is_file() else file).read_text()
    kind = read_assignment(exercise.folder).kind
    texts: Iterator[str]
    if kind in PROGRAMS:
        texts = copied_programs(lesson, starter)
    elif kind == "reward":
        texts = copied_rewards(lesson, exercise)
    else:
        texts = copied_tasks(lesson, exercise, yaml.safe_load(starter))
    for text in dict.fromkeys(texts):
        file.write_text(text)
        yield folder if whole.is_dir() else file


@pytest.mark.parametrize(("lesson", "exercise"), EXERCISES)
def test_a_copied_work_earns_at_most_half(lesson: Lesson, exercise: Exercise, tmp_path: Path) -> None:
    assignment = read_assignment(exercise.folder)
    shares = {}
    for work in copies(lesson, exercise, tmp_path):
        result = grade(assignment, read_submission(work, assignment.submit), GradingOptions(Level.LIMITED))
        assert result.points is not None
        shares[(tmp_path / exercise.file).read_text()] = result.points / result.max_points
    assert {text: share for text, share in shares.items() if share > MOST} == {}


def test_something_is_copied() -> None:
    """Else the test above would try nothing."""
    rewards = kit_lesson("11-rewards")
    assert len(list(copied_rewards(rewards, rewards.exercises[0]))) >= 2
    nodes = kit_lesson("02-nodes-and-topics")
    assert len(list(copied_programs(nodes, "def main():\n    pass  # TODO\n"))) >= 5
    tasks = kit_lesson("24-train-your-own")
    assert len(list(copied_tasks(tasks, tasks.exercises[0], {}))) >= 2
