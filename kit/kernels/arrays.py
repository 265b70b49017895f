"""Arrays that belong together, under one name: what the compiled loops of ``kit.kernels.kernels`` take."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Float64Array = NDArray[np.float64]
Float32Array = NDArray[np.float32]
Int64Array = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


LANES = 8
"""The lines of a lidar are looked at in whole vectors of so many."""


class WallBlocks(NamedTuple):
    """Walls, sorted into blocks of neighbours, each within a disc; made by ``kit.kernels.lidar_index.make_wall_blocks``."""

    ends: Float64Array
    """(n, 4) ``x1 y1 x2 y2`` in world coordinates."""
    starts: Int64Array
    """(blocks + 1): block k is ``ends[starts[k]:starts[k + 1]]``."""
    discs: Float64Array
    """(blocks, 3) ``x y radius``, each containing its block."""


class Shapes(NamedTuple):
    """Circles and convex polygons, in world coordinates or in those of their bodies, and their layer bits."""

    circles: Float64Array
    """(circles, 3) ``x y radius``."""
    circle_bits: Int64Array
    corners: Float64Array
    """(corners, 2), polygon after polygon, counter-clockwise."""
    starts: Int64Array
    """(polygons + 1): polygon k is ``corners[starts[k]:starts[k + 1]]``."""
    polygon_bits: Int64Array


class MovingShapes(NamedTuple):
    """Shapes of bodies that move: in the bodies' frames, and where they are in the world."""

    poses: Float64Array
    """(bodies, 3) ``x y theta``."""
    circle_body: Int64Array
    """(circles,) the body of each."""
    corner_body: Int64Array
    """(corners,) the body of each."""
    circles: Float64Array
    """(circles, 3) ``x y radius`` in the frames of their bodies."""
    corners: Float64Array
    """(corners, 2) in the frames of their bodies."""
    world: Shapes
    """In the world, once they have been placed."""


class Beams(NamedTuple):
    """The directions of a lidar's rays in its own frame; made by ``kit.kernels.lidar_index.make_beams``.

    Rays in opposite directions lie on one line, and what a wall does to one of them is known from the other.
    """

    cos: Float32Array
    """(rays,)"""
    sin: Float32Array
    """(rays,)"""
    lines: Float32Array
    """(2, lines): cos and sin of the lines. Whole vectors are faster: the last lines may point nowhere."""
    ray_runs: Int64Array
    """(runs, 4): rays from ``first`` to before ``end`` lie along (0) or against (1) the lines from ``line`` on."""


class ScanBuffers(NamedTuple):
    """Scratch arrays of one scan."""

    lines: Float32Array
    """(2, lines): cos and sin of the lines, in the world."""
    nearness: Float32Array
    """(2, lines): 1 / distance of the nearest obstacle so far along the lines, and, negative, in the opposite direction."""
    scratch: Float32Array
    """Scratch space of the same shape."""
    local_segments: Float32Array
    """(5, AIMED): segments relative to the sensor, and their scales."""
    rim: Float64Array
    """(corners, 4): the edges of one polygon."""


class VisibilityCells(NamedTuple):
    """The walls visible from each square cell of a map; made by ``kit.kernels.lidar_index.make_visibility_cells``."""

    ends: Float64Array
    """(n, 4) ``x1 y1 x2 y2``: the walls of each view, view after view."""
    starts: Int64Array
    """(views + 1): view k is ``ends[starts[k]:starts[k + 1]]``."""
    view_of_cell: Int64Array
    """(cells): the view that holds all that can be seen from anywhere in a cell."""
    map_corners: Float64Array
    """(maps, 2) ``x y`` of the first cell's lower left corner."""
    map_grids: Int64Array
    """(maps, 3): number of the first cell, columns, rows; cells go row by row. No rows: there is no view."""
    cell_size: float
    """Its side [m]."""


class ObstacleParts(NamedTuple):
    """Shapes of bodies that are neither walls nor robots, in the frames of their bodies; some of these move."""

    map_parts: Int64Array
    """(maps + 1): map m has the parts ``map_parts[m]:map_parts[m + 1]``."""
    body: Int64Array
    """(parts): the body of each part, by its number on its map."""
    circles: Float64Array
    """(parts, 3) ``x y radius``; radius 0 for a polygon."""
    corners: Float64Array
    """(corners, 2), polygon after polygon, counter-clockwise."""
    starts: Int64Array
    """(parts + 1): part k has the corners ``corners[starts[k]:starts[k + 1]]``; none for a circle."""
    bits: Int64Array
    """(parts): 1 where robots touch it, 2 where their lidars see it, 3 for both."""
    reach: Float64Array
    """(parts): no part reaches farther from its body's origin [m]."""


class StartTables(NamedTuple):
    """Where the episodes of all cases start and end, for ``kit.kernels.world_kernels.draw_starts``."""

    starts: Float64Array
    """(places, robots, 3) ``x y theta``, case after case."""
    start_first: Int64Array
    """(cases): the number of each case's first place."""
    start_count: Int64Array
    """(cases)"""
    start_shift: Float64Array
    """(cases, 2): all robots start up to this far from their places, to either side [m]."""
    is_area: BoolArray
    """(cases): whether places are cells of free floor, of which every robot has one, rather than poses for all robots."""
    headings: Float64Array
    """(cases, 2): the least and the greatest one on free floor."""
    any_heading: Float64Array
    """(cases): 1 where all robots are turned by any angle, else 0."""
    targets: Float64Array
    """(targets, 3) ``x y theta``, case after case."""
    target_first: Int64Array
    """(cases): the number of each case's first target."""
    target_choices: Int64Array
    """(cases): among how many of them the first one is chosen."""
    target_shift: Float64Array
    """(cases, 2): a target lies up to this far from its place, to either side [m]."""
    noise: Float64Array
    """(3,): each robot starts up to this far from its pose, but for free floor."""
    cell_size: float
    """The side of a cell of free floor [m]."""


class BatchGeometry(NamedTuple):
    """What is the same in all worlds of a batch: the walls of the maps, the robots' hulls and lidars."""

    walls: WallBlocks
    """Of all maps, one after the other."""
    map_blocks: Int64Array
    """(maps + 1): map m has the blocks ``blocks[m]:blocks[m + 1]``."""
    wall_boxes: Float64Array
    """(4, boxes) ``x1 y1 x2 y2``: the upright boxes around the walls in their order, and boxes infinitely far away that make
    those of each map whole vectors."""
    box_starts: Int64Array
    """(maps + 1): map m has the boxes ``box_starts[m]:box_starts[m + 1]``."""
    visibility: VisibilityCells
    hulls: Shapes
    """Polygons in their robots' own frames; those of robot k are on layer bit ``1 << k``."""
    lidar_bits: Int64Array
    """(polygons): the same bits, 0 for a polygon that no lidar sees."""
    corner_robot: Int64Array
    """(corners): the robot that each corner belongs to."""
    hull_radius: float
    """No hull reaches farther from its robot's origin [m]."""
    beams: Beams
    max_range: float
    """The lidars' [m]."""
    own_ranges: Float32Array
    """(rays,): how far each ray reaches before it meets its own robot [m]; or (0,) where none does."""
    noise_std: float
    """Standard deviation of the noise on every range [m]."""


class StepRules(NamedTuple):
    """What is the same in all steps of all worlds of a task."""

    fleet: BatchGeometry
    seen_fleet: BatchGeometry
    """With the hulls in the frames of the lidars."""
    obstacles: ObstacleParts
    ways: Float32Array
    """(targets, rows, columns): the way to each target [m]; see ``interpolate_tables``."""
    ways_corners: Float64Array
    """(targets, 2)"""
    cell: float
    """Their side [m]."""
    has_ways: bool
    """Whether ways are wanted."""
    radius: float
    """Of targets [m]."""
    is_by_hull: bool
    """Whether a robot is in a target with its hull or with its origin."""
    lidar: Float64Array
    """(3,): its pose on a robot."""
    is_lidar_offset: bool
    """Whether that is not the robot's own."""
    max_sensed: float
    scale: float
    single_rays: Int64Array
    sectors: Int64Array
    """See ``reduce_ranges``."""


class StepMoves(NamedTuple):
    """What n worlds with r robots each do in one step."""

    twists: Float64Array
    """(commands, n, r, 2) at the wheels: forward [m/s] and turn [rad/s]."""
    durations: Float64Array
    """(commands, n): for how long each is in force [s]."""
    order: Int64Array
    """(moves,): which command each move follows."""
    checks: Int64Array
    """(moves,): which check for obstacles comes after each move, -1 for none."""
    turn: Float64Array
    """(n, r): by how much the robots turn in all [rad]."""


class StepInputs(NamedTuple):
    """What one step of n worlds with r robots each begins with."""

    maps: Int64Array
    """(n,)"""
    moves: StepMoves
    bodies: Float64Array
    """(checks, n, k, 3): where the obstacles' bodies are at each check; at the last one they are scanned."""
    target_rows: Int64Array
    """(n,): the numbers of the targets in ``ways``."""
    targets: Float64Array
    """(n, 2)"""
    poses: Float64Array
    """(n, r, 3) before the step."""
    clearance: Float64Array
    """(n, r) before the step; see ``step_worlds``."""
    rotation: Float64Array
    """(n, r) before the step; see ``add_rotations``."""
    keys: Int64Array
    scan_numbers: Int64Array
    noise_std: Float64Array
    dropped: Float64Array
    """(n,) each; see ``scan_worlds``."""


class StepOutputs(NamedTuple):
    """What a step fills."""

    poses: Float64Array
    clearance: Float64Array
    collided: BoolArray
    to_go: Float64Array
    inside: BoolArray
    rotation: Float64Array
    full_turns: Int64Array
    previous_full_turns: Int64Array
    ranges: Float32Array
    readings: Float32Array


class StepScratch(NamedTuple):
    """Arrays that a step writes to besides its outputs; the next one writes over them."""

    hulls: Shapes
    seen_hulls: Shapes
    before: Float64Array
    squares: Float64Array
    corners: Float64Array
    buffers: ScanBuffers
    lidars: Float64Array
    last_poses: Float64Array
