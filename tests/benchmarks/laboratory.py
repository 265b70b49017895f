"""Whether the kit's own tasks are learned: ``python tests/benchmarks/laboratory.py [TASK ...]`` (needs the extra ``learn``).

Each task of ``kit/learning/tasks`` that is not the dissertation's is trained with the kit's preset from seeds that were not looked
at while it was made, and tested on fresh episodes. One line a training, then one table: how many seeds reached the
goal in their worst case, the success of all seeds together with its 95 % interval, and minutes. ``--seeds N`` (5),
``--algo NAME`` (ppo), ``--steps N`` (the preset's), ``--episodes N`` of each case in the final test (500), ``--goal`` (0.9).

What has been trained is kept in a file, ``--state`` (laboratory.jsonl in the folder for temporary files), a line a training: the
same command goes on where it was interrupted, and ``--show`` prints the table of what there is without training. A line
that another version of the task or other settings made does not count.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory, gettempdir

sys.path.insert(0, str(Path(__file__).parents[2]))

from kit.learning.policies.confidence_intervals import wilson_interval
from kit.learning.policies.evaluation import Evaluator
from kit.learning.tasks.catalogue import TASKS, all_tasks, find_task
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.run_config import RunConfig
from kit.learning.training.run_folders import create_run
from kit.learning.training.training import train

FIRST_SEED = 7000
FINAL_TEST = 987_654_321


@dataclass(frozen=True)
class Settings:
    """What a training and its final test depend on besides the seed."""

    task: str
    version: str
    """Of the task's file and everything it names."""
    steps: int | None
    episodes: int
    algorithm: str = "ppo"


@dataclass(frozen=True)
class Learned:
    """One training, and the final test of what it kept."""

    settings: Settings
    seed: int
    steps: int
    minutes: float
    cpu_minutes: float
    shares: dict[str, float]
    """Of each case, the share of the episodes that reached the goal."""
    failure: str = ""
    """Why there is no policy, where a training ended otherwise than it should."""

    @property
    def worst(self) -> tuple[float, str]:
        """The smallest share, and its case; 0 where nothing was learned."""
        return min(((share, case) for case, share in self.shares.items()), default=(0.0, self.failure))


def learned(settings: Settings, seed: int, folder: Path) -> Learned:
    """Trains once, and tests what was kept."""
    run = create_run(
        folder, RunConfig(TaskSpec(settings.task), settings.algorithm, seed=seed, steps=settings.steps)
    )
    began, cpu = time.monotonic(), time.process_time()
    ended = train(run)
    minutes, cpu_minutes = (time.monotonic() - began) / 60, (time.process_time() - cpu) / 60
    if ended.how != "finished":
        return Learned(settings, seed, ended.steps, minutes, cpu_minutes, {}, f"{ended.how}: {ended.reason}")
    policy = run.policy()
    result = Evaluator(policy.trained_on.resolve()).test(policy, settings.episodes, FINAL_TEST)
    shares = {case.case: case.share for case in result.cases}
    return Learned(settings, seed, ended.steps, minutes, cpu_minutes, shares)


def read_state(file: Path) -> list[Learned]:
    """What has been trained so far; a line that was cut off by a kill is left out."""
    lines = file.read_text().splitlines() if file.exists() else []
    found = []
    for line in lines:
        try:
            values = json.loads(line)
        except ValueError:
            continue
        found.append(Learned(Settings(**values.pop("settings")), **values))
    return found


def table_row(settings: Settings, found: Sequence[Learned], goal: float) -> str:
    """How many seeds have learned, the success of all together, minutes and steps."""
    if not found:
        return f"{settings.task:20} not run"
    good = sum(each.worst[0] >= goal for each in found)
    episodes = settings.episodes * sum(max(1, len(each.shares)) for each in found)
    reached = round(settings.episodes * sum(sum(each.shares.values()) for each in found))
    low, high = wilson_interval(reached, episodes)
    worst = min(each.worst[0] for each in found)
    minutes, cpu, steps = (
        median(getattr(each, name) for each in found) for name in ("minutes", "cpu_minutes", "steps")
    )
    return (
        f"{settings.task:20} {good} of {len(found)}   {reached / episodes:.3f} ({low:.3f} to {high:.3f})   {worst:.3f}   "
        f"{minutes:7.1f} {cpu:7.1f} {steps:11,.0f}"
    )


def main() -> None:
    """Reads the arguments, trains what is missing, and prints the table."""
    own = [task.name for task in all_tasks() if task not in TASKS]
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("tasks", nargs="*", default=own, metavar="TASK", help=", ".join(own))
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--algo", default="ppo")
    parser.add_argument("--steps", type=int)
    parser.add_argument("--episodes", type=int, default=500)
    parser.add_argument("--goal", type=float, default=0.9)
    parser.add_argument("--state", type=Path, default=Path(gettempdir()) / "laboratory.jsonl")
    parser.add_argument("--show", action="store_true")
    chosen = parser.parse_args()
    rows = []
    for name in chosen.tasks:
        settings = Settings(name, find_task(name).version, chosen.steps, chosen.episodes, chosen.algo)
        known = {each.seed: each for each in read_state(chosen.state) if each.settings == settings}
        for seed in range(FIRST_SEED, FIRST_SEED + chosen.seeds):
            if seed not in known and not chosen.show:
                with TemporaryDirectory() as folder:
                    known[seed] = learned(settings, seed, Path(folder))
                with chosen.state.open("a") as file:
                    file.write(json.dumps(asdict(known[seed])) + "\n")
            if seed in known:
                each, (share, case) = known[seed], known[seed].worst
                figures = f"{each.steps:,} steps, {each.minutes:.1f} min, worst {share:.3f} ({case})"
                print(f"{name}, seed {seed}: {figures}", flush=True)
        rows.append(table_row(settings, [known[seed] for seed in sorted(known)], chosen.goal))
    print(f"\n{'task':20} learned   success, 95 % interval       worst   minutes     CPU  steps (medians)")
    print("\n".join(rows))


if __name__ == "__main__":
    main()
