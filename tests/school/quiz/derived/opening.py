"""What the course's opener says of robots, their programs and simulators, found out in small worlds."""

from __future__ import annotations

import math
from pathlib import Path

from kit.controllers import find_controller
from kit.msg.sensor_msgs import LaserScan
from kit.run.scenario import scenario_on_map
from kit.run.session import Session
from kit.school.quiz.items import QuizItem
from kit.sim.simulation import Simulation
from kit.world.catalogue import find_map
from tests.school.quiz.derived.finding import Derivation, Finding
from tests.sim.workshop import Workshop


def _driven(place: str, controller: str | None, seconds: float) -> float:
    """How far the robot is from its start in the end [m]."""
    with Session(scenario_on_map(find_map(place)), seed=1) as session:
        robot = session.scenario.robot
        assert robot is not None
        start = session.runner.simulation.pose(robot)
        if controller is not None:
            session.drive_with(find_controller(controller))
            session.wait_until_driven()
        for _ in range(round(seconds * 100)):
            session.runner.tick()
        return math.dist(session.runner.simulation.pose(robot)[:2], start[:2])


def ros_carries(item: QuizItem, folder: Path) -> Finding:
    """Without a program the messages still flow, and nobody decides where the robot drives."""
    with Session(scenario_on_map(find_map("simple")), seed=1) as session:
        published = {each.name for each in session.graph.directory.nodes}
        topics = any(True for _ in session.graph.directory.subscriptions("/cmd_vel"))
    decides = _driven("simple", None, 1.0) > 0.01
    return Finding(
        "carries" if topics and published and not decides else "decides",
        {
            "It decides where the robot drives next": "decides",
            "It carries messages between programs": "carries",
            "It replaces Linux on the computer": "replaces",
        },
    )


def same_program(item: QuizItem, folder: Path) -> Finding:
    """The same file on two maps, with robots of their own."""
    ways = [_driven(place, "random_walk", 3.0) for place in ("simple", "maze")]
    return Finding(
        all(way > 0.3 for way in ways),
        {
            "Yes, since it only knows the messages": True,
            "No, since each robot has its own ROS 2": False,
            "Only if it is written again in C++": "rewritten",
        },
    )


def laser_from_file(item: QuizItem, folder: Path) -> Finding:
    """A wall in a file moves by a metre, and so does what the laser measures."""
    ahead = []
    for wall in (2.0, 3.0):
        (folder / f"{wall:g}").mkdir()
        simulation = Simulation(Workshop(folder / f"{wall:g}").serp([(wall, -1, wall, 1)]))
        scans = [each.message for each in simulation.step(100) if isinstance(each.message, LaserScan)]
        ahead.append(scans[-1].ranges[len(scans[-1].ranges) // 2])
    found = "simulator" if abs(ahead[1] - ahead[0] - 1.0) < 0.05 else "room"
    return Finding(
        found,
        {
            "From a real laser, in a room that is kept for it": "room",
            "From the robot's program, which knows the room": "program",
            "From the simulator, which works it out": "simulator",
        },
    )


def learner_gets(item: QuizItem, folder: Path) -> Finding:
    """What an environment gives an agent for an action, beside the observation that a node gets too."""
    from kit.learning.environment.env import TurnEnv

    with TurnEnv() as env:
        env.reset(seed=1)
        _, reward, *_ = env.step(0)
    return Finding(
        "reward" if isinstance(reward, float) else "none",
        {
            "A number after each step, for how good it was": "reward",
            "The distances that the laser measures": "observation",
            "The rules that a good driver would follow": "rules",
        },
    )


def without_a_program(item: QuizItem, folder: Path) -> Finding:
    stays = _driven("simple", None, 3.0) < 0.01
    return Finding(
        "stands" if stays else "drives",
        {
            "It drives ahead until it meets a wall": "drives",
            "It stands still where it is": "stands",
            "It turns where it is and looks for a wall": "turns",
        },
    )


OPENING: dict[str, Derivation] = {
    "ros-carries": ros_carries,
    "same-program": same_program,
    "laser-from-file": laser_from_file,
    "learner-gets": learner_gets,
    "without-a-program": without_a_program,
}
