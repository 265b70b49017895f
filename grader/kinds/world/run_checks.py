"""Checks of a world that ran: what its plugins sent, and how our driver got on in it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from grader.check import Check, NoParams, check
from grader.evidence.contract import EvidenceRecord
from grader.kinds.world.faults import UNSPECIFIED, WorldRun, format_metres, measure_run, run_check
from kit.plain_text import counted

LEAST_WAY: Final = 0.1
"""A robot that drove less did not drive to its target [m]."""


@dataclass(frozen=True, slots=True)
class PublishRateParams:
    topic: str = "/scan"
    rate: float = 10.0
    """Messages a second."""
    within: float = 0.05
    """A share."""


@run_check(PublishRateParams)
def rate(run: WorldRun, params: PublishRateParams) -> Iterator[str]:
    """A plugin publishes too often or too rarely:"""
    count = {statistics.topic: statistics.count for statistics in run.run.topics}.get(params.topic, 0)
    actual = count / run.run.seconds if run.run.seconds else 0.0
    if not count:
        yield f"nothing came on {params.topic}"
    elif abs(actual - params.rate) > params.within * params.rate:
        yield f"{params.topic} came {actual:.3g} times a second, not {params.rate:g}"


@dataclass(frozen=True, slots=True)
class NoiseParams:
    topic: str = "/scan"
    deviation: float = 0.02
    """m"""
    within: float = 0.1
    """A share."""


@run_check(NoiseParams)
def noise(run: WorldRun, params: NoiseParams) -> Iterator[str]:
    """The noise, measured while the world stood still, is not what was asked ({where}):"""
    spread = {statistics.topic: statistics.spread for statistics in run.run.topics}.get(params.topic)
    if spread is None:
        yield f"nothing came on {params.topic}"
    elif abs(spread - params.deviation) > params.within * params.deviation:
        yield f"on {params.topic} what stands still spreads by {spread:.4g} m, not {params.deviation:g} m"


@dataclass(frozen=True, slots=True)
class DrivesParams:
    start_x: float = UNSPECIFIED
    start_y: float = UNSPECIFIED
    """Where the robot must begin: from its target there is no way left."""
    within: float = 0.3
    """m"""


@run_check(DrivesParams)
def drives(run: WorldRun, params: DrivesParams) -> Iterator[str]:
    """Our driver does not reach its target in your world ({where}):"""
    for wanted, actual, axis in zip((params.start_x, params.start_y), run.run.start, "xy", strict=False):
        if abs(actual - wanted) > params.within:
            yield f"the robot begins at {axis} = {format_metres(actual)}; {format_metres(wanted)} is wanted"
    if run.run.reached_s is not None and run.run.distance < LEAST_WAY:
        yield "the robot is at its target before it has driven"
    if run.run.undriven >= LEAST_WAY:
        yield f"the robot moves by {run.run.undriven:.1f} m while nobody drives it"
    if run.run.reached_s is None:
        away = "" if run.run.target_distance is None else f"it ended {run.run.target_distance:.1f} m away"
        yield ", ".join(
            part
            for part in (
                away,
                f"after {run.run.distance:.1f} m of way" if run.run.distance > 0.05 else "and never moved",
                f"with {counted(run.run.bumps, 'bump')}" if run.run.bumps else "",
            )
            if part
        )


@check(none=1, full=0, unit="bumps")
def bumps(evidence: EvidenceRecord, params: NoParams) -> float:
    """While our driver drove, the robot touched something: {actual} ({where})."""
    return measure_run(evidence, lambda run: run.bumps)


@check(none=0, full=1, words=("not stopped", "stopped"))
def stopped(evidence: EvidenceRecord, params: NoParams) -> float:
    """Our driver went straight at where something solid should be, and nothing stopped it ({where})."""
    return measure_run(evidence, lambda run: run.bumps > 0)


@run_check()
def reachable(run: WorldRun, params: NoParams) -> Iterator[str]:
    """No path from the robot's start to the target is wide enough for it ({where})."""
    if not run.run.is_reachable:
        yield "Look for a wall too many, a gap too narrow, or a start inside a wall"


@run_check()
def closed(run: WorldRun, params: NoParams) -> Iterator[str]:
    """The walls do not hold the robot in: somewhere it can leave."""
    if not run.run.is_enclosed:
        yield "Look for two walls that should meet and do not"


def _gap(run: WorldRun, params: NoParams) -> Iterator[str]:
    if run.run.joint_gap > 0.0:
        yield f"The joint {run.run.widest_joint} was {run.run.joint_gap * 1000:.0f} mm apart"


@check(none=0.05, full=0.01, unit="m", faults=_gap)
def together(evidence: EvidenceRecord, params: NoParams) -> float:
    """While it drove the model came apart by {actual} ({where}); at most {full} is allowed."""
    return measure_run(evidence, lambda run: run.joint_gap)


RUN_CHECKS: Final[tuple[Check, ...]] = (rate, noise, drives, bumps, stopped, reachable, closed, together)
