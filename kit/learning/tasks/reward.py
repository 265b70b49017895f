"""A reward: a weighed sum of terms, or a student's own function of a transition."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from kit.learning.tasks.reward_terms import TERMS, term_settings
from kit.learning.tasks.transition import Array, Transition
from kit.plain_text import quoted, suggestion

RewardFunction: TypeAlias = Callable[[Transition], Array]
"""A student's reward: a transition of ``n`` worlds -> (n,) rewards."""


def check_reward(reward: object) -> None:
    """Raises TypeError for what was given as a reward and is neither None nor a function, such as a file's name."""
    if reward is not None and not callable(reward):
        raise TypeError(
            f"reward must be a function of a transition, not {quoted(str(reward))}. A file is the reward of a task whose file "
            "says `reward: {file: NAME}`, or of a training with `kit train --reward NAME`."
        )


class UnknownRewardTerm(LookupError):
    """No term has that name; the message offers the nearest one."""


@dataclass(frozen=True, slots=True)
class TermWeight:
    """The weight of a reward term. Raises UnknownRewardTerm."""

    term: str
    """A name in ``TERMS``."""
    value: float
    at_end: bool = True
    """Whether it also counts in the step that ends the episode."""
    settings: tuple[tuple[str, float], ...] = ()
    """Values of the term's settings, by name; the others are as ``term_settings`` says."""

    def __post_init__(self) -> None:
        if self.term not in TERMS:
            raise UnknownRewardTerm(
                f"there is no reward term {quoted(self.term)}: {suggestion(self.term, TERMS)}"
            )
        known = term_settings(self.term)
        for name, _ in self.settings:
            if name not in known:
                raise UnknownRewardTerm(
                    f"the reward term {self.term} has no setting {quoted(name)}: {suggestion(name, known)}"
                )

    def __call__(self, transition: Transition) -> Array:
        """(...) what the term earns, before it is weighed."""
        function = TERMS[self.term]
        return function(transition, **dict(self.settings)) if self.settings else function(transition)


@dataclass(frozen=True, slots=True)
class Reward:
    """A weighed sum of terms."""

    name: str
    weights: tuple[TermWeight, ...]
    scale: float = 1.0
    """Factor of the whole sum."""
    is_small: bool = False
    """Whether an episode earns a few units as it stands; the dissertation's rewards come to hundreds."""

    def terms(self, transition: Transition) -> dict[str, Array]:
        """(...) each: what every term adds to the reward, weight and scale included."""
        going = None if all(weight.at_end for weight in self.weights) else ~transition.ended
        found = {}
        for weight in self.weights:
            earned = weight(transition) if weight.settings else TERMS[weight.term](transition)
            value = (self.scale * weight.value) * earned
            found[weight.term] = value if weight.at_end or going is None else value * going
        return found

    def __call__(self, transition: Transition) -> Array:
        """(...) the reward."""
        return np.asarray(sum(self.terms(transition).values()))
