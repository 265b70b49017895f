"""Every algorithm that can learn a task, one row each: those of stable-baselines3 and sb3-contrib, and the kit's own
(Boltzmann exploration, and two tables for teaching).

A new algorithm is one more row, with its settings in ``presets.py``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from inspect import signature
from types import MappingProxyType
from typing import Any, Literal

from kit.plain_text import unknown_name

AlgorithmFamily = Literal["rollouts", "replay", "search", "table", "imitation"]
"""The kind of learning: from what its present policy just did; from a replay buffer; by trying changed networks
for whole episodes; a number for each state and action, without a network; or from what others do."""


ActionKinds = Literal["discrete", "continuous", "both"]


class UnsuitableAlgorithm(ValueError):
    """An algorithm cannot learn a task; the message says why, and which ones can."""


class UnknownAlgorithm(LookupError):
    """No algorithm has that name; the message offers the nearest one."""


@dataclass(frozen=True, slots=True)
class Algorithm:
    """One way to learn."""

    name: str
    title: str
    family: AlgorithmFamily
    module: str
    class_name: str
    policy: str = "MlpPolicy"
    supports_multi_discrete: bool = True
    """Whether it can choose several numbers at once, one for each robot."""
    actions: ActionKinds = "discrete"
    """The kinds of actions that it can learn."""
    library: Literal["stable-baselines3", "sb3-contrib", "kit"] = "stable-baselines3"

    @property
    def needs_torch(self) -> bool:
        """Whether it needs the extra ``learn``."""
        return self.family != "table"

    def library_defaults(self) -> Mapping[str, Any]:
        """The arguments of a library's class and their defaults; none for the kit's own. ImportError without the extra
        ``learn``."""
        if self.library == "kit":
            return {}
        return {name: each.default for name, each in signature(self.load()).parameters.items()}

    def load(self) -> Any:
        """The class. ImportError without the extra ``learn``."""
        return getattr(import_module(self.module), self.class_name)


_SB3, _CONTRIB = "stable_baselines3", "sb3_contrib"

ALGORITHMS: Mapping[str, Algorithm] = MappingProxyType(
    {
        row.name: row
        for row in (
            Algorithm("ppo", "Proximal policy optimisation", "rollouts", _SB3, "PPO", actions="both"),
            Algorithm("a2c", "Advantage actor-critic", "rollouts", _SB3, "A2C", actions="both"),
            Algorithm(
                "dqn",
                "Deep Q-network with epsilon-greedy exploration",
                "replay",
                _SB3,
                "DQN",
                supports_multi_discrete=False,
            ),
            Algorithm(
                "boltzmann-dqn",
                "Deep Q-network with Boltzmann exploration (the dissertation's)",
                "replay",
                "kit.learning.training.boltzmann_dqn",
                "BoltzmannLearner",
                supports_multi_discrete=False,
                library="kit",
            ),
            Algorithm(
                "qrdqn",
                "Deep Q-network that learns the distribution of returns",
                "replay",
                _CONTRIB,
                "QRDQN",
                supports_multi_discrete=False,
                library="sb3-contrib",
            ),
            Algorithm(
                "trpo",
                "Trust region policy optimisation",
                "rollouts",
                _CONTRIB,
                "TRPO",
                actions="both",
                library="sb3-contrib",
            ),
            Algorithm(
                "recurrent-ppo",
                "PPO with a recurrent network",
                "rollouts",
                _CONTRIB,
                "RecurrentPPO",
                actions="both",
                policy="MlpLstmPolicy",
                library="sb3-contrib",
            ),
            Algorithm(
                "maskable-ppo",
                "PPO that can mask actions",
                "rollouts",
                _CONTRIB,
                "MaskablePPO",
                library="sb3-contrib",
            ),
            Algorithm(
                "ars",
                "Augmented random search, without gradients",
                "search",
                _CONTRIB,
                "ARS",
                supports_multi_discrete=False,
                library="sb3-contrib",
            ),
            Algorithm(
                "q-learning",
                "Table of values, learned from the best next action",
                "table",
                "kit.learning.training.tabular",
                "QLearning",
                supports_multi_discrete=False,
                library="kit",
            ),
            Algorithm(
                "sarsa",
                "Table of values, learned from the next action taken",
                "table",
                "kit.learning.training.tabular",
                "Sarsa",
                supports_multi_discrete=False,
                library="kit",
            ),
            Algorithm(
                "sac",
                "Soft actor-critic: maximises reward and entropy",
                "replay",
                _SB3,
                "SAC",
                actions="continuous",
            ),
            Algorithm(
                "td3",
                "Twin delayed DDPG: uses the lower of two critics",
                "replay",
                _SB3,
                "TD3",
                actions="continuous",
            ),
            Algorithm(
                "ddpg", "Deep deterministic policy gradient", "replay", _SB3, "DDPG", actions="continuous"
            ),
            Algorithm(
                "tqc",
                "SAC with truncated quantile critics",
                "replay",
                _CONTRIB,
                "TQC",
                actions="continuous",
                library="sb3-contrib",
            ),
            Algorithm(
                "crossq",
                "SAC with batch normalisation, without target networks",
                "replay",
                _CONTRIB,
                "CrossQ",
                actions="continuous",
                library="sb3-contrib",
            ),
        )
    }
)
"""Algorithms by the name that ``kit train --algo`` takes."""


_IMITATION = "kit.learning.training.imitation"
IMITATION_ALGORITHMS: Mapping[str, Algorithm] = MappingProxyType(
    {
        row.name: row
        for row in (
            Algorithm(
                "bc",
                "Behaviour cloning: copies the demonstrated action for each observation",
                "imitation",
                _IMITATION,
                "ImitationLearner",
                actions="both",
                library="kit",
            ),
            Algorithm(
                "dagger",
                "DAgger: asks the demonstrator in the states that the learner visits",
                "imitation",
                _IMITATION,
                "ImitationLearner",
                actions="both",
                library="kit",
            ),
        )
    }
)
"""Those that learn from what others do, and not from a reward: ``kit train --imitate``."""


def find_algorithm(name: str) -> Algorithm:
    """Returns the algorithm of that name. Raises UnknownAlgorithm."""
    known = {**ALGORITHMS, **IMITATION_ALGORITHMS}
    if name not in known:
        raise UnknownAlgorithm(unknown_name("algorithm", name, known, "kit train --list"))
    return known[name]


def algorithms_for(*, is_continuous: bool) -> tuple[str, ...]:
    """The names of the algorithms that learn such actions."""
    unable = "discrete" if is_continuous else "continuous"
    return tuple(row.name for row in ALGORITHMS.values() if row.actions != unable)


def check_suits(algorithm: Algorithm, *, is_continuous: bool) -> None:
    """UnsuitableAlgorithm if it cannot learn a task with such actions."""
    if algorithm.actions != ("discrete" if is_continuous else "continuous"):
        return
    able = algorithms_for(is_continuous=is_continuous)
    if is_continuous:
        raise UnsuitableAlgorithm(
            f"{algorithm.name} needs discrete actions, but this task's are continuous. Those that learn "
            f"continuous actions: {', '.join(able)}."
        )
    raise UnsuitableAlgorithm(
        f"{algorithm.name} needs continuous actions, but this task's are discrete. Those that learn "
        f"it: {', '.join(able)}. Or use a task with continuous actions, such as smooth-turn; in your own file, "
        "write `actions: {linear: [-0.2, 0.5], angular: [-2, 2]}`."
    )
