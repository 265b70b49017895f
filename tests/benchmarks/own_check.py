"""What a student's own check costs: ``python tests/benchmarks/own_check.py [EXERCISE ...]``.

For every exercise of the lessons (or those whose path holds one of the words) its solution is checked as a lesson checks
it, and the best of three runs is printed: processor seconds of all processes, which do not depend on what else the machine
does, seconds on the clock, and the simulated seconds of its episodes. Then the same for works that cannot be loaded.
"""

from __future__ import annotations

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

from grader.reading import read_assignment
from kit.school.lessons.checking import check_exercise
from kit.school.lessons.reading import lesson_names, lessons_folder, read_lesson, solutions_folder
from kit.school.lessons.records import Exercise, Lesson

RUNS: Final = 3
TICK_S: Final = 0.01
BROKEN_PROGRAMS: Final = {
    "a syntax error": "def main(:\n",
    "a NameError at import": "import rclpy\nspeed = fast\n",
}
BROKEN_YAML: Final = "key:value\nother: [1, 2\n"


class Cost(NamedTuple):
    processor_s: float
    clock_s: float
    steps: int


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


def measure(exercise: Exercise, file: Path) -> Cost:
    costs = []
    for _ in range(RUNS):
        before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
        report = check_exercise(exercise, file, recording=file.parent / ".worst.npz")
        took = time.perf_counter() - began
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        processor_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        costs.append(Cost(processor_s, took, 0 if report.result is None else report.result.steps))
    return min(costs)


def figure(name: str, kind: str, cost: Cost) -> None:
    print(
        f"{name:<44}{kind:<12}{cost.processor_s:>7.2f} cpu{cost.clock_s:>7.2f} s{cost.steps * TICK_S:>9.1f} simulated",
        flush=True,
    )


def main() -> None:
    controllers = []
    for lesson, exercise in exercises(sys.argv[1:]):
        kind = read_assignment(exercise.folder).kind
        with tempfile.TemporaryDirectory() as name:
            file = put_solution(lesson, exercise, Path(name))
            cost = measure(exercise, file)
            figure(f"{lesson.name}/{exercise.name}", kind, cost)
            if kind == "controller":
                controllers.append(cost)
                for what, source in BROKEN_PROGRAMS.items():
                    file.write_text(source)
                    figure(f"    {what}", "", measure(exercise, file))
            elif file.suffix == ".yaml":
                file.write_text(BROKEN_YAML)
                figure("    a slip in the YAML", "", measure(exercise, file))
    if controllers:
        print(
            f"median of the controllers: {statistics.median(each.processor_s for each in controllers):.2f} cpu, ",
            end="",
        )
        print(f"{statistics.median(each.clock_s for each in controllers):.2f} s")


if __name__ == "__main__":
    main()
