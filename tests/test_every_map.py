"""Every folder of ``maps/``: it loads, it is closed, its starts are free, its targets can be reached."""

from __future__ import annotations

import math
from collections import Counter
from functools import cache
from itertools import combinations

import numpy as np
import pytest
import yaml

from kit.arrays import BoolArray, FloatArray
from kit.geometry import Pose
from kit.layers.case_sources import open_task, solve_task
from kit.sim.simulation import Simulation, load_world
from kit.world.catalogue import MapCard, MapCase, maps_folder
from kit.world.collision_rules import CollisionRules, ContactKind
from kit.world.records import Circle, Model, Polygon, World
from tests.cases import every_case
from tests.kit_content import kit_maps

MAPS = maps_folder()
ROBOTS = MAPS / "robots"
CARDS = {card.name: card for card in kit_maps()}

CELL = 0.03
"""Side [m] of the squares in which ways are searched."""
HAIR = 0.03
"""Radius [m] of a ghost that slips through anything but a wall: two squares of wall stop it."""

every_map = every_case("name", CARDS)
each_start = pytest.mark.parametrize(
    ("name", "case"),
    [pytest.param(card.name, case, id=case.name) for card in CARDS.values() for case in card.cases],
)


@cache
def world(name: str) -> World:
    return load_world(CARDS[name].world_file, root=CARDS[name].root)


def robots(name: str) -> list[Model]:
    """The robot that the cases are about, and its partner where there is one."""
    wanted = [robot for robot in (CARDS[name].robot, CARDS[name].partner) if robot]
    return [next(model for model in world(name).models if model.name == robot) for robot in wanted]


def starts(case: MapCase) -> list[Pose]:
    return [case.start, *([case.partner_start] if case.partner_start else [])]


def segments(name: str) -> FloatArray:
    """(n, 4): all walls, in world coordinates."""
    return world(name).wall_segments


def reach(robot: Model) -> float:
    """How far [m] the robot's farthest point lies from its origin: turning on the spot it needs that much room."""
    far = [0.0]
    for body in robot.bodies:
        for shape in (footprint.shape for footprint in body.footprints):
            corners = shape.points if isinstance(shape, Polygon) else (shape.center,)
            more = shape.radius if isinstance(shape, Circle) else 0.0
            far += [math.hypot(*body.pose.transform_point(*corner)) + more for corner in corners]
    return max(far)


def clearance(points: FloatArray, walls: FloatArray) -> FloatArray:
    """(..., 2) points [m] -> (...) the distance of each to the nearest wall [m]."""
    nearest = np.full(points.shape[:-1], np.inf)
    for x1, y1, x2, y2 in walls:
        a, ab = np.array((x1, y1)), np.array((x2 - x1, y2 - y1))
        along = np.clip((points - a) @ ab / (ab @ ab), 0, 1)
        offset = points - a - along[..., None] * ab
        nearest = np.minimum(nearest, np.hypot(offset[..., 0], offset[..., 1]))
    return nearest


class Floor:
    """The squares of a map and how far each middle lies from the nearest wall, counted up to MARGIN [m]."""

    MARGIN = 0.5

    def __init__(self, walls: FloatArray) -> None:
        ends = walls.reshape(-1, 2)
        self.corner = ends.min(axis=0) - self.MARGIN
        columns, rows = np.ceil((ends.max(axis=0) + self.MARGIN - self.corner) / CELL).astype(int)
        x = self.corner[0] + CELL * (np.arange(columns) + 0.5)
        y = self.corner[1] + CELL * (np.arange(rows) + 0.5)
        self.middles = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
        self.clear = np.full((columns, rows), self.MARGIN)
        for wall in walls:
            low, high = (
                self.square(np.minimum(wall[:2], wall[2:]) - self.MARGIN),
                self.square(np.maximum(wall[:2], wall[2:]) + self.MARGIN),
            )
            near = slice(max(low[0], 0), high[0] + 1), slice(max(low[1], 0), high[1] + 1)
            self.clear[near] = np.minimum(self.clear[near], clearance(self.middles[near], wall[None]))

    def square(self, point: FloatArray) -> tuple[int, int]:
        column, row = np.floor((point - self.corner) / CELL).astype(int)
        return int(column), int(row)

    def reached(self, start: Pose, radius: float) -> BoolArray:
        """Where a disc of that radius gets to from ``start``."""
        from scipy.ndimage import (
            label,  # here: it takes longer to import than everything else that is collected with it
        )

        free = self.clear > radius
        at = self.square(np.array(start[:2]))
        free[at] = True
        parts, _ = label(free)  # of squares that share a side
        reached: BoolArray = parts == parts[at]
        return reached


@cache
def floor(name: str) -> Floor:
    return Floor(segments(name))


def spread(at: tuple[float, ...], shift: tuple[float, float]) -> FloatArray:
    """(25, 2): the place ``at``, shifted in 5 x 5 steps by up to ``shift`` either way."""
    steps = np.stack(np.meshgrid(np.linspace(-1, 1, 5), np.linspace(-1, 1, 5)), axis=-1).reshape(-1, 2)
    places: FloatArray = np.array(at)[:2] + steps * np.array(shift)
    return places


def test_every_folder_but_the_robots_is_a_map() -> None:
    assert {folder for folder in MAPS.iterdir() if folder.is_dir()} == {
        card.folder for card in CARDS.values()
    } | {ROBOTS}


def test_no_two_cases_share_a_name() -> None:
    names = Counter(case.name for card in CARDS.values() for case in card.cases)
    assert [name for name, count in names.items() if count > 1] == []


@every_map
def test_a_card_says_in_one_line_each_what_the_map_is(name: str) -> None:
    card: MapCard = CARDS[name]
    for line in (card.title, card.summary, card.source):
        assert line.strip()
        assert "\n" not in line.strip()
    assert all((case.partner_start is not None) == (card.partner is not None) for case in card.cases)


@every_map
def test_a_world_is_short_and_says_first_what_it_shows(name: str) -> None:
    lines = CARDS[name].world_file.read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("# ")
    assert len(lines) <= 40


@every_map
def test_the_world_stands_as_its_first_case_begins(name: str) -> None:
    first = CARDS[name].cases[0]
    assert [robot.pose for robot in robots(name)] == starts(first)
    beacons = [model for model in world(name).models if model.name == "beacon"]
    assert [tuple(beacon.pose[:2]) for beacon in beacons] == [first.target] * len(beacons)


@pytest.mark.parametrize("name", CARDS)
def test_nothing_gets_out(name: str) -> None:
    been = floor(name).reached(CARDS[name].cases[0].start, HAIR)
    rim = np.concatenate((been[0], been[-1], been[:, 0], been[:, -1]))
    assert not rim.any()


@each_start
def test_every_start_has_room_to_turn(name: str, case: MapCase) -> None:
    for robot, start in zip(robots(name), starts(case), strict=True):
        assert clearance(spread(start, case.start_shift), segments(name)).min() > reach(robot)


@every_map
def test_no_two_models_start_on_one_another(name: str) -> None:
    placed = [(model.pose, reach(model)) for model in world(name).models if model.name != "beacon"]
    for i, (one, room) in enumerate(placed):
        for other, more in placed[i + 1 :]:
            assert math.hypot(one.x - other.x, one.y - other.y) > room + more


@each_start
def test_every_target_can_be_reached(name: str, case: MapCase) -> None:
    been = floor(name).reached(case.start, max(reach(robot) for robot in robots(name)))
    for place in spread(case.target, case.target_shift):
        assert been[floor(name).square(place)]


@every_map
def test_robots_touch_and_see_walls_and_each_other_and_not_themselves(name: str) -> None:
    touching = CollisionRules(world(name))
    own = {robot.name for robot in robots(name)}
    hulls = [
        thing for thing in touching.bodies if thing.model in own and any(s.category for s in thing.filters)
    ]
    walls = [thing for thing in touching.bodies if thing.model is None]
    assert len(hulls) == len(own)
    assert len(walls) == 1
    for one, other in combinations([*hulls, *walls], 2):
        assert touching.contact_rule(one, other).kind is ContactKind.COLLIDES
    for laser in (laser for laser in touching.lasers if laser.model in own):
        seen = {thing for thing in touching.bodies if touching.visibility(laser, thing).is_visible}
        assert seen >= {thing for thing in [*hulls, *walls] if thing.model != laser.model}
        assert not any(thing.model == laser.model for thing in seen)


@every_map
def test_a_beacon_sees_robots_only_and_nothing_touches_it(name: str) -> None:
    touching = CollisionRules(world(name))
    own = {robot.name for robot in robots(name)}
    for laser in (laser for laser in touching.lasers if laser.model == "beacon"):
        assert {
            thing.model for thing in touching.bodies if touching.visibility(laser, thing).is_visible
        } == own
    for one, other, verdict in touching.contact_rules():
        assert "beacon" not in (one.model, other.model) or verdict.kind is ContactKind.PASSES


@every_map
def test_a_world_names_as_few_layers_as_can_be(name: str) -> None:
    _, plan = solve_task(open_task(str(CARDS[name].world_file), root=CARDS[name].root))
    assert plan is not None
    assert plan.current_name_count == plan.size == plan.bound


@every_map
def test_a_resting_robot_has_a_wall_in_every_direction_and_touches_none(name: str) -> None:
    simulation = Simulation(world(name))
    simulation.step(20)
    assert simulation.state().contacts == ()
    for robot in robots(name):
        assert simulation.state().pose(robot.name) == pytest.approx(robot.pose)
        (view,) = (view for view in simulation.latest_scans() if view.model == robot.name)
        assert np.isfinite(view.ranges).all()


@pytest.mark.parametrize("variant", ["serp_tracked", "left", "right"])
def test_the_robots_differ_in_layers_and_colour_only(variant: str) -> None:
    def plain(value: object) -> object:
        if isinstance(value, dict):
            return {key: plain(each) for key, each in value.items() if key not in {"layers", "color"}}
        return [plain(each) for each in value] if isinstance(value, list) else value

    read = [
        yaml.safe_load((ROBOTS / f"{each}.model.yaml").read_text(encoding="utf-8"))
        for each in ("serp", variant)
    ]
    assert plain(read[0]) == plain(read[1])
