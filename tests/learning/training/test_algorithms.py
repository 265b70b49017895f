"""Every algorithm of the table learns a task that a few lines of arithmetic could solve."""

from __future__ import annotations

import math
import tempfile
from contextlib import suppress
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import pytest

from kit.array_archives import unpack_arrays
from kit.learning.environment.episode_stats import EpisodeStats
from kit.learning.policies.evaluation import Evaluator
from kit.learning.policies.policy_network import ActionValueTable
from kit.learning.tasks.actions import ContinuousActions
from kit.learning.tasks.catalogue import TASKS, find_task
from kit.learning.tasks.learning_task import LearningTask, StartVariation
from kit.learning.tasks.rewards import PROGRESS
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.algorithm_settings import (
    ActorCriticReplayParams,
    ARSSettings,
    LinearSchedule,
    OnPolicyParams,
    ReplayParams,
    TabularParams,
)
from kit.learning.training.algorithms import (
    ALGORITHMS,
    Algorithm,
    UnknownAlgorithm,
    UnsuitableAlgorithm,
    find_algorithm,
)
from kit.learning.training.learner import Learner, StopLearning
from kit.learning.training.presets import PRESETS, Preset, find_preset
from kit.learning.training.run_config import RunConfig
from kit.learning.training.run_folders import create_run
from kit.learning.training.stopping_rules import TrainUntilGoal
from kit.learning.training.training import fit_task_spec, make_learner, train
from tests.cases import every_case
from tests.learning.worlds import NINE_NUMBERS, THREE_MOVES

STRAIGHT_ON = replace(
    find_task("hallway").on("straight"),
    name="straight-on",
    start=StartVariation(shifted=False),
    actions=THREE_MOVES,
    observation=NINE_NUMBERS,
    reward=PROGRESS,
    max_steps=60,
)
"""Ahead is right at every step, and pays at once."""

ANY_SPEED = replace(
    STRAIGHT_ON, name="any-speed", actions=ContinuousActions((-0.2, 0.4), (-1.0, 1.0)), max_steps=100
)


def straight_on(algorithm: Algorithm) -> LearningTask:
    """The task, with actions that the algorithm learns."""
    return ANY_SPEED if algorithm.actions == "continuous" else STRAIGHT_ON


_RATE = LinearSchedule(3e-3, 3e-3)
_UNTIL = TrainUntilGoal(test_interval=1000)
_REPLAY = ReplayParams(
    learning_starts=300, train_freq=1, gradient_steps=1, target_update_interval=100, gamma=0.9
)
_ACTOR_CRITIC = ActorCriticReplayParams(
    learning_starts=300,
    batch_size=64,
    train_freq=1,
    gradient_steps=4,
    gamma=0.9,
    tau=0.02,
    ent_coef="auto_0.01",
)
_NOISY = replace(_ACTOR_CRITIC, ent_coef=None, action_noise=0.3)
_PPO = OnPolicyParams(n_steps=32, batch_size=256, n_epochs=6)
_ANY = Preset(OnPolicyParams(n_steps=32), _UNTIL, 6_000, worlds=16, learning_rate=_RATE)
QUICK = {
    "a2c": replace(_ANY, settings=OnPolicyParams(n_steps=8)),
    "trpo": _ANY,
    "ppo": replace(_ANY, settings=_PPO),
    "maskable-ppo": replace(_ANY, settings=_PPO),
    "recurrent-ppo": replace(_ANY, settings=_PPO, lstm_size=8),
    "dqn": replace(_ANY, settings=_REPLAY),
    "qrdqn": replace(_ANY, settings=_REPLAY, layers=(16,)),
    "boltzmann-dqn": replace(_ANY, settings=replace(_REPLAY, temperature=0.1)),
    "ars": Preset(
        ARSSettings(n_delta=4, n_top=2, n_eval_episodes=4),
        *(_UNTIL, 60_000, 4),
        learning_rate=LinearSchedule(0.05, 0.05),
    ),
    "sac": replace(_ANY, settings=_ACTOR_CRITIC, steps=3_000),
    "tqc": replace(_ANY, settings=_ACTOR_CRITIC, steps=3_000),
    "crossq": replace(_ANY, settings=replace(_ACTOR_CRITIC, tau=None), steps=3_000),
    "td3": replace(_ANY, settings=_NOISY, steps=12_000, learning_rate=LinearSchedule(1e-3, 1e-3)),
    "ddpg": replace(_ANY, settings=_NOISY, steps=12_000, learning_rate=LinearSchedule(1e-3, 1e-3)),
    "q-learning": Preset(TabularParams(gamma=0.9), _UNTIL, 20_000, worlds=8),
    "sarsa": Preset(TabularParams(gamma=0.9), _UNTIL, 20_000, worlds=8),
}
needs_learner = pytest.mark.skipif(find_spec("torch") is None, reason="the extra learn is not installed")


class Onlooker:
    """Counts."""

    def __init__(self) -> None:
        self.stops = 0
        self.episodes: list[EpisodeStats] = []

    def between_updates(self) -> None:
        self.stops += 1

    def on_episode_end(self, episode: EpisodeStats) -> None:
        self.episodes.append(episode)


class UntilLearned(Onlooker):
    """Ends learning once every test episode reaches the target, as a stopping rule does: a policy without chance of its
    own comes and goes, and when it is there differs from processor to processor."""

    def __init__(self, learner: Learner, evaluator: Evaluator) -> None:
        super().__init__()
        self._learner, self._evaluator, self._tested = learner, evaluator, 0

    def between_updates(self) -> None:
        super().between_updates()
        if self._learner.steps - self._tested >= 1_000:
            self._tested = self._learner.steps
            if self._evaluator.test(self._learner.policy(), 20, 1).mean == 1.0:
                raise StopLearning


ROWS = [
    pytest.param(row, id=row.name, marks=needs_learner if row.needs_torch else ())
    for row in ALGORITHMS.values()
]


@pytest.mark.long
@pytest.mark.parametrize("algorithm", ROWS)
def test_learns_to_go_straight_on(
    algorithm: Algorithm, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    preset = QUICK[algorithm.name]
    choice = TaskSpec("hallway", ("straight",))
    learner = make_learner(algorithm, preset, choice, straight_on(algorithm), seed=3)
    evaluator = Evaluator(straight_on(algorithm))
    before = evaluator.test(learner.policy(), 20, 1).mean
    onlooker = UntilLearned(learner, evaluator)
    with suppress(StopLearning):
        learner.learn(preset.steps, onlooker)
    assert evaluator.test(learner.policy(), 20, 1).mean == 1.0 > before or before == 1.0
    assert onlooker.stops >= 2
    assert {episode.case for episode in onlooker.episodes} == {"straight"}
    assert not list(tmp_path.glob("SB3-*")), "it leaves no folder behind"


@pytest.mark.long_cases("qrdqn", "recurrent-ppo", "trpo", "sac", "td3", "ddpg", "tqc", "crossq")
@pytest.mark.parametrize("algorithm", ROWS)
def test_goes_on_from_what_it_saved(algorithm: Algorithm) -> None:
    preset = replace(QUICK[algorithm.name], steps=600)
    choice = TaskSpec("hallway", ("straight",))
    first = make_learner(algorithm, preset, choice, straight_on(algorithm), seed=3)
    first.learn(600, Onlooker())
    parts = first.save()
    second = make_learner(algorithm, preset, choice, straight_on(algorithm), seed=4)
    second.load(parts)
    assert second.steps == first.steps
    one, other = (learner.policy() for learner in (first, second))
    if not isinstance(one.model, ActionValueTable):
        assert not isinstance(other.model, ActionValueTable)
        assert [layer.weights.tolist() for layer in one.model.layers] == [
            layer.weights.tolist() for layer in other.model.layers
        ]
    if "parameters.npz" in parts:  # optimisers, and the weight of SAC's entropy, stand beside the networks
        stored, again = (unpack_arrays(each["parameters.npz"], 1 << 30) for each in (parts, second.save()))
        assert {name: array.tolist() for name, array in stored.items()} == {
            name: array.tolist() for name, array in again.items()
        }
        assert (
            any(name.endswith(("exp_avg", "square_avg")) for name in stored) or algorithm.family == "search"
        )
        if algorithm.name == "sac":
            assert stored["log_ent_coef"] != pytest.approx(math.log(0.01))
    second.learn(first.steps + 600, Onlooker())
    assert second.steps >= first.steps + 600
    parts["learner.json"] = parts["learner.json"].replace(algorithm.name.encode(), b"another")
    with pytest.raises(ValueError, match=algorithm.name):
        second.load(parts)


@pytest.mark.long_cases("a2c", "qrdqn", "recurrent-ppo", "trpo", "sac", "td3", "ddpg", "tqc", "crossq")
@pytest.mark.parametrize("algorithm", ROWS)
def test_what_was_remembered_can_be_recalled(algorithm: Algorithm) -> None:
    preset = replace(QUICK[algorithm.name], steps=600)
    learner = make_learner(algorithm, preset, TaskSpec("hallway"), straight_on(algorithm), seed=3)
    evaluator = Evaluator(straight_on(algorithm))
    known, before = learner.snapshot(), evaluator.test(learner.policy(), 10, 1)
    learner.learn(1200, Onlooker())
    learner.restore(known)
    assert evaluator.test(learner.policy(), 10, 1) == before


@every_case("name", PRESETS)
@every_case("algorithm", ALGORITHMS.values(), ids=ALGORITHMS)
def test_every_algorithm_has_presets_for_every_task(algorithm: Algorithm, name: str) -> None:
    for task in TASKS:
        preset = find_preset(name, algorithm, task.preset)  # type: ignore[arg-type]  # PRESETS are its names
        assert preset.steps >= preset.stopping_rule.test_interval > 0


def test_an_unknown_algorithm_is_told_from_a_known_one() -> None:
    with pytest.raises(UnknownAlgorithm, match=r'did you mean "?ppo'):
        find_algorithm("pppo")


CONTINUOUS = [row for row in ALGORITHMS.values() if row.actions != "discrete"]
CONTINUOUS_REPLAY = [row for row in CONTINUOUS if row.family == "replay"]


@needs_learner
@pytest.mark.long
@pytest.mark.parametrize("algorithm", CONTINUOUS, ids=lambda row: row.name)
def test_continuous_actions_are_learned(algorithm: Algorithm) -> None:
    preset = replace(QUICK[algorithm.name], steps=12_000)
    learner = make_learner(algorithm, preset, TaskSpec("hallway"), ANY_SPEED, seed=3)
    evaluator = Evaluator(ANY_SPEED)
    with suppress(StopLearning):
        learner.learn(preset.steps, UntilLearned(learner, evaluator))
    policy = learner.policy()
    assert policy.choices == ()
    assert policy.action_size == 2
    result = evaluator.test(policy, 20, 1)
    assert result.mean == 1.0
    assert evaluator.test(policy, 20, 1, greedy=False).reward != result.reward


def test_an_algorithm_is_refused_where_it_cannot_choose_the_actions() -> None:
    for algorithm in ALGORITHMS.values():
        if algorithm.actions == "discrete":
            with pytest.raises(UnsuitableAlgorithm, match=r"continuous actions: ppo.*, sac"):
                fit_task_spec(TaskSpec("smooth-turn"), algorithm)
        if algorithm.actions == "continuous":
            with pytest.raises(UnsuitableAlgorithm, match=r"learn it: ppo.*smooth-turn.*linear"):
                fit_task_spec(TaskSpec("turn"), algorithm)


@pytest.mark.daily(5)
@needs_learner
@pytest.mark.long
@pytest.mark.parametrize("algorithm", CONTINUOUS_REPLAY, ids=lambda row: row.name)
def test_a_kit_preset_learns_the_smooth_turn(algorithm: Algorithm, tmp_path: Path) -> None:
    run = create_run(tmp_path, RunConfig(TaskSpec("smooth-turn"), algorithm.name, seed=1))
    assert train(run).how == "finished"
    policy = run.policy()
    assert Evaluator(policy.trained_on.resolve()).test(policy, 100, 5).worst.share >= 0.9


@needs_learner
@pytest.mark.nightly
def test_a_kit_preset_learns_fifteen_hallways_from_a_replay_buffer(tmp_path: Path) -> None:
    run = create_run(
        tmp_path, RunConfig(TaskSpec("smooth-hallway"), "td3", seed=11)
    )  # the one that takes least time
    assert train(run).how == "finished"
    policy = run.policy()
    assert Evaluator(policy.trained_on.resolve()).test(policy, 200, 5).worst.share >= 0.9
