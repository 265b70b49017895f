"""Checks of worlds: what happens while one runs."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from grader.checks.contract import NoParams, check
from grader.checks.faults import NO_WORDS, WorldRun, count_run_faults
from grader.evidence.contract import EvidenceRecord


@dataclass(frozen=True, slots=True)
class TopicRateParams:
    topic: str = "/scan"
    rate: float = 10.0
    """Messages a second."""
    within: float = 0.05
    """A share."""


def wrong_rate(run: WorldRun, params: TopicRateParams) -> Iterator[str]:
    count_faults = {heard.topic: heard.count for heard in run.run.topics}.get(params.topic, 0)
    is_ = count_faults / run.run.seconds if run.run.seconds else 0.0
    if not count_faults:
        yield f"nothing came on {params.topic}"
    elif abs(is_ - params.rate) > params.within * params.rate:
        yield f"{params.topic} came {is_:.3g} times a second, not {params.rate:g}"


@check(none=1, full=0, words=NO_WORDS, params=TopicRateParams)
def rate(evidence: EvidenceRecord, params: TopicRateParams) -> float:
    """A plugin speaks too often or too rarely:"""
    return count_run_faults(evidence, wrong_rate, params)


@dataclass(frozen=True, slots=True)
class NoiseParams:
    topic: str = "/scan"
    deviation: float = 0.02
    """m"""
    within: float = 0.1
    """A share."""


def wrong_noise(run: WorldRun, params: NoiseParams) -> Iterator[str]:
    spread = {heard.topic: heard.spread for heard in run.run.topics}.get(params.topic)
    if spread is None:
        yield f"nothing came on {params.topic}"
    elif abs(spread - params.deviation) > params.within * params.deviation:
        yield f"on {params.topic} what stands still spreads by {spread:.4g} m, not {params.deviation:g} m"


@check(none=1, full=0, words=NO_WORDS, params=NoiseParams)
def noise(evidence: EvidenceRecord, params: NoiseParams) -> float:
    """The noise, measured while the world stood still, is not what was asked ({where}):"""
    return count_run_faults(evidence, wrong_noise, params)


def not_there(run: WorldRun, params: NoParams) -> Iterator[str]:
    if run.run.reached_s is None:
        away = "" if run.run.target_distance is None else f"it ended {run.run.target_distance:.1f} m away"
        yield ", ".join(
            part
            for part in (
                away,
                f"after {run.run.distance:.1f} m of way" if run.run.distance > 0.05 else "and never moved",
                f"with {run.run.bumps} bump{'s' if run.run.bumps > 1 else ''}" if run.run.bumps else "",
            )
            if part
        )


@check(none=1, full=0, words=NO_WORDS, params=NoParams)
def drives(evidence: EvidenceRecord, params: NoParams) -> float:
    """Our driver does not reach its target in your world ({where}):"""
    return count_run_faults(evidence, not_there, params)


@check(none=1, full=0, unit="bumps", params=NoParams)
def bumps(evidence: EvidenceRecord, params: NoParams) -> float:
    """While our driver drove, the robot touched something: {actual} ({where})."""
    if not isinstance(evidence.content, WorldRun) or evidence.content.run.problem:
        return math.nan
    return float(evidence.content.run.bumps)


@check(none=0, full=1, words=("not stopped", "stopped"))
def stopped(evidence: EvidenceRecord, params: NoParams) -> float:
    """Our driver went straight at where something solid should be, and nothing stopped it ({where})."""
    if not isinstance(evidence.content, WorldRun) or evidence.content.run.problem:
        return math.nan
    return float(evidence.content.run.bumps > 0)


def no_way(run: WorldRun, params: NoParams) -> Iterator[str]:
    if not run.run.is_reachable:
        yield "Look for a wall too many, a gap too narrow, or a start inside a wall"


@check(none=1, full=0, words=NO_WORDS, params=NoParams)
def reachable(evidence: EvidenceRecord, params: NoParams) -> float:
    """There is no way that is wide enough for the robot from its start to the target ({where})."""
    return count_run_faults(evidence, no_way, params)


def leaks(run: WorldRun, params: NoParams) -> Iterator[str]:
    if not run.run.is_enclosed:
        yield "Look for two walls that should meet and do not"


@check(none=1, full=0, words=NO_WORDS, params=NoParams)
def closed(evidence: EvidenceRecord, params: NoParams) -> float:
    """The walls do not hold the robot in: somewhere it can leave."""
    return count_run_faults(evidence, leaks, params)


def apart(run: WorldRun, params: NoParams) -> Iterator[str]:
    if run.run.joint_gap > 0.0:
        yield f"The joint {run.run.widest_joint} was {run.run.joint_gap * 1000:.0f} mm apart"


@check(none=0.05, full=0.01, unit="m", params=NoParams)
def together(evidence: EvidenceRecord, params: NoParams) -> float:
    """While it drove the model came apart by {actual} ({where}); at most {full} is allowed."""
    if not isinstance(evidence.content, WorldRun) or evidence.content.run.problem:
        return math.nan
    return float(evidence.content.run.joint_gap)
