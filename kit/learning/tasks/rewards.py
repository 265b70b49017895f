"""The rewards that come with the kit: the dissertation's, as its text says and as its code ran, and ours."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from kit.learning.tasks.reward import Reward, TermWeight

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
        TermWeight("elapsed", -0.14),
        TermWeight("adjacent", 0.126),
        TermWeight("abreast", 0.014),
        TermWeight("collided", -6.0),
        TermWeight("reached", 3.0),
    ),
    is_small=True,
)
"""Ours, for two. Side by side a step costs nothing, but never earns anything: else the pair would stand still side by
side to the end. A collision costs 6: at 2, two that are side by side still touched in one episode of a hundred."""

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
