"""The level of the day: a map that its date generates, the same for everybody, with a drive that proves it drivable.

The first run of a day counts, for the board of the day and the streak, also if it is left; further ones are practice.
"""

from __future__ import annotations

import datetime
import math
import random
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from itertools import islice, pairwise
from typing import Final, TypeAlias

import numpy as np

from kit.arrays import FloatArray
from kit.breadth_first import reached_from
from kit.geometry import Pose, wrap_angle
from kit.run.scenario import BEACON, Scenario
from kit.school.game.drive_commands import DriveCommand, ReferenceDrive
from kit.school.game.levels import (
    SPEED,
    TURN_RATE,
    ExtraRules,
    GameLevel,
    LevelConditions,
    UnknownLevel,
    apply_conditions,
    find_level,
)
from kit.school.game.player_progress import drive_from_event
from kit.school.game.task_levels import find_task_level
from kit.school.progress import EventKind, ProgressEvent
from kit.segments import nearest_on_segments
from kit.sim.simulation import STEP_SIZE_S

DAILY_PREFIX: Final = "daily-"
_ID: Final = re.compile(rf"{DAILY_PREFIX}(\d{{4}}-\d{{2}}-\d{{2}})")
BASE_LEVEL: Final = "roundabout"
"""Its robot drives, and its world holds the walls."""
CELL: Final = 0.8
"""Side of a cell [m]."""
WALL: Final = 0.1
"""Thickness of a wall [m]."""
COLUMNS, ROWS = (6, 9), (4, 6)
"""Fewest and most cells of a map."""
LOOPS: Final = 0.12
"""Share of the walls between cells that are taken out of the maze again, so that there are several ways."""
LEAST_CELLS, LEAST_BENDS = 9, 4
"""Of the shortest way: a map with less is drawn again."""
RADIUS: Final = 0.25
"""Of the target [m]."""
LOOKAHEADS: Final = (0.3, 0.35, 0.4)
"""Distances at which the reference drive may aim [m]: the farther, the more of a bend is cut."""
INSETS: Final = (0.0, 0.03, 0.06)
"""How far from the middle of an opening it may pass, on the inner side of the bends before and after [m]."""
MOST_WAYS: Final = 8
"""Of the equally short ways that it may take."""
LEAST_CLEARANCE: Final = 0.147
"""Of the middle of the robot from walls; its hull reaches 0.145 m [m]."""
HULL_AHEAD: Final = 0.048
"""Of the robot's front from its middle [m]."""
HOLD_TICKS, GAIN, POINT_STEP = 5, 6.0, 0.02
"""Of the pursuit: ticks of a command, turn rate per error of heading [1/s], and m between two points of the way."""
MAX_COMMANDS: Final = 4000

Cell: TypeAlias = tuple[int, int]
"""Column and row, from 0."""


@dataclass(frozen=True, slots=True)
class DailyMap:
    """A maze of cells."""

    columns: int
    rows: int
    openings: frozenset[tuple[Cell, Cell]]
    """Neighbours without a wall between them, in both directions."""
    way: tuple[Cell, ...]
    """A shortest way from the start to the target."""


@dataclass(frozen=True, slots=True)
class DailyLevel(GameLevel):
    """A level whose map is generated."""

    day: datetime.date = datetime.date.min

    @property
    def map(self) -> DailyMap:
        return daily_map(self.day)

    def find_scenario(self) -> Scenario:
        """The robot of another level at the start of the generated map."""
        base = find_level(BASE_LEVEL).find_scenario()
        drawn, walls = self.map, wall_segments(self.map)
        case, robot = base.case, base.robot
        assert case is not None  # every level has one
        start, target = start_pose(drawn), _middle_of_cell(drawn.way[-1])
        layers = tuple(
            layer
            if layer.walls is None
            else replace(layer, walls=replace(layer.walls, local_segments=walls, origin=Pose()))
            for layer in base.world.layers
        )
        poses = {robot: start, BEACON: Pose(*target)}
        models = tuple(
            replace(model, pose=poses[model.name]) for model in base.world.models if model.name in poses
        )
        scenario = replace(
            base,
            title=self.title,
            world=replace(base.world, layers=layers, models=models),
            case=replace(case, start=start, target=target, target_radius=RADIUS),
            level=self.id,
        )
        return apply_conditions(scenario, self.conditions)


@cache
def daily_level(day: datetime.date) -> GameLevel:
    """The level of a day; in fog on some days. It is always open."""
    base = find_level(BASE_LEVEL)
    fog = _random_of_day(day).random() < 0.4
    reference = daily_drive(daily_map(day))
    return DailyLevel(
        id=daily_id(day),
        title=f"The maze of {day.isoformat()}{' in fog' if fog else ''}",
        map_name=base.map_name,
        case=base.case,
        hint="To the target, by the shortest way.",
        opened_by=(),
        row=0,
        story="A new maze every day, the same for everybody.",
        skill="finding the way before the clock starts",
        time_limit=math.ceil(5.0 * reference.seconds),
        rules=ExtraRules(max_training_steps=None),
        conditions=LevelConditions(fog=fog),
        day=day,
        drive=reference,
    )


def _random_of_day(day: datetime.date) -> random.Random:
    return random.Random(day.toordinal())


@cache
def daily_map(day: datetime.date) -> DailyMap:
    """The map of a day: a spanning tree of cells (randomized depth-first search) with some walls taken out again."""
    chance = _random_of_day(day)
    chance.random()  # the first one decides about fog
    while True:
        columns, rows = chance.randint(*COLUMNS), chance.randint(*ROWS)
        openings = _draw_maze(chance, columns, rows)
        start = (0, chance.randrange(rows))
        ways = dict(reached_from(start, partial(_moves_through, sorted(openings))))
        far = max(ways, key=lambda cell: (len(ways[cell]), cell))
        way = (start, *ways[far])
        bends = sum(
            _direction(a, b) != _direction(b, c) for a, b, c in zip(way, way[1:], way[2:], strict=False)
        )
        if len(way) >= LEAST_CELLS and bends >= LEAST_BENDS:
            return DailyMap(columns, rows, frozenset(openings), way)


def _draw_maze(chance: random.Random, columns: int, rows: int) -> set[tuple[Cell, Cell]]:
    openings: set[tuple[Cell, Cell]] = set()
    stack, seen = [(0, 0)], {(0, 0)}
    while stack:
        cell = stack[-1]
        beside = [each for each in _neighbours(cell, columns, rows) if each not in seen]
        if not beside:
            stack.pop()
            continue
        following = chance.choice(beside)
        openings |= {(cell, following), (following, cell)}
        seen.add(following)
        stack.append(following)
    for cell in sorted(seen):
        for other in _neighbours(cell, columns, rows):
            if other > cell and (cell, other) not in openings and chance.random() < LOOPS:
                openings |= {(cell, other), (other, cell)}
    return openings


def _neighbours(cell: Cell, columns: int, rows: int) -> list[Cell]:
    x, y = cell
    around = ((x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1))
    return [(a, b) for a, b in around if 0 <= a < columns and 0 <= b < rows]


def _moves_through(openings: Sequence[tuple[Cell, Cell]], cell: Cell) -> Iterator[tuple[Cell, Cell]]:
    """The cells beside one that an opening leads to, each as the move there and where that leads."""
    return ((second, second) for first, second in openings if first == cell)


def _direction(a: Cell, b: Cell) -> tuple[int, int]:
    return b[0] - a[0], b[1] - a[1]


def _middle_of_cell(cell: Cell) -> tuple[float, float]:
    return (cell[0] + 0.5) * CELL, (cell[1] + 0.5) * CELL


def start_pose(drawn: DailyMap) -> Pose:
    """The pose in the middle of the first cell, towards the second one."""
    x, y = _middle_of_cell(drawn.way[0])
    dx, dy = _direction(drawn.way[0], drawn.way[1])
    return Pose(x, y, math.atan2(dy, dx))


def wall_segments(drawn: DailyMap) -> FloatArray:
    """(n, 4) ``x1 y1 x2 y2`` [m]: the outlines of all walls."""
    segments: list[tuple[float, float, float, float]] = []

    def block(x1: float, y1: float, x2: float, y2: float) -> None:
        corners = [(x1, y1), (x2, y1), (x2, y2), (x1, y2), (x1, y1)]
        segments.extend((*a, *b) for a, b in pairwise(corners))

    half, width, height = 0.5 * WALL, drawn.columns * CELL, drawn.rows * CELL
    for x in (0.0, width):
        block(x - half, -half, x + half, height + half)
    for y in (0.0, height):
        block(-half, y - half, width + half, y + half)
    for x in range(drawn.columns):
        for y in range(drawn.rows):
            for other in ((x + 1, y), (x, y + 1)):
                if (
                    other[0] < drawn.columns
                    and other[1] < drawn.rows
                    and ((x, y), other) not in drawn.openings
                ):
                    left, low = other[0] * CELL, other[1] * CELL
                    right, high = (left, low + CELL) if other[0] > x else (left + CELL, low)
                    block(left - half, low - half, right + half, high + half)
    return np.array(segments, dtype=np.float64)


def daily_drive(drawn: DailyMap) -> ReferenceDrive:
    """The reference drive of a map: pure pursuit from opening to opening at full speed, by the quickest of the shortest ways,
    which cuts bends by as much as the walls leave room for. That it arrives and touches nothing proves the map drivable."""
    walls, start = wall_segments(drawn), start_pose(drawn)
    tried = [
        _pursue_path(start, _places_to_pass(way, inset), lookahead)
        for way in islice(_shortest_ways(drawn), MOST_WAYS)
        for inset in INSETS
        for lookahead in LOOKAHEADS
    ]
    safe = [
        drive for drive, places in tried if nearest_on_segments(places, walls)[0].min() >= LEAST_CLEARANCE
    ]
    return min(safe, key=lambda drive: drive.seconds)


def _shortest_ways(drawn: DailyMap) -> Iterator[tuple[Cell, ...]]:
    """All ways through as few cells as the map's own."""
    moves = partial(_moves_through, sorted(drawn.openings))
    left = {cell: len(way) for cell, way in reached_from(drawn.way[-1], moves)}

    def go_on(way: tuple[Cell, ...]) -> Iterator[tuple[Cell, ...]]:
        if way[-1] == drawn.way[-1]:
            yield way
        for _, cell in moves(way[-1]):
            if left[cell] < left[way[-1]]:
                yield from go_on((*way, cell))

    return go_on(drawn.way[:1])


def _places_to_pass(way: Sequence[Cell], inset: float) -> list[tuple[float, float]]:
    """Points in the openings of a way, and the middle of its last cell. ``inset``: how far from the middle [m]."""
    moves = [_direction(a, b) for a, b in pairwise(way)]
    places = []
    for number, (cell, move) in enumerate(zip(way, moves, strict=False)):
        x, y = _middle_of_cell(cell)
        before, after = moves[max(number - 1, 0)], moves[min(number + 1, len(moves) - 1)]
        aside = [max(-1, min(1, then - earlier)) if not ahead else 0
                 for then, earlier, ahead in zip(after, before, move, strict=True)]  # fmt: skip
        places.append(
            (x + 0.5 * CELL * move[0] + inset * aside[0], y + 0.5 * CELL * move[1] + inset * aside[1])
        )
    return [*places, _middle_of_cell(way[-1])]


def _pursue_path(
    start: Pose, corners: Sequence[tuple[float, float]], lookahead: float
) -> tuple[ReferenceDrive, FloatArray]:
    """The commands of a pursuit, and (k, 2) its places [m]; the motors' model is exact, so the simulator drives the same."""
    x, y, theta = start
    points = np.concatenate(
        [
            np.linspace(first, second, max(1, round(math.dist(first, second) / POINT_STEP)), endpoint=False)
            for first, second in pairwise([(x, y), *corners])
        ]
        + [np.array(corners[-1:])]
    ).tolist()
    dt = HOLD_TICKS * STEP_SIZE_S
    at, places = 0, [(x, y)]
    commands: list[DriveCommand] = []
    while math.dist((x, y), corners[-1]) > RADIUS + HULL_AHEAD and len(commands) < MAX_COMMANDS:
        while at < len(points) - 1 and math.dist(points[at], (x, y)) < lookahead:
            at += 1
        error = wrap_angle(math.atan2(points[at][1] - y, points[at][0] - x) - theta)
        turn = round(max(-TURN_RATE, min(TURN_RATE, GAIN * error)), 4)
        commands.append(DriveCommand(HOLD_TICKS, SPEED, turn))
        for _ in range(HOLD_TICKS):
            theta += turn * STEP_SIZE_S
            x += SPEED * STEP_SIZE_S * math.cos(theta)
            y += SPEED * STEP_SIZE_S * math.sin(theta)
        places.append((x, y))
    return ReferenceDrive(tuple(commands), round(len(commands) * dt, 3)), np.array(places)


def today() -> datetime.date:
    """The date where the player is."""
    return datetime.datetime.now().astimezone().date()


def yesterday() -> datetime.date:
    """The day before ``today``, of which a board tells who won."""
    return today() - datetime.timedelta(days=1)


def daily_id(day: datetime.date) -> str:
    """The id of a day's level, which takes no map to be drawn."""
    return f"{DAILY_PREFIX}{day.isoformat()}"


def find_playable_level(name: str) -> GameLevel:
    """Finds a level as ``find_level`` does, a daily one by its id, such as ``daily-2026-09-01``, or the level of a task by
    the task's file, folder or name. Raises UnknownLevel, and WorldError for a task that cannot be one."""
    found = _ID.fullmatch(name)
    if found is None:
        try:
            return find_level(name)
        except UnknownLevel:
            of_task = find_task_level(name)
            if of_task is None:
                raise
            return of_task
    try:
        return daily_level(datetime.date.fromisoformat(found[1]))
    except ValueError:
        raise UnknownLevel(f"There is no such day: {found[1]}.") from None


def is_of_today(level: GameLevel) -> bool:
    """Whether it is today's level."""
    return isinstance(level, DailyLevel) and level.day == today()


def streak(events: Sequence[ProgressEvent], today: datetime.date) -> int:
    """Returns for how many days in a row, up to today or yesterday, the daily challenge was begun on its day and finished."""
    begun = {event.subject: event for event in reversed(events) if event.kind is EventKind.START}
    days = set()
    for event in events:
        found = _ID.fullmatch(event.subject) if event.kind is EventKind.FINISH else None
        drive = drive_from_event(event) if found is not None else None
        if found is None or drive is None or not drive.finish.reached or drive.is_shipped:
            continue
        day = begun.get(event.subject, event).time.astimezone().date()
        if day.isoformat() == found[1]:
            days.add(day)
    last = today if today in days else today - datetime.timedelta(days=1)
    count = 0
    while last - datetime.timedelta(days=count) in days:
        count += 1
    return count


def has_run(events: Sequence[ProgressEvent], level: GameLevel) -> bool:
    """Whether a run of a day's level has begun: what comes after it is practice."""
    return level.id.startswith(DAILY_PREFIX) and any(
        event.kind in (EventKind.START, EventKind.FINISH) and event.subject == level.id for event in events
    )
