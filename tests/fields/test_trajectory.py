"""Ways and rides: short, clear of walls, gentle; and goals that cannot be reached are said to be so."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit.fields.charges import ChargeField, PointCharge
from kit.fields.controller_setup import ControllerSetup
from kit.fields.layout import ChargeLayout, Intensities
from kit.fields.occupancy_grid import OccupancyGrid, wall_depth
from kit.fields.planner import CostToGo, Unreachable, VehicleSize, interpolate_grid, resample_path
from kit.fields.trajectory import (
    STEP_S,
    ComfortLimits,
    PairSettings,
    Trajectory,
    TrajectoryTracker,
    VelocityCommand,
    control_step,
    drive_commands,
    plan_trajectory,
    twist_between,
)
from kit.geometry import Pose, wrap_angle
from kit.run.scenario import Scenario, find_scenario
from tests.kit_content import kit_maps

LIMITS = ComfortLimits()
SMALL = VehicleSize(0.14, 0.14)
CASES = [
    pytest.param(card.name, case.name, id=case.name)
    for card in kit_maps()
    for case in card.cases
    if card.robot not in ("tricycle", "car")  # which have another drive
]
PAIRS = [
    pytest.param(card.name, case.name, id=case.name)
    for card in kit_maps()
    for case in card.cases
    if card.partner
]


def load_setup(place: Scenario) -> ControllerSetup:
    assert place.case is not None
    return ControllerSetup.load(place.world.file, place.partners, place.case.target, place.case.target_radius)


def room(*walls: tuple[float, float, float, float]) -> OccupancyGrid:
    around = [(0, 0, 4, 0), (4, 0, 4, 4), (4, 4, 0, 4), (0, 4, 0, 0)]
    return OccupancyGrid.from_walls(np.array([*around, *walls], dtype=float), [(0.5, 0.5)])


@pytest.mark.long_cases("forest_back", "labyrinth", "maze", "office_northeast", "spiral_in", "spiral_out")
@pytest.mark.parametrize(("name", "case"), CASES)
def test_on_every_map_a_ride_leads_to_the_target_and_never_near_a_wall(name: str, case: str) -> None:
    place = find_scenario(name, case)
    assert place.case is not None
    here = load_setup(place)
    ride = here.plan_trajectory(place.starts)
    for first, start in zip(ride.poses[0], place.starts, strict=True):
        assert math.dist(first[:2], start[:2]) < 0.06
        assert abs(wrap_angle(first[2] - start.theta)) < 0.06
    for robot, track in zip(here.robots, ride.tracks(), strict=True):
        assert (
            interpolate_grid(here.grid, here.grid.clearance, track).min()
            > robot.reach - 0.5 * here.grid.cell_size
        )
    assert math.dist(ride.poses[-1, :, :2].mean(axis=0), place.case.target) < 0.02


@pytest.mark.parametrize(("name", "case"), PAIRS)
def test_two_stay_side_by_side_within_a_passengers_limits(name: str, case: str) -> None:
    place = find_scenario(name, case)
    ride = load_setup(place).plan_trajectory(place.starts)
    left, right = ride.tracks()
    assert np.hypot(*(left - right).T) == pytest.approx(np.full(len(left), 0.3), abs=0.02)
    commands = np.array(
        [
            [twist_between(Pose(*now), Pose(*then), STEP_S) for now, then in zip(one, other, strict=True)]
            for one, other in zip(ride.poses[:-1].tolist(), ride.poses[1:].tolist(), strict=True)
        ]
    )
    speed, turn = commands[..., 0], commands[..., 1]
    assert speed.min() > -1e-3
    assert speed.max() <= LIMITS.speed * 1.03
    assert np.abs(turn).max() <= LIMITS.turn_rate * 1.1
    assert np.abs(np.diff(speed, axis=0)).max() / STEP_S <= LIMITS.acceleration * 1.6
    jerk = np.diff(speed, 2, axis=0) / STEP_S**2
    assert np.abs(jerk).max() <= 2 * LIMITS.acceleration / LIMITS.smoothing_time * 2


def test_a_way_round_a_wall_is_about_as_short_as_can_be() -> None:
    grid = room((2, 0, 2, 3))
    ways = CostToGo.compute(grid, (3.5, 0.5), SMALL, (0.5, 0.5))
    ways.check_reachable((0.5, 0.5))
    way = ways.plan_path((0.5, 0.5))
    length = float(np.hypot(*np.diff(way, axis=0).T).sum())
    shortest = 2 * math.hypot(1.5, 2.5)
    assert shortest < length < 1.12 * shortest
    assert interpolate_grid(grid, grid.clearance, way).min() >= 0.125


@pytest.mark.parametrize(
    ("walls", "size", "said"),
    [
        ([(2, 0, 2, 4)], SMALL, "walls block it"),
        ([(2, 0, 2, 1.9), (2, 2.1, 2, 4)], SMALL, "0.28 m wide: where it is narrowest, the widest leaves 0.2"),
        ([(2, 0, 2, 1.8), (2, 2.2, 2, 4)], VehicleSize(0.25, 0.14, "the two"), "wide enough for the two, 0.50 m wide"),
    ],
)  # fmt: skip
def test_a_goal_that_cannot_be_reached_is_said_to_be_so(
    walls: list[tuple[float, float, float, float]], size: VehicleSize, said: str
) -> None:
    ways = CostToGo.compute(room(*walls), (3.5, 2.0), size, (0.5, 2.0))
    with pytest.raises(Unreachable, match=said):
        ways.check_reachable((0.5, 2.0))


def test_a_target_inside_a_wall_or_at_one_is_said_to_be_so() -> None:
    grid = room((2, 2, 3, 2), (3, 2, 3, 3), (3, 3, 2, 3), (2, 3, 2, 2))
    with pytest.raises(Unreachable, match="is inside one"):
        CostToGo.compute(grid, (2.5, 2.5), SMALL, (0.5, 0.5)).check_reachable((0.5, 0.5))
    with pytest.raises(Unreachable, match=r"The target \(1\.9, 2\.5\) is too close to a wall for the robot"):
        CostToGo.compute(grid, (1.9, 2.5), SMALL, (0.5, 0.5)).check_reachable((0.5, 0.5))


def test_how_deep_inside_a_wall() -> None:
    grid = room((2, 2, 3, 2), (3, 2, 3, 3), (3, 3, 2, 3), (2, 3, 2, 2))
    faces = grid.wall_faces()
    assert wall_depth(grid, faces, 2.5, 2.6) == pytest.approx(0.4)
    assert wall_depth(grid, faces, 2.01, 2.6) == pytest.approx(0.01)
    for x, y in ((0.5, 0.5), (2.0, 2.6), (1.99, 2.6), (3.99, 1.0)):
        assert wall_depth(grid, faces, x, y) == 0


def test_who_stands_elsewhere_lines_up_first() -> None:
    way = resample_path(np.array([(0.0, 0.0), (2.0, 0.0)]), 0.03)
    ride = plan_trajectory(way, [Pose(0, 0.15, 0), Pose(0.4, -0.6, 2.0)], 0.3)
    assert ride.poses[0, 1] == pytest.approx([0.4, -0.6, 2.0])
    assert ride.poses[-1, 1, :2] == pytest.approx([2, -0.15], abs=1e-6)
    first = int(np.argmax(ride.poses[:, 0, 0] > 1e-6))
    assert ride.poses[first - 2, 1] == pytest.approx(
        [0, -0.15, 0], abs=0.01
    )  # there before the left one goes
    assert np.hypot(*np.diff(ride.poses[:, 1, :2], axis=0).T).max() < LIMITS.speed * STEP_S * 1.05


@given(st.floats(-0.05, 0.05), st.floats(-0.05, 0.05), st.floats(-0.4, 0.4))
def test_a_follower_comes_back_to_the_ride(x: float, y: float, theta: float) -> None:
    way = resample_path(np.array([(0.0, 0.0), (1.0, 0.0), (2.0, 0.5), (3.0, 0.5)]), 0.03)
    ride = plan_trajectory(way, [Pose()], 0.3)
    follower, pose = TrajectoryTracker(ride), Pose(x, y, theta)
    for _ in range(3 * len(ride.poses)):
        (command,) = follower.commands([pose])
        half = pose.compose(Pose(0, 0, 0.5 * command.angular * STEP_S))
        step = command.linear * STEP_S
        pose = Pose(
            pose.x + step * math.cos(half.theta),
            pose.y + step * math.sin(half.theta),
            pose.theta + command.angular * STEP_S,
        )
        if follower.is_done:
            break
    assert follower.is_done
    assert math.dist(pose[:2], (3.0, 0.5)) < 0.03


def test_who_falls_behind_is_waited_for() -> None:
    ride = Trajectory(np.zeros((50, 2, 3)) + np.linspace(0, 1, 50)[:, None, None] * (1, 0, 0))
    follower = TrajectoryTracker(ride)
    for _ in range(10):
        follower.commands([Pose(0.0, 0, 0), Pose(-0.5, 0, 0)])
    assert follower.tick == 0


@given(st.floats(-0.2, 0.2), st.floats(-0.3, 0.3), st.floats(-3, 3))
def test_a_twist_leads_where_it_should(forward: float, turn: float, theta: float) -> None:
    here = Pose(1, 2, theta)
    radius = forward / turn if abs(turn) > 1e-6 else None
    step = (
        Pose(forward, 0, 0)
        if radius is None
        else Pose(radius * math.sin(turn), radius * (1 - math.cos(turn)), turn)
    )
    found = twist_between(here, here.compose(step), 1.0)
    assert found.linear == pytest.approx(forward, abs=1e-6)
    assert wrap_angle(found.angular - (turn if radius is not None else 0.0)) == pytest.approx(0, abs=1e-6)


def test_the_robots_of_a_course() -> None:
    robots = load_setup(find_scenario("pair_turn")).robots
    assert [robot.commands for robot in robots] == ["/left/cmd_vel", "/right/cmd_vel"]
    assert [robot.odometry for robot in robots] == ["/left/odom", "/right/odom"]
    assert [robot.half_width for robot in robots] == pytest.approx([0.085, 0.085])


def test_a_robot_with_another_drive_is_refused() -> None:
    with pytest.raises(LookupError, match="no DiffDrive"):
        load_setup(find_scenario("depot"))


EMPTY = ChargeLayout((), Intensities(), None, ChargeField.from_charges(()))
AHEAD = Pose(0, 0, math.pi / 2)


def abreast(gap: float = 0.3, heading: float = math.pi / 2) -> tuple[Pose, Pose]:
    return Pose(-gap / 2, 0, heading), Pose(gap / 2, 0, heading)


def test_the_steps_of_section_4_1_3_2() -> None:
    found = control_step(abreast(), (0.0, 5.0), EMPTY)
    assert found.middle == (0, 0)
    assert found.middle_force == pytest.approx((0, 0.6))  # 15 / 25
    assert found.targets[0] == pytest.approx((-0.15, 0.3))  # 0.3 m ahead at most, 0.15 m aside
    assert found.targets[1] == pytest.approx((0.15, 0.3))
    # Tension 100 * 0.3 ahead; the other robot pushes by 1 / 0.3^2 aside.
    assert found.forces[0] == pytest.approx((-1 / 0.09, 30))
    assert found.forces[1] == pytest.approx((1 / 0.09, 30))


def test_a_weak_force_leads_less_far() -> None:
    found = control_step(abreast(), (0.0, 10.0), EMPTY)
    assert found.targets[0] == pytest.approx((-0.15, 0.15))


def test_walls_push_the_middle_and_each_robot() -> None:
    charges = (PointCharge(0, -1),)
    layout = ChargeLayout(charges, Intensities(target=1e-9), None, ChargeField.from_charges(charges))
    found = control_step(abreast(), (0.0, 5.0), layout)
    assert found.middle_force == pytest.approx((0, 1))
    assert found.forces[0][1] == pytest.approx(30 + 1 / (1 + 0.15**2) ** 1.5)


def test_both_turn_before_either_drives() -> None:
    poses = (Pose(0, 0, 0), Pose(1, 0, math.pi / 2))
    found = drive_commands(poses, [(0, 1), (0, 1)], PairSettings())
    assert found == (
        VelocityCommand(0, 1.0),
        VelocityCommand(0, 0),
    )  # 5 * pi / 2, but at most 1 rad/s; the other waits


def test_near_its_heading_a_robot_turns_more_slowly_and_the_short_way() -> None:
    poses = (Pose(0, 0, math.pi / 2 + 0.1), Pose(0, 0, -math.pi + 0.05))
    found = drive_commands(poses, [(0, 1), (-1, 0)], PairSettings())
    assert found[0] == pytest.approx((0, -0.5))
    assert found[1] == pytest.approx((0, -0.25))


@pytest.mark.parametrize("tolerance", [0.019, -0.019])
def test_within_the_tolerance_the_stronger_force_gets_full_speed_and_the_other_its_share(
    tolerance: float,
) -> None:
    poses = (Pose(0, 0, math.pi / 2 + tolerance), AHEAD)
    weaker, stronger = drive_commands(poses, [(0, 2), (0, 6)], PairSettings())
    assert weaker == pytest.approx((0.1, 0))
    assert stronger == pytest.approx((0.3, 0))


def test_no_force_no_motion() -> None:
    assert drive_commands((Pose(), Pose()), [(0, 0), (0, 0)], PairSettings()) == (
        VelocityCommand(0, 0),
        VelocityCommand(0, 0),
    )


def test_one_robot_alone_follows_the_force() -> None:
    found = control_step((AHEAD,), (0.0, 3.0), EMPTY)
    assert found.forces[0] == pytest.approx((0, 15 / 9))
    assert found.commands == (VelocityCommand(0.3, 0),)
