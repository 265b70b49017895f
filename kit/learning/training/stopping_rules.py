"""Rules for when to test, when to stop, and which policy to keep: the dissertation's two strategies, and a statistically sound one.

A stopping rule evaluates the policy now and then, on episodes that it was not trained on. The dissertation stops at the first
test that goes well; with 20 episodes and many tests that is often luck. ``TrainUntilSure`` does not fall for it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Protocol, TypeAlias

from kit.learning.policies.confidence_intervals import ConfidenceInterval, lower_bound, wilson_interval

CONFIRMING_PARTS = 2
"""A long test's first look is at so many parts. In more parts, worlds wait for the longest episodes for longer than is won."""


@dataclass(frozen=True, slots=True)
class CaseCount:
    """Episodes of one case that were tried, and how many reached the target."""

    reached: int
    episodes: int
    adjacency: float = 0.0
    """Mean share of steps that two robots were side by side."""
    collided: int = 0
    reward: float = 0.0
    """Mean sum over an episode."""

    @property
    def share(self) -> float:
        return self.reached / self.episodes if self.episodes else 0.0

    def plus(self, other: CaseCount) -> CaseCount:
        """The counts of the episodes of both."""
        episodes = self.episodes + other.episodes
        weight = other.episodes / episodes if episodes else 0.0
        return CaseCount(
            self.reached + other.reached,
            episodes,
            self.adjacency + weight * (other.adjacency - self.adjacency),
            self.collided + other.collided,
            self.reward + weight * (other.reward - self.reward),
        )


NO_EPISODES = CaseCount(0, 0)

CaseCounts: TypeAlias = Mapping[str, CaseCount]
"""Counts by the case's name."""


class PolicyTest(Protocol):
    """Tries the present policy on episodes that neither training nor an earlier test has seen."""

    @property
    def cases(self) -> int:
        """How many cases there are."""

    def __call__(self, episodes: int) -> CaseCounts:
        """Tests at least this many episodes in total, the same number for each case."""


def success_rate(counts: CaseCounts) -> float:
    """The share of all episodes that reached the target."""
    episodes = sum(count.episodes for count in counts.values())
    return sum(count.reached for count in counts.values()) / episodes if episodes else 0.0


def worst_share(counts: CaseCounts) -> float:
    """The share in the case that goes worst."""
    return min((count.share for count in counts.values()), default=0.0)


@dataclass(frozen=True, slots=True)
class StoppingMemory:
    """A stopping rule's memory between evaluations; saved in every checkpoint."""

    best: tuple[float, ...] | None = None
    """Rank of the best policy; greater is better."""
    best_low: float = 0.0
    """Lower bound of that policy's accuracy."""
    best_steps: int = 0
    confirmations: int = 0
    returns: int = 0
    """How often training went back to the policy kept."""


@dataclass(frozen=True, slots=True)
class StoppingDecision:
    """A stopping rule's decision after an evaluation."""

    counts: CaseCounts
    """Counts of the decisive test."""
    memory: StoppingMemory
    is_best: bool
    """This policy is the best so far."""
    stop: bool = False
    restore_best: bool = False
    """Training goes on from the policy kept: this one has forgotten."""
    reason: str = ""


class StoppingRule(Protocol):
    """Decides when to evaluate, when to stop, and which policy to keep."""

    @property
    def test_interval(self) -> int:
        """Steps of training between two evaluations."""

    @property
    def greedy(self) -> bool:
        """Whether policies are tested by their best actions; else as they explore."""

    def evaluate(self, steps: int, memory: StoppingMemory, test: PolicyTest) -> StoppingDecision:
        """Evaluates the present policy after this many steps."""


def _worst_lower_bound(counts: CaseCounts) -> float:
    """Lower bound of the worst case's share: of two policies without a failure the one that was tested
    longer is the better one."""
    return min((lower_bound(count.reached, count.episodes) for count in counts.values()), default=0.0)


def _policy_rank(counts: CaseCounts, sufficient_share: float = 1.0) -> tuple[float, ...]:
    """The rank of a policy. The worst case counts first, up to ``sufficient_share``; then how much two robots are side by side;
    then all episodes."""
    beside = sum(count.adjacency for count in counts.values()) / max(1, len(counts))
    return min(_worst_lower_bound(counts), sufficient_share), beside, success_rate(counts)


def _with_best(
    counts: CaseCounts, steps: int, memory: StoppingMemory, sufficient_share: float = 1.0
) -> tuple[StoppingMemory, bool]:
    """The memory with this test in it, and whether this policy is the best so far. Ties go to the newer one."""
    mark = _policy_rank(counts, sufficient_share)
    if memory.best is not None and mark < memory.best:
        return memory, False
    low = _pooled_interval(counts).low
    return replace(memory, best=mark, best_low=low, best_steps=steps), True


def _pooled_interval(counts: CaseCounts) -> ConfidenceInterval:
    """The 99 % confidence interval of the true accuracy."""
    reached = sum(count.reached for count in counts.values())
    return wilson_interval(reached, sum(count.episodes for count in counts.values()), 0.99)


@dataclass(frozen=True, slots=True)
class TrainThenTest:
    """The dissertation's first strategy (section 3.1.4): train for all the steps there are, whatever tests say.

    Tested every so often nevertheless, as in its figures 3.5 to 3.8. The newest policy counts, not the best.
    """

    test_interval: int
    episodes: int = 100
    greedy: bool = True

    def evaluate(self, steps: int, memory: StoppingMemory, test: PolicyTest) -> StoppingDecision:
        counts = test(self.episodes)
        return StoppingDecision(
            counts, replace(memory, best=_policy_rank(counts), best_steps=steps), is_best=True
        )


@dataclass(frozen=True, slots=True)
class TrainUntilGoal:
    """The dissertation's second strategy: train a batch, test, stop at the first accuracy that is high enough."""

    test_interval: int
    episodes: int = 100
    goal: float = 0.8
    greedy: bool = True

    def evaluate(self, steps: int, memory: StoppingMemory, test: PolicyTest) -> StoppingDecision:
        counts = test(self.episodes)
        memory, keep = _with_best(counts, steps, memory)
        share = success_rate(counts)
        if share >= self.goal:
            return StoppingDecision(counts, memory, True, stop=True, reason=f"accuracy {share:.2f} in a test")
        return StoppingDecision(counts, memory, keep)


@dataclass(frozen=True, slots=True, kw_only=True)
class TrainUntilSure:
    """Stop when every single case is sure to be good enough; keep the best policy; go back if one has forgotten.

    An evaluation is a short test, before which a look may say that the goal is far. If its worst case is at the goal, a longer
    one follows, on new episodes, and only that one counts: each case's share must be at least the goal with a confidence that
    is shared out among the cases and among all such attempts (attempt k gets 1 / (k (k + 1)) of what may go wrong), so that
    trying often does not help.
    Where the longer test leaves it open, it goes on to four times as many episodes, up to the most. It is made in parts, and
    stops as soon as not even success in all the episodes that are left could make it sure, or, where all steps are used, the best.
    """

    test_interval: int
    goal: float = 0.95
    first_episodes: int = 0
    """Episodes of each case in a look before a short test; where more of them fail than may in the whole short test, it is left
    out. 0: no look."""
    screening_episodes: int = 40
    """Episodes of each case in a short test."""
    confirming_episodes: int = 500
    """Episodes of each case in a long test, before it is first looked whether it is sure."""
    most_confirming_episodes: int = 0
    """Most episodes of each case in a long test; by default it does not go on."""
    confidence: float = 0.95
    restore_margin: float = 0.3
    """Where the accuracy is surely by so much below the best one's, training goes back to that policy."""
    patience: int = 3
    """Most returns to an earlier policy, so that a learner that cannot improve stops."""
    use_all_steps: bool = False
    """Train on all the same: where two robots drive, success comes first and side by side last."""
    sufficient_share: float = 1.0
    """If two policies' worst cases are probably not below this, the one that keeps robots side by side wins."""
    greedy: bool = True

    def evaluate(self, steps: int, memory: StoppingMemory, test: PolicyTest) -> StoppingDecision:
        counts = self._screen(test)
        looks = self._looks() if worst_share(counts) >= self.goal else ()
        first = memory.confirmations + 1
        for number in range(len(looks)):
            attempts = dict(enumerate(looks[number:], first + number))
            counts = self._tested_further(test, counts if number else {}, attempts, memory)
            memory = replace(memory, confirmations=first + number)
            low = self._confident_share(counts, first + number)
            if low >= self.goal and not self.use_all_steps:
                memory, _ = _with_best(counts, steps, replace(memory, best=None))
                return StoppingDecision(
                    counts,
                    memory,
                    True,
                    stop=True,
                    reason=f"every case reaches {low:.3f} or more, {self.confidence:.0%} sure",
                )
            if worst_share(counts) < self.goal or self._is_lost(counts, attempts, memory):
                break
        remembered, keep = _with_best(counts, steps, memory, self.sufficient_share)
        if not keep and self._has_forgotten(counts, memory):
            return StoppingDecision(
                counts,
                replace(memory, returns=memory.returns + 1),
                False,
                restore_best=True,
                reason=f"accuracy fell to {success_rate(counts):.2f}: returning to the policy of step {memory.best_steps}",
            )
        return StoppingDecision(counts, remembered, keep)

    def _screen(self, test: PolicyTest) -> CaseCounts:
        """A short test, or the look before it where that decides."""
        if self.first_episodes:
            counts = test(self.first_episodes * test.cases)
            allowed = round((1 - self.goal) * self.screening_episodes, 9)
            if any(count.episodes - count.reached > allowed for count in counts.values()):
                return counts
        return test(self.screening_episodes * test.cases)

    def _looks(self) -> tuple[int, ...]:
        """Of how many episodes of each case a long test consists when it is looked whether it is sure."""
        looks = [self.confirming_episodes]
        while looks[-1] < self.most_confirming_episodes:
            looks.append(min(4 * looks[-1], self.most_confirming_episodes))
        return tuple(looks)

    def _tested_further(
        self, test: PolicyTest, counts: CaseCounts, attempts: Mapping[int, int], memory: StoppingMemory
    ) -> CaseCounts:
        """The long test with the parts up to the first of the ``attempts``, if it is not lost before: episodes of each case, by the
        attempt's number."""
        part = -(-self.confirming_episodes // CONFIRMING_PARTS) * test.cases
        while not counts or min(count.episodes for count in counts.values()) < min(attempts.values()):
            tested = test(part)
            counts = {name: count.plus(counts.get(name, NO_EPISODES)) for name, count in tested.items()}
            if self._is_lost(counts, attempts, memory):
                break
        return counts

    def _is_lost(self, counts: CaseCounts, attempts: Mapping[int, int], memory: StoppingMemory) -> bool:
        """Whether none of the attempts can be sure any more; where all steps are used, whether the policy cannot become the best."""
        failed = max(count.episodes - count.reached for count in counts.values())
        if self.use_all_steps:
            most = max(lower_bound(max(0, episodes - failed), episodes) for episodes in attempts.values())
            return memory.best is not None and min(most, self.sufficient_share) < memory.best[0]
        return all(
            lower_bound(max(0, episodes - failed), episodes, self._confidence_of(attempt, len(counts)))
            < self.goal
            for attempt, episodes in attempts.items()
        )

    def _confident_share(self, counts: CaseCounts, attempt: int) -> float:
        """Lower bound of every case's share, all together with the wanted confidence."""
        confidence = self._confidence_of(attempt, len(counts))
        return min(lower_bound(count.reached, count.episodes, confidence) for count in counts.values())

    def _confidence_of(self, attempt: int, cases: int) -> float:
        """With which confidence one case's share must be good enough in an attempt."""
        return 1 - (1 - self.confidence) / (attempt * (attempt + 1)) / cases

    def _has_forgotten(self, counts: CaseCounts, memory: StoppingMemory) -> bool:
        far_below = _pooled_interval(counts).high < memory.best_low - self.restore_margin
        return memory.returns < self.patience and far_below
