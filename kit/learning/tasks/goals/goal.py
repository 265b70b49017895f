"""The contract of a goal: what a task asks for, and how much of it many worlds have achieved.

A goal is a count that grows until it is full: then the episode has reached it. Whoever drives, trains, watches, races or
draws a task asks this contract; nobody else tells goals apart.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, fields
from enum import Enum, auto
from typing import TYPE_CHECKING, Any, ClassVar, Final, Self

import numpy as np

from kit.arrays import FloatArray, IntArray
from kit.learning.tasks.transition import Array, Transition
from kit.world.catalogue import MapCard
from kit.world.yaml_section import Section

if TYPE_CHECKING:
    from kit.learning.maps.batch_map import BatchMap


KNOWN_IN_RACE: Final = frozenset(
    {
        "case", "step", "pose", "hit", "in_target", "target", "target_heading", "obstacle_distance", "count", "achieved",
    }
)  # fmt: skip
"""The fields of a state that a race knows as a training does, beside ``ranges`` where a goal ``reads_lidar``: a goal counts by
these alone, so that it can be raced. ``hit`` is never True there: a bump ends no race."""


class CaseTargets(Enum):
    """What a goal takes the targets of a case for."""

    NONE = auto()
    """It has none."""
    PLACE = auto()
    """Robots are to be in one of them."""
    ROUTE = auto()
    """Robots are to be in all of them, one after the other."""
    LEADER = auto()
    """It is a model that moves."""


@dataclass(frozen=True, slots=True)
class GoalCase:
    """What a goal knows of a case: its map, who drives there, and where they start."""

    card: MapCard
    robots: tuple[str, ...]
    start: tuple[float, float]
    """A place where episodes start [m]."""
    target_count: int

    @property
    def batch_map(self) -> BatchMap:
        """Its map as arrays. Raises UnsupportedWorld and WorldError."""
        from kit.learning.maps.batch_map import load_batch_map

        return load_batch_map(self.card, self.robots)


class GoalCount(ABC):
    """Counts how much of a goal is achieved in n worlds, in the goal's own unit."""

    needed: FloatArray
    """(cases,) the count at which the goal is reached."""

    def begin(self, which: IntArray, cases: IntArray, poses: FloatArray) -> FloatArray:
        """(m,) the counts of new episodes of ``cases`` (m) in the worlds ``which`` (m), with robots at ``poses`` (m, r, 3)."""
        return np.zeros(len(which))

    @abstractmethod
    def count(self, transition: Transition) -> FloatArray:
        """(n,) the counts after a step; before it they were ``transition.before.count``.

        Of the states only fields ``KNOWN_IN_RACE`` are read. No count falls unless robots can leave a target: what holds for
        a while, such as a distance that is kept, is counted as the seconds or the metres during which it has held.
        """


class Goal(ABC):
    """What a task asks for. A subclass is a frozen dataclass: its fields are the settings that a file may give."""

    kind: ClassVar[str]
    """Its name in files."""
    case_targets: ClassVar[CaseTargets] = CaseTargets.NONE
    is_observation_delayed: ClassVar[bool] = False
    """Whether agents that see ``achieved`` are told it one step later: where the newest scan is what is counted."""
    least_robots: ClassVar[int] = 1
    """How many robots it needs."""
    needs_obstacles: ClassVar[bool] = False
    """Whether there must be models that neither drive nor are walls."""
    reads_lidar: ClassVar[bool] = False
    """Whether what is counted is measured by the robots' lidars."""
    is_lost_at_start: ClassVar[bool] = False
    """Whether a robot that is put back to its start, as a race does after a bump, begins again."""

    @classmethod
    @abstractmethod
    def read(cls, section: Section) -> Self:
        """Reads the goal's settings from a file; what is wrong is noted in the section."""

    @property
    @abstractmethod
    def description(self) -> str:
        """What is to be done, ``be in the target``."""

    @abstractmethod
    def make_count(self, cases: Sequence[GoalCase], n: int, step_time: float) -> GoalCount:
        """A count for ``n`` worlds of these cases, whose steps take ``step_time`` [s]."""

    @abstractmethod
    def progress(self, count: float, needed: float) -> str:
        """How much of it is achieved, in a few words; empty where there is nothing to count."""

    @property
    def heading_tolerance(self) -> float | None:
        """The target's heading must be kept within this [rad]; None: any heading will do."""
        return None

    def least_time(self, way: float, speed: float) -> float:
        """[s] No episode reaches the goal sooner. ``way`` [m]: no way to the targets is shorter; ``speed`` [m/s]: no robot is faster."""
        return way / speed

    def node_facts(self, case: GoalCase) -> dict[str, Any]:
        """What the program of a node must know to count it in a case, JSON-able: see ``kit/learning/policies/node_goals``."""
        settings = {each.name: getattr(self, each.name) for each in fields(self)}  # type: ignore[arg-type]  # a dataclass
        needed = float(self.make_count([case], 1, 1.0).needed[0])
        return {**settings, "needed": needed, "is_observation_delayed": self.is_observation_delayed}

    @property
    def farthest_measured(self) -> float:
        """[m] The farthest wall that counts for something; 0 where none does."""
        return 0.0

    @property
    def needs_target(self) -> bool:
        """Whether a case must have a target."""
        return self.case_targets is not CaseTargets.NONE

    @property
    def has_standing_targets(self) -> bool:
        """Whether robots are to be in targets that stand somewhere: there are ways to them, and pictures show them."""
        return self.case_targets in (CaseTargets.PLACE, CaseTargets.ROUTE)

    @property
    def is_route(self) -> bool:
        """Whether all targets of a case are reached, one after the other."""
        return self.case_targets is CaseTargets.ROUTE

    @property
    def begins_outside_target(self) -> bool:
        """Whether episodes that begin in the target would be over at once."""
        return self.case_targets is CaseTargets.PLACE

    @property
    def needs_leader(self) -> bool:
        """Whether the target must be a model that moves."""
        return self.case_targets is CaseTargets.LEADER

    @property
    def needs_count(self) -> bool:
        """Whether robots that are in a target are not done with it at once, so that a node must count."""
        return False

    def route(self, targets: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
        """Where robots are to be, one place after the other [m, m]; ``targets``: those of the case."""
        return targets[:1] if self.case_targets is CaseTargets.PLACE else ()

    def is_arrived(self, inside: Array, poses: Array, headings: Array) -> Array:
        """(n, r) who is in the target, of those ``inside`` it at ``poses`` (n, r, 3); ``headings`` (n,): the targets'."""
        return inside

    @classmethod
    def usual_settings(cls) -> str:
        """The settings that a file may give with what they usually are, ``share 0.9, radius 0.15``."""
        told = ((each.name, each.default) for each in fields(cls))  # type: ignore[arg-type]  # a dataclass, by contract
        return ", ".join(f"{name} {_plain_value(usual)}".rstrip() for name, usual in told)


def read_distances(section: Section, nearest: float, farthest: float) -> tuple[float, float]:
    """Reads the distances [m] between which something counts; ``nearest`` and ``farthest`` are the usual ones. Notes a mistake
    in the section."""
    low = section.number("nearest", nearest, minimum=0)
    high = section.number("farthest", farthest, above=0)
    if low >= high:
        section.error(f"farthest must be greater than nearest, {low:g}", "farthest")
    return low, high


def _plain_value(value: object) -> str:
    if value is None:
        return ""
    return f"{value:g}" if isinstance(value, float) else str(value)
