"""Policies as plain arrays: the result of training, and all that driving needs. No torch.

A policy is the rule that chooses actions. Here it is a brain, which gives every action a score for what is seen, and
a way to choose by these scores: the best (greedy), or by chance (sampled), as the algorithm did while it learned.
"""

from __future__ import annotations

import json
import math
import sys
from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np
from gymnasium import spaces

from kit.arrays import BoolArray, Float32Array, IntArray
from kit.learning.policies.policy_network import ActionValueTable, PolicyNetwork
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.task_spec import TaskSpec
from kit.plain_text import printable_line

SamplingKind = Literal["softmax", "epsilon", "normal", "tanh-normal", "noisy-tanh"]


DEVIATION_KINDS = ("normal", "noisy-tanh")
"""Continuous actions that scatter alike for everything that is seen."""


CONTINUOUS_KINDS = (*DEVIATION_KINDS, "tanh-normal")


LOG_DEVIATION_RANGE = (-20.0, 2.0)
"""Within this stays the logarithm of a standard deviation that a network gives, as in stable-baselines3."""


MAX_COUNT = 1 << 53
"""Of steps, inputs and actions: up to it, numbers of every language are exact."""


class PolicyError(Exception):
    """A policy's file is damaged, or the policy does not fit the task; the message says which and what to do.

    What the file says of itself stands in it as characters that no terminal obeys.
    """

    def __init__(self, message: str) -> None:
        super().__init__("\n".join(map(printable_line, message.split("\n"))))


@dataclass(frozen=True, slots=True)
class ActionSampling:
    """How a sampled policy draws an action from the scores."""

    kind: SamplingKind
    """``softmax``: in proportion to exp(score / amount). ``epsilon``: anything at all with probability ``amount``.

    Of continuous actions, ``normal``: normally around the network's outputs, with ``amount`` times the ``deviations``.
    ``noisy-tanh``: the same around their hyperbolic tangents. ``tanh-normal``: the network gives means, then the
    logarithms of standard deviations; the action is the hyperbolic tangent of what is drawn."""
    amount: float = 1.0
    deviations: tuple[float, ...] = ()
    """Standard deviation of each number of a continuous action."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Policy:
    """Which actions for which observations: what training makes, and all that driving needs.

    >>> policy = kit.load_policy("best.npz")
    >>> policy
    Policy(turn: 9 numbers seen, 3 actions, 0 steps)
    >>> import numpy
    >>> action, _ = policy.predict(numpy.zeros(9))
    >>> int(action)
    0
    """

    model: PolicyNetwork | ActionValueTable
    choices: tuple[int, ...]
    """How many actions there are to choose from: one number, or one for each robot; none of continuous actions, which
    are made of the network's outputs as ``sampling.kind`` says, and lie between -1 and 1."""
    sampling: ActionSampling
    trained_on: TaskSpec
    steps: int
    """Steps of training."""
    interface: Mapping[str, Any]
    """What it saw and could do when it was trained; see ``task_interface``."""
    critic: PolicyNetwork | None = None
    """Says what return is expected, from the observation, or from observation and continuous action; None where no network
    of its own was learned for that."""

    def check_consistent(self) -> None:
        """Raises ValueError unless its parts fit one another: a damaged file may hold anything."""
        self.model.check_shapes()
        counts = (self.steps + 1, self.model.inputs, *self.choices)
        if not all(1 <= count < MAX_COUNT for count in counts):
            raise ValueError("a number of steps, inputs or actions that there cannot be")
        if self.choices and self.model.outputs != sum(self.choices):
            raise ValueError(f"{self.model.outputs} scores for {_product_text(self.choices)} actions")
        kind = self.sampling.kind
        if (kind in CONTINUOUS_KINDS) == bool(self.choices):
            raise ValueError("the way in which actions are drawn does not fit the actions")
        deviations = self.action_size if kind in DEVIATION_KINDS else 0
        if len(self.sampling.deviations) != deviations or (kind == "tanh-normal" and self.model.outputs % 2):
            raise ValueError(
                f"{len(self.sampling.deviations)} standard deviations for {self.model.outputs} outputs"
            )
        if not all(0.0 <= deviation < math.inf for deviation in self.sampling.deviations):
            raise ValueError("a standard deviation that is none")
        lowest = 0.0 if self.sampling.kind == "epsilon" else sys.float_info.min
        if not lowest <= self.sampling.amount < math.inf:
            raise ValueError(f"actions drawn with an amount of {self.sampling.amount}")
        if not isinstance(self.interface, dict):
            raise ValueError("no record of what it saw")
        if self.critic is not None:
            self.critic.check_shapes()
            known = {self.model.inputs, self.model.inputs + (0 if self.choices else self.action_size)}
            if self.critic.inputs not in known or self.critic.outputs != 1 or self.critic.memory:
                raise ValueError(f"a critic of {self.critic.inputs} numbers that gives {self.critic.outputs}")

    @property
    def action_size(self) -> int:
        """How many numbers a continuous action has."""
        return self.model.outputs // 2 if self.sampling.kind == "tanh-normal" else self.model.outputs

    def check_fits(self, task: LearningTask) -> None:
        """PolicyError if it cannot play ``task``, or what it would see or do there means something else."""
        sees, space = task.observation.size * task.robots, task.actions.space(task.robots)
        choices = action_counts(space)
        if bool(choices) != bool(self.choices):
            kinds = {True: "has discrete actions", False: "has continuous actions"}
            raise PolicyError(
                f"this policy was trained on {self.trained_on.title} and {kinds[bool(self.choices)]}; an agent of task "
                f"{task.name} {kinds[bool(choices)]}. Play it on the task it was trained on, or train another."
            )
        if not choices and sees == self.model.inputs and space.shape != (self.action_size,):
            raise PolicyError(
                f"this policy was trained on {self.trained_on.title} and gives {self.action_size} numbers, but task "
                f"{task.name} takes {space.shape}."
            )
        if (sees, choices) != (self.model.inputs, self.choices):
            raise PolicyError(
                f"this policy was trained on {self.trained_on.title}: it sees {self.model.inputs} numbers and chooses "
                f"from {_product_text(self.choices)} actions, but task {task.name} gives {sees} and wants one of "
                f"{_product_text(choices)}. Play it on the task it was trained on, or train another."
            )
        if changes := _differences(self.interface, task_interface(task)):
            raise PolicyError(
                f"this policy was trained on {self.trained_on.title}, and task {task.name} is not the same as that was: "
                f"{'; '.join(changes)}. Play it on the task it was trained on, or train another."
            )

    def expected_returns(
        self, observations: Float32Array, scores: Float32Array, actions: IntArray | Float32Array
    ) -> Float32Array | None:
        """(n,) the discounted return expected from here on, for what is seen (n, inputs), the model's ``scores`` of it and
        the ``actions`` chosen; None where neither a critic nor the scores tell."""
        if self.critic is not None:
            parts = [np.asarray(observations, dtype=np.float32)]
            if self.critic.inputs > self.model.inputs:
                parts.append(np.asarray(actions, dtype=np.float32))
            no_memory = np.zeros((len(parts[0]), 2, 0), dtype=np.float32)
            return self.critic.scores(np.concatenate(parts, axis=1), no_memory)[0][:, 0]
        if self.sampling.kind == "epsilon" and self.sampling.amount > 0.0 and len(self.choices) == 1:
            best: Float32Array = scores.max(axis=1)
            return best
        return None

    def predict(
        self,
        observation: Float32Array,
        state: Float32Array | None = None,
        episode_start: BoolArray | None = None,
        deterministic: bool = True,
    ) -> tuple[IntArray | Float32Array, Float32Array | None]:
        """The action for an observation (numbers,), or (n, ...) actions for (n, numbers), and the next memory, as
        stable-baselines3's models give them.

        ``state``: (n, 2, h) the memory that the last call returned; None at the start. ``episode_start``: (n,) where an
        episode has just begun. ``deterministic``: whether it takes the best action, or draws one as in training.
        Raises ValueError for observations of another size.
        """
        seen = np.atleast_2d(np.asarray(observation, dtype=np.float32))
        if seen.ndim != 2 or seen.shape[1] != self.model.inputs:
            raise ValueError(
                f"observations have {self.model.inputs} numbers each, not the shape {np.shape(observation)}"
            )
        player = self.make_player(len(seen), None if deterministic else np.random.default_rng())
        if state is not None:
            player.memory = np.array(state, dtype=np.float32)
        actions = player.act(seen, None if episode_start is None else np.atleast_1d(episode_start))
        memory = player.memory if self.model.memory else None
        return (actions[0] if np.ndim(observation) == 1 else actions), memory

    def __repr__(self) -> str:
        """``Policy(turn: 9 numbers seen, 3 actions, 40,960 steps)``"""
        does = (
            f"{_product_text(self.choices)} actions"
            if self.choices
            else f"actions of {self.action_size} numbers"
        )
        return (
            f"Policy({self.trained_on.title}: {self.model.inputs} numbers seen, {does}, {self.steps:,} steps)"
        )

    def make_player(self, n: int, rng: np.random.Generator | None = None) -> PolicyPlayer:
        """Returns a player for ``n`` worlds: greedy, or, given a random generator, sampled."""
        return PolicyPlayer(self, n, rng)


def task_interface(task: LearningTask) -> dict[str, Any]:
    """JSON-able: what a policy of the task sees and can do, apart from maps, rewards and ends."""
    found = {
        "step_time": task.step_time,
        "robots": task.robots,
        **asdict(task.observation),
        **{f"actions.{name}": value for name, value in asdict(task.actions).items()},
    }
    known: dict[str, Any] = json.loads(json.dumps(found))  # tuples as lists, as in a file
    return known


def _differences(then: Mapping[str, Any], now: Mapping[str, Any]) -> list[str]:
    """Describes the differences. What only one of them has does not count: the kit has learned it since."""
    return [
        f"{name.replace('_', ' ')} was {_value_text(name, then[name])} and is {_value_text(name, now[name])}"
        for name in then
        if name in now and then[name] != now[name]
    ]


def _value_text(name: str, value: Any) -> str:
    if name == "sectors" and isinstance(value, list) and all(type(each) is int for each in value):
        # Of each ray the number of its sector: as task files say it, how many rays each has.
        value = [rays for _, rays in sorted(Counter(value).items())]
    text = json.dumps(value)
    return text if len(text) <= MAX_VALUE_TEXT else f"{text[:MAX_VALUE_TEXT]}..."


MAX_VALUE_TEXT = 60
"""Characters of a value in a message."""


def _product_text(choices: tuple[int, ...]) -> str:
    return " x ".join(map(str, choices))


def action_counts(space: spaces.Space[Any]) -> tuple[int, ...]:
    """How many actions a Discrete or MultiDiscrete space has to choose from, number by number; none in a Box."""
    if isinstance(space, spaces.Discrete):
        return (int(space.n),)
    if isinstance(space, spaces.MultiDiscrete):
        return tuple(int(count) for count in space.nvec)
    if isinstance(space, spaces.Box):
        return ()
    raise PolicyError(f"a policy cannot act in the space {space}")


def check_network(network: PolicyNetwork, task: LearningTask) -> None:
    """ValueError unless a network that was trained elsewhere sees what an agent of the task sees, and scores its actions."""
    sees, choices = task.observation.size * task.robots, action_counts(task.actions.space(task.robots))
    if network.inputs != sees or (choices and network.outputs != sum(choices)):
        has = f"one of {_product_text(choices)} actions" if choices else "continuous actions"
        raise ValueError(
            f"its network sees {network.inputs} numbers and gives {network.outputs}; an agent of task {task.name} sees {sees} "
            f"and does {has}"
        )


class PolicyPlayer:
    """A policy at play in ``n`` worlds, with its memory of their episodes."""

    def __init__(self, policy: Policy, n: int, rng: np.random.Generator | None = None) -> None:
        self.policy = policy
        self._rng = rng
        self.memory: Float32Array = np.zeros((n, 2, policy.model.memory), dtype=np.float32)
        """(n, 2, h)"""
        self.scores: Float32Array = np.zeros((n, policy.model.outputs), dtype=np.float32)
        """(n, outputs): what the model gave for the observations of the last ``act``."""

    def act(self, observations: Float32Array, fresh: BoolArray | None = None) -> IntArray | Float32Array:
        """(n,) actions, or (n, numbers) of them; ``fresh`` (n,): where an episode has just begun."""
        if fresh is not None:
            self.memory[fresh] = 0.0
        self.scores, self.memory = self.policy.model.scores(
            np.asarray(observations, dtype=np.float32), self.memory
        )
        choices = self.policy.choices
        if not choices:
            return self._sample_actions(self.scores)
        parts = np.split(self.scores, np.cumsum(choices)[:-1], axis=1)
        chosen = np.stack([self._choose_actions(part) for part in parts], axis=1)
        return chosen[:, 0] if len(choices) == 1 else chosen

    def _sample_actions(self, outputs: Float32Array) -> Float32Array:
        """(n, numbers) continuous actions."""
        sampling, deviations = self.policy.sampling, np.zeros(0, dtype=np.float32)
        if sampling.kind == "tanh-normal":
            outputs, logarithms = np.split(outputs, 2, axis=1)
            deviations = np.exp(np.clip(logarithms, *LOG_DEVIATION_RANGE))
        elif sampling.kind == "noisy-tanh":
            outputs = np.tanh(outputs)
        if self._rng is not None:
            if sampling.kind in DEVIATION_KINDS:
                deviations = np.array(sampling.deviations, np.float32)
            noise = self._rng.standard_normal(outputs.shape, dtype=np.float32)
            outputs = outputs + np.float32(sampling.amount) * noise * deviations
        if sampling.kind == "tanh-normal":
            outputs = np.tanh(outputs)
        return np.clip(outputs, np.float32(-1), np.float32(1))

    def _choose_actions(self, scores: Float32Array) -> IntArray:
        best: IntArray = scores.argmax(axis=1)
        if self._rng is None:
            return best
        chance = self.policy.sampling
        if chance.kind == "epsilon":
            anything = self._rng.integers(scores.shape[1], size=len(scores))
            return np.where(self._rng.random(len(scores)) < chance.amount, anything, best)
        # The greatest of score plus Gumbel noise is drawn in proportion to exp(score).
        noisy: IntArray = (scores / chance.amount + self._rng.gumbel(size=scores.shape)).argmax(axis=1)
        return noisy
