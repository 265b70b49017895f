"""Rewards: every term for one world and for many, the three algorithms against their text, and ours."""

from __future__ import annotations

import numpy as np
import pytest

from kit.learning.tasks.actions import Move
from kit.learning.tasks.reward import Reward, TermWeight, UnknownRewardTerm
from kit.learning.tasks.reward_terms import TERMS
from kit.learning.tasks.rewards import (
    ALGORITHM_1,
    ALGORITHM_1_AS_RUN,
    ALGORITHM_2,
    ALGORITHM_2_AS_RUN,
    ALGORITHM_2_STOPPING_AS_RUN,
    ALGORITHM_3,
    PROGRESS,
    REWARDS,
    SIDE_BY_SIDE,
)
from kit.learning.tasks.transition import Transition
from tests.cases import every_case
from tests.learning.worlds import TASKS, sampled

TURNING = (Move.LEFT, Move.RIGHT)
CURVES = (Move.FORWARD_LEFT, Move.FORWARD_RIGHT)
OPPOSITE = {
    (Move.FORWARD, Move.BACK),
    (Move.BACK, Move.FORWARD),
    (Move.LEFT, Move.RIGHT),
    (Move.RIGHT, Move.LEFT),
}


def some(transition: Transition, count: int = 400) -> list[Transition]:
    """Single worlds out of many."""
    chance = np.random.default_rng(1)
    return [transition.select(int(i)) for i in chance.integers(len(transition.step), size=count)]


@every_case("task", TASKS)
@every_case("term", TERMS)
def test_a_term_is_the_same_for_one_world_and_for_many(task: str, term: str) -> None:
    many = sampled(task)
    values = np.asarray(TERMS[term](many))
    assert values.shape == many.step.shape
    for i in np.random.default_rng(2).integers(len(values), size=200).tolist():
        assert np.asarray(TERMS[term](many.select(i))) == values[i]


@pytest.mark.parametrize("task", TASKS)
@pytest.mark.parametrize("name", REWARDS)
def test_a_reward_is_the_sum_of_its_terms(task: str, name: str) -> None:
    many = sampled(task)
    terms = REWARDS[name].terms(many)
    assert list(terms) == [weight.term for weight in REWARDS[name].weights]
    assert np.asarray(REWARDS[name](many)) == pytest.approx(np.sum(list(terms.values()), axis=0))
    assert np.isfinite(REWARDS[name](many)).all()


@pytest.mark.parametrize("task", TASKS)
def test_the_samples_show_every_ending(task: str) -> None:
    many = sampled(task)
    for ending in (many.collided, many.reached, many.timed_out):
        assert ending.any()
    assert (many.ended == (many.collided | many.reached | many.timed_out)).all()
    assert not (many.collided & many.reached).any()


# The dissertation's pseudo-code, once more, one world at a time


def of_moves(t: Transition, k: int, basic: float) -> float:
    move = Move(int(t.move[k]))
    if move is Move.FORWARD:
        return basic
    if move in CURVES:
        return 0.5 * basic
    if move in TURNING:
        return -2 * basic if t.front[k] > 0.1 else 0.5 * basic
    return -5 * basic


def of_habits(t: Transition, k: int, basic: float) -> float:
    earned = 0.0
    if t.step > 1 and (Move(int(t.previous_move[k])), Move(int(t.move[k]))) in OPPOSITE:
        earned -= 5 * basic
    earned -= 75 * float(t.full_turns[k])
    earned += 2 * (float(t.front[k]) - 0.5) * basic
    if t.front[k] > 0.5:
        earned += (float(t.front_left[k]) - 0.5) * (float(t.front_right[k]) - 0.5) * basic
    return earned


def of_endings(t: Transition, basic: float) -> float | None:
    """None while the episode goes on."""
    if t.collided:
        return -200.0
    if t.reached:
        return 400.0 + t.max_steps - float(t.step)
    if t.step >= t.max_steps:
        return -(300.0 + basic * float(t.forward_steps.sum()))
    return None


@pytest.mark.parametrize("task", ["turn", "hallway"])
def test_algorithm_1(task: str) -> None:
    for t in some(sampled(task)):
        basic = 300 / t.max_steps
        ending = of_endings(t, basic)
        expected = (of_moves(t, 0, basic) if ending is None else ending) + of_habits(t, 0, basic)
        assert float(ALGORITHM_1(t)) == pytest.approx(expected, abs=1e-4)


def of_habits_as_run(t: Transition, k: int, basic: float, *, left: float) -> float:
    """As the code has them: a whole turn is charged once, the diagonals are added; ``left`` counts the left one."""
    earned = 0.0
    if t.step > 1 and (Move(int(t.previous_move[k])), Move(int(t.move[k]))) in OPPOSITE:
        earned -= 5 * basic
    if t.full_turns[k] > t.previous_full_turns[k]:
        earned -= 75 * float(t.full_turns[k])
    earned += 2 * (float(t.front[k]) - 0.5) * basic
    if t.front[k] > 0.5:
        sides = left * (float(t.front_left[k]) - 0.5) + (2 - left) * (float(t.front_right[k]) - 0.5)
        earned += sides * basic
    return earned


def test_algorithm_1_as_run() -> None:
    for t in some(sampled("hallway")):
        basic = 300 / t.max_steps
        ending = of_endings(t, basic)
        expected = of_moves(t, 0, basic) if ending is None else ending
        expected += of_habits_as_run(t, 0, basic, left=0.0)
        assert float(ALGORITHM_1_AS_RUN(t)) == pytest.approx(expected, abs=1e-4)


@pytest.mark.parametrize(
    "reward", [ALGORITHM_2_AS_RUN, ALGORITHM_2_STOPPING_AS_RUN], ids=lambda each: each.name
)
def test_algorithm_2_as_run(reward: Reward) -> None:
    for t in some(sampled("wheelchairs")):
        basic, n = 300 / t.max_steps, float(t.step)
        expected = 10.0 * bool(t.adjacent)
        if t.collided:
            expected -= 400.0
        elif t.reached:
            expected += 800.0 + 300.0 - n * 200.0 / 300.0
        elif t.step >= t.max_steps:
            expected -= 600.0 + basic * float(t.forward_steps.sum())
        expected += 100.0 * bool((t.in_target & ~t.was_in_target).any())
        expected -= 100.0 * bool((t.was_in_target & ~t.in_target).any())
        for k in range(2):
            if reward is ALGORITHM_2_STOPPING_AS_RUN and t.in_target[k]:
                expected += 1.0 if Move(int(t.move[k])) is Move.STOP else -1.0
            else:
                expected += of_moves(t, k, basic)
            expected += of_habits_as_run(t, k, basic, left=1.0 if k == 0 else 0.0)
        assert float(reward(t)) == pytest.approx(expected, abs=1e-3)


def test_algorithm_2() -> None:
    for t in some(sampled("wheelchairs")):
        basic = 300 / t.max_steps
        expected = of_endings(t, basic) or 0.0
        for k in range(2):
            if t.in_target[k] != t.was_in_target[k]:
                expected += 100.0 if t.in_target[k] else -100.0
            expected += of_moves(t, k, basic) + of_habits(t, k, basic)
        expected += 10.0 * bool(t.adjacent)
        assert float(ALGORITHM_2(t)) == pytest.approx(expected, abs=1e-3)


def test_algorithm_3() -> None:
    for t in some(sampled("turn")):
        basic = 300 / t.max_steps
        ending = of_endings(t, basic)
        going = basic if Move(int(t.move[0])) is Move.FORWARD else 0.0
        assert float(ALGORITHM_3(t)) == pytest.approx(going if ending is None else ending)


# Ours


def test_progress_adds_up_to_the_way_driven() -> None:
    many = sampled("hallway")
    assert TERMS["progress"](many) == pytest.approx((many.previous_to_go - many.to_go)[:, 0])


def test_standing_still_side_by_side_earns_nothing() -> None:
    """Else the pair would stand there to the end."""
    best = sum(w.value for w in SIDE_BY_SIDE.weights if w.term in ("elapsed", "adjacent", "abreast"))
    assert best == pytest.approx(0.0)


def test_nothing_of_ours_depends_on_the_clock() -> None:
    for reward in (PROGRESS, SIDE_BY_SIDE):
        assert not {w.term for w in reward.weights} & {"time_left", "timed_out", "forward_lost"}


def test_a_weight_that_does_not_count_at_the_end() -> None:
    many = sampled("hallway")
    (value,) = Reward("going", (TermWeight("elapsed", 3.0, at_end=False),), scale=0.5).terms(many).values()
    assert value == pytest.approx(np.where(many.ended, 0.0, 1.5))


def test_an_unknown_term_is_refused_with_the_nearest_name() -> None:
    with pytest.raises(UnknownRewardTerm, match="progress"):
        TermWeight("progres", 1.0)
