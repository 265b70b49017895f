"""The dissertation's agent (section 3.1.2): a deep Q-network with Boltzmann exploration, as Keras-RL has it.

It draws actions in proportion to exp(value / temperature) and learns from squared errors, by gradients without a bound,
towards the best value of a target network (Mnih and others, Nature 518, 2015); Keras-RL's other defaults are meant too.
With rewards in the hundreds and temperature 1 it explores little: a difference of a few units in value already makes the
better action all but certain. In numpy: with two layers of 24 neurons torch takes five times as long.

Keras-RL takes all values over temperature beyond 500 for equal (``value_limit``), so that no exponential overflows. Where
good actions are worth more, it chooses among them by chance, and the best of many values, each a little off, feeds on
itself: they grow without end. Here no exponential overflows anyway: the largest is subtracted first.
"""

from __future__ import annotations

import io
import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kit.arrays import BoolArray, Float32Array, FloatArray, IntArray
from kit.learning.policies.policy import ActionSampling, Policy, action_counts, task_interface
from kit.learning.policies.policy_network import Activation, LinearLayer, PolicyNetwork
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.algorithm_settings import LinearSchedule, ReplayParams
from kit.learning.training.algorithms import Algorithm
from kit.learning.training.checkpoint_file import MAX_NUMBER, LearnerCounts, check_actions, check_rows
from kit.learning.training.deep import LEARNING_RATE_FACTOR, EpisodeReporter
from kit.learning.training.learner import TrainingCallback
from kit.learning.training.presets import Preset

ADAM_DECAY: Final = (0.9, 0.999)
ADAM_EPSILON: Final = 1e-7
"""Adam's epsilon, as in Keras."""
DEFAULT_RATE: Final = LinearSchedule(1e-3, 1e-3)
DEFAULTS: Final = ReplayParams(
    buffer_size=50_000,
    learning_starts=100,
    batch_size=32,
    tau=1.0,
    gamma=0.99,
    train_freq=1,
    gradient_steps=1,
    target_update_interval=1,
    temperature=1.0,
    value_limit=math.inf,
)


class ReplayBatch(NamedTuple):
    """Some steps of the replay buffer: n of them."""

    seen: Float32Array
    """(n, inputs)"""
    actions: IntArray
    rewards: Float32Array
    terminated: BoolArray
    seen_next: Float32Array


class ReplayBuffer:
    """The last ``size`` steps."""

    def __init__(self, size: int, inputs: int) -> None:
        self._arrays = ReplayBatch(
            np.zeros((size, inputs), np.float32),
            np.zeros(size, np.int64),
            np.zeros(size, np.float32),
            np.zeros(size, np.bool_),
            np.zeros((size, inputs), np.float32),
        )
        self._size, self._added = size, 0

    @property
    def filled(self) -> int:
        return min(self._added, self._size)

    def add(self, steps: ReplayBatch) -> None:
        places = (self._added + np.arange(len(steps.rewards))) % self._size
        for name, values in steps._asdict().items():
            getattr(self._arrays, name)[places] = values
        self._added += len(places)

    def sample(self, rng: np.random.Generator, count: int) -> ReplayBatch:
        chosen = rng.integers(self.filled, size=count)
        seen, actions, rewards, terminated, seen_next = self._arrays
        return ReplayBatch(
            seen[chosen], actions[chosen], rewards[chosen], terminated[chosen], seen_next[chosen]
        )

    def save(self) -> bytes:
        file = io.BytesIO()
        np.savez(file, np.array(self._added), *(np.asarray(array)[: self.filled] for array in self._arrays))
        return file.getvalue()

    def load(self, data: bytes, actions: int) -> None:
        """Reads what ``save`` returned. Raises ValueError and KeyError for anything else, and where an action is none of so
        many."""
        with np.load(io.BytesIO(data), allow_pickle=False) as stored:
            added = int(stored["arr_0"])
            rows = [
                check_rows(stored[f"arr_{number}"], own) for number, own in enumerate(self._fields(), start=1)
            ]
        if not 0 <= added <= MAX_NUMBER or {len(each) for each in rows} != {min(added, self._size)}:
            raise ValueError("a replay buffer with other rows than it counts")
        check_actions(ReplayBatch(*rows).actions, actions)
        self._added = added
        for own, values in zip(self._fields(), rows, strict=True):
            own[: len(values)] = values

    def _fields(self) -> list[NDArray[Any]]:
        return list(self._arrays._asdict().values())


class QNetwork:
    """A network that gives a value for each action, and its Adam optimiser; all parameters in one array."""

    def __init__(self, sizes: Sequence[int], activation: Activation, rng: np.random.Generator) -> None:
        self._shapes = [shape for rows, columns in pairwise(sizes) for shape in ((rows, columns), (columns,))]
        self._activation = activation
        self.parameters: Float32Array = np.zeros(sum(math.prod(shape) for shape in self._shapes), np.float32)
        self.mean, self.square = np.zeros_like(self.parameters), np.zeros_like(self.parameters)
        self.updates = 0
        for weights in self.layer_views(self.parameters)[::2]:
            limit = math.sqrt(6.0 / sum(weights.shape))  # Glorot, as Keras begins
            weights[:] = rng.uniform(-limit, limit, weights.shape)

    def layer_views(self, parameters: Float32Array) -> list[Float32Array]:
        """Views of weights and biases, layer by layer."""
        views, first = [], 0
        for shape in self._shapes:
            views.append(parameters[first : first + math.prod(shape)].reshape(shape))
            first += math.prod(shape)
        return views

    def outputs(self, seen: Float32Array, parameters: Float32Array | None = None) -> list[Float32Array]:
        """What each layer gives for (n, inputs), the values (n, actions) last; by other parameters if they are given."""
        views = self.layer_views(self.parameters if parameters is None else parameters)
        found, x = [], seen
        for weights, bias in zip(views[:-2:2], views[1:-2:2], strict=True):
            x = x @ weights
            x += bias
            x = np.tanh(x) if self._activation == "tanh" else np.maximum(x, np.float32(0), out=x)
            found.append(x)
        found.append(x @ views[-2] + views[-1])
        return found

    def descend(self, batch: ReplayBatch, targets: Float32Array, rate: float) -> None:
        """Makes one step of gradient descent (Adam) on half the squared differences to the targets of the actions taken."""
        layers = [batch.seen, *self.outputs(batch.seen)]
        rows, count = np.arange(len(targets)), np.float32(len(targets))
        slope = np.zeros_like(layers[-1])
        slope[rows, batch.actions] = (layers[-1][rows, batch.actions] - targets) / count
        gradient = np.empty_like(self.parameters)
        parts, views = self.layer_views(gradient), self.layer_views(self.parameters)
        for number in reversed(range(len(layers) - 1)):
            inputs = layers[number]
            np.matmul(inputs.T, slope, out=parts[2 * number])
            slope.sum(axis=0, out=parts[2 * number + 1])
            if number:
                slope = slope @ views[2 * number].T
                slope *= 1 - inputs**2 if self._activation == "tanh" else inputs > 0
        self._adam_step(gradient, rate)

    def _adam_step(self, gradient: Float32Array, rate: float) -> None:
        one, other = ADAM_DECAY
        self.updates += 1
        self.mean += np.float32(1 - one) * (gradient - self.mean)
        self.square += np.float32(1 - other) * (gradient * gradient - self.square)
        correction = math.sqrt(1 - other**self.updates)
        scale = rate * correction / (1 - one**self.updates)
        self.parameters -= (
            np.float32(scale) * self.mean / (np.sqrt(self.square) + np.float32(ADAM_EPSILON * correction))
        )


class BoltzmannLearner:
    """Learns with ``n`` worlds at once, of a vector environment of stable-baselines3."""

    def __init__(self, algorithm: Algorithm, preset: Preset, choice: TaskSpec, venv: Any, seed: int) -> None:
        assert isinstance(preset.settings, ReplayParams)
        self._algorithm = algorithm
        self._preset = preset
        self._choice = choice
        self._env = EpisodeReporter(venv)
        self._rng = np.random.default_rng(seed)
        inputs, actions = int(venv.observation_space.shape[0]), int(venv.action_space.n)
        self._activation: Activation = preset.activation or "relu"
        self._network = QNetwork((inputs, *preset.layers, actions), self._activation, self._rng)
        self._target = self._network.parameters.copy()
        self._buffer = ReplayBuffer(int(self._setting("buffer_size")), inputs)
        self._steps = 0
        self._rate_factor = 1.0

    def _setting(self, name: str) -> float:
        """The preset's, or Keras-RL's."""
        own = getattr(self._preset.settings, name)
        return float(getattr(DEFAULTS, name) if own is None else own)

    # Learning

    def learn(self, steps: int, callback: TrainingCallback) -> None:
        self._env.callback = callback
        seen = self._env.reset()
        every, worlds = int(self._setting("train_freq")), self._env.num_envs
        target_every = max(1, int(self._setting("target_update_interval")) // worlds)
        calls = 0
        while self._steps < steps:
            callback.between_updates()
            seen = self._step_worlds(seen)
            calls += 1
            if calls % every == 0 and self._steps > self._setting("learning_starts"):
                self._update(1.0 - self._steps / steps)
            if calls % target_every == 0:
                self._target += np.float32(self._setting("tau")) * (self._network.parameters - self._target)

    def _step_worlds(self, seen: Float32Array) -> Float32Array:
        """One step of all worlds; what is seen then."""
        actions = self._sample_actions(seen)
        following, rewards, ended, infos = self._env.step(actions)
        reached, terminated = following, ended
        if ended.any():
            reached, terminated = following.copy(), ended.copy()
            for world in np.flatnonzero(ended):
                reached[world] = infos[world]["terminal_observation"]
                terminated[world] = not infos[world]["TimeLimit.truncated"]
        self._buffer.add(ReplayBatch(seen, actions, rewards, terminated, reached))
        self._steps += len(rewards)
        found: Float32Array = following
        return found

    def _sample_actions(self, seen: Float32Array) -> IntArray:
        """An action for each world, in proportion to exp(value / temperature)."""
        values = self._network.outputs(seen)[-1].astype(np.float64) / self._setting("temperature")
        limit = self._setting("value_limit")
        exponents = np.clip(values, -limit, limit)
        sums = np.exp(exponents - exponents.max(axis=1, keepdims=True)).cumsum(axis=1)
        drawn = self._rng.random(len(seen)) * sums[:, -1]
        actions: IntArray = (sums <= drawn[:, None]).sum(axis=1)
        return actions

    def _update(self, left: float) -> None:
        rate = self._rate_factor * (self._preset.learning_rate or DEFAULT_RATE).value_at(max(0.0, left))
        for _ in range(int(self._setting("gradient_steps"))):
            batch = self._buffer.sample(self._rng, int(self._setting("batch_size")))
            best = self._network.outputs(batch.seen_next, self._target)[-1].max(axis=1)
            targets = batch.rewards + np.float32(self._setting("gamma")) * best * ~batch.terminated
            self._network.descend(batch, targets, rate)

    def assign_cases(self, shares: FloatArray) -> None:
        batch = self._env.unwrapped.batch
        if batch.has_fixed_cases:
            batch.assign_cases(shares)

    # What every learner can do

    @property
    def steps(self) -> int:
        return self._steps

    def policy(self) -> Policy:
        views = self._network.layer_views(self._network.parameters.copy())
        layers = tuple(LinearLayer(*pair) for pair in zip(views[::2], views[1::2], strict=True))
        return Policy(
            PolicyNetwork(layers, self._activation),
            action_counts(self._env.action_space),
            ActionSampling("softmax", self._setting("temperature")),
            self._choice,
            self._steps,
            task_interface(self._env.unwrapped.batch.task),
        )

    def _arrays(self) -> dict[str, Float32Array]:
        network = self._network
        return {
            "parameters": network.parameters,
            "target": self._target,
            "mean": network.mean,
            "square": network.square,
        }

    def snapshot(self) -> Any:
        return self._network.updates, {name: array.copy() for name, array in self._arrays().items()}

    def restore(self, known: Any) -> None:
        self._network.updates, arrays = known
        for name, array in self._arrays().items():
            array[:] = arrays[name]
        self._rate_factor *= LEARNING_RATE_FACTOR

    def measures(self) -> dict[str, float]:
        recent = self._env.recent
        values = self._network.outputs(recent.observations)[-1].max(axis=1)
        return recent.measures(values, self._setting("gamma"), None)

    def save(self) -> dict[str, bytes]:
        file = io.BytesIO()
        np.savez(file, **self._arrays())  # type: ignore[arg-type]  # numpy's stub takes the names for its own options
        counts = LearnerCounts(
            self._algorithm.name,
            self._steps,
            self._rate_factor,
            self._network.updates,
            largest=self._env.recent.save(),
        )
        return {
            **counts.pack(),
            "network.npz": file.getvalue(),
            "replay.npz": self._buffer.save(),
        }

    def load(self, parts: Mapping[str, bytes]) -> None:
        counts = LearnerCounts.unpack(parts, self._algorithm.name)
        with np.load(io.BytesIO(parts["network.npz"]), allow_pickle=False) as stored:
            for name, array in self._arrays().items():
                if stored[name].shape != array.shape or not np.isfinite(stored[name]).all():
                    raise ValueError(f"{name} does not fit the network")
                array[:] = stored[name]
        self._buffer.load(parts["replay.npz"], int(self._env.action_space.n))
        self._steps, self._network.updates = counts.steps, counts.updates
        self._rate_factor = counts.slower
        self._env.recent.load(counts.largest)
