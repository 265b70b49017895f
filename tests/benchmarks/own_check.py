"""What a student's own check costs: ``python tests/benchmarks/own_check.py [EXERCISE ...]``.

For every exercise of the lessons (or those whose path holds one of the words) its solution is checked as a lesson checks
it, and the best of three runs is printed: processor seconds of all processes, seconds on the clock, and the simulated
seconds of its episodes, those with secret seeds too. Then the same for works that cannot be loaded. The processor seconds
are compared with ``MEDIAN_S``, ``limit_s`` and ``LOADING_S``; exit code 1 if any is over. They depend less than the clock on
what else the machine does, but not little: with fifteen busy processes on two cores they are a quarter larger.

On an idle machine the median of 14 controllers was 0.79 s of processor time, and what cannot be loaded cost less than
0.5 s, but for slips in tasks to learn: 0.56 to 0.60 s. Since these load no numba and no simulator either, they cost what
slips in trainings do.

Every check is a cold start: no process is kept for the next one. Within a check, the programs of its episodes are forked from
one interpreter (``kit.host.warm_start``).
"""

from __future__ import annotations

import compileall
import os
import resource
import shutil
import statistics
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Final, NamedTuple

sys.path.insert(0, str(Path(__file__).parents[2]))

from grader.assignment import Assignment
from grader.evidence.training_results import TrainingBudget
from grader.grading import GradingOptions, grade
from grader.kinds.environment.examination import EnvironmentTask
from grader.reading import read_assignment
from grader.submission import read_submission
from kit.host.sandbox.sandbox_config import Level
from kit.school.lessons.checking import submission_path
from kit.school.lessons.reading import lesson_names, lessons_folder, read_lesson, solutions_folder
from kit.school.lessons.records import Exercise, Lesson
from tests.exercise_checks import check_exercise

ROOT: Final = Path(__file__).parents[2]
RUNS: Final = 3
MEDIAN_S: Final = 2.0
"""The median of all controllers stays below this."""
LOADING_S: Final = 0.5
"""What a work costs at most that cannot be loaded."""
TICK_S: Final = 0.01
BROKEN_PROGRAMS: Final = {
    "a syntax error": "def main(:\n",
    "a NameError at import": "import rclpy\nspeed = fast\n",
}
BROKEN_YAML: Final = "key:value\nother: [1, 2\n"


class Cost(NamedTuple):
    processor_s: float
    clock_s: float
    simulated_s: float = 0.0

    @property
    def limit_s(self) -> float:
        """What the check of a whole work costs at most: twice its simulated episodes and 1 s."""
        return 2.0 * self.simulated_s + 1.0


def compile_kit() -> None:
    """Writes the bytecode that an installation has too, whatever ``PYTHONDONTWRITEBYTECODE`` says."""
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    for folder in ("kit", "grader"):
        compileall.compile_dir(ROOT / folder, quiet=1)


def exercises(words: list[str]) -> Iterator[tuple[Lesson, Exercise]]:
    for name in lesson_names():
        lesson = read_lesson(lessons_folder() / name)
        for exercise in lesson.exercises:
            if not words or any(word in f"{name}/{exercise.name}" for word in words):
                yield lesson, exercise


def put_solution(lesson: Lesson, exercise: Exercise, folder: Path) -> Path:
    """Writes the starter's files and the solution's over them; returns the file to edit."""
    solved = solutions_folder() / lesson.name / exercise.name
    for whole in (exercise.folder / "starter", solved / "solution"):
        if whole.is_dir():
            shutil.copytree(whole, folder, dirs_exist_ok=True)
    single = solved / f"solution{Path(exercise.file).suffix}"
    if single.is_file():
        shutil.copy(single, folder / exercise.file)
    return folder / exercise.file


def simulated_seconds(assignment: Assignment, exercise: Exercise, file: Path) -> float:
    """What all episodes of a work last [s]: a step of an environment, or of a training, lasts longer than a tick."""
    step_s = TICK_S
    if isinstance(assignment.task, EnvironmentTask):
        step_s = assignment.task.step_s
    elif isinstance(assignment.task, TrainingBudget):
        step_s = assignment.task.choice.resolve().step_time
    submission = read_submission(submission_path(exercise, file), assignment.submit)
    return grade(assignment, submission, GradingOptions(Level.LIMITED, secret=True)).steps * step_s


def measure(exercise: Exercise, file: Path) -> Cost:
    costs = []
    for _ in range(RUNS):
        before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        report = check_exercise(exercise, file, recording=file.parent / ".worst.npz")
        took = time.perf_counter() - began
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        processor_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        assert report.result is not None, report.problem
        costs.append(Cost(processor_s, took))
    return min(costs)


class Table:
    """Prints a line for each check, and keeps those that are over their limit."""

    def __init__(self) -> None:
        self.over: list[str] = []

    def add(self, name: str, kind: str, cost: Cost, limit_s: float) -> None:
        is_over = cost.processor_s > limit_s
        if is_over:
            self.over.append(f"{name}: {cost.processor_s:.2f} cpu, at most {limit_s:.2f}")
        print(
            f"{name:<52}{kind:<12}{cost.processor_s:>7.2f} cpu{cost.clock_s:>7.2f} s"
            f"{cost.simulated_s:>9.1f} simulated{'   OVER' if is_over else ''}",
            flush=True,
        )


def main() -> None:
    compile_kit()
    controllers = []
    table = Table()
    for lesson, exercise in exercises(sys.argv[1:]):
        assignment = read_assignment(exercise.folder)
        kind = assignment.kind
        with tempfile.TemporaryDirectory() as name:
            file = put_solution(lesson, exercise, Path(name))
            cost = measure(exercise, file)._replace(simulated_s=simulated_seconds(assignment, exercise, file))
            title = f"{lesson.name}/{exercise.name}"
            table.add(title, kind, cost, cost.limit_s)
            if kind == "controller":
                controllers.append(cost)
                for what, source in BROKEN_PROGRAMS.items():
                    file.write_text(source)
                    table.add(f"{title}, {what}", "", measure(exercise, file), LOADING_S)
            elif file.suffix == ".yaml":
                file.write_text(BROKEN_YAML)
                table.add(f"{title}, a YAML slip", "", measure(exercise, file), LOADING_S)
    if controllers:
        median_s = statistics.median(each.processor_s for each in controllers)
        clock_s = statistics.median(each.clock_s for each in controllers)
        print(
            f"median of {len(controllers)} controllers: {median_s:.2f} cpu (under {MEDIAN_S:g}), {clock_s:.2f} s"
        )
        if median_s >= MEDIAN_S:
            table.over.append(f"median of the controllers: {median_s:.2f} cpu, under {MEDIAN_S:g}")
    print("\n".join(["over their limit:", *table.over] if table.over else ["all within their limits"]))
    raise SystemExit(bool(table.over))


if __name__ == "__main__":
    main()
