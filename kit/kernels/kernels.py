"""All compiled code of the project: every formula once, as a scalar function; loops over arrays below.

It is one file because numba's disk cache does not notice an edit in another one. Lengths in metres, angles
in radians, counter-clockwise. Nothing here allocates more than a few rays' worth of scratch, and nothing
depends on the order in which worlds, rays or walls are taken: one world and many give the same bits.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from typing import Any, TypeAlias, TypeVar, cast

import numba
import numpy as np

from kit.kernels.arrays import Beams as Beams
from kit.kernels.arrays import Flags, Floats, Integers, Singles
from kit.kernels.arrays import Fleet as Fleet
from kit.kernels.arrays import Gaze as Gaze
from kit.kernels.arrays import Segments as Segments
from kit.kernels.arrays import Shapes as Shapes
from kit.kernels.arrays import Views as Views

Function = TypeVar("Function", bound=Callable[..., Any])
Single: TypeAlias = np.float32
Bits: TypeAlias = np.uint64
Half: TypeAlias = np.uint32
# An index that is not plainly a loop's own is made unsigned: else a negative one would have to be taken from the
# end, as in Python, and the loop would not vectorise.


def jit(function: Function) -> Function:
    """Compiles on first use and remembers it on disk; where nothing may be written, compiles at each start.

    A division by zero gives inf or nan, as in numpy: Python's check would keep loops from vectorising.
    ``fastmath`` stays off, for it gives other bits on other processors.
    """
    compiled = numba.njit(error_model="numpy")(function)
    with suppress(RuntimeError):  # neither beside this file nor in the user's cache
        compiled.enable_caching()
    return cast(Function, compiled)


def inlined(function: Function) -> Function:
    """Becomes a part of its callers: handing over arrays costs more than a short loop."""
    return cast(Function, numba.njit(error_model="numpy", inline="always")(function))


# --- motion -----------------------------------------------------------------------------------------------


@jit
def mean_velocity(
    theta: float, forward: float, lateral: float, turn: float, dt: float
) -> tuple[float, float]:
    """The chord of an arc, as a velocity [m/s] in the world: where a constant twist leads in ``dt``, over ``dt``.

    ``theta``: heading at the start; ``forward``, ``lateral`` [m/s], ``turn`` [rad/s]: the twist, in the body's
    own frame. A body that keeps it runs along a circle; the chord points along the heading at half time and
    is shorter than the arc by sin(h) / h, h = turn * dt / 2.
    """
    half = 0.5 * turn * dt
    shrink = math.sin(half) / half if half != 0.0 else 1.0
    cos, sin = shrink * math.cos(theta + half), shrink * math.sin(theta + half)
    return cos * forward - sin * lateral, sin * forward + cos * lateral


@jit
def twist_step(
    x: float, y: float, theta: float, forward: float, lateral: float, turn: float, dt: float
) -> tuple[float, float, float]:
    """The pose after ``dt`` of a constant twist: exact, so that ten short steps lead where a long one does."""
    vx, vy = mean_velocity(theta, forward, lateral, turn, dt)
    return x + vx * dt, y + vy * dt, theta + turn * dt


# --- rays: how near is the nearest thing so far -----------------------------------------------------------
# In single precision, relative to the sensor. Branch-free, so that the loops over lines vectorise. Nearness is
# 1 / distance: a ray divides once at the end, instead of once for each segment. What lies on a line behind the
# sensor has a nearness below 0: so one line serves two rays.


@jit
def ray_segment(
    cos: Single, sin: Single, ax: Single, ay: Single, bx: Single, by: Single, scale: Single
) -> Single:
    """How near to the origin the line ``(cos, sin)`` meets the segment a-b; below 0 against its direction. 0, or nan,
    where it does not. ``scale``: 1 / cross(a, b).

    It crosses the segment where a and b lie on different sides of it: cross(ray, a) * cross(ray, b) <= 0.
    Two segments that share an end share that product's factor, so no ray slips between them. A line along
    the segment meets nothing (0 / 0), as in Box2D.
    """
    a = cos * ay - sin * ax
    b = cos * by - sin * bx
    nearness = (b - a) * scale
    return nearness if a * b <= 0 else Single(0)


@jit
def ray_circle(cos: Single, sin: Single, x: Single, y: Single, radius: Single, near: Single) -> Single:
    """The greater of ``near`` and how near the ray meets the circle about ``(x, y)``. One that starts inside does
    not meet it."""
    along = cos * x + sin * y
    across = cos * y - sin * x
    nearness = Single(1) / (along - np.sqrt(radius * radius - across * across))  # nan where it misses
    return nearness if nearness > near else near


# --- points, segments, convex polygons --------------------------------------------------------------------
# ``corners``: (k, 2), counter-clockwise.


@jit
def point_segment(x: float, y: float, ax: float, ay: float, bx: float, by: float) -> float:
    """Distance from a point to the segment a-b, which may be a point too."""
    dx, dy = bx - ax, by - ay
    length2 = dx * dx + dy * dy
    t = ((x - ax) * dx + (y - ay) * dy) / length2 if length2 > 0.0 else 0.0
    t = min(max(t, 0.0), 1.0)
    dx, dy = ax + t * dx - x, ay + t * dy - y
    return math.sqrt(dx * dx + dy * dy)  # hypot takes three times as long


@jit
def point_in_polygon(x: float, y: float, corners: Floats) -> bool:
    """Whether the point lies inside a convex polygon or on its rim."""
    last = corners.shape[0] - 1
    for i in range(corners.shape[0]):
        j = i - 1 if i else last
        ex, ey = corners[i, 0] - corners[j, 0], corners[i, 1] - corners[j, 1]
        if ex * (y - corners[j, 1]) - ey * (x - corners[j, 0]) < 0.0:
            return False
    return True


@jit
def point_polygon(x: float, y: float, corners: Floats) -> float:
    """Distance from a point to a convex polygon; 0 inside."""
    if point_in_polygon(x, y, corners):
        return 0.0
    nearest = math.inf
    last = corners.shape[0] - 1
    for i in range(corners.shape[0]):
        j = i - 1 if i else last
        nearest = min(
            nearest, point_segment(x, y, corners[j, 0], corners[j, 1], corners[i, 0], corners[i, 1])
        )
    return nearest


@jit
def segment_meets_polygon(ax: float, ay: float, bx: float, by: float, corners: Floats) -> bool:
    """Whether the segment a-b and a convex polygon have a point in common.

    Cyrus and Beck (1978): each edge cuts off the part of the segment that lies outside of it.
    """
    enters, leaves = 0.0, 1.0
    last = corners.shape[0] - 1
    for i in range(corners.shape[0]):
        j = i - 1 if i else last
        ex, ey = corners[i, 0] - corners[j, 0], corners[i, 1] - corners[j, 1]
        inside = ex * (ay - corners[j, 1]) - ey * (ax - corners[j, 0])
        slope = ex * (by - ay) - ey * (bx - ax)
        if slope > 0.0:
            enters = max(enters, -inside / slope)
        elif slope < 0.0:
            leaves = min(leaves, -inside / slope)
        elif inside < 0.0:
            return False
        if enters > leaves:
            return False
    return True


# --- noise: a value for every (key, counter) --------------------------------------------------------------


@jit
def scrambled(z: Bits) -> Bits:
    """64 bits, well mixed: the finaliser of splitmix64 (Steele, Lea and Flood 2014)."""
    z = (z ^ (z >> Bits(30))) * Bits(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> Bits(27))) * Bits(0x94D049BB133111EB)
    return z ^ (z >> Bits(31))


@jit
def random_bits(key: int, counter: int) -> Bits:
    """64 bits that depend on ``(key, counter)`` alone: whoever draws first, draws the same."""
    golden = Bits(0x9E3779B97F4A7C15)
    return scrambled(scrambled(Bits(key) + golden) + Bits(counter) * golden)


@jit
def uniform(key: int, counter: int) -> float:
    """Uniform in [0, 1), 53 bits."""
    return float(random_bits(key, counter) >> Bits(11)) * (1.0 / 9007199254740992.0)


@jit
def bell(four: Half | Bits) -> Single:
    """Standard normal, of the sum of four 16-bit uniforms; never beyond 4.9.

    Bent to a normal one by a polynomial as Teichroew (1953) did with twelve: off by less than 0.007 up to 3.5. Without
    logarithm and cosine, so that a loop over rays vectorises.
    """
    u = Single(np.int32(four)) * Single(1.0 / 65536.0) - Single(131070.0 / 65536.0)
    u2 = u * u
    bent = Single(0.08163078) + u2 * (Single(-0.02656002) + u2 * Single(0.01351341))
    return u * (Single(1.66182467) + u2 * bent)


@jit
def normal(key: int, counter: int) -> Single:
    """Standard normal, from one draw."""
    bits, low = random_bits(key, counter), Bits(0xFFFF)
    return bell((bits & low) + ((bits >> Bits(16)) & low) + ((bits >> Bits(32)) & low) + (bits >> Bits(48)))


@jit
def mixed(z: Half) -> Half:
    """32 bits, well mixed, in as many lanes as a processor has: a finaliser of murmur's kind (Wellons 2018)."""
    z = Half((z ^ (z >> Half(16))) * Half(0x21F0AAAD))
    z = Half((z ^ (z >> Half(15))) * Half(0xD35A2D97))
    return Half(z ^ (z >> Half(15)))


# --- what a lidar sees ------------------------------------------------------------------------------------


LANES = 8
"""Lines are looked at in whole vectors of so many."""
AIMED = 64
"""Segments that are made ready at once."""


@jit
def lines_meeting(lines: Singles, x: Single, y: Single, radius: Single, near: Singles) -> tuple[int, int]:
    """The first and one past the last line on which a disc lies nearer than ``near``, in whole vectors; the second is
    0 if there is none.

    The disc is taken a little larger than it is, to make up for single precision.
    """
    count = np.int32(lines.shape[1])
    first, end = count, np.int32(0)
    radius += Single(1e-5) * (Single(1) + abs(x) + abs(y) + radius)
    for i in range(count):
        along = lines[0, i] * x + lines[1, i] * y
        across = lines[0, i] * y - lines[1, i] * x
        ahead = (along >= -radius) & ((along - radius) * near[0, i] < Single(1))
        behind = (along <= radius) & ((along + radius) * near[1, i] < Single(1))
        meets = (abs(across) <= radius) & (ahead | behind)
        line = np.int32(i)
        first = min(first, line if meets else count)
        end = max(end, line + np.int32(1) if meets else np.int32(0))
    return int(first) // LANES * LANES, (int(end) + LANES - 1) // LANES * LANES


@jit
def aim(x: float, y: float, ends: Floats, first: int, end: int, aimed: Singles) -> int:
    """Fills ``aimed`` (5, AIMED) with the segments ``ends[first:end]``, seen from ``(x, y)``, and their scales; how many
    those are, in whole fours: what is missing is met nowhere."""
    count = end - first
    for j in range(count):
        row = Bits(first + j)
        aimed[0, j], aimed[1, j] = Single(ends[row, 0] - x), Single(ends[row, 1] - y)
        aimed[2, j], aimed[3, j] = Single(ends[row, 2] - x), Single(ends[row, 3] - y)
    for j in range(count):
        aimed[4, j] = Single(1) / (aimed[0, j] * aimed[3, j] - aimed[1, j] * aimed[2, j])
    fours = (count + 3) // 4 * 4
    for j in range(count, fours):
        for k in range(5):
            aimed[k, j] = Single(0)
    return int(fours)


@inlined
def meet_pair(
    lines: Singles, aimed: Singles, j: int, near: Singles, nearer: Singles, line: int, last: int
) -> None:
    """Fills ``nearer`` for the lines from ``line`` to before ``last``: as near as ``near`` and the segments j and j + 1.

    Not in place: compilers would store under a mask, which is very slow on some processors.
    """
    ax, ay, bx, by, one_scale = aimed[0, j], aimed[1, j], aimed[2, j], aimed[3, j], aimed[4, j]
    k = j + 1
    cx, cy, dx, dy, other_scale = aimed[0, k], aimed[1, k], aimed[2, k], aimed[3, k], aimed[4, k]
    for i in range(Bits(line), Bits(last)):
        one = ray_segment(lines[0, i], lines[1, i], ax, ay, bx, by, one_scale)
        other = ray_segment(lines[0, i], lines[1, i], cx, cy, dx, dy, other_scale)
        ahead, behind = near[0, i], near[1, i]
        ahead = one if one > ahead else ahead
        behind = one if one < behind else behind
        nearer[0, i] = other if other > ahead else ahead
        nearer[1, i] = other if other < behind else behind


@jit
def meet_segments(
    x: float, y: float, gaze: Gaze, ends: Floats, first: int, end: int, line: int, last: int
) -> None:
    """Brings the lines from ``line`` to before ``last`` as near as the nearest of ``ends[first:end]``."""
    near, room, aimed = gaze.near, gaze.room, gaze.aimed
    for start in range(first, end, AIMED):
        fours = aim(x, y, ends, start, min(start + AIMED, end), aimed)
        for j in range(0, fours, 4):
            meet_pair(gaze.lines, aimed, j, near, room, line, last)
            meet_pair(gaze.lines, aimed, j + 2, room, near, line, last)


@jit
def meet_walls(x: float, y: float, gaze: Gaze, walls: Segments, first: int, end: int) -> None:
    """Brings every line as near as the nearest wall of the blocks from ``first`` to before ``end``."""
    for k in range(first, end):
        line, last = 0, gaze.lines.shape[1]
        if end - first > 1:
            disc_x, disc_y = Single(walls.discs[k, 0] - x), Single(walls.discs[k, 1] - y)
            line, last = lines_meeting(gaze.lines, disc_x, disc_y, Single(walls.discs[k, 2]), gaze.near)
        if line < last:
            meet_segments(x, y, gaze, walls.ends, walls.starts[k], walls.starts[k + 1], line, last)


@jit
def meet_shapes(x: float, y: float, gaze: Gaze, shapes: Shapes, bits: int, line: int, last: int) -> None:
    """Brings the lines from ``line`` to before ``last`` as near as the nearest shape on one of the layers ``bits``, but
    for those around the sensor."""
    cos, sin, near = gaze.lines[0], gaze.lines[1], gaze.near
    for k in range(shapes.circles.shape[0]):
        if shapes.circle_bits[k] & bits == 0:
            continue
        cx, cy = Single(shapes.circles[k, 0] - x), Single(shapes.circles[k, 1] - y)
        radius = Single(shapes.circles[k, 2])
        for i in range(Bits(line), Bits(last)):
            near[0, i] = ray_circle(cos[i], sin[i], cx, cy, radius, near[0, i])
            near[1, i] = -ray_circle(-cos[i], -sin[i], cx, cy, radius, -near[1, i])
    for k in range(shapes.polygon_bits.shape[0]):
        corners = shapes.corners[shapes.starts[k] : shapes.starts[k + 1]]
        if shapes.polygon_bits[k] & bits == 0 or point_in_polygon(x, y, corners):
            continue
        rim = np.empty((corners.shape[0], 4))
        for j in range(corners.shape[0]):
            rim[j, :2], rim[j, 2:] = corners[j - 1], corners[j]
        meet_segments(x, y, gaze, rim, 0, corners.shape[0], line, last)


@jit
def new_gaze(lines: Singles) -> Gaze:
    """Room for scans along so many lines."""
    aimed = np.empty((5, AIMED), dtype=np.float32)
    return Gaze(np.empty_like(lines), np.empty_like(lines), np.empty_like(lines), aimed)


@inlined
def turn_lines(theta: float, lines: Singles, turned: Singles) -> None:
    """Fills ``turned`` with the lines' directions in the world, for a sensor that points to ``theta``."""
    cos, sin = Single(math.cos(theta)), Single(math.sin(theta))
    for i in range(lines.shape[1]):
        turned[0, i] = cos * lines[0, i] - sin * lines[1, i]
        turned[1, i] = sin * lines[0, i] + cos * lines[1, i]


@inlined
def spread(found: Singles, runs: Integers, ranges: Singles) -> None:
    """Fills ``ranges`` (rays,) with what was found along and against the lines (2, lines)."""
    for k in range(runs.shape[0]):
        ray, side, line = runs[k, 0], runs[k, 2], runs[k, 3]
        for i in range(runs[k, 1] - ray):
            ranges[Bits(ray + i)] = found[side, Bits(line + i)]


@jit
def scan(
    pose: tuple[float, float, float],
    beams: Beams,
    reach: float,
    walls: Segments,
    shapes: Shapes,
    bits: int,
    ranges: Singles,
) -> None:
    """Fills ``ranges`` (rays,) with the distance along each ray to the nearest wall or shape; NaN beyond reach.

    Exact: positions are subtracted in double precision, the rest is single precision (errors below a micrometre
    per metre). ``walls`` are all seen; ``shapes`` where their layer bits meet ``bits``; a shape around the
    sensor is not seen. Lines are the inner loop, for there vector instructions take 4 to 16 at once.
    """
    x, y, theta = pose
    gaze, least = new_gaze(beams.lines), Single(1.0 / reach)
    near, room, last = gaze.near, gaze.room, beams.lines.shape[1]
    turn_lines(theta, beams.lines, gaze.lines)
    near[0], near[1] = least, -least
    meet_walls(x, y, gaze, walls, 0, walls.discs.shape[0])
    meet_shapes(x, y, gaze, shapes, bits, 0, last)
    for i in range(last):
        room[0, i] = Single(1) / near[0, i] if near[0, i] > least else Single(np.nan)
        room[1, i] = Single(-1) / near[1, i] if near[1, i] < -least else Single(np.nan)
    spread(room, beams.runs, ranges)


@jit
def add_noise(ranges: Singles, deviation: float, key: int, number: int) -> None:
    """Adds normal noise: scan ``number`` of ``key``. A ray's depends on its place in the scan. NaN stays NaN."""
    bits, low, half = random_bits(key, number), Half(0xFFFF), Half(16)
    one, other = Half(bits), Half(bits >> Bits(32))
    for i in range(ranges.shape[0]):
        a, b = mixed(one), mixed(other)
        ranges[i] += Single(deviation) * bell(
            Half(a & low) + Half(a >> half) + Half(b & low) + Half(b >> half)
        )
        one, other = Half(one + Half(0x9E3779B9)), Half(other + Half(0x85EBCA6B))


@jit
def place_shapes(
    poses: Floats, circle_body: Integers, corner_body: Integers, local: Shapes, world: Shapes
) -> None:
    """Fills ``world`` with the shapes of ``local``, each carried by its body's pose.

    ``poses``: (bodies, 3) ``x y theta``; ``circle_body``, ``corner_body``: which body a circle or corner is on.
    """
    for k in range(local.circles.shape[0]):
        x, y, theta = poses[circle_body[k]]
        cos, sin = math.cos(theta), math.sin(theta)
        world.circles[k, 0] = x + cos * local.circles[k, 0] - sin * local.circles[k, 1]
        world.circles[k, 1] = y + sin * local.circles[k, 0] + cos * local.circles[k, 1]
        world.circles[k, 2] = local.circles[k, 2]
    body, cos, sin = -1, 1.0, 0.0
    for k in range(local.corners.shape[0]):
        x, y, theta = poses[corner_body[k]]
        if corner_body[k] != body:
            body, cos, sin = corner_body[k], math.cos(theta), math.sin(theta)
        world.corners[k, 0] = x + cos * local.corners[k, 0] - sin * local.corners[k, 1]
        world.corners[k, 1] = y + sin * local.corners[k, 0] + cos * local.corners[k, 1]


# --- many worlds at once -----------------------------------------------------------------------------------
# Arrays of all worlds, then loops over them that call what stands above. Every world by itself: nothing a
# world does depends on which others there are. Shapes: n worlds, r robots each, alike but for their poses.


@jit
def placed_hulls(fleet: Fleet, bits: Integers) -> Shapes:
    """Room for the hulls of one world, where its robots are, on the layers ``bits``."""
    own = fleet.hulls
    return Shapes(own.circles, own.circle_bits, np.empty_like(own.corners), own.starts, bits)


@inlined
def nearest_wall(
    pose: Floats, hulls: Shapes, bit: int, radius: float, walls: Floats, first: int, end: int
) -> tuple[float, bool]:
    """A distance from a robot's origin within which there is no wall, and whether one of ``walls[first:end]`` meets its hull.

    The hull: the polygons on the layer ``bit``, in the robot's frame, within ``radius`` of its origin. A wall counts
    as near as the upright rectangle around it: to be sure, that is enough.
    """
    x, y, cos, sin, nearest = pose[0], pose[1], math.cos(pose[2]), math.sin(pose[2]), math.inf
    for row in range(first, end):
        j = Bits(row)
        ax, ay, bx, by = walls[j, 0] - x, walls[j, 1] - y, walls[j, 2] - x, walls[j, 3] - y
        dx, dy = max(min(ax, bx), -max(ax, bx), 0.0), max(min(ay, by), -max(ay, by), 0.0)
        nearest = min(nearest, dx * dx + dy * dy)
        if dx * dx + dy * dy > radius * radius:
            continue
        ax, ay, bx, by = cos * ax + sin * ay, cos * ay - sin * ax, cos * bx + sin * by, cos * by - sin * bx
        for k in range(hulls.polygon_bits.shape[0]):
            corners = hulls.corners[hulls.starts[k] : hulls.starts[k + 1]]
            if hulls.polygon_bits[k] == bit and segment_meets_polygon(ax, ay, bx, by, corners):
                return 0.0, True
    return math.sqrt(nearest), False


@jit
def hulls_meet(hulls: Shapes) -> bool:
    """Whether convex polygons of different robots meet: an edge of one and the other, or one lies inside."""
    for i in range(hulls.polygon_bits.shape[0]):
        one = hulls.corners[hulls.starts[i] : hulls.starts[i + 1]]
        for j in range(hulls.polygon_bits.shape[0]):
            other = hulls.corners[hulls.starts[j] : hulls.starts[j + 1]]
            if hulls.polygon_bits[i] != hulls.polygon_bits[j]:
                if point_in_polygon(other[0, 0], other[0, 1], one):
                    return True
                for k in range(one.shape[0]):
                    if segment_meets_polygon(one[k - 1, 0], one[k - 1, 1], one[k, 0], one[k, 1], other):
                        return True
    return False


@inlined
def stop_robots(
    fleet: Fleet, number: int, before: Floats, room: Shapes, poses: Floats, free: Floats, hit: Flags
) -> None:
    """Puts the robots of one world, on map ``number``, back where they meet something; they are hit.

    ``before``: where they were. ``room``: for the hulls where they are now.
    """
    if poses.shape[0] > 1:
        place_shapes(poses, fleet.robot_of[:0], fleet.robot_of, fleet.hulls, room)
    together = poses.shape[0] > 1 and hulls_meet(room)
    for k in range(poses.shape[0]):
        meets = together
        if free[k] <= fleet.radius:
            walls = fleet.walls
            first, end = walls.starts[fleet.blocks[number]], walls.starts[fleet.blocks[number + 1]]
            hulls, bit = fleet.hulls, 1 << k
            free[k], meets = nearest_wall(poses[k], hulls, bit, fleet.radius, walls.ends, first, end)
        if meets or together:
            poses[k], free[k], hit[k] = before[k], 0.0, True


@jit
def drive_worlds(
    fleet: Fleet, maps: Integers, twists: Floats, dt: float, poses: Floats, free: Floats, hit: Flags
) -> None:
    """Every robot moves for ``dt``. Where it would meet something it stays, and is hit: (n, r), set, never cleared.

    ``maps`` (n); ``twists`` (n, r, 2) forward [m/s] and turn [rad/s]; ``poses`` (n, r, 3). ``free`` (n, r): no wall
    is nearer, for sure; 0 where unknown. It spares most moves the search for walls.
    """
    room, before = placed_hulls(fleet, fleet.hulls.polygon_bits), np.empty_like(poses[0])
    for i in range(poses.shape[0]):
        near = False
        for k in range(poses.shape[1]):
            x, y, theta, forward = poses[i, k, 0], poses[i, k, 1], poses[i, k, 2], twists[i, k, 0]
            before[k, 0], before[k, 1], before[k, 2] = x, y, theta
            x, y, theta = twist_step(x, y, theta, forward, 0.0, twists[i, k, 1], dt)
            poses[i, k, 0], poses[i, k, 1], poses[i, k, 2] = x, y, theta
            free[i, k] -= abs(forward) * dt
            near |= free[i, k] <= fleet.radius
            near |= k > 0 and math.hypot(x - poses[i, 0, 0], y - poses[i, 0, 1]) <= 2.0 * fleet.radius
        if near:
            stop_robots(fleet, maps[i], before, room, poses[i], free[i], hit[i])


@jit
def arrivals(
    fleet: Fleet, poses: Floats, targets: Floats, radius: float, by_hull: bool, inside: Flags
) -> None:
    """Fills ``inside`` (n, r): who is within ``radius`` of ``targets`` (n, 2), by the hull or by its origin."""
    for i in range(poses.shape[0]):
        for k in range(poses.shape[1]):
            x, y = targets[i, 0] - poses[i, k, 0], targets[i, 1] - poses[i, k, 1]
            away = math.hypot(x, y)
            if by_hull and radius < away <= radius + fleet.radius:
                cos, sin = math.cos(poses[i, k, 2]), math.sin(poses[i, k, 2])
                for j in range(fleet.hulls.polygon_bits.shape[0]):
                    if fleet.hulls.polygon_bits[j] == 1 << k:
                        corners = fleet.hulls.corners[fleet.hulls.starts[j] : fleet.hulls.starts[j + 1]]
                        away = min(away, point_polygon(cos * x + sin * y, cos * y - sin * x, corners))
            inside[i, k] = away <= radius


@inlined
def view_from(views: Views, number: int, x: float, y: float) -> int:
    """Which view of map ``number`` holds all that can be seen from ``(x, y)``; -1 if there is none."""
    column = math.floor((x - views.corners[number, 0]) / views.cell)
    row = math.floor((y - views.corners[number, 1]) / views.cell)
    columns, rows = views.grids[number, 1], views.grids[number, 2]
    if 0 <= column < columns and 0 <= row < rows:
        return int(views.of_cell[views.grids[number, 0] + row * columns + column])
    return -1


@inlined
def sense(far: float, single: Integers, sectors: Integers, ranges: Singles, sensed: Singles) -> None:
    """Limits ``ranges`` (rays,) to 0..``far``, and fills ``sensed`` (numbers,) with some rays and minima.

    ``single`` (s,): rays given as they are, first. ``sectors`` (m, 3): number from 0, first ray and end of a stretch.
    """
    nothing, most = Single(0), Single(far)
    for i in range(ranges.shape[0]):
        limited = ranges[i] if ranges[i] > nothing else nothing
        ranges[i] = limited if limited < most else most
    sensed[:] = most
    for m in range(sectors.shape[0]):
        number, least = single.shape[0] + sectors[m, 0], most
        for i in range(Bits(sectors[m, 1]), Bits(sectors[m, 2])):
            least = ranges[i] if ranges[i] < least else least
        sensed[number] = least if least < sensed[number] else sensed[number]
    for j in range(single.shape[0]):
        sensed[j] = ranges[single[j]]


@jit
def look_worlds(
    fleet: Fleet,
    maps: Integers,
    poses: Floats,
    keys: Integers,
    drawn: Integers,
    far: float,
    single: Integers,
    sectors: Integers,
    ranges: Singles,
    sensed: Singles,
) -> None:
    """Scans of all robots, as ``scan`` and ``add_noise`` make them and ``sense`` limits them, (n, r, rays or more), and
    what they sense, (n, r, numbers).

    The noise of world i is that of the scans ``drawn[i]`` and following of ``keys[i]``. ``single`` (r, s).
    """
    robots, rays, fixed, views = ranges.shape[1], fleet.beams.cos.shape[0], fleet.beams.lines, fleet.views
    gaze, last = new_gaze(fixed), fixed.shape[1]
    near, room = gaze.near, gaze.room
    hulls, least = placed_hulls(fleet, fleet.sight), Single(1.0 / fleet.reach)
    for i in range(ranges.shape[0]):
        if robots > 1:
            place_shapes(poses[i], fleet.robot_of[:0], fleet.robot_of, fleet.hulls, hulls)
        for k in range(robots):
            x, y = poses[i, k, 0], poses[i, k, 1]
            turn_lines(poses[i, k, 2], fixed, gaze.lines)
            near[0], near[1] = least, -least
            view = view_from(views, maps[i], x, y)
            if view >= 0:
                first, end = views.starts[view], views.starts[view + 1]
                meet_segments(x, y, gaze, views.ends, first, end, 0, last)
            else:
                first, end = fleet.blocks[maps[i]], fleet.blocks[maps[i] + 1]
                meet_walls(x, y, gaze, fleet.walls, first, end)
            if robots > 1:
                dx, dy = Single(poses[i, 1 - k, 0] - x), Single(poses[i, 1 - k, 1] - y)
                line, stop = lines_meeting(gaze.lines, dx, dy, Single(fleet.radius), near)
                meet_shapes(x, y, gaze, hulls, ~(1 << k), line, stop)
            for j in range(last):
                room[0, j], room[1, j] = Single(1) / near[0, j], Single(-1) / near[1, j]
            spread(room, fleet.beams.runs, ranges[i, k])
            ranges[i, k, rays:] = Single(fleet.reach)
            add_noise(ranges[i, k], fleet.noise, keys[i], drawn[i] + k)
            sense(far, single[k], sectors, ranges[i, k], sensed[i, k])


@jit
def look_up(
    tables: Singles, corners: Floats, cell: float, cases: Integers, poses: Floats, found: Floats
) -> None:
    """Fills ``found`` (n, r) from a table each case has, between the four nearest cells.

    ``tables`` (cases, rows, columns): values at the middles of square cells; ``corners`` (cases, 2): the first middle.
    """
    for i in range(poses.shape[0]):
        table = tables[cases[i]]
        for k in range(poses.shape[1]):
            u = min(max((poses[i, k, 0] - corners[cases[i], 0]) / cell, 0.0), table.shape[1] - 1.001)
            v = min(max((poses[i, k, 1] - corners[cases[i], 1]) / cell, 0.0), table.shape[0] - 1.001)
            column, row = int(u), int(v)
            u, v = u - column, v - row
            below = (1.0 - u) * table[row, column] + u * table[row, column + 1]
            above = (1.0 - u) * table[row + 1, column] + u * table[row + 1, column + 1]
            found[i, k] = (1.0 - v) * below + v * above


@jit
def uniforms(keys: Integers, first: Integers, drawn: Floats) -> None:
    """Fills ``drawn`` (n, m): row i with number ``first[i]`` and following of ``keys[i]``."""
    for i in range(drawn.shape[0]):
        for j in range(drawn.shape[1]):
            drawn[i, j] = uniform(keys[i], first[i] + j)


@jit
def add_forces(x: Floats, y: Floats, charges: Floats, starts: Integers, fx: Floats, fy: Floats) -> None:
    """Adds to ``fx``, ``fy`` (n) the forces of charges at the points ``x``, ``y`` (n); see ``kit.fields.charges``.

    ``charges`` (m, 9) ``ax ay ux uy length low high intensity rank``: stretches from a along the unit vector u, that
    act where the foot of the perpendicular lies from ``low`` to ``high`` along them. Of those from ``starts[c]``
    on, before the next start, the one of the least rank + r^2 acts, with intensity / r^2; none at r = 0.
    """
    n = x.shape[0]
    least, away_x, away_y, pull = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    for c in range(starts.shape[0] - 1):
        least[:], away_x[:], away_y[:], pull[:] = math.inf, 0.0, 0.0, 0.0
        for ax, ay, ux, uy, length, low, high, intensity, rank in charges[starts[c] : starts[c + 1]]:
            for i in range(n):
                dx, dy = ax - x[i], ay - y[i]
                along = -(dx * ux + dy * uy)
                share = min(max(along, 0.0), length)
                dx, dy = dx + share * ux, dy + share * uy
                key = rank + dx * dx + dy * dy
                acts = (along >= low) & (along <= high) & (key < least[i])
                least[i] = key if acts else least[i]
                away_x[i] = dx if acts else away_x[i]
                away_y[i] = dy if acts else away_y[i]
                pull[i] = intensity if acts else pull[i]
        for i in range(n):
            square = away_x[i] * away_x[i] + away_y[i] * away_y[i]
            cube = square * math.sqrt(square)
            share = pull[i] / cube if cube > 0.0 else 0.0
            fx[i] += share * away_x[i]
            fy[i] += share * away_y[i]


def warm() -> None:
    """Compiles, or loads from disk, what the interactive world calls: seconds the first time, then moments."""
    ranges, bits, corners = np.ones(2, dtype=np.float32), np.zeros(0, dtype=np.int64), np.zeros((3, 2))
    walls = Segments(np.zeros((0, 4)), np.zeros(2, dtype=np.int64), np.zeros((1, 3)))
    shapes = Shapes(np.zeros((0, 3)), bits, np.zeros((0, 2)), np.zeros(1, dtype=np.int64), bits)
    ones = np.ones(2, dtype=np.float32)
    beams = Beams(ones, ones, np.zeros((2, LANES), dtype=np.float32), np.zeros((0, 4), dtype=np.int64))
    scan((0.0, 0.0, 0.0), beams, 2.0, walls, shapes, 1, ranges)
    add_noise(ranges, 0.0, 1, 0)
    place_shapes(np.zeros((1, 3)), bits, bits, shapes, shapes)
    twist_step(0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.1)
    mean_velocity(0.0, 1.0, 0.0, 0.0, 0.1)
    point_polygon(2.0, 0.0, corners)
    normal(1, 0)
    uniform(1, 0)
