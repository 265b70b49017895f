"""One step of worlds, the states before and after it: what rewards are computed from and goals are counted by."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, Protocol, TypeAlias

import numpy as np

from kit.fields.adjacency import SIDE_RAYS, adjacency_score, is_adjacent_by_rays
from kit.geometry import wrap_angle
from kit.learning.maps.ray_directions import AHEAD_RAY, LEFT_RAYS, RIGHT_RAYS

Array: TypeAlias = Any
"""A numpy array; for one world, where nothing is left of its shape, numpy's number."""

FAR = 100.0
"""Distance [m] to what is not there."""
NO_MOVE = -1
DIAGONAL_RAYS = 2
"""Number of rays (4 degrees each) beside straight ahead."""


class StateView(Protocol):
    """The state of worlds before or after a step, as far as rewards and goals may depend on it. Shapes as in ``Transition``."""

    @property
    def case(self) -> Array:
        """(...) int"""

    @property
    def step(self) -> Array:
        """(...) int: steps of this episode so far."""

    @property
    def pose(self) -> Array:
        """(..., R, 3) ``x y theta``"""

    @property
    def hit(self) -> Array:
        """(..., R) bool: who met a wall or another robot in the last step."""

    @property
    def in_target(self) -> Array:
        """(..., R) bool"""

    @property
    def to_go(self) -> Array:
        """(..., R)"""

    @property
    def rotation(self) -> Array:
        """(..., R) since the robot last turned to the other side."""

    @property
    def ranges(self) -> Array:
        """(..., R, 91) of the last step; meaningless before the first."""

    @property
    def move(self) -> Array:
        """(..., R) int: that of the last step, NO_MOVE before the first."""

    @property
    def twist(self) -> Array:
        """(..., R, 2) forward and turn, of the last step."""

    @property
    def forward_steps(self) -> Array:
        """(..., R)"""

    @property
    def target(self) -> Array:
        """(..., 2)"""

    @property
    def target_heading(self) -> Array:
        """(...)"""

    @property
    def obstacle_distance(self) -> Array:
        """(..., R)"""

    @property
    def count(self) -> Array:
        """(...) how much of the goal is achieved, in the goal's own unit."""

    @property
    def achieved(self) -> Array:
        """(...) the share of the goal."""


@dataclass(frozen=True, slots=True, eq=False)
class EpisodeState:
    """A ``StateView`` by itself, for transitions that come from elsewhere than the batch engine."""

    case: Array
    step: Array
    pose: Array
    hit: Array
    in_target: Array
    to_go: Array
    rotation: Array
    ranges: Array
    move: Array
    twist: Array
    forward_steps: Array
    target: Array
    target_heading: Array
    obstacle_distance: Array
    count: Array
    achieved: Array

    @classmethod
    def of(cls, state: StateView) -> EpisodeState:
        """What is seen of a state; ``replace`` then changes it."""
        return cls(*(getattr(state, field.name) for field in fields(cls)))

    def select(self, index: Any) -> EpisodeState:
        """The state of one world, or of some, out of many."""
        return EpisodeState(*(getattr(self, field.name)[index] for field in fields(self)))


@dataclass(frozen=True, eq=False)
class Transition:
    """One step: everything that a reward may depend on. Metres, seconds, radians.

    Shapes: ``...`` is ``()`` for one world and ``(n,)`` for many; R is the number of robots, the left one first.
    """

    before: StateView
    after: StateView
    max_steps: int
    """Steps after which an episode is over."""
    collision_ends: bool = True
    """Whether a collision ends the episode."""

    @property
    def case(self) -> Array:
        """(...) int: number of the case."""
        return self.after.case

    @property
    def step(self) -> Array:
        """(...) int: steps of this episode, this one included."""
        return self.after.step

    @property
    def hit(self) -> Array:
        """(..., R) bool: who met a wall or the other robot."""
        return self.after.hit

    @property
    def in_target(self) -> Array:
        """(..., R) bool: who is in the target."""
        return self.after.in_target

    @property
    def was_in_target(self) -> Array:
        """(..., R) bool: who was in the target before the step."""
        return self.before.in_target

    @property
    def move(self) -> Array:
        """(..., R) int: what each robot did: 0 nothing, 1 forward, 2 back, 3 left, 4 right, 5 forward_left, 6 forward_right."""
        return self.after.move

    @property
    def previous_move(self) -> Array:
        """(..., R) int: what each robot did the step before; -1 in the first."""
        return self.before.move

    @property
    def pose(self) -> Array:
        """(..., R, 3) ``x y theta``"""
        return self.after.pose

    @property
    def previous_pose(self) -> Array:
        """(..., R, 3) ``x y theta`` before the step."""
        return self.before.pose

    @property
    def target(self) -> Array:
        """(..., 2) ``x y``"""
        return self.after.target

    @property
    def to_go(self) -> Array:
        """(..., R) to the target's usual place, along the shortest way that keeps clear of walls."""
        return self.after.to_go

    @property
    def previous_to_go(self) -> Array:
        """(..., R) the same before the step."""
        return self.before.to_go

    @cached_property
    def full_turns(self) -> Array:
        """(..., R) int: whole turns, without ever turning to the other side."""
        return _whole_turns(self.after.rotation)

    @cached_property
    def previous_full_turns(self) -> Array:
        """(..., R) int: whole turns before the step."""
        return _whole_turns(self.before.rotation)

    @property
    def forward_steps(self) -> Array:
        """(..., R) steps forward in this episode, this one included; one along a curve counts half."""
        return self.after.forward_steps

    @property
    def ranges(self) -> Array:
        """(..., R, 91) what each robot's lidar reads, as far as the agent sees."""
        return self.after.ranges

    @property
    def twist(self) -> Array:
        """(..., R, 2) what the action asked for: forward [m/s] and turn [rad/s]."""
        return self.after.twist

    @property
    def target_heading(self) -> Array:
        """(...) of the target, where the goal asks for one; else 0."""
        return self.after.target_heading

    @property
    def obstacle_distance(self) -> Array:
        """(..., R) to the middle of the nearest thing that is neither wall nor robot, such as a cart; 100 where there is none."""
        return self.after.obstacle_distance

    @property
    def achieved(self) -> Array:
        """(...) share of the goal that is achieved; 1 and more where it is reached."""
        return self.after.achieved

    @property
    def previous_achieved(self) -> Array:
        """(...) share of the goal that was achieved before the step."""
        return self.before.achieved

    @property
    def robots(self) -> int:
        """How many robots there are."""
        return int(self.hit.shape[-1])

    @cached_property
    def collided(self) -> Array:
        """(...) bool: a robot has met a wall or another robot."""
        return self.hit[..., 0] if self.robots == 1 else self.hit.any(axis=-1)

    @cached_property
    def reached(self) -> Array:
        """(...) bool: the goal is reached, and no robot has collided."""
        return (self.achieved >= 1.0) & ~self.collided

    @cached_property
    def timed_out(self) -> Array:
        """(...) bool: that was the last step, and the goal is not reached."""
        return (self.step >= self.max_steps) & ~self.crashed & ~self.reached

    @cached_property
    def ended(self) -> Array:
        """(...) bool: the episode is over: goal reached, collision or time."""
        return self.crashed | self.reached | (self.step >= self.max_steps)

    @cached_property
    def crashed(self) -> Array:
        """(...) bool: a collision has ended the episode."""
        return self.collided if self.collision_ends else np.zeros_like(self.collided)

    @cached_property
    def front(self) -> Array:
        """(..., R) range straight ahead."""
        return self.ranges[..., AHEAD_RAY]

    @cached_property
    def front_left(self) -> Array:
        """(..., R) range 8 degrees to the left of ahead."""
        return self.ranges[..., AHEAD_RAY + DIAGONAL_RAYS]

    @cached_property
    def front_right(self) -> Array:
        """(..., R) range 8 degrees to the right of ahead."""
        return self.ranges[..., AHEAD_RAY - DIAGONAL_RAYS]

    @cached_property
    def nearest(self) -> Array:
        """(..., R) the shortest range of all."""
        return self.ranges.min(axis=-1)

    @cached_property
    def distance(self) -> Array:
        """(..., R) from the middle of the robot's axle to the target."""
        return distance_to_target(self.pose, self.target)

    @cached_property
    def previous_distance(self) -> Array:
        """(..., R) ``distance`` before the step."""
        return distance_to_target(self.previous_pose, self.target)

    @cached_property
    def bearing(self) -> Array:
        """(..., R) of the target, from straight ahead, to the left positive, in [-pi, pi)."""
        return bearing_of_target(self.pose, self.target)

    @cached_property
    def previous_bearing(self) -> Array:
        """(..., R) ``bearing`` before the step."""
        return bearing_of_target(self.previous_pose, self.target)

    @cached_property
    def beside_left(self) -> Array:
        """(..., R) the shortest range to the left, 60 to 120 degrees from ahead."""
        return self.ranges[..., list(LEFT_RAYS)].min(axis=-1)

    @cached_property
    def beside_right(self) -> Array:
        """(..., R) the shortest range to the right."""
        return self.ranges[..., list(RIGHT_RAYS)].min(axis=-1)

    @cached_property
    def misalignment(self) -> Array:
        """(..., R) between the robot's heading and the target's, 0 to pi."""
        return np.abs(wrap_angle(self.pose[..., 2] - self.target_heading[..., None]))

    @cached_property
    def adjacent(self) -> Array:
        """(...) bool: two robots side by side, as four rays tell (dissertation, equations 4.7 to 4.9). Walls can
        look the same. False for one robot."""
        if self.robots == 1:
            return np.zeros(np.shape(self.step), dtype=np.bool_)
        left, right = self.ranges[..., 0, list(SIDE_RAYS[0])], self.ranges[..., 1, list(SIDE_RAYS[1])]
        return is_adjacent_by_rays(left, right)

    @cached_property
    def abreast(self) -> Array:
        """(...) how well two robots stand side by side by their poses, 0 to 1: 1 where each is straight abeam of the
        other and both face the same way. 0 for one robot."""
        if self.robots == 1:
            return np.zeros(np.shape(self.step))
        return adjacency_score(self.pose[..., 0, :], self.pose[..., 1, :])

    def select(self, index: Any) -> Transition:
        """The transition of one world, or of some, out of many."""
        before, after = (EpisodeState.of(state).select(index) for state in (self.before, self.after))
        return replace(self, before=before, after=after)


TRANSITION_FIELDS = tuple(
    sorted(
        {field.name for field in fields(Transition) if field.name not in ("before", "after")}
        | {name for name, value in vars(Transition).items() if isinstance(value, property | cached_property)}
    )
)
"""Everything that a transition tells, by name."""


def _whole_turns(rotation: Array) -> Array:
    """(..., R) int"""
    return (np.abs(rotation) / (2.0 * math.pi)).astype(np.int64)


def distance_to_target(pose: Array, target: Array) -> Array:
    """(..., R) from poses (..., R, 3) to targets (..., 2) [m]."""
    return np.hypot(target[..., None, 0] - pose[..., 0], target[..., None, 1] - pose[..., 1])


def bearing_of_target(pose: Array, target: Array) -> Array:
    """(..., R) of targets (..., 2), from ahead of poses (..., R, 3), in [-pi, pi)."""
    dx, dy = target[..., None, 0] - pose[..., 0], target[..., None, 1] - pose[..., 1]
    return wrap_angle(np.arctan2(dy, dx) - pose[..., 2])


def average_speeds(before: Array, after: Array, seconds: float) -> Array:
    """(..., 2) forward [m/s] and turn [rad/s] that led from one pose (..., 3) to the other in this many seconds."""
    (dx, dy, turn), middle = np.moveaxis(after - before, -1, 0), 0.5 * (before[..., 2] + after[..., 2])
    forward = dx * np.cos(middle) + dy * np.sin(middle)
    return np.stack([forward, turn], axis=-1) / seconds
