"""Terms of a reward, each a function of a transition; plain arithmetic on arrays.

The same function serves one world (fields of shape ``()``) and many (``(n,)``). What belongs to a robot has one more axis, the
robots, over which a term sums.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from inspect import signature
from types import MappingProxyType
from typing import TypeAlias

import numpy as np

from kit.geometry import wrap_angle
from kit.learning.tasks.actions import Move
from kit.learning.tasks.transition import Array, Transition

RewardTerm: TypeAlias = Callable[..., Array]
"""(...) what a transition, its first argument, earns by one rule, before it is weighed. Further parameters are numbers with
a default: the term's settings."""


def _values_by_move(**values: float) -> Array:
    """One value for each move, 0 for those not named."""
    return np.array([values.get(move.name, 0.0) for move in Move])


def _sum_over_robots(each: Array) -> Array:
    """(...) of the robots (..., R). numpy's own sum takes ten times as long over so few."""
    total = each[..., 0]
    for robot in range(1, each.shape[-1]):
        total = total + each[..., robot]
    return total


FORWARD_SHARE = _values_by_move(FORWARD=1.0, FORWARD_LEFT=0.5, FORWARD_RIGHT=0.5)
IDLE_MOVES = _values_by_move(STOP=1.0, BACK=1.0)
TURNING_MOVES = _values_by_move(LEFT=1.0, RIGHT=1.0)
REVERSED_MOVES = np.zeros((len(Move) + 1, len(Move)))
"""(previous move, move): 1 where the second takes back the first; the row -1 is for no move before."""
for _one, _other in ((Move.FORWARD, Move.BACK), (Move.LEFT, Move.RIGHT)):
    REVERSED_MOVES[_one, _other] = REVERSED_MOVES[_other, _one] = 1.0
TIGHT_RANGE = 0.1
"""With less room ahead than this [m], a robot must turn."""
FREE_RANGE = 0.5
"""With more room ahead than this [m], a robot may continue."""


def collided_reward(t: Transition) -> Array:
    """1 where a robot met a wall or the other robot."""
    return 1.0 * t.collided


def reached_reward(t: Transition) -> Array:
    """1 where the goal is reached and no robot has collided."""
    return 1.0 * t.reached


def time_left_reward(t: Transition) -> Array:
    """The steps that were left when the target was reached."""
    return t.reached * (t.max_steps - t.step)


def timed_out_reward(t: Transition) -> Array:
    """1 where time ran out."""
    return 1.0 * t.timed_out


def forward_lost_reward(t: Transition) -> Array:
    """The share of all steps that led forward, where time ran out: what they earned is taken back."""
    return t.timed_out * _sum_over_robots(t.forward_steps) / t.max_steps


def elapsed_reward(t: Transition) -> Array:
    """1 in every step."""
    return np.ones(np.shape(t.step))


def _sum_over_moving(t: Transition, each: Array, there: float) -> Array:
    """(...) of the robots (..., R), as a share of all steps; of those in the target times ``there``."""
    return _sum_over_robots(each if there == 1.0 else np.where(t.in_target, there * each, each)) / t.max_steps


def forward_reward(t: Transition, there: float = 1.0) -> Array:
    """1 for each robot that moves forward, half of it along a curve, in the target times the factor ``there``; as a share of all
    steps."""
    return _sum_over_moving(t, FORWARD_SHARE[t.move], there)


def idle_reward(t: Transition, there: float = 1.0) -> Array:
    """1 for each robot that stops or goes back, in the target times the factor ``there``; as a share of all steps."""
    return _sum_over_moving(t, IDLE_MOVES[t.move], there)


def turning_with_room_reward(t: Transition, there: float = 1.0) -> Array:
    """1 for each robot that turns on the spot with room ahead, in the target times the factor ``there``; as a share of all
    steps."""
    return _sum_over_moving(t, TURNING_MOVES[t.move] * (t.front > TIGHT_RANGE), there)


def turning_in_need_reward(t: Transition, there: float = 1.0) -> Array:
    """1 for each robot that turns on the spot before a wall, in the target times the factor ``there``; as a share of all
    steps."""
    return _sum_over_moving(t, TURNING_MOVES[t.move] * (t.front <= TIGHT_RANGE), there)


def undoing_reward(t: Transition) -> Array:
    """1 for each robot that takes back its last move; as a share of all steps."""
    return _sum_over_robots(REVERSED_MOVES[t.previous_move, t.move]) / t.max_steps


def full_turns_reward(t: Transition) -> Array:
    """The whole turns that each robot has made to the same side, in every step again."""
    return 1.0 * _sum_over_robots(t.full_turns)


def turn_completed_reward(t: Transition) -> Array:
    """In the step in which a robot completes a whole turn: the number of turns it has made to the same side."""
    return 1.0 * _sum_over_robots(t.full_turns * (t.full_turns > t.previous_full_turns))


def room_ahead_reward(t: Transition) -> Array:
    """Metres of room ahead of each robot, beyond half a metre; as a share of all steps."""
    return _sum_over_robots(t.front - FREE_RANGE) / t.max_steps


def room_aside_reward(t: Transition) -> Array:
    """The product of the room to the left and to the right of ahead, where there is room ahead."""
    both = (t.front_left - FREE_RANGE) * (t.front_right - FREE_RANGE)
    return _sum_over_robots((t.front > FREE_RANGE) * both) / t.max_steps


def room_diagonal_reward(t: Transition, left_share: float = 0.5, others_less: float = 0.0) -> Array:
    """Metres of room to the left and to the right of ahead, beyond half a metre each, where there is room ahead; as a share
    of all steps. ``left_share``: of the two, how much the left one counts, of every robot but the first ``others_less``."""
    left: Array = left_share - others_less * (np.arange(t.robots) > 0) if others_less else left_share
    room = left * t.front_left + (1.0 - left) * t.front_right - FREE_RANGE
    return _sum_over_robots((t.front > FREE_RANGE) * 2.0 * room) / t.max_steps


def entering_reward(t: Transition, most: float = 4.0) -> Array:
    """1 for each robot that enters the target, up to ``most`` in one step."""
    return np.minimum(1.0 * _sum_over_robots(t.in_target & ~t.was_in_target), most)


def leaving_reward(t: Transition, most: float = 4.0) -> Array:
    """1 for each robot that leaves the target, up to ``most`` in one step."""
    return np.minimum(1.0 * _sum_over_robots(t.was_in_target & ~t.in_target), most)


def stopping_there_reward(t: Transition) -> Array:
    """For each robot in the target: 1 if it stops, -1 if it does anything else."""
    return _sum_over_robots(t.in_target * np.where(t.move == Move.STOP, 1.0, -1.0))


def adjacent_reward(t: Transition) -> Array:
    """1 where two robots are side by side, as their rays tell."""
    return 1.0 * t.adjacent


def abreast_reward(t: Transition) -> Array:
    """How well two robots stand side by side by their poses, 0 to 1."""
    return t.abreast


def progress_reward(t: Transition) -> Array:
    """Metres along the way to the target since the last step, the mean of the robots."""
    return _sum_over_robots(t.previous_to_go - t.to_go) / t.robots


def approaching_reward(t: Transition) -> Array:
    """For each robot: 1 if it came nearer to the target in a straight line, -1 if farther; as a share of all steps."""
    return _sum_over_robots(np.sign(t.previous_distance - t.distance)) / t.max_steps


def facing_reward(t: Transition) -> Array:
    """For each robot: 1 if it turned towards the target, -1 if away; as a share of all steps."""
    return _sum_over_robots(np.sign(np.abs(t.previous_bearing) - np.abs(t.bearing))) / t.max_steps


def achieving_reward(t: Transition) -> Array:
    """The share of the goal that this step achieved."""
    return t.achieved - t.previous_achieved


def speed_reward(t: Transition) -> Array:
    """Metres per second forward that each robot's action asked for, the mean of the robots."""
    return _sum_over_robots(t.twist[..., 0]) / t.robots


def turning_reward(t: Transition) -> Array:
    """Radians per second that each robot's action asked for, to either side, the mean of the robots."""
    return _sum_over_robots(np.abs(t.twist[..., 1])) / t.robots


def near_obstacle_reward(t: Transition, distance: float = 0.5) -> Array:
    """For each robot nearer than ``distance`` to a cart or the like: 0 at that distance, up to 1 at its middle."""
    return _sum_over_robots(np.maximum(0.0, 1.0 - t.obstacle_distance / distance))


def beside_wall_reward(
    t: Transition, distance: float = 0.25, tolerance: float = 0.1, left: float = 0.0
) -> Array:
    """Up to 1 for each robot with a wall at ``distance`` on its right, on its left if ``left``; 0 from ``tolerance`` off."""
    beside = t.beside_left if left else t.beside_right
    return _sum_over_robots(np.maximum(0.0, 1.0 - np.abs(beside - distance) / tolerance))


def off_leader_reward(t: Transition, nearest: float = 0.3, farthest: float = 0.8) -> Array:
    """Metres by which each robot is nearer than ``nearest`` or farther than ``farthest`` from the target, at most 2."""
    off = np.maximum(nearest - t.distance, t.distance - farthest)
    return _sum_over_robots(np.clip(off, 0.0, 2.0))


def misaligned_reward(t: Transition, within: float = 0.5) -> Array:
    """For each robot less than ``within`` from the target: by how much its heading is off, 0 to 1."""
    return _sum_over_robots((t.distance < within) * t.misalignment) / np.pi


def heading_progress_reward(t: Transition, within: float = 0.5) -> Array:
    """Progress in heading near the target: half turns that each robot came nearer to the target's heading, within ``within`` metres."""
    before = np.abs(wrap_angle(t.previous_pose[..., 2] - t.target_heading[..., None]))
    return _sum_over_robots((t.distance < within) * (before - t.misalignment)) / np.pi


TERMS: Mapping[str, RewardTerm] = MappingProxyType(
    {
        "collided": collided_reward,
        "reached": reached_reward,
        "time_left": time_left_reward,
        "timed_out": timed_out_reward,
        "forward_lost": forward_lost_reward,
        "elapsed": elapsed_reward,
        "forward": forward_reward,
        "idle": idle_reward,
        "turning_with_room": turning_with_room_reward,
        "turning_in_need": turning_in_need_reward,
        "undoing": undoing_reward,
        "full_turns": full_turns_reward,
        "turn_completed": turn_completed_reward,
        "room_ahead": room_ahead_reward,
        "room_aside": room_aside_reward,
        "room_diagonal": room_diagonal_reward,
        "entering": entering_reward,
        "leaving": leaving_reward,
        "stopping_there": stopping_there_reward,
        "adjacent": adjacent_reward,
        "abreast": abreast_reward,
        "progress": progress_reward,
        "approaching": approaching_reward,
        "facing": facing_reward,
        "achieving": achieving_reward,
        "speed": speed_reward,
        "turning": turning_reward,
        "near_obstacle": near_obstacle_reward,
        "beside_wall": beside_wall_reward,
        "off_leader": off_leader_reward,
        "misaligned": misaligned_reward,
        "heading_progress": heading_progress_reward,
    }
)
"""Terms by the name that weights, events and ``info["terms"]`` use."""


def term_settings(term: str) -> dict[str, float]:
    """The settings of a reward term and their usual values: the parameters of its function beside the transition."""
    parameters = list(signature(TERMS[term]).parameters.values())[1:]
    return {parameter.name: float(parameter.default) for parameter in parameters}
