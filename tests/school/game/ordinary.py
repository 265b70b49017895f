"""A hand with ordinary skill: the tidy driver's keys a fifth of a second late, and what the hint of a level tells everybody.

It stops at a dock before the battery is empty, mops in lanes, keeps behind a leader, releases the keys
early on ice, and waits for traffic or gets out of its way. It searches nothing and learns nothing.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from kit.controllers import find_controller
from kit.geometry import Pose, wrap_angle
from kit.learning.environment.distance_field import CELL, DistanceField, compute_distance_field
from kit.run.scenario import BEACON
from kit.run.session import Session
from kit.school.game.levels import GameLevel
from kit.school.game.race import DOCK_TIME
from kit.sim.plugins.tricycle_drive import TricycleDriveParams
from kit.sim.simulation import Simulation
from tests.school.game.map_plans import LANES
from tests.school.game.tidy import (
    CLEARANCE,
    LOOKAHEAD,
    SPEED,
    STEERING_TOLERANCE,
    TURN_IN_PLACE_ANGLE,
    TURN_RATE,
    WALL_PRICE,
    TidyDriver,
)

REACTION_TICKS: Final = 20
"""From what is seen to the key that is pressed: 0.2 s, as of people who expect something; by default."""
KEY_TICKS: Final = 10
"""Keys change no faster than a terminal repeats them: every 0.1 s."""
AT_DOCK: Final = 0.25
"""From here it lets go of all keys to stand at a dock [m]."""
BEHIND_LEADER: Final = (0.4, 0.6)
"""Nearer than the first it backs off, farther than the second it follows [m]."""
BEND: Final = 0.4
"""A way that turns by more than this is a bend [rad]."""
BEND_SPEED: Final = 0.05
"""What it has on ice where a bend begins [m/s]."""
CART_DISTANCE, WALL_DISTANCE = 0.32, 0.16
"""What it keeps from the middle of a cart, and from walls when it gets out of a cart's way [m]."""
GOING_S, STANDING_S = 1.6, 0.4
"""For so long it looks ahead: going, and then standing where it has come to [s]."""
STEERED_CLEARANCE, STEERED_TOLERANCE = 0.36, 0.1
"""What it keeps from walls [m], and within which heading error it steers straight on [rad], where it cannot turn on the spot."""
JUMP: Final = 0.2
"""Nobody drives so far in one tick [m]."""
STUCK_TICKS, BACKING_TICKS = 60, 80
"""Who has pressed forward for so long and has not moved backs off for so long."""


def targets_of(level: GameLevel) -> list[tuple[float, float]]:
    """The targets in the order of the file, whatever order would be best; or the corners of lanes."""
    if level.id in LANES:
        return LANES[level.id][1:]
    if level.goal.is_route:
        return list(level.goal.route(level.targets))
    case = level.find_scenario().case
    assert case is not None
    return [case.target]


class OrdinaryDriver(TidyDriver):
    """Drives a level with the delays of a hand: what is seen is acted on a fifth of a second later."""

    def __init__(self, session: Session, level: GameLevel, reaction_ticks: int = REACTION_TICKS) -> None:
        super().__init__(session, targets_of(level))
        self._level = level
        self._seen: deque[Pose] = deque(maxlen=reaction_ticks)
        self._carts = [
            each.name
            for each in session.scenario.world.models
            if each.name not in (*self._models, BEACON, level.leader)
        ]
        self._cart_ways = self._watched_carts() if self._carts else np.empty((0, 0, 2))
        self._tick = 0
        self._held = (0.0, 0.0)
        self._is_steered = any(
            isinstance(plugin.params, TricycleDriveParams) for plugin in session.scenario.driven.plugins
        )
        self._stuck = self._backing = 0
        self._charge = level.conditions.charge
        self._has_docked = False
        self._docked_s = 0.0

    def keys(self, pose: Pose) -> tuple[float, float]:
        if self._seen:
            self._charge -= math.dist(pose[:2], self._seen[-1][:2])
        self._seen.append(pose)
        is_held = self._held[0] > 0.0 and math.dist(pose[:2], self._seen[0][:2]) < 0.01
        self._stuck = self._stuck + 1 if is_held else 0
        if self._stuck > STUCK_TICKS:
            self._backing, self._stuck = BACKING_TICKS, 0
        self._backing = max(0, self._backing - 1)
        if self._tick % KEY_TICKS == 0:
            self._held = (-SPEED, 0.0) if self._backing else self._decide(self._seen[0])
        self._tick += 1
        return self._held

    def _decide(self, pose: Pose) -> tuple[float, float]:
        conditions = self._level.conditions
        if self._level.leader:
            return self._follow(pose)
        if conditions.docks and self._is_docking(pose):
            return 0.0, 0.0
        keys = self._steer(pose) if self._is_steered else super().keys(pose)
        if conditions.acceleration:
            keys = self._on_ice(pose, conditions.acceleration)
        return self._among_carts(pose, keys) if self._carts else keys

    def _follow(self, pose: Pose) -> tuple[float, float]:
        x, y, _ = self._session.runner.simulation.pose(self._level.leader)
        error = wrap_angle(math.atan2(y - pose.y, x - pose.x) - pose.theta)
        distance = math.dist((x, y), pose[:2])
        speed = SPEED if distance > BEHIND_LEADER[1] else -SPEED if distance < BEHIND_LEADER[0] else 0.0
        turn = 0.0 if abs(error) < 0.1 else math.copysign(TURN_RATE, error)
        return (speed if abs(error) < TURN_IN_PLACE_ANGLE else 0.0), turn

    def _steer(self, pose: Pose) -> tuple[float, float]:
        """The keys for a robot that cannot turn on the spot: always forward, far from walls, in short turns."""
        self._field = self._field or compute_distance_field.__wrapped__(
            self._walls, self._targets[0], STEERED_CLEARANCE, WALL_PRICE
        )
        x, y = self._aim_point(self._field, *pose[:2])
        error = wrap_angle(math.atan2(y - pose.y, x - pose.x) - pose.theta)
        return SPEED, 0.0 if abs(error) < STEERED_TOLERANCE else math.copysign(TURN_RATE, error)

    def _is_docking(self, pose: Pose) -> bool:
        """Makes the dock the next target where the charge would not last; whether it stands there to be charged."""
        docks = self._level.conditions.docks
        if self._targets[0] in docks:
            if math.dist(pose[:2], self._targets[0]) > AT_DOCK and not self._docked_s:
                return False
            self._docked_s += 0.01 * KEY_TICKS
            if self._docked_s < DOCK_TIME + 0.5:
                return True
            self._targets.pop(0)
            self._field, self._docked_s, self._has_docked = None, 0.0, True
            self._charge = self._level.conditions.charge
            return False
        if not self._has_docked:
            way = [self._length(pose[:2], self._targets[0])]
            if len(self._targets) > 1:
                way.append(min(self._length(self._targets[0], dock) for dock in docks))
            if sum(way) > self._charge:
                nearest = min(docks, key=lambda dock: self._length(pose[:2], dock))
                self._targets.insert(0, nearest)
                self._field = None
            self._has_docked = True
        left = len(self._targets)
        if left > 1 and math.dist(pose[:2], self._targets[0]) < 0.25:
            self._has_docked = False  # the next target is another question
        return False

    def _field_to(self, place: tuple[float, float]) -> DistanceField:
        return compute_distance_field.__wrapped__(self._walls, place, CLEARANCE, WALL_PRICE)

    def _length(self, a: tuple[float, float], b: tuple[float, float]) -> float:
        """Of the way that it would drive [m]."""
        x, y, length = *a, 0.0
        field = self._field_to(b)
        for place in self._way(field, x, y):
            length += math.dist((x, y), place)
            x, y = place
        return length

    def _way(self, field: DistanceField, x: float, y: float) -> Iterator[tuple[float, float]]:
        """The places of the shortest way, a cell apart."""
        rows, columns = field.values.shape
        column = min(max(round((x - field.origin[0]) / CELL), 0), columns - 1)
        row = min(max(round((y - field.origin[1]) / CELL), 0), rows - 1)
        while True:
            window = field.values[max(0, row - 1) : row + 2, max(0, column - 1) : column + 2]
            r, c = np.unravel_index(int(window.argmin()), window.shape)
            r, c = int(r) + max(0, row - 1), int(c) + max(0, column - 1)
            if (r, c) == (row, column):
                return
            row, column = r, c
            yield field.origin[0] + CELL * column, field.origin[1] + CELL * row

    def _on_ice(self, pose: Pose, acceleration: float) -> tuple[float, float]:
        """Lets go of a key when what it has set going will last until where it is to end."""
        now = self._seen[-1]
        lasted = 0.01 * max(1, len(self._seen) - 1)
        speed = math.dist(now[:2], pose[:2]) / lasted
        turning = wrap_angle(now.theta - pose.theta) / lasted
        assert self._field is not None
        distance, allowed, aim = 0.0, SPEED, self._targets[0]
        x, y = now.x, now.y
        for number, place in enumerate(self._way(self._field, x, y)):
            distance += math.dist((x, y), place)
            x, y = place
            if distance <= LOOKAHEAD:
                aim = place
            if number % 4 == 3 and distance > 0.1:
                towards = math.atan2(y - now.y, x - now.x)
                if abs(wrap_angle(towards - now.theta)) > BEND:
                    allowed = math.hypot(BEND_SPEED, math.sqrt(2.0 * acceleration * max(0.0, distance - 0.3)))
                    break
            if distance > 1.0:
                break
        error = wrap_angle(math.atan2(aim[1] - now.y, aim[0] - now.x) - now.theta)
        coming = turning * abs(turning) / (2.0 * 3.0 * acceleration) + 0.1 * turning
        left = wrap_angle(error - coming)
        turn = 0.0 if abs(left) < 2.0 * STEERING_TOLERANCE else math.copysign(TURN_RATE, left)
        return (SPEED if speed < allowed and abs(error) < TURN_IN_PLACE_ANGLE else 0.0), turn

    def _among_carts(self, pose: Pose, keys: tuple[float, float]) -> tuple[float, float]:
        """The keys that it would press anyway, where no cart comes; else none, else whatever gets out of its way."""
        place = pose[:2]
        assert self._field is not None
        ahead, length = [place], 0.0
        for each in self._way(self._field, *place):
            length += math.dist(ahead[-1], each)
            ahead.append(each)
            if length > SPEED * GOING_S:
                break
        if self._is_clear([*ahead[:: max(1, len(ahead) // 8)], ahead[-1]]):
            return keys
        choices = [(speed, turn) for speed in (SPEED, 0.0, -SPEED) for turn in (0.0, -TURN_RATE, TURN_RATE)]
        ways = [(each, self._way_with(pose, each)) for each in choices]
        safe = [(self._left(way[-1]), each) for each, way in ways if self._is_clear(way)]
        if safe:
            return min(safe)[1]
        return max(ways, key=lambda each: self._room(each[1]))[0]

    def _way_with(self, pose: Pose, keys: tuple[float, float]) -> list[tuple[float, float]]:
        """Where these keys lead to while it goes; a wall ends it."""
        x, y, theta = pose
        way, step = [(x, y)], GOING_S / 8
        for _ in range(8):
            theta += keys[1] * step
            x += keys[0] * math.cos(theta) * step
            y += keys[0] * math.sin(theta) * step
            if self._wall_distance(x, y) < WALL_DISTANCE:
                x, y = way[-1]
            way.append((x, y))
        return way

    def _left(self, place: tuple[float, float]) -> float:
        """How far it is from there to the target [m]."""
        assert self._field is not None
        rows, columns = self._field.values.shape
        column = min(max(round((place[0] - self._field.origin[0]) / CELL), 0), columns - 1)
        row = min(max(round((place[1] - self._field.origin[1]) / CELL), 0), rows - 1)
        return float(self._field.values[row, column])

    def _is_clear(self, way: list[tuple[float, float]]) -> bool:
        """Whether it can go that way, and then stand for a while, without a cart coming near."""
        places = [*way, *[way[-1]] * 6]
        times = np.concatenate(
            [
                np.linspace(0.0, GOING_S, len(way)),
                np.linspace(0.1, STANDING_S, 6) + (GOING_S if len(way) > 1 else 0.0),
            ]
        )
        return all(
            np.hypot(*(self._carts_in(at) - place).T).min() >= CART_DISTANCE
            for at, place in zip(times, places, strict=True)
        )

    def _room(self, way: list[tuple[float, float]]) -> float:
        """The least distance from a cart on a way [m]."""
        times = np.linspace(0.0, GOING_S, len(way))
        return min(
            float(np.hypot(*(self._carts_in(at) - place).T).min())
            for at, place in zip(times, way, strict=True)
        )

    def _carts_in(self, seconds: float) -> np.ndarray:
        """Where the carts will be (k, 2) [m]: they go to and fro, and whoever has watched them for a while knows."""
        return self._cart_ways[
            min(self._session.runner.simulation.tick + round(100.0 * seconds), len(self._cart_ways) - 1)
        ]

    def _watched_carts(self) -> np.ndarray:
        """Where the carts are at every tick (ticks, k, 2) [m]."""
        world = self._session.scenario.world
        others = tuple(each for each in world.models if each.name not in self._models)
        simulation = Simulation(replace(world, models=others), has_subscribers=lambda topic: False)
        places = []
        for _ in range(round(100.0 * self._level.time_limit)):
            places.append([simulation.pose(name)[:2] for name in self._carts])
            simulation.step()
        return np.array(places)

    def _wall_distance(self, x: float, y: float) -> float:
        walls = self._session.scenario.world.wall_segments
        ways = walls[:, 2:] - walls[:, :2]
        to_point = np.array([x, y]) - walls[:, :2]
        share = np.clip((to_point * ways).sum(1) / np.maximum((ways**2).sum(1), 1e-12), 0.0, 1.0)
        return float(np.hypot(*(to_point - share[:, None] * ways).T).min())


class KeyPresser(OrdinaryDriver):
    """Presses these keys, and releases them: the kit's own teleop drives, as in a level that somebody plays."""

    def __init__(self, session: Session, level: GameLevel, reaction_ticks: int = REACTION_TICKS) -> None:
        super().__init__(session, level, reaction_ticks)
        self._down: set[str] = set()
        teleop = "teleop_pair" if len(self._models) > 1 else "teleop"
        session.drive_with(find_controller(teleop))
        session.wait_until_driven()

    def exchange(self) -> bool:
        speed, turn = self.keys(self._pose())
        pushes = {"up": speed > 0.0, "down": speed < 0.0, "left": turn > 0.0, "right": turn < 0.0}
        down = {key for key, is_pushed in pushes.items() if is_pushed}
        if self._is_sent_back():  # and the keys that are down count no more
            self._down = set()
        released, pressed = sorted(self._down - down), sorted(down - self._down)
        self._session.keys.publish([*(f"r_{key}" for key in released), *(f"p_{key}" for key in pressed)])
        self._down = down
        return False

    def _is_sent_back(self) -> bool:
        """Whether teleop has just put the robot back to its start."""
        return len(self._seen) > 1 and math.dist(self._seen[-1][:2], self._seen[-2][:2]) > JUMP
