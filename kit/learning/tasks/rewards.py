"""Rewards: a sum of named terms, weighed in one place; the dissertation's three, and ours.

A term is a function of a transition. It is plain arithmetic on arrays: the same function serves one world
(fields of shape ``()``) and many (``(n,)``). What belongs to a robot has one more axis, the robots, over which a
term sums.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from inspect import signature
from types import MappingProxyType
from typing import TypeAlias

import numpy as np

from kit.fields.adjacency import wrap_angles
from kit.learning.tasks.actions import Move
from kit.learning.tasks.transition import Array, Transition
from kit.plain_text import quoted, suggestion

RewardTerm: TypeAlias = Callable[..., Array]
"""(...) what a transition, its first argument, earns by one rule, before it is weighed. Further parameters are numbers with
a default: the term's settings."""

RewardFunction: TypeAlias = Callable[[Transition], Array]
"""A student's reward: a transition of ``n`` worlds -> (n,) rewards."""


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
    """1 for each robot that moves forward, half of it along a curve, ``there`` times as much in the target; as a share of all
    steps."""
    return _sum_over_moving(t, FORWARD_SHARE[t.move], there)


def idle_reward(t: Transition, there: float = 1.0) -> Array:
    """1 for each robot that stops or goes back, ``there`` times as much in the target; as a share of all steps."""
    return _sum_over_moving(t, IDLE_MOVES[t.move], there)


def turning_with_room_reward(t: Transition, there: float = 1.0) -> Array:
    """1 for each robot that turns on the spot with room ahead, ``there`` times as much in the target; as a share of all
    steps."""
    return _sum_over_moving(t, TURNING_MOVES[t.move] * (t.front > TIGHT_RANGE), there)


def turning_in_need_reward(t: Transition, there: float = 1.0) -> Array:
    """1 for each robot that turns on the spot before a wall, ``there`` times as much in the target; as a share of all
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


def aligned_progress_reward(t: Transition, within: float = 0.5) -> Array:
    """Progress in heading near the target: half turns that each robot came nearer to the target's heading, within ``within`` metres."""
    before = np.abs(wrap_angles(t.previous_pose[..., 2] - t.target_heading[..., None]))
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
        "aligned_progress": aligned_progress_reward,
    }
)
"""Terms by the name that weights, events and ``info["terms"]`` use."""


class UnknownRewardTerm(LookupError):
    """No term has that name; the message offers the nearest one."""


@dataclass(frozen=True, slots=True)
class TermWeight:
    """The weight of a reward term. Raises UnknownRewardTerm."""

    term: str
    """A name in ``TERMS``."""
    value: float
    at_end: bool = True
    """Whether it also counts in the step that ends the episode."""
    settings: tuple[tuple[str, float], ...] = ()
    """Values of the term's settings, by name; the others are as ``term_settings`` says."""

    def __post_init__(self) -> None:
        if self.term not in TERMS:
            raise UnknownRewardTerm(
                f"there is no reward term {quoted(self.term)}: {suggestion(self.term, TERMS)}"
            )
        known = term_settings(self.term)
        for name, _ in self.settings:
            if name not in known:
                raise UnknownRewardTerm(
                    f"the reward term {self.term} has no setting {quoted(name)}: {suggestion(name, known)}"
                )

    def __call__(self, transition: Transition) -> Array:
        """(...) what the term earns, before it is weighed."""
        function = TERMS[self.term]
        return function(transition, **dict(self.settings)) if self.settings else function(transition)


def term_settings(term: str) -> dict[str, float]:
    """The settings of a reward term and their usual values: the parameters of its function beside the transition."""
    parameters = list(signature(TERMS[term]).parameters.values())[1:]
    return {parameter.name: float(parameter.default) for parameter in parameters}


@dataclass(frozen=True, slots=True)
class Reward:
    """A weighed sum of terms."""

    name: str
    weights: tuple[TermWeight, ...]
    scale: float = 1.0
    """Factor of the whole sum."""
    is_small: bool = False
    """Whether an episode earns a few units as it stands; the dissertation's rewards come to hundreds."""

    def terms(self, transition: Transition) -> dict[str, Array]:
        """(...) each: what every term adds to the reward, weight and scale included."""
        going = None if all(weight.at_end for weight in self.weights) else ~transition.ended
        found = {}
        for weight in self.weights:
            earned = weight(transition) if weight.settings else TERMS[weight.term](transition)
            value = (self.scale * weight.value) * earned
            found[weight.term] = value if weight.at_end or going is None else value * going
        return found

    def __call__(self, transition: Transition) -> Array:
        """(...) the reward."""
        return np.asarray(sum(self.terms(transition).values()))


REWARD_SCALE = 0.01
"""Factor that makes the dissertation's rewards small: a value network learns those at once."""
FULL_FORWARD = 300.0
"""Reward for moving forward in every step of an episode: the dissertation's ``basic_reward`` is this, per step."""

_OUTCOME_WEIGHTS = (
    TermWeight("collided", -200.0),
    TermWeight("reached", 400.0),
    TermWeight("time_left", 1.0),
    TermWeight("timed_out", -300.0),
)
_MOVE_WEIGHTS = (
    TermWeight("forward", FULL_FORWARD, at_end=False),
    TermWeight("idle", -5 * FULL_FORWARD, at_end=False),
    TermWeight("turning_with_room", -2 * FULL_FORWARD, at_end=False),
    TermWeight("turning_in_need", 0.5 * FULL_FORWARD, at_end=False),
)
_DRIVING_STYLE_WEIGHTS = (
    TermWeight("undoing", -5 * FULL_FORWARD),
    TermWeight("full_turns", -75.0),
    TermWeight("room_ahead", 2 * FULL_FORWARD),
    TermWeight("room_aside", FULL_FORWARD),
)

ALGORITHM_1 = Reward(
    "algorithm-1",
    (*_OUTCOME_WEIGHTS, TermWeight("forward_lost", -FULL_FORWARD), *_MOVE_WEIGHTS, *_DRIVING_STYLE_WEIGHTS),
)
"""One robot in the hallways (dissertation, section 3.1.2.3)."""

ALGORITHM_1_AS_RUN = Reward(
    "algorithm-1-as-run",
    (
        *ALGORITHM_1.weights[: -len(_DRIVING_STYLE_WEIGHTS)],
        TermWeight("undoing", -5 * FULL_FORWARD),
        TermWeight("turn_completed", -75.0),
        TermWeight("room_ahead", 2 * FULL_FORWARD),
        TermWeight("room_diagonal", FULL_FORWARD, settings=(("left_share", 0.0),)),
    ),
)
"""The same as its code ran: a whole turn is charged once, and both diagonals are the ray to the right of ahead, added instead of
multiplied."""

ALGORITHM_1_TARGET = Reward(
    "algorithm-1-target",
    (*ALGORITHM_1.weights, TermWeight("approaching", FULL_FORWARD), TermWeight("facing", FULL_FORWARD)),
)
"""The same where distance and rotation to the target are known (section 3.2.2, which gives no amounts)."""

ALGORITHM_2 = Reward(
    "algorithm-2",
    (
        *_OUTCOME_WEIGHTS,
        TermWeight("forward_lost", -FULL_FORWARD),
        *(TermWeight(weight.term, weight.value) for weight in _MOVE_WEIGHTS),
        *_DRIVING_STYLE_WEIGHTS,
        TermWeight("entering", 100.0),
        TermWeight("leaving", -100.0),
        TermWeight("adjacent", 10.0),
    ),
)
"""Two wheelchairs (section 4.1.4.2). Its line 18 adds the whole sum so far to what a timeout takes back; here, as in
algorithm 1, it is what moving forward earned."""

ALGORITHM_2_STOPPING = Reward(
    "algorithm-2-stopping", (*ALGORITHM_2.weights, TermWeight("stopping_there", 10.0))
)
"""The same where stopping in the target is rewarded and anything else there charged (section 4.2.1.1, which gives no
amount; this one outweighs what stopping costs)."""

_CODE_OUTCOME_WEIGHTS = (
    TermWeight("collided", -400.0),
    TermWeight("reached", 900.0),
    TermWeight("time_left", 2.0 / 3.0),
    TermWeight("timed_out", -600.0),
    TermWeight("forward_lost", -FULL_FORWARD),
)
_CODE_HABIT_WEIGHTS = (
    TermWeight("undoing", -5 * FULL_FORWARD),
    TermWeight("turn_completed", -75.0),
    TermWeight("room_ahead", 2 * FULL_FORWARD),
    TermWeight("room_diagonal", FULL_FORWARD, settings=(("others_less", 0.5),)),
    TermWeight("entering", 100.0, settings=(("most", 1.0),)),
    TermWeight("leaving", -100.0, settings=(("most", 1.0),)),
    TermWeight("adjacent", 10.0),
)

ALGORITHM_2_AS_RUN = Reward(
    "algorithm-2-as-run",
    (
        *_CODE_OUTCOME_WEIGHTS,
        *(TermWeight(weight.term, weight.value) for weight in _MOVE_WEIGHTS),
        *_CODE_HABIT_WEIGHTS,
    ),
)
"""The same as its code ran for table 4.1: outcomes count twice and arriving in the n-th of 300 steps earns 800 + 300 - 2n/3, a
whole turn is charged once, the two diagonals are added instead of multiplied, of the right wheelchair both are the ray to the
right of ahead, and two that enter or leave the target in one step count as one."""

ALGORITHM_2_STOPPING_AS_RUN = Reward(
    "algorithm-2-stopping-as-run",
    (
        *_CODE_OUTCOME_WEIGHTS,
        *(TermWeight(weight.term, weight.value, settings=(("there", 0.0),)) for weight in _MOVE_WEIGHTS),
        *_CODE_HABIT_WEIGHTS,
        TermWeight("stopping_there", 1.0),
    ),
)
"""The same from table 4.2 on: in the target a robot earns 1 for stopping and -1 for anything else, instead of what the move
earns elsewhere."""

ALGORITHM_3 = Reward(
    "algorithm-3",
    (
        *_OUTCOME_WEIGHTS,
        TermWeight("forward_lost", -FULL_FORWARD),
        TermWeight("forward", FULL_FORWARD, at_end=False),
    ),
)
"""Tutorial 2 (section 5.2.2.5)."""

PROGRESS = Reward(
    "progress",
    (
        TermWeight("progress", 1.0),
        TermWeight("elapsed", -0.01),
        TermWeight("collided", -2.0),
        TermWeight("reached", 2.0),
    ),
    is_small=True,
)
"""Ours, for one robot: every metre counts. Nothing in it depends on a clock that the agent cannot see."""

SIDE_BY_SIDE = Reward(
    "side-by-side",
    (
        TermWeight("progress", 1.0),
        TermWeight("elapsed", -0.07),
        TermWeight("adjacent", 0.063),
        TermWeight("abreast", 0.007),
        TermWeight("collided", -2.0),
        TermWeight("reached", 2.0),
    ),
    is_small=True,
)
"""Ours, for two. Side by side a step costs nothing, but never earns anything: else the pair would stand still side by
side to the end."""

REWARDS: Mapping[str, Reward] = MappingProxyType(
    {
        reward.name: reward
        for reward in (
            ALGORITHM_1,
            ALGORITHM_1_AS_RUN,
            ALGORITHM_1_TARGET,
            ALGORITHM_2,
            ALGORITHM_2_STOPPING,
            ALGORITHM_2_AS_RUN,
            ALGORITHM_2_STOPPING_AS_RUN,
            ALGORITHM_3,
            PROGRESS,
            SIDE_BY_SIDE,
        )
    }
)
