"""How what the lesson on wall followers says is found out again: by driving its scenes and its reference solution."""

from __future__ import annotations

import math
import re
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np

from kit.arrays import FloatArray
from kit.controllers import find_controller
from kit.run.scenario import find_scenario
from kit.run.session import Session
from kit.school.lessons.reading import lessons_folder, solutions_folder
from kit.school.lessons.records import LessonStep
from tests.kit_content import lesson_reference

LESSON: Final = "34-wall-follower"
DISTANCE: Final = 0.4
"""From the laser to the wall, as the lesson asks [m]."""
TICK_S: Final = 0.01
SCAN_S: Final = 0.1


@cache
def driven(place: str, controller: str, seconds: float, seed: int = 1) -> tuple[FloatArray, int]:
    """(ticks, 3) the poses of a robot in a world that a controller drives, and how often it bumped."""
    with Session(find_scenario(place), seed=seed) as session:
        robot = session.scenario.robot
        assert robot is not None
        session.drive_with(find_controller(controller))
        session.wait_until_driven()
        poses = []
        while len(poses) < seconds / TICK_S:
            session.runner.tick()
            poses.append(tuple(session.runner.simulation.pose(robot)))
        return np.array(poses), session.metrics.metrics.bumps


def scene_of(step: LessonStep) -> tuple[FloatArray, int]:
    assert step.scene is not None
    return driven(step.scene.map_name, step.scene.controller, step.scene.seconds, step.scene.seed)


def numbers_in(pattern: str, file: Path) -> list[float]:
    """The numbers that a pattern finds in a file."""
    found = re.search(pattern, file.read_text())
    assert found is not None, pattern
    return [float(each) for each in found.groups()]


def start_of(world: str) -> float:
    """Where the robot begins, across the wall [m]."""
    return numbers_in(r"pose: \[[\d.]+, ([\d.]+), 0\]", lessons_folder() / LESSON / world / "world.yaml")[0]


def swing_settings(words: str, step: LessonStep, folder: Path) -> str:
    aim, speed, gain = numbers_in(
        r"error = ([\d.]+) - distance\n.*\n.*= ([\d.]+), ([\d.]+) \* error",
        lessons_folder() / LESSON / "swing.py",
    )
    start = start_of("long-wall")
    error = start - aim
    texts = (
        f"The wall is {start:g} m to the robot's right; it is to be {aim:g} m",
        f"the error is {aim:g} m minus the distance",
        f"turns at {gain:.1f} times the error, and drives on at {speed:g} m/s",
        f"The error is {error:.1g} m at first, so it turns at {gain * error:.1g} rad/s",
    )
    return next((each for each in texts if each[:12] == words[:12]), texts[0])


def swing(words: str, step: LessonStep, folder: Path) -> str:
    """It crosses its distance again and again, as far as at the beginning."""
    track, bumps = scene_of(step)
    off = track[:, 1] - DISTANCE
    crossings = np.count_nonzero(np.diff(np.sign(off)))
    late = off[len(off) * 2 // 3 :]
    assert crossings >= 5
    assert late.max() > 0.2 > -0.2 > late.min()
    if words.startswith("From"):
        assert bumps
        return f"From {track[:, 1].min():.2f} m to {track[:, 1].max():.2f} m, and it touches the wall"
    return "It swings past 0.4 m, to and fro, for ever."


def seconds_between_scans(words: str, step: LessonStep, folder: Path) -> str:
    (rate,) = numbers_in(
        r"topic: static_laser[\s\S]*?update_rate: (\d+)",
        lessons_folder() / LESSON / "long-wall" / "robot.model.yaml",
    )
    return f"{1 / rate:g} s pass from one scan to the next"


def pd_stays(words: str, step: LessonStep, folder: Path) -> str:
    """The reference solution in the first scene's room."""
    room = lessons_folder() / LESSON / "long-wall" / "world.yaml"
    solution = solutions_folder() / LESSON / "follower" / "solution.py"
    track, bumps = driven(str(room), str(solution), 25.0)
    late = track[1000:, 1]
    assert not bumps
    assert np.abs(late - 0.42).max() <= 0.03
    return "stays within 0.03 m of 0.42 m after ten seconds"


def noise_as_change(words: str, step: LessonStep, folder: Path) -> str:
    (noise,) = numbers_in(
        r"noise_std_dev: ([\d.]+)", lessons_folder() / LESSON / "long-wall" / "robot.model.yaml"
    )
    return f"a difference of {noise:g} m in {SCAN_S:g} s already looks like {noise / SCAN_S:g} m/s"


def sides_are_mirrored(words: str, step: LessonStep, folder: Path) -> str:
    """Which rays count, by the reference: one short ray at a time."""
    reference = lesson_reference(LESSON, "steering")
    seen = {
        side: [
            ray
            for ray in range(91)
            if reference.distance([0.5 if each == ray else 3.0 for each in range(91)], side) < 1.0
        ]
        for side in ("right", "left")
    }
    right, left = seen["right"], seen["left"]
    assert [90 - ray for ray in reversed(right)] == left
    return f"rays {right[0]} to {right[-1]} on the right, rays {left[0]} to {left[-1]} on the left"


def one_ray_settings(words: str, step: LessonStep, folder: Path) -> str:
    aim, gain = numbers_in(
        r"error = ([\d.]+) - scan[\s\S]*error \+ ([\d.]+) \* change", lessons_folder() / LESSON / "one_ray.py"
    )
    room = [
        [float(number) for number in line.split()]
        for line in (lessons_folder() / LESSON / "doorway" / "room.dat").read_text().splitlines()
    ]
    (first, wall, corner, _), behind = room[4], room[0][1]
    jump = wall - behind
    (begin,) = numbers_in(r"pose: \[([\d.]+),", lessons_folder() / LESSON / "doorway" / "world.yaml")
    assert first == 0.0
    assert round(corner - begin) == 2
    assert gain == 3.0
    texts = (
        f"It drives along a wall at {start_of('doorway') - wall:.1g} m",
        f"behind it the next wall is {jump:g} m further away",
        "After two metres comes a door",
        (
            f"The error jumps by {jump:g} m in {SCAN_S:g} s: a change of {-jump / SCAN_S:g} m/s. "
            f"This one turns at {gain:.1f} times the change"
        ),
    )
    assert aim == DISTANCE
    return next((each for each in texts if each[:9] == words[:9]), texts[0])


def one_ray_spins(words: str, step: LessonStep, folder: Path) -> str:
    """More than a whole turn, and no way beyond the door."""
    track, _ = scene_of(step)
    turned = np.ptp(np.unwrap(track[:, 2]))
    assert turned > 2 * math.tau
    assert track[:, 0].max() < 3.0
    return "It spins on the spot and loses its way."


def right_hand_rule(words: str, step: LessonStep, folder: Path) -> str:
    """Walks through the picture's maze with one hand on the wall to the right."""
    rows = step.picture.splitlines()
    maze = {(x, y): mark for y, row in enumerate(rows) for x, mark in enumerate(row)}
    at = next(place for place, mark in maze.items() if mark == "I")
    heading, ways = 0, ((1, 0), (0, 1), (-1, 0), (0, -1))
    for _ in range(4 * len(maze)):
        for turn in (1, 0, -1, 2):  # to the right first; y points down
            ahead = ways[(heading + turn) % 4]
            following = at[0] + ahead[0], at[1] + ahead[1]
            if maze.get(following, "#") != "#":
                at, heading = following, (heading + turn) % 4
                break
        if maze[at] == "O":
            return "Yes. The outer wall runs past the way out."
    raise AssertionError("it does not get out")


FOLLOWER_DERIVATIONS: Final = (
    swing_settings,
    swing,
    seconds_between_scans,
    pd_stays,
    noise_as_change,
    sides_are_mirrored,
    one_ray_settings,
    one_ray_spins,
    right_hand_rule,
)
