"""Defines observations: a few numbers from a scan, and optionally the robot's motion, pose and target."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from gymnasium import spaces

from kit.arrays import Float32Array, IntArray
from kit.fields.adjacency import SIDE_RAYS
from kit.learning.maps.ray_directions import RAY_COUNT
from kit.learning.tasks.actions import MAX_SPEED, MAX_TURN_RATE

MAX_TARGET_DISTANCE = 4.0
"""A target's distance is given up to here [m]."""
MAX_COORDINATE = 100.0
"""A robot's coordinates are given up to here [m]."""


class ObservationPart(NamedTuple):
    """Numbers of one robot that belong together."""

    name: str
    size: int
    low: tuple[float, ...]
    high: tuple[float, ...]
    mirrored: tuple[float, ...] | None
    """Factors that mirror each number; None: it has no mirror image."""


@dataclass(frozen=True, slots=True)
class ObservationSpec:
    """One robot's numbers: single rays, side rays, sector minima, then ``parts``. For several robots the first one's
    numbers come first; of two that is the left one."""

    rays: tuple[int, ...]
    """Rays given as they are."""
    sectors: tuple[int, ...]
    """(91): the sector that each ray belongs to, from 0; empty for none."""
    side_rays: bool = False
    """Whether each of two robots has two rays that look at the other one."""
    clip: float = 2.0
    """Ranges are given up to here [m]."""
    scale: float = 1.0
    """Ranges, distances and coordinates are multiplied by this."""
    target: bool = False
    """Whether distance and rotation to the target are given."""
    arrived: bool = False
    """Whether each robot is told if it is in the target."""
    speeds: bool = False
    """Whether the speed [m/s] and turn rate [rad/s] of the last step are given."""
    last_action: bool = False
    """Whether the speed and turn rate that the last action asked for are given."""
    own_pose: bool = False
    """Whether x, y, cos and sin of the robot's pose in the world are given."""
    target_heading: bool = False
    """Whether the rotation to the heading asked for at the target is given, as cos and sin."""
    achieved: bool = False
    """Whether the share of the goal that is achieved so far is given."""
    frames: int = 1
    """How many of the last observations are given, the newest last."""
    other_rays: tuple[int, ...] = ()
    """Rays of every robot but the first, as many as ``rays``; empty: the same."""

    @property
    def sector_count(self) -> int:
        return max(self.sectors, default=-1) + 1

    @property
    def scan_size(self) -> int:
        """Numbers that come from a scan: they are a robot's first ones."""
        return len(self.rays) + 2 * self.side_rays + self.sector_count

    @property
    def parts(self) -> tuple[ObservationPart, ...]:
        """The parts that follow the numbers of the scan."""
        return _observation_parts(self)

    @property
    def frame_size(self) -> int:
        """Numbers per robot of one frame."""
        return self.scan_size + sum(part.size for part in self.parts)

    @property
    def size(self) -> int:
        """Numbers per robot, all frames together."""
        return self.frame_size * self.frames

    def part_slices(self) -> dict[str, slice]:
        """Where each part stands among one robot's numbers of one frame."""
        found, first = {}, self.scan_size
        for part in self.parts:
            found[part.name] = slice(first, first + part.size)
            first += part.size
        return found

    def ray_tables(self, robots: int) -> tuple[IntArray, IntArray]:
        """(robots, single) the rays that each robot's numbers start with; (m, 3) sector, first ray and end of every
        stretch of rays in one sector."""
        own = [self.rays, *[self.other_rays or self.rays] * (robots - 1)]
        single = [rays + (tuple(SIDE_RAYS[k]) if self.side_rays else ()) for k, rays in enumerate(own)]
        rays = np.array(single, dtype=np.int64).reshape(robots, -1)
        if not self.sectors:
            return rays, np.zeros((0, 3), dtype=np.int64)
        sectors = np.array(self.sectors, dtype=np.int64)
        ends = np.flatnonzero(np.diff(sectors, append=-1)) + 1
        starts = np.concatenate([[0], ends[:-1]])
        return rays, np.stack([sectors[starts], starts, ends], axis=1)

    def mirror_table(self, robots: int) -> tuple[IntArray, Float32Array]:
        """(robots * size,) each: which number stands here in a mirror, and by what it is multiplied.

        Raises ValueError where the two sides are not alike.
        """
        if self.other_rays and robots > 1:
            raise ValueError("robots see different rays")
        single, last = list(self.rays), RAY_COUNT - 1
        sectors = [
            {ray for ray, sector in enumerate(self.sectors) if sector == k} for k in range(self.sector_count)
        ]
        try:
            places = [single.index(last - ray) for ray in single]
            places += [len(places) + k for k in range(2 * self.side_rays)]
            places += [len(places) + sectors.index({last - ray for ray in sector}) for sector in sectors]
        except ValueError:
            raise ValueError("what agents see is not symmetric") from None
        order = np.array([*places, *range(len(places), self.frame_size)], dtype=np.int64)
        signs = [np.ones(self.scan_size, dtype=np.float32)]
        for part in self.parts:
            if part.mirrored is None:
                raise ValueError(f"what agents see has no mirror image: {part.name}")
            signs.append(np.array(part.mirrored, dtype=np.float32))
        blocks = [order + self.frame_size * k for k in reversed(range(robots))]
        frame = np.concatenate(blocks)
        frames = [frame + len(frame) * k for k in range(self.frames)]
        return np.concatenate(frames), np.tile(np.concatenate(signs), robots * self.frames)

    def space(self, robots: int) -> spaces.Box:
        """Box (robots * size,) float32."""
        near, far = [0.0] * self.scan_size, [self.clip * self.scale] * self.scan_size
        for part in self.parts:
            near += part.low
            far += part.high
        low, high = (np.tile(bound, robots * self.frames).astype(np.float32) for bound in (near, far))
        return spaces.Box(low, high, dtype=np.float32)


@cache
def _observation_parts(seen: ObservationSpec) -> tuple[ObservationPart, ...]:
    motion = (MAX_SPEED, MAX_TURN_RATE)
    still = (-MAX_SPEED, -MAX_TURN_RATE)
    far, reach = MAX_TARGET_DISTANCE * seen.scale, MAX_COORDINATE * seen.scale
    wanted = (
        (seen.speeds, ObservationPart("speeds", 2, still, motion, (1.0, -1.0))),
        (seen.last_action, ObservationPart("last_action", 2, still, motion, (1.0, -1.0))),
        (
            seen.own_pose,
            ObservationPart("own_pose", 4, (-reach, -reach, -1.0, -1.0), (reach, reach, 1.0, 1.0), None),
        ),
        (
            seen.target_heading,
            ObservationPart("target_heading", 2, (-1.0, -1.0), (1.0, 1.0), (1.0, -1.0)),
        ),
        (seen.achieved, ObservationPart("achieved", 1, (0.0,), (1.0,), (1.0,))),
        (seen.target, ObservationPart("target", 2, (0.0, -1.0), (far, 1.0), (1.0, -1.0))),
        (seen.arrived, ObservationPart("arrived", 1, (0.0,), (1.0,), (1.0,))),
    )
    return tuple(part for is_given, part in wanted if is_given)


PART_NAMES = MappingProxyType(
    {
        "target": "distance to the target [m, times the scale], rotation to it [-1 to 1, half turns]",
        "arrived": "whether it is in the target",
        "speeds": "speed [m/s] and turn rate [rad/s] of the last step",
        "last_action": "speed [m/s] and turn rate [rad/s] commanded by the last action",
        "own_pose": "x and y [m, times the scale], cos and sin of its heading",
        "target_heading": "cos and sin of the rotation to the required heading",
        "achieved": "share of the goal achieved so far",
    }
)
"""What each part tells, by the key that a task file has for it."""
