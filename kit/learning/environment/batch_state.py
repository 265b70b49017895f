"""The state of many worlds of one task, and the results of their steps, as arrays."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from kit.learning.environment.disturbance_state import DisturbanceState
from kit.learning.environment.tasks import LearningTask
from kit.learning.environment.transition import Array, Transition

FloatArray = NDArray[np.float64]
SingleArray = NDArray[np.float32]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

NO_MOVE = -1
TRANSITION_ARRAYS = (
    "case",
    "target",
    "step",
    "pose",
    "to_go",
    "forward_steps",
    "move",
    "twist",
    "in_target",
    "count",
)
"""Those that a transition shows as they are: its receiver may keep them."""


@dataclass(slots=True, eq=False)
class BatchState:
    """The state of ``n`` worlds with r robots each. A step makes a new one; only a reset writes into it."""

    episode: IntArray
    """(n,)"""
    case: IntArray
    """(n,)"""
    target: FloatArray
    """(n, 2)"""
    step: IntArray
    """(n,) steps of this episode so far."""
    pose: FloatArray
    """(n, r, 3)"""
    clearance: FloatArray
    """(n, r): no wall is nearer [m], for sure; 0 where unknown."""
    to_go: FloatArray
    """(n, r)"""
    rotation: FloatArray
    """(n, r) rad, since the robot last turned to the other side."""
    forward_steps: FloatArray
    """(n, r)"""
    move: IntArray
    """(n, r) the last one, NO_MOVE at the start."""
    twist: FloatArray
    """(n, r, 2) what the last action asked for, forward [m/s] and turn [rad/s]; 0 at the start."""
    speed: FloatArray
    """(n, r, 2) how fast the robots really moved in the last step; only where agents are told."""
    frames: SingleArray
    """(n, frames - 1, size): what agents saw before, where they see more than one frame."""
    in_target: BoolArray
    """(n, r)"""
    target_row: IntArray
    """(n,) the target's number among those of all cases."""
    phase: FloatArray
    """(n,) 0 to 1: where on their ways moving models began."""
    count: FloatArray
    """(n,) how much of the goal is achieved, in the goal's own unit."""
    covered: BoolArray
    """(n, rows, columns): the cells that have been covered, where the goal is to cover."""
    disturbed: DisturbanceState

    @classmethod
    def allocate(cls, task: LearningTask, n: int, covered_shape: tuple[int, int] = (0, 0)) -> BatchState:
        """Arrays for ``n`` worlds of a task, all zero, without a last move."""
        robots, seen = task.robots, task.observation
        shape = n, robots
        return cls(
            episode=np.zeros(n, dtype=np.int64),
            case=np.zeros(n, dtype=np.int64),
            target=np.zeros((n, 2)),
            step=np.zeros(n, dtype=np.int64),
            pose=np.zeros((n, robots, 3)),
            clearance=np.zeros(shape),
            to_go=np.zeros(shape),
            rotation=np.zeros(shape),
            forward_steps=np.zeros(shape),
            move=np.full(shape, NO_MOVE, dtype=np.int64),
            twist=np.zeros((*shape, 2)),
            speed=np.zeros((*shape, 2)),
            frames=np.zeros((n, seen.frames - 1, robots * seen.frame_size), dtype=np.float32),
            in_target=np.zeros(shape, dtype=np.bool_),
            target_row=np.zeros(n, dtype=np.int64),
            phase=np.zeros(n),
            count=np.zeros(n),
            covered=np.zeros((n, *covered_shape), dtype=np.bool_),
            disturbed=DisturbanceState.allocate(task, n),
        )

    def copy(self) -> BatchState:
        return BatchState(*(getattr(self, field.name).copy() for field in fields(self)))

    def unshare_arrays(self) -> None:
        """Replaces the arrays that the last transition shows by copies, so that they can be written to."""
        for name in TRANSITION_ARRAYS:
            setattr(self, name, getattr(self, name).copy())


@dataclass(frozen=True, slots=True, eq=False)
class BatchStep:
    """The results of one step of all worlds. A world whose episode has ended is in its next one already.

    The arrays are the caller's to keep.
    """

    observations: SingleArray
    """(n, size): of the running episodes."""
    rewards: SingleArray
    """(n,)"""
    terminated: BoolArray
    """(n,)"""
    truncated: BoolArray
    """(n,)"""
    final_observations: SingleArray
    """(n, size): what was seen before the reset; equal to ``observations`` where nothing has ended."""
    transition: Transition
    """The transitions of n worlds, before the reset."""
    terms: dict[str, Array]
    """(n,) each: the reward by named term; empty for a student's reward."""

    @property
    def ended(self) -> BoolArray:
        """(n,)"""
        return self.terminated | self.truncated
