"""Parts of a learner as arrays: all of them come back, and nothing that is not of their size."""

from __future__ import annotations

import io
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from kit.array_archives import unpack_arrays
from tests.cases import every_case

if find_spec("torch") is None:
    pytest.skip("needs the extra learn", allow_module_level=True)

import torch
from torch import nn

from kit.learning.training.torch_parts import pack_parts, unpack_parts

if TYPE_CHECKING:
    from kit.learning.training.torch_parts import TorchParts


def trained(steps: int = 3) -> TorchParts:
    """A network, its optimiser, whose compiled code writes without a look at sizes, and a number beside them."""
    torch.set_num_threads(1)
    network = nn.Linear(40, 30)
    optimizer = torch.optim.Adam(network.parameters(), lr=steps, fused=True)
    for _ in range(steps):
        optimizer.zero_grad()
        network(torch.ones(2, 40)).sum().backward()
        optimizer.step()
    return {"network": network, "optimizer": optimizer, "weight": torch.tensor([float(steps)])}


def arrays(parts: TorchParts) -> dict[str, Any]:
    return {name: array.tolist() for name, array in unpack_arrays(pack_parts(parts), 1 << 20).items()}


@every_case("steps", [0, 3])
def test_all_parts_come_back_and_the_optimiser_stays_as_it_is_set(steps: int) -> None:
    one, other = trained(steps), trained(5)
    assert arrays(one) != arrays(other)
    unpack_parts(other, pack_parts(one))
    assert arrays(one) == arrays(other)
    optimizer = other["optimizer"]
    assert isinstance(optimizer, torch.optim.Optimizer)
    assert optimizer.param_groups[0]["lr"] == 5
    optimizer.step()


@every_case("shape", [(), (1,), (300, 400)])
@every_case("name", ["network/weight", "optimizer/0/exp_avg", "optimizer/0/exp_avg_sq", "optimizer/1/step"])
def test_an_array_of_another_size_is_refused(name: str, shape: tuple[int, ...]) -> None:
    parts = trained()
    changed = unpack_arrays(pack_parts(parts), 1 << 20)
    before, changed[name] = changed[name], np.zeros(shape, np.float32)
    if before.shape == shape:
        return
    file = io.BytesIO()
    np.savez(file, **changed)  # type: ignore[arg-type]  # numpy's stub takes the names for its own options
    with pytest.raises((ValueError, RuntimeError)):
        unpack_parts(trained(), file.getvalue())
