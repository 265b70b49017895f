"""A sweep of trainings: every combination of tasks, cases, algorithms, presets and rewards, from several seeds each.

A folder holds all of it: ``manifest.json`` what is trained, ``runs/`` a training run for each, ``results/KEY.json`` what came of
it. A run's key is a digest of its configuration, so that any number of processes can share the work, and the same sweep
goes on where it was.
"""

from __future__ import annotations

import hashlib
import itertools
import json
import os
import signal
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any, ClassVar, Final

from kit.field_types import check_field_types
from kit.host.job_executors import read_result
from kit.host.job_folder import JobFolder
from kit.host.python_command import python_command
from kit.learning.policies.evaluation import evaluate_on
from kit.learning.policies.seeds import derive_seed
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.process_lock import holds_open, is_locked, process_lock
from kit.learning.training.run_config import PresetName, RunConfig, RunError, format_settings
from kit.learning.training.run_folders import RunExists, create_run
from kit.learning.training.runs import TrainingRun
from kit.learning.training.training import train
from kit.plain_files import foreign_part, read_plain_file
from kit.workspace import make_private_folder, write_atomically

ALL_CASES = "all"
TAKEOVER_S = 20.0
"""Time to wait for a training that another process runs [s]."""


SweepGroup = tuple[str, str, str, str, str, str]


@dataclass(frozen=True, slots=True)
class SweepEntry:
    """One training of a sweep."""

    key: str
    config: RunConfig

    @property
    def group(self) -> SweepGroup:
        """Task, cases, algorithm, preset, reward and changed settings: what trainings from several seeds have in common."""
        config = self.config
        reward = config.choice.reward or (
            Path(config.reward_file).name if config.reward_file else "the task's"
        )
        cases = ", ".join(config.choice.on) or ALL_CASES
        settings = format_settings(config.settings) or "the preset's"
        return config.choice.name, cases, config.algorithm, config.preset, reward, settings


LOCK_FILE: Final = "lock"
"""Is locked by the process that trains a sweep, and holds its number."""


@dataclass(frozen=True, slots=True)
class SweepResult:
    """What came of a training: its policy's test on fresh episodes."""

    steps: int = 0
    seconds: float = 0.0
    mean: float = 0.0
    """Mean success of the cases."""
    worst: float = 0.0
    worst_case: str = ""
    reached: int = 0
    episodes: int = 0
    problem: str = ""
    """Why there is no result; the next start of the sweep tries again."""
    metrics: Mapping[str, float] = field(default_factory=dict)
    """Mean of each metric of the task's own reward file, by name."""


@dataclass(frozen=True, slots=True)
class TrainingSweep(JobFolder):
    """The folder of a sweep."""

    job_name: ClassVar[str] = "kit-sweep"

    @classmethod
    def prepare(
        cls, folder: Path, configs: Sequence[RunConfig], episodes: int, *, grows: bool = False
    ) -> TrainingSweep:
        """Makes the folder, or takes up the one that is there. RunError if it holds another sweep. OSError.

        ``grows``: the sweep that is there may be the beginning of this one, or this one of it; the longer one stays.
        """
        if folder.exists() and (part := foreign_part(folder)):
            raise RunError(
                f"{folder}: {part}. A sweep has plain files alone, because the kit writes to them."
            )
        sweep = cls(folder)
        frozen = [replace(config, choice=config.choice.frozen()) for config in configs]
        content = {"episodes": episodes, "runs": [config.as_dict() for config in frozen]}
        text = json.dumps(content, indent=1).encode()
        manifest = folder / "manifest.json"
        known, new = sweep._read_manifest() if manifest.exists() else None, json.loads(text)
        if known is not None and grows and known["runs"][: len(new["runs"])] == new["runs"]:
            text, new = json.dumps(known, indent=1).encode(), {**new, "runs": known["runs"]}
        elif known is not None and grows and new["runs"][: len(known["runs"])] == known["runs"]:
            known["runs"] = new["runs"]
        if known not in (None, new):
            raise RunError(f"{folder} contains a different sweep. Give this one another --name.")
        for part in ("runs", "results"):
            make_private_folder(folder / part)
        write_atomically(manifest, text)
        return sweep

    def _read_manifest(self) -> dict[str, Any]:
        try:
            content = read_result(self.folder / "manifest.json")
            if not {"episodes", "runs"} <= content.keys():
                raise ValueError
        except (OSError, ValueError):
            raise RunError(f"{self.folder}: not a sweep; `kit sweep` creates one.") from None
        return content

    @property
    def episodes(self) -> int:
        """Episodes per case in the final test."""
        return int(self._read_manifest()["episodes"])

    def entries(self) -> tuple[SweepEntry, ...]:
        """Every training, in order. RunError if the folder holds no sweep."""
        content = self._read_manifest()
        found = []
        for each in content["runs"]:
            told = json.dumps([each, content["episodes"]], sort_keys=True).encode()
            found.append(SweepEntry(hashlib.sha256(told).hexdigest()[:32], RunConfig.from_dict(each)))
        return tuple(found)

    def result(self, key: str) -> SweepResult | None:
        """None if there is none that can be read."""
        try:
            content = read_result(self._result_file(key))
            check_field_types(SweepResult, content)
            return SweepResult(**content)
        except (OSError, KeyError, TypeError, ValueError):
            return None

    def run_of(self, entry: SweepEntry) -> TrainingRun:
        """The training's run; its folder is there once the training has begun."""
        config = entry.config
        name = "-".join([config.choice.name, config.algorithm, str(config.seed), entry.key[:8]])
        return TrainingRun(self.folder / "runs" / name)

    @property
    def is_active(self) -> bool:
        """Whether a process trains it."""
        return is_locked(self.folder / LOCK_FILE)

    @contextmanager
    def kept_from_others(self) -> Iterator[None]:
        """Lets no other process train it meanwhile. Raises LockedError if one does."""
        with process_lock(self.folder / LOCK_FILE) as lock:
            lock.truncate(0)
            lock.write(b"%d" % os.getpid())
            lock.flush()
            yield

    def stop(self) -> None:
        """Ends the process that trains it; the training that runs leaves a checkpoint. Nothing if there is none."""
        if self.is_active:
            with suppress(OSError, ValueError):  # it has ended meanwhile
                process = int(read_plain_file(self.folder / LOCK_FILE, 20))
                # The sweep may be somebody else's, and its lock name any process.
                if process > 1 and holds_open(process, self.folder / LOCK_FILE):
                    os.kill(process, signal.SIGTERM)

    @property
    def worker_command(self) -> list[str]:
        return python_command("kit.learning.training.sweep_worker", str(self.folder.absolute()))

    @property
    def shard_command(self) -> list[str]:
        return self.worker_command

    def keys(self) -> tuple[str, ...]:
        return tuple(entry.key for entry in self.entries())

    def is_waiting(self, key: str) -> bool:
        """Whether a training has no result yet, or only a problem."""
        found = self.result(key)
        return found is None or bool(found.problem)

    def run_job(self, key: str, *, interrupted: Callable[[], bool] = lambda: False) -> None:
        """Trains and tests one of them, and saves the result; a training that was begun goes on.

        Raises KeyboardInterrupt if interrupted, and KeyError.
        """
        entry = {each.key: each for each in self.entries()}[key]
        run = self.run_of(entry)
        if not (run.folder / "config.json").exists():
            with suppress(RunExists):  # another process of this sweep has begun it at this moment
                create_run(self.folder / "runs", entry.config, run.name)
        waited_until = time.monotonic() + TAKEOVER_S
        while run.is_active and time.monotonic() < waited_until:
            time.sleep(0.1)  # the process of a sweep that was killed is about to end
        try:
            ended = run.summary() if run.summary().state == "finished" else None
            problem = "" if ended else self._train_run(run, interrupted)
            result = SweepResult(problem=problem) if problem else self._test_run(run)
        except RunError as error:
            result = SweepResult(problem=str(error))
        self._save_result(key, result)

    def record_loss(self, key: str) -> None:
        if self.result(key) is None:
            self._save_result(key, SweepResult(problem="its process died twice; is there enough memory?"))

    def _train_run(self, run: TrainingRun, interrupted: Callable[[], bool]) -> str:
        """Trains to the end; why it failed."""
        ended = train(run, interrupted=interrupted)
        return ended.reason if ended.how == "failed" else ""

    def _test_run(self, run: TrainingRun) -> SweepResult:
        config, summary = run.config(), run.summary()
        policy = run.policy()
        seed = derive_seed(config.seed, "training sweep")
        found = evaluate_on(policy.trained_on.resolve(), policy, self.episodes, seed)
        return SweepResult(
            steps=summary.steps,
            seconds=summary.seconds,
            mean=found.mean,
            worst=found.worst.share,
            worst_case=found.worst.case,
            reached=sum(case.reached for case in found.cases),
            episodes=sum(case.episodes for case in found.cases),
            metrics=found.metrics,
        )

    def _save_result(self, key: str, result: SweepResult) -> None:
        write_atomically(self._result_file(key), json.dumps(asdict(result)).encode())

    def _result_file(self, key: str) -> Path:
        return self.folder / "results" / f"{key}.json"


def combine(
    tasks: Sequence[str],
    *,
    cases: Sequence[str] = (ALL_CASES,),
    algorithms: Sequence[str] = ("ppo",),
    presets: Sequence[PresetName] = ("kit",),
    rewards: Sequence[str] = (),
    seeds: Sequence[int] = (0,),
    steps: int | None = None,
    settings: Mapping[str, Sequence[float]] = MappingProxyType({}),
) -> tuple[RunConfig, ...]:
    """Every combination. ``cases``: names or groups, each trained by itself, or ``all``. ``rewards``: those of the kit by name,
    or Python files; the task's own if there is none. ``settings``: one or more numbers for each name."""
    changes = [
        tuple(zip(settings, numbers, strict=True)) for numbers in itertools.product(*settings.values())
    ]
    combinations = itertools.product(tasks, cases, algorithms, presets, rewards or (None,), changes, seeds)
    configs = []
    for task, case, algorithm, preset, reward, changed, seed in combinations:
        file = str(Path(reward).absolute()) if reward is not None and reward.endswith(".py") else None
        on = () if case == ALL_CASES else (case,)
        spec = TaskSpec(task, on, reward=reward if file is None else None)
        configs.append(RunConfig(spec, algorithm, preset, seed, steps, reward_file=file, settings=changed))
    return tuple(configs)
