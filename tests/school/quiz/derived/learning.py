"""What environments, rewards and updates do, found out by stepping, earning and updating."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from kit.learning.environment.env import TaskEnv, TurnEnv
from kit.learning.policies.confidence_intervals import lower_bound
from kit.learning.tasks.catalogue import TURN
from kit.learning.tasks.reward import Reward, TermWeight
from kit.learning.tasks.rewards import ALGORITHM_3
from kit.learning.tasks.transition import EpisodeState, Transition
from kit.learning.training.algorithm_settings import LinearSchedule
from kit.learning.training.tabular import QLearning, Sarsa, TableLearner
from kit.school.quiz.items import QuizItem
from tests.learning.worlds import sampled
from tests.school.quiz.derived.finding import Derivation, Finding, nearest

LEFT, FORWARD = 1, 0


def _steps(env: TaskEnv, action: int) -> Iterator[tuple[Any, ...]]:
    """An episode of always the same."""
    env.reset(seed=0)
    while True:
        told = env.step(np.int64(action))
        yield told
        if told[2] or told[3]:
            return


def _ends() -> dict[str, tuple[int, bool, bool]]:
    """Episodes that end in each way: steps, terminated, truncated."""
    near = replace(TURN, target_radius=3.0)
    found = {}
    for env, action in ((TurnEnv(), FORWARD), (TurnEnv(), LEFT), (TaskEnv(near), LEFT)):
        for count, (_, _, terminated, truncated, info) in enumerate(_steps(env, action), 1):
            if terminated or truncated:
                found[info["outcome"]] = (count, terminated, truncated)
    assert set(found) == {"collided", "timed out", "reached"}
    return found


def action_space_owner(item: QuizItem, folder: Path) -> Finding:
    """No agent is there, and the reward is another one; the actions are the same."""
    plain, paid = TurnEnv(), TurnEnv(reward=lambda transition: np.zeros(len(transition.step)))
    assert plain.action_space == paid.action_space
    owner = "environment" if plain.action_space.n == len(TURN.actions.moves) else "elsewhere"
    return Finding(owner, {"The agent": "agent", "The reward": "reward", "The environment": "environment"})


def terminal_outcomes(item: QuizItem, folder: Path) -> Finding:
    outcomes = frozenset(how for how, (_, terminated, _) in _ends().items() if terminated)
    return Finding(
        outcomes,
        {
            "The episode is over, and reset comes next": frozenset({"reached", "collided"}),
            "The agent has reached what it was to reach": frozenset({"reached"}),
            "The agent has failed and has to try again": frozenset({"collided"}),
        },
    )


def episode_lengths(item: QuizItem, folder: Path) -> Finding:
    lengths = {steps for steps, _, _ in _ends().values()}
    return Finding(
        "differ" if len(lengths) > 1 else "max_steps" if lengths == {TURN.max_steps} else "made equal",
        {
            "They are equal: max_steps": "max_steps",
            "They may well differ": "differ",
            "They must be made equal to learn": "made equal",
        },
    )


def step_values(item: QuizItem, folder: Path) -> Finding:
    return nearest(item, len(next(_steps(TurnEnv(), LEFT))), 0)


def timeout_flags(item: QuizItem, folder: Path) -> Finding:
    steps, terminated, truncated = _ends()["timed out"]
    assert steps == 200
    found = f"terminated {terminated}, truncated {truncated}"
    return Finding(found, {option.text: option.text for option in item.options})


def observation_size(item: QuizItem, folder: Path) -> Finding:
    seen, _ = TurnEnv().reset(seed=0)
    return nearest(item, len(seen), 0)


def discounted_return(item: QuizItem, folder: Path) -> Finding:
    return nearest(item, _returned((1, 1, 8), 0.5), 1e-9)


def _returned(rewards: Sequence[float], discount: float) -> float:
    return sum(reward * discount**step for step, reward in enumerate(rewards))


# Rewards


def _transition(before: Mapping[str, object] | None = None, **after: object) -> Transition:
    """One of one world, in which nothing happens but what is said of the states before and after it."""
    one = sampled("turn").select(0)
    still = {"hit": np.array([False]), "in_target": np.array([False]), "step": np.array(10)}
    states = (
        replace(EpisodeState.of(state), **{**still, **changes})
        for state, changes in ((one.before, before or {}), (one.after, after))
    )
    return Transition(*states, max_steps=200)


def entering_loop(item: QuizItem, folder: Path) -> Finding:
    """What each behaviour earns in 200 steps, by the kit's own term."""
    reward = Reward("entering", (TermWeight("entering", 100.0),))

    def earned(inside: Sequence[bool]) -> float:
        return sum(
            float(reward(_transition({"in_target": np.array([before])}, in_target=np.array([after]))))
            for before, after in pairwise([False, *inside])
        )

    behaviours = {
        "To enter and stay inside": [True] * 200,
        "To go in and out all the time": [True, False] * 100,
        "To come near and stay outside": [False] * 200,
    }
    returns = {text: earned(inside) for text, inside in behaviours.items()}
    return Finding(max(returns.values()), returns)


def reached_early(item: QuizItem, folder: Path) -> Finding:
    terms = ALGORITHM_3.terms(_transition(achieved=np.array(1.0), step=np.array(50)))
    return nearest(item, float(terms["reached"] + terms["time_left"]), 1e-6)


def round_trip(item: QuizItem, folder: Path) -> Finding:
    reward = Reward("progress", (TermWeight("progress", 1.0),))
    to_go = [3.0, 2.5, 2.0, 2.5, 3.0]
    earned = sum(
        float(reward(_transition({"to_go": np.array([before])}, to_go=np.array([after]))))
        for before, after in pairwise(to_go)
    )
    return Finding(
        int(np.sign(round(earned, 9))), {"Less than nothing": -1, "Nothing": 0, "More than nothing": 1}
    )


def crash_pays(item: QuizItem, folder: Path) -> Finding:
    returns = {
        "To crash into the wall at once": -1 * 2 - 10,
        "To drive to the target": -1 * 30,
        "To stand still to the end": -1 * 200,
    }
    for number in ("2 steps", "30 steps", "200"):
        assert number in item.question
    return Finding(max(returns.values()), returns)


def terms_in_info(item: QuizItem, folder: Path) -> Finding:
    seen, reward, _, _, info = next(_steps(TurnEnv(), FORWARD))
    assert math.isclose(sum(info["terms"].values()), reward, abs_tol=1e-6)
    places = {
        "In the reward that step() returns": reward,
        "In the observation it returns": seen,
        'In info, under "terms"': info["terms"],
    }
    return Finding(True, {text: isinstance(told, dict) for text, told in places.items()})


# Updates and tests


def _updated(
    kind: type[TableLearner], taken: int, reward: float, *, terminated: bool = False, truncated: bool = False
) -> float:
    """The value of state 0, action 0, after one of the kit's own updates towards state 1, whose actions are worth 10
    and 4."""
    learner = kind.__new__(kind)  # without the worlds, which an update does not need
    learner._settings = SimpleNamespace(gamma=0.9, rate=LinearSchedule(0.5, 0.5))  # type: ignore[assignment]  # all it reads
    learner._rate_factor = 1.0
    learner._values = np.array([[2.0, 0.0], [10.0, 4.0]])
    step: Any = SimpleNamespace(
        rewards=np.array([reward]), terminated=np.array([terminated]), truncated=np.array([truncated])
    )
    zero, one = np.array([0]), np.array([1])
    learner._update(zero, zero, step, one, np.array([taken]), 1.0)
    return float(learner._values[0, 0])


def q_update(item: QuizItem, folder: Path) -> Finding:
    return nearest(item, _updated(QLearning, 0, 1.0), 1e-9)


def sarsa_update(item: QuizItem, folder: Path) -> Finding:
    return nearest(item, _updated(Sarsa, 1, 1.0), 1e-9)


def terminal_update(item: QuizItem, folder: Path) -> Finding:
    return nearest(item, _updated(QLearning, 0, -10.0, terminated=True), 1e-9)


def timeout_update(item: QuizItem, folder: Path) -> Finding:
    """The future that an update has counted: value 2, rate 0.5, so new = 1 + (reward + 0.9 future) / 2."""
    future = (2 * (_updated(QLearning, 0, 1.0, truncated=True) - 1) - 1.0) / 0.9
    return Finding(
        round(future, 9),
        {
            "Zero, since the episode is over": 0.0,
            "What the agent thinks it is worth": 10.0,
            "The penalty for running out of time": -300.0,
        },
    )


def twenty_of_twenty(item: QuizItem, folder: Path) -> Finding:
    return nearest(item, lower_bound(20, 20), 0.01)


def lucky_test(item: QuizItem, folder: Path) -> Finding:
    """In per cent, exactly."""
    one = sum(math.comb(20, k) * 0.7**k * 0.3 ** (20 - k) for k in range(16, 21))
    assert any(
        option.text == f"About {100 * one:.0f} %" for option in item.options
    )  # the mistake's figure is right too
    return nearest(item, 100 * (1 - (1 - one) ** 10), 0.5)


LEARNING: dict[str, Derivation] = {
    "action-space-owner": action_space_owner,
    "terminal-outcomes": terminal_outcomes,
    "episode-lengths": episode_lengths,
    "step-values": step_values,
    "timeout-flags": timeout_flags,
    "observation-size": observation_size,
    "discounted-return": discounted_return,
    "entering-loop": entering_loop,
    "reached-early": reached_early,
    "round-trip": round_trip,
    "crash-pays": crash_pays,
    "terms-in-info": terms_in_info,
    "q-update": q_update,
    "sarsa-update": sarsa_update,
    "terminal-update": terminal_update,
    "timeout-update": timeout_update,
    "twenty-of-twenty": twenty_of_twenty,
    "lucky-test": lucky_test,
}
