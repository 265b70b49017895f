"""The inputs of a map-based controller for one robot or two: grid, robots, their topics, target."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Final

from kit.fields.charge_derivation import derive_charges, layout_differences
from kit.fields.layout import ChargeLayout, derived_layout, load_layout, read_layout
from kit.fields.minima import ForceFlow
from kit.fields.occupancy_grid import OccupancyGrid, load_occupancy_grid
from kit.fields.planner import CostToGo, VehicleSize
from kit.fields.trajectory import ComfortLimits, Trajectory, plan_trajectory
from kit.geometry import Pose, wrap_angle
from kit.plain_text import suggestion
from kit.world.records import Model, World

WALL_MARGIN: Final = 0.01
"""m that a robot keeps from walls at least."""
PAIR_GAP: Final = 0.3
"""m between two robots side by side; the dissertation's."""
MAX_START_ANGLE: Final = 0.5
"""rad: so far off they may face another way, or stand behind one another, and still count as side by side."""


@dataclass(frozen=True, slots=True)
class DrivenRobot:
    name: str
    odometry: str
    """The topic that says where it is."""
    commands: str
    """The topic that drives it."""
    contacts: str | None
    """The topic that says what touches it, if anything does."""
    reach: float
    """From its origin to its farthest point [m]."""
    half_width: float
    """m"""


@dataclass(frozen=True)
class ControllerSetup:
    """One task for the first two robots of a world, or for one."""

    grid: OccupancyGrid
    layout: ChargeLayout
    robots: tuple[DrivenRobot, ...]
    target: tuple[float, float]
    target_radius: float = 0.25

    @classmethod
    def load(
        cls,
        world_file: Path,
        models: Sequence[str],
        target: tuple[float, float],
        target_radius: float = 0.25,
        *,
        derived: bool = False,
        charges: Path | None = None,
    ) -> ControllerSetup:
        """Loads the setup for the first two of ``models``, the left one first. ``derived``: do not use the charges drawn by hand.
        ``charges``: a charge file to use instead of the world's own.

        Raises WorldError for a wrong file, ValueError for a world without walls, LookupError for a missing model.
        """
        world, grid = load_occupancy_grid(world_file)
        if charges is not None:
            layout = read_layout(charges, grid)
        else:
            layout = derived_layout(grid) if derived else load_layout(world_file, grid)
        robots = tuple(_driven_robot(_find_model(world, name)) for name in models[:2])
        return cls(grid, layout, robots, target, target_radius)

    @cached_property
    def flow(self) -> ForceFlow:
        """Computes where the charges' forces lead from every cell of the grid."""
        return ForceFlow.from_layout(self.layout, self.grid, self.target, self.target_radius)

    @property
    def vehicle_size(self) -> VehicleSize:
        reach = max(robot.reach for robot in self.robots) + WALL_MARGIN
        if len(self.robots) == 1:
            return VehicleSize(reach, reach, f"the robot {self.robots[0].name}")
        width = PAIR_GAP / 2 + max(robot.half_width for robot in self.robots) + WALL_MARGIN
        return VehicleSize(max(width, reach), reach, "two robots side by side")

    def cost_to_go(self, start: tuple[float, float]) -> CostToGo:
        """Ways to the target. Raises Unreachable if none leads there from ``start``."""
        ways = CostToGo.compute(self.grid, self.target, self.vehicle_size, start)
        ways.check_reachable(start)
        return ways

    def plan_trajectory(self, poses: Sequence[Pose], limits: ComfortLimits = ComfortLimits()) -> Trajectory:
        """Plans a trajectory from the robots' poses to the target. Raises Unreachable."""
        start = mean_position(poses)
        way = self.cost_to_go(start).plan_path(start, _common_heading(poses))
        return plan_trajectory(way, poses, PAIR_GAP, limits)

    def layout_differences(self) -> tuple[str, ...]:
        """Describes each difference between the layout and the one derived from the walls."""
        return (
            layout_differences(self.layout.charges, derive_charges(self.grid)) if self.layout.source else ()
        )


def mean_position(poses: Sequence[Pose]) -> tuple[float, float]:
    return (
        math.fsum(pose.x for pose in poses) / len(poses),
        math.fsum(pose.y for pose in poses) / len(poses),
    )


def _common_heading(poses: Sequence[Pose]) -> float | None:
    """The heading of robots that stand side by side; None for others, and for one alone, which turns on the spot."""
    if len(poses) == 1:
        return None
    left, right = poses
    apart = wrap_angle(right.theta - left.theta)
    heading = left.theta + 0.5 * apart
    abeam = wrap_angle(math.atan2(left.y - right.y, left.x - right.x) - math.pi / 2 - heading)
    return heading if max(abs(apart), abs(abeam)) <= MAX_START_ANGLE else None


def _find_model(world: World, name: str) -> Model:
    for model in world.models:
        if model.name == name:
            return model
    names = [model.name for model in world.models]
    raise LookupError(f"{world.file}: it has no model {name} to drive: {suggestion(name, names)}")


def _driven_robot(model: Model) -> DrivenRobot:
    drive = next((plugin for plugin in model.plugins if plugin.type == "DiffDrive"), None)
    if drive is None or not isinstance(drive.params, Mapping):
        raise LookupError(f"{model.file}: {model.name} has no DiffDrive plugin, so it cannot be driven.")
    bumper = next((plugin for plugin in model.plugins if plugin.type == "Bumper"), None)
    touched = (
        str(bumper.params.get("topic", "collisions"))
        if bumper and isinstance(bumper.params, Mapping)
        else None
    )
    points = model.outer_points
    return DrivenRobot(
        model.name,
        odometry=model.topic(str(drive.params.get("odom_pub", "odometry/filtered"))),
        commands=model.topic(str(drive.params.get("twist_sub", "cmd_vel"))),
        contacts=None if touched is None else model.topic(touched),
        reach=max((math.hypot(x, y) + radius for x, y, radius in points), default=0.0),
        half_width=max((abs(y) + radius for _, y, radius in points), default=0.0),
    )
