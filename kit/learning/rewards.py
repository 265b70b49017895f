"""Rewards: a sum of named terms, weighed in one place; the dissertation's three, and ours.

A term is a function of a transition. It is plain arithmetic on arrays: the same function serves one world
(fields of shape ``()``) and many (``(n,)``). What belongs to a robot has one more axis, the robots.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from types import MappingProxyType
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from kit.learning.actions import Move

Array: TypeAlias = NDArray[Any]


@dataclass(frozen=True, slots=True, eq=False)
class Transition:
    """What one step did: everything a reward may depend on. Metres, seconds, radians.

    Shapes: ``...`` is ``()`` for one world and ``(n,)`` for many; R is the number of robots.
    """

    step: Array
    """(...) int: steps of this episode, this one included."""
    max_steps: int
    collided: Array
    """(...) bool: a robot met a wall or the other robot."""
    reached: Array
    """(...) bool: every robot is in the target, and none has collided."""
    timed_out: Array
    """(...) bool: the last step has passed, without the two above."""
    case: Array
    """(...) int: number of the case."""
    move: Array
    """(..., R) int: what each robot did, a ``Move``."""
    previous_move: Array
    """(..., R) int: what it did the step before; -1 in the first."""
    pose: Array
    """(..., R, 3) ``x y theta`` after the step."""
    front: Array
    """(..., R) range straight ahead, as far as the agent sees."""
    front_left: Array
    """(..., R) range 8 degrees to the left of ahead."""
    front_right: Array
    """(..., R)"""
    nearest: Array
    """(..., R) the shortest range of all."""
    in_target: Array
    """(..., R) bool"""
    was_in_target: Array
    """(..., R) bool: the same, before the step."""
    distance: Array
    """(..., R) to the target, as the task measures it."""
    previous_distance: Array
    """(..., R)"""
    bearing: Array
    """(..., R) of the target, from straight ahead, to the left positive, in [-pi, pi)."""
    previous_bearing: Array
    """(..., R)"""
    to_go: Array
    """(..., R) along the shortest way to the target's usual place that keeps clear of walls."""
    previous_to_go: Array
    """(..., R)"""
    full_turns: Array
    """(..., R) int: whole turns without ever turning to the other side."""
    forward_share: Array
    """(..., R) steps forward in this episode, this one included; one along a curve counts half."""
    adjacent: Array
    """(...) bool: two robots side by side, as their four side rays tell. False for one robot."""
    abreast: Array
    """(...) how well two robots stand side by side, 0 to 1, by their poses. 0 for one robot."""

    @property
    def ended(self) -> Array:
        """(...) bool"""
        ended: Array = self.collided | self.reached | self.timed_out
        return ended

    def at(self, index: Any) -> Transition:
        """The transition of one world, or of some, out of many."""
        return Transition(
            **{
                field.name: value if field.name == "max_steps" else value[index]
                for field in fields(self)
                for value in [getattr(self, field.name)]
            }
        )


Term: TypeAlias = Callable[[Transition], Array]
"""(...) what a transition earns by one rule, before it is weighed."""

RewardFunction: TypeAlias = Callable[[Transition], Array]
"""A student's reward: a transition of ``n`` worlds -> (n,) rewards."""

TERMS: Mapping[str, Term] = MappingProxyType({})


@dataclass(frozen=True, slots=True)
class Weight:
    """How much a term counts."""

    term: str
    """A name in ``TERMS``."""
    value: float
    at_end: bool = True
    """Whether it also counts in the step that ends the episode."""


@dataclass(frozen=True, slots=True)
class Reward:
    """A weighed sum of terms."""

    name: str
    weights: tuple[Weight, ...]
    scale: float = 1.0
    """Of the whole sum."""

    def terms(self, transition: Transition) -> dict[str, Array]:
        """(...) each: what every term adds to the reward, weight and scale included."""
        raise NotImplementedError

    def __call__(self, transition: Transition) -> Array:
        """(...) the reward."""
        return np.asarray(sum(self.terms(transition).values()))


_ = Move
