"""A drive of a solution's, given again by the clock without any sensor, earns little where a sensor is the idea."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from grader.driving import episodes
from grader.driving.drive_record import GradedDrive
from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from grader.submission import Submission
from kit.host.sandbox.sandbox_config import Level
from kit.school.lessons.reading import lesson_names, lessons_folder, solutions_folder
from tests.kit_content import kit_lesson

TAPE = """
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node

COMMANDS = {commands}

class Tape(Node):
    def __init__(self):
        super().__init__("tape")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.ticks = 0
        self.create_timer(0.01, self.on_timer)

    def on_timer(self):
        self.ticks += 1
        while COMMANDS and COMMANDS[0][0] <= 0.01 * self.ticks + 1e-6:
            command = Twist()
            _, command.linear.x, command.angular.z = COMMANDS.pop(0)
            self.drive.publish(command)

def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Tape())
"""

BY_THE_CLOCK = {("01-drive", "square"), ("09-your-own-controller", "circle")}
"""Exercises whose idea is a tape: numbers and times that make a figure."""

MOST = 0.5
"""The most of an exercise's points that a tape may earn: the episode that it was made in, and what comes with it."""


def driven_exercises() -> Iterator[tuple[str, str]]:
    for name in lesson_names():
        for exercise in kit_lesson(name).exercises:
            text = (lessons_folder() / name / exercise.name / "assignment.yaml").read_text()
            if "\nkind: controller" in text and (name, exercise.name) not in BY_THE_CLOCK:
                yield name, exercise.name


@pytest.mark.daily(5)
@pytest.mark.long
@pytest.mark.parametrize(("name", "exercise"), list(driven_exercises()))
def test_a_tape_of_the_solutions_drive_earns_little(
    name: str, exercise: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert share_of_tapes(name, exercise, monkeypatch) <= MOST


@pytest.mark.long
def test_a_tape_earns_much_where_a_figure_is_driven_by_the_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    """So the tapes are not clumsy."""
    assert share_of_tapes("01-drive", "square", monkeypatch) > MOST


def share_of_tapes(name: str, exercise: str, monkeypatch: pytest.MonkeyPatch) -> float:
    """Returns the most that a tape of one of the solution's drives earns, as a share of the points."""
    drives: list[GradedDrive] = []

    def kept(*arguments: Any, **fields: Any) -> GradedDrive:
        drives.append(GradedDrive(*arguments, **fields))
        return drives[-1]

    monkeypatch.setattr(episodes, "GradedDrive", kept)
    assignment = read_assignment(lessons_folder() / name / exercise)
    solution = (solutions_folder() / name / exercise / "solution.py").read_bytes()
    public = GradingOptions(Level.LIMITED)
    grade(assignment, Submission("solution", assignment.submit, {assignment.submit: solution}), public)
    tapes = {tuple(map(tuple, drive.commands.tolist())) for drive in drives} - {()}
    earned = []
    for commands in sorted(tapes):
        source = TAPE.format(commands=list(commands)).encode()
        work = Submission("tape", assignment.submit, {assignment.submit: source})
        earned.append(grade(assignment, work, GradingOptions(Level.LIMITED, secret=True)).points or 0.0)
    return max(earned, default=0.0) / assignment.max_points
