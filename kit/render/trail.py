"""The trail of a robot: single points that grow sparser with age."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, field

import numpy as np

from kit.render.scene import FloatArray


@dataclass
class Trail:
    """Points along a robot's way. Each keeps its place as long as it lasts, so the trail never shimmers."""

    spacing: float = 0.12
    """Distance [m] between points."""
    length: int = 160
    """Points kept. The older half is thinned to every other point, the older quarter to every fourth."""

    _points: deque[tuple[int, float, float]] = field(default_factory=deque, init=False, repr=False)
    _serial: int = field(default=0, init=False, repr=False)

    def add(self, x: float, y: float) -> None:
        """Notes where the robot is now. Costs nothing while it stays within the spacing."""
        if self._points:
            _, last_x, last_y = self._points[-1]
            if math.hypot(x - last_x, y - last_y) < self.spacing:
                return
        self._points.append((self._serial, x, y))
        self._serial += 1
        while self._points[0][0] <= self._serial - 1 - self.length:
            self._points.popleft()

    def clear(self) -> None:
        self._points.clear()

    @property
    def points(self) -> FloatArray:
        """(k, 2) [m], oldest first."""
        kept = [(x, y) for serial, x, y in self._points if serial % self._stride(serial) == 0]
        return np.array(kept, dtype=float).reshape(-1, 2)

    def _stride(self, serial: int) -> int:
        age = (self._serial - 1 - serial) / self.length
        return 1 if age < 0.5 else 2 if age < 0.75 else 4
