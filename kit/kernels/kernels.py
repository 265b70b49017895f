"""Compiled code: every formula once, as a scalar function; loops over arrays below, those over many worlds in
``world_kernels``.

Lengths in metres, angles in radians, counter-clockwise. Nothing here allocates more than a few rays' worth of scratch, and nothing
depends on the order in which worlds, rays or walls are taken: one world and many give the same bits.
"""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np

from kit.arrays import Float32Array, FloatArray, IntArray
from kit.kernels.arrays import LANES
from kit.kernels.arrays import BatchGeometry as BatchGeometry
from kit.kernels.arrays import Beams as Beams
from kit.kernels.arrays import MovingShapes as MovingShapes
from kit.kernels.arrays import ObstacleParts as ObstacleParts
from kit.kernels.arrays import ScanBuffers as ScanBuffers
from kit.kernels.arrays import Shapes as Shapes
from kit.kernels.arrays import StartTables as StartTables
from kit.kernels.arrays import VisibilityCells as VisibilityCells
from kit.kernels.arrays import WallBlocks as WallBlocks
from kit.kernels.compilation import compiled_for as compiled_for
from kit.kernels.compilation import jit, jit_borrowing, jit_inline

Float32: TypeAlias = np.float32
Uint64: TypeAlias = np.uint64
Uint32: TypeAlias = np.uint32
# An index that is not plainly a loop's own is made unsigned: else a negative one would have to be taken from the
# end, as in Python, and the loop would not vectorise.


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
def ray_segment_nearness(
    cos: Float32, sin: Float32, ax: Float32, ay: Float32, bx: Float32, by: Float32, scale: Float32
) -> Float32:
    """Returns 1 / distance from the origin to the segment a-b along the line ``(cos, sin)``; negative against its direction. 0, or nan,
    where it does not. ``scale``: 1 / cross(a, b).

    It crosses the segment where a and b lie on different sides of it: cross(ray, a) * cross(ray, b) <= 0.
    Two segments that share an end share that product's factor, so no ray slips between them. A line along
    the segment meets nothing (0 / 0), as in Box2D.
    """
    a = cos * ay - sin * ax
    b = cos * by - sin * bx
    nearness = (b - a) * scale
    return nearness if a * b <= 0 else Float32(0)


@jit
def ray_circle_nearness(
    cos: Float32, sin: Float32, x: Float32, y: Float32, radius: Float32, nearest: Float32
) -> Float32:
    """The greater of ``nearest`` and how near the ray meets the circle about ``(x, y)``. One that starts inside does
    not meet it."""
    along = cos * x + sin * y
    across = cos * y - sin * x
    nearness = Float32(1) / (along - np.sqrt(radius * radius - across * across))  # nan where it misses
    return nearness if nearness > nearest else nearest


# --- points, segments, convex polygons --------------------------------------------------------------------
# ``corners``: (k, 2), counter-clockwise.


@jit_borrowing
def point_segment_distance(x: float, y: float, ax: float, ay: float, bx: float, by: float) -> float:
    """Distance from a point to the segment a-b, which may be a point too."""
    dx, dy = bx - ax, by - ay
    length2 = dx * dx + dy * dy
    t = ((x - ax) * dx + (y - ay) * dy) / length2 if length2 > 0.0 else 0.0
    t = min(max(t, 0.0), 1.0)
    dx, dy = ax + t * dx - x, ay + t * dy - y
    return math.sqrt(dx * dx + dy * dy)  # hypot takes three times as long


@jit_borrowing
def point_in_polygon(x: float, y: float, corners: FloatArray) -> bool:
    """Returns whether the point lies inside a convex polygon or on its rim."""
    last = corners.shape[0] - 1
    for i in range(corners.shape[0]):
        j = i - 1 if i else last
        ex, ey = corners[i, 0] - corners[j, 0], corners[i, 1] - corners[j, 1]
        if ex * (y - corners[j, 1]) - ey * (x - corners[j, 0]) < 0.0:
            return False
    return True


@jit_borrowing
def point_polygon_distance(x: float, y: float, corners: FloatArray) -> float:
    """Distance from a point to a convex polygon; 0 inside."""
    if point_in_polygon(x, y, corners):
        return 0.0
    nearest = math.inf
    last = corners.shape[0] - 1
    for i in range(corners.shape[0]):
        j = i - 1 if i else last
        nearest = min(
            nearest, point_segment_distance(x, y, corners[j, 0], corners[j, 1], corners[i, 0], corners[i, 1])
        )
    return nearest


@jit_borrowing
def segment_intersects_polygon(ax: float, ay: float, bx: float, by: float, corners: FloatArray) -> bool:
    """Returns whether the segment a-b and a convex polygon have a point in common.

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
def mix_bits64(z: Uint64) -> Uint64:
    """64 bits, well mixed: the finaliser of splitmix64 (Steele, Lea and Flood 2014)."""
    z = (z ^ (z >> Uint64(30))) * Uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> Uint64(27))) * Uint64(0x94D049BB133111EB)
    return z ^ (z >> Uint64(31))


@jit
def random_bits(key: int, counter: int) -> Uint64:
    """64 bits that depend on ``(key, counter)`` alone: the order of draws does not matter."""
    golden = Uint64(0x9E3779B97F4A7C15)
    return mix_bits64(mix_bits64(Uint64(key) + golden) + Uint64(counter) * golden)


@jit
def uniform(key: int, counter: int) -> float:
    """Uniform in [0, 1), 53 bits."""
    return float(random_bits(key, counter) >> Uint64(11)) * (1.0 / 9007199254740992.0)


@jit
def normal_from_bits(four: Uint32 | Uint64) -> Float32:
    """Standard normal, of the sum of four 16-bit uniforms; never beyond 4.9.

    Bent to a normal one by a polynomial as Teichroew (1953) did with twelve: off by less than 0.007 up to 3.5. Without
    logarithm and cosine, so that a loop over rays vectorises.
    """
    u = Float32(np.int32(four)) * Float32(1.0 / 65536.0) - Float32(131070.0 / 65536.0)
    u2 = u * u
    bent = Float32(0.08163078) + u2 * (Float32(-0.02656002) + u2 * Float32(0.01351341))
    return u * (Float32(1.66182467) + u2 * bent)


@jit
def normal(key: int, counter: int) -> Float32:
    """Standard normal, from one draw."""
    bits, low = random_bits(key, counter), Uint64(0xFFFF)
    return normal_from_bits(
        (bits & low) + ((bits >> Uint64(16)) & low) + ((bits >> Uint64(32)) & low) + (bits >> Uint64(48))
    )


@jit
def mix_bits32(z: Uint32) -> Uint32:
    """32 bits, well mixed, in as many lanes as a processor has: a finaliser of murmur's kind (Wellons 2018)."""
    z = Uint32((z ^ (z >> Uint32(16))) * Uint32(0x21F0AAAD))
    z = Uint32((z ^ (z >> Uint32(15))) * Uint32(0xD35A2D97))
    return Uint32(z ^ (z >> Uint32(15)))


# --- lidar scans ------------------------------------------------------------------------------------------


SEGMENT_CHUNK = 64
"""Segments that are made ready at once."""


@jit_borrowing
def lines_through_disc(
    lines: Float32Array, x: Float32, y: Float32, radius: Float32, nearness: Float32Array
) -> tuple[int, int]:
    """The first and one past the last line on which a disc lies nearer than ``nearness``, in whole vectors; the second is
    0 if there is none.

    The disc is taken a little larger than it is, to make up for single precision.
    """
    count = np.int32(lines.shape[1])
    first, end = count, np.int32(0)
    radius += Float32(1e-5) * (Float32(1) + abs(x) + abs(y) + radius)
    for i in range(count):
        along = lines[0, i] * x + lines[1, i] * y
        across = lines[0, i] * y - lines[1, i] * x
        ahead = (along >= -radius) & ((along - radius) * nearness[0, i] < Float32(1))
        behind = (along <= radius) & ((along + radius) * nearness[1, i] < Float32(1))
        meets = (abs(across) <= radius) & (ahead | behind)
        line = np.int32(i)
        first = min(first, line if meets else count)
        end = max(end, line + np.int32(1) if meets else np.int32(0))
    return int(first) // LANES * LANES, (int(end) + LANES - 1) // LANES * LANES


@jit_borrowing
def load_segments(
    x: float, y: float, ends: FloatArray, first: int, end: int, local_segments: Float32Array
) -> int:
    """Fills ``local_segments`` (5, AIMED) with the segments ``ends[first:end]``, seen from ``(x, y)``, and their scales; how many
    those are, in whole fours: what is missing is met nowhere."""
    count = end - first
    for j in range(count):
        row = Uint64(first + j)
        local_segments[0, j], local_segments[1, j] = Float32(ends[row, 0] - x), Float32(ends[row, 1] - y)
        local_segments[2, j], local_segments[3, j] = Float32(ends[row, 2] - x), Float32(ends[row, 3] - y)
    for j in range(count):
        local_segments[4, j] = Float32(1) / (
            local_segments[0, j] * local_segments[3, j] - local_segments[1, j] * local_segments[2, j]
        )
    fours = (count + 3) // 4 * 4
    for j in range(count, fours):
        for k in range(5):
            local_segments[k, j] = Float32(0)
    return int(fours)


@jit_inline
def cast_segment_pair(
    lines: Float32Array,
    local_segments: Float32Array,
    j: int,
    nearness: Float32Array,
    new_nearness: Float32Array,
    line: int,
    last: int,
) -> None:
    """Fills ``new_nearness`` for the lines from ``line`` to before ``last``: as near as ``nearness`` and the segments j and j + 1.

    Not in place: compilers would store under a mask, which is very slow on some processors.
    """
    ax, ay, bx, by, one_scale = (
        local_segments[0, j],
        local_segments[1, j],
        local_segments[2, j],
        local_segments[3, j],
        local_segments[4, j],
    )
    k = j + 1
    cx, cy, dx, dy, other_scale = (
        local_segments[0, k],
        local_segments[1, k],
        local_segments[2, k],
        local_segments[3, k],
        local_segments[4, k],
    )
    for i in range(Uint64(line), Uint64(last)):
        one = ray_segment_nearness(lines[0, i], lines[1, i], ax, ay, bx, by, one_scale)
        other = ray_segment_nearness(lines[0, i], lines[1, i], cx, cy, dx, dy, other_scale)
        ahead, behind = nearness[0, i], nearness[1, i]
        ahead = one if one > ahead else ahead
        behind = one if one < behind else behind
        new_nearness[0, i] = other if other > ahead else ahead
        new_nearness[1, i] = other if other < behind else behind


@jit_borrowing
def cast_segments(
    x: float, y: float, buffers: ScanBuffers, ends: FloatArray, first: int, end: int, line: int, last: int
) -> None:
    """Brings the lines from ``line`` to before ``last`` as near as the nearest of ``ends[first:end]``."""
    nearness, scratch, local_segments = buffers.nearness, buffers.scratch, buffers.local_segments
    for start in range(first, end, SEGMENT_CHUNK):
        fours = load_segments(x, y, ends, start, min(start + SEGMENT_CHUNK, end), local_segments)
        for j in range(0, fours, 4):
            cast_segment_pair(buffers.lines, local_segments, j, nearness, scratch, line, last)
            cast_segment_pair(buffers.lines, local_segments, j + 2, scratch, nearness, line, last)


@jit_borrowing
def cast_walls(x: float, y: float, buffers: ScanBuffers, walls: WallBlocks, first: int, end: int) -> None:
    """Brings every line as near as the nearest wall of the blocks from ``first`` to before ``end``."""
    for k in range(first, end):
        line, last = 0, buffers.lines.shape[1]
        if end - first > 1:
            disc_x, disc_y = Float32(walls.discs[k, 0] - x), Float32(walls.discs[k, 1] - y)
            line, last = lines_through_disc(
                buffers.lines, disc_x, disc_y, Float32(walls.discs[k, 2]), buffers.nearness
            )
        if line < last:
            cast_segments(x, y, buffers, walls.ends, walls.starts[k], walls.starts[k + 1], line, last)


@jit_borrowing
def cast_shapes(
    x: float, y: float, buffers: ScanBuffers, shapes: Shapes, bits: int, line: int, last: int
) -> None:
    """Brings the lines from ``line`` to before ``last`` as near as the nearest shape on one of the layers ``bits``, but
    for those around the sensor."""
    cos, sin, nearness = buffers.lines[0], buffers.lines[1], buffers.nearness
    for k in range(shapes.circles.shape[0]):
        if shapes.circle_bits[k] & bits == 0:
            continue
        cx, cy = Float32(shapes.circles[k, 0] - x), Float32(shapes.circles[k, 1] - y)
        radius = Float32(shapes.circles[k, 2])
        for i in range(Uint64(line), Uint64(last)):
            nearness[0, i] = ray_circle_nearness(cos[i], sin[i], cx, cy, radius, nearness[0, i])
            nearness[1, i] = -ray_circle_nearness(-cos[i], -sin[i], cx, cy, radius, -nearness[1, i])
    for k in range(shapes.polygon_bits.shape[0]):
        corners = shapes.corners[shapes.starts[k] : shapes.starts[k + 1]]
        if shapes.polygon_bits[k] & bits == 0 or point_in_polygon(x, y, corners):
            continue
        before = corners.shape[0] - 1
        for j in range(corners.shape[0]):
            buffers.rim[j, 0], buffers.rim[j, 1] = corners[before, 0], corners[before, 1]
            buffers.rim[j, 2], buffers.rim[j, 3] = corners[j, 0], corners[j, 1]
            before = j
        cast_segments(x, y, buffers, buffers.rim, 0, corners.shape[0], line, last)


@jit_borrowing
def cast_obstacles(
    x: float, y: float, buffers: ScanBuffers, parts: ObstacleParts, map_index: int, bodies: FloatArray
) -> None:
    """Brings every line as near as the nearest obstacle that lidars see. ``bodies`` (k, 3): where their bodies are."""
    cos, sin, nearness = buffers.lines[0], buffers.lines[1], buffers.nearness
    for p in range(parts.map_parts[map_index], parts.map_parts[map_index + 1]):
        if parts.bits[p] & 2 == 0:
            continue
        body = bodies[parts.body[p]]
        dx, dy = Float32(body[0] - x), Float32(body[1] - y)
        line, last = lines_through_disc(buffers.lines, dx, dy, Float32(parts.reach[p]), nearness)
        turn_cos, turn_sin = math.cos(body[2]), math.sin(body[2])
        count, first = parts.starts[p + 1] - parts.starts[p], parts.starts[p]
        if count == 0:
            cx, cy = parts.circles[p, 0], parts.circles[p, 1]
            cx, cy = body[0] + turn_cos * cx - turn_sin * cy, body[1] + turn_sin * cx + turn_cos * cy
            to_x, to_y, radius = Float32(cx - x), Float32(cy - y), Float32(parts.circles[p, 2])
            for i in range(Uint64(line), Uint64(last)):
                nearness[0, i] = ray_circle_nearness(cos[i], sin[i], to_x, to_y, radius, nearness[0, i])
                nearness[1, i] = -ray_circle_nearness(-cos[i], -sin[i], to_x, to_y, radius, -nearness[1, i])
            continue
        rim = buffers.rim
        for j in range(count):
            cx, cy = parts.corners[first + j, 0], parts.corners[first + j, 1]
            px, py = body[0] + turn_cos * cx - turn_sin * cy, body[1] + turn_sin * cx + turn_cos * cy
            rim[j, 0], rim[j, 1] = px, py
            rim[(j + count - 1) % count, 2], rim[(j + count - 1) % count, 3] = px, py
        cast_segments(x, y, buffers, rim, 0, count, line, last)


@jit
def most_corners(starts: IntArray) -> int:
    """Returns how many corners the largest polygon has."""
    most = 0
    for k in range(starts.shape[0] - 1):
        most = max(most, starts[k + 1] - starts[k])
    return most


@jit
def allocate_scan_buffers(lines: Float32Array, corners: int) -> ScanBuffers:
    """Allocates the arrays for scans along the lines (2, lines), of polygons of at most this many corners."""
    local_segments, rim = np.empty((5, SEGMENT_CHUNK), dtype=np.float32), np.empty((corners, 4))
    return ScanBuffers(np.empty_like(lines), np.empty_like(lines), np.empty_like(lines), local_segments, rim)


@jit_inline
def rotate_lines(theta: float, lines: Float32Array, turned: Float32Array) -> None:
    """Fills ``turned`` with the lines' directions in the world, for a sensor that points to ``theta``."""
    cos, sin = Float32(math.cos(theta)), Float32(math.sin(theta))
    for i in range(lines.shape[1]):
        turned[0, i] = cos * lines[0, i] - sin * lines[1, i]
        turned[1, i] = sin * lines[0, i] + cos * lines[1, i]


@jit_inline
def scatter_to_rays(found: Float32Array, runs: IntArray, ranges: Float32Array) -> None:
    """Fills ``ranges`` (rays,) with what was found along and against the lines (2, lines)."""
    for k in range(runs.shape[0]):
        ray, side, line = runs[k, 0], runs[k, 2], runs[k, 3]
        for i in range(runs[k, 1] - ray):
            ranges[Uint64(ray + i)] = found[side, Uint64(line + i)]


@jit_borrowing
def scan_with(
    buffers: ScanBuffers,
    pose: tuple[float, float, float],
    beams: Beams,
    max_range: float,
    walls: WallBlocks,
    shapes: Shapes,
    bits: int,
    ranges: Float32Array,
) -> None:
    """Fills ``ranges`` (rays,) with the distance along each ray to the nearest wall or shape; NaN beyond reach.

    Exact: positions are subtracted in double precision, the rest is single precision (errors below a micrometre
    per metre). ``walls`` are all seen; ``shapes`` where their layer bits meet ``bits``; a shape around the
    sensor is not seen. Lines are the inner loop, for there vector instructions take 4 to 16 at once.
    ``buffers``: scratch arrays from ``allocate_scan_buffers``.
    """
    (x, y, theta), least = pose, Float32(1.0 / max_range)
    nearness, scratch, last = buffers.nearness, buffers.scratch, beams.lines.shape[1]
    rotate_lines(theta, beams.lines, buffers.lines)
    nearness[0], nearness[1] = least, -least
    cast_walls(x, y, buffers, walls, 0, walls.discs.shape[0])
    cast_shapes(x, y, buffers, shapes, bits, 0, last)
    for i in range(last):
        scratch[0, i] = Float32(1) / nearness[0, i] if nearness[0, i] > least else Float32(np.nan)
        scratch[1, i] = Float32(-1) / nearness[1, i] if nearness[1, i] < -least else Float32(np.nan)
    scatter_to_rays(scratch, beams.ray_runs, ranges)


@jit_borrowing
def add_noise(ranges: Float32Array, deviation: float, key: int, number: int) -> None:
    """Adds normal noise: scan ``number`` of ``key``. The noise of a ray depends on its index in the scan. NaN stays NaN."""
    bits, low, half = random_bits(key, number), Uint32(0xFFFF), Uint32(16)
    one, other = Uint32(bits), Uint32(bits >> Uint64(32))
    for i in range(ranges.shape[0]):
        a, b = mix_bits32(one), mix_bits32(other)
        ranges[i] += Float32(deviation) * normal_from_bits(
            Uint32(a & low) + Uint32(a >> half) + Uint32(b & low) + Uint32(b >> half)
        )
        one, other = Uint32(one + Uint32(0x9E3779B9)), Uint32(other + Uint32(0x85EBCA6B))


@jit_borrowing
def drop_rays(ranges: Float32Array, share: float, missing: float, key: int, number: int) -> None:
    """Sets about this share of the ranges to ``missing``: others in every scan ``number`` of ``key``."""
    bits, limit = random_bits(~key, number), Uint32(share * 4294967295.0)
    one = Uint32(bits)
    for i in range(ranges.shape[0]):
        ranges[i] = Float32(missing) if mix_bits32(one) < limit else ranges[i]
        one = Uint32(one + Uint32(0x9E3779B9))


@jit_borrowing
def place_shapes(
    poses: FloatArray,
    circle_body: IntArray,
    corner_body: IntArray,
    circles: FloatArray,
    corners: FloatArray,
    world: Shapes,
) -> None:
    """Fills ``world`` with circles and corners that are given in the frames of their bodies.

    ``poses``: (bodies, 3) ``x y theta``; ``circle_body``, ``corner_body``: which body a circle or corner is on.
    """
    for k in range(circles.shape[0]):
        x, y, theta = poses[circle_body[k]]
        cos, sin = math.cos(theta), math.sin(theta)
        world.circles[k, 0] = x + cos * circles[k, 0] - sin * circles[k, 1]
        world.circles[k, 1] = y + sin * circles[k, 0] + cos * circles[k, 1]
        world.circles[k, 2] = circles[k, 2]
    body, cos, sin = -1, 1.0, 0.0
    for k in range(corners.shape[0]):
        x, y, theta = poses[corner_body[k]]
        if corner_body[k] != body:
            body, cos, sin = corner_body[k], math.cos(theta), math.sin(theta)
        world.corners[k, 0] = x + cos * corners[k, 0] - sin * corners[k, 1]
        world.corners[k, 1] = y + sin * corners[k, 0] + cos * corners[k, 1]


@jit_borrowing
def scan_moved(
    buffers: ScanBuffers,
    pose: tuple[float, float, float],
    beams: Beams,
    max_range: float,
    walls: WallBlocks,
    shapes: MovingShapes,
    has_moved: bool,
    bits: int,
    noise: tuple[float, int, int],
    ranges: Float32Array,
) -> None:
    """As ``scan_with``, of shapes that are first carried where their bodies are if one ``has_moved``, and with the ``noise``
    of ``add_noise``: deviation, key and number. One call instead of three."""
    if has_moved:
        place_shapes(
            shapes.poses,
            shapes.circle_body,
            shapes.corner_body,
            shapes.circles,
            shapes.corners,
            shapes.world,
        )
    scan_with(buffers, pose, beams, max_range, walls, shapes.world, bits, ranges)
    if noise[0] > 0.0:
        add_noise(ranges, noise[0], noise[1], noise[2])


def compile_kernels() -> None:
    """Compiles, or loads from disk, what the interactive world calls: seconds the first time, then moments."""
    ranges, bits, corners = np.ones(2, dtype=np.float32), np.zeros(0, dtype=np.int64), np.zeros((3, 2))
    walls = WallBlocks(np.zeros((0, 4)), np.zeros(2, dtype=np.int64), np.zeros((1, 3)))
    shapes = Shapes(np.zeros((0, 3)), bits, np.zeros((0, 2)), np.zeros(1, dtype=np.int64), bits)
    ones = np.ones(2, dtype=np.float32)
    beams = Beams(ones, ones, np.zeros((2, LANES), dtype=np.float32), np.zeros((0, 4), dtype=np.int64))
    buffers = allocate_scan_buffers(beams.lines, most_corners(shapes.starts))
    moving = MovingShapes(np.zeros((1, 3)), bits, bits, shapes.circles, shapes.corners, shapes)
    scan_moved(buffers, (0.0, 0.0, 0.0), beams, 2.0, walls, moving, True, 1, (0.0, 1, 0), ranges)
    twist_step(0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.1)
    mean_velocity(0.0, 1.0, 0.0, 0.0, 0.1)
    point_polygon_distance(2.0, 0.0, corners)
    normal(1, 0)
    uniform(1, 0)
