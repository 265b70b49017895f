"""The state of many worlds of one task, and the results of their steps, as arrays."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from kit.arrays import BoolArray, Float32Array, FloatArray, IntArray
from kit.kernels.arrays import RobotStates
from kit.learning.environment.disturbance_state import DisturbanceState
from kit.learning.maps.ray_directions import RAY_COUNT
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.transition import FAR, NO_MOVE, Array, Transition


@dataclass(slots=True, eq=False)
class BatchState:
    """The state of ``n`` worlds with r robots each. A step makes a new one; only the beginning of episodes writes into its
    arrays, and then into copies."""

    robots: RobotStates
    episode: IntArray
    """(n,)"""
    case: IntArray
    """(n,)"""
    target_row: IntArray
    """(n,) the target's number among those of all cases."""
    phase: FloatArray
    """(n,) 0 to 1: where on their ways moving models began."""
    target: FloatArray
    """(n, 2)"""
    target_heading: FloatArray
    """(n,) of the target, where the goal asks for one; else 0."""
    step: IntArray
    """(n,) steps of this episode so far."""
    forward_steps: FloatArray
    """(n, r)"""
    move: IntArray
    """(n, r) the last one, NO_MOVE at the start."""
    twist: FloatArray
    """(n, r, 2) what the last action asked for, forward [m/s] and turn [rad/s]; 0 at the start."""
    speed: FloatArray
    """(n, r, 2) how fast the robots really moved in the last step; only where agents are told."""
    frames: Float32Array
    """(n, frames - 1, size): what agents saw before, where they see more than one frame."""
    obstacle_distance: FloatArray
    """(n, r)"""
    count: FloatArray
    """(n,) how much of the goal is achieved, in the goal's own unit."""
    achieved: FloatArray
    """(n,) the share of the goal."""
    told_achieved: FloatArray
    """(n,) the same as agents are told."""
    disturbed: DisturbanceState

    @property
    def pose(self) -> FloatArray:
        """(n, r, 3)"""
        return self.robots.pose

    @property
    def hit(self) -> BoolArray:
        """(n, r)"""
        return self.robots.hit

    @property
    def to_go(self) -> FloatArray:
        """(n, r)"""
        return self.robots.to_go

    @property
    def in_target(self) -> BoolArray:
        """(n, r)"""
        return self.robots.in_target

    @property
    def rotation(self) -> FloatArray:
        """(n, r)"""
        return self.robots.rotation

    @property
    def ranges(self) -> Float32Array:
        """(n, r, 91)"""
        return self.robots.ranges[:, :, :RAY_COUNT]

    @classmethod
    def allocate(cls, task: LearningTask, robots: RobotStates) -> BatchState:
        """The state of worlds of a task with these robots, all zero, without a last move."""
        n, r = shape = robots.hit.shape
        seen = task.observation
        for array in robots:
            array[:] = 0
        return cls(
            robots,
            episode=np.zeros(n, dtype=np.int64),
            case=np.zeros(n, dtype=np.int64),
            target_row=np.zeros(n, dtype=np.int64),
            phase=np.zeros(n),
            target=np.zeros((n, 2)),
            target_heading=np.zeros(n),
            step=np.zeros(n, dtype=np.int64),
            forward_steps=np.zeros(shape),
            move=np.full(shape, NO_MOVE, dtype=np.int64),
            twist=np.zeros((*shape, 2)),
            speed=np.zeros((*shape, 2)),
            frames=np.zeros((n, seen.frames - 1, r * seen.frame_size), dtype=np.float32),
            obstacle_distance=np.full(shape, FAR),
            count=np.zeros(n),
            achieved=np.zeros(n),
            told_achieved=np.zeros(n),
            disturbed=DisturbanceState.allocate(task, n),
        )

    def copy(self) -> BatchState:
        """A copy of the arrays that beginning an episode writes into; the others are shared."""
        robots = self.robots
        return BatchState(
            robots._replace(
                pose=robots.pose.copy(),
                clearance=robots.clearance.copy(),
                to_go=robots.to_go.copy(),
                in_target=robots.in_target.copy(),
                rotation=robots.rotation.copy(),
            ),
            episode=self.episode.copy(),
            case=self.case.copy(),
            target_row=self.target_row.copy(),
            phase=self.phase.copy(),
            target=self.target.copy(),
            target_heading=self.target_heading.copy(),
            step=self.step.copy(),
            forward_steps=self.forward_steps.copy(),
            move=self.move.copy(),
            twist=self.twist.copy(),
            speed=self.speed.copy(),
            frames=self.frames,  # is replaced
            obstacle_distance=self.obstacle_distance,  # of which nothing is seen before the first step
            count=self.count.copy(),
            achieved=self.achieved.copy(),
            told_achieved=self.told_achieved.copy(),
            disturbed=self.disturbed.copy(),
        )

    def changed(self, **changes: Any) -> BatchState:
        """A copy with other values of some fields, as ``dataclasses.replace``, which takes three times as long."""
        return BatchState(*[changes[name] if name in changes else getattr(self, name) for name in FIELDS])


FIELDS = tuple(field.name for field in fields(BatchState))


@dataclass(frozen=True, slots=True, eq=False)
class BatchStep:
    """The results of one step of all worlds. A world whose episode has ended is in its next one already.

    The arrays are the caller's to keep.
    """

    observations: Float32Array
    """(n, size): of the running episodes."""
    rewards: Float32Array
    """(n,)"""
    terminated: BoolArray
    """(n,)"""
    truncated: BoolArray
    """(n,)"""
    last_observations: Float32Array
    """(m, size): what was seen at the end of the m episodes that have ended, before the resets."""
    transition: Transition
    """The transitions of n worlds, before the reset."""
    terms: dict[str, Array]
    """(n,) each: the reward by named term; empty for a student's reward."""

    @property
    def ended(self) -> BoolArray:
        """(n,)"""
        return self.terminated | self.truncated

    def final_observations(self) -> Float32Array:
        """(n, size): what was seen before the resets; ``observations`` where nothing has ended."""
        found = self.observations.copy()
        found[self.transition.ended] = self.last_observations
        return found
