"""Searches the reference drives of the game: ``python -m tests.school.game.search [LEVEL ...]`` writes lessons/reference_drives.json.

A* (Hart, Nilsson and Raphael 1968) over motion primitives of a tenth of a second that are measured on the exact simulation
(a state lattice, Pivtoraju and Kelly 2005): forward, backwards, bends and turns on the spot, at the level's full speed. Moving
carts are avoided in time as well as in space. What it finds is driven on the exact simulation, and kept only if it reaches the
goal, touches nothing and is faster than the drive that is there. Where speed carries over from one primitive to the next (a
slippery floor), and for goals other than targets, a receding-horizon search rolls the exact simulation ahead instead.
"""

from __future__ import annotations

import heapq
import itertools
import json
import math
import sys
import time
from dataclasses import replace
from types import SimpleNamespace

import numba
import numpy as np

from kit.fields.occupancy_grid import wall_distances
from kit.geometry import convex_hull, wrap_angle
from kit.kernels import grids
from kit.learning.environment.distance_field import compute_distance_field
from kit.msg.geometry_msgs import Twist, Vector3
from kit.school.game.drive_commands import DriveCommand, ReferenceDrive
from kit.school.game.levels import PAIR_SPEED, SPEED, TURN_RATE, GameLevel, all_levels
from kit.school.game.race import DOCK_TIME, RaceReferee
from kit.school.game.references import drive_reference, drives_file, load_drives
from kit.school.game.starts import OWN_SEED
from kit.sim.simulation import Simulation
from tests.school.game.map_plans import LANES
from tests.school.game.measured_drivers import drive
from tests.school.game.ordinary import OrdinaryDriver
from tests.school.game.tidy import PAIR_TURN_RATE

TICKS = 10
"""Of one primitive."""
CELL = 0.025
HEADINGS = 84
KEY_CELL = 0.02
"""States nearer to each other than this count as one [m]."""
MARGIN = 0.004
"""The hull is taken to be this much larger all round [m]."""
MAX_NODES = 4_000_000
LANE_RADIUS = 0.06
"""So near it comes to the corners of lanes [m]."""
PURSUIT_S = 40.0
POLISH_S = 5.0
"""Wall clock [s]."""


@numba.njit(cache=True)
def _segment_hits(ax, ay, bx, by, cx, cy, dx, dy):
    d1 = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    d2 = (bx - ax) * (dy - ay) - (by - ay) * (dx - ax)
    d3 = (dx - cx) * (ay - cy) - (dy - cy) * (ax - cx)
    d4 = (dx - cx) * (by - cy) - (dy - cy) * (bx - cx)
    return d1 * d2 <= 0.0 and d3 * d4 <= 0.0


@numba.njit(cache=True)
def _hull_distance(hull, x, y, cos, sin, px, py):
    """From a point to the convex hull at a pose; 0 inside."""
    u, v = cos * (px - x) + sin * (py - y), -sin * (px - x) + cos * (py - y)
    best, inside, n = 1e9, True, len(hull)
    for i in range(n):
        ax, ay = hull[i]
        bx, by = hull[(i + 1) % n]
        ex, ey = bx - ax, by - ay
        if ex * (v - ay) - ey * (u - ax) < 0.0:
            inside = False
        t = min(max(((u - ax) * ex + (v - ay) * ey) / (ex * ex + ey * ey), 0.0), 1.0)
        best = min(best, math.hypot(u - ax - t * ex, v - ay - t * ey))
    return 0.0 if inside else best


@numba.njit(cache=True)
def _is_free(hull, walls, room, ox, oy, reach, x, y, th):
    rows, columns = room.shape
    c, r = int((x - ox) / CELL + 0.5), int((y - oy) / CELL + 0.5)
    if r < 0 or c < 0 or r >= rows or c >= columns:
        return False
    clear = room[r, c]
    if clear > reach + CELL:
        return True
    cos, sin, n = math.cos(th), math.sin(th), len(hull)
    for w in range(len(walls)):
        cx, cy, dx, dy = walls[w]
        if (
            min(cx, dx) > x + reach
            or max(cx, dx) < x - reach
            or min(cy, dy) > y + reach
            or max(cy, dy) < y - reach
        ):
            continue
        for i in range(n):
            ax, ay = hull[i]
            bx, by = hull[(i + 1) % n]
            if _segment_hits(
                x + cos * ax - sin * ay,
                y + sin * ax + cos * ay,
                x + cos * bx - sin * by,
                y + sin * bx + cos * by,
                cx,
                cy,
                dx,
                dy,
            ):
                return False
    return True


@numba.njit(cache=True)
def _search(
    start,
    hull,
    goal_hulls,
    reach,
    walls,
    room,
    ox,
    oy,
    moves,
    halves,
    fields,
    rest,
    discs,
    speed,
    carts,
    uses_time,
    weight,
):
    """Returns (action of each step) or an empty array. ``discs`` (legs, 4): x, y, radius, steps to stand still there."""
    rows, columns = room.shape
    legs = len(discs)
    xs, ys, ths = [start[0]], [start[1]], [start[2]]
    parents, actions, leg_of, depth, waits = [-1], [-1], [0], [0], [0]
    heap = [(0.0, 0)]
    closed = {0: False}
    closed.clear()
    step_s = TICKS * 0.01
    while len(heap) > 0:
        _, node = heapq.heappop(heap)
        x, y, th, leg = xs[node], ys[node], ths[node], leg_of[node]
        if leg == legs:
            count = depth[node]
            out = np.empty(count, np.int64)
            while parents[node] >= 0:
                count -= 1
                out[count] = actions[node]
                node = parents[node]
            return out
        turn = math.floor(th / (2.0 * math.pi / HEADINGS)) % HEADINGS
        key = int((x - ox) / KEY_CELL) + 2 * columns * (
            int((y - oy) / KEY_CELL) + 2 * rows * (turn + HEADINGS * (leg * 16 + waits[node]))
        )
        if uses_time:
            key = key * 4096 + depth[node] // 3
        if key in closed:
            continue
        closed[key] = True
        if len(xs) > MAX_NODES:
            return np.empty(0, np.int64)
        for a in range(len(moves)):
            is_wait = moves[a, 0] == 0.0 and moves[a, 1] == 0.0 and moves[a, 2] == 0.0
            cos, sin = math.cos(th), math.sin(th)
            nx, ny = x + cos * moves[a, 0] - sin * moves[a, 1], y + sin * moves[a, 0] + cos * moves[a, 1]
            nth = th + moves[a, 2]
            nleg, nwait = leg, 0
            d = depth[node] + 1
            if not is_wait:
                hx, hy = (
                    x + cos * halves[a, 0] - sin * halves[a, 1],
                    y + sin * halves[a, 0] + cos * halves[a, 1],
                )
                if not _is_free(hull, walls, room, ox, oy, reach, nx, ny, nth):
                    continue
                if not _is_free(hull, walls, room, ox, oy, reach, hx, hy, th + halves[a, 2]):
                    continue
            is_met = False
            for k in range(carts.shape[1]):
                for back in (0, TICKS // 2):
                    t = min(d * TICKS - back, carts.shape[0] - 1)
                    px, py = (nx, ny) if back == 0 else (0.5 * (x + nx), 0.5 * (y + ny))
                    if math.hypot(carts[t, k, 0] - px, carts[t, k, 1] - py) < reach + carts[
                        t, k, 2
                    ] + 0.05 and (
                        _hull_distance(
                            hull, px, py, math.cos(nth), math.sin(nth), carts[t, k, 0], carts[t, k, 1]
                        )
                        < carts[t, k, 2] + 0.02
                    ):
                        is_met = True
            if is_met:
                continue
            disc = discs[leg]
            away = 0.0
            for robot in range(len(goal_hulls)):
                away = max(
                    away,
                    _hull_distance(goal_hulls[robot], nx, ny, math.cos(nth), math.sin(nth), disc[0], disc[1]),
                )
            is_there = (
                math.hypot(nx - disc[0], ny - disc[1]) <= 0.22 if disc[3] > 0.0 else away <= disc[2] - 0.003
            )
            if is_there:
                if disc[3] > 0.0:
                    if is_wait:
                        nwait = waits[node] + 1
                        if nwait > disc[3]:
                            nleg, nwait = leg + 1, 0
                else:
                    nleg = leg + 1
            h = 0.0
            if nleg < legs:
                c, r = int((nx - ox) / CELL + 0.5), int((ny - oy) / CELL + 0.5)
                h = max(0.0, 0.93 * fields[nleg, r, c] - discs[nleg, 2] - reach) / speed + rest[nleg]
            xs.append(nx)
            ys.append(ny)
            ths.append(nth)
            parents.append(node)
            actions.append(a)
            leg_of.append(nleg)
            depth.append(d)
            waits.append(nwait)
            heapq.heappush(heap, (d * step_s + weight * h, len(xs) - 1))
    return np.empty(0, np.int64)


def commands_of(level: GameLevel) -> list[tuple[float, float]]:
    scenario = level.find_scenario()
    if is_tricycle(scenario):
        return [(s * SPEED, a) for s in (1, -1) for a in (0.0, 0.9, -0.9, 0.45, -0.45)]
    pair = len(scenario.partners) > 1
    speed, turn = (PAIR_SPEED, PAIR_TURN_RATE) if pair else (SPEED, TURN_RATE)
    half_gap = 0.5 * math.dist(*(pose[:2] for pose in scenario.starts)) if pair else 0.0

    def bend(direction: int, share: float) -> tuple[float, float]:
        return direction * (speed - abs(share) * turn * half_gap), share * turn

    found = [bend(s, w) for s in (1, -1) for w in (0, 1, -1)] + [(0.0, turn), (0.0, -turn)]
    found += [bend(1, 0.5), bend(1, -0.5)]
    if scenario.world.models and (
        level.conditions.docks or level.conditions.carts or level.map_name == "crossing"
    ):
        found.append((0.0, 0.0))
    return found


def is_tricycle(scenario) -> bool:
    return any(each.type == "TricycleDrive" for each in scenario.driven.plugins)


def track_front_wheel(level: GameLevel, scenario, points: list[tuple[np.ndarray, float]]) -> ReferenceDrive:
    """Follows planned poses of a tricycle, whose steering takes time: its front wheel drives towards the next point.

    ``points``: the pose planned after each primitive, and the speed on the way there.
    """
    simulation = Simulation(scenario.world, seed=OWN_SEED, has_subscribers=lambda topic: False)
    commands: list[DriveCommand] = []
    for number, (_, speed) in enumerate(points):
        ahead = number
        while ahead + 1 < len(points) and ahead < number + 1 and points[ahead + 1][1] == speed:
            ahead += 1
        goal = points[ahead][0]
        for _ in range(2):
            pose = middle(simulation, scenario)
            towards = math.atan2(goal[1] - pose[1], goal[0] - pose[0]) + (math.pi if speed < 0 else 0.0)
            steering = max(-0.9, min(0.9, wrap_angle(towards - pose[2])))
            commands.append(DriveCommand(TICKS // 2, speed, round(steering, 3)))
            apply(simulation, scenario, (speed, steering))
            simulation.step(TICKS // 2)
    return ReferenceDrive(tuple(commands))


def apply(simulation: Simulation, scenario, command: tuple[float, float]) -> None:
    half = 0.0
    if len(scenario.starts) > 1:
        half = 0.5 * math.dist(scenario.starts[0][:2], scenario.starts[1][:2])
    for name, offset in zip(scenario.partners, (-half, half), strict=False):
        for end in simulation.model_endpoints(name):
            if end.direction == "subscribe" and end.type is Twist:
                simulation.accept(
                    end.topic,
                    Twist(linear=Vector3(x=command[0] + command[1] * offset), angular=Vector3(z=command[1])),
                )


def middle(simulation: Simulation, scenario) -> np.ndarray:
    poses = [simulation.pose(name) for name in scenario.partners]
    return np.array([np.mean([p.x for p in poses]), np.mean([p.y for p in poses]), poses[0].theta])


def measured_moves(scenario, commands) -> tuple[np.ndarray, np.ndarray]:
    """How far each primitive goes, whole and half, in the frame of its start."""
    models = tuple(each for each in scenario.world.models if each.name in scenario.partners)
    layers = tuple(replace(layer, walls=None) for layer in scenario.world.layers)
    simulation = Simulation(
        replace(scenario.world, models=models, layers=layers), has_subscribers=lambda topic: False
    )
    found = []
    for command in commands:
        simulation.reset()
        apply(simulation, scenario, command)
        if is_tricycle(scenario):
            simulation.step(5 * TICKS)  # until its steering is there
        x, y, th = middle(simulation, scenario)
        for ticks in (TICKS // 2, TICKS - TICKS // 2):
            simulation.step(ticks)
            nx, ny, nth = middle(simulation, scenario)
            dx, dy = nx - x, ny - y
            found.append(
                (
                    math.cos(th) * dx + math.sin(th) * dy,
                    math.cos(th) * dy - math.sin(th) * dx,
                    wrap_angle(nth - th),
                )
            )
    array = np.array(found)
    array[np.abs(array) < 1e-7] = 0.0
    return array[1::2], array[0::2]


def hull_of(scenario, robot: str = "") -> np.ndarray:
    """The convex hull of all that drives, or of one robot of it, in the frame of the middle."""
    start = middle(Simulation(scenario.world), scenario)
    points = []
    for model in scenario.world.models:
        if model.name in ((robot,) if robot else scenario.partners):
            for body in model.bodies:
                for footprint in body.footprints:
                    for px, py in getattr(footprint.shape, "points", ()):
                        wx, wy = model.pose.compose(body.pose).transform_point(px, py)
                        dx, dy = wx - start[0], wy - start[1]
                        c, s = math.cos(start[2]), math.sin(start[2])
                        points.append((c * dx + s * dy, c * dy - s * dx))
    return np.array(convex_hull([(round(x, 5), round(y, 5)) for x, y in points]))


def legs_of(level: GameLevel, scenario):
    """Candidates for the order of the targets: rows (x, y, radius, seconds to stand still)."""
    radius = scenario.case.target_radius
    if level.id in LANES:
        return [[(x, y, LANE_RADIUS, 0.0) for x, y in LANES[level.id][1:]]]
    if not level.goal.is_route:
        orders = [[(*scenario.case.target, radius, 0.0)]]
    else:
        targets = [(x, y, radius, 0.0) for x, y in level.goal.route(level.targets)]
        orders = [list(each) for each in itertools.permutations(targets)] if level.any_order else [targets]
    if level.conditions.charge:
        docks = [(x, y, 0.2, DOCK_TIME) for x, y in level.conditions.docks]
        orders = [
            [
                leg
                for leg, before in zip(order, plan, strict=True)
                for leg in ([docks[0]] if before else []) + [leg]
            ]
            for order in orders
            for plan in itertools.product((False, True), repeat=len(order))
            if any(plan)
        ]
    return orders


def search_lattice(level: GameLevel) -> list[ReferenceDrive]:
    scenario = level.find_scenario()
    commands = commands_of(level)
    moves, halves = measured_moves(scenario, commands)
    true_hull = hull_of(scenario)
    goal_hulls = np.array([hull_of(scenario, name) for name in scenario.partners])
    tricycle = is_tricycle(scenario)
    hull = true_hull + (0.035 if tricycle else MARGIN) * np.sign(true_hull)
    reach = float(np.hypot(hull[:, 0], hull[:, 1]).max())
    walls = scenario.world.wall_segments
    points = walls.reshape(-1, 2)
    origin = points.min(axis=0) - 2 * CELL
    columns, rows = np.ceil((points.max(axis=0) + 2 * CELL - origin) / CELL).astype(int) + 1
    x, y = origin[0] + CELL * np.arange(columns), origin[1] + CELL * np.arange(rows)
    room = wall_distances(x, y, walls, reach + 2 * CELL)
    price = np.ones_like(room)
    price[room < (0.02 if len(scenario.partners) > 1 else 0.07)] = math.inf
    fields: dict[tuple[float, float], np.ndarray] = {}

    def field(px: float, py: float) -> np.ndarray:
        if (px, py) not in fields:
            lengths = np.full((rows, columns), math.inf)
            lengths[round((py - origin[1]) / CELL), round((px - origin[0]) / CELL)] = 0.0
            grids.relax_path_lengths(lengths, price, CELL)
            lengths[~np.isfinite(lengths)] = 1e3
            fields[px, py] = lengths
        return fields[px, py]

    def length(a, b) -> float:
        return float(field(b[0], b[1])[round((a[1] - origin[1]) / CELL), round((a[0] - origin[0]) / CELL)])

    start = middle(Simulation(scenario.world), scenario)
    orders = legs_of(level, scenario)

    def estimate(order) -> float:
        return sum(length(a, b) for a, b in itertools.pairwise([tuple(start), *order])) + sum(
            0.6 for leg in order if leg[3]
        )

    def lasts(order) -> bool:
        left, at = level.conditions.charge or math.inf, tuple(start)
        for leg in order:
            left -= 0.96 * length(at, leg) - leg[2]
            at = leg
            if left < 0.0:
                return False
            if leg[3]:
                left = level.conditions.charge
        return True

    orders = sorted((order for order in orders if lasts(order)), key=estimate)
    carts = np.zeros((1, 0, 3))
    others = [each.name for each in scenario.world.models if each.name not in (*scenario.partners, "beacon")]
    if others:
        models = tuple(each for each in scenario.world.models if each.name not in scenario.partners)
        simulation = Simulation(replace(scenario.world, models=models), has_subscribers=lambda topic: False)
        track = []
        for _ in range(round(level.time_limit / 0.01)):
            track.append([(*simulation.pose(name)[:2], 0.15) for name in others])
            simulation.step()
        carts = np.array(track)
    found = []
    speed = max(abs(v) for v, _ in commands)

    def plan(pose: np.ndarray, order, first_tick: int) -> np.ndarray:
        discs = np.array([(x, y, r, wait / (TICKS * 0.01)) for x, y, r, wait in order])
        gaps = [
            max(0.0, 0.93 * length(a, b) - a[2] - b[2] - 2 * reach) / speed + a[3]
            for a, b in itertools.pairwise(order)
        ]
        rest = np.array([sum(gaps[number:]) for number in range(len(order))])
        grids_of_legs = np.array([field(px, py) for px, py, _, _ in order])
        for weight in (1.0, 1.15, 1.5, 2.5) if len(order) == 1 else (1.2, 1.5, 2.5):
            steps = _search(
                pose,
                hull,
                goal_hulls,
                reach,
                walls,
                room,
                origin[0],
                origin[1],
                moves,
                halves,
                grids_of_legs,
                rest,
                discs,
                speed,
                carts[first_tick:],
                bool(others),
                weight,
            )
            if len(steps):
                return steps
        return np.empty(0, np.int64)

    for order in orders[:2]:
        pose, actions, planned = start, [], []
        for number in range(len(order)):  # two targets ahead, of which the first is kept
            ahead = order[number : number + 2]
            steps = plan(pose, ahead, len(actions) * TICKS)
            whole = plan(pose, ahead[:1], len(actions) * TICKS) if not len(steps) else steps
            if not len(whole):
                break
            still = 0
            for action in whole.tolist():
                c, sn = math.cos(pose[2]), math.sin(pose[2])
                dx, dy, dth = moves[action]
                pose = pose + np.array([c * dx - sn * dy, sn * dx + c * dy, dth])
                actions.append(action)
                planned.append((pose, commands[action][0]))
                x, y, radius, wait = ahead[0]
                still = still + 1 if not moves[action].any() and math.dist(pose[:2], (x, y)) <= 0.22 else 0
                near = max(
                    _hull_distance(each, pose[0], pose[1], math.cos(pose[2]), math.sin(pose[2]), x, y)
                    for each in goal_hulls
                )
                if still > wait / (TICKS * 0.01) if wait else near <= radius - 0.003:
                    break
        else:
            merged = [[len(list(run)) * TICKS, *commands[a]] for a, run in itertools.groupby(actions)]
            if tricycle:
                found.append(track_front_wheel(level, scenario, planned))
            else:
                found.append(ReferenceDrive(tuple(DriveCommand(*each) for each in merged)))
    return found


def drive_time(
    level: GameLevel, scenario, simulation: Simulation, drive: ReferenceDrive, limit: float
) -> float:
    """The time of a drive that touches nothing [s]; inf where it does, or is not there before ``limit``."""
    simulation.reset()
    referee = RaceReferee(level, scenario)
    tick = 0
    for command in (*drive.commands, replace(drive.commands[-1], ticks=100)):
        apply(simulation, scenario, (command.speed, command.turn))
        for _ in range(command.ticks):
            simulation.step()
            referee.on_step(simulation)
            tick += 1
            if referee.is_over or referee.finish.collisions or tick * 0.01 > limit:
                finish = referee.finish
                return finish.seconds if finish.reached and not finish.collisions else math.inf
    return math.inf


def polish(level: GameLevel, drive: ReferenceDrive, seconds: float) -> ReferenceDrive:
    """Shortens a drive by moving the ends of its commands by single ticks, for ``seconds`` of wall clock."""
    scenario = level.find_scenario()
    simulation = Simulation(scenario.world, seed=OWN_SEED, has_subscribers=lambda topic: False)
    best = drive_time(level, scenario, simulation, drive, math.inf)
    random, end = np.random.default_rng(1), time.perf_counter() + seconds
    while time.perf_counter() < end:
        commands = list(drive.commands)
        first = int(random.integers(len(commands)))
        change = int(random.integers(1, 5)) * (1 if random.random() < 0.5 else -1)
        others = [(first, change)]
        if random.random() < 0.8:
            others.append((min(max(first + int(random.integers(-3, 4)), 0), len(commands) - 1), -change))
        for number, ticks in others:
            commands[number] = replace(commands[number], ticks=max(0, commands[number].ticks + ticks))
        changed = ReferenceDrive(tuple(each for each in commands if each.ticks))
        if not changed.commands:
            continue
        found = drive_time(level, scenario, simulation, changed, best)
        if found < best or (found == best and random.random() < 0.2):
            best, drive = found, changed
    return drive


def hand_drive(level: GameLevel) -> ReferenceDrive:
    """The keys that a hand with ordinary skill presses: what is found has to beat it."""
    pressed: list[tuple[float, float]] = []

    class Noted(OrdinaryDriver):
        def keys(self, pose):
            pressed.append(super().keys(pose))
            return pressed[-1]

    drive(level, OWN_SEED, lambda session: session.runner.participants.append(Noted(session, level)))
    runs = itertools.groupby(pressed)
    return ReferenceDrive(tuple(DriveCommand(len(list(run)), *keys) for keys, run in runs))


def search_pursuit(level: GameLevel, seconds: float) -> ReferenceDrive | None:
    """Searches the gains of a driver that follows a way, or a leader, where no lattice can be measured."""
    scenario = level.find_scenario()
    simulation = Simulation(scenario.world, seed=OWN_SEED, has_subscribers=lambda topic: False)
    random, end = np.random.default_rng(1), time.perf_counter() + seconds
    fields: dict[float, object] = {}
    walls = scenario.world.wall_segments
    best, found, tries = math.inf, None, 0
    while time.perf_counter() < end:
        tries += 1
        clearance = float(random.choice([0.13, 0.16, 0.2, 0.25, 0.32]))
        lookahead, gain, damping = (
            random.uniform(0.2, 0.9),
            random.uniform(1.0, 6.0),
            random.uniform(0.0, 1.5),
        )
        slow_angle, least = random.uniform(0.3, 1.5), random.uniform(0.0, 0.6)
        distance = random.uniform(0.3, 0.7)
        if not level.leader and clearance not in fields:
            fields[clearance] = compute_distance_field.__wrapped__(
                SimpleNamespace(walls=walls), scenario.case.target, clearance, 8.0
            )
        simulation.reset()
        referee = RaceReferee(level, scenario)
        commands: list[DriveCommand] = []
        before = middle(simulation, scenario)
        while not referee.is_over and not referee.finish.collisions and len(commands) * 0.05 < best:
            pose = middle(simulation, scenario)
            rate, before = wrap_angle(pose[2] - before[2]) / 0.05, pose
            if level.leader:
                leader = simulation.pose(level.leader)
                x, y, top = leader.x, leader.y, math.dist(leader[:2], pose[:2])
                top = max(-1.0, min(1.0, gain * (top - distance)))
            else:
                x, y = aim_point(fields[clearance], scenario.case.target, pose[0], pose[1], lookahead)
                top = 1.0
            error = wrap_angle(math.atan2(y - pose[1], x - pose[0]) - pose[2])
            speed = SPEED * top * max(least, 1.0 - abs(error) / slow_angle)
            turn = max(-TURN_RATE, min(TURN_RATE, gain * error - damping * rate))
            commands.append(DriveCommand(5, round(speed, 3), round(turn, 3)))
            apply(simulation, scenario, (commands[-1].speed, commands[-1].turn))
            for _ in range(5):
                simulation.step()
                referee.on_step(simulation)
        finish = referee.finish
        if finish.reached and not finish.collisions and finish.seconds < best:
            best, found = finish.seconds, ReferenceDrive(tuple(commands))
    print(f"  {tries} drivers tried, best {best:.2f} s")
    return found


def aim_point(field, target, x: float, y: float, lookahead: float) -> tuple[float, float]:
    """The point of the shortest way so many metres ahead."""
    rows, columns = field.values.shape
    column = min(max(round((x - field.origin[0]) / CELL), 0), columns - 1)
    row = min(max(round((y - field.origin[1]) / CELL), 0), rows - 1)
    distance = 0.0
    while distance < lookahead:
        window = field.values[max(0, row - 1) : row + 2, max(0, column - 1) : column + 2]
        r, c = np.unravel_index(int(window.argmin()), window.shape)
        r, c = int(r) + max(0, row - 1), int(c) + max(0, column - 1)
        if (r, c) == (row, column):
            return target
        distance += CELL * math.hypot(r - row, c - column)
        row, column = r, c
    return field.origin[0] + CELL * column, field.origin[1] + CELL * row


def main(names: list[str]) -> None:
    drives = dict(load_drives())
    for level in all_levels():
        if names and level.id not in names:
            continue
        begin = time.perf_counter()
        if level.goal.needs_leader or level.conditions.acceleration:
            found = search_pursuit(level, PURSUIT_S)
            candidates = [hand_drive(level), *([] if found is None else [found])]
        else:
            candidates = search_lattice(level)
        report = "nothing found"
        for found in candidates:
            finish, _ = drive_reference(level, found)
            report = f"{finish.seconds:.2f} s, reached {finish.reached}, bumps {finish.collisions}"
            if finish.reached and not finish.collisions:
                found = polish(level, found, POLISH_S)
                finish, _ = drive_reference(level, found)
                found = replace(found, seconds=round(finish.seconds, 3))
                report += f", polished {finish.seconds:.2f} s"
                before = drives.get(level.id)
                if before is None or drive_reference(level, before)[0].seconds > finish.seconds:
                    drives[level.id] = found
        print(f"{level.id}: {report} ({time.perf_counter() - begin:.0f} s)", flush=True)
        save_drives(drives)


def save_drives(drives: dict[str, ReferenceDrive]) -> None:
    """Writes the file of all reference drives, one line each."""
    rows = []
    for name, each in sorted(drives.items()):
        commands = [[each.ticks, round(each.speed, 4), round(each.turn, 4)] for each in each.commands]
        rows.append(f"  {json.dumps(name)}: {json.dumps({'seconds': each.seconds, 'commands': commands})}")
    drives_file().write_text("{\n" + ",\n".join(rows) + "\n}\n")


if __name__ == "__main__":
    main(sys.argv[1:])
