"""One drive that is played again as a picture, and passed on as one line of text.

A process that trains writes the line, and another one draws it without the task, its world or its policy.
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, Self

import numpy as np

from kit.arrays import FloatArray
from kit.geometry import Pose
from kit.plain_text import printable_line
from kit.render.scene import Disc, Scene, SceneBody, Trail

MAX_POSES: Final = 40
"""Poses of one drive in its text; between them it is interpolated."""
MAX_WALLS: Final = 1200
"""A place with more is not passed on."""
MAX_TEXT: Final = 200
"""Characters of a name and of a result."""
MAX_NUMBER: Final = 1_000_000
"""Centimetres, or degrees; no place is as large."""
CENTIMETRES: Final = 100.0
POSE_UNITS: Final = np.array((CENTIMETRES, CENTIMETRES, 180.0 / math.pi))
"""Units of x, y and theta in the text."""


@dataclass(frozen=True, slots=True, eq=False)
class DrivenPlace:
    """What is drawn of the place of a drive."""

    walls: FloatArray
    """(n, 4) ``x1 y1 x2 y2`` [m]: walls, and the edges of things that never move."""
    hull: tuple[FloatArray, ...]
    """Each (k, 2) [m]: one polygon of a robot, in its own frame."""
    target: Disc | None
    """Where the drive is to end, if that is a place."""


@dataclass(frozen=True, slots=True, eq=False)
class DrivePlayback:
    """One drive that can be drawn at any of its times."""

    case: str
    result: str
    """How it ended, and when: ``hit a wall after 2.0 s at (1.2, 0.4)``."""
    poses: FloatArray
    """(k, robots, 3) ``x y theta`` [m, rad], at equal intervals, the first and the last one included."""
    duration_s: float
    place: DrivenPlace

    def scene_at(self, time_s: float) -> Scene:
        """The picture ``time_s`` after the start, with the way so far; after the end, the end."""
        share = min(1.0, max(0.0, time_s / self.duration_s)) if self.duration_s else 1.0
        at = share * (len(self.poses) - 1)
        number = int(at)
        before, after = self.poses[number], self.poses[min(number + 1, len(self.poses) - 1)]
        turn = np.remainder(after[:, 2] - before[:, 2] + math.pi, math.tau) - math.pi
        now = before + (at - number) * np.column_stack(((after - before)[:, :2], turn))
        way = np.concatenate((self.poses[: number + 1], now[None]))
        robots = range(self.poses.shape[1])
        return Scene(
            walls=self.place.walls,
            bodies=tuple(self._robot_at(robot, Pose(*now[robot].tolist())) for robot in robots),
            targets=() if self.place.target is None else (self.place.target,),
            trails=tuple(_make_trail(way[:, robot, :2]) for robot in robots),
        )

    def _robot_at(self, number: int, pose: Pose) -> SceneBody:
        outlines = (
            np.array([pose.transform_point(*corner) for corner in part.tolist()]) for part in self.place.hull
        )
        return SceneBody(f"robot {number + 1}", pose, tuple(outlines), is_robot=True)

    def to_text(self, *, with_place: bool) -> str:
        """One line that ``from_text`` reads: centimetres, degrees, ``MAX_POSES`` poses at most. ``with_place``: the walls too,
        which are the same for all drives of a case. Empty where there are more than ``MAX_WALLS``."""
        place = self.place
        if len(place.walls) > MAX_WALLS:
            return ""
        at = np.linspace(0, len(self.poses) - 1, min(MAX_POSES, len(self.poses))).round().astype(np.int64)
        content: dict[str, Any] = {
            "case": self.case[:MAX_TEXT],
            "result": self.result[:MAX_TEXT],
            "seconds": round(self.duration_s, 3),
            "poses": _to_integers(self.poses[at] * POSE_UNITS),
            "target": None if place.target is None else _to_integers(np.array(place.target) * CENTIMETRES),
        }
        if with_place:
            content["walls"] = _to_integers(place.walls * CENTIMETRES)
            content["hull"] = [_to_integers(part * CENTIMETRES) for part in place.hull]
        return json.dumps(content, separators=(",", ":"))

    @classmethod
    def from_text(cls, text: str, earlier: Sequence[str] = ()) -> Self:
        """Reads what ``to_text`` has written. ``earlier``: texts of which one has the place of this case, where this one
        has not. ValueError if it is damaged."""
        try:
            content = json.loads(text)
            known = content if "walls" in content else _with_place_of(content["case"], earlier)
            walls = _parse_numbers(known["walls"], -1, 4) / CENTIMETRES
            hull = tuple(_parse_numbers(part, -1, 2) / CENTIMETRES for part in known["hull"])
            told = content["target"]
            target = None if told is None else Disc(*(_parse_numbers(told, 3) / CENTIMETRES).tolist())
            poses = _parse_numbers(content["poses"], -1, len(content["poses"][0]), 3) / POSE_UNITS
            seconds = float(_parse_numbers(content["seconds"], 1)[0])
            place = DrivenPlace(walls, hull, target)
            return cls(
                printable_line(str(content["case"]))[:MAX_TEXT],
                printable_line(str(content["result"]))[:MAX_TEXT],
                poses,
                seconds,
                place,
            )
        except (KeyError, TypeError, IndexError, OverflowError, RecursionError) as error:
            raise ValueError(f"not a drive: {error}") from None


def _with_place_of(case: str, texts: Sequence[str]) -> dict[str, Any]:
    """The content of the text that has the place of a case. KeyError if none has."""
    for text in texts:
        if '"walls":' in text:
            content: dict[str, Any] = json.loads(text)
            if content["case"] == case:
                return content
    raise KeyError(case)


def _to_integers(values: FloatArray) -> Any:
    return np.clip(values, -MAX_NUMBER, MAX_NUMBER).round().astype(np.int64).tolist()


def _parse_numbers(values: Any, *shape: int) -> FloatArray:
    """ValueError where they are not numbers of this shape, within ``MAX_NUMBER``."""
    found = np.array(values, dtype=np.float64).reshape(shape)
    if not found.size or not (np.abs(found) <= MAX_NUMBER).all():
        raise ValueError("not the numbers of a place")
    return found


def _make_trail(points: FloatArray) -> FloatArray:
    trail = Trail()
    for x, y in points.tolist():
        trail.add(x, y)
    return trail.points
