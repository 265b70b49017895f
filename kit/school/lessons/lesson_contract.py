"""The contract of a folder of lessons, which authors check themselves: ``kit lesson --check FOLDER``."""

from __future__ import annotations

import subprocess
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from kit.controllers import find_controller
from kit.host.python_command import python_command
from kit.host.sandbox.probe import highest_level_up_to
from kit.host.sandbox.sandbox_config import Level
from kit.plain_text import quoted, suggestion
from kit.run.scenario import find_scenario
from kit.school.lessons.checking import SOLUTIONS
from kit.school.lessons.reading import LESSON_FILE, read_lesson
from kit.school.lessons.records import Lesson, LessonStep, StepKind
from kit.world.problems import WorldError

SELF_TEST_S: Final = 600.0
"""The longest time that the proof of one exercise may take [s]."""


@dataclass(frozen=True, slots=True)
class ContractFinding:
    """The result of one test of a lesson."""

    lesson: str
    text: str
    problem: str = ""
    """What is wrong; empty where nothing is."""

    @property
    def is_kept(self) -> bool:
        return not self.problem


def lesson_folders(folder: Path) -> tuple[Path, ...]:
    """The lessons in a folder, in order of their names; the folder itself where it is one."""
    if (folder / LESSON_FILE).is_file():
        return (folder,)
    return tuple(sorted(each.parent for each in folder.glob(f"[!.]*/{LESSON_FILE}")))


def check_contract(folder: Path, verbs: Collection[str]) -> Iterator[ContractFinding]:
    """Checks every lesson in a folder. ``verbs``: those of the ``kit`` command."""
    for each in lesson_folders(folder):
        try:
            lesson = read_lesson(each, is_foreign=True)
        except (WorldError, OSError) as error:
            yield ContractFinding(each.name, "it can be read", str(error))
            continue
        yield ContractFinding(each.name, "it can be read, and every text fits its screen")
        yield from _check_structure(lesson)
        yield from _check_commands(lesson, verbs)
        yield from _check_scenes(lesson)
        for exercise in lesson.exercises:
            yield _prove(lesson, exercise.name)


def _check_structure(lesson: Lesson) -> Iterator[ContractFinding]:
    name, kinds = lesson.folder.name, [step.kind for step in lesson.steps]
    first = "" if kinds[0] is StepKind.PREDICT else f"step 1 is of kind {kinds[0]}"
    yield ContractFinding(name, "it begins with a prediction", first)
    yield ContractFinding(name, "it has an exercise", "" if lesson.exercises else "no step has one")


def _check_commands(lesson: Lesson, verbs: Collection[str]) -> Iterator[ContractFinding]:
    for step in lesson.steps:
        for command in step.commands:
            verb = command.line.split()[1] if " " in command.line else ""
            problem = "" if verb in verbs else f"no verb {quoted(verb)}: {suggestion(verb, tuple(verbs))}"
            yield ContractFinding(lesson.folder.name, f"step {step.number}: {command.line}", problem)


def _check_scenes(lesson: Lesson) -> Iterator[ContractFinding]:
    for step in lesson.steps:
        if step.scene is None:
            continue
        problem = ""
        try:
            find_scenario(step.scene.map_name, step.scene.case)
            if step.scene.controller:
                find_controller(step.scene.controller)
        except (LookupError, WorldError) as error:
            problem = str(error)
        yield ContractFinding(lesson.folder.name, _scene_text(step), problem)


def _scene_text(step: LessonStep) -> str:
    return f"step {step.number}: its scene has a world and a controller"


def _prove(lesson: Lesson, exercise: str) -> ContractFinding:
    """Has the grader try the exercise: the starter fails politely, the solution passes, each wrong work loses."""
    text = f"exercise {exercise}: the grader's self-test"
    solutions = lesson.folder / SOLUTIONS / exercise
    if not solutions.is_dir():
        return ContractFinding(
            lesson.folder.name, text, f"{solutions}: no folder with a solution and wrong works"
        )
    command = python_command(
        "grader", "self-test", str(lesson.folder / exercise), "--solutions", str(solutions)
    )
    if highest_level_up_to(Level.FILTERED) < Level.FILTERED:
        command += ["--level", "0"]  # the author's own programs, on a machine that has no higher level
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=SELF_TEST_S, check=False)
    except subprocess.TimeoutExpired:
        return ContractFinding(lesson.folder.name, text, f"it takes more than {SELF_TEST_S:g} s")
    problem = "" if done.returncode == 0 else (done.stdout + done.stderr).strip()
    return ContractFinding(lesson.folder.name, text, problem)
