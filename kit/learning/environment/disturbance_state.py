"""What differs from the robots' files in each of many worlds: noise, late commands, slow motors, wheels."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from kit.arrays import FloatArray, IntArray
from kit.kernels import world_kernels
from kit.kernels.arrays import StepMoves
from kit.learning.tasks.disturbances import TURN_SHARE
from kit.learning.tasks.learning_task import LearningTask
from kit.sim.simulation import STEP_SIZE_S

SHARED_KINDS = ("lidar_noise", "dropped_rays", "latency", "command_jitter")
"""Drawn once for all robots of a world."""
WHEEL_KINDS = ("wheel_radius", "drift")
"""Drawn for each robot."""


@dataclass(frozen=True, slots=True, eq=False)
class DisturbanceState:
    """The disturbances of ``n`` worlds with r robots each, in their present episodes. Only ``begin`` writes into it."""

    task: LearningTask
    shared: FloatArray
    """(n, 4): the values of SHARED_KINDS."""
    wheels: FloatArray
    """(n, r, 2): those of WHEEL_KINDS."""
    commands: FloatArray
    """(n, depth, r, 2): twists at the wheels, the newest first. All that are older than the last one are in the past."""
    due: FloatArray
    """(n, depth, r): in how many seconds each takes effect; at most 0 where it has already."""
    inertia: FloatArray
    """(n,) s per m/s; of all robots of a world."""
    driven: FloatArray
    """(n, r, 2): forward [m/s] and turn [rad/s] of the motors at the end of the last step; 0 without inertia."""
    is_any: bool
    """Whether the task has disturbances; asked of it in every step, that would cost as much as a kernel."""

    @classmethod
    def allocate(cls, task: LearningTask, n: int) -> DisturbanceState:
        """Arrays for ``n`` worlds, all zero."""
        depth = 1 + math.ceil(task.disturbances.longest_delay / task.step_time - 1e-9)
        return cls(
            task,
            shared=np.zeros((n, len(SHARED_KINDS))),
            wheels=np.zeros((n, task.robots, len(WHEEL_KINDS))),
            commands=np.zeros((n, depth, task.robots, 2)),
            due=np.zeros((n, depth, task.robots)),
            inertia=np.zeros(n),
            driven=np.zeros((n, task.robots, 2)),
            is_any=bool(task.disturbances),
        )

    def copy(self) -> DisturbanceState:
        """A copy into which ``begin`` may write."""
        if not self.is_any:
            return self
        return replace(
            self,
            shared=self.shared.copy(),
            wheels=self.wheels.copy(),
            commands=self.commands.copy(),
            due=self.due.copy(),
            inertia=self.inertia.copy(),
            driven=self.driven.copy(),
        )

    def begin(self, which: IntArray, keys: IntArray, first: IntArray) -> None:
        """Draws the disturbances of new episodes in the worlds ``which`` (m), whose robots stand.

        World ``which[i]`` takes number ``first[i]`` and following of ``keys[i]``.
        """
        if not self.is_any:
            return
        disturbances, robots, shared = self.task.disturbances, self.task.robots, len(SHARED_KINDS)
        kinds = (*SHARED_KINDS, *WHEEL_KINDS * robots, "inertia")
        drawn = np.empty((len(which), len(kinds)))
        world_kernels.fill_uniform(keys, first, drawn)
        low, high = np.array([disturbances.range_of(kind) for kind in kinds]).T
        drawn = low + drawn * (high - low)
        self.shared[which] = drawn[:, :shared]
        self.wheels[which] = drawn[:, shared:-1].reshape(len(which), robots, len(WHEEL_KINDS))
        self.inertia[which] = drawn[:, -1]
        self.driven[which] = 0.0
        self.commands[which] = 0.0
        self.due[which] = 0.0

    def after_command(self, twists: FloatArray, keys: IntArray, numbers: IntArray) -> DisturbanceState:
        """The state once ``twists`` (n, r, 2), forward [m/s] and turn [rad/s], are sent; a later command never
        overtakes an earlier one. The jitter of robot k is number ``numbers[i] + k`` of ``keys[i]``."""
        disturbances = self.task.disturbances
        if not self.is_any:
            return replace(self, commands=twists[:, None])
        factor = 1.0 + self.wheels[:, :, 0]
        forward, turn = twists[:, :, 0] * factor, twists[:, :, 1] * factor
        driven = np.stack([forward, turn + forward * self.wheels[:, :, 1]], axis=2)
        late = self.shared[:, 2, None]
        if disturbances.command_jitter.high > 0.0:
            drawn = np.empty((len(keys), self.task.robots))
            world_kernels.fill_uniform(keys, numbers, drawn)
            late = late + self.shared[:, 3, None] * drawn
        before, earlier = self.commands[:, :-1], self.due - self.task.step_time
        if self.task.stops_between:
            before = np.where(earlier[:, :-1, :, None] > 0.0, before, 0.0)
        due = np.maximum(late, earlier[:, 0])
        return replace(
            self,
            commands=np.concatenate([driven[:, None], before], axis=1),
            due=np.concatenate([due[:, None], earlier[:, :-1]], axis=1),
        )

    def moves(self, checks: int) -> tuple[DisturbanceState, StepMoves]:
        """The state after a step, and what the motors do during it: it has this many checks for collisions, one after each equal
        part of it."""
        length = self.task.step_time / checks
        twists, lasts, after, motors = [], [], [], self.driven
        for check in range(checks):
            parts = [
                (driven, seconds)
                for driven, seconds in self._twist_parts(check * length, length)
                if seconds.any()
            ]
            if self.task.disturbances.inertia.high > 0.0:
                parts = list(self._slow_parts(parts, motors, max(1, round(length / STEP_SIZE_S))))
                motors = parts[-1][0]
            twists += [driven for driven, _ in parts]
            lasts += [seconds for _, seconds in parts]
            after += [-1] * (len(parts) - 1) + [check]
        turn = np.zeros(twists[0].shape[:2])
        for driven, seconds in zip(twists, lasts, strict=True):
            turn += driven[:, :, 1] * seconds[:, None]
        moves = StepMoves(np.stack(twists), np.stack(lasts), np.arange(len(after)), np.array(after), turn)
        return replace(self, driven=motors), moves

    def _slow_parts(
        self, parts: Sequence[tuple[FloatArray, FloatArray]], motors: FloatArray, ticks: int
    ) -> Iterator[tuple[FloatArray, FloatArray]]:
        """The ``parts`` of a step in ``ticks`` each, as motors follow them that are at ``motors`` (n, r, 2): as
        ``kit.sim.motors.limited_speed``, where gaining and losing speed have one limit."""
        with np.errstate(divide="ignore"):
            limit = np.array([1.0, TURN_SHARE]) / self.inertia[:, None, None]
        for asked, seconds in parts:
            tick = seconds / ticks
            change = np.where(tick[:, None, None] > 0.0, limit, 0.0) * tick[:, None, None]
            for _ in range(ticks):
                motors = motors + np.clip(asked - motors, -change, change)
                yield motors, tick

    def _twist_parts(self, start: float, length: float) -> Iterator[tuple[FloatArray, FloatArray]]:
        """The twists (n, r, 2) of the parts of the ``length`` seconds after ``start``, one after the other, and how long each
        part takes (n,): in none of them does a robot change its command."""
        n, depth, robots = self.due.shape
        if depth == 1:
            yield self.commands[:, 0], np.full(n, length)
            return
        worlds, own = np.arange(n)[:, None], np.arange(robots)
        before = self.due[:, :-1]
        if not ((before > start) & (before < start + length)).any():  # nobody changes a command now
            newest: IntArray = (before > start).sum(axis=1)
            yield self.commands[worlds, newest, own], np.full(n, start + length - start)
            return
        end = np.full((n, 1), start + length)
        begins = np.clip(self.due, start, start + length)
        begins[:, -1] = start
        changes = np.sort(begins.reshape(n, -1), axis=1)
        seconds = np.diff(changes, axis=1, append=end)
        for place in range(changes.shape[1]):
            later: IntArray = (begins[:, :-1] > changes[:, place, None, None]).sum(axis=1)
            yield self.commands[worlds, later, own], seconds[:, place]

    def noise_std(self, usual: float, which: IntArray | slice) -> FloatArray:
        """(m,) standard deviation of the ranges [m] in the worlds ``which``, whose lidars' own is ``usual``."""
        return np.hypot(usual, self.shared[which, 0])

    def dropped(self, which: IntArray | slice) -> FloatArray:
        """(m,) the share of rays that read nothing."""
        return np.ascontiguousarray(self.shared[which, 1])
