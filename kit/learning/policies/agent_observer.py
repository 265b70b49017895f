"""Follows an agent that drives in a world as a node: works out what its policy perceives there, and how it rates its actions."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from kit.geometry import wrap_angle
from kit.learning.environment.case_arrays import CaseArrays
from kit.learning.environment.observations import RAY_COUNT
from kit.learning.policies.agent_view import AgentView, ExpectedReturns, build_agent_view
from kit.learning.policies.policies import Policy, PolicyError, SingleArray
from kit.learning.policies.policy_node import NODE_PARTS, ray_angles
from kit.render.scene import FloatArray
from kit.run.lockstep import Observer
from kit.sim.simulation import Simulation
from kit.sim.state import LatestScan


class AgentObserver(Observer):
    """Reads the robots' lidars once in each step of the policy's, as its node does, in the world's thread.

    The node reads a scan when it arrives, so that its own reading may be one scan older or newer than what is told here.
    """

    def __init__(self, policy: Policy, models: Sequence[str], on_view: Callable[[AgentView], object]) -> None:
        """``models``: the robots that it drives, the left one of two first. ``on_view``: called with every new view.

        PolicyError if the policy perceives what a node does not know, or drives another number of robots.
        """
        task = policy.trained_on.resolve()
        policy.check_fits(task)
        unknown = [part.name for part in task.observation.parts if part.name not in NODE_PARTS]
        if unknown or task.robots != len(models):
            raise PolicyError(
                f"this policy drives {task.robots} robot{'s' if task.robots > 1 else ''}"
                + (f" and is told {', '.join(unknown)}" if unknown else "")
                + ": what it perceives here cannot be shown."
            )
        self._policy, self._task, self._models, self._on_view = policy, task, tuple(models), on_view
        self._angles = np.array(ray_angles(task))
        self._lidar_heading = CaseArrays(task).lidar.theta
        self._single, self._sectors = task.observation.ray_tables(task.robots)
        self._restart()

    def _restart(self) -> None:
        self._player = self._policy.make_player(1)
        self._expected = ExpectedReturns(self._policy)
        self._frames: list[SingleArray] = []
        self._last_twists: FloatArray = np.zeros((self._task.robots, 2))
        self._next_s = self._last_s = -math.inf

    def on_step(self, simulation: Simulation) -> None:
        now = simulation.time_ns / 1e9
        if now < self._last_s:  # the world has begun again
            self._restart()
        self._last_s = now
        if now < self._next_s - simulation.step_size / 2:
            return
        scans = {scan.model: scan for scan in reversed(simulation.latest_scans())}
        if all(model in scans for model in self._models):
            self._next_s = now + self._task.step_time
            self._look([scans[model] for model in self._models], simulation)

    def _look(self, scans: Sequence[LatestScan], simulation: Simulation) -> None:
        frame = np.concatenate(
            [self._observe(robot, scan, simulation) for robot, scan in enumerate(scans)]
        ).astype(np.float32)
        count = self._task.observation.frames
        self._frames = ([frame] * count if not self._frames else [*self._frames, frame])[-count:]
        observation = np.concatenate(self._frames)
        action = self._player.act(observation[None], np.zeros(1, dtype=np.bool_))
        self._expected.add(self._player, observation[None], action)
        self._last_twists = self._task.actions.commands(action, self._task.robots).twists[0]
        poses = np.array([scan.pose for scan in scans]) - (0.0, 0.0, self._lidar_heading)
        scores, expected = self._player.scores[0], self._expected.values
        self._on_view(build_agent_view(self._policy, self._task, observation, scores, poses, expected))

    def _observe(self, robot: int, scan: LatestScan, simulation: Simulation) -> FloatArray:
        """One robot's numbers: rays, sector minima, then the parts."""
        seen = self._task.observation
        ranges = self._known_ranges(scan)
        minima = [ranges[first:stop].min() for _, first, stop in self._sectors.tolist()]
        numbers = [*(ranges[self._single[robot]] * seen.scale), *(np.array(minima) * seen.scale)]
        for part in seen.parts:
            numbers += (
                self._speeds(robot, simulation)
                if part.name == "speeds"
                else self._last_twists[robot].tolist()
            )
        return np.array(numbers)

    def _known_ranges(self, scan: LatestScan) -> FloatArray:
        """(91,) [m] in the directions that the policy knows; as far as it sees where the lidar does not look."""
        clip = self._task.observation.clip
        angles = np.arctan2(scan.beams.sin, scan.beams.cos)
        apart = np.abs(np.angle(np.exp(1j * (angles[None, :] - self._angles[:, None]))))
        nearest = apart.argmin(axis=1)
        ranges = np.nan_to_num(scan.ranges.astype(np.float64), nan=clip, posinf=clip).clip(0.0, clip)[nearest]
        return np.where(apart.min(axis=1) <= math.tau / (RAY_COUNT - 1), ranges, clip)

    def _speeds(self, robot: int, simulation: Simulation) -> list[float]:
        """Forward [m/s] and turn rate [rad/s]."""
        state = next(each for each in simulation.state().bodies if each.model == self._models[robot])
        vx, vy, turn = state.velocity
        theta = wrap_angle(state.pose.theta)
        return [math.cos(theta) * vx + math.sin(theta) * vy, turn]
