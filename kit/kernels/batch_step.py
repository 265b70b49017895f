"""One step of many worlds, in loops that several threads share: each takes the next few worlds that none has begun.

Threads wait for each other in here, without Python's lock: to wake one that sleeps takes as long as a hundred worlds do.
"""

from __future__ import annotations

import numpy as np

from kit.arrays import FloatArray, IntArray
from kit.kernels.arrays import Step, StepRules, StepScratch
from kit.kernels.compilation import fetch_add, jit, jit_borrowing_without_gil, jit_inline, load_count
from kit.kernels.grids import add_rotations, interpolate_tables
from kit.kernels.kernels import allocate_scan_buffers, most_corners
from kit.kernels.world_kernels import (
    allocate_hulls,
    carry_lidars,
    find_arrivals,
    scan_worlds,
    step_worlds_with,
    stop_at_obstacles,
)

CHUNK = 64
"""A thread takes so many worlds at a time."""

CACHE_LINE = 8
"""So many counts lie on a cache line. Threads that count on the same one wait for each other."""
DONE, BEGUN, FROM_START, FROM_END = 0, CACHE_LINE, 2 * CACHE_LINE, 3 * CACHE_LINE
"""Places of counts: worlds done, chunks begun, and these by the end of the array that they were taken from."""
ADVANCE, SCAN = CACHE_LINE, 5 * CACHE_LINE
"""The two parts of a step, and where their counts begin."""
HELP = 0
"""Both parts, beside the thread that waits for them."""
COUNTS = 10 * CACHE_LINE
"""With an empty line at each end, which nothing else lies on."""


@jit_inline
def _wait_until(counts: IntArray, place: int, least: int, patience: int) -> bool:
    """Waits until a count is ``least`` or more; False if it is not after looking ``patience`` times."""
    for _ in range(patience):
        if load_count(counts, place) >= least:
            return True
    return bool(load_count(counts, place) >= least)


@jit
def allocate_scratch(rules: StepRules, robots: int) -> StepScratch:
    """Allocates the arrays of one thread."""
    corners = max(most_corners(rules.seen_fleet.hulls.starts), most_corners(rules.obstacles.starts))
    return StepScratch(
        allocate_hulls(rules.fleet, rules.fleet.hulls.polygon_bits),
        allocate_hulls(rules.seen_fleet, rules.seen_fleet.lidar_bits),
        np.empty((robots, 3)),
        np.empty(rules.fleet.wall_boxes.shape[1]),
        np.empty((most_corners(rules.obstacles.starts), 2)),
        allocate_scan_buffers(rules.seen_fleet.beams.lines, corners),
        np.empty((CHUNK, robots, 3)),
        np.empty((CHUNK, robots, 3)),
    )


@jit_inline
def _copy_poses(poses: FloatArray, copies: FloatArray) -> None:
    for i in range(poses.shape[0]):
        for k in range(poses.shape[1]):
            for axis in range(3):
                copies[i, k, axis] = poses[i, k, axis]


@jit_inline
def _advance_worlds(begin: int, end: int, scratch: StepScratch, step: Step) -> None:
    """Moves the robots of some worlds, and fills what follows from their poses."""
    rules, inputs, outputs = step.rules, step.inputs, step.outputs
    poses, clearance, collided = (
        outputs.poses[begin:end],
        outputs.clearance[begin:end],
        outputs.collided[begin:end],
    )
    moves, last = inputs.moves, scratch.last_poses[: end - begin]
    _copy_poses(inputs.poses[begin:end], poses)
    for i in range(end - begin):
        for k in range(poses.shape[1]):
            clearance[i, k], collided[i, k] = inputs.clearance[begin + i, k], False
    for i in range(moves.order.shape[0]):
        if inputs.bodies.shape[2] and (i == 0 or moves.checks[i - 1] >= 0):
            _copy_poses(poses, last)
        step_worlds_with(
            scratch.hulls,
            scratch.before,
            scratch.squares,
            rules.fleet,
            inputs.maps[begin:end],
            moves.twists[moves.order[i], begin:end],
            moves.durations[moves.order[i], begin:end],
            poses,
            clearance,
            collided,
        )
        if moves.checks[i] >= 0 and inputs.bodies.shape[2]:
            stop_at_obstacles(
                scratch.corners,
                rules.fleet,
                rules.obstacles,
                inputs.maps[begin:end],
                inputs.bodies[moves.checks[i], begin:end],
                last,
                poses,
                clearance,
                collided,
            )
    if rules.has_ways:
        rows, to_go = inputs.target_rows[begin:end], outputs.to_go[begin:end]
        interpolate_tables(rules.ways, rules.ways_corners, rules.cell, rows, poses, to_go)
    targets, inside = inputs.targets[begin:end], outputs.inside[begin:end]
    find_arrivals(rules.fleet, poses, targets, rules.radius, rules.is_by_hull, inside)
    add_rotations(
        inputs.rotation[begin:end],
        moves.turn[begin:end],
        outputs.rotation[begin:end],
        outputs.full_turns[begin:end],
        outputs.previous_full_turns[begin:end],
    )


@jit_inline
def _scan_worlds(begin: int, end: int, scratch: StepScratch, step: Step) -> None:
    """Scans from the new poses of some worlds."""
    rules, inputs, outputs = step.rules, step.inputs, step.outputs
    lidars = outputs.poses[begin:end]
    if rules.is_lidar_offset:
        lidars = scratch.lidars[: end - begin]
        carry_lidars(rules.lidar, outputs.poses[begin:end], lidars)
    scan_worlds(
        scratch.buffers,
        scratch.seen_hulls,
        rules.seen_fleet,
        inputs.maps[begin:end],
        lidars,
        inputs.keys[begin:end],
        inputs.scan_numbers[begin:end],
        inputs.noise_std[begin:end],
        inputs.dropped[begin:end],
        rules.obstacles,
        inputs.bodies[inputs.bodies.shape[0] - 1, begin:end],
        rules.max_sensed,
        rules.scale,
        rules.single_rays,
        rules.sectors,
        outputs.ranges[begin:end],
        outputs.readings[begin:end],
    )


@jit_inline
def _take(progress: IntArray, stage: int, n: int, is_helping: bool) -> tuple[int, int]:
    """The first and last plus one of some worlds that no thread has begun; equal where none is left. A thread that helps takes
    them from the end: what it has written in a step before it writes again, and nothing moves from cache to cache."""
    chunks = (n + CHUNK - 1) // CHUNK
    if fetch_add(progress, stage + BEGUN, 1) >= chunks:
        return n, n
    if is_helping:
        number = chunks - 1 - fetch_add(progress, stage + FROM_END, 1)
    else:
        number = fetch_add(progress, stage + FROM_START, 1)
    return number * CHUNK, min((number + 1) * CHUNK, n)


@jit_borrowing_without_gil
def run_step(
    scratch: StepScratch, step: Step, part: int, begun: IntArray, number: int, patience: int
) -> bool:
    """Does a part of step ``number``, but for the worlds that other threads have begun: ADVANCE, or SCAN when all are advanced.
    Returns whether that is done by all threads, after looking ``patience`` times.

    HELP does both beside the calling thread, and waits for the next step. ``begun`` (COUNTS,): the last step that has begun.
    """
    n, progress, is_helping = step.outputs.poses.shape[0], step.progress, part == HELP
    if part != SCAN:
        if not is_helping:
            begun[CACHE_LINE] = number
        begin, end = _take(progress, ADVANCE, n, is_helping)
        while begin < end:
            _advance_worlds(begin, end, scratch, step)
            fetch_add(progress, ADVANCE + DONE, end - begin)
            begin, end = _take(progress, ADVANCE, n, is_helping)
        while not _wait_until(progress, ADVANCE + DONE, n, patience):
            if not is_helping:
                return False
    if part == ADVANCE:
        return True
    begin, end = _take(progress, SCAN, n, is_helping)
    while begin < end:
        _scan_worlds(begin, end, scratch, step)
        fetch_add(progress, SCAN + DONE, end - begin)
        begin, end = _take(progress, SCAN, n, is_helping)
    if is_helping:
        return _wait_until(begun, CACHE_LINE, number + 1, patience)
    return _wait_until(progress, SCAN + DONE, n, patience)
