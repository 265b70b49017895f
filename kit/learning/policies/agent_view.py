"""What an agent perceives at one step, and how it rates its actions: for screens that show it while it drives."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from kit.geometry import Pose
from kit.learning.environment.actions import ContinuousActions, DiscreteActions
from kit.learning.environment.observations import ObservationSpec, ray_direction
from kit.learning.environment.tasks import LearningTask
from kit.learning.policies.policies import IntArray, Policy, PolicyPlayer, SingleArray
from kit.render.scene import FloatArray, ScenePath

ARC_STEP = math.radians(4.0)
"""Between two points of a drawn arc [rad]."""

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
    """By robot: the shortest range that it is given [m]; inf where it has no scan."""
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

    def add(self, player: PolicyPlayer, observations: SingleArray, actions: IntArray | SingleArray) -> None:
        """Notes the step of one world, in which ``player`` chose ``actions`` (1,) or (1, numbers)."""
        found = self._policy.expected_returns(observations, player.scores, actions)
        if found is not None:
            self.values.append(float(found[0]))


def build_agent_view(
    policy: Policy,
    task: LearningTask,
    observation: SingleArray,
    scores: SingleArray,
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
            (name if size == 1 else f"{name} {place + 1}", float(frame[0, first + place]))
            for name, first, size in _parts(seen)
            for place in range(size)
        ),
        tuple(float(row.min(initial=math.inf)) for row in ranges),
        tuple(
            path
            for robot in range(robots)
            for path in _sight(seen, task, robot, ranges[robot], Pose(*poses[robot].tolist()))
        ),
        tuple(expected),
    )


def _parts(seen: ObservationSpec) -> list[tuple[str, int, int]]:
    """Name, place and size of what follows the scan's numbers."""
    return [(name, part.start, part.stop - part.start) for name, part in seen.part_slices().items()]


def _sight(
    seen: ObservationSpec, task: LearningTask, robot: int, ranges: SingleArray, pose: Pose
) -> list[ScenePath]:
    single, sectors = seen.ray_tables(task.robots)
    paths = []
    for ray, distance in zip(single[robot].tolist(), ranges.tolist(), strict=False):
        end = _end(pose, ray_direction(ray), distance)
        paths.append(ScenePath(np.array([pose[:2], end]), "dotted" if distance >= seen.clip else "solid"))
    for (_, first, stop), distance in zip(sectors.tolist(), ranges[single.shape[1] :].tolist(), strict=False):
        start, end_angle = ray_direction(first), ray_direction(stop - 1)
        count = max(2, math.ceil((end_angle - start) / ARC_STEP) + 1)
        arc = [_end(pose, angle, distance) for angle in np.linspace(start, end_angle, count).tolist()]
        paths.append(ScenePath(np.array(arc), "dotted" if distance >= seen.clip else "solid"))
    return paths


def _end(pose: Pose, angle: float, distance: float) -> tuple[float, float]:
    return (
        pose.x + distance * math.cos(pose.theta + angle),
        pose.y + distance * math.sin(pose.theta + angle),
    )


def _rated_actions(
    policy: Policy, task: LearningTask, scores: SingleArray
) -> tuple[RatingKind, tuple[RatedAction, ...]]:
    actions = task.actions
    if isinstance(actions, ContinuousActions):
        return "command", _commands(actions, task.robots, scores)
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


def _commands(actions: ContinuousActions, robots: int, scores: SingleArray) -> tuple[RatedAction, ...]:
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
