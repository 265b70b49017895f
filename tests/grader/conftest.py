"""Assignments and submissions for the tests of the grader."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from grader.assignment import Assignment
from grader.reading import read_assignment
from kit.host.sandbox import landlock, probe

LOCKS = pytest.mark.skipif(
    sys.platform != "linux" or landlock.abi() < 3, reason="this kernel cannot lock a process in (Landlock)"
)

TEMPLATES = Path(__file__).parents[2] / "grader" / "templates"

QUICK = """
title: Drive on
submit: controller.py
level: 0
trials: [{name: turn, place: turn, time: 4, seeds: [1]}]
checks:
  - {check: runs, points: 1}
  - {check: moves, points: 2, after: runs, share: {none: 0, full: 0.5}}
  - {check: reached, points: 3, after: runs, hints: [one, two, three]}
"""
"""An assignment that takes a blink to grade."""

FORWARD = """
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist, Vector3

class Forward(Node):
    def __init__(self):
        super().__init__("forward")
        self.drive = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.go)

    def go(self):
        self.drive.publish(Twist(linear=Vector3(x=SPEED)))

SPEED = 0.3

def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Forward())
"""


def write_assignment(folder: Path, text: str = QUICK, secret: str | None = None) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "assignment.yaml").write_text(text)
    if secret is not None:
        (folder / "secret.yaml").write_text(secret)
    return folder


@pytest.fixture
def quick(tmp_path: Path) -> Assignment:
    return read_assignment(write_assignment(tmp_path / "quick"))


@pytest.fixture
def no_level_1(monkeypatch: pytest.MonkeyPatch) -> None:
    """A machine that can lock nothing in."""
    monkeypatch.setattr(probe, "_known_levels", set())
    monkeypatch.setattr(probe, "is_level_available", lambda level: False)
