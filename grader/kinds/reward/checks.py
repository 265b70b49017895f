"""Checks of reward functions: their values for single steps and whole drives, and the behaviour optimal under them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np

from grader.check import Check, NoParams, check
from grader.kinds.reward.behaviours import BehaviourComparison
from grader.kinds.reward.evidence import RewardEvidence
from grader.kinds.reward.reward_training import RewardTrainingParams


@dataclass(frozen=True, slots=True)
class RewardBoundParams:
    limit: float = 1e5
    """The largest magnitude of a reward."""


@check(none=0, full=1, words=("out of bounds", "fine"), params=RewardBoundParams)
def contract(evidence: RewardEvidence, params: RewardBoundParams) -> float:
    """The reward of a single step is larger than the task allows. Smaller numbers teach the same, and faster."""
    return 1.0 if float(np.abs(evidence.rewards).max()) <= params.limit else 0.0


@check(none=0, full=1, words=("changes", "always the same"))
def pure(evidence: RewardEvidence, params: NoParams) -> float:
    """The same step does not always get the same reward. A reward may depend on nothing but what it is given: no
    counting, no remembering, no chance, no clock."""
    return 1.0 if evidence.is_pure else 0.0


@check(none=0.9, full=0.995, unit="%")
def symmetric(evidence: RewardEvidence, params: NoParams) -> float:
    """Mirror or turn the whole world and the reward is another one; only {actual} of the steps keep theirs. The robot
    would learn to prefer a side."""
    return evidence.symmetry


@check(none=0.5, full=1, unit="%")
def shaped(evidence: RewardEvidence, params: NoParams) -> float:
    """Of two drives that are equally long and do not arrive, the one that comes nearer must be paid more, and by so much that
    it is noticed beside the largest reward; that holds for {actual} of the comparisons. A reward for arriving alone tells a
    beginner nothing on the way."""
    return _ordered_share(evidence.approaches)


@check(none=0.4, full=1, unit="%")
def ordered(evidence: RewardEvidence, params: NoParams) -> float:
    """Better drives must be paid more, all in all; that holds for {actual} of the comparisons."""
    return _ordered_share(evidence.behaviours)


@check(none=0.5, full=1, unit="%")
def loops(evidence: RewardEvidence, params: NoParams) -> float:
    """Going round in a loop must not pay by itself, nor as well as arriving; that holds for {actual} of the loops that were
    tried."""
    return (
        float(np.mean([not loop.is_profitable for loop in evidence.loops]))
        if evidence.loops
        else float("nan")
    )


@check(none=0.5, full=0.999, unit="%")
def planned(evidence: RewardEvidence, params: NoParams) -> float:
    """A robot that does exactly what this reward asks for reaches the target in {actual} of all cases; {full} earns all
    points. The picture shows what it does instead: that is what your reward pays best."""
    return evidence.plan_outcome.success


@check(none=0.2, full=0.6, unit="%", params=RewardTrainingParams)
def trained(evidence: RewardEvidence, params: RewardTrainingParams) -> float:
    """A robot that was trained with this reward reaches its target in {actual} of its episodes; {full} is wanted. A
    reward may be right and still teach slowly: does every step tell the robot something?"""
    return evidence.success_after_training(params)


CHECKS: Final[Mapping[str, Check]] = MappingProxyType(
    {each.name: each for each in (contract, pure, symmetric, shaped, ordered, loops, planned, trained)}
)
"""Every check of a reward, by name."""


def _ordered_share(pairs: Sequence[BehaviourComparison]) -> float:
    return float(np.mean([pair.is_ordered for pair in pairs])) if pairs else float("nan")
