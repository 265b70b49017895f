"""Rewards: a sum of named terms, weighed in one place; the dissertation's three, and ours.

A term is a function of a transition. It is plain arithmetic on arrays: the same function serves one world
(fields of shape ``()``) and many (``(n,)``). What belongs to a robot has one more axis, the robots, over which a
term sums.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TypeAlias

import numpy as np

from kit.learning.environment.actions import Move
from kit.learning.environment.transition import Array, Transition
from kit.plain_text import quoted, suggestion

Term: TypeAlias = Callable[[Transition], Array]
"""(...) what a transition earns by one rule, before it is weighed."""

RewardFunction: TypeAlias = Callable[[Transition], Array]
"""A student's reward: a transition of ``n`` worlds -> (n,) rewards."""


def _table(**values: float) -> Array:
    """One value for each move, 0 for those not named."""
    return np.array([values.get(move.name, 0.0) for move in Move])


def _sum(each: Array) -> Array:
    """(...) of the robots (..., R). numpy's own sum takes ten times as long over so few."""
    return each[..., 0] if each.shape[-1] == 1 else each[..., 0] + each[..., 1]


FORWARD_SHARE = _table(FORWARD=1.0, FORWARD_LEFT=0.5, FORWARD_RIGHT=0.5)
IDLE = _table(STOP=1.0, BACK=1.0)
TURNING = _table(LEFT=1.0, RIGHT=1.0)
UNDOES = np.zeros((len(Move) + 1, len(Move)))
"""(previous move, move): 1 where the second takes back the first; the row -1 is for no move before."""
for _one, _other in ((Move.FORWARD, Move.BACK), (Move.LEFT, Move.RIGHT)):
    UNDOES[_one, _other] = UNDOES[_other, _one] = 1.0
TIGHT = 0.1
"""With less room ahead than this [m] a robot has to turn."""
ROOM = 0.5
"""With more than this [m] ahead it may go on."""


def collided(t: Transition) -> Array:
    """1 where a robot met a wall or the other robot."""
    return 1.0 * t.collided


def reached(t: Transition) -> Array:
    """1 where every robot is in the target."""
    return 1.0 * t.reached


def time_left(t: Transition) -> Array:
    """The steps that were left when the target was reached."""
    return t.reached * (t.max_steps - t.step)


def timed_out(t: Transition) -> Array:
    """1 where time ran out."""
    return 1.0 * t.timed_out


def forward_lost(t: Transition) -> Array:
    """The share of all steps that led forward, where time ran out: what they earned is taken back."""
    return t.timed_out * _sum(t.forward_steps) / t.max_steps


def elapsed(t: Transition) -> Array:
    """1 in every step."""
    return np.ones(np.shape(t.step))


def forward(t: Transition) -> Array:
    """1 for each robot that moves forward, half of it along a curve; as a share of all steps."""
    return _sum(FORWARD_SHARE[t.move]) / t.max_steps


def idle(t: Transition) -> Array:
    """1 for each robot that stops or goes back; as a share of all steps."""
    return _sum(IDLE[t.move]) / t.max_steps


def turning_with_room(t: Transition) -> Array:
    """1 for each robot that turns on the spot with room ahead; as a share of all steps."""
    return _sum(TURNING[t.move] * (t.front > TIGHT)) / t.max_steps


def turning_in_need(t: Transition) -> Array:
    """1 for each robot that turns on the spot before a wall; as a share of all steps."""
    return _sum(TURNING[t.move] * (t.front <= TIGHT)) / t.max_steps


def undoing(t: Transition) -> Array:
    """1 for each robot that takes back its last move; as a share of all steps."""
    return _sum(UNDOES[t.previous_move, t.move]) / t.max_steps


def full_turns(t: Transition) -> Array:
    """The whole turns that each robot has made to the same side, in every step anew."""
    return 1.0 * _sum(t.full_turns)


def room_ahead(t: Transition) -> Array:
    """Metres of room ahead of each robot, beyond half a metre; as a share of all steps."""
    return _sum(t.front - ROOM) / t.max_steps


def room_aside(t: Transition) -> Array:
    """The product of the room to the left and to the right of ahead, where there is room ahead."""
    both = (t.front_left - ROOM) * (t.front_right - ROOM)
    return _sum((t.front > ROOM) * both) / t.max_steps


def entering(t: Transition) -> Array:
    """1 for each robot that enters the target."""
    return 1.0 * _sum(t.in_target & ~t.was_in_target)


def leaving(t: Transition) -> Array:
    """1 for each robot that leaves the target."""
    return 1.0 * _sum(t.was_in_target & ~t.in_target)


def stopping_there(t: Transition) -> Array:
    """For each robot in the target: 1 if it stops, -1 if it does anything else."""
    return _sum(t.in_target * np.where(t.move == Move.STOP, 1.0, -1.0))


def adjacent(t: Transition) -> Array:
    """1 where two robots are side by side, as their rays tell."""
    return 1.0 * t.adjacent


def abreast(t: Transition) -> Array:
    """How well two robots stand side by side by their poses, 0 to 1."""
    return t.abreast


def progress(t: Transition) -> Array:
    """Metres along the way to the target since the last step, the mean of the robots."""
    return _sum(t.previous_to_go - t.to_go) / t.robots


def approaching(t: Transition) -> Array:
    """For each robot: 1 if it came nearer to the target as the crow flies, -1 if farther; as a share of all steps."""
    return _sum(np.sign(t.previous_distance - t.distance)) / t.max_steps


def facing(t: Transition) -> Array:
    """For each robot: 1 if it turned towards the target, -1 if away; as a share of all steps."""
    return _sum(np.sign(np.abs(t.previous_bearing) - np.abs(t.bearing))) / t.max_steps


TERMS: Mapping[str, Term] = MappingProxyType(
    {
        term.__name__: term
        for term in (
            *(
                collided,
                reached,
                time_left,
                timed_out,
                forward_lost,
                elapsed,
                forward,
                idle,
                turning_with_room,
            ),
            *(
                turning_in_need,
                undoing,
                full_turns,
                room_ahead,
                room_aside,
                entering,
                leaving,
                stopping_there,
            ),
            *(adjacent, abreast, progress, approaching, facing),
        )
    }
)


class UnknownTerm(LookupError):
    """No term has that name; the message offers the nearest one."""


@dataclass(frozen=True, slots=True)
class Weight:
    """How much a term counts. Raises UnknownTerm."""

    term: str
    """A name in ``TERMS``."""
    value: float
    at_end: bool = True
    """Whether it also counts in the step that ends the episode."""

    def __post_init__(self) -> None:
        if self.term not in TERMS:
            raise UnknownTerm(f"there is no reward term {quoted(self.term)}: {suggestion(self.term, TERMS)}")


@dataclass(frozen=True, slots=True)
class Reward:
    """A weighed sum of terms."""

    name: str
    weights: tuple[Weight, ...]
    scale: float = 1.0
    """Of the whole sum."""
    small: bool = False
    """Whether an episode earns a few units as it stands; the dissertation's rewards come to hundreds."""

    def terms(self, transition: Transition) -> dict[str, Array]:
        """(...) each: what every term adds to the reward, weight and scale included."""
        going = None if all(weight.at_end for weight in self.weights) else ~transition.ended
        found = {}
        for weight in self.weights:
            value = (self.scale * weight.value) * TERMS[weight.term](transition)
            found[weight.term] = value if weight.at_end or going is None else value * going
        return found

    def __call__(self, transition: Transition) -> Array:
        """(...) the reward."""
        return np.asarray(sum(self.terms(transition).values()))


SCALE = 0.01
"""What makes the dissertation's rewards small: a value network learns those at once."""
ALL_STEPS = 300.0
"""What moving forward in every step of an episode earns: the dissertation's ``basic_reward`` is this, per step."""

_ENDINGS = (
    Weight("collided", -200.0),
    Weight("reached", 400.0),
    Weight("time_left", 1.0),
    Weight("timed_out", -300.0),
)
_MOVES = (
    Weight("forward", ALL_STEPS, at_end=False),
    Weight("idle", -5 * ALL_STEPS, at_end=False),
    Weight("turning_with_room", -2 * ALL_STEPS, at_end=False),
    Weight("turning_in_need", 0.5 * ALL_STEPS, at_end=False),
)
_HABITS = (
    Weight("undoing", -5 * ALL_STEPS),
    Weight("full_turns", -75.0),
    Weight("room_ahead", 2 * ALL_STEPS),
    Weight("room_aside", ALL_STEPS),
)

ALGORITHM_1 = Reward("algorithm-1", (*_ENDINGS, Weight("forward_lost", -ALL_STEPS), *_MOVES, *_HABITS))
"""One robot in the hallways (dissertation, section 3.1.2.3)."""

ALGORITHM_1_TARGET = Reward(
    "algorithm-1-target",
    (*ALGORITHM_1.weights, Weight("approaching", ALL_STEPS), Weight("facing", ALL_STEPS)),
)
"""The same where distance and rotation to the target are known (section 3.2.2, which gives no amounts)."""

ALGORITHM_2 = Reward(
    "algorithm-2",
    (
        *_ENDINGS,
        Weight("forward_lost", -ALL_STEPS),
        *(Weight(weight.term, weight.value) for weight in _MOVES),
        *_HABITS,
        *(Weight("entering", 100.0), Weight("leaving", -100.0), Weight("adjacent", 10.0)),
    ),
)
"""Two wheelchairs (section 4.1.4.2). Its line 18 adds the whole sum so far to what a timeout takes back; here, as in
algorithm 1, it is what moving forward earned."""

ALGORITHM_2_STOPPING = Reward("algorithm-2-stopping", (*ALGORITHM_2.weights, Weight("stopping_there", 10.0)))
"""The same where stopping in the target is rewarded and anything else there charged (section 4.2.1.1, which gives no
amount; this one outweighs what stopping costs)."""

ALGORITHM_3 = Reward(
    "algorithm-3", (*_ENDINGS, Weight("forward_lost", -ALL_STEPS), Weight("forward", ALL_STEPS, at_end=False))
)
"""Tutorial 2 (section 5.2.2.5)."""

PROGRESS = Reward(
    "progress",
    (Weight("progress", 1.0), Weight("elapsed", -0.01), Weight("collided", -2.0), Weight("reached", 2.0)),
    small=True,
)
"""Ours, for one robot: every metre counts. Nothing in it depends on a clock that the agent cannot see."""

SIDE_BY_SIDE = Reward(
    "side-by-side",
    (
        Weight("progress", 1.0),
        Weight("elapsed", -0.07),
        Weight("adjacent", 0.063),
        Weight("abreast", 0.007),
        Weight("collided", -2.0),
        Weight("reached", 2.0),
    ),
    small=True,
)
"""Ours, for two. Side by side a step costs nothing, but never earns anything: else the pair would stand still side by
side to the end."""

REWARDS: Mapping[str, Reward] = MappingProxyType(
    {
        reward.name: reward
        for reward in (
            ALGORITHM_1,
            ALGORITHM_1_TARGET,
            ALGORITHM_2,
            ALGORITHM_2_STOPPING,
            ALGORITHM_3,
            PROGRESS,
            SIDE_BY_SIDE,
        )
    }
)
