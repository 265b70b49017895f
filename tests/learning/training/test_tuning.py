"""Settings: changed by name, refused with the way out, compared in a sweep, and searched with optuna."""

from __future__ import annotations

import re
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.algorithm_settings import LinearSchedule
from kit.learning.training.algorithms import ALGORITHMS, find_algorithm
from kit.learning.training.presets import find_preset
from kit.learning.training.run_config import RunConfig, RunError, format_settings
from kit.learning.training.sweep_table import sweep_rows
from kit.learning.training.training import resolve_preset
from kit.learning.training.training_sweep import SweepResult, TrainingSweep, combine
from kit.learning.training.tuning import SettingRange, check_ranges, tune

needs_learner = pytest.mark.skipif(find_spec("torch") is None, reason="the extra learn is not installed")
TABULAR = RunConfig(TaskSpec("turn"), "q-learning", steps=2_000)
GAMMA = SettingRange("gamma", 0.9, 0.999)


def test_a_setting_replaces_that_of_the_preset() -> None:
    changed = replace(TABULAR, settings=(("gamma", 0.5), ("rate", 0.25)))
    own, found = resolve_preset(TABULAR), resolve_preset(changed)
    assert found == replace(own, settings=replace(own.settings, gamma=0.5, rate=LinearSchedule(0.25, 0.25)))
    assert RunConfig.from_dict(changed.as_dict()) == changed


def test_settings_that_are_none_are_refused() -> None:
    for settings, told in (
        ((("gama", 0.5),), 'did you mean "gamma"'),
        ((("edges", 0.5),), "no setting"),
        ((("gamma", 1.5),), "from 0 to 1"),
        ((("gamma", -0.5),), "from 0 to 1"),
    ):
        with pytest.raises(RunError, match=told):
            resolve_preset(replace(TABULAR, settings=settings))
    for broken in ([1], {"gamma": "0.5"}, {"gamma": True}, 3):
        with pytest.raises(ValueError, match=r"numbers|configuration"):
            RunConfig.from_dict({**TABULAR.as_dict(), "settings": broken})


@needs_learner
def test_what_an_algorithm_offers_its_library_takes() -> None:
    for algorithm in ALGORITHMS.values():
        preset = find_preset("kit", algorithm, "turn", is_continuous=algorithm.actions == "continuous")
        names = preset.setting_types(algorithm)
        assert "learning_rate" in names or algorithm.family == "table"
        if algorithm.library != "kit":
            assert set(names) <= set(algorithm.library_defaults())
    a2c = find_algorithm("a2c")
    with pytest.raises(RunError, match="a2c has no setting"):
        find_preset("kit", a2c, "turn").changed({"clip_range": 0.1}, a2c)
    ppo = find_algorithm("ppo")
    with pytest.raises(RunError, match="whole number"):
        find_preset("kit", ppo, "turn").changed({"n_steps": 3.5}, ppo)
    changed = find_preset("kit", ppo, "turn").changed({"n_steps": 32.0, "learning_rate": 0.01}, ppo)
    arguments = changed.learner_arguments()
    assert (arguments["n_steps"], type(arguments["n_steps"])) == (32, int)
    assert arguments["learning_rate"](0.5) == 0.01


def test_a_sweep_compares_settings(tmp_path: Path) -> None:
    configs = combine(
        ["turn"], algorithms=["q-learning"], seeds=[1, 2], settings={"gamma": (0.9, 0.95), "rate": (0.1,)}
    )
    assert len(set(configs)) == 4
    rows = sweep_rows(TrainingSweep.prepare(tmp_path, configs, 10))
    assert [row.group[-1] for row in rows] == ["gamma=0.9 rate=0.1", "gamma=0.95 rate=0.1"]


def cost_of_gamma(settings: tuple[tuple[str, float], ...]) -> SweepResult:
    """A training that ends the sooner, the nearer gamma is to 0.95."""
    gamma = dict(settings)["gamma"]
    return SweepResult(steps=int(1 + 1e5 * abs(gamma - 0.95)), mean=1.0, worst=1.0, episodes=10)


class TrainingStandIn:
    """Saves a result for everything a sweep waits for, at most ``patience`` times."""

    def __init__(self, patience: int = 1000) -> None:
        self.patience, self.trained = patience, 0

    def __call__(self, sweep: TrainingSweep) -> None:
        entries = {entry.key: entry.config for entry in sweep.entries()}
        for key in sweep.waiting():
            if self.trained == self.patience:
                raise KeyboardInterrupt
            self.trained += 1
            sweep._save_result(key, cost_of_gamma(entries[key].settings))


def search(folder: Path, run: Any, trials: int = 14) -> list[str]:
    sweep = tune(folder, TABULAR, [GAMMA], [1, 2], trials=trials, episodes=10, run=run)
    return [row.group[-1] for row in sorted(sweep_rows(sweep), key=lambda row: row.cost)]


def test_a_search_finds_what_is_cheap_and_goes_on_where_it_was_interrupted(tmp_path: Path) -> None:
    whole = TrainingStandIn()
    found = search(tmp_path / "whole", whole)
    assert len(found) == whole.trained / 2 >= 10
    assert abs(float(found[0].removeprefix("gamma=")) - 0.95) < 0.01
    first, rest = TrainingStandIn(11), TrainingStandIn()
    with pytest.raises(KeyboardInterrupt):
        search(tmp_path / "parts", first)
    assert search(tmp_path / "parts", rest) == found
    assert first.trained + rest.trained == whole.trained, "nothing is trained twice"
    assert len(search(tmp_path / "parts", rest, trials=4)) == len(found), "what is known stays"
    with pytest.raises(RunError, match="--name"):
        tune(tmp_path / "parts", replace(TABULAR, steps=7), [GAMMA], [1, 2], trials=4, episodes=10, run=rest)


def test_trainings_that_fail_do_not_end_a_search(tmp_path: Path) -> None:
    def run(sweep: TrainingSweep) -> None:
        for key in sweep.waiting():
            sweep.record_loss(key)

    sweep = tune(tmp_path, TABULAR, [GAMMA], [1], trials=6, episodes=10, run=run)
    assert all(row.cost == float("inf") for row in sweep_rows(sweep))
    assert len(sweep.entries()) >= 5


def test_settings_are_written_as_they_are_read() -> None:
    assert format_settings((("gamma", 0.98), ("buffer_size", 1234567))) == "gamma=0.98 buffer_size=1234567"


def test_a_range_must_suit_its_setting() -> None:
    for wrong in (SettingRange("gamma", 0.9, 1.2), SettingRange("gamme", 0.9, 0.99)):
        with pytest.raises(RunError):
            check_ranges(TABULAR, [wrong])


def kit(*arguments: str) -> tuple[int, str]:
    done = CliRunner().invoke(main, [*arguments], env={"COLUMNS": "80"})
    assert "Traceback" not in done.output
    return done.exit_code, done.output


def test_mistakes_are_told_before_anything_is_written() -> None:
    table = ("turn", "--algos", "q-learning")
    for words, told in (
        (("train", "turn", "--algo", "q-learning", "--set", "gama=0.5"), "gamma"),
        (("train", "turn", "--algo", "q-learning", "--set", "gamma"), "NAME=NUMBER"),
        (("train", "turn", "--algo", "q-learning", "--set", "gamma=nan"), "finite"),
        (("train", "turn", "--algo", "q-learning", "--set", "gamma=0.5,0.6"), "kit sweep"),
        (("train", "turn", "--set", "gamma=0.5", "--set", "gamma=0.6"), "more than once"),
        (("train", "turn", "--set", "learning_rate=0.1", "--learning-rate", "0.1"), "one of them"),
        (("sweep", *table, "--tune", "gamma=0.9"), "LOW:HIGH"),
        (("sweep", *table, "--tune", "gamma=0.9:0.8"), "LOW:HIGH"),
        (("sweep", *table, "--tune", "gamma=0.9:0.95", "--tune", "gamma=0.9:0.99"), "one range"),
        (("sweep", *table, "--tune", "gamma=0.9:0.95", "--set", "gamma=0.9"), "--set and by --tune"),
        (("sweep", *table, "--tune", "gamma=0.9:0.95", "--presets", "kit,seed"), "at a time"),
        (("sweep", *table, "--tune", "gamma=0.9:1.95"), "from 0 to 1"),
    ):
        code, output = kit(*words)
        assert (code, told in output) == (2, True), output


def test_the_settings_of_an_algorithm_are_listed_with_the_numbers_of_its_preset() -> None:
    code, output = kit("train", "turn", "--algo", "q-learning", "--list")
    lines = dict(line.split(maxsplit=1) for line in output.splitlines()[1:])
    assert (code, lines) == (0, {"rate": "0.2 to 0.02", "gamma": "0.99", "epsilon": "0.3 to 0.02"})
    assert kit("train", "trun", "--list")[0] == 2


@needs_learner
@pytest.mark.parametrize(
    "words", [("train", "--set", "n_steps=1e300"), ("sweep", "--tune", "n_steps=1:1e300")]
)
def test_a_count_has_a_limit(words: tuple[str, ...]) -> None:
    code, output = kit(words[0], "turn", *words[1:])
    assert (code, "from 1 to 100,000" in output) == (2, True), output


@needs_learner
def test_a_setting_that_a_preset_leaves_alone_is_listed_as_the_library_has_it() -> None:
    output = kit("train", "turn", "--list")[1]
    assert re.search(r"^  max_grad_norm +0.5 \(the library's\)$", output, re.MULTILINE), output


@pytest.mark.long
def test_a_small_search_on_this_machine(tmp_path: Path) -> None:
    words = ("sweep", "turn", "--algos", "q-learning", "--steps", "3000", "--episodes", "5", "--seeds", "1")
    options = ("--tune", "rate=0.01:0.5", "--trials", "5", "--name", "small", "--workspace", str(tmp_path))
    code, output = kit(*words, *options)
    assert code == 0, output
    assert output.count("rate=") == 5
    assert kit(*words, *options, "--executor", "none")[1].count("rate=") == 5
