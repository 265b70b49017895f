"""Checks of drives ask for a behaviour: what happens once, or all at once, is none."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from grader.driving import checks as drives
from grader.driving.checks import SpeedByRangeParams
from grader.driving.drive_record import GradedDrive
from grader.grading import GradingOptions, grade
from grader.kinds.environment.examination import FreePlacementRunner
from grader.reading import read_assignment
from grader.submission import Submission
from kit.host.sandbox.confinement import Level
from kit.ros.graph.graph import Graph
from kit.run.scenario import find_scenario
from kit.sim.simulation import Simulation, SimulationError
from tests.cases import every_case
from tests.grader.conftest import QUICK, write_assignment
from tests.grader.further_attacks import ROBOT, ROBOT_WITH_LASER, ROOM, SQUARE

SECONDS = 20


def rate_of(per_second: dict[int, int], rate: float) -> float:
    return drives._rate_error(per_second, rate, SECONDS)


@every_case(
    "rate, per_second, is_steady",
    [
        (10, dict.fromkeys(range(SECONDS), 10), True),
        (10, dict.fromkeys(range(1, SECONDS), 10), True),
        (10, {0: 10 * SECONDS}, False),
        (10, {0: 100, 19: 100}, False),
        (10, dict.fromkeys(range(0, SECONDS, 2), 20), False),
        (10, dict.fromkeys(range(SECONDS), 5), False),
        (10, {}, False),
        (1, dict.fromkeys(range(SECONDS), 1), True),
        (1, {0: SECONDS}, False),
        (0.5, dict.fromkeys(range(0, SECONDS, 2), 1), True),
        (0.5, {0: 10}, False),
    ],
)
def test_a_rate_is_kept_all_the_time(rate: float, per_second: dict[int, int], is_steady: bool) -> None:
    assert (rate_of(per_second, rate) <= 0.1) == is_steady


def graded(folder: Path, checks: str, source: str) -> dict[str, float]:
    sheet = QUICK.partition("checks:")[0] + f"checks: [{checks}]\n"
    assignment = read_assignment(write_assignment(folder, sheet))
    work = Submission("ada", "controller.py", {"controller.py": source.encode()})
    result = grade(assignment, work, GradingOptions(Level.LIMITED))
    return {test.id: test.points for test in result.tests}


NODE = """
import rclpy
from rclpy.node import Node
from geometry_msgs.msg import Twist

class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.drive = self.create_publisher(Twist, "TOPIC", 10)
        self.create_timer(PERIOD, self.once)
        self.is_first = True

    def once(self):
        for _ in range(COUNT):
            if self.is_first or not ALL_AT_ONCE:
                self.drive.publish(Twist())
                self.get_logger().info("alive")
        self.is_first = False

rclpy.init()
rclpy.spin(Talker())
"""


def talker(topic: str, *, all_at_once: bool, count: int = 1) -> str:
    words = {"TOPIC": topic, "PERIOD": "0.1", "COUNT": str(count), "ALL_AT_ONCE": str(all_at_once)}
    source = NODE
    for word, value in words.items():
        source = source.replace(word, value)
    return source


@pytest.mark.long
@pytest.mark.parametrize(("all_at_once", "count", "points"), [(False, 1, 2.0), (True, 40, 0.0)])
def test_all_messages_and_lines_in_the_first_tick_are_no_rate(
    all_at_once: bool, count: int, points: float, tmp_path: Path
) -> None:
    checks = (
        "{check: rate, points: 1, with: {topic: /cmd_vel, rate: 10}}, "
        "{check: says, points: 1, with: {text: alive, seconds: 0.1}}"
    )
    source = talker("cmd_vel", all_at_once=all_at_once, count=count)
    sheet_time = QUICK.count("time:")
    assert sheet_time == 1
    assert sum(graded(tmp_path / "r", checks, source).values()) == pytest.approx(points)


def drive_by_range(distances: list[float], speeds: list[float]) -> float:
    """What ``speed_by_range`` measures where a scan comes ten times a second, and a command right after it."""
    times = np.arange(len(distances)) / 10
    drive = object.__new__(GradedDrive)
    object.__setattr__(drive, "ahead", {"/static_laser": np.column_stack([times, distances])})
    object.__setattr__(drive, "commands", np.column_stack([times + 0.01, speeds, 0 * times]))
    return drives.speed_by_range.measure(drive, SpeedByRangeParams())


def test_the_speed_must_follow_what_the_laser_measures() -> None:
    distances = [*np.linspace(2.0, 0.4, 60).tolist(), *[0.4] * 20, *[float("nan")] * 5]
    right = [0.0 if each < 0.5 else 0.3 if each < 1.2 else 0.6 for each in distances]
    assert drive_by_range(distances, right) == 1.0
    assert drive_by_range(distances, [right[0], *right[:-1]]) == 1.0, (
        "it may answer the scan before the newest"
    )
    assert drive_by_range(distances, [0.6] * len(right)) == 0.0
    late = [*[0.6] * 12, *right[:-12]]
    assert drive_by_range(distances, late) < 0.9, "the same speeds in the same order, by the clock"
    assert drive_by_range([2.0] * 50, [0.6] * 50) == 0.0, "who never comes near shows nothing"
    assert drive_by_range([], []) == 0.0


TWO_ROBOTS = """
properties: {}
layers: [{name: [solid], map: room.yaml}]
models:
  - {name: robot, model: robot.model.yaml, pose: [1, 1, 0]}
  - {name: cart, model: cart.model.yaml, pose: [3, 3, 0], namespace: cart}
"""
CART = ROBOT.replace("RADIUS", "0.1") + "plugins: [{type: DiffDrive, name: drive, body: base}]\n"


@pytest.mark.long
@pytest.mark.parametrize(("topic", "obeys"), [("cmd_vel", 1.0), ("/cart/cmd_vel", 0.0)])
def test_a_program_drives_no_other_robot(topic: str, obeys: float, tmp_path: Path) -> None:
    """Traffic that is stopped stands in nobody's way."""
    folder = tmp_path / "two"
    folder.mkdir()
    files = {
        "world.yaml": TWO_ROBOTS,
        "cart.model.yaml": CART,
        "room.yaml": ROOM.decode(),
        "room.dat": SQUARE.decode(),
    }
    for name, text in {**files, "robot.model.yaml": ROBOT_WITH_LASER}.items():
        (folder / name).write_text(text)
    sheet = QUICK.partition("trials:")[0] + (
        "trials: [{name: two, place: world.yaml, time: 1, seeds: [1], target: [3.5, 1]}]\n"
        "checks: [{check: obeys, points: 1}]\n"
    )
    (folder / "assignment.yaml").write_text(sheet)
    source = talker(topic, all_at_once=False)
    work = Submission("ada", "controller.py", {"controller.py": source.encode()})
    result = grade(read_assignment(folder), work, GradingOptions(Level.LIMITED))
    assert result.points == obeys, result.tests


def test_an_environment_moves_its_robot_only_where_an_episode_begins() -> None:
    """One that moves it in each step, and never drives, acts on nothing."""
    scenario = find_scenario("turn")
    simulation = Simulation(scenario.world, seed=1)
    runner = FreePlacementRunner(simulation, Graph(log_sink=lambda record: None), frozenset({"move_model"}))
    runner.call_service("move_model", scenario.robot, (0.5, 0.0, 0.0))
    runner.is_in_step = True
    with pytest.raises(SimulationError):
        runner.call_service("move_model", scenario.robot, (0.6, 0.0, 0.0))
    assert runner.refused == ["move_model"]
