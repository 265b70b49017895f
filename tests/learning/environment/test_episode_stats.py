"""Episodes add up."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.episode_stats import EpisodeOutcome, EpisodeStatsRecorder
from tests.learning.worlds import TASKS, steps


@pytest.mark.parametrize("name", TASKS)
def test_an_episode_is_the_sum_of_its_steps(name: str) -> None:
    batch = BatchEnv(replace(TASKS[name], max_steps=15), 10, seed=3)
    batch.reset()
    recorder, rewards, adjacent, seen = EpisodeStatsRecorder(batch), np.zeros(10), np.zeros(10), 0
    for step in steps(batch, 50):
        rewards += step.rewards
        adjacent += step.transition.adjacent
        episodes = recorder.add(step)
        assert [episode.world for episode in episodes] == np.flatnonzero(step.ended).tolist()
        for episode in episodes:
            i = episode.world
            assert episode.reward == pytest.approx(rewards[i], abs=1e-5)
            assert sum(episode.terms.values()) == pytest.approx(rewards[i], abs=1e-4)
            assert episode.steps == step.transition.step[i]
            assert episode.adjacency == pytest.approx(adjacent[i] / episode.steps)
            assert episode.case == batch.cases[int(step.transition.case[i])].name
            assert episode.outcome is (
                EpisodeOutcome.COLLIDED
                if step.transition.collided[i]
                else EpisodeOutcome.REACHED
                if step.transition.reached[i]
                else EpisodeOutcome.TIMED_OUT
            )
            rewards[i] = adjacent[i] = 0.0
            seen += 1
    assert seen > 10
