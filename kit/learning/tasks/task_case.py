"""The cases of a task: where its episodes start and end."""

from __future__ import annotations

import math
from dataclasses import dataclass

from kit.geometry import Pose
from kit.world.catalogue import MapCase

Area = tuple[float, float, float, float]
"""``x1 y1 x2 y2`` [m]: an upright rectangle, by two opposite corners."""


@dataclass(frozen=True, slots=True)
class EpisodePlaces:
    """Places of which every episode takes one, each as likely as the others; poses where there are any, else an area.

    Of an area only the floor counts on which a robot of any heading touches nothing, and from which the rest of the
    task can be reached.
    """

    poses: tuple[Pose, ...] = ()
    """For targets the heading counts only where the goal asks for one."""
    area: Area | None = None
    """Its floor; None with no poses: the floor of the whole map."""
    headings: tuple[float, float] = (-math.pi, math.pi)
    """Headings in an area are drawn between these [rad]."""
    model: str | None = None
    """Targets only: the target moves with this model of the world."""

    @property
    def is_area(self) -> bool:
        """Whether places are drawn from the floor."""
        return not self.poses and self.model is None

    @property
    def nominal(self) -> Pose:
        """One pose that stands for all: the first, or the middle of the area; the origin for a whole map."""
        if self.poses:
            return self.poses[0]
        if self.area is None:
            return Pose()
        x1, y1, x2, y2 = self.area
        return Pose((x1 + x2) / 2, (y1 + y2) / 2, sum(self.headings) / 2)

    @property
    def description(self) -> str:
        """``(0, 0)``, ``one of 4 places``, ``anywhere``."""
        if self.model is not None:
            return f"the moving {self.model}"
        if len(self.poses) == 1:
            return f"({self.poses[0].x:g}, {self.poses[0].y:g})"
        if self.poses:
            return f"one of {len(self.poses)} places"
        if self.area is None:
            return "anywhere on free floor"
        x1, y1, x2, y2 = self.area
        return f"anywhere free from ({x1:g}, {y1:g}) to ({x2:g}, {y2:g})"


@dataclass(frozen=True, slots=True)
class TaskCase:
    """One case of a task: where its episodes start and end. In metres and radians."""

    name: str
    starts: tuple[EpisodePlaces, ...]
    """One for each robot. Where several have lists of poses, all take the same place in their lists."""
    targets: EpisodePlaces
    start_shift: tuple[float, float] = (0.0, 0.0)
    """Largest random displacement of all robots' starts along x and y [m], to either side."""
    target_shift: tuple[float, float] = (0.0, 0.0)
    is_heading_random: bool = False
    """Whether the heading at the start is drawn at random."""
    group: str = ""
    """Cases that results are given for together; may be empty."""

    @classmethod
    def from_map(cls, case: MapCase) -> TaskCase:
        """The case of a map's card."""
        starts = [case.start] if case.partner_start is None else [case.start, case.partner_start]
        return cls(
            case.name,
            tuple(EpisodePlaces((start,)) for start in starts),
            EpisodePlaces((Pose(*case.target),)),
            case.start_shift,
            case.target_shift,
            case.is_heading_random,
            case.group,
        )

    @property
    def start(self) -> Pose:
        """The first robot's start, or a pose that stands for all of them."""
        return self.starts[0].nominal

    @property
    def target(self) -> tuple[float, float]:
        """The target's usual place, or one that stands for all of them."""
        return self.targets.nominal.x, self.targets.nominal.y
