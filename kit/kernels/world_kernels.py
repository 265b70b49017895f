"""Compiled loops over many worlds at once: motion, collisions, scans, arrivals and starts of a batch.

Arrays of all worlds, then loops over them that call what stands in ``kit.kernels.kernels``. Every world by itself: nothing
a world does depends on which others there are. Shapes: n worlds, r robots each, alike but for their poses.
"""

from __future__ import annotations

import math

import numpy as np

from kit.arrays import BoolArray, Float32Array, FloatArray, IntArray
from kit.kernels.compilation import jit, jit_borrowing, jit_inline, jit_without_gil
from kit.kernels.kernels import (
    BatchGeometry,
    Float32,
    ObstacleParts,
    ScanBuffers,
    Shapes,
    StartTables,
    Uint64,
    VisibilityCells,
    add_noise,
    cast_obstacles,
    cast_segments,
    cast_shapes,
    cast_walls,
    drop_rays,
    lines_through_disc,
    place_shapes,
    point_in_polygon,
    point_polygon_distance,
    rotate_lines,
    scatter_to_rays,
    segment_intersects_polygon,
    twist_step,
    uniform,
)


@jit
def allocate_hulls(geometry: BatchGeometry, bits: IntArray) -> Shapes:
    """Allocates the hulls of one world at its robots' poses, on the layers ``bits``."""
    own = geometry.hulls
    return Shapes(own.circles, own.circle_bits, np.empty_like(own.corners), own.starts, bits)


@jit_inline
def square_distances(
    x: float, y: float, boxes: FloatArray, first: int, end: int, squares: FloatArray
) -> float:
    """Fills ``squares`` with those of the distances from a point to the boxes from ``first`` to before ``end``; returns the least.

    ``boxes`` (4, n): ``x1 y1 x2 y2``; the count is one of whole vectors.
    """
    for offset in range(end - first):
        i, j = Uint64(first + offset), Uint64(offset)
        left, right, below, above = boxes[0, i] - x, x - boxes[2, i], boxes[1, i] - y, y - boxes[3, i]
        dx, dy = left if left > right else right, below if below > above else above
        dx, dy = dx if dx > 0.0 else 0.0, dy if dy > 0.0 else 0.0
        squares[j] = dx * dx + dy * dy
    one, two, three, four = math.inf, math.inf, math.inf, math.inf  # one after the other would take turns
    for row in range(0, end - first, 4):
        j = Uint64(row)
        one = squares[j] if squares[j] < one else one
        two = squares[j + Uint64(1)] if squares[j + Uint64(1)] < two else two
        three = squares[j + Uint64(2)] if squares[j + Uint64(2)] < three else three
        four = squares[j + Uint64(3)] if squares[j + Uint64(3)] < four else four
    return min(min(one, two), min(three, four))


@jit_inline
def wall_clearance(
    pose: FloatArray, geometry: BatchGeometry, bit: int, map_index: int, squares: FloatArray
) -> tuple[float, bool]:
    """A distance from a robot's origin within which there is no wall, and whether one of the map's walls meets its hull:
    the polygons on the layer ``bit``.

    A wall counts as near as the upright rectangle around it: to be sure, that is enough. ``squares``: scratch space.
    """
    x, y, hulls, walls = pose[0], pose[1], geometry.hulls, geometry.walls
    first, end = geometry.box_starts[map_index], geometry.box_starts[map_index + 1]
    nearest, limit = square_distances(x, y, geometry.wall_boxes, first, end, squares), geometry.hull_radius
    if nearest > limit * limit:
        return math.sqrt(nearest), False
    cos, sin, row = math.cos(pose[2]), math.sin(pose[2]), walls.starts[geometry.map_blocks[map_index]]
    for i in range(end - first):
        if squares[i] > limit * limit:
            continue
        j = Uint64(row + i)
        ax, ay, bx, by = (
            walls.ends[j, 0] - x,
            walls.ends[j, 1] - y,
            walls.ends[j, 2] - x,
            walls.ends[j, 3] - y,
        )
        ax, ay, bx, by = cos * ax + sin * ay, cos * ay - sin * ax, cos * bx + sin * by, cos * by - sin * bx
        for k in range(hulls.polygon_bits.shape[0]):
            corners = hulls.corners[hulls.starts[k] : hulls.starts[k + 1]]
            if hulls.polygon_bits[k] == bit and segment_intersects_polygon(ax, ay, bx, by, corners):
                return 0.0, True
    return math.sqrt(nearest), False


@jit_inline
def place_corners(corners: FloatArray, x: float, y: float, theta: float, placed: FloatArray) -> None:
    """Fills ``placed`` (k, 2) with the corners as a body at the pose ``x``, ``y``, ``theta`` carries them."""
    cos, sin = math.cos(theta), math.sin(theta)
    for j in range(corners.shape[0]):
        placed[j, 0] = x + cos * corners[j, 0] - sin * corners[j, 1]
        placed[j, 1] = y + sin * corners[j, 0] + cos * corners[j, 1]


@jit_borrowing
def edge_separates(one: FloatArray, other: FloatArray) -> bool:
    """Returns whether all of ``other`` lies outside of one edge of the convex polygon ``one``, by more than rounding."""
    last = one.shape[0] - 1
    for i in range(one.shape[0]):
        j = i - 1 if i else last
        ex, ey = one[i, 0] - one[j, 0], one[i, 1] - one[j, 1]
        most = -math.inf
        for k in range(other.shape[0]):
            most = max(most, ex * (other[k, 1] - one[j, 1]) - ey * (other[k, 0] - one[j, 0]))
        if most < -1e-9:
            return True
    return False


@jit_borrowing
def polygons_meet(one: FloatArray, other: FloatArray) -> bool:
    """Returns whether an edge of one convex polygon meets the other one, or one lies inside."""
    if point_in_polygon(other[0, 0], other[0, 1], one):
        return True
    for k in range(one.shape[0]):
        if segment_intersects_polygon(one[k - 1, 0], one[k - 1, 1], one[k, 0], one[k, 1], other):
            return True
    return False


@jit_borrowing
def hulls_overlap(hulls: Shapes, bits: int) -> bool:
    """Returns whether convex polygons of different robots meet, one of them on the layers ``bits``."""
    for i in range(hulls.polygon_bits.shape[0]):
        one = hulls.corners[hulls.starts[i] : hulls.starts[i + 1]]
        for j in range(hulls.polygon_bits.shape[0]):
            counts = (hulls.polygon_bits[i] | hulls.polygon_bits[j]) & bits != 0
            other = hulls.corners[hulls.starts[j] : hulls.starts[j + 1]]
            if not counts or hulls.polygon_bits[i] == hulls.polygon_bits[j] or edge_separates(one, other):
                continue
            if polygons_meet(one, other):
                return True
    return False


@jit_borrowing
def hull_meets_obstacles(
    scratch: FloatArray,
    geometry: BatchGeometry,
    parts: ObstacleParts,
    map_index: int,
    pose: FloatArray,
    bodies: FloatArray,
    bit: int,
) -> bool:
    """Returns whether the hull on the layer ``bit``, at ``pose``, meets an obstacle that robots touch.

    ``bodies`` (k, 3): where the obstacles' bodies are. ``scratch`` (corners, 2): for the obstacle that has most.
    """
    hulls = geometry.hulls
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    for p in range(parts.map_parts[map_index], parts.map_parts[map_index + 1]):
        body = bodies[parts.body[p]]
        dx, dy = body[0] - pose[0], body[1] - pose[1]
        if parts.bits[p] & 1 == 0 or math.hypot(dx, dy) > parts.reach[p] + geometry.hull_radius:
            continue
        # The obstacle in the robot's frame.
        x, y, turn = cos * dx + sin * dy, cos * dy - sin * dx, body[2] - pose[2]
        turn_cos, turn_sin = math.cos(turn), math.sin(turn)
        own = parts.corners[parts.starts[p] : parts.starts[p + 1]]
        corners = scratch[: own.shape[0]]
        place_corners(own, x, y, turn, corners)
        cx, cy, radius = parts.circles[p, 0], parts.circles[p, 1], parts.circles[p, 2]
        cx, cy = x + turn_cos * cx - turn_sin * cy, y + turn_sin * cx + turn_cos * cy
        for i in range(hulls.polygon_bits.shape[0]):
            if hulls.polygon_bits[i] != bit:
                continue
            hull = hulls.corners[hulls.starts[i] : hulls.starts[i + 1]]
            if corners.shape[0] == 0:
                if point_polygon_distance(cx, cy, hull) <= radius:
                    return True
                continue
            if polygons_meet(corners, hull):
                return True
    return False


@jit_inline
def place_hulls(geometry: BatchGeometry, poses: FloatArray, placed_hulls: Shapes) -> None:
    """Puts the hulls of the robots, which are polygons, at their ``poses`` (robots, 3)."""
    owner, hulls = geometry.corner_robot, geometry.hulls
    place_shapes(poses, owner[:0], owner, hulls.circles, hulls.corners, placed_hulls)


@jit_inline
def stop_colliding_robots(
    geometry: BatchGeometry,
    map_index: int,
    before: FloatArray,
    placed_hulls: Shapes,
    squares: FloatArray,
    poses: FloatArray,
    clearance: FloatArray,
    collided: BoolArray,
) -> None:
    """Puts the robots of one world, on map ``map_index``, back where they meet something; they are hit.

    ``before``: where they were. ``placed_hulls``: for the hulls where they are now; ``squares``: scratch space for walls.
    """
    if poses.shape[0] > 1:
        place_hulls(geometry, poses, placed_hulls)
    overlapping = poses.shape[0] > 1 and hulls_overlap(placed_hulls, -1)
    for k in range(poses.shape[0]):
        overlapping_here = overlapping and (poses.shape[0] == 2 or hulls_overlap(placed_hulls, 1 << k))
        meets = overlapping_here
        if clearance[k] <= geometry.hull_radius:
            clearance[k], meets = wall_clearance(poses[k], geometry, 1 << k, map_index, squares)
        if meets or overlapping_here:
            for axis in range(3):
                poses[k, axis] = before[k, axis]
            clearance[k], collided[k] = 0.0, True


@jit_without_gil
def step_worlds(
    geometry: BatchGeometry,
    maps: IntArray,
    twists: FloatArray,
    durations: FloatArray,
    poses: FloatArray,
    clearance: FloatArray,
    collided: BoolArray,
) -> None:
    """Every robot of world i moves for ``durations[i]`` s. Where it would meet something it stays, and is hit: (n, r), set, never cleared.

    ``maps`` (n); ``twists`` (n, r, 2) forward [m/s] and turn [rad/s]; ``poses`` (n, r, 3). ``clearance`` (n, r): no wall
    is nearer, for sure; 0 where unknown. It spares most moves the search for walls.
    """
    placed_hulls, before = allocate_hulls(geometry, geometry.hulls.polygon_bits), np.empty_like(poses[0])
    squares = np.empty(geometry.wall_boxes.shape[1])
    step_worlds_with(
        placed_hulls, before, squares, geometry, maps, twists, durations, poses, clearance, collided
    )


@jit_borrowing
def step_worlds_with(
    placed_hulls: Shapes,
    before: FloatArray,
    squares: FloatArray,
    geometry: BatchGeometry,
    maps: IntArray,
    twists: FloatArray,
    durations: FloatArray,
    poses: FloatArray,
    clearance: FloatArray,
    collided: BoolArray,
) -> None:
    """As ``step_worlds``, with scratch arrays from the caller: hulls, poses, and one number for each wall."""
    for i in range(poses.shape[0]):
        may_collide, dt = False, durations[i]
        for k in range(poses.shape[1]):
            x, y, theta, forward = poses[i, k, 0], poses[i, k, 1], poses[i, k, 2], twists[i, k, 0]
            before[k, 0], before[k, 1], before[k, 2] = x, y, theta
            turn = twists[i, k, 1]
            lateral = turn * geometry.axle
            x, y, theta = twist_step(x, y, theta, forward, lateral, turn, dt)
            poses[i, k, 0], poses[i, k, 1], poses[i, k, 2] = x, y, theta
            clearance[i, k] -= (abs(forward) + abs(lateral)) * dt
            may_collide |= clearance[i, k] <= geometry.hull_radius
            for j in range(k):
                away = math.hypot(x - poses[i, j, 0], y - poses[i, j, 1])
                may_collide |= away <= 2.0 * geometry.hull_radius
        if may_collide:
            stop_colliding_robots(
                geometry, maps[i], before, placed_hulls, squares, poses[i], clearance[i], collided[i]
            )


@jit_borrowing
def stop_at_obstacles(
    scratch: FloatArray,
    geometry: BatchGeometry,
    parts: ObstacleParts,
    maps: IntArray,
    bodies: FloatArray,
    before: FloatArray,
    poses: FloatArray,
    clearance: FloatArray,
    collided: BoolArray,
) -> None:
    """Puts robots back to ``before`` (n, r, 3) where they meet an obstacle; they are hit: (n, r), set, never cleared.

    ``bodies`` (n, k, 3): where the obstacles' bodies are by now. ``clearance`` (n, r) as for ``step_worlds``. ``scratch``
    (corners, 2): for the obstacle that has most.
    """
    for i in range(poses.shape[0]):
        for k in range(poses.shape[1]):
            if hull_meets_obstacles(scratch, geometry, parts, maps[i], poses[i, k], bodies[i], 1 << k):
                for axis in range(3):
                    poses[i, k, axis] = before[i, k, axis]
                clearance[i, k], collided[i, k] = 0.0, True


@jit_without_gil
def find_arrivals(
    geometry: BatchGeometry,
    poses: FloatArray,
    targets: FloatArray,
    radius: float,
    by_hull: bool,
    inside: BoolArray,
) -> None:
    """Fills ``inside`` (n, r): which robots are within ``radius`` of ``targets`` (n, 2), by the hull or by the origin."""
    for i in range(poses.shape[0]):
        for k in range(poses.shape[1]):
            x, y = targets[i, 0] - poses[i, k, 0], targets[i, 1] - poses[i, k, 1]
            away = math.hypot(x, y)
            if by_hull and radius < away <= radius + geometry.hull_radius:
                cos, sin = math.cos(poses[i, k, 2]), math.sin(poses[i, k, 2])
                for j in range(geometry.hulls.polygon_bits.shape[0]):
                    if geometry.hulls.polygon_bits[j] == 1 << k:
                        corners = geometry.hulls.corners[
                            geometry.hulls.starts[j] : geometry.hulls.starts[j + 1]
                        ]
                        away = min(
                            away, point_polygon_distance(cos * x + sin * y, cos * y - sin * x, corners)
                        )
            inside[i, k] = away <= radius


@jit_inline
def find_visibility_cell(visibility: VisibilityCells, number: int, x: float, y: float) -> int:
    """Returns the index of the view of map ``number`` for the point ``(x, y)``; -1 if there is none."""
    column = math.floor((x - visibility.map_corners[number, 0]) / visibility.cell_size)
    row = math.floor((y - visibility.map_corners[number, 1]) / visibility.cell_size)
    columns, rows = visibility.map_grids[number, 1], visibility.map_grids[number, 2]
    if 0 <= column < columns and 0 <= row < rows:
        return int(visibility.view_of_cell[visibility.map_grids[number, 0] + row * columns + column])
    return -1


@jit_inline
def reduce_ranges(
    max_sensed: float,
    scale: float,
    single_rays: IntArray,
    sectors: IntArray,
    ranges: Float32Array,
    readings: Float32Array,
) -> None:
    """Limits ``ranges`` (rays,) to 0..``max_sensed``, and fills ``readings`` with some rays and minima, times ``scale``.

    ``single_rays`` (s,): rays given as they are, first. ``sectors`` (m, 3): number from 0, first ray and end of a stretch.
    What follows these numbers in ``readings`` is left as it is.
    """
    zero, limit, factor = Float32(0), Float32(max_sensed), Float32(scale)
    for i in range(ranges.shape[0]):
        limited = ranges[i] if ranges[i] > zero else zero
        ranges[i] = limited if limited < limit else limit
    for m in range(sectors.shape[0]):
        readings[single_rays.shape[0] + sectors[m, 0]] = limit * factor
    for m in range(sectors.shape[0]):
        number, least = single_rays.shape[0] + sectors[m, 0], limit
        for i in range(Uint64(sectors[m, 1]), Uint64(sectors[m, 2])):
            least = ranges[i] if ranges[i] < least else least
        least = least * factor
        readings[number] = least if least < readings[number] else readings[number]
    for j in range(single_rays.shape[0]):
        readings[j] = ranges[single_rays[j]] * factor


@jit_borrowing
def scan_worlds(
    buffers: ScanBuffers,
    hulls: Shapes,
    geometry: BatchGeometry,
    maps: IntArray,
    poses: FloatArray,
    keys: IntArray,
    scan_numbers: IntArray,
    noise_std: FloatArray,
    dropped: FloatArray,
    parts: ObstacleParts,
    bodies: FloatArray,
    max_sensed: float,
    scale: float,
    single_rays: IntArray,
    sectors: IntArray,
    ranges: Float32Array,
    readings: Float32Array,
) -> None:
    """Scans of all robots, as ``scan_with`` and ``add_noise`` make them and ``sense`` limits them, (n, r, rays or more), and
    what they sense, (n, r, numbers).

    The noise of world i, of the standard deviation ``noise_std[i]`` [m], is that of the scans ``scan_numbers[i]`` and
    following of ``keys[i]``; ``dropped[i]`` of its rays read nothing. ``bodies`` (n, k, 3): where the bodies of
    the obstacles ``parts`` are; none where k is 0. ``single_rays`` (r, s). ``buffers`` and ``hulls`` are scratch arrays.
    """
    robots, rays, fixed = ranges.shape[1], geometry.beams.cos.shape[0], geometry.beams.lines
    visibility, nearness, scratch, last = (
        geometry.visibility,
        buffers.nearness,
        buffers.scratch,
        fixed.shape[1],
    )
    least = Float32(1.0 / geometry.max_range)
    for i in range(ranges.shape[0]):
        if robots > 1:
            place_hulls(geometry, poses[i], hulls)
        for k in range(robots):
            x, y = poses[i, k, 0], poses[i, k, 1]
            rotate_lines(poses[i, k, 2], fixed, buffers.lines)
            nearness[0], nearness[1] = least, -least
            view = find_visibility_cell(visibility, maps[i], x, y)
            if view >= 0:
                first, end = visibility.starts[view], visibility.starts[view + 1]
                cast_segments(x, y, buffers, visibility.ends, first, end, 0, last)
            else:
                first, end = geometry.map_blocks[maps[i]], geometry.map_blocks[maps[i] + 1]
                cast_walls(x, y, buffers, geometry.walls, first, end)
            for other in range(robots):
                if other != k:
                    dx, dy = Float32(poses[i, other, 0] - x), Float32(poses[i, other, 1] - y)
                    line, stop = lines_through_disc(
                        buffers.lines, dx, dy, Float32(geometry.hull_radius), nearness
                    )
                    cast_shapes(x, y, buffers, hulls, 1 << other, line, stop)
            if bodies.shape[1]:
                cast_obstacles(x, y, buffers, parts, maps[i], bodies[i])
            for j in range(last):
                scratch[0, j], scratch[1, j] = Float32(1) / nearness[0, j], Float32(-1) / nearness[1, j]
            scatter_to_rays(scratch, geometry.beams.ray_runs, ranges[i, k])
            for j in range(geometry.own_ranges.shape[0]):
                ranges[i, k, j] = min(ranges[i, k, j], geometry.own_ranges[j])
            ranges[i, k, rays:] = Float32(geometry.max_range)
            add_noise(ranges[i, k], noise_std[i], keys[i], scan_numbers[i] + k)
            if dropped[i] > 0.0:
                drop_rays(ranges[i, k], dropped[i], geometry.max_range, keys[i], scan_numbers[i] + k)
            reduce_ranges(max_sensed, scale, single_rays[k], sectors, ranges[i, k], readings[i, k])


@jit_without_gil
def carry_lidars(lidar: FloatArray, poses: FloatArray, carried: FloatArray) -> None:
    """Fills ``carried`` (n, r, 3) with the poses of lidars that robots at ``poses`` carry at the pose ``lidar`` (3) of their own."""
    for i in range(poses.shape[0]):
        for k in range(poses.shape[1]):
            cos, sin = math.cos(poses[i, k, 2]), math.sin(poses[i, k, 2])
            carried[i, k, 0] = poses[i, k, 0] + cos * lidar[0] - sin * lidar[1]
            carried[i, k, 1] = poses[i, k, 1] + sin * lidar[0] + cos * lidar[1]
            carried[i, k, 2] = poses[i, k, 2] + lidar[2]


SHARED_DRAWS = 5
"""A start takes this many random numbers for all robots together, and three more for each of them; after these come
those that choose among places."""


@jit
def draw_starts(
    tables: StartTables,
    cases: IntArray,
    keys: IntArray,
    first: IntArray,
    poses: FloatArray,
    targets: FloatArray,
    rows: IntArray,
    phases: FloatArray,
) -> None:
    """Fills ``poses`` (m, robots, 3), ``targets`` (m, 2), their numbers ``rows`` (m) and ``phases`` (m), 0 to 1, for episodes of
    ``cases`` (m). Episode i takes number ``first[i]`` and following of ``keys[i]``."""
    robots = poses.shape[1]
    for i in range(cases.shape[0]):
        case, key, own = cases[i], keys[i], first[i] + SHARED_DRAWS
        choices, is_area = own + 3 * robots, tables.is_area[cases[i]]
        turned = math.pi * (2.0 * uniform(key, first[i] + 2) - 1.0) * tables.any_heading[case]
        for k in range(robots):
            share = uniform(key, choices + 3 + (k if is_area else 0))
            place = tables.starts[tables.start_first[case] + int(share * tables.start_count[case])]
            x, y, theta = place[k, 0], place[k, 1], place[k, 2]
            dx = 2.0 * uniform(key, own + 3 * k) - 1.0
            dy = 2.0 * uniform(key, own + 3 * k + 1) - 1.0
            turn = 2.0 * uniform(key, own + 3 * k + 2) - 1.0
            if is_area:
                low, high = tables.headings[case, 0], tables.headings[case, 1]
                x, y = x + 0.5 * tables.cell_size * dx, y + 0.5 * tables.cell_size * dy
                theta = 0.5 * (low + high) + 0.5 * (high - low) * turn
            x += (2.0 * uniform(key, first[i]) - 1.0) * tables.start_shift[case, 0]
            y += (2.0 * uniform(key, first[i] + 1) - 1.0) * tables.start_shift[case, 1]
            if not is_area:
                x, y = x + dx * tables.noise[0], y + dy * tables.noise[1]
                theta += turn * tables.noise[2]
            poses[i, k, 0], poses[i, k, 1], poses[i, k, 2] = x, y, theta + turned
        row = tables.target_first[case] + int(uniform(key, choices) * tables.target_choices[case])
        for axis in range(2):
            shift = (2.0 * uniform(key, first[i] + 3 + axis) - 1.0) * tables.target_shift[case, axis]
            targets[i, axis] = tables.targets[row, axis] + shift
        rows[i], phases[i] = row, uniform(key, choices + 1)


@jit
def fill_uniform(keys: IntArray, first: IntArray, drawn: FloatArray) -> None:
    """Fills ``drawn`` (n, m): row i with number ``first[i]`` and following of ``keys[i]``."""
    for i in range(drawn.shape[0]):
        for j in range(drawn.shape[1]):
            drawn[i, j] = uniform(keys[i], first[i] + j)
