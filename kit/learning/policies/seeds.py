"""Seeds for the parts of an experiment, all from one."""

from __future__ import annotations

import numpy as np


def derive_seed(seed: int, purpose: str, number: int = 0) -> int:
    """A seed of its own for each use of a run's seed, so that no two uses see the same episodes."""
    words = np.random.SeedSequence((seed, number, *purpose.encode())).generate_state(1)
    return int(words[0])
