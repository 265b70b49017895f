"""Walls that are elsewhere in every run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kit.arrays import FloatArray
from kit.plain_text import quoted
from kit.sim.physics import WallBody
from kit.sim.plugin import Plugin, WorldPluginContext, WorldPluginType
from kit.sim.plugin_clock import RandomStream
from kit.world.plugin_reader import WorldScope
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class RandomWallParams:
    layer: str
    """Any of its names."""
    robot: str
    count: int
    distance: float
    both_sides: bool

    def build(self, context: WorldPluginContext) -> RandomWall:
        return RandomWall(self, context)


def read_params(section: Section, scope: WorldScope) -> RandomWallParams:
    layer = scope.layer(section, "layer")
    count = section.integer("num_of_walls", 0, minimum=0)
    walls = next((entry.walls for entry in scope.layers if layer in entry.names), None)
    available = 0 if walls is None else len(walls.local_segments)
    if count > available:
        section.error(f"the layer {quoted(layer)} has {available} wall segments, not {count}", "num_of_walls")
    return RandomWallParams(
        layer=layer,
        robot=scope.model(section, "robot_name"),
        count=count,
        distance=section.number("wall_wall_dist", 1.0, above=0),
        both_sides=section.flag("double_wall", False),
    )


class RandomWall(Plugin):
    """Makes some walls of a layer thicker: copies wall segments that it chooses at random, at a distance from the
    original towards a robot's first place, and closes the ends. A plugin of the world.

    ============== =========================================
    layer          the layer whose walls are chosen and grow
    robot_name     the model on whose side the copies stand
    num_of_walls   how many segments are chosen
    wall_wall_dist from the original to the copy [m]
    double_wall    whether to put a copy on both sides
    ============== =========================================

    The seed of the simulation chooses, where Flatland asks the clock.
    """

    def __init__(self, params: RandomWallParams, context: WorldPluginContext) -> None:
        self._params = params
        self._physics = context.physics
        self._layer = next(layer for layer in context.world.layers if params.layer in layer.names)
        self._robot_pose = next(model.pose for model in context.world.models if model.name == params.robot)
        self._added_wall: WallBody | None = None

    def reset(self, seed: int) -> None:
        if self._added_wall is not None:
            self._physics.remove_wall(self._added_wall)
            self._added_wall = None
        if self._layer.walls is None or not self._params.count:
            return
        noise = RandomStream(seed)
        segments = self._layer.walls.segments
        order = sorted(range(len(segments)), key=noise.uniform)
        chosen = segments[sorted(order[: self._params.count])]
        sides = (1.0, -1.0) if self._params.both_sides else (1.0,)
        added = np.concatenate(
            [self._thickening_segments(segment, side) for segment in chosen for side in sides]
        )
        self._added_wall = self._physics.add_wall(self._layer.name, self._layer.bits, added)

    def _thickening_segments(self, segment: FloatArray, side: float) -> FloatArray:
        """(3, 4): the copy of a segment, and the two that close the ends. ``side`` 1 is the robot's."""
        a, b = segment[:2], segment[2:]
        along = (b - a) / max(np.hypot(*(b - a)), 1e-12)  # a .dat file may hold a point
        across = np.array([-along[1], along[0]])
        if across @ (np.array([self._robot_pose.x, self._robot_pose.y]) - a) < 0:
            across = -across
        shift = side * self._params.distance * across
        return np.array([[*a, *(a + shift)], [*(a + shift), *(b + shift)], [*(b + shift), *b]])


PLUGIN_TYPE = WorldPluginType(
    "RandomWall", RandomWall, read_params, example="layer: walls\nrobot_name: robot"
)
