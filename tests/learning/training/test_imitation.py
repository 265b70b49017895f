"""Imitation: examples are what agents see and what was done; cloning fails off the demonstrated way, DAgger mends it."""

from __future__ import annotations

from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from kit.controllers import find_controller
from kit.learning.environment.batch import BatchEnv
from kit.learning.policies.evaluation import Evaluator
from kit.learning.policies.policy import ActionSampling, Policy, task_interface
from kit.learning.policies.policy_file import save_policy
from kit.learning.policies.policy_network import LinearLayer, PolicyNetwork
from kit.learning.tasks.catalogue import find_task
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.algorithm_settings import ImitationParams, LinearSchedule
from kit.learning.training.algorithms import find_algorithm
from kit.learning.training.controller_demonstrator import ControllerDemonstrator, read_demonstrator
from kit.learning.training.demonstrations import (
    DemonstrationError,
    PolicyDemonstrator,
    PoseObserver,
    RecordedDemonstrator,
    actions_of_twists,
)
from kit.learning.training.presets import Preset
from kit.learning.training.run_config import RunConfig
from kit.learning.training.run_folders import create_run
from kit.learning.training.stopping_rules import TrainUntilGoal
from kit.learning.training.training import make_learner, train
from kit.run.headless import run_episode
from kit.run.recording import Input, load_recording
from tests.learning.training.test_algorithms import ANY_SPEED, STRAIGHT_ON, Onlooker

needs_learner = pytest.mark.skipif(find_spec("torch") is None, reason="the extra learn is not installed")
SMOOTH = replace(find_task("smooth-turn"), lidar_noise=0.0)


def twist_policy(forward: float, turn: float) -> Policy:
    """One that always drives with the same shares of the speeds."""
    layer = LinearLayer(np.zeros((9, 2), np.float32), np.array([forward, turn], np.float32))
    sampling = ActionSampling("normal", 1.0, (0.0, 0.0))
    return Policy(
        PolicyNetwork((layer,), "tanh"),
        (),
        sampling,
        TaskSpec("hallway"),
        0,
        task_interface(ANY_SPEED),
    )


def test_twists_become_the_actions_that_are_most_like_them() -> None:
    twists = np.array([[[0.5, 0.1]], [[0.1, 1.5]], [[0.0, -1.0]]])
    assert actions_of_twists(find_task("turn"), twists).tolist() == [0, 1, 2]
    continuous = actions_of_twists(SMOOTH, np.array([[[0.5, -2.0]], [[-0.2, 9.0]], [[0.15, 0.0]]]))
    assert continuous == pytest.approx(np.array([[1, -1], [-1, 1], [0, 0]]), abs=1e-6)
    pair = find_task("wheelchairs")
    assert actions_of_twists(pair, np.array([[[0.3, 0.0], [0.0, 1.0]]])).tolist() == [[1, 2]]


def test_an_observer_sees_what_an_agent_would_have_seen() -> None:
    task = replace(SMOOTH, observation=replace(SMOOTH.observation, last_action=True, frames=2, target=True))
    batch, observer, rng = BatchEnv(task, 1, 3, autoreset=False), PoseObserver(task), np.random.default_rng(0)
    seen = batch.reset()
    found = observer.begin(int(batch.state.case[0]), batch.state.pose[0])
    assert np.abs(seen - found).max() < 1e-6
    for _ in range(10):
        action = rng.uniform(-1, 1, (1, 2)).astype(np.float32)
        seen = batch.step(action).observations
        assert observer.twists_to(batch.state.pose[0]).shape == (1, 2)
        found = observer.follow(batch.state.pose[0], batch.state.twist[0])
        assert np.abs(seen - found).max() < 1e-5


def test_a_recorded_drive_is_its_observations_and_twists(tmp_path: Path) -> None:
    run_episode("turn", "forward", seconds=3.0, record=tmp_path / "drive.npz")
    recording = load_recording(tmp_path / "drive.npz")
    examples = RecordedDemonstrator(recording, SMOOTH, "drive.npz").demonstrate(None, 0)
    assert examples.observations.shape == (len(examples), 15)
    moving = np.minimum(
        examples.observations[2:-2, 13], 0.5
    )  # the last step's speed, as far as actions can ask for it
    driven = -0.2 + (examples.actions[2:-2, 0] + 1.0) * 0.35
    assert np.abs(moving[1:] - driven[:-1]).max() < 1e-4
    assert driven.max() > 0.1
    put_back = replace(
        recording, inputs=(*recording.inputs, Input(30, "move_model", ("serp", 0.0, 0.0, 0.0)))
    )
    later = RecordedDemonstrator(put_back, SMOOTH, "drive.npz").demonstrate(None, 0)
    assert 0 < len(later) < len(examples), "what was before the robot was put back is left out"
    with pytest.raises(DemonstrationError, match="was driven on turn"):
        RecordedDemonstrator(recording, find_task("hallway"), "drive.npz")
    still = replace(recording, poses=np.zeros_like(recording.poses))
    with pytest.raises(DemonstrationError, match="nothing moves"):
        RecordedDemonstrator(still, SMOOTH, "drive.npz")


def test_a_policy_shows_what_it_would_do_where_another_drives(tmp_path: Path) -> None:
    save_policy(twist_policy(0.5, 0.1), tmp_path / "p.npz")
    teacher = read_demonstrator(tmp_path / "p.npz", ANY_SPEED)
    assert isinstance(teacher, PolicyDemonstrator)
    for driver in (None, twist_policy(1.0, 0.0)):
        examples = teacher.demonstrate(driver, 1)
        assert examples.actions == pytest.approx(np.tile([0.5, 0.1], (len(examples), 1)))


@pytest.mark.long
def test_a_controller_takes_over_where_a_policy_has_driven_to() -> None:
    task = replace(SMOOTH.on("turn_a_to_b"), max_steps=20)
    file = find_controller("forward").file
    demonstrator = ControllerDemonstrator(file, task)
    own = demonstrator.demonstrate(None, 1)
    assert own.actions[-1, 0] > 0.0
    layer = LinearLayer(np.zeros((15, 2), np.float32), np.array([-0.4, -1.0], np.float32))
    turner = Policy(
        PolicyNetwork((layer,), "tanh"),
        (),
        ActionSampling("normal", 1.0, (0.0, 0.0)),
        TaskSpec("smooth-turn"),
        0,
        task_interface(SMOOTH),
    )
    after = demonstrator.demonstrate(turner, 1)
    assert not np.allclose(own.observations[0], after.observations[0], atol=0.02), "it begins elsewhere"


QUICK = Preset(
    ImitationParams(batch_size=64),
    TrainUntilGoal(test_interval=2_000),
    8_000,
    learning_rate=LinearSchedule(3e-3, 3e-3),
    layers=(16,),
)


@needs_learner
@pytest.mark.parametrize("name", ["bc", "dagger"])
def test_a_saved_imitator_goes_on_as_it_was(name: str, tmp_path: Path) -> None:
    save_policy(twist_policy(0.9, 0.0), tmp_path / "p.npz")
    preset = replace(QUICK, settings=ImitationParams(rounds=2 * (name == "dagger"), round_steps=1_000))

    def learner(seed: int):  # type: ignore[no-untyped-def]  # the class is loaded by the table
        made = find_algorithm(name), preset, TaskSpec("hallway"), ANY_SPEED
        return make_learner(*made, seed=seed, demonstrations=[tmp_path / "p.npz"])

    first = learner(1)
    first.learn(4_000, Onlooker())
    assert Evaluator(ANY_SPEED).test(first.policy(), 10, 1).mean == 1.0
    second = learner(2)
    second.load(first.save())
    one, other = first.policy(), second.policy()
    assert one.steps == other.steps
    assert [layer.weights.tolist() for layer in one.model.layers] == [
        layer.weights.tolist() for layer in other.model.layers
    ]
    second.learn(6_000, Onlooker())
    with pytest.raises(DemonstrationError, match="something to imitate"):
        make_learner(find_algorithm(name), preset, TaskSpec("hallway"), ANY_SPEED, seed=1)


@needs_learner
def test_a_table_of_actions_is_imitated_too(tmp_path: Path) -> None:
    layer = LinearLayer(np.zeros((9, 3), np.float32), np.array([5, 0, 0], np.float32))
    ahead = Policy(
        PolicyNetwork((layer,), "tanh"),
        (3,),
        ActionSampling("softmax"),
        TaskSpec("hallway"),
        0,
        task_interface(STRAIGHT_ON),
    )
    save_policy(ahead, tmp_path / "p.npz")
    learner = make_learner(
        find_algorithm("bc"),
        QUICK,
        TaskSpec("hallway"),
        STRAIGHT_ON,
        seed=1,
        demonstrations=[tmp_path / "p.npz"],
    )
    learner.learn(4_000, Onlooker())
    assert Evaluator(STRAIGHT_ON).test(learner.policy(), 10, 1).mean == 1.0


@needs_learner
@pytest.mark.nightly
def test_cloning_fails_off_the_demonstrated_way_and_dagger_mends_it(tmp_path: Path) -> None:
    drives = []
    for case in ("turn_a_to_b", "turn_b_to_a"):
        drives.append(tmp_path / f"{case}.npz")
        run_episode("turn", "fields", case=case, seconds=30.0, record=drives[-1])
    files = tuple(map(str, drives))
    shares = {}
    for algorithm, whom in (("bc", files), ("dagger", (str(find_controller("fields").file),))):
        run = create_run(tmp_path, RunConfig(TaskSpec("smooth-turn"), algorithm, seed=1, imitate=whom))
        assert train(run).how == "finished"
        policy = run.policy()
        shares[algorithm] = Evaluator(policy.trained_on.resolve()).test(policy, 200, 5).worst.share
    assert shares["bc"] < 0.6
    assert shares["dagger"] > 0.9
