"""Settings of algorithms: a record for each kind, with the names and the meaning that their library gives them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, TypeAlias

LEARNING_RATE: Final = "learning_rate"
"""A setting of every algorithm that trains a network."""
SHARES: Final = ("gamma", "tau", "exploration_fraction", "exploration_final_eps", "epsilon", "rate")
"""Settings from 0 to 1."""
LIMITS: Final = ("value_limit",)
"""Settings that may be infinite."""
MAX_COUNT: Final = 1_000_000_000
"""The largest number of a setting that counts something."""
REPEATS: Final = (
    "n_steps", "n_epochs", "train_freq", "gradient_steps", "n_delta", "n_top", "n_eval_episodes", "rounds",
)  # fmt: skip
"""Settings that say how often something is done before a learner looks whether it is to stop."""
MAX_REPEATS: Final = 100_000
MAX_HELD_BYTES: Final = 4 << 30
"""Bytes of what a learner holds: a rollout or a replay buffer, a batch of it, its changed networks."""


@dataclass(frozen=True, slots=True)
class LinearSchedule:
    """A value that falls in a straight line from the first to the last step of training."""

    initial: float
    final: float

    def __str__(self) -> str:
        return f"{self.initial:g}" + (f" to {self.final:g}" if self.final != self.initial else "")

    def value_at(self, left: float) -> float:
        """``left``: the share of training that is still to come, 1 to 0."""
        return self.final + (self.initial - self.final) * left


@dataclass(frozen=True, slots=True)
class OnPolicyParams:
    """Settings of PPO and its kin, A2C and TRPO: what they have in common, and what only some of them have."""

    n_steps: int | None = None
    """Steps of each world between two updates."""
    batch_size: int | None = None
    n_epochs: int | None = None
    gamma: float | None = None
    clip_range: float | None = None
    target_kl: float | None = None
    max_grad_norm: float | None = None
    ent_coef: LinearSchedule | None = None


@dataclass(frozen=True, slots=True)
class ReplayParams:
    """Settings of the deep Q-networks."""

    buffer_size: int | None = None
    learning_starts: int | None = None
    batch_size: int | None = None
    tau: float | None = None
    gamma: float | None = None
    train_freq: int | None = None
    gradient_steps: int | None = None
    target_update_interval: int | None = None
    exploration_fraction: float | None = None
    exploration_final_eps: float | None = None
    max_grad_norm: float | None = None
    temperature: float | None = None
    """Temperature of Boltzmann exploration."""
    value_limit: float | None = None
    """Beyond this all values over temperature count as equal in Boltzmann exploration; infinite: no limit."""


@dataclass(frozen=True, slots=True)
class ActorCriticReplayParams:
    """Settings of SAC and its kin, which learn continuous actions from a replay buffer."""

    buffer_size: int | None = None
    learning_starts: int | None = None
    batch_size: int | None = None
    tau: float | None = None
    gamma: float | None = None
    train_freq: int | None = None
    """Steps of every world between two updates."""
    gradient_steps: int | None = None
    """Gradient steps per update."""
    n_steps: int | None = None
    """Rewards added up before the critic's estimate of the rest; None: one."""
    ent_coef: float | str | None = None
    """Weight of the entropy; ``auto_0.02``: learned, from 0.02 on."""
    action_noise: float | None = None
    """Standard deviation of the noise on every number of an action, for algorithms that do not explore by themselves."""


@dataclass(frozen=True, slots=True)
class ARSSettings:
    """Settings of augmented random search."""

    n_delta: int | None = None
    n_top: int | None = None
    delta_std: float | None = None
    n_eval_episodes: int | None = None


@dataclass(frozen=True, slots=True)
class ImitationParams:
    """Settings of algorithms that learn from demonstrations."""

    batch_size: int = 256
    rounds: int = 0
    """How often the demonstrators are asked what they would do along the learner's ways."""
    round_steps: int = 50_000
    """Examples that are learned from before each round."""


@dataclass(frozen=True, slots=True)
class TabularParams:
    """Settings of the tabular algorithms."""

    rate: LinearSchedule = LinearSchedule(0.2, 0.02)  # falls, so that the values come to rest
    gamma: float = 0.99
    epsilon: LinearSchedule = LinearSchedule(0.3, 0.02)  # any action at all, with this probability
    edges: tuple[float, ...] = (0.15, 0.35)  # between the bins: near, free, far, in what the agent sees


AlgorithmSettings: TypeAlias = (
    OnPolicyParams | ReplayParams | ActorCriticReplayParams | ARSSettings | ImitationParams | TabularParams
)
