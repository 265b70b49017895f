"""Networks and tables that give every action a score for what is seen, as plain arrays. No torch."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from kit.arrays import Float32Array, IntArray

Activation = Literal["tanh", "relu"]

MAX_TABLE_INPUTS = 62
"""That a table looks at: with two bins each, its rows can just be counted."""


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


def join_heads(means: PolicyNetwork, log_deviations: PolicyNetwork) -> PolicyNetwork:
    """One network of two that differ in their last layer: it gives means, then logarithms of standard deviations."""
    one, other = means.layers[-1], log_deviations.layers[-1]
    joined = LinearLayer(
        np.concatenate((one.weights, other.weights), axis=1), np.concatenate((one.bias, other.bias))
    )
    return PolicyNetwork((*means.layers[:-1], joined), means.activation)


def average_quantiles(network: PolicyNetwork, quantiles: int) -> PolicyNetwork:
    """The mean of a value's quantiles is linear in the last layer, so that layer can give it at once."""
    last = network.layers[-1]
    weights = last.weights.reshape(len(last.weights), quantiles, -1).mean(axis=1)
    bias = last.bias.reshape(quantiles, -1).mean(axis=0)
    return PolicyNetwork((*network.layers[:-1], LinearLayer(weights, bias)), network.activation)


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
        if used.ndim != 1 or used.dtype.kind != "i" or len(used) > MAX_TABLE_INPUTS:
            raise ValueError("no list of the inputs that it looks at, or too long a one")
        if len(set(used.tolist())) < len(used) or ((used < 0) | (used >= self.inputs)).any():
            raise ValueError("it looks at inputs twice, or at some that it does not see")
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
