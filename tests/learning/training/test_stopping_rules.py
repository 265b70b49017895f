from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from kit.learning.training.presets import KIT_PPO_HALLWAY
from kit.learning.training.stopping_rules import (
    CaseCount,
    CaseCounts,
    StoppingMemory,
    TrainThenTest,
    TrainUntilGoal,
    TrainUntilSure,
    success_rate,
    worst_share,
)


class Tries:
    """A test with made-up outcomes; each call takes the next shares, or the last ones again."""

    def __init__(self, *shares: tuple[float, ...]) -> None:
        self._shares = list(shares)
        self.cases = len(shares[0])
        self.sizes: list[int] = []

    def __call__(self, episodes: int) -> CaseCounts:
        each = -(-episodes // self.cases)
        self.sizes.append(each)
        shares = self._shares.pop(0) if len(self._shares) > 1 else self._shares[0]
        return {f"case {i}": CaseCount(round(share * each), each) for i, share in enumerate(shares)}


class Coins:
    """A test whose episodes succeed by chance."""

    def __init__(self, seed: int, *shares: float) -> None:
        self._chance, self._shares, self.cases = np.random.default_rng(seed), shares, len(shares)
        self.episodes = 0

    def __call__(self, episodes: int) -> CaseCounts:
        each = -(-episodes // self.cases)
        self.episodes += each
        drawn = self._chance.binomial(each, self._shares).tolist()
        return {str(number): CaseCount(reached, each) for number, reached in enumerate(drawn)}


def test_the_first_goes_on_whatever_happens_and_keeps_the_newest() -> None:
    strategy = TrainThenTest(test_interval=10)
    for shares in ((1.0, 1.0), (0.1, 0.1)):
        decision = strategy.evaluate(10, StoppingMemory(), Tries(shares))
        assert decision.is_best
        assert not decision.stop
        assert not decision.restore_best


def test_the_second_stops_at_the_first_good_test() -> None:
    strategy = TrainUntilGoal(test_interval=10, episodes=20, goal=0.8)
    decision = strategy.evaluate(10, StoppingMemory(), Tries((0.7, 0.7)))
    assert not decision.stop
    decision = strategy.evaluate(20, decision.memory, Tries((1.0, 0.6)))
    assert decision.stop
    assert decision.is_best
    assert "0.80" in decision.reason


def test_the_second_remembers_the_best() -> None:
    strategy = TrainUntilGoal(test_interval=10)
    memory = strategy.evaluate(10, StoppingMemory(), Tries((0.7, 0.7))).memory
    worse = strategy.evaluate(20, memory, Tries((0.5, 0.5)))
    assert not worse.is_best
    assert worse.memory.best_steps == 10
    assert strategy.evaluate(30, worse.memory, Tries((0.7, 0.72))).is_best


SURE = TrainUntilSure(test_interval=10, goal=0.95, screening_episodes=40, confirming_episodes=500)


def test_a_pooled_accuracy_does_not_hide_a_bad_case() -> None:
    tries = Tries((1.0, 1.0, 0.5))
    assert not SURE.evaluate(10, StoppingMemory(), tries).stop
    assert tries.sizes == [40]


def test_a_good_short_test_is_confirmed_on_new_episodes() -> None:
    tries = Tries((1.0, 1.0), (0.996, 0.992))
    decision = SURE.evaluate(10, StoppingMemory(), tries)
    assert decision.stop
    assert decision.is_best
    assert tries.sizes == [40, 250, 250]
    assert success_rate(decision.counts) == pytest.approx(0.994)


def test_a_look_decides_where_the_goal_is_out_of_reach() -> None:
    rule = replace(SURE, first_episodes=20)
    far = Tries((1.0, 0.85))  # three failures of 20, where two of 40 are allowed
    decision = rule.evaluate(10, StoppingMemory(), far)
    assert far.sizes == [20]
    assert success_rate(decision.counts) == pytest.approx(0.925)
    near = Tries((1.0, 0.9), (1.0, 1.0), (0.998, 0.996))
    assert rule.evaluate(10, StoppingMemory(), near).stop
    assert near.sizes == [20, 40, 250, 250], "what is looked at does not count in the test"


def test_luck_in_the_short_test_is_not_enough() -> None:
    decision = SURE.evaluate(10, StoppingMemory(), Tries((1.0, 1.0), (0.96, 0.96)))
    assert not decision.stop
    assert decision.memory.confirmations == 1


def test_trying_often_makes_it_harder() -> None:
    shares = (0.974, 0.974)
    assert SURE.evaluate(10, StoppingMemory(), Tries((1.0, 1.0), shares)).stop
    assert not SURE.evaluate(10, StoppingMemory(confirmations=50), Tries((1.0, 1.0), shares)).stop


def test_a_test_that_leaves_it_open_goes_on() -> None:
    rule = replace(SURE, most_confirming_episodes=3000)
    tries = Tries((1.0, 1.0), (0.965, 0.965))
    decision = rule.evaluate(10, StoppingMemory(), tries)
    assert decision.stop
    assert tries.sizes == [40, *[250] * 8], "its first 500 episodes leave it open"
    assert decision.memory.confirmations == 2
    bad = Tries((1.0, 1.0), (0.94, 1.0))
    assert not rule.evaluate(10, StoppingMemory(), bad).stop
    assert bad.sizes == [40, 250, 250]
    never = Tries((1.0, 1.0), (0.956, 0.956))
    assert not rule.evaluate(10, StoppingMemory(), never).stop
    assert 2000 < sum(never.sizes[1:]) <= 3000


def test_a_long_test_ends_when_it_is_lost() -> None:
    lost = Tries((1.0, 1.0), (0.9, 1.0))
    assert not SURE.evaluate(10, StoppingMemory(), lost).stop
    assert lost.sizes == [40, 250]
    pair = replace(SURE, use_all_steps=True)  # there a long test ranks policies
    whole = Tries((1.0, 1.0), (0.97, 1.0))
    memory = pair.evaluate(10, StoppingMemory(), whole).memory
    assert whole.sizes == [40, 250, 250]
    worse = Tries((1.0, 1.0), (0.9, 1.0))  # it cannot become the best
    decision = pair.evaluate(20, memory, worse)
    assert worse.sizes == [40, 250]
    assert not decision.is_best
    better = Tries((1.0, 1.0), (0.99, 1.0))
    assert pair.evaluate(20, memory, better).is_best
    assert better.sizes == [40, 250, 250]


def test_a_test_that_ends_early_decides_as_a_whole_one() -> None:
    class Whole(TrainUntilSure):
        def _is_lost(self, counts: CaseCounts, attempts: Mapping[int, int], memory: StoppingMemory) -> bool:
            return False

    stops = []
    spent = {"early": 0, "whole": 0}
    for seed in range(200):
        shares = np.random.default_rng(seed).uniform(0.94, 1.0, 3).tolist()
        rule = replace(SURE, most_confirming_episodes=3000)
        early, whole = Coins(seed, *shares), Coins(seed, *shares)
        memory = StoppingMemory(confirmations=seed % 4)
        decision = rule.evaluate(10, memory, early)
        assert (
            decision.stop
            == Whole(test_interval=10, most_confirming_episodes=3000).evaluate(10, memory, whole).stop
        )
        stops.append(decision.stop)
        spent["early"] += early.episodes
        spent["whole"] += whole.episodes
    assert 20 < sum(stops) < 180
    assert spent["early"] < spent["whole"]


def test_a_hallway_policy_still_passes_after_many_attempts() -> None:
    rule, shares = KIT_PPO_HALLWAY.stopping_rule, (0.99,) * 15
    assert rule.evaluate(10, StoppingMemory(confirmations=9), Tries(*[shares] * 3)).stop
    assert isinstance(rule, TrainUntilSure)  # a smaller test would drive it on to the cap of steps
    few = replace(rule, confirming_episodes=500, most_confirming_episodes=500)
    assert not few.evaluate(10, StoppingMemory(confirmations=9), Tries(shares, shares)).stop


def test_a_mediocre_policy_is_all_but_never_passed() -> None:
    """True success 0.93 in both cases, looked at 60 times: the seed's rule with a goal of 0.95 passes it always."""
    chance = Coins(5, 0.93, 0.93)

    def passes(strategy: TrainUntilSure | TrainUntilGoal) -> bool:
        memory = StoppingMemory()
        for steps in range(60):
            decision = strategy.evaluate(steps, memory, chance)
            if decision.stop:
                return True
            memory = decision.memory
        return False

    assert sum(passes(SURE) for _ in range(50)) == 0
    assert sum(passes(TrainUntilGoal(test_interval=1, episodes=20, goal=0.95)) for _ in range(50)) == 50


def test_the_longer_test_counts_more_than_the_luckier() -> None:
    memory = SURE.evaluate(10, StoppingMemory(), Tries((1.0, 1.0), (0.96, 0.97))).memory
    assert not SURE.evaluate(20, memory, Tries((1.0, 1.0), (0.9, 0.9))).is_best
    assert not replace(SURE, goal=1.1).evaluate(20, memory, Tries((1.0, 1.0))).is_best


def test_what_was_forgotten_is_fetched_back_a_few_times() -> None:
    memory = SURE.evaluate(10, StoppingMemory(), Tries((0.9, 0.9))).memory
    for _ in range(SURE.patience):
        decision = SURE.evaluate(20, memory, Tries((0.1, 0.2)))
        assert decision.restore_best
        assert "to the policy of step 10" in decision.reason
        assert not decision.is_best
        memory = decision.memory
    assert not SURE.evaluate(30, memory, Tries((0.1, 0.2))).restore_best


def test_a_small_setback_is_left_alone() -> None:
    memory = SURE.evaluate(10, StoppingMemory(), Tries((0.9, 0.9))).memory
    assert not SURE.evaluate(20, memory, Tries((0.7, 0.7))).restore_best


def test_side_by_side_decides_among_those_that_arrive() -> None:
    def pair(share: float, adjacency: float) -> CaseCounts:
        return {"straight": CaseCount(round(500 * share), 500, adjacency)}

    class Once:
        cases = 1

        def __init__(self, counts: CaseCounts) -> None:
            self._counts = counts

        def __call__(self, episodes: int) -> CaseCounts:
            return self._counts

    strategy = replace(SURE, use_all_steps=True, sufficient_share=0.95)
    first = strategy.evaluate(10, StoppingMemory(), Once(pair(1.0, 0.6)))
    assert not first.stop
    second = strategy.evaluate(20, first.memory, Once(pair(0.99, 0.9)))
    assert second.is_best
    third = strategy.evaluate(30, second.memory, Once(pair(0.9, 0.99)))
    assert not third.is_best


def test_nothing_tried_is_nothing_reached() -> None:
    assert success_rate({}) == worst_share({}) == CaseCount(0, 0).share == 0.0
