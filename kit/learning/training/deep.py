"""A learner with a neural network: any algorithm of the table that stable-baselines3's classes make (needs the extra
``learn``)."""

from __future__ import annotations

import io
import math
import warnings
from collections.abc import Mapping
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np
import torch
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.logger import Logger
from stable_baselines3.common.noise import NormalActionNoise
from stable_baselines3.common.vec_env import VecEnvWrapper
from torch import nn

from kit.arrays import FloatArray
from kit.learning.environment.episode_stats import EpisodeOutcome, EpisodeStats
from kit.learning.policies.export import export_critic, export_network, export_sampling
from kit.learning.policies.policy import Policy, action_counts, task_interface
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.algorithm_settings import LinearSchedule, OnPolicyParams
from kit.learning.training.algorithms import Algorithm
from kit.learning.training.checkpoint_file import LearnerCounts, check_actions, check_rows
from kit.learning.training.learner import TrainingCallback
from kit.learning.training.measures import RecentExperience
from kit.learning.training.presets import Preset
from kit.learning.training.torch_parts import TorchParts, pack_parts, unpack_parts

LEARNING_RATE_FACTOR = 0.5
"""Factor for the learning rate each time a learner returns to an earlier policy."""
OPTIMIZER_OPTIONS: Mapping[str, Mapping[str, Any]] = {
    "ppo": {"fused": True, "eps": 1e-5},
    "maskable-ppo": {"fused": True, "eps": 1e-5},
    "recurrent-ppo": {"fused": True, "eps": 1e-5},
    "trpo": {"fused": True, "eps": 1e-5},
    "dqn": {"fused": True},
    "qrdqn": {"fused": True},
    "sac": {"fused": True},
    "td3": {"fused": True},
    "ddpg": {"fused": True},
    "tqc": {"fused": True},
    "crossq": {"fused": True, "betas": (0.5, 0.999)},
}
"""Those that learn by Adam: a step in one call, instead of ten for each layer. The rest is as the library has it."""
ACTIVATIONS = {"tanh": nn.Tanh, "relu": nn.ReLU}
ENTROPY_WEIGHT = "log_ent_coef"
"""The attribute of SAC's kin that holds the logarithm of the weight of the entropy."""
LEARN_OPTIONS: Mapping[str, Mapping[str, Any]] = {"maskable-ppo": {"use_masking": False}}
"""The tasks forbid no action anywhere."""

UPDATE_MEASURES: Mapping[str, tuple[str, float]] = {
    "train/explained_variance": ("explained_variance", 1.0),
    "train/entropy_loss": ("entropy", -1.0),
    "train/clip_fraction": ("clip_fraction", 1.0),
    "train/approx_kl": ("approx_kl", 1.0),
    "train/kl_divergence_loss": ("approx_kl", 1.0),
}
"""What the library's on-policy learners log of their last update: the measure that it is, and its sign."""


class EpisodeReporter(VecEnvWrapper):
    """Passes every episode that ends to the callback, and keeps the last observations."""

    callback: TrainingCallback | None = None

    def __init__(self, venv: Any) -> None:
        super().__init__(venv)
        self.recent = RecentExperience(venv.num_envs, int(np.prod(venv.observation_space.shape)))

    def reset(self) -> Any:
        return self.venv.reset()

    def step_wait(self) -> Any:
        observations, rewards, dones, infos = self.venv.step_wait()
        self.recent.add(observations, rewards, dones)
        if self.callback is not None:
            for number in np.flatnonzero(dones):
                self.callback.on_episode_end(_episode_of(int(number), infos[number]))
        return observations, rewards, dones, infos


def _episode_of(world: int, info: Mapping[str, Any]) -> EpisodeStats:
    """Converts the statistics that ``BatchVecEnv`` reports."""
    return EpisodeStats(
        world,
        info["case"],
        EpisodeOutcome(info["outcome"]),
        info["episode"]["l"],
        info["episode"]["r"],
        info["terms"],
        info.get("adjacency", 0.0),
    )


class _RolloutCallback(BaseCallback):
    """Calls the training callback before each rollout, when the policy does not change."""

    def __init__(self, callback: TrainingCallback, entropy: LinearSchedule | None) -> None:
        super().__init__()
        self._callback = callback
        self._entropy = entropy

    def _on_rollout_start(self) -> None:
        if self._entropy is not None:
            self.model.ent_coef = self._entropy.value_at(self.model._current_progress_remaining)
        self._callback.between_updates()

    def _on_step(self) -> bool:
        return True


class DeepLearner:
    """Wraps one model. torch runs on one thread: more are no faster here, and results would depend on their number."""

    def __init__(
        self,
        algorithm: Algorithm,
        preset: Preset,
        choice: TaskSpec,
        venv: Any,
        seed: int,
        tensorboard: Path | None = None,
    ) -> None:
        """``venv``: a ``BatchVecEnv``. ``tensorboard``: a folder for its files."""
        torch.set_num_threads(1)
        self._algorithm = algorithm
        self._preset = preset
        self._choice = choice
        self._env = EpisodeReporter(venv)
        self._rate_factor = 1.0
        network: dict[str, Any] = {"net_arch": list(preset.layers)}
        if preset.activation is not None:
            network["activation_fn"] = ACTIVATIONS[preset.activation]
        if preset.lstm_size is not None:
            network["lstm_hidden_size"] = preset.lstm_size
        if algorithm.name in OPTIMIZER_OPTIONS:
            network["optimizer_kwargs"] = dict(OPTIMIZER_OPTIONS[algorithm.name])
        keywords = preset.learner_arguments()
        if "action_noise" in keywords:
            size = venv.action_space.shape
            keywords["action_noise"] = NormalActionNoise(
                np.zeros(size), np.full(size, keywords["action_noise"])
            )
        if preset.learning_rate is not None:
            keywords["learning_rate"] = self._learning_rate
        with warnings.catch_warnings():
            # Every update but its last batch is as asked for; a search would say so in each trial.
            warnings.filterwarnings("ignore", "You have specified a mini-batch size")
            self._model = algorithm.load()(
                algorithm.policy,
                self._env,
                policy_kwargs=network,
                seed=seed,
                device="cpu",
                tensorboard_log=None if tensorboard is None else str(tensorboard),
                **keywords,
            )
        if (
            tensorboard is None
        ):  # the library's own logger makes a folder for temporary files in each ``learn``
            self._model.set_logger(Logger(folder=None, output_formats=[]))

    def _learning_rate(self, left: float) -> float:
        assert self._preset.learning_rate is not None
        return self._rate_factor * self._preset.learning_rate.value_at(left)

    @property
    def steps(self) -> int:
        return int(self._model.num_timesteps)

    def learn(self, steps: int, callback: TrainingCallback) -> None:
        settings = self._preset.settings
        entropy = settings.ent_coef if isinstance(settings, OnPolicyParams) else None
        self._env.callback = callback
        self._model.learn(
            max(0, steps - self.steps),
            _RolloutCallback(callback, entropy),
            reset_num_timesteps=False,
            tb_log_name="training",
            **LEARN_OPTIONS.get(self._algorithm.name, {}),
        )

    def assign_cases(self, shares: FloatArray) -> None:
        batch = self._env.unwrapped.batch
        if batch.has_fixed_cases:
            batch.assign_cases(shares)

    def policy(self) -> Policy:
        return Policy(
            export_network(self._model),
            action_counts(self._model.action_space),
            export_sampling(self._model),
            self._choice,
            self.steps,
            task_interface(self._env.unwrapped.batch.task),
            export_critic(self._model),
        )

    def measures(self) -> dict[str, float]:
        if self._algorithm.family != "replay":
            told = self._model.logger.name_to_value
            found = {
                name: float(told[key]) * sign for key, (name, sign) in UPDATE_MEASURES.items() if key in told
            }
            return {name: number for name, number in found.items() if math.isfinite(number)}
        recent = self._env.recent
        if not len(recent.observations):  # it was resumed with no step to come
            return {}
        policy = self.policy()
        scores = policy.model.scores(
            recent.observations, np.zeros((len(recent.observations), 2, 0), np.float32)
        )[0]
        actions = np.tanh(scores[:, : policy.action_size])
        values = policy.expected_returns(recent.observations, scores, actions)
        assert values is not None  # of these algorithms either the scores or a critic tell
        return recent.measures(values, float(self._model.gamma), None)

    def _parts(self) -> TorchParts:
        """Networks and optimisers, and the weight of SAC's entropy, which the library keeps beside them."""
        names = self._model.get_parameters()
        if getattr(self._model, ENTROPY_WEIGHT, None) is not None:
            names = (*names, ENTROPY_WEIGHT)
        return {name: attrgetter(name)(self._model) for name in names}

    def _set_parts(self, packed: bytes) -> None:
        unpack_parts(self._parts(), packed)
        if self._algorithm.family == "search":  # it keeps a copy of its own
            self._model.weights = nn.utils.parameters_to_vector(self._model.policy.parameters()).detach()

    def snapshot(self) -> bytes:
        return pack_parts(self._parts())

    def restore(self, known: bytes) -> None:
        self._set_parts(known)
        self._rate_factor *= LEARNING_RATE_FACTOR

    def save(self) -> dict[str, bytes]:
        counts = LearnerCounts(
            self._algorithm.name,
            self.steps,
            self._rate_factor,
            int(self._model._n_updates),
            largest=self._env.recent.save(),
        )
        parts = {**counts.pack(), "parameters.npz": self.snapshot()}
        if self._algorithm.family == "replay":
            parts["replay.npz"] = _pack_replay_buffer(self._model.replay_buffer)
        return parts

    def load(self, parts: Mapping[str, bytes]) -> None:
        counts = LearnerCounts.unpack(parts, self._algorithm.name)
        self._set_parts(parts["parameters.npz"])
        self._model.num_timesteps = counts.steps
        self._model._n_updates = counts.updates
        self._rate_factor = counts.slower
        self._env.recent.load(counts.largest)
        if "replay.npz" in parts:
            actions = max(action_counts(self._model.action_space), default=None)
            _unpack_replay_buffer(self._model.replay_buffer, parts["replay.npz"], actions)


REPLAY_ARRAYS = ("observations", "next_observations", "actions", "rewards", "dones", "timeouts")


def _pack_replay_buffer(buffer: Any) -> bytes:
    """Packs the contents of a replay buffer."""
    filled = buffer.buffer_size if buffer.full else buffer.pos
    file = io.BytesIO()
    place = np.array([buffer.pos, int(buffer.full)])
    np.savez(file, place, *(getattr(buffer, name)[:filled] for name in REPLAY_ARRAYS))
    return file.getvalue()


def _unpack_replay_buffer(buffer: Any, data: bytes, actions: int | None) -> None:
    """``actions``: how many there are to choose from; None if they are continuous."""
    with np.load(io.BytesIO(data), allow_pickle=False) as stored:
        pos, full = stored["arr_0"].tolist()
        if type(pos) is not int or not 0 <= pos < buffer.buffer_size:
            raise ValueError("a place outside its replay buffer")
        for number, name in enumerate(REPLAY_ARRAYS, start=1):
            own = getattr(buffer, name)
            values = check_rows(stored[f"arr_{number}"], own)
            if len(values) != (buffer.buffer_size if full else pos):
                raise ValueError("a replay buffer with other rows than it counts")
            if name == "actions" and actions is not None:
                check_actions(values, actions)
            own[: len(values)] = values
    buffer.pos, buffer.full = pos, bool(full)
