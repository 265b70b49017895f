"""Chances of moves, and draws by them."""

from __future__ import annotations

import numpy as np

from kit.arrays import FloatArray


def softmax(logits: FloatArray) -> FloatArray:
    """Returns probabilities (..., n) that sum to 1, from any numbers (..., n)."""
    powers = np.exp(logits - logits.max(axis=-1, keepdims=True))
    chances: FloatArray = powers / powers.sum(axis=-1, keepdims=True)
    return chances


def draw(chances: FloatArray, rng: np.random.Generator) -> int:
    """Draws one of ``n`` numbers by its chance (n,)."""
    return int(np.searchsorted(np.cumsum(chances)[:-1], rng.random()))
