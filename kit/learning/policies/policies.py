"""Policies as plain arrays: the result of training, and all that driving needs. No torch.

A policy is the rule that chooses actions. Here it is a brain, which gives every action a score for what is seen, and
a way to choose by these scores: the best (greedy), or by chance (sampled), as the algorithm did while it learned.
"""

from __future__ import annotations

import io
import json
import math
import sys
import zipfile
from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from kit.array_archives import read_arrays
from kit.arrays import BoolArray, Float32Array, IntArray
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.task_spec import TaskSpec
from kit.workspace import write_atomically

Activation = Literal["tanh", "relu"]
SamplingKind = Literal["softmax", "epsilon", "normal", "tanh-normal", "noisy-tanh"]
DEVIATION_KINDS = ("normal", "noisy-tanh")
"""Continuous actions that scatter alike for everything that is seen."""
CONTINUOUS_KINDS = (*DEVIATION_KINDS, "tanh-normal")
LOG_DEVIATION_RANGE = (-20.0, 2.0)
"""Within this stays the logarithm of a standard deviation that a network gives, as in stable-baselines3."""


class PolicyError(Exception):
    """A policy's file is damaged, or the policy does not fit the task; the message says which and what to do."""


def _check_numbers(array: NDArray[Any], dimensions: int) -> None:
    """Raises ValueError unless it is an array of finite floating-point numbers with this many dimensions."""
    if array.ndim != dimensions or array.dtype.kind != "f":
        raise ValueError(f"an array of shape {array.shape} and type {array.dtype}")
    if not np.isfinite(array).all():
        raise ValueError("an array with numbers that are not finite")


@dataclass(frozen=True, slots=True, eq=False)
class LinearLayer:
    """A linear layer: ``x @ weights + bias``."""

    weights: Float32Array
    """(inputs, outputs)"""
    bias: Float32Array
    """(outputs,)"""


@dataclass(frozen=True, slots=True, eq=False)
class LstmLayer:
    """A layer with memory (Hochreiter and Schmidhuber 1997), its gates in torch's order: in, forget, cell, out."""

    input_layer: LinearLayer
    """(inputs, 4 * h)"""
    recurrent_layer: LinearLayer
    """(h, 4 * h)"""

    @property
    def size(self) -> int:
        return len(self.recurrent_layer.weights)

    def step(self, x: Float32Array, memory: Float32Array) -> tuple[Float32Array, Float32Array]:
        """(n, h) outputs and the next memory, from inputs (n, inputs) and memory (n, 2, h): hidden, cell."""
        gates = (
            x @ self.input_layer.weights
            + self.input_layer.bias
            + memory[:, 0] @ self.recurrent_layer.weights
            + self.recurrent_layer.bias
        )
        enter, forget, cell, out = np.split(gates, 4, axis=1)
        kept = _sigmoid(forget) * memory[:, 1] + _sigmoid(enter) * np.tanh(cell)
        hidden = _sigmoid(out) * np.tanh(kept)
        return hidden, np.stack((hidden, kept), axis=1)


def _sigmoid(x: Float32Array) -> Float32Array:
    """Written with tanh, which does not overflow."""
    y: Float32Array = (np.tanh(x * np.float32(0.5)) + np.float32(1)) * np.float32(0.5)
    return y


@dataclass(frozen=True, slots=True, eq=False)
class PolicyNetwork:
    """A feed-forward network, perhaps with a memory in front."""

    layers: tuple[LinearLayer, ...]
    activation: Activation
    """Between the layers, not after the last."""
    lstm: LstmLayer | None = None

    @property
    def inputs(self) -> int:
        return len((self.lstm.input_layer if self.lstm else self.layers[0]).weights)

    @property
    def outputs(self) -> int:
        return len(self.layers[-1].bias)

    @property
    def memory(self) -> int:
        return self.lstm.size if self.lstm else 0

    def check_shapes(self) -> None:
        """Raises ValueError unless the layers are arrays of numbers and fit one another."""
        layers = [*((self.lstm.input_layer, self.lstm.recurrent_layer) if self.lstm else ()), *self.layers]
        for layer in layers:
            _check_numbers(layer.weights, 2)
            _check_numbers(layer.bias, 1)
            if layer.weights.shape[1:] != layer.bias.shape:
                raise ValueError(f"weights of shape {layer.weights.shape} with {len(layer.bias)} biases")
        size = self.inputs
        if self.lstm is not None:
            size = self.lstm.size
            if {len(layer.bias) for layer in layers[:2]} != {4 * size}:
                raise ValueError(f"a memory of {size} numbers with gates of other sizes")
        for layer in self.layers:
            if len(layer.weights) != size:
                raise ValueError(f"a layer for {len(layer.weights)} numbers after one that gives {size}")
            size = len(layer.bias)

    def scores(self, observations: Float32Array, memory: Float32Array) -> tuple[Float32Array, Float32Array]:
        """(n, outputs) and the next memory (n, 2, h), from (n, inputs) and the last one."""
        with np.errstate(over="ignore", invalid="ignore"):  # weights of a damaged file may be as large as any
            return self._scores(observations, memory)

    def _scores(self, observations: Float32Array, memory: Float32Array) -> tuple[Float32Array, Float32Array]:
        x = observations
        if self.lstm is not None:
            x, memory = self.lstm.step(x, memory)
        for layer in self.layers[:-1]:
            x = x @ layer.weights + layer.bias
            x = np.tanh(x) if self.activation == "tanh" else np.maximum(x, np.float32(0))
        last = self.layers[-1]
        return x @ last.weights + last.bias, memory


@dataclass(frozen=True, slots=True, eq=False)
class ActionValueTable:
    """One row of scores for each state; a state is in which bins a few of the inputs lie."""

    used: IntArray
    """(k,) which inputs count."""
    edges: Float32Array
    """(b - 1,) between the bins, rising."""
    values: Float32Array
    """(b ** k, outputs)"""
    inputs: int

    @property
    def outputs(self) -> int:
        return int(self.values.shape[1])

    @property
    def memory(self) -> int:
        return 0

    def check_shapes(self) -> None:
        """Raises ValueError unless the arrays hold numbers and fit one another."""
        _check_numbers(self.edges, 1)
        _check_numbers(self.values, 2)
        used = self.used
        if used.ndim != 1 or used.dtype.kind != "i" or ((used < 0) | (used >= self.inputs)).any():
            raise ValueError(f"it looks at inputs that are not among its {self.inputs}")
        if not (np.diff(self.edges) > 0).all() or len(self.values) != (len(self.edges) + 1) ** len(used):
            raise ValueError(f"a table of {len(self.values)} rows for {len(used)} inputs")

    def states(self, observations: Float32Array) -> IntArray:
        """(n,) row numbers, from (n, inputs)."""
        bins = self.edges.searchsorted(observations[:, self.used], side="right")
        weights = (len(self.edges) + 1) ** np.arange(len(self.used))[::-1]
        states: IntArray = bins @ weights
        return states

    def scores(self, observations: Float32Array, memory: Float32Array) -> tuple[Float32Array, Float32Array]:
        """(n, outputs); a table has no memory."""
        return self.values[self.states(observations)], memory


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


@dataclass(frozen=True, slots=True, eq=False)
class Policy:
    """Which actions for which observations."""

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
        if self.choices and (min(self.choices) < 1 or self.model.outputs != sum(self.choices)):
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
            return self._draw(self.scores)
        parts = np.split(self.scores, np.cumsum(choices)[:-1], axis=1)
        chosen = np.stack([self._choose(part) for part in parts], axis=1)
        return chosen[:, 0] if len(choices) == 1 else chosen

    def _draw(self, outputs: Float32Array) -> Float32Array:
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

    def _choose(self, scores: Float32Array) -> IntArray:
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


FORMAT_VERSION = 1


def save_policy(policy: Policy, file: Path) -> None:
    """Writes it, atomically, as an ``.npz`` of plain arrays and one text. OSError if it cannot be written."""
    write_atomically(file, policy_bytes(policy))


def policy_bytes(policy: Policy) -> bytes:
    """The bytes that ``save_policy`` writes."""
    about = {
        "format": FORMAT_VERSION,
        "choices": policy.choices,
        "chance": [policy.sampling.kind, policy.sampling.amount],
        **({"deviations": policy.sampling.deviations} if policy.sampling.deviations else {}),
        "task": policy.trained_on.as_dict(),
        "steps": policy.steps,
        "activation": getattr(policy.model, "activation", None),
        "inputs": policy.model.inputs,
        "interface": policy.interface,
        **({} if policy.critic is None else {"critic": policy.critic.activation}),
    }
    text = np.frombuffer(json.dumps(about).encode(), dtype=np.uint8)
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:  # what numpy.savez does, but always with the same bytes
        for name, array in {"about": text, **_arrays_of(policy.model), **_critic_arrays(policy)}.items():
            with archive.open(zipfile.ZipInfo(f"{name}.npy"), "w") as member:
                np.lib.format.write_array(member, array, allow_pickle=False)
    return buffer.getvalue()


def _arrays_of(model: PolicyNetwork | ActionValueTable) -> dict[str, NDArray[Any]]:
    if isinstance(model, ActionValueTable):
        return {"used": model.used, "edges": model.edges, "values": model.values}
    layers = [*((model.lstm.input_layer, model.lstm.recurrent_layer) if model.lstm else ()), *model.layers]
    names = [*(("seen", "kept") if model.lstm else ()), *(str(number) for number in range(len(model.layers)))]
    named: dict[str, NDArray[Any]] = {}
    for name, layer in zip(names, layers, strict=True):
        named[f"weights_{name}"], named[f"bias_{name}"] = layer.weights, layer.bias
    return named


def _critic_arrays(policy: Policy) -> dict[str, NDArray[Any]]:
    if policy.critic is None:
        return {}
    return {f"critic_{name}": array for name, array in _arrays_of(policy.critic).items()}


def load_policy(file: Path | str) -> Policy:
    """Reads a trained policy, such as a run's ``best.npz``; needs no torch.

    Raises PolicyError if the file is damaged and FileNotFoundError if there is none.

    >>> policy = kit.load_policy("best.npz")
    >>> policy.trained_on.task
    'turn'
    """
    file = Path(file)
    try:
        return _policy_from_arrays(read_arrays(file))
    except FileNotFoundError:
        raise
    except Exception as error:  # noqa: BLE001 - whatever a damaged archive makes numpy raise
        raise PolicyError(f"{file}: not a policy, or damaged ({error}). `kit runs` lists the runs.") from None


def _policy_from_arrays(arrays: dict[str, NDArray[Any]]) -> Policy:
    about = json.loads(arrays["about"].tobytes())
    if about["format"] != FORMAT_VERSION:
        raise ValueError(f"format {about['format']}, this kit reads {FORMAT_VERSION}")
    kind, amount = about["chance"]
    known_kind = next(each for each in get_args(SamplingKind) if each == kind)
    policy = Policy(
        _table_from_arrays(arrays, about["inputs"])
        if "values" in arrays
        else _network_from_arrays(arrays, about["activation"]),
        tuple(map(int, about["choices"])),
        ActionSampling(known_kind, float(amount), tuple(map(float, about.get("deviations", ())))),
        TaskSpec.from_dict(about["task"]),
        int(about["steps"]),
        about["interface"],
        _network_from_arrays(_critics_own(arrays), about["critic"]) if "critic" in about else None,
    )
    policy.check_consistent()
    return policy


def _critics_own(arrays: dict[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    return {
        name.removeprefix("critic_"): array for name, array in arrays.items() if name.startswith("critic_")
    }


def _table_from_arrays(arrays: dict[str, NDArray[Any]], inputs: int) -> ActionValueTable:
    return ActionValueTable(arrays["used"], arrays["edges"], arrays["values"], inputs)


def _network_from_arrays(arrays: dict[str, NDArray[Any]], activation: str) -> PolicyNetwork:
    def layer(name: str) -> LinearLayer:
        return LinearLayer(arrays[f"weights_{name}"], arrays[f"bias_{name}"])

    count = sum(name.removeprefix("weights_").isdigit() for name in arrays)
    known: Activation = next(each for each in get_args(Activation) if each == activation)
    lstm = LstmLayer(layer("seen"), layer("kept")) if "weights_seen" in arrays else None
    return PolicyNetwork(tuple(layer(str(number)) for number in range(count)), known, lstm)
