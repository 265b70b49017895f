"""One step of all worlds of a batch, in one compiled call: the robots move, then they scan."""

from __future__ import annotations

import numpy as np

from kit.arrays import FloatArray
from kit.kernels.arrays import StepInputs, StepOutputs, StepRules, StepScratch
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
def _move_robots(rules: StepRules, scratch: StepScratch, inputs: StepInputs, outputs: StepOutputs) -> None:
    """Moves all robots, and fills what follows from their poses."""
    poses, clearance, collided = outputs.poses, outputs.clearance, outputs.collided
    moves, last = inputs.moves, scratch.last_poses
    _copy_poses(inputs.poses, poses)
    for i in range(poses.shape[0]):
        for k in range(poses.shape[1]):
            clearance[i, k], collided[i, k] = inputs.clearance[i, k], False
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
            collided,
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
                collided,
            )
    if rules.has_ways:
        interpolate_tables(
            rules.ways, rules.ways_corners, rules.cell, inputs.target_rows, poses, outputs.to_go
        )
    find_arrivals(rules.fleet, poses, inputs.targets, rules.radius, rules.is_by_hull, outputs.inside)
    add_rotations(
        inputs.rotation, moves.turn, outputs.rotation, outputs.full_turns, outputs.previous_full_turns
    )


@jit_inline
def _scan(rules: StepRules, scratch: StepScratch, inputs: StepInputs, outputs: StepOutputs) -> None:
    """Scans from the new poses of all robots."""
    lidars = outputs.poses
    if rules.is_lidar_offset:
        lidars = scratch.lidars
        carry_lidars(rules.lidar, outputs.poses, lidars)
    scan_worlds(
        scratch.buffers,
        scratch.seen_hulls,
        rules.seen_fleet,
        inputs.maps,
        lidars,
        inputs.keys,
        inputs.scan_numbers,
        inputs.noise_std,
        inputs.dropped,
        rules.obstacles,
        inputs.bodies[inputs.bodies.shape[0] - 1],
        rules.max_sensed,
        rules.scale,
        rules.single_rays,
        rules.sectors,
        outputs.ranges,
        outputs.readings,
    )


@jit_borrowing_without_gil
def step_batch(rules: StepRules, scratch: StepScratch, inputs: StepInputs, outputs: StepOutputs) -> None:
    """Makes one step of all worlds: fills ``outputs``."""
    _move_robots(rules, scratch, inputs, outputs)
    _scan(rules, scratch, inputs, outputs)
