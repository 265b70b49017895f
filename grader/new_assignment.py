"""Makes a new assignment from a complete example: a template, or an exercise of a lesson with its solutions."""

from __future__ import annotations

import secrets
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import yaml

from grader.evidence_digest import ASSIGNMENT_FILE, YAML_LOADER
from grader.kinds.contract import find_kind
from grader.reading import SECRET_FILE, read_assignment
from grader.seeds import GUESSABLE_BELOW, MAX_SEED
from kit.plain_text import quoted, suggestion
from kit.school.lessons.reading import find_lesson, lessons_folder, solutions_folder
from kit.workspace import write_atomically

TEMPLATES: Final = Path(__file__).parent / "templates"

CARD: Final = "README.md"
"""The page of an assignment that its students read."""


class NoExample(LookupError):
    """No example has that name; the message says which there are."""


@dataclass(frozen=True, slots=True)
class AssignmentExample:
    """A complete assignment to start from: folders whose files together make it."""

    folders: tuple[Path, ...]
    source: str
    """What it is called in messages."""


def example_of_kind(kind: str) -> AssignmentExample:
    """Returns the example of a kind of submission. Raises NoExample for a kind without one, FileNotFoundError."""
    if (TEMPLATES / kind).is_dir():
        return AssignmentExample((TEMPLATES / kind,), kind)
    exercise = find_kind(kind).exercise
    if not exercise:
        raise NoExample(
            f"The kind {quoted(kind)} comes with no example; write its {ASSIGNMENT_FILE} by hand."
        )
    return example_of_exercise(exercise)


def example_of_exercise(name: str) -> AssignmentExample:
    """Returns an exercise of a lesson with its solution and its wrong solutions: ``LESSON/EXERCISE``, where the lesson is
    called as in ``kit lesson``. Raises NoExample, UnknownLesson, WorldError, FileNotFoundError."""
    lesson_name, _, exercise = name.partition("/")
    lesson = find_lesson(lesson_name)
    names = [each.name for each in lesson.exercises]
    if exercise not in names:
        choices = [f"{lesson.name}/{each}" for each in names]
        raise NoExample(f"There is no exercise {quoted(name)}: {suggestion(name, choices)}")
    folders = (lessons_folder() / lesson.name / exercise, solutions_folder() / lesson.name / exercise)
    return AssignmentExample(folders, f"{lesson.name}/{exercise}")


def make_assignment(example: AssignmentExample, folder: Path) -> None:
    """Copies the example into ``folder``, which is empty or does not exist yet. Everybody has the secret seeds of an example, so
    new ones are drawn. Raises OSError, WorldError."""
    ignored = shutil.ignore_patterns("__pycache__", "*.pyc")
    for each in example.folders:
        shutil.copytree(each, folder, dirs_exist_ok=True, ignore=ignored)
    secret = folder / SECRET_FILE
    if secret.exists():
        write_atomically(secret.absolute(), _with_new_seeds(secret.read_text(encoding="utf-8")).encode())
    if not (folder / CARD).exists():
        write_atomically((folder / CARD).absolute(), _default_readme(folder).encode())


def _with_new_seeds(text: str) -> str:
    """The text of a secret file with another number in place of each seed.

    >>> _with_new_seeds("seed: 7  # long\\n").endswith("  # long\\n")
    True
    """
    for seed in reversed(list(_seed_nodes(yaml.compose(text, Loader=YAML_LOADER)))):
        drawn = GUESSABLE_BELOW + secrets.randbelow(MAX_SEED - GUESSABLE_BELOW)
        text = f"{text[: seed.start_mark.index]}{drawn}{text[seed.end_mark.index :]}"
    return text


def _seed_nodes(node: yaml.Node | None, is_seed: bool = False) -> Iterator[yaml.ScalarNode]:
    """Yields the numbers under keys ``seed`` and ``seeds``, in their order in the text."""
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            yield from _seed_nodes(value, is_seed or key.value in ("seed", "seeds"))
    elif isinstance(node, yaml.SequenceNode):
        for value in node.value:
            yield from _seed_nodes(value, is_seed)
    elif isinstance(node, yaml.ScalarNode) and is_seed:
        yield node


def _default_readme(folder: Path) -> str:
    """The page for students of an assignment that has none yet."""
    assignment = read_assignment(folder)
    starter = next((each.name for each in sorted(folder.glob("starter*"))), "")
    start = f"Start from `{starter}`. " if starter else ""
    return (
        f"# {assignment.title}\n\nHand in `{assignment.submit}`. {start}To see where you stand:\n\n"
        f"    grader check {assignment.submit} --assignment .\n"
    )
