"""What a robot does, found out by letting it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from kit.controllers import find_controller
from kit.geometry import Pose
from kit.msg.geometry_msgs import Twist, Vector3
from kit.msg.sensor_msgs import LaserScan
from kit.run.scenario import scenario_on_map
from kit.run.session import Session
from kit.school.quiz.items import QuizItem
from kit.sim.simulation import Simulation
from kit.world.catalogue import find_map
from tests.driving_program import driving_program
from tests.school.quiz.derived.finding import Derivation, Finding, nearest
from tests.sim.workshop import Workshop

Walls = Sequence[Sequence[float]]


def drive(
    folder: Path,
    x: float,
    turn: float,
    seconds: float,
    *,
    y: float = 0.0,
    theta: float = 0.0,
    walls: Walls = ((50, -1, 50, 1),),
) -> Simulation:
    """The robot after one command, which is sent at the start."""
    simulation = Simulation(Workshop(folder).serp(walls, pose=(0, 0, theta)))
    simulation.accept("/cmd_vel", Twist(linear=Vector3(x=x, y=y), angular=Vector3(z=turn)))
    simulation.step(round(seconds / simulation.step_size))
    return simulation


def turn_in_place(item: QuizItem, folder: Path) -> Finding:
    pose = drive(folder, 0.0, 1.0, 1.0).pose("serp")
    way, side = math.hypot(pose.x, pose.y), "left" if pose.theta > 0 else "right"
    return Finding(
        (way > 0.01, side),
        {
            "It turns on the spot to the right": (False, "right"),
            "It drives a curve to the left": (True, "left"),
            "It turns on the spot to the left": (False, "left"),
        },
    )


def command_holds(item: QuizItem, folder: Path) -> Finding:
    at = [drive(folder, 0.5, 0.0, seconds).pose("serp").x for seconds in (0.1, 1.0, 4.0, 5.0)]
    speeds = (at[1] / 1.0, at[3] - at[2])
    found = "goes on" if min(speeds) > 0.49 else "stands" if max(speeds) < 0.1 else "slows down"
    return Finding(
        found,
        {
            "It drives on at 0.5 m/s for all five seconds": "goes on",
            "It stops after one tenth of a second": "stands",
            "It slows down little by little and comes to rest": "slows down",
        },
    )


def no_sideways(item: QuizItem, folder: Path) -> Finding:
    pose = drive(folder, 0.0, 0.0, 2.0, y=0.3).pose("serp")
    found = "turns" if abs(pose.theta) > 0.01 else "slides" if math.hypot(pose.x, pose.y) > 0.01 else "stays"
    return Finding(
        found,
        {
            "It slides to its left at 0.3 m/s": "slides",
            "It stays where it is and does not turn": "stays",
            "It turns left and then drives 0.3 m/s": "turns",
        },
    )


def circle_radius(item: QuizItem, folder: Path) -> Finding:
    """Half the distance of two opposite points."""
    there = drive(folder, 0.5, 0.25, math.pi / 0.25).pose("serp")
    return nearest(item, math.hypot(there.x, there.y) / 2, 0.05)


def forward_from_a_heading(item: QuizItem, folder: Path) -> Finding:
    pose = drive(folder, 0.5, 0.0, 1.0, theta=math.radians(90)).pose("serp")
    return Finding(
        (round(2 * pose.x), round(2 * pose.y)),
        {"Up, along y": (0, 1), "To the right, along x": (1, 0), "Down, against y": (0, -1)},
    )


def teleop_home(item: QuizItem, folder: Path) -> Finding:
    """Drives with the keys until it bumps, and looks where it is then."""
    with Session(scenario_on_map(find_map("simple")), seed=1) as session:
        start = session.scenario.start
        assert start is not None
        assert session.scenario.robot is not None
        session.drive_with(find_controller("teleop"))
        session.wait_until_driven()
        assert session.failure is None
        session.keys.publish(["p_up"])
        simulation, farthest = session.runner.simulation, start
        for _ in range(6000):
            session.runner.tick()
            pose = simulation.pose(session.scenario.robot)
            if session.metrics.metrics.bumps and math.dist(pose[:2], start[:2]) < 0.05:
                break
            farthest = pose
    away = math.dist(farthest[:2], start[:2])
    assert away > 0.1  # it was somewhere else before
    home = math.dist(pose[:2], start[:2]) < 0.05 and not session.runner.paused
    return Finding(
        "home" if home else "paused" if session.runner.paused else "back",
        {
            "It backs off a little and waits": "back",
            "It puts the robot back to its start": "home",
            "It stops the world until you press r": "paused",
        },
    )


# Lesson 9


def ray_ahead(item: QuizItem, folder: Path) -> Finding:
    """A wall stands ahead alone: which entry is the shortest?"""
    simulation = Simulation(Workshop(folder).serp([(1.0, -0.02, 1.0, 0.02)], lidar={"noise_std_dev": 0}))
    ranges = _scan(simulation).ranges
    hits = [index for index, value in enumerate(ranges) if not math.isnan(value)]
    assert len(ranges) == 91
    assert len(hits) == 1
    return nearest(item, hits[0], 0)


def laser_misses(item: QuizItem, folder: Path) -> Finding:
    value = _scan(Simulation(Workshop(folder).serp([(50, -1, 50, 1)]))).ranges[45]
    found = "nan" if math.isnan(value) else str(value)
    return Finding(found, {option.text: option.text for option in item.options})


def nan_comparison(item: QuizItem, folder: Path) -> Finding:
    ahead = _scan(Simulation(Workshop(folder).serp([(50, -1, 50, 1)]))).ranges[45]
    found = "turns" if ahead < 1.0 else "drives"
    return Finding(found, {"It turns": "turns", "It drives": "drives", "It stops": "stops"})


def way_between_scans(item: QuizItem, folder: Path) -> Finding:
    """In metres; the options are in mm and cm."""
    scale = {"mm": 0.001, "cm": 0.01}
    simulation = Simulation(Workshop(folder).serp([(50, -1, 50, 1)]))
    simulation.accept("/cmd_vel", Twist(linear=Vector3(x=0.5)))
    at = []
    while len(at) < 3:
        sent = simulation.step()
        if any(isinstance(out.message, LaserScan) for out in sent):
            at.append(simulation.pose("serp").x)
    way = at[2] - at[1]
    means = {
        option.text: float(option.text.split()[0]) * scale[option.text.split()[1]] for option in item.options
    }
    return Finding(round(way, 4), {text: round(value, 4) for text, value in means.items()})


def quarter_turn(item: QuizItem, folder: Path) -> Finding:
    """Scans come at 10 Hz, so ten of them are one second."""
    return nearest(item, math.degrees(drive(folder, 0.0, 1.5708, 1.0).pose("serp").theta), 1.0)


def sign_at_left_wall(item: QuizItem, folder: Path) -> Finding:
    wall = 0.6
    left = {
        sign: wall - drive(folder, 0.3, sign * 0.5, 1.0, walls=[(-5, wall, 5, wall)]).pose("serp").y
        for sign in (1, -1, 0)
    }
    best = min(left, key=lambda sign: left[sign])
    return Finding(best, {"A positive one": 1, "A negative one": -1, "Zero, and more speed": 0})


ENDLESS = driving_program(0.2, then="while self.count == 5:\n    pass", period_s=0.05)


def endless_loop(item: QuizItem, folder: Path) -> Finding:
    file = folder / "driver.py"
    file.write_text(ENDLESS)
    with Session(scenario_on_map(find_map("simple"))) as session:
        assert session.scenario.robot is not None
        session.drive_with(find_controller(str(file)))
        session.wait_until_driven()
        for _ in range(200):
            session.runner.tick()
            session.poll()
        ticks = session.runner.simulation.tick
        before = session.runner.simulation.pose(session.scenario.robot)
        for _ in range(100):
            session.runner.tick()
        after: Pose = session.runner.simulation.pose(session.scenario.robot)
        goes_on = session.runner.simulation.tick == ticks + 100
        stopped = session.failure is not None
    drives = math.dist(before[:2], after[:2]) > 0.01
    return Finding(
        (stopped, goes_on, drives),
        {
            "All stands still until you end the kit": (False, False, False),
            "The robot goes on with the old command": (True, True, True),
            "It is stopped, and the world goes on": (True, True, False),
        },
    )


def _scan(simulation: Simulation) -> LaserScan:
    scans = [out.message for out in simulation.step() if isinstance(out.message, LaserScan)]
    assert scans
    return scans[-1]


MOTION: dict[str, Derivation] = {
    "turn-in-place": turn_in_place,
    "command-holds": command_holds,
    "no-sideways": no_sideways,
    "circle-radius": circle_radius,
    "forward-from-a-heading": forward_from_a_heading,
    "teleop-home": teleop_home,
    "ray-ahead": ray_ahead,
    "laser-misses": laser_misses,
    "nan-comparison": nan_comparison,
    "way-between-scans": way_between_scans,
    "quarter-turn": quarter_turn,
    "sign-at-left-wall": sign_at_left_wall,
    "endless-loop": endless_loop,
}
