"""What agents see of many worlds: the numbers of their scans with those of the rest of their observation."""

from __future__ import annotations

import numpy as np

from kit.arrays import Float32Array, IntArray
from kit.learning.environment.batch_state import BatchState
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.observations import MAX_COORDINATE, MAX_TARGET_DISTANCE
from kit.learning.tasks.transition import Array, bearing_of_target, distance_to_target


class AgentObservations:
    """Completes the observations of a task's agents."""

    def __init__(self, task: LearningTask) -> None:
        self._robots, self._scale = task.robots, task.observation.scale
        self._parts, self._frames = task.observation.part_slices(), task.observation.frames

    def complete(
        self, frame: Float32Array, state: BatchState, which: IntArray | slice, *, is_fresh: bool
    ) -> Float32Array:
        """(m, size) what agents see of the worlds ``which``: ``frame`` (m, robots, size), with what is not of their rays.

        ``is_fresh``: whether their episodes have just begun. Where agents see several frames, ``state`` keeps them.
        """
        for name, place in self._parts.items():
            frame[:, :, place] = self._part_values(name, state, which)
        flat = frame.reshape(len(frame), -1)
        return flat if self._frames == 1 else self._stack_frames(flat, state, which, is_fresh=is_fresh)

    def _part_values(self, name: str, state: BatchState, which: IntArray | slice) -> Array:
        """(m, robots, size) the numbers of one part of the observation."""
        pose, target, scale = state.pose[which], state.target[which], self._scale
        match name:
            case "target":
                distance = np.minimum(distance_to_target(pose, target), MAX_TARGET_DISTANCE) * scale
                return np.stack([distance, bearing_of_target(pose, target) / np.pi], axis=2)
            case "target_heading":
                off = state.target_heading[which][:, None] - pose[:, :, 2]
                return np.stack([np.cos(off), np.sin(off)], axis=2)
            case "achieved":
                share = np.minimum(state.told_achieved[which], 1.0)
                return np.repeat(share[:, None, None], self._robots, axis=1)
            case "arrived":
                return state.in_target[which][:, :, None]
            case "speeds":
                return state.speed[which]
            case "last_action":
                return state.twist[which]
            case "own_pose":
                place = np.clip(pose[:, :, :2], -MAX_COORDINATE, MAX_COORDINATE) * scale
                heading = pose[:, :, 2:]
                return np.concatenate([place, np.cos(heading), np.sin(heading)], axis=2)
            case _:
                raise AssertionError(name)  # a part without numbers is a mistake in this class

    def _stack_frames(
        self, frame: Float32Array, state: BatchState, which: IntArray | slice, *, is_fresh: bool
    ) -> Float32Array:
        """(m, frames * size) the last frames, the newest last; of a fresh episode all are its first one."""
        past = np.repeat(frame[:, None], self._frames - 1, axis=1) if is_fresh else state.frames[which]
        stack = np.concatenate([past, frame[:, None]], axis=1)
        kept = state.frames.copy()
        kept[which] = stack[:, 1:]
        state.frames = kept
        return stack.reshape(len(frame), -1)
