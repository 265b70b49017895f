"""One step of all worlds of a batch, in one compiled call: the robots move, then they scan."""

from __future__ import annotations

import numpy as np

from kit.arrays import FloatArray
from kit.kernels.arrays import RobotStates, StepInputs, StepRules, StepScratch
from kit.kernels.compilation import jit, jit_borrowing_without_gil, jit_inline
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


@jit
def allocate_scratch(rules: StepRules, n: int, robots: int) -> StepScratch:
    """Allocates the arrays that a step of ``n`` worlds writes to besides its outputs."""
    corners = max(most_corners(rules.seen_fleet.hulls.starts), most_corners(rules.obstacles.starts))
    return StepScratch(
        allocate_hulls(rules.fleet, rules.fleet.hulls.polygon_bits),
        allocate_hulls(rules.seen_fleet, rules.seen_fleet.lidar_bits),
        np.empty((robots, 3)),
        np.empty(rules.fleet.wall_boxes.shape[1]),
        np.empty((most_corners(rules.obstacles.starts), 2)),
        allocate_scan_buffers(rules.seen_fleet.beams.lines, corners),
        np.empty((n, robots, 3)),
        np.empty((n, robots, 3)),
    )


@jit_inline
def _copy_poses(poses: FloatArray, copies: FloatArray) -> None:
    for i in range(poses.shape[0]):
        for k in range(poses.shape[1]):
            for axis in range(3):
                copies[i, k, axis] = poses[i, k, axis]


@jit_inline
def _move_robots(
    rules: StepRules, scratch: StepScratch, inputs: StepInputs, before: RobotStates, after: RobotStates
) -> None:
    """Moves all robots, and fills what follows from their poses."""
    poses, clearance, hit = after.pose, after.clearance, after.hit
    moves, last = inputs.moves, scratch.last_poses
    _copy_poses(before.pose, poses)
    for i in range(poses.shape[0]):
        for k in range(poses.shape[1]):
            clearance[i, k], hit[i, k] = before.clearance[i, k], False
    for i in range(moves.order.shape[0]):
        if inputs.bodies.shape[2] and (i == 0 or moves.checks[i - 1] >= 0):
            _copy_poses(poses, last)
        step_worlds_with(
            scratch.hulls,
            scratch.before,
            scratch.squares,
            rules.fleet,
            inputs.maps,
            moves.twists[moves.order[i]],
            moves.durations[moves.order[i]],
            poses,
            clearance,
            hit,
        )
        if moves.checks[i] >= 0 and inputs.bodies.shape[2]:
            stop_at_obstacles(
                scratch.corners,
                rules.fleet,
                rules.obstacles,
                inputs.maps,
                inputs.bodies[moves.checks[i]],
                last,
                poses,
                clearance,
                hit,
            )
    if rules.has_ways:
        interpolate_tables(rules.ways, rules.ways_corners, rules.cell, inputs.target_rows, poses, after.to_go)
    find_arrivals(rules.fleet, poses, inputs.targets, rules.radius, rules.is_by_hull, after.in_target)
    add_rotations(before.rotation, moves.turn, after.rotation)


@jit_inline
def _scan(rules: StepRules, scratch: StepScratch, inputs: StepInputs, after: RobotStates) -> None:
    """Scans from the new poses of all robots."""
    lidars, draws = after.pose, inputs.draws
    if rules.is_lidar_offset:
        lidars = scratch.lidars
        carry_lidars(rules.lidar, after.pose, lidars)
    scan_worlds(
        scratch.buffers,
        scratch.seen_hulls,
        rules.seen_fleet,
        inputs.maps,
        lidars,
        draws.keys,
        draws.numbers,
        draws.noise_std,
        draws.dropped,
        rules.obstacles,
        inputs.bodies[inputs.bodies.shape[0] - 1],
        rules.max_sensed,
        rules.scale,
        rules.single_rays,
        rules.sectors,
        after.ranges,
        after.readings,
    )


@jit_borrowing_without_gil
def step_batch(
    rules: StepRules, scratch: StepScratch, inputs: StepInputs, before: RobotStates, after: RobotStates
) -> None:
    """Makes one step of all worlds: fills ``after``."""
    _move_robots(rules, scratch, inputs, before, after)
    _scan(rules, scratch, inputs, after)
