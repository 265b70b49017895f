"""Defines observations: a few numbers from a scan, and optionally the target and who has arrived."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from kit.fields.adjacency import SIDE_RAYS as SIDE_RAYS

RAY_COUNT = 91
"""The robot's lidar: every 4 degrees from straight back round to straight back; ray 45 points ahead."""
AHEAD_RAY = 45
MAX_TARGET_DISTANCE = 4.0
"""A target's distance is given up to here [m]."""


@dataclass(frozen=True, slots=True)
class ObservationSpec:
    """One robot's numbers, in this order: single rays, side rays, sector minima, target, arrived. For two robots
    the left one's numbers come first, then the right one's."""

    rays: tuple[int, ...]
    """Rays given as they are."""
    sectors: tuple[int, ...]
    """(91): the sector that each ray belongs to, from 0."""
    side_rays: bool = False
    """Whether each of two robots has two rays that look at the other one."""
    clip: float = 2.0
    """Ranges are given up to here [m]."""
    scale: float = 1.0
    """Ranges and distances are multiplied by this."""
    target: bool = False
    """Whether distance and rotation to the target are given."""
    arrived: bool = False
    """Whether each robot is told if it is in the target."""

    @property
    def size(self) -> int:
        """Numbers per robot."""
        sectors = max(self.sectors) + 1
        return len(self.rays) + sectors + 2 * self.side_rays + 2 * self.target + self.arrived

    def ray_tables(self, robots: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """(robots, single) the rays that each robot's numbers start with; (m, 3) sector, first ray and end of every
        stretch of rays in one sector."""
        single = [self.rays + (tuple(SIDE_RAYS[k]) if self.side_rays else ()) for k in range(robots)]
        sectors = np.array(self.sectors, dtype=np.int64)
        ends = np.flatnonzero(np.diff(sectors, append=-1)) + 1
        starts = np.concatenate([[0], ends[:-1]])
        stretches = np.stack([sectors[starts], starts, ends], axis=1)
        return np.array(single, dtype=np.int64).reshape(robots, -1), stretches

    def mirror_table(self, robots: int) -> tuple[NDArray[np.int64], NDArray[np.float32]]:
        """(robots * size,) each: which number stands here in a mirror, and by what it is multiplied.

        Raises ValueError where the two sides are not alike.
        """
        single, last = list(self.rays), RAY_COUNT - 1
        sectors = [
            {ray for ray in range(RAY_COUNT) if self.sectors[ray] == k} for k in range(max(self.sectors) + 1)
        ]
        try:
            places = [single.index(last - ray) for ray in single]
            places += [len(places) + k for k in range(2 * self.side_rays)]
            places += [len(places) + sectors.index({last - ray for ray in sector}) for sector in sectors]
        except ValueError:
            raise ValueError("what agents see is not the same on both sides") from None
        order = np.array([*places, *range(len(places), self.size)], dtype=np.int64)
        signs = np.ones(self.size, dtype=np.float32)
        if self.target:
            signs[self.size - self.arrived - 1] = -1.0
        blocks = [order + self.size * k for k in reversed(range(robots))]
        return np.concatenate(blocks), np.tile(signs, robots)

    def space(self, robots: int) -> spaces.Box:
        """Box (robots * size,) float32."""
        near, far = np.zeros(self.size), np.full(self.size, self.clip * self.scale)
        if self.target:
            first = self.size - self.arrived - 2
            far[first], near[first + 1], far[first + 1] = MAX_TARGET_DISTANCE * self.scale, -1.0, 1.0
        if self.arrived:
            far[-1] = 1.0
        low, high = (np.tile(bound, robots).astype(np.float32) for bound in (near, far))
        return spaces.Box(low, high, dtype=np.float32)


def _twelve_sectors() -> tuple[int, ...]:
    """Three sectors of about 60 degrees behind, straight back first, then nine of 20 degrees in front; from the
    right to the left."""
    table: NDArray[np.int64] = np.zeros(RAY_COUNT, dtype=np.int64)
    table[8:23] = 1
    for sector in range(9):
        table[23 + 5 * sector : 28 + 5 * sector] = 2 + sector
    table[68:83] = 11
    return tuple(table.tolist())


NINE_NUMBERS = ObservationSpec(
    rays=(), sectors=tuple(min(ray // 10, 8) for ray in range(RAY_COUNT)), clip=2.0, scale=0.5
)
"""Tutorial 2 (dissertation, figure 5.4): eight sectors of 10 rays, one of 11."""

SEVENTEEN_NUMBERS = ObservationSpec(
    rays=(AHEAD_RAY, AHEAD_RAY + 2, AHEAD_RAY - 2, AHEAD_RAY + 23, AHEAD_RAY - 23),
    sectors=_twelve_sectors(),
    scale=0.5,
)
"""Hallways (figure 3.3): ahead, 8 degrees to the left and right of it, left, right; 12 sectors."""

NINETEEN_NUMBERS = ObservationSpec(
    SEVENTEEN_NUMBERS.rays, SEVENTEEN_NUMBERS.sectors, side_rays=True, scale=0.5
)
"""Two wheelchairs (figure 4.8): 38 numbers for both."""
