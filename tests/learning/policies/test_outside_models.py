"""Models that were trained outside the kit: read, exported and refused."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("torch")
pytest.importorskip("sb3_contrib")

import sb3_contrib as contrib
import stable_baselines3 as sb3
import torch
from click.testing import CliRunner
from stable_baselines3.common.vec_env import VecNormalize
from torch import nn

import kit
from kit.cli import main
from kit.learning.policies.policy import Policy, PolicyError
from kit.learning.policies.sb3_archive import EXPORT_STATISTICS
from tests.benchmarks.one_policy import compare

TASKS = {"discrete": "turn", "continuous": "smooth-turn"}
SMALL_BATCH: dict[str, Any] = {"n_steps": 4, "batch_size": 16}
KINDS: dict[str, tuple[Any, str, dict[str, Any]]] = {
    "PPO": (sb3.PPO, "discrete", SMALL_BATCH),
    "PPO of numbers": (sb3.PPO, "continuous", SMALL_BATCH),
    "PPO with ReLU": (
        sb3.PPO,
        "discrete",
        {**SMALL_BATCH, "policy_kwargs": {"activation_fn": nn.ReLU, "net_arch": [8, 6]}},
    ),
    "A2C": (sb3.A2C, "discrete", {}),
    "DQN": (sb3.DQN, "discrete", {"buffer_size": 100}),
    "SAC": (sb3.SAC, "continuous", {"buffer_size": 100}),
    "TD3": (sb3.TD3, "continuous", {"buffer_size": 100}),
    "RecurrentPPO": (contrib.RecurrentPPO, "discrete", SMALL_BATCH),
    "QRDQN": (contrib.QRDQN, "discrete", {"buffer_size": 100}),
    "TQC": (contrib.TQC, "continuous", {"buffer_size": 100}),
    "ARS": (contrib.ARS, "discrete", {}),
    "TRPO": (contrib.TRPO, "continuous", SMALL_BATCH),
}
UNREAD = {"CrossQ": (contrib.CrossQ, "continuous", {"buffer_size": 100})}


def make_model(kind: str, env: Any = None) -> tuple[Any, str]:
    """A model with the weights that it begins with, and its task."""
    algorithm, actions, settings = (KINDS | UNREAD)[kind]
    task = TASKS[actions]
    rows = "MlpLstmPolicy" if kind == "RecurrentPPO" else "MlpPolicy"
    env = kit.make_vec_env(task, 4, seed=1) if env is None else env
    return algorithm(rows, env, seed=3, device="cpu", **settings), task


def what_it_may_see(task: str) -> np.ndarray[Any, Any]:
    found = kit.find_task(task)
    space = found.observation.space(found.robots)
    return np.random.default_rng(5).uniform(space.low, space.high, (200, *space.shape)).astype(np.float32)


def assert_same(policy: Policy, model: Any, seen: Any, told: Any = None) -> None:
    theirs, _ = model.predict(seen if told is None else told, deterministic=True)
    ours, _ = policy.predict(seen)
    assert np.isclose(ours, theirs.reshape(ours.shape), atol=1e-4).mean() > 0.99


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS)
def test_a_saved_model_does_the_same_as_a_policy_of_the_kit(kind: str, tmp_path: Path) -> None:
    model, task = make_model(kind)
    model.save(tmp_path / "model.zip")
    policy = kit.load_policy(tmp_path / "model.zip", task)
    assert_same(policy, model, what_it_may_see(task))
    kit.save_policy(policy, tmp_path / "mine.npz")
    again = kit.load_policy(tmp_path / "mine.npz", task)
    assert_same(again, model, what_it_may_see(task))
    assert repr(again) == repr(policy)
    assert sum(case.episodes for case in kit.evaluate_policy(again, episodes=2).cases) >= 4


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS | UNREAD)
def test_a_model_at_hand_is_exported(kind: str) -> None:
    model, task = make_model(kind)
    assert_same(kit.export_policy(model, task), model, what_it_may_see(task))


@pytest.mark.long
def test_what_was_trained_on_normalised_observations_needs_their_statistics(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    env = VecNormalize(kit.make_vec_env("turn", 4, seed=1), clip_obs=1000.0)
    model, task = make_model("PPO", env)
    model.learn(64)
    model.save("model.zip")
    with pytest.raises(PolicyError, match="statistics") as refused:
        kit.load_policy("model.zip", task)
    assert EXPORT_STATISTICS in str(refused.value)
    exec(EXPORT_STATISTICS, {"numpy": np, "env": env})
    seen = what_it_may_see(task)
    policy = kit.load_policy("model.zip", task, statistics="statistics.npz")
    assert_same(policy, model, seen, env.normalize_obs(seen))
    env.clip_obs = 0.5
    exec(EXPORT_STATISTICS, {"numpy": np, "env": env})
    with pytest.raises(PolicyError, match="clip_obs"):
        kit.load_policy("model.zip", task, statistics="statistics.npz")


class Spy:
    """What is pickled in a hostile archive: loading it writes a file."""

    def __init__(self, file: Path) -> None:
        self.file = file

    def __reduce__(self) -> tuple[Any, ...]:
        return Path.touch, (self.file,)


@pytest.mark.parametrize("place", ["weights", "description"])
def test_a_hostile_archive_runs_nothing(place: str, tmp_path: Path) -> None:
    spy, ran = Spy(tmp_path / "ran"), tmp_path / "ran"
    packed = io.BytesIO()
    torch.save({"action_net.weight": spy if place == "weights" else torch.zeros(1)}, packed)
    hostile = io.BytesIO()
    torch.save(spy, hostile)
    import base64
    import pickle

    blob = base64.b64encode(pickle.dumps(spy)).decode()
    about = {"policy_kwargs": {":serialized:": blob}, "_last_obs": {":serialized:": blob}, "num_timesteps": 1}
    with zipfile.ZipFile(tmp_path / "model.zip", "w") as archive:
        archive.writestr("policy.pth", packed.getvalue())
        archive.writestr("pytorch_variables.pth", hostile.getvalue())
        archive.writestr("data", json.dumps(about))
    with pytest.raises(PolicyError):
        kit.load_policy(tmp_path / "model.zip", "turn")
    assert not ran.exists()
    torch.load(io.BytesIO(hostile.getvalue()), weights_only=False)
    assert ran.exists(), "what was refused would have run"


def damaged(model: bytes, how: str) -> bytes:
    if how == "cut":
        return model[: len(model) // 2]
    parts = {}
    with zipfile.ZipFile(io.BytesIO(model)) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    parts |= {"no description": {"data": b"["}, "no weights": {"policy.pth": b""}}[how]
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as archive:
        for name, data in parts.items():
            archive.writestr(name, data)
    return made.getvalue()


@pytest.mark.parametrize("how", ["cut", "no description", "no weights"])
def test_a_damaged_model_is_refused_in_a_sentence(how: str, tmp_path: Path) -> None:
    model, task = make_model("PPO")
    file = tmp_path / "model.zip"
    model.save(file)
    file.write_bytes(damaged(file.read_bytes(), how))
    with pytest.raises(PolicyError, match="damaged"):
        kit.load_policy(file, task)


def test_what_does_not_fit_is_said(tmp_path: Path) -> None:
    model, task = make_model("PPO")
    file = tmp_path / "model.zip"
    model.save(file)
    with pytest.raises(PolicyError, match="task='turn'"):
        kit.load_policy(file)
    for other in ("hallway", "smooth-turn"):
        with pytest.raises(PolicyError, match=other):
            kit.load_policy(file, other)
        with pytest.raises(PolicyError, match=other):
            kit.export_policy(model, other)
    for refused in (lambda: kit.load_policy(file, "hallway"), lambda: kit.export_policy(model, "hallway")):
        with pytest.raises(PolicyError, match="sees 9 numbers and gives 3; an agent of task hallway sees 17"):
            refused()
    with pytest.raises(PolicyError, match="export_policy"):
        kit.evaluate_policy(model)
    (tmp_path / "text.zip").write_text("a text")
    with pytest.raises(PolicyError, match="stable-baselines3"):
        kit.load_policy(tmp_path / "text.zip", task)
    elu = sb3.PPO(
        "MlpPolicy", kit.make_vec_env(task, 4), device="cpu", policy_kwargs={"activation_fn": nn.ELU}
    )
    elu.save(file)
    with pytest.raises(PolicyError, match="ELU"):
        kit.load_policy(file, task)
    with pytest.raises(PolicyError, match="something else"):
        kit.export_policy(elu, task)


def test_a_torch_module_becomes_a_policy(tmp_path: Path) -> None:
    actor = nn.Sequential(nn.Linear(9, 8), nn.ReLU(), nn.Dropout(0.5), nn.Linear(8, 3))
    policy = kit.export_policy(actor, "turn")
    seen = what_it_may_see("turn")
    with torch.no_grad():
        best = actor.eval()(torch.as_tensor(seen)).argmax(dim=1).numpy()
    assert (policy.predict(seen)[0] == best).mean() > 0.99
    one, memory = policy.predict(seen[0])
    assert (np.shape(one), memory) == ((), None)
    drawn = [int(policy.predict(seen[0], deterministic=False)[0]) for _ in range(200)]
    assert set(drawn) <= {0, 1, 2}
    with pytest.raises(ValueError, match="9 numbers"):
        policy.predict(seen[:, :5])


class ActorCritic(nn.Module):
    """As many write it: a critic beside the actor, functions between its layers."""

    def __init__(self, between: Callable[[torch.Tensor], torch.Tensor]) -> None:
        super().__init__()
        self.critic = nn.Linear(9, 1)
        self.first, self.second, self.last = nn.Linear(9, 8), nn.Linear(8, 8), nn.Linear(8, 3)
        self.between = between

    def forward(self, seen: torch.Tensor) -> torch.Tensor:
        scores: torch.Tensor = self.last(self.between(self.second(self.between(self.first(seen)))))
        return scores


def test_what_a_module_calls_is_its_policy() -> None:
    seen = np.random.default_rng(1).uniform(0, 1, (50, 9)).astype(np.float32)
    for between in (nn.Tanh(), nn.ReLU(), torch.tanh, torch.relu):
        module = ActorCritic(between)
        policy = kit.export_policy(module, "turn")
        best = module(torch.as_tensor(seen)).argmax(dim=1).numpy()
        np.testing.assert_array_equal(policy.predict(seen)[0], best)
    with pytest.raises(PolicyError, match="something else"):
        kit.export_policy(ActorCritic(torch.nn.functional.gelu), "turn")


class Doubled(nn.Module):
    """Does more than its layers one after the other."""

    def __init__(self) -> None:
        super().__init__()
        self.one, self.other = nn.Linear(9, 9), nn.Linear(9, 3)

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        return self.other(self.one(x) + x)


class Unwritten(nn.Module):
    """Fails without a word."""

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        raise NotImplementedError


@pytest.mark.parametrize(
    ("module", "reason"),
    [
        (nn.Sequential(nn.Linear(9, 8), nn.GELU(), nn.Linear(8, 3)), "GELU"),
        (nn.Sequential(nn.Linear(9, 8), nn.Tanh(), nn.Linear(8, 8), nn.ReLU(), nn.Linear(8, 3)), "the same"),
        (nn.Sequential(nn.Linear(9, 3), nn.Tanh()), "after the last"),
        (nn.Sequential(nn.Linear(7, 3)), "the 9 numbers"),
        (nn.Sequential(nn.Linear(9, 4)), "4 scores|4 actions|from 3"),
        (nn.Identity(), "no linear layer"),
        (Doubled(), "something else"),
        (Unwritten(), "the 9 numbers"),
    ],
    ids=str,
)
def test_a_module_that_the_kit_cannot_be_is_refused(module: nn.Module, reason: str) -> None:
    with pytest.raises(PolicyError, match=reason):
        kit.export_policy(module, "turn")


def write_zip(folder: Path) -> tuple[Path, str]:
    """A model of stable-baselines3 as it saves itself, with the weights that it begins with."""
    model, task = make_model("PPO")
    model.save(folder / "model.zip")
    return folder / "model.zip", task


@pytest.mark.long
@pytest.mark.parametrize("origin", ["zip", "module"])
def test_a_script_races_and_exports_what_was_trained_elsewhere(origin: str, tmp_path: Path) -> None:
    if origin == "zip":
        file, task = write_zip(tmp_path)
        policy = kit.load_policy(file, task=task)
    else:
        actor = nn.Sequential(nn.Linear(9, 8), nn.Tanh(), nn.Linear(8, 3))
        policy = kit.export_policy(actor, "turn")
    kit.save_policy(policy, tmp_path / "mine.npz")
    mine = str(tmp_path / "mine.npz")
    runner = CliRunner()
    raced = runner.invoke(main, ["game", "race", "turn", "--agent", mine])
    assert raced.exit_code == 0, raced.output
    assert "from the next target" in raced.output
    words = ["evaluate", mine, "--package", "from_outside", "--dest", str(tmp_path)]
    made = runner.invoke(main, words)
    assert made.exit_code == 0, made.output
    program = (tmp_path / "from_outside/from_outside/policy.py").read_text()
    assert "import torch" not in program
    found = compare(kit.load_policy(mine), kit.find_task("turn").file or tmp_path, (5,))[1]
    assert all(each.same_commands == 1.0 for each in found.values())
