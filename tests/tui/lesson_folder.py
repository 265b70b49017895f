"""A lesson of our own with every kind of step, for the tests of its screen."""

from __future__ import annotations

from pathlib import Path

LESSON = """
title: Colours
summary: What a traffic light says.
minutes: 5
outcomes: [Read a light, Say what it says]
carries: [light]
steps:
  - kind: predict
    title: Where does it go?
    goal: Foresee a walk
    text: |
      A robot stands in a corridor. It goes **straight on** until a wall is near; `random_walk` drives it.
    scene: {place: turn, controller: random_walk, seed: 1, seconds: 1}
    question: What does it do first?
    options:
      - {text: It drives ahead., right: true, feedback: It goes ahead while there is room.}
      - {text: It turns on the spot., feedback: Only a wall makes it turn.}
      - {text: Nothing at all., feedback: A timer makes it go.}
  - kind: run
    title: A list of maps
    goal: See what there is
    text: Type this.
    picture: |
      (o) red
      ( ) green
    commands:
      - {line: kit maps}
      - {line: kit keys, how: screen}
  - kind: explain
    title: Why
    goal: See why
    text: |
      It goes round.

      - red
      - green
  - kind: modify
    title: Say it
    goal: Write it down
    text: Write the colour into {file}.
    exercise: colour
    file: answers.yaml
    seconds: 20
  - kind: make
    title: Round the corner
    goal: Drive to the target
    text: The robot stands still. Make it go.
    exercise: corner
    file: controller.py
    seconds: 20
"""
COLOUR = """
title: Colour
kind: answers
submit: answers.yaml
level: 0
questions: {colour: {ask: Which colour means go?}}
answers: {colour: {right: [green], feedback: {red: That one means stop.}}}
checks:
  - {check: answers, id: colour, title: The colour, points: 2, hints: [Look up., It grows on trees., It is green.]}
"""
CORNER = """
title: Corner
kind: controller
submit: controller.py
level: 0
trials:
  - {name: there, place: turn, case: turn_a_to_b, time: 2, seeds: [1]}
checks:
  - {check: runs, title: It runs, points: 1}
  - {check: reached, title: It reaches the target, points: 3, after: runs, hints: [Turn left at the corner.]}
"""
STILL = '''"""Stands still."""

import rclpy
from rclpy.node import Node


class Still(Node):
    def __init__(self):
        super().__init__("still")
        print("here I stand")


def main():
    rclpy.init()
    rclpy.spin(Still())


if __name__ == "__main__":
    main()
'''
TURNING = (
    STILL.replace("Stands still", "Turns on the spot")
    .replace(
        """        print("here I stand")
""",
        """        self.wheels = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.turn)

    def turn(self):
        command = Twist()
        command.angular.z = 0.3
        self.wheels.publish(command)
""",
    )
    .replace("import rclpy\n", "import rclpy\nfrom geometry_msgs.msg import Twist\n", 1)
)


def write_lessons(folder: Path, more: int = 0) -> Path:
    """A folder of lessons: one to go through, and ``more`` like it."""
    for number in range(1, more + 2):
        lesson = folder / f"{number:02}-colours{'' if number == 1 else number}"
        (lesson / "colour").mkdir(parents=True)
        (lesson / "corner").mkdir()
        (lesson / "lesson.yaml").write_text(LESSON)
        (lesson / "colour" / "assignment.yaml").write_text(COLOUR)
        (lesson / "colour" / "starter.yaml").write_text("colour:\n")
        (lesson / "corner" / "assignment.yaml").write_text(CORNER)
        (lesson / "corner" / "starter.py").write_text(STILL)
    (folder / "outcomes.yaml").write_text("light: Read a light\n")
    return folder


DRIVEN = """
title: By hand
summary: A drive.
minutes: 5
outcomes: [Drive]
carries: [light]
steps:
  - kind: make
    title: To the target
    goal: Reach it
    text: Drive there.
    scene: {place: turn, case: turn_a_to_b, controller: teleop, seed: 1, seconds: 60}
    exercise: drive
    file: drive.npz
    seconds: 20
"""
DRIVE = """
title: A drive
kind: drive
submit: drive.npz
level: 0
drive: {place: turn, case: turn_a_to_b, time: 60}
checks:
  - {check: genuine, title: It is a drive, points: 1}
  - {check: reached, title: It reaches the target, points: 3, after: genuine, hints: [Turn right.]}
"""


def write_drive(folder: Path) -> Path:
    """A lesson with one exercise, that is driven by hand."""
    lesson = folder / "01-by-hand"
    (lesson / "drive").mkdir(parents=True)
    (folder / "outcomes.yaml").write_text("light: Read a light\n")
    (lesson / "lesson.yaml").write_text(DRIVEN)
    (lesson / "drive" / "assignment.yaml").write_text(DRIVE)
    return lesson


def write_solutions(folder: Path) -> Path:
    """What solves its exercises, as far as somebody may look at it."""
    (folder / "01-colours" / "colour").mkdir(parents=True)
    (folder / "01-colours" / "colour" / "solution.yaml").write_text("# go\ncolour: green\n")
    return folder
