"""Views of an agent: its observation at one step and its rating of each action, for screens that show it while it drives.

Follows an agent that drives in a world as a node: works out what its policy perceives there, and how it rates its actions.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal, NamedTuple

import numpy as np

from kit.arrays import Float32Array, FloatArray, IntArray
from kit.geometry import Pose
from kit.learning.environment.case_arrays import CaseArrays
from kit.learning.maps.ray_directions import LEFT_RAYS, ranges_in_directions, ray_direction
from kit.learning.policies.node_goals.goal_count import GoalProgress
from kit.learning.policies.policy import Policy, PolicyError, PolicyPlayer
from kit.learning.policies.policy_node import node_count, node_refusals, ray_angles
from kit.learning.tasks.actions import ContinuousActions, DiscreteActions
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.observations import MAX_COORDINATE, MAX_TARGET_DISTANCE, ObservationSpec
from kit.learning.tasks.transition import bearing_of_target, distance_to_target
from kit.plain_text import counted
from kit.render.scene import ScenePath
from kit.run.lockstep import Observer
from kit.sim.simulation import Simulation
from kit.sim.state import LatestScan

ARC_STEP = math.radians(4.0)
"""Between two points of a drawn arc [rad]."""

READING_NAMES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "target": ("target distance", "target rotation"),
        "arrived": ("arrived",),
        "speeds": ("speed", "turn rate"),
        "last_action": ("asked speed", "asked turn rate"),
        "own_pose": ("own x", "own y", "own heading cos", "own heading sin"),
        "target_heading": ("target head. cos", "target head. sin"),
        "achieved": ("achieved",),
    }
)
"""What each number of a part of the observation is called."""

RatingKind = Literal["probability", "value", "command"]


class RatedAction(NamedTuple):
    """One action, or one number of a continuous action."""

    name: str
    rating: float
    """Probability, value or command [m/s or rad/s], as ``AgentView.kind`` says."""
    share: float
    """Length of its bar, 0 to 1."""
    is_chosen: bool


@dataclass(frozen=True, slots=True, eq=False)
class AgentView:
    """What an agent perceives now, and what it makes of it."""

    kind: RatingKind
    """``probability`` of each action, its ``value`` (the return that is expected from it), or the ``command`` itself."""
    actions: tuple[RatedAction, ...]
    readings: tuple[tuple[str, float], ...]
    """What it perceives beside its scan, by name; of the first robot."""
    nearest: tuple[float, ...]
    """Shortest range that each robot gets [m]; inf without a scan."""
    sight: tuple[ScenePath, ...]
    """The scan as it perceives it: a line for each single ray, an arc for each sector; dotted where nothing is near."""
    expected_returns: tuple[float, ...] = ()
    """At every step of this episode so far, the discounted return that it expected from there on, the newest last; none where
    the policy does not say."""


class ExpectedReturns:
    """Notes at every step of an episode what return the agent expects from there on."""

    def __init__(self, policy: Policy) -> None:
        self._policy = policy
        self.values: list[float] = []
        """The newest last."""

    def add(self, player: PolicyPlayer, observations: Float32Array, actions: IntArray | Float32Array) -> None:
        """Notes the step of one world, in which ``player`` chose ``actions`` (1,) or (1, numbers)."""
        found = self._policy.expected_returns(observations, player.scores, actions)
        if found is not None:
            self.values.append(float(found[0]))


def build_agent_view(
    policy: Policy,
    task: LearningTask,
    observation: Float32Array,
    scores: Float32Array,
    poses: FloatArray,
    expected: Sequence[float] = (),
) -> AgentView:
    """What a policy perceives in one world.

    ``observation``: (size,). ``scores``: (outputs,), what the policy's model gave for it. ``poses``: (robots, 3) of the
    robots' lidars [m], and the robots' headings [rad]. ``expected``: what return it expected at each step so far.
    """
    seen, robots = task.observation, task.robots
    frame = observation[-seen.frame_size * robots :].reshape(robots, seen.frame_size)
    ranges = frame[:, : seen.scan_size] / seen.scale
    kind, actions = _rated_actions(policy, task, scores)
    return AgentView(
        kind,
        actions,
        tuple(
            (name, float(number))
            for part, place in seen.part_slices().items()
            for name, number in zip(READING_NAMES[part], frame[0, place], strict=True)
        ),
        tuple(float(row.min(initial=math.inf)) for row in ranges),
        tuple(
            path
            for robot in range(robots)
            for path in _seen_paths(seen, task, robot, ranges[robot], Pose(*poses[robot].tolist()))
        ),
        tuple(expected),
    )


def _seen_paths(
    seen: ObservationSpec, task: LearningTask, robot: int, ranges: Float32Array, pose: Pose
) -> list[ScenePath]:
    single, sectors = seen.ray_tables(task.robots)
    paths = []
    for ray, distance in zip(single[robot].tolist(), ranges.tolist(), strict=False):
        end = _ray_end(pose, ray_direction(ray), distance)
        paths.append(ScenePath(np.array([pose[:2], end]), "dotted" if distance >= seen.clip else "solid"))
    for (_, first, stop), distance in zip(sectors.tolist(), ranges[single.shape[1] :].tolist(), strict=False):
        start, end_angle = ray_direction(first), ray_direction(stop - 1)
        count = max(2, math.ceil((end_angle - start) / ARC_STEP) + 1)
        arc = [_ray_end(pose, angle, distance) for angle in np.linspace(start, end_angle, count).tolist()]
        paths.append(ScenePath(np.array(arc), "dotted" if distance >= seen.clip else "solid"))
    return paths


def _ray_end(pose: Pose, angle: float, distance: float) -> tuple[float, float]:
    return (
        pose.x + distance * math.cos(pose.theta + angle),
        pose.y + distance * math.sin(pose.theta + angle),
    )


def _rated_actions(
    policy: Policy, task: LearningTask, scores: Float32Array
) -> tuple[RatingKind, tuple[RatedAction, ...]]:
    actions = task.actions
    if isinstance(actions, ContinuousActions):
        return "command", _rated_commands(actions, task.robots, scores)
    names = _action_names(actions, task.robots)
    is_probability = policy.sampling.kind == "softmax"
    rated = []
    for part, part_names in zip(np.split(scores, np.cumsum(policy.choices)[:-1]), names, strict=True):
        if is_probability:
            powers = np.exp((part - part.max()) / policy.sampling.amount)
            ratings = powers / powers.sum()
            shares = ratings
        else:
            ratings = part
            low = float(part.min())
            shares = (part - low) / max(float(part.max()) - low, 1e-12)
        best = int(part.argmax())
        rated += [
            RatedAction(name, float(rating), float(share), number == best)
            for number, (name, rating, share) in enumerate(zip(part_names, ratings, shares, strict=True))
        ]
    return ("probability" if is_probability else "value"), tuple(rated)


def _action_names(actions: DiscreteActions, robots: int) -> list[list[str]]:
    """The names of all actions, for each number of an action."""
    if robots == 1:
        return [list(actions.names)]
    if actions.one_number:
        return [[" + ".join(each) for each in itertools.product(actions.names, repeat=robots)]]
    return [[f"{robot + 1} {name}" for name in actions.names] for robot in range(robots)]


def _rated_commands(actions: ContinuousActions, robots: int, scores: Float32Array) -> tuple[RatedAction, ...]:
    shares = np.clip(scores, -1.0, 1.0)
    twists = actions.commands(shares[None], robots).twists[0]
    return tuple(
        RatedAction(
            f"{robot + 1} {name}" if robots > 1 else name,
            float(twists[robot, place]),
            float(shares[2 * robot + place] + 1) / 2,
            True,
        )
        for robot in range(robots)
        for place, name in enumerate(("forward m/s", "turn rad/s"))
    )


class AgentObserver(Observer):
    """Reads the robots' lidars once in each step of the policy's, as its node does, in the world's thread.

    The node reads a scan when it arrives, so that its own reading may be one scan older or newer than what is told here.
    """

    def __init__(
        self,
        policy: Policy,
        models: Sequence[str],
        on_view: Callable[[AgentView], object],
        target: tuple[float, float] | None = None,
        *,
        route: Sequence[tuple[float, float]] = (),
        radius: float = 0.0,
        leader: str | None = None,
        heading: float = 0.0,
    ) -> None:
        """``models``: the robots that it drives, the left one of two first. ``on_view``: called with every new view.
        ``target``: of the world [m]. ``route``: all targets where there are several, one after the other, each reached within
        ``radius`` [m]. ``leader``: the model that is the target, where that moves. ``heading``: asked for at the target [rad].

        PolicyError if the policy perceives what a node does not know, or drives another number of robots.
        """
        task = policy.trained_on.resolve()
        policy.check_fits(task)
        unknown = list(node_refusals(task))
        if task.observation.target and target is None:
            unknown.append("agents see a target, and there is none")
        if task.robots != len(models):
            unknown.append(f"this policy drives {counted(task.robots, 'robot')}")
        if unknown:
            raise PolicyError(f"what this policy perceives here cannot be shown: {'; '.join(unknown)}.")
        self._policy, self._task, self._models, self._on_view = policy, task, tuple(models), on_view
        self._route = tuple(route) or (() if target is None else (target,))
        self._radius, self._leader, self._heading = radius, leader, heading
        self._count = node_count(task)
        self._angles = np.array(ray_angles(task))
        self._lidar_heading = CaseArrays(task).robot.lidar.theta
        self._single, self._sectors = task.observation.ray_tables(task.robots)
        self._restart()

    def _restart(self) -> None:
        self._progress = GoalProgress(self._count, self._is_inside, self._route, len(self._models))
        self._player = self._policy.make_player(1)
        self._expected = ExpectedReturns(self._policy)
        self._frames: list[Float32Array] = []
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

    def _count_goal(self, scans: Sequence[LatestScan], simulation: Simulation) -> None:
        """Finds where the target is now, and how much of the goal is achieved."""
        self._simulation = simulation
        if self._leader is not None:
            self._progress.target = simulation.pose(self._leader)[:2]
        poses = np.array([simulation.pose(model) for model in self._models])
        beside = []
        for scan in scans:
            ranges = self._known_ranges(scan, math.inf)
            beside.append([ranges[LEFT_RAYS,].min(), ranges[::-1][LEFT_RAYS,].min()])
        self._progress.step(poses, np.array(beside))

    def _is_inside(self, robot: int, pose: FloatArray, place: Sequence[float]) -> bool:
        """Whether a robot has arrived where the simulation has it."""
        x, y = place
        away = math.hypot(pose[0] - x, pose[1] - y)
        if self._task.measured_to != "axle" and math.isfinite(away):
            away = self._simulation.hull_distance(self._models[robot], (x, y))
        inside, headings = np.array([[away <= self._radius]]), np.array([self._heading])
        return bool(self._task.goal.is_arrived(inside, np.array([[pose]]), headings).all())

    def _look(self, scans: Sequence[LatestScan], simulation: Simulation) -> None:
        self._count_goal(scans, simulation)
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
        ranges = self._known_ranges(scan, seen.clip).clip(0.0, seen.clip)
        minima = [ranges[first:stop].min() for _, first, stop in self._sectors.tolist()]
        numbers = [*(ranges[self._single[robot]] * seen.scale), *(np.array(minima) * seen.scale)]
        for part in seen.parts:
            numbers += self._part_values(part.name, robot, simulation)
        return np.array(numbers)

    def _part_values(self, part: str, robot: int, simulation: Simulation) -> list[float]:
        """The numbers of one part, as the node of the policy knows them."""
        if part == "last_action":
            twist: list[float] = self._last_twists[robot].tolist()
            return twist
        if part in ("achieved", "arrived"):
            return self._progress.part_numbers(part, robot)
        state = next(each for each in simulation.state().bodies if each.model == self._models[robot])
        pose, scale = state.pose, self._task.observation.scale
        if part == "speeds":
            vx, vy, turn = state.velocity
            return [math.cos(pose.theta) * vx + math.sin(pose.theta) * vy, turn]
        if part == "own_pose":
            place = np.clip((pose.x, pose.y), -MAX_COORDINATE, MAX_COORDINATE) * scale
            return [*place.tolist(), math.cos(pose.theta), math.sin(pose.theta)]
        if part == "target_heading":
            return [math.cos(self._heading - pose.theta), math.sin(self._heading - pose.theta)]
        at, target = np.array([[pose.x, pose.y, pose.theta]]), np.array(self._progress.target)
        distance = min(float(distance_to_target(at, target)[0]), MAX_TARGET_DISTANCE)
        return [distance * scale, float(bearing_of_target(at, target)[0]) / math.pi]

    def _known_ranges(self, scan: LatestScan, beyond: float) -> FloatArray:
        """(91,) [m] in the directions that the policy knows; ``beyond`` where the lidar does not look or sees nothing."""
        angles = np.arctan2(scan.beams.sin, scan.beams.cos)
        return ranges_in_directions(self._angles, scan.ranges, angles, beyond)
