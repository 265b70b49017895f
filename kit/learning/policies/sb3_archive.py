"""Reads the policy out of a model that stable-baselines3 or sb3-contrib has saved, by its weights alone. No torch.

Such an archive also holds pickled Python objects: none of them is ever loaded. What the algorithm was is seen by the names of
the weights, and what lies between the layers by what the archive says in plain text.
"""

from __future__ import annotations

import base64
import io
import itertools
import json
import pickletools
import re
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from kit.array_archives import MAX_PACKED_BYTES, MAX_UNPACKED_BYTES, READ_ERRORS, read_arrays
from kit.arrays import Float32Array, FloatArray
from kit.learning.policies.policy import (
    ActionSampling,
    Policy,
    PolicyError,
    action_counts,
    check_network,
    task_interface,
)
from kit.learning.policies.policy_network import (
    Activation,
    LinearLayer,
    LstmLayer,
    PolicyNetwork,
    average_quantiles,
    join_heads,
)
from kit.learning.policies.torch_weights import read_torch_weights
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.task_spec import TaskSpec
from kit.plain_files import read_plain_file

WEIGHTS: Final = "policy.pth"
DESCRIPTION: Final = "data"
MAX_DESCRIPTION_BYTES: Final = 8 << 20
MAX_PICKLE_OPERATIONS: Final = 10_000
"""That are looked through for what a model saw last; its own pickle takes a few dozen."""
MAX_TOLD: Final = 60
"""Characters of what an archive says, in a message."""
ACTIVATIONS: Final[Mapping[str, Activation]] = {"Tanh": "tanh", "ReLU": "relu"}
NORMALISATION_KEY: Final = re.compile(r"(^|\.)(ra_mean|running_mean|num_batches_tracked)$")
"""Weights of a layer that normalises what goes through it."""
SLACK: Final = 1e-3
"""By which an observation may lie outside its space and count as inside."""
Weights = Mapping[str, Float32Array]

EXPORT_STATISTICS: Final = 'numpy.savez("statistics.npz", mean=env.obs_rms.mean, var=env.obs_rms.var, epsilon=env.epsilon, clip=env.clip_obs)'
"""The line that writes what a VecNormalize has learned of observations, which only a pickle holds otherwise."""


@dataclass(frozen=True, slots=True)
class _Parts:
    """What is needed of an archive."""

    model: PolicyNetwork
    sampling: ActionSampling
    critic: PolicyNetwork | None


def is_sb3_archive(file: Path) -> bool:
    """Whether a file looks like a model of stable-baselines3."""
    try:
        with zipfile.ZipFile(io.BytesIO(read_plain_file(file, MAX_PACKED_BYTES))) as archive:
            return {WEIGHTS, DESCRIPTION} <= set(archive.namelist())
    except READ_ERRORS:
        return False


def read_sb3_policy(
    file: Path,
    spec: TaskSpec,
    *,
    activation: Activation | None = None,
    statistics: Path | None = None,
) -> Policy:
    """The policy of a saved model that was trained on the task ``spec``.

    ``activation``: what lies between the layers, where the archive does not say it in plain text. ``statistics``: an ``.npz``
    with ``mean``, ``var``, ``epsilon`` and ``clip`` of the VecNormalize around its environment, as ``EXPORT_STATISTICS``
    writes it. PolicyError if the archive is damaged, of an unknown kind, or does not fit the task; FileNotFoundError.
    """
    task = spec.resolve()
    weights, about = _read_archive(file)
    choices = action_counts(task.actions.space(task.robots))
    if statistics is None and _is_normalised(about, task):
        raise PolicyError(
            f"{file}: it was trained on normalised observations. Write their statistics from Python with\n"
            f"    {EXPORT_STATISTICS}\nand pass statistics='statistics.npz'."
        )
    try:
        between = activation or _activation(about, weights)
        parts = _parts_of(weights, between, about, choices)
        model, critic = parts.model, parts.critic
        check_network(model, task)
        if statistics is not None:
            normal = _Normalisation.read(statistics, task)
            model = normal.before(model)
            critic = None if critic is None else normal.before(critic)
        steps = about.get("num_timesteps")
        policy = Policy(
            model,
            choices,
            parts.sampling,
            spec,
            steps if type(steps) is int else 0,
            task_interface(task),
            critic,
        )
        policy.check_fits(task)
        policy.check_consistent()
    except (LookupError, ValueError, OverflowError) as error:
        raise PolicyError(
            f"{file}: its weights do not fit one another, or task {task.name}: {error}. Was it trained on another task?"
        ) from None
    return policy


def _read_archive(file: Path) -> tuple[Weights, dict[str, Any]]:
    """The weights by name, and what the archive says in plain text."""
    try:
        with zipfile.ZipFile(io.BytesIO(read_plain_file(file, MAX_PACKED_BYTES))) as archive:
            sizes = {each.filename: each.file_size for each in archive.infolist()}
            if len(sizes) < len(archive.infolist()):
                raise ValueError("two parts of one name")
            if sizes[WEIGHTS] > MAX_UNPACKED_BYTES or sizes[DESCRIPTION] > MAX_DESCRIPTION_BYTES:
                raise ValueError("it unpacks to more than a policy needs")
            weights, about = read_torch_weights(archive.read(WEIGHTS)), json.loads(archive.read(DESCRIPTION))
        if not isinstance(about, dict):
            raise ValueError("its description is none")
    except FileNotFoundError:
        raise
    except (*READ_ERRORS, RecursionError, MemoryError) as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise PolicyError(f"{file}: not a model of stable-baselines3, or damaged ({reason[:200]}).") from None
    return weights, about


def _is_normalised(about: Mapping[str, Any], task: LearningTask) -> bool:
    """Whether what the model saw last lies outside what an agent of the task can see. The pickle is looked through for the
    bytes of that array, and not loaded."""
    space = task.observation.space(task.robots)
    size = space.shape[0]
    try:
        pickled = base64.b64decode(about["_last_obs"][":serialized:"])
        operations = itertools.islice(pickletools.genops(pickled), MAX_PICKLE_OPERATIONS)
        buffers = [given for _, given, _ in operations if isinstance(given, (bytes, bytearray))]
    except Exception:  # noqa: BLE001 - it holds none, or is damaged; its weights are judged by themselves
        return False
    rows = [np.frombuffer(each, np.float32) for each in buffers if len(each) and len(each) % (4 * size) == 0]
    return any(
        ((row.reshape(-1, size) < space.low - SLACK) | (row.reshape(-1, size) > space.high + SLACK)).any()
        for row in rows
    )


def _activation(about: Mapping[str, Any], weights: Weights) -> Activation:
    """What lies between the layers: as the archive says, else as its algorithm has it."""
    given = about.get("policy_kwargs")
    named = given.get("activation_fn") if isinstance(given, dict) else None
    if named is None:
        return "tanh" if any(name.startswith("mlp_extractor.") for name in weights) else "relu"
    for name, known in ACTIVATIONS.items():
        if re.search(rf"\b{name}\b", str(named)):
            return known
    raise PolicyError(
        f"between its layers lies {str(named)[:MAX_TOLD]}; the kit knows Tanh and ReLU. Train with one of them: "
        "policy_kwargs={'activation_fn': torch.nn.Tanh}."
    )


def _parts_of(
    weights: Weights, activation: Activation, about: Mapping[str, Any], choices: tuple[int, ...]
) -> _Parts:
    """Recognises the algorithm by the names of its weights. PolicyError for one that the kit does not know."""
    if any(
        name.startswith(("features_extractor.", "pi_features_extractor.", "actor.features_extractor."))
        for name in weights
    ):
        raise PolicyError(
            "its network has a part for pictures or dictionaries; the tasks of the kit give one row of numbers."
        )
    if any(NORMALISATION_KEY.search(name) for name in weights):
        raise PolicyError(
            "its layers normalise what goes through them, as CrossQ's do. Use `kit.export_policy(model, task)` in Python, "
            "where the model is at hand."
        )
    chance = about.get("exploration_rate", 0.0)
    epsilon = ActionSampling("epsilon", float(chance) if isinstance(chance, (int, float)) else 0.0)

    def network(prefix: str, *heads: str) -> PolicyNetwork:
        return PolicyNetwork(_linear_layers(weights, prefix, heads), activation)

    if "q_net.q_net.0.weight" in weights:
        return _Parts(network("q_net.q_net"), epsilon, None)
    if "quantile_net.quantile_net.0.weight" in weights:
        scores = network("quantile_net.quantile_net")
        return _Parts(average_quantiles(scores, scores.outputs // sum(choices)), epsilon, None)
    critic = network("critic.qf0") if "critic.qf0.0.weight" in weights else None
    if critic is not None and critic.outputs > 1:
        critic = average_quantiles(critic, critic.outputs)
    if "actor.latent_pi.0.weight" in weights:
        means, logarithms = (
            network("actor.latent_pi", "actor.mu"),
            network("actor.latent_pi", "actor.log_std"),
        )
        return _Parts(join_heads(means, logarithms), ActionSampling("tanh-normal"), critic)
    if "actor.mu.0.weight" in weights:
        model = network("actor.mu")
        return _Parts(model, ActionSampling("noisy-tanh", 1.0, (0.0,) * model.outputs), critic)
    if "action_net.weight" in weights:
        memory = _lstm_layer(weights)
        model = PolicyNetwork(
            _linear_layers(weights, "mlp_extractor.policy_net", ("action_net",)), activation, memory
        )
        value = None if memory else network("mlp_extractor.value_net", "value_net")
        if choices:
            return _Parts(model, ActionSampling("softmax"), value)
        deviations = np.exp(weights["log_std"].astype(float))
        return _Parts(model, ActionSampling("normal", 1.0, tuple(deviations.tolist())), value)
    if "action_net.0.weight" in weights:
        return _Parts(network("action_net"), ActionSampling("epsilon", 0.0), None)
    raise PolicyError(
        f"no network of a known algorithm: its weights are {', '.join(list(weights)[:4])[:MAX_TOLD]} ... The kit reads PPO, A2C, TRPO, "
        "RecurrentPPO, DQN, QRDQN, SAC, TQC, TD3, DDPG and ARS with an MlpPolicy."
    )


def _linear_layers(weights: Weights, prefix: str, heads: tuple[str, ...] = ()) -> tuple[LinearLayer, ...]:
    """The linear layers ``prefix.0``, ``prefix.2`` and so on, and behind them the heads."""
    pattern = re.compile(rf"{re.escape(prefix)}\.(\d+)\.weight")
    numbers = sorted(int(found[1]) for name in weights if (found := pattern.fullmatch(name)))
    names = [*(f"{prefix}.{number}" for number in numbers), *heads]
    layers = []
    for name in names:
        weight = weights[f"{name}.weight"]
        if weight.ndim != 2:
            raise ValueError(f"{name[:MAX_TOLD]}.weight has the shape {weight.shape}")
        bias = weights.get(f"{name}.bias", np.zeros(len(weight), dtype=np.float32))
        layers.append(LinearLayer(np.ascontiguousarray(weight.T), bias))
    return tuple(layers)


def _lstm_layer(weights: Weights) -> LstmLayer | None:
    if "lstm_actor.weight_ih_l0" not in weights:
        return None
    if "lstm_actor.weight_ih_l1" in weights:
        raise PolicyError("its memory has more than one layer, which the kit does not read.")

    def layer(name: str) -> LinearLayer:
        weight = weights[f"lstm_actor.weight_{name}_l0"]
        return LinearLayer(np.ascontiguousarray(weight.T), weights[f"lstm_actor.bias_{name}_l0"])

    return LstmLayer(layer("ih"), layer("hh"))


@dataclass(frozen=True, slots=True)
class _Normalisation:
    """``(observation - mean) / deviation``, which a first layer can do itself."""

    mean: FloatArray
    deviation: FloatArray

    @classmethod
    def read(cls, file: Path, task: LearningTask) -> _Normalisation:
        """Raises PolicyError for another file, and where what is cut off at ``clip`` would make another policy."""
        try:
            found = read_arrays(file)
            mean, variance = (np.asarray(found[name], dtype=float).reshape(-1) for name in ("mean", "var"))
            deviation = np.sqrt(variance + float(found["epsilon"]))
            clip = float(found["clip"])
        except FileNotFoundError:
            raise
        except Exception as error:  # noqa: BLE001 - whatever a damaged archive makes numpy raise
            raise PolicyError(
                f"{file}: no statistics ({error}). This line writes them:\n    {EXPORT_STATISTICS}"
            ) from None
        size = task.observation.size * task.robots
        if (
            not len(mean) == len(deviation) == size
            or not np.isfinite([*mean, *deviation]).all()
            or not (deviation > 0).all()
        ):
            raise PolicyError(f"{file}: statistics of {len(mean)} numbers; task {task.name} gives {size}.")
        space = task.observation.space(task.robots)
        furthest = np.maximum(np.abs(space.low - mean), np.abs(space.high - mean)) / deviation
        if (furthest > clip).any():
            raise PolicyError(
                f"{file}: what an agent sees of task {task.name} can be {furthest.max():.3g} deviations from its mean, and all "
                f"above {clip:g} was cut off in training: such a policy cannot be read. Train with a larger clip_obs."
            )
        return cls(mean, deviation)

    def before(self, network: PolicyNetwork) -> PolicyNetwork:
        """The network for observations as they are. What it sees besides, such as an action, stays as it is."""
        memory = network.lstm
        first = network.layers[0] if memory is None else memory.input_layer
        size = len(self.mean)
        weights = first.weights.astype(float)
        weights[:size] /= self.deviation[:, None]
        bias = first.bias - self.mean @ weights[:size]
        layer = LinearLayer(weights.astype(np.float32), bias.astype(np.float32))
        if memory is None:
            return PolicyNetwork((layer, *network.layers[1:]), network.activation)
        return PolicyNetwork(network.layers, network.activation, LstmLayer(layer, memory.recurrent_layer))
