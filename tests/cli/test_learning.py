"""The verbs of learning, as a user types them."""

from __future__ import annotations

import json
from importlib.util import find_spec
from pathlib import Path

import pytest

from kit.learning.policies.policy_file import load_policy
from kit.learning.training.algorithms import IMITATION_ALGORITHMS, algorithms_for
from kit.learning.training.training_sweep import TrainingSweep
from tests.cli.verbs import kit

QUICK = ("--algo", "q-learning", "--steps", "4000", "--keep-training")


@pytest.mark.long
def test_from_training_to_a_node(tmp_path: Path) -> None:
    output = kit("train", "turn", *QUICK, "--name", "first").output
    assert "started" in output
    assert "finished after 4,000 steps" in output
    assert output.count("TEST") == 1  # it ended before its strategy's first look: one is made at the end
    assert kit("runs").output.count("first") == 1
    assert "finished" in kit("runs", "first").output
    assert json.loads(kit("runs", "--json").output)[0]["name"] == "first"
    kit("runs", "first", "--rename", "other")
    assert "first is called" not in kit("runs", "other", "--rename", "first").output
    assert kit("watch", "first", "--once").output in output or "started" in output
    assert "worst" in kit("evaluate", "--episodes", 20).output
    data = json.loads(kit("evaluate", "first", "--episodes", 20, "--json").output)
    assert set(data["cases"]) == {"turn_a_to_b", "turn_b_to_a"}
    kit("evaluate", "first", "--episodes", 2, "--pictures", tmp_path / "seen")
    assert {file.name for file in (tmp_path / "seen").iterdir()} == {"turn_a_to_b.png", "turn_b_to_a.png"}
    assert "turn_a_to_b" in kit("evaluate", "first", "--episodes", 2, "--paths", 2).output
    table = kit("compare", "first", "first", "--episodes", 10, "--curves").output
    assert "worst" in table
    swept = ("evaluate", "first", "--episodes", 2, "--sweep", "--kinds", "latency")
    assert "latency [s]" in kit(*swept, "--csv", tmp_path / "sweep.csv").output
    assert (tmp_path / "sweep.csv").read_text().startswith("kind,unit,value")
    assert len(json.loads(kit(*swept, "--json").stdout)["points"]) == 6
    assert "Under drift 1 rad/m" in kit("evaluate", "first", "--episodes", 2, "--drift", "1").output
    assert "latency 0:0.2 s" in kit("train", "turn", *QUICK, "--name", "robust", "--latency", "0:0.2").output
    assert "Under latency 0:0.2 s" in kit("evaluate", "robust", "--episodes", 2).output
    kit("evaluate", "first", "--node", tmp_path / "node.py")
    compile((tmp_path / "node.py").read_text(), "node.py", "exec")


@pytest.mark.long
@pytest.mark.skipif(find_spec("torch") is None, reason="the extra learn is not installed")
def test_a_continuous_policy_is_watched_tested_exported_and_imitated(tmp_path: Path) -> None:
    kit("train", "smooth-turn", "--steps", 40_000, "--seed", 101, "--name", "first", "--plain")
    assert "finished" in kit("runs", "first").output
    assert "finished after" in kit("watch", "first", "--once").output
    found = json.loads(kit("evaluate", "first", "--episodes", 50, "--json").output)
    assert found["worst"] > 0.9
    assert "worst" in kit("evaluate", "first", "--episodes", 10, "--sampled").output
    kit("evaluate", "first", "--package", "my_agent", "--dest", tmp_path)
    assert "BOUNDS = [[-0.2, 0.5]" in (tmp_path / "my_agent" / "my_agent" / "policy.py").read_text()
    kit("train", "smooth-turn", "--imitate", "first", "--name", "second", "--plain")
    table = json.loads(kit("compare", "first", "second", "--episodes", 50, "--json").output)
    assert table["second"]["worst"] > 0.9
    assert (tmp_path / "workspace" / "runs" / "second" / "demonstration-0.npz").is_file()
    node = tmp_path / "node.py"
    kit("evaluate", "second", "--node", node)
    driven = kit("run", "turn", "--controller", node, "--until-reached", "--steps", 3000).output
    assert "target       reached" in driven
    assert "0 bumps" in driven


MISTAKES = {
    "no task": (("train",), "kit train turn"),
    "two sides not alike": (("train", "turn", "--mirrored"), "task turn has no mirror image"),
    "a table in a mirror": (("train", "hallway", "--algo", "sarsa", "--mirrored"), "leave out --mirrored"),
    "unknown task": (("train", "trun"), "turn"),
    "unknown case": (("train", "hallway", "--on", "dors"), "doors"),
    "unknown algorithm": (("train", "turn", "--algo", "pppo"), "ppo"),
    "continuous alone": (("train", "turn", "--algo", "sac"), "smooth-turn"),
    "a table alone": (("train", "smooth-turn", "--algo", "dqn"), "sac"),
    "nobody to imitate": (("train", "smooth-turn", "--algo", "bc"), "--imitate fields"),
    "imitated by a reward": (("train", "turn", "--algo", "ppo", "--imitate", "fields"), "bc or dagger"),
    "an unknown controller": (("train", "smooth-turn", "--imitate", "feilds"), 'did you mean "fields'),
    "unknown reward": (("train", "turn", "--algorithm-reward", "mine"), "algorithm-1"),
    "bad name": (("train", "turn", *QUICK, "--name", "../x"), "letters"),
    "no such run": (("watch", "nothing"), "kit train turn"),
    "nothing to go on with": (("train", "--resume", "nothing"), "no run"),
    "nothing to test": (("evaluate",), "kit train turn"),
    "nothing to stop": (("runs", "--stop"), "kit train turn"),
    "impossible disturbance": (("evaluate", "--latency", "9"), "between 0 and 5 s"),
    "no range": (("train", "turn", "--drift", "1:"), "neither a number nor a range"),
    "kinds without a sweep": (("evaluate", "--kinds", "drift"), "--sweep"),
    "no such file": (("evaluate", "gone.npz"), "gone.npz"),
    "unknown group": (("sweep", "hallway", "--crosstable", "--algos", "sarsa", "--on", "stairs"), "stairs"),
}


@pytest.mark.long_cases("a table in a mirror")
@pytest.mark.parametrize(("arguments", "message"), MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_ends_with_a_clear_line(arguments: tuple[str, ...], message: str, tmp_path: Path) -> None:
    assert message in kit(*arguments, code=2).output
    assert not list((tmp_path / "workspace").glob("runs/*"))


def test_a_sweep_that_another_process_trains_is_refused(tmp_path: Path) -> None:
    words = ("sweep", "turn", "--algos", "q-learning", "--seeds", "1", "--steps", "2000", "--name", "mine")
    kit(*words, "--executor", "none")
    with TrainingSweep(tmp_path / "workspace" / "sweeps" / "mine").kept_from_others():
        assert "another process" in kit(*words, code=2).output


def test_a_bad_reward_is_told_before_anything_is_written(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text("def reward(speed):\n    return speed\n")
    output = kit("train", "turn", *QUICK, "--reward", file, code=2).output
    assert "mine.py:1" in output
    assert not list((tmp_path / "workspace").glob("runs/*"))


@pytest.mark.long
def test_a_reward_that_raises_is_shown_with_its_line(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text("def reward(step):\n    return 1 / (step - 5)\n")
    output = kit("train", "turn", *QUICK, "--reward", file, "--name", "bad", code=1).output
    assert f"{file}:2" in output
    assert "failed" in kit("runs").output


@pytest.mark.long
def test_a_policy_is_tested_on_cases_it_was_not_trained_on() -> None:
    kit("train", "turn", *QUICK, "--on", "turn_a_to_b", "--name", "one-way")
    own = json.loads(kit("evaluate", "one-way", "--episodes", 5, "--json").output)
    every = json.loads(kit("evaluate", "one-way", "--episodes", 5, "--on", "all", "--json").output)
    assert (len(own["cases"]), len(every["cases"])) == (1, 2)
    assert "17" in kit("evaluate", "one-way", "--task", "hallway", code=2).output


@pytest.mark.long
def test_a_finished_run_is_not_resumed_and_its_file_is_a_policy(tmp_path: Path) -> None:
    kit("train", "turn", *QUICK, "--name", "done")
    assert "has finished" in kit("train", "--resume", "done", code=2).output
    file = tmp_path / "workspace" / "runs" / "done" / "best.npz"
    assert load_policy(file).trained_on.task == "turn"
    assert "worst" in kit("evaluate", file, "--episodes", 3).output
    file.write_bytes(file.read_bytes()[:100])
    assert "damaged" in kit("evaluate", file, code=2).output


def test_everything_there_is_can_be_listed() -> None:
    output = kit("train", "--list").output
    for name in ("hallway", "curve_right_180", "recurrent-ppo", "algorithm-3"):
        assert name in output


def test_the_help_of_train_names_the_algorithms_by_kind_of_action() -> None:
    words = " ".join(kit("train", "--help").output.split()).replace(" and ", ", ")
    for is_continuous in (False, True):
        assert ", ".join(algorithms_for(is_continuous=is_continuous)) in words
    assert all(f" {name}" in words for name in IMITATION_ALGORITHMS)


@pytest.mark.long
def test_a_drive_on_another_map_or_asked_by_dagger_is_refused(tmp_path: Path) -> None:
    drive = tmp_path / "drive.npz"
    kit("run", "turn", "--controller", "forward", "--steps", 50, "--record", drive)
    output = kit("train", "smooth-hallway", "--imitate", drive, code=2).output
    assert "was driven on turn" in output
    assert "--record" in output
    assert (
        "cannot answer" in kit("train", "smooth-turn", "--algo", "dagger", "--imitate", drive, code=2).output
    )
    assert not list((tmp_path / "workspace").glob("runs/*"))
