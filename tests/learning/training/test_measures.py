"""What learners measure of their own learning: values against what rewards can pay, and updates of policies."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.algorithms import ALGORITHMS
from kit.learning.training.events import Evaluated, TrainingNote, TrainingProgress, decode_event, encode_event
from kit.learning.training.measures import (
    MEASURES,
    VALUE_MAX,
    VALUE_MEAN,
    VALUE_PAYABLE,
    RecentExperience,
    format_measures,
    is_value_too_large,
    value_warning,
)
from kit.learning.training.presets import find_preset
from kit.learning.training.run_config import RunConfig, RunError, format_settings
from kit.learning.training.run_folders import create_run
from kit.learning.training.runs import TrainingRun
from kit.learning.training.training import resolve_preset, train

UPDATES = {"explained_variance", "entropy"}
"""What every on-policy learner tells."""


def experience(rewards: list[float], ended: list[bool]) -> RecentExperience:
    """Of one world that sees the number of its step."""
    recent = RecentExperience(1, 1)
    for number, (reward, over) in enumerate(zip(rewards, ended, strict=True)):
        recent.add(np.array([[number]], np.float32), np.array([reward], np.float32), np.array([over]))
    return recent


def test_no_episode_earns_more_than_is_said_to_be_possible() -> None:
    chance = np.random.default_rng(1)
    for gamma in (0.0, 0.5, 0.99, 1.0):
        for _ in range(20):
            rewards = chance.normal(size=12) * 10
            recent = experience(rewards.tolist(), [False] * 11 + [True])
            earned = [float((gamma ** np.arange(12 - k) * rewards[k:]).sum()) for k in range(12)]
            assert max(earned) <= recent.largest_return(gamma, 11) + 1e-4
            if gamma < 1.0:
                assert recent.largest_return(gamma, None) >= recent.largest_return(gamma, 11)


def test_the_best_reward_in_every_step_is_the_largest_return() -> None:
    recent = experience([1.0, 3.0, -2.0, 100.0], [False, False, False, True])
    assert recent.largest_return(0.9, None) == pytest.approx(3.0 / 0.1 + 100.0)
    assert recent.largest_return(0.9, 2) == pytest.approx(3.0 + 2.7 + 100.0)
    assert math.isinf(recent.largest_return(1.0, None))
    assert math.isinf(RecentExperience(1, 1).largest_return(0.9, None))
    again = RecentExperience(1, 1)
    again.add(np.zeros((1, 1), np.float32), np.array([-1.0], np.float32), np.array([False]))
    again.load(json.loads(json.dumps(recent.save())))
    assert again.largest_return(0.9, None) == recent.largest_return(0.9, None)


def test_the_last_observations_are_kept() -> None:
    recent = experience([0.0] * 1500, [False] * 1500)
    assert sorted(recent.observations[:, 0].tolist()) == list(range(500, 1500))
    assert len(experience([0.0] * 3, [False] * 3).observations) == 3


def test_values_beyond_the_largest_return_are_told_with_both_numbers() -> None:
    measures = {VALUE_MAX: 57_123_456.0, VALUE_MEAN: 3.0, VALUE_PAYABLE: 1390.0}
    assert is_value_too_large(measures)
    assert "57,123,456" in value_warning(measures)
    assert "1,390" in value_warning(measures)
    assert not is_value_too_large({**measures, VALUE_MAX: 1389.0})
    assert not is_value_too_large({})
    assert format_measures({VALUE_MAX: 12.34, "another kit's": 1.0}) == "largest value 12.3"


def trained(folder: Path, algorithm: str, *, steps: int = 3000, task: str = "turn") -> TrainingRun:
    config = RunConfig(TaskSpec(task), algorithm, steps=steps, worlds=4, keep_training=True)
    if "learning_starts" in resolve_preset(config).setting_types():
        config = replace(config, settings=(("learning_starts", 200),))
    run = create_run(folder, config)
    assert train(run).how == "finished"
    return run


@pytest.mark.long
@pytest.mark.parametrize("algorithm", [name for name in ALGORITHMS if name != "ars"])
def test_every_learner_tells_its_values_or_its_updates(tmp_path: Path, algorithm: str) -> None:
    task = "smooth-turn" if ALGORITHMS[algorithm].actions == "continuous" else "turn"
    run = trained(tmp_path, algorithm, steps=600, task=task)
    told = [event.measures for event in run.events() if isinstance(event, Evaluated)]
    assert told
    assert set(told[-1]) <= set(MEASURES)
    if ALGORITHMS[algorithm].family == "rollouts":
        assert UPDATES & set(told[-1])
        return
    assert {VALUE_MAX, VALUE_MEAN, VALUE_PAYABLE} == set(told[-1])
    assert told[-1][VALUE_MEAN] <= told[-1][VALUE_MAX] <= 1e6


def test_a_learner_s_values_are_in_its_events_and_in_its_summary(tmp_path: Path) -> None:
    run = trained(tmp_path, "q-learning")
    events = run.events()
    progress = [event for event in events if isinstance(event, TrainingProgress)]
    assert VALUE_MAX in progress[-1].measures
    assert run.summary().measures == progress[-1].measures
    again = decode_event(encode_event(progress[-1]))
    assert again == progress[-1]
    assert not any(isinstance(event, TrainingNote) for event in events)


def test_values_that_cannot_be_paid_are_told_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from kit.learning.training.tabular import QLearning

    grown = {VALUE_MAX: 1e6, VALUE_MEAN: 1e5, VALUE_PAYABLE: 10.0}
    monkeypatch.setattr(QLearning, "measures", lambda self: grown)
    run = trained(tmp_path, "q-learning", steps=120_000)
    assert sum(isinstance(event, Evaluated) for event in run.events()) >= 2
    (note,) = [event for event in run.events() if isinstance(event, TrainingNote)]
    assert note.text == value_warning(grown)


# The limit of values


def test_the_seed_s_presets_limit_values_and_the_kit_s_do_not() -> None:
    algorithm = ALGORITHMS["boltzmann-dqn"]
    limits = {
        name: find_preset(name, algorithm, "wheelchairs").settings.value_limit  # type: ignore[union-attr]  # replay's
        for name in ("seed", "seed-text", "kit")
    }
    assert limits == {"seed": 500.0, "seed-text": 500.0, "kit": math.inf}


def test_a_limit_is_a_setting_that_may_be_none() -> None:
    assert format_settings((("value_limit", math.inf), ("gamma", 0.9))) == "value_limit=none gamma=0.9"
    config = RunConfig(TaskSpec("turn"), "boltzmann-dqn", "seed", settings=(("value_limit", math.inf),))
    assert RunConfig.from_dict(json.loads(json.dumps(config.as_dict()))) == config
    assert resolve_preset(config).settings.value_limit == math.inf  # type: ignore[union-attr]  # replay's
    with pytest.raises(RunError, match="finite"):
        resolve_preset(replace(config, settings=(("temperature", math.inf),)))


def test_beyond_the_limit_all_actions_are_alike() -> None:
    import kit.learning.training.boltzmann_dqn as dqn  # imports torch
    from kit.learning.environment.sb3_vec_env import make_vec_env

    choice, algorithm = TaskSpec("turn"), ALGORITHMS["boltzmann-dqn"]
    preset = find_preset("seed", algorithm, "turn")
    counts = {}
    for limit in (500.0, math.inf):
        changed = preset.changed({"value_limit": limit})
        learner = dqn.BoltzmannLearner(algorithm, changed, choice, make_vec_env(choice.resolve(), 1, 0), 0)
        *_, weights, bias = learner._network.layer_views(learner._network.parameters)
        weights[:], bias[:] = 0.0, [600.0, 700.0, 800.0]
        drawn = learner._sample_actions(np.zeros((3000, 9), np.float32))
        counts[limit] = np.bincount(drawn, minlength=3)
    assert counts[500.0].min() > 900  # by chance
    assert counts[math.inf].tolist() == [0, 0, 3000]
