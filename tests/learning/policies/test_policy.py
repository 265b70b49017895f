from __future__ import annotations

from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from kit.learning.policies.policy import ActionSampling, Policy, PolicyError, task_interface
from kit.learning.policies.policy_file import load_policy, policy_bytes, save_policy
from kit.learning.policies.policy_network import ActionValueTable, LinearLayer, LstmLayer, PolicyNetwork
from kit.learning.tasks.catalogue import find_task
from kit.learning.tasks.learning_task import UnknownTask
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.algorithms import ALGORITHMS, Algorithm
from kit.learning.training.presets import find_preset
from kit.learning.training.training import fit_task_spec, make_learner


def layer(rng: np.random.Generator, inputs: int, outputs: int) -> LinearLayer:
    weights, bias = rng.normal(size=(inputs, outputs)), rng.normal(size=outputs)
    return LinearLayer(weights.astype(np.float32), bias.astype(np.float32))


def made(choices: tuple[int, ...] = (3,), *, recurrent: bool = False, seed: int = 0) -> Policy:
    """A policy that sees nine numbers."""
    rng = np.random.default_rng(seed)
    lstm = LstmLayer(layer(rng, 9, 20), layer(rng, 5, 20)) if recurrent else None
    layers = (layer(rng, 5 if recurrent else 9, 8), layer(rng, 8, sum(choices)))
    return Policy(
        PolicyNetwork(layers, "tanh", lstm),
        choices,
        ActionSampling("softmax"),
        TaskSpec("turn"),
        1234,
        task_interface(TaskSpec("turn").resolve()),
    )


def table() -> Policy:
    values = np.arange(27 * 3, dtype=np.float32).reshape(27, 3) % 7
    model = ActionValueTable(np.array([0, 4, 8]), np.array([0.2, 0.4], dtype=np.float32), values, 9)
    return Policy(
        model,
        (3,),
        ActionSampling("epsilon", 0.5),
        TaskSpec("turn"),
        9,
        task_interface(TaskSpec("turn").resolve()),
    )


def continuous() -> Policy:
    """A policy that sees nine numbers and gives two."""
    rng = np.random.default_rng(2)
    sampling = ActionSampling("normal", 1.0, (0.5, 0.1))
    last = layer(rng, 8, 2)
    small = LinearLayer(last.weights * np.float32(0.02), last.bias * np.float32(0.02))
    network = PolicyNetwork((layer(rng, 9, 8), small), "relu")
    return Policy(network, (), sampling, TaskSpec("turn"), 5, {"scale": 0.5})


def squashed() -> Policy:
    """One as SAC's: means, then logarithms of standard deviations."""
    rng = np.random.default_rng(3)
    last = layer(rng, 8, 4)
    small = LinearLayer(last.weights * np.float32(0.1), last.bias * np.float32(0.1))
    network = PolicyNetwork((layer(rng, 9, 8), small), "relu")
    return Policy(
        network,
        (),
        ActionSampling("tanh-normal"),
        TaskSpec("turn"),
        5,
        task_interface(TaskSpec("turn").resolve()),
    )


def noisy() -> Policy:
    """One as TD3's."""
    return replace(continuous(), sampling=ActionSampling("noisy-tanh", 1.0, (0.2, 0.2)))


def judging(inputs: int, policy: Policy) -> Policy:
    """One with a critic that sees so many numbers."""
    rng = np.random.default_rng(4)
    return replace(policy, critic=PolicyNetwork((layer(rng, inputs, 6), layer(rng, 6, 1)), "relu"))


POLICIES = {
    "continuous": continuous(),
    "squashed": squashed(),
    "noisy": noisy(),
    "network": made(),
    "two heads": made((4, 4)),
    "memory": made(recurrent=True),
    "critic of states": judging(9, made()),
    "critic of actions": judging(11, continuous()),
    "table": table(),
}
SEEN = np.random.default_rng(1).random((50, 9), dtype=np.float32)


@pytest.mark.parametrize("policy", POLICIES.values(), ids=POLICIES)
def test_comes_back_from_its_file_as_it_was(policy: Policy, tmp_path: Path) -> None:
    save_policy(policy, tmp_path / "p.npz")
    back = load_policy(tmp_path / "p.npz")
    assert policy_bytes(back) == policy_bytes(policy)
    assert (back.choices, back.sampling, back.trained_on, back.steps) == (
        *(policy.choices, policy.sampling, policy.trained_on),
        policy.steps,
    )
    one, other = policy.make_player(50), back.make_player(50)
    for _ in range(3):
        assert one.act(SEEN).tolist() == other.act(SEEN).tolist()
    expected = [each.expected_returns(SEEN, one.scores, one.act(SEEN)) for each in (policy, back)]
    assert (expected[0] is None) == (policy.critic is None and policy.sampling.kind != "epsilon")
    assert np.array_equal(*([] if each is None else each.tolist() for each in expected))


@pytest.mark.parametrize("keep", [0, 10, 200, 900])
def test_half_a_file_is_refused(keep: int, tmp_path: Path) -> None:
    file = tmp_path / "p.npz"
    file.write_bytes(policy_bytes(made())[:keep])
    with pytest.raises(PolicyError, match=r"p\.npz") as caught:
        load_policy(file)
    assert "pickle" not in str(caught.value)  # nobody is told to trust a file


def test_a_file_with_code_in_it_is_refused(tmp_path: Path) -> None:
    np.savez(tmp_path / "p.npz", about=np.array([object()]))
    with pytest.raises(PolicyError, match="damaged"):
        load_policy(tmp_path / "p.npz")


def test_a_missing_file_is_missing(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        load_policy(tmp_path / "p.npz")


def test_one_world_alone_acts_as_among_many() -> None:
    for policy in POLICIES.values():
        together = policy.make_player(50).act(SEEN)
        alone = [policy.make_player(1).act(SEEN[i : i + 1])[0] for i in range(50)]
        # On some processors the matrix product adds one row's numbers in another order than those of many rows.
        np.testing.assert_allclose(np.array(alone), together, rtol=0, atol=1e-6)


def test_memory_is_cleared_where_an_episode_begins() -> None:
    model = made(recurrent=True).model
    policy = replace(POLICIES["memory"], model=model, choices=(1,) * 3)
    fresh, old = policy.make_player(50), policy.make_player(50)
    for _ in range(3):
        old.act(1 - SEEN)
    begun = np.arange(50) % 2 == 0
    fresh.act(SEEN)
    old.act(SEEN, begun)
    assert np.array_equal(old.memory[begun], fresh.memory[begun])
    assert not np.isclose(old.memory[~begun], fresh.memory[~begun]).all(axis=(1, 2)).any()


def test_softmax_draws_in_proportion() -> None:
    bias = np.log(np.array([0.5, 0.3, 0.2], dtype=np.float32))
    model = PolicyNetwork((LinearLayer(np.zeros((9, 3), np.float32), bias),), "tanh")
    policy = replace(made(), model=model)
    drawn = policy.make_player(20_000, np.random.default_rng(0)).act(np.zeros((20_000, 9)))
    assert np.bincount(drawn) / 20_000 == pytest.approx([0.5, 0.3, 0.2], abs=0.02)
    cold = replace(policy, sampling=ActionSampling("softmax", 0.01)).make_player(
        1000, np.random.default_rng(0)
    )
    assert not cold.act(np.zeros((1000, 9))).any()


def test_epsilon_takes_anything_now_and_then() -> None:
    policy = table()
    best = policy.make_player(1).act(SEEN[:1])[0]
    drawn = policy.make_player(9000, np.random.default_rng(0)).act(np.repeat(SEEN[:1], 9000, axis=0))
    assert np.mean(drawn == best) == pytest.approx(0.5 + 0.5 / 3, abs=0.02)


def test_a_policy_that_does_not_fit_says_what_it_was_made_for() -> None:
    made().check_fits(find_task("turn"))
    with pytest.raises(PolicyError, match=r"turn: it sees 9 numbers.*hallway gives 17"):
        made().check_fits(find_task("hallway"))
    with pytest.raises(PolicyError, match="4 actions"):
        made((4,)).check_fits(find_task("turn"))


def test_a_choice_goes_into_a_file_and_back() -> None:
    choice = TaskSpec("hallway", ("doors",), measured_to="axle", tells_target=True, scale=0.5)
    assert TaskSpec.from_dict(choice.as_dict()) == choice
    task = choice.resolve()
    assert (task.measured_to, task.observation.target, task.reward.scale) == ("axle", True, 0.5)
    assert len(task.map_cases()) == 3
    for wrong in (None, {}, {"task": "turn", "colour": 1}):
        with pytest.raises(ValueError, match="choice"):
            TaskSpec.from_dict(wrong)
    with pytest.raises(UnknownTask, match="algorithm-1"):
        TaskSpec("turn", reward="algorithm1").resolve()


NEURAL = [row for row in ALGORITHMS.values() if row.needs_torch]
CONTINUOUS = [row for row in NEURAL if row.actions != "discrete"]
needs_learner = pytest.mark.skipif(find_spec("torch") is None, reason="the extra learn is not installed")


@needs_learner
@pytest.mark.long
@pytest.mark.parametrize("algorithm", CONTINUOUS, ids=lambda row: row.name)
def test_arrays_drive_as_the_network_they_come_from(algorithm: Algorithm) -> None:
    task = find_task("smooth-turn")
    preset = replace(find_preset("kit", algorithm, "continuous", is_continuous=True), worlds=8)
    learner = make_learner(algorithm, preset, TaskSpec("smooth-turn"), task, seed=1)
    if algorithm.name == "crossq":  # statistics that are not those of a new layer
        for each in learner._model.policy.actor.modules():  # type: ignore[attr-defined]  # as below
            if hasattr(each, "ra_mean"):
                each.ra_mean.uniform_(-0.5, 0.5)
                each.ra_var.uniform_(0.5, 2.0)
    seen = np.random.default_rng(0).random((200, 15), dtype=np.float32)
    wanted, _ = learner._model.predict(seen, deterministic=True)  # type: ignore[attr-defined]  # the peer it must equal
    policy = learner.policy()
    policy.check_consistent()
    assert np.abs(policy.make_player(200).act(seen) - wanted).max() < 1e-5


@needs_learner
@pytest.mark.parametrize(
    "algorithm",
    [
        row for row in NEURAL if row.actions != "continuous" and row.name != "boltzmann-dqn"
    ],  # whose network is arrays itself
    ids=lambda row: row.name,
)
def test_arrays_act_as_the_network_they_come_from(algorithm: Algorithm) -> None:
    choice = fit_task_spec(TaskSpec("wheelchairs"), algorithm)
    task = choice.resolve()
    preset = replace(
        find_preset("kit", algorithm, "wheelchairs"), worlds=225 if algorithm.supports_multi_discrete else 2
    )
    if algorithm.name == "trpo":
        preset = replace(preset, worlds=64)
    learner = make_learner(algorithm, preset, choice, task, seed=1)
    seen = np.random.default_rng(0).random((200, 38), dtype=np.float32)
    player, memory, starts = learner.policy().make_player(200), None, np.ones(200, dtype=bool)
    for _ in range(3):
        wanted, memory = learner._model.predict(seen, memory, starts, deterministic=True)  # type: ignore[attr-defined]  # the peer it must equal
        assert np.mean(player.act(seen) == wanted) > 0.99  # equal scores may be rounded either way
        starts[:] = False


@needs_learner
@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    "algorithm",
    [row for row in NEURAL if row.name in ("ppo", "a2c", "sac", "td3", "tqc", "crossq")],
    ids=lambda row: row.name,
)
def test_the_expected_return_is_the_critics(algorithm: Algorithm) -> None:
    import torch

    name = "turn" if algorithm.actions == "discrete" else "smooth-turn"
    task = find_task(name)
    preset = replace(
        find_preset("kit", algorithm, "continuous", is_continuous=name == "smooth-turn"), worlds=8
    )
    learner = make_learner(algorithm, preset, TaskSpec(name), task, seed=1)
    model = learner._model  # type: ignore[attr-defined]  # the peer it must equal
    policy, size = learner.policy(), task.observation.size
    policy.check_consistent()
    seen = np.random.default_rng(0).random((20, size), dtype=np.float32)
    player = policy.make_player(20)
    actions = player.act(seen)
    with torch.no_grad():
        if hasattr(model.policy, "predict_values"):
            wanted = model.policy.predict_values(torch.as_tensor(seen))[:, 0]
        else:
            model.policy.set_training_mode(False)
            told = model.critic(torch.as_tensor(seen), torch.as_tensor(actions))
            wanted = told[:, 0].mean(dim=1) if torch.is_tensor(told) else told[0][:, 0]
    found = policy.expected_returns(seen, player.scores, actions)
    assert found == pytest.approx(wanted.numpy(), abs=1e-4)


def test_a_value_based_policy_expects_its_best_value() -> None:
    policy = replace(made(), sampling=ActionSampling("epsilon", 0.05))
    player = policy.make_player(50)
    actions = player.act(SEEN)
    expected = policy.expected_returns(SEEN, player.scores, actions)
    assert expected == pytest.approx(player.scores.max(axis=1))
    assert made().expected_returns(SEEN, player.scores, actions) is None


def test_continuous_actions_are_the_outputs_or_drawn_around_them() -> None:
    policy = continuous()
    outputs, _ = policy.model.scores(SEEN, np.zeros((50, 2, 0), dtype=np.float32))
    greedy = policy.make_player(50).act(SEEN)
    assert greedy.tolist() == np.clip(outputs, -1, 1).tolist()
    drawn = np.stack([policy.make_player(50, np.random.default_rng(seed)).act(SEEN) for seed in range(200)])
    inside = (np.abs(outputs) < 0.3).all(axis=1)
    spread = drawn[:, inside].std(axis=0).mean(axis=0)
    assert spread[1] == pytest.approx(0.1, rel=0.1)
    assert 0.3 < spread[0] <= 0.5  # what lies beyond the bounds is brought to them


def test_squashed_actions_are_bounded_and_scatter_as_they_did_in_training() -> None:
    outputs, _ = squashed().model.scores(SEEN, np.zeros((50, 2, 0), dtype=np.float32))
    means, deviations = outputs[:, :2], np.exp(np.clip(outputs[:, 2:], -20, 2))
    greedy = squashed().make_player(50).act(SEEN)
    assert np.abs(greedy - np.tanh(means)).max() < 1e-6
    players = [squashed().make_player(50, np.random.default_rng(seed)) for seed in range(400)]
    drawn = np.arctanh(np.clip(np.stack([player.act(SEEN) for player in players]), -0.999999, 0.999999))
    inside = (np.abs(means) + 3 * deviations < 5).all(axis=1)
    assert inside.sum() > 5
    assert drawn[:, inside].std(axis=0) == pytest.approx(deviations[inside], rel=0.2)
    scattered = noisy().make_player(50, np.random.default_rng(0)).act(SEEN) - noisy().make_player(50).act(
        SEEN
    )
    assert 0.1 < scattered.std() < 0.25


def test_a_policy_says_when_the_task_has_become_another() -> None:
    turn = find_task("turn")
    policy = replace(made(), interface=task_interface(turn))
    policy.check_fits(turn)
    policy.check_fits(replace(turn, reward=find_task("hallway").reward, max_steps=7))
    scaled = replace(turn, observation=replace(turn.observation, scale=6.0))
    with pytest.raises(PolicyError, match=r"scale was 0.5 and is 6.0"):
        policy.check_fits(scaled)
    with pytest.raises(PolicyError, match=r"clip was 2.0 and is 10.0"):
        policy.check_fits(find_task("turn-seed"))
    narrow = replace(
        turn, observation=replace(turn.observation, sectors=(*[0] * 11, *turn.observation.sectors[11:]))
    )
    with pytest.raises(PolicyError, match=r"sectors was \[10, 10,.* and is \[11, 9, 10"):
        policy.check_fits(narrow)
    faster = replace(turn.actions, twist_table=((0.9, 0.0), *turn.actions.twist_table[1:]))
    with pytest.raises(PolicyError, match="twist table was"):
        policy.check_fits(replace(turn, actions=faster))
    with pytest.raises(PolicyError, match=r"step time was 0.1 and is 0.2"):
        policy.check_fits(replace(turn, step_time=0.2))


def test_a_table_policy_does_not_drive_with_continuous_actions() -> None:
    with pytest.raises(PolicyError, match="continuous"):
        made().check_fits(find_task("smooth-turn"))
    with pytest.raises(PolicyError, match="discrete actions"):
        continuous().check_fits(find_task("turn"))


@pytest.mark.parametrize("number", [np.nan, np.inf, -np.inf])
def test_a_policy_of_numbers_that_are_not_finite_is_refused(tmp_path: Path, number: float) -> None:
    for policy in (made(), made(recurrent=True), table()):
        model = policy.model
        array = model.values if isinstance(model, ActionValueTable) else model.layers[0].weights
        kept = array[1, 1]
        array[1, 1] = number
        (tmp_path / "best.npz").write_bytes(policy_bytes(policy))
        with pytest.raises(PolicyError, match="not finite"):
            load_policy(tmp_path / "best.npz")
        array[1, 1] = kept
        (tmp_path / "best.npz").write_bytes(policy_bytes(policy))
        assert load_policy(tmp_path / "best.npz").choices == policy.choices
