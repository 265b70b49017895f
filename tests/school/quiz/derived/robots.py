"""What the questions on real robots ask, worked out by the references of the exercises and by trainings of the lesson's."""

from __future__ import annotations

import csv
import subprocess
import sys
from functools import cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory

from kit.school.lessons.reading import lessons_folder, read_lesson
from kit.school.quiz.items import QuizItem
from tests.kit_content import lesson_reference
from tests.school.quiz.derived.finding import Derivation, Finding, nearest

LESSON = lessons_folder() / "38-sim-to-real"


robot_reference = partial(lesson_reference, LESSON.name)


def training_line(name: str) -> str:
    """The lesson's command that trains the run of that name."""
    lines = [command.line for step in read_lesson(LESSON).steps for command in step.commands]
    (line,) = (each for each in lines if each.startswith("kit train") and f"--name {name} " in each)
    return line


@cache
def drift_sweep(name: str) -> dict[float, str]:
    """The share that arrives at each drift [rad/m], as the kit prints it, of a run trained by the lesson's command."""
    with TemporaryDirectory() as folder:
        table = Path(folder) / "drift.csv"
        for line in (
            training_line(name),
            f"kit evaluate {name} --sweep --kinds drift --episodes 40 --csv {table}",
        ):
            done = subprocess.run(
                [sys.executable, "-m", *line.split(), "--workspace", folder],
                capture_output=True,
                text=True,
                check=False,
                timeout=500,
            )
            assert done.returncode == 0, done.stderr
        with table.open(newline="") as rows:
            return {float(row["value"]): f"{float(row['share']):.3f}" for row in csv.DictReader(rows)}


def endured_latency(item: QuizItem, folder: Path) -> Finding:
    table = [[0.0, 0.90], [0.1, 0.80], [0.2, 0.60], [0.3, 0.75]]
    return nearest(item, robot_reference("sweep").endured(table, 0.8), 0.001)


def late_by_two_steps(item: QuizItem, folder: Path) -> Finding:
    carried_out = robot_reference("sweep").delayed([0.4, 0.4, 0.0, 0.0], 2)
    text = ", ".join(f"{each:.1f}" for each in carried_out)
    return Finding(text, {option.text: option.text for option in item.options})


def better_where_exact(item: QuizItem, folder: Path) -> Finding:
    shares = [float(drift_sweep(name)[0.0]) for name in ("careful", "shaken")]
    better = "The first" if shares[0] > shares[1] else "The second" if shares[1] > shares[0] else "Both alike"
    return Finding(better, {option.text: option.text for option in item.options})


def always_the_same_rays(item: QuizItem, folder: Path) -> Finding:
    """Of a robot that turns beside a wall: its wheel keeps its ray, and the wall does not."""
    far = 3.5
    scans = [[far] * 8 for _ in range(8)]
    for turn, scan in enumerate(scans):
        scan[(3 + turn) % 8] = 0.3  # the wall
        scan[6] = 0.06
    own = robot_reference("guard").own_rays(scans, far)
    seen = "The robot itself" if own == [None] * 6 + [0.06, None] else "A wall that is very near"
    return Finding(seen, {option.text: option.text for option in item.options})


ROBOTS: dict[str, Derivation] = {
    "endured-latency": endured_latency,
    "late-by-two-steps": late_by_two_steps,
    "better-where-exact": better_where_exact,
    "always-the-same-rays": always_the_same_rays,
}
