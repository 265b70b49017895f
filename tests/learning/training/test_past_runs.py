"""How long the next training will take is told by those of its kind that ended here, and by nothing else."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.events import EventWriter, TrainingEnded, TrainingProgress, TrainingStarted
from kit.learning.training.past_runs import expected_time
from kit.learning.training.run_config import RunConfig
from kit.learning.training.run_folders import create_run
from kit.learning.training.training import resolve_preset

CONFIG = RunConfig(TaskSpec("turn"), "q-learning", seed=3)


def ended(folder: Path, config: RunConfig, seconds: float, how: str = "finished") -> None:
    run = create_run(folder, config)
    with EventWriter(run.events_file) as writer:
        writer.write(TrainingStarted(1.5, 0, {}))
        writer.write(TrainingProgress(100, seconds, 200.0, {}, -1.0, 20.0, {}, None))
        writer.write(TrainingEnded(how, 200, seconds, ""))  # type: ignore[arg-type]  # one of the three


def test_the_median_of_those_like_it_counts(tmp_path: Path) -> None:
    for number, seconds in enumerate((10.0, 30.0, 11.0)):
        ended(tmp_path, replace(CONFIG, seed=number), seconds)
    ended(tmp_path, replace(CONFIG, algorithm="sarsa"), 500.0)
    ended(tmp_path, replace(CONFIG, preset="seed"), 600.0)
    ended(tmp_path, CONFIG, 0.5, "stopped")
    expected = expected_time(tmp_path, CONFIG)
    assert expected.usual_seconds == 11.0
    assert expected.most_steps == resolve_preset(CONFIG).steps
    assert expected.most_seconds == expected.most_steps / 200.0


def test_nothing_is_made_up_where_none_has_ended(tmp_path: Path) -> None:
    expected = expected_time(tmp_path, CONFIG)
    assert expected.usual_seconds is expected.most_seconds is None
    (tmp_path / "broken").mkdir()
    (tmp_path / "broken" / "config.json").write_text("{", encoding="utf-8")
    assert expected_time(tmp_path, CONFIG) == expected
