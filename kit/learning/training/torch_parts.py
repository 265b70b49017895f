"""Parameters of torch's networks and the states of their optimisers as plain arrays, each of the size that its own has.

``torch.load`` would take from a file tensors of any size and with shared numbers, which an optimiser's compiled code then writes
beyond: such a checkpoint of somebody else's ends the process, or runs in it.
"""

from __future__ import annotations

import io
from collections.abc import Mapping
from itertools import chain
from typing import Any

import numpy as np
import torch
from torch import nn
from torch.optim import Optimizer

from kit.array_archives import unpack_arrays
from kit.learning.training.checkpoint_file import MAX_CHECKPOINT_BYTES

TorchParts = Mapping[str, nn.Module | Optimizer | torch.Tensor]
"""What a learner has trained, by name. How its optimisers are set is no part of it: that is the preset's."""
OPTIMIZER_STATES: Mapping[str, frozenset[str]] = {
    "Adam": frozenset({"step", "exp_avg", "exp_avg_sq"}),
    "RMSprop": frozenset({"step", "square_avg"}),
}
"""What an optimiser keeps for each parameter once it has made a step."""


def pack_parts(parts: TorchParts) -> bytes:
    arrays: dict[str, Any] = {}
    for name, part in parts.items():
        if isinstance(part, torch.Tensor):
            arrays[name] = part.detach()
        elif isinstance(part, Optimizer):
            for number, values in part.state_dict()["state"].items():
                arrays |= {f"{name}/{number}/{key}": value for key, value in values.items()}
        else:
            arrays |= {f"{name}/{key}": value for key, value in part.state_dict().items()}
    file = io.BytesIO()
    np.savez(file, **arrays)
    return file.getvalue()


def unpack_parts(parts: TorchParts, data: bytes) -> None:
    """Puts what was packed into parts that are built alike. Raises KeyError, ValueError and RuntimeError for what does not fit."""
    stored = {
        # In the order of memory that torch's own have: an optimiser's compiled code goes by that.
        name: torch.from_numpy(np.asarray(array, order="C"))
        for name, array in unpack_arrays(data, MAX_CHECKPOINT_BYTES).items()
    }
    for name, part in parts.items():
        if isinstance(part, torch.Tensor):
            part.data.copy_(stored[name])
        elif isinstance(part, Optimizer):
            state = {}
            parameters = chain.from_iterable(group["params"] for group in part.param_groups)
            for number, parameter in enumerate(parameters):
                prefix = f"{name}/{number}/"
                found = {key.removeprefix(prefix): stored[key] for key in stored if key.startswith(prefix)}
                if found and found.keys() != OPTIMIZER_STATES[type(part).__name__]:
                    raise ValueError(f"{name} lacks a state")
                if any(
                    value.shape != (() if key == "step" else parameter.shape) for key, value in found.items()
                ):
                    raise ValueError(f"{name} does not fit the network")
                if found:
                    state[number] = found
            part.load_state_dict({**part.state_dict(), "state": state})
        else:
            part.load_state_dict({key: stored[f"{name}/{key}"] for key in part.state_dict()})
