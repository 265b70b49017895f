"""Policies as files: arrays and a description, without anything that could run."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from kit.array_archives import read_arrays
from kit.learning.policies.policy import ActionSampling, Policy, PolicyError, SamplingKind
from kit.learning.policies.policy_network import (
    ActionValueTable,
    Activation,
    LinearLayer,
    LstmLayer,
    PolicyNetwork,
)
from kit.learning.policies.sb3_archive import is_sb3_archive, read_sb3_policy
from kit.learning.tasks.catalogue import find_task, task_names
from kit.learning.tasks.task_spec import TaskSpec
from kit.plain_text import quoted
from kit.workspace import write_atomically

FORMAT_VERSION = 1
TORCH_SUFFIXES = (".pt", ".pth")


def save_policy(policy: Policy, file: Path | str) -> None:
    """Writes a policy, atomically, as an ``.npz`` of plain arrays and one text, which every command takes that takes a policy.

    Raises OSError if it cannot be written.

    >>> kit.save_policy(kit.load_policy("best.npz"), "mine.npz")
    """
    write_atomically(Path(file), policy_bytes(policy))


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


def load_policy(
    file: Path | str,
    task: Path | str | None = None,
    *,
    activation: Activation | None = None,
    statistics: Path | str | None = None,
) -> Policy:
    """Reads a trained policy: a file of the kit's, such as a run's ``best.npz``, which needs no torch, or a model that
    stable-baselines3 or sb3-contrib has saved (``.zip``), of which the weights alone are read and nothing is run.

    ``task``: the name or file that the model was trained on; a file of the kit's says it itself. ``activation``: ``tanh`` or
    ``relu``, where a model does not say what lies between its layers. ``statistics``: those of the VecNormalize around its
    environment, where it had one; what is raised without them has the line that writes them.

    Raises PolicyError if the file is damaged or does not fit the task, and FileNotFoundError if there is none.

    >>> policy = kit.load_policy("best.npz")
    >>> policy.trained_on.task
    'turn'
    """
    file = Path(file)
    if is_sb3_archive(file):
        if task is None:
            raise PolicyError(
                f"{file} is a model of stable-baselines3, which does not say what it was trained on: "
                f"kit.load_policy({str(file)!r}, task='turn') reads it, and kit.save_policy(policy, {file.stem + '.npz'!r}) makes a "
                "file of it that every command takes."
            )
        return read_sb3_policy(
            file,
            TaskSpec(str(task)).frozen(),
            activation=activation,
            statistics=None if statistics is None else Path(statistics),
        )
    try:
        policy = _policy_from_arrays(read_arrays(file))
    except FileNotFoundError:
        raise
    except Exception as error:  # noqa: BLE001 - whatever a damaged archive makes numpy raise
        if file.suffix in TORCH_SUFFIXES:
            raise PolicyError(
                f"{file}: what torch saves does not say which network it belongs to. Save the whole model with "
                "stable-baselines3, model.save('model.zip'), and read it with kit.load_policy('model.zip', task='turn'); a "
                "training of the kit's writes best.npz, which `kit evaluate` takes."
            ) from None
        if file.suffix == ".zip":
            raise PolicyError(
                f"{file}: not a model of stable-baselines3, or damaged: save it again."
            ) from None
        raise PolicyError(f"{file}: not a policy, or damaged ({error}). `kit runs` lists the runs.") from None
    if task is not None:
        policy.check_fits(find_task(str(task)))
    return policy


def _policy_from_arrays(arrays: dict[str, NDArray[Any]]) -> Policy:
    about = json.loads(arrays["about"].tobytes())
    if about["format"] != FORMAT_VERSION:
        raise ValueError(f"format {about['format']}, this kit reads {FORMAT_VERSION}")
    task = TaskSpec.from_dict(about["task"])
    if task.text is None and task.task not in task_names():  # a policy may be anybody's, and name any file
        raise ValueError(f"there is no task {quoted(task.task)}, and it does not hold it")
    kind, amount = about["chance"]
    known_kind = next(each for each in get_args(SamplingKind) if each == kind)
    policy = Policy(
        _table_from_arrays(arrays, about["inputs"])
        if "values" in arrays
        else _network_from_arrays(arrays, about["activation"]),
        tuple(map(int, about["choices"])),
        ActionSampling(known_kind, float(amount), tuple(map(float, about.get("deviations", ())))),
        task,
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
    return ActionValueTable(arrays["used"], arrays["edges"], arrays["values"], int(inputs))


def _network_from_arrays(arrays: dict[str, NDArray[Any]], activation: str) -> PolicyNetwork:
    def layer(name: str) -> LinearLayer:
        return LinearLayer(arrays[f"weights_{name}"], arrays[f"bias_{name}"])

    count = sum(name.removeprefix("weights_").isdigit() for name in arrays)
    known: Activation = next(each for each in get_args(Activation) if each == activation)
    lstm = LstmLayer(layer("seen"), layer("kept")) if "weights_seen" in arrays else None
    return PolicyNetwork(tuple(layer(str(number)) for number in range(count)), known, lstm)
