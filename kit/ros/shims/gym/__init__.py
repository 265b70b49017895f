"""The gym of Flatland's time, on gymnasium's spaces: for packages that import it where it is not installed.

``reset()`` returns the observation alone, ``step()`` four values. A learner of today wants it otherwise: what
stable-baselines3 is given is wrapped on its way there (``shimmy``), so the package's own calls stay as they are.
"""

from __future__ import annotations

from typing import Any, NoReturn

from gym import spaces
from gym.core import ActionWrapper, Env, ObservationWrapper, RewardWrapper, Wrapper
from gym.learners import adapt_checker
from kit.ros.execution.context import log_as_kit

__version__ = "0.21.0"

log_as_kit(
    "gym is not installed: gymnasium's spaces and an Env of gym 0.21 stand in for it; reset() returns the "
    "observation alone, step() four values, and stable-baselines3 gets the environment wrapped"
)
adapt_checker()


def make(name: str, **options: Any) -> NoReturn:
    """gym's registry of ready-made environments is not a part of this."""
    raise ImportError(
        f"gym is not installed, so there is no {name!r} to make; gymnasium, its successor, has most of its environments"
    )


__all__ = [
    "ActionWrapper",
    "Env",
    "ObservationWrapper",
    "RewardWrapper",
    "Wrapper",
    "make",
    "spaces",
]
