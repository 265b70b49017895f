"""Arrays that belong together, under one name: what the compiled loops of ``kit.kernels.kernels`` take."""

from __future__ import annotations

from typing import NamedTuple

from kit.arrays import BoolArray, Float32Array, FloatArray, IntArray

LANES = 8
"""The lines of a lidar are looked at in whole vectors of this many."""


class WallBlocks(NamedTuple):
    """Walls, sorted into blocks of neighbours, each within a disc; made by ``kit.kernels.lidar_index.make_wall_blocks``."""

    ends: FloatArray
    """(n, 4) ``x1 y1 x2 y2`` in world coordinates."""
    starts: IntArray
    """(blocks + 1): block k is ``ends[starts[k]:starts[k + 1]]``."""
    discs: FloatArray
    """(blocks, 3) ``x y radius``, each containing its block."""


class Shapes(NamedTuple):
    """Circles and convex polygons, in world coordinates or in those of their bodies, and their layer bits."""

    circles: FloatArray
    """(circles, 3) ``x y radius``."""
    circle_bits: IntArray
    corners: FloatArray
    """(corners, 2), polygon after polygon, counter-clockwise."""
    starts: IntArray
    """(polygons + 1): polygon k is ``corners[starts[k]:starts[k + 1]]``."""
    polygon_bits: IntArray


class MovingShapes(NamedTuple):
    """Shapes of bodies that move: in the bodies' frames, and where they are in the world."""

    poses: FloatArray
    """(bodies, 3) ``x y theta``."""
    circle_body: IntArray
    """(circles,) the body of each."""
    corner_body: IntArray
    """(corners,) the body of each."""
    circles: FloatArray
    """(circles, 3) ``x y radius`` in the frames of their bodies."""
    corners: FloatArray
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
    ray_runs: IntArray
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
    rim: FloatArray
    """(corners, 4): the edges of one polygon."""


class VisibilityCells(NamedTuple):
    """The walls visible from each square cell of a map; made by ``kit.kernels.lidar_index.make_visibility_cells``."""

    ends: FloatArray
    """(n, 4) ``x1 y1 x2 y2``: the walls of each view, view after view."""
    starts: IntArray
    """(views + 1): view k is ``ends[starts[k]:starts[k + 1]]``."""
    view_of_cell: IntArray
    """(cells): the view that holds all that can be seen from anywhere in a cell."""
    map_corners: FloatArray
    """(maps, 2) ``x y`` of the first cell's lower left corner."""
    map_grids: IntArray
    """(maps, 3): number of the first cell, columns, rows; cells go row by row. No rows: there is no view."""
    cell_size: float
    """Its side [m]."""


class ObstacleParts(NamedTuple):
    """Shapes of bodies that are neither walls nor robots, in the frames of their bodies; some of these move."""

    map_parts: IntArray
    """(maps + 1): map m has the parts ``map_parts[m]:map_parts[m + 1]``."""
    body: IntArray
    """(parts): the body of each part, by its number on its map."""
    circles: FloatArray
    """(parts, 3) ``x y radius``; radius 0 for a polygon."""
    corners: FloatArray
    """(corners, 2), polygon after polygon, counter-clockwise."""
    starts: IntArray
    """(parts + 1): part k has the corners ``corners[starts[k]:starts[k + 1]]``; none for a circle."""
    bits: IntArray
    """(parts): 1 where robots touch it, 2 where their lidars see it, 3 for both."""
    reach: FloatArray
    """(parts): no part reaches farther from its body's origin [m]."""


class StartTables(NamedTuple):
    """Where the episodes of all cases start and end, for ``kit.kernels.world_kernels.draw_starts``."""

    starts: FloatArray
    """(places, robots, 3) ``x y theta``, case after case."""
    start_first: IntArray
    """(cases): the number of each case's first place."""
    start_count: IntArray
    """(cases)"""
    start_shift: FloatArray
    """(cases, 2): all robots start up to this far from their places, to either side [m]."""
    is_area: BoolArray
    """(cases): whether places are cells of free floor, of which every robot has one, rather than poses for all robots."""
    headings: FloatArray
    """(cases, 2): the least and the greatest one on free floor."""
    any_heading: FloatArray
    """(cases): 1 where all robots are turned by any angle, else 0."""
    targets: FloatArray
    """(targets, 3) ``x y theta``, case after case."""
    target_first: IntArray
    """(cases): the number of each case's first target."""
    target_choices: IntArray
    """(cases): among how many of them the first one is chosen."""
    target_shift: FloatArray
    """(cases, 2): a target lies up to this far from its place, to either side [m]."""
    noise: FloatArray
    """(3,): each robot starts up to this far from its pose, but for free floor."""
    cell_size: float
    """The side of a cell of free floor [m]."""


class BatchGeometry(NamedTuple):
    """What is the same in all worlds of a batch: the walls of the maps, the robots' hulls and lidars."""

    walls: WallBlocks
    """Of all maps, one after the other."""
    map_blocks: IntArray
    """(maps + 1): map m has the blocks ``blocks[m]:blocks[m + 1]``."""
    wall_boxes: FloatArray
    """(4, boxes) ``x1 y1 x2 y2``: the upright boxes around the walls in their order, and boxes infinitely far away that make
    those of each map whole vectors."""
    box_starts: IntArray
    """(maps + 1): map m has the boxes ``box_starts[m]:box_starts[m + 1]``."""
    visibility: VisibilityCells
    hulls: Shapes
    """Polygons in their robots' own frames; those of robot k are on layer bit ``1 << k``."""
    lidar_bits: IntArray
    """(polygons): the same bits, 0 for a polygon that no lidar sees."""
    corner_robot: IntArray
    """(corners): the robot that each corner belongs to."""
    hull_radius: float
    """No hull reaches farther from its robot's origin [m]."""
    axle: float
    """How far a robot's origin lies before the axle that it turns about [m]."""
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
    ways_corners: FloatArray
    """(targets, 2)"""
    cell: float
    """Their side [m]."""
    has_ways: bool
    """Whether ways are wanted."""
    radius: float
    """Of targets [m]."""
    is_by_hull: bool
    """Whether a robot is in a target with its hull or with its origin."""
    lidar: FloatArray
    """(3,): its pose on a robot."""
    is_lidar_offset: bool
    """Whether that is not the robot's own."""
    max_sensed: float
    scale: float
    single_rays: IntArray
    sectors: IntArray
    """See ``reduce_ranges``."""


class StepMoves(NamedTuple):
    """What n worlds with r robots each do in one step."""

    twists: FloatArray
    """(commands, n, r, 2) at the wheels: forward [m/s] and turn [rad/s]."""
    durations: FloatArray
    """(commands, n): for how long each is in force [s]."""
    order: IntArray
    """(moves,): which command each move follows."""
    checks: IntArray
    """(moves,): which check for obstacles comes after each move, -1 for none."""
    turn: FloatArray
    """(n, r): by how much the robots turn in all [rad]."""


class ScanDraws(NamedTuple):
    """The random part of one scan of n worlds; see ``scan_worlds``. (n,) each."""

    keys: IntArray
    numbers: IntArray
    noise_std: FloatArray
    dropped: FloatArray


class StepInputs(NamedTuple):
    """What one step of n worlds needs to know besides the robots."""

    maps: IntArray
    """(n,)"""
    moves: StepMoves
    bodies: FloatArray
    """(checks, n, k, 3): where the obstacles' bodies are at each check; at the last one they are scanned."""
    target_rows: IntArray
    """(n,): the numbers of the targets in ``ways``."""
    targets: FloatArray
    """(n, 2)"""
    draws: ScanDraws


class RobotStates(NamedTuple):
    """The r robots of n worlds after a step."""

    pose: FloatArray
    """(n, r, 3)"""
    clearance: FloatArray
    """(n, r): no wall is nearer [m], for sure; 0 where unknown. See ``step_worlds``."""
    hit: BoolArray
    """(n, r) who met something."""
    to_go: FloatArray
    """(n, r)"""
    in_target: BoolArray
    """(n, r)"""
    rotation: FloatArray
    """(n, r) rad, since the robot last turned to the other side."""
    ranges: Float32Array
    """(n, r, 96): what the lidars read, as far as agents see; what follows the last ray is the reach."""
    readings: Float32Array
    """(n, r, frame size) the numbers of an observation; those of rays come first, the others are not written."""


class StepScratch(NamedTuple):
    """Arrays that a step writes to besides its outputs; the next one writes over them."""

    hulls: Shapes
    seen_hulls: Shapes
    before: FloatArray
    squares: FloatArray
    corners: FloatArray
    buffers: ScanBuffers
    lidars: FloatArray
    last_poses: FloatArray
