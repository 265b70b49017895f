"""Whether the kit's own tasks are learned: ``python tests/benchmarks/laboratory.py [TASK ...]`` (needs the extra ``learn``).

Each task of ``kit/learning/tasks`` that is not the dissertation's is trained with the kit's preset from seeds that were not looked
at while it was made, and tested on fresh episodes. One line a training, then one table: how many seeds reached the
goal in their worst case, the success of all seeds together with its 95 % interval, and minutes. ``--seeds N`` (5),
``--steps N`` (the preset's), ``--episodes N`` of each case in the final test (500), ``--goal`` (0.9).
"""

from __future__ import annotations

import argparse
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).parents[2]))

from kit.learning.environment.task_spec import TaskSpec
from kit.learning.environment.tasks import TASKS, all_tasks
from kit.learning.policies.confidence_intervals import wilson_interval
from kit.learning.policies.evaluation import EvaluationResult, Evaluator
from kit.learning.training.runs import RunConfig, create_run
from kit.learning.training.training import train

FIRST_SEED = 7000
FINAL_TEST = 987_654_321


@dataclass(frozen=True)
class Learned:
    """One training, and the final test of what it kept."""

    steps: int
    minutes: float
    cpu_minutes: float
    result: EvaluationResult


def learned(task: str, seed: int, steps: int | None, episodes: int, folder: Path) -> Learned:
    config = RunConfig(TaskSpec(task), seed=seed, steps=steps)
    run = create_run(folder, config)
    began, cpu = time.monotonic(), time.process_time()
    ended = train(run)
    minutes, cpu_minutes = (time.monotonic() - began) / 60, (time.process_time() - cpu) / 60
    if ended.how != "finished":
        raise SystemExit(f"{task}, seed {seed}: {ended.how}: {ended.reason}")
    policy = run.policy()
    result = Evaluator(policy.trained_on.resolve()).test(policy, episodes, FINAL_TEST)
    return Learned(ended.steps, minutes, cpu_minutes, result)


def table_row(task: str, found: list[Learned], goal: float) -> str:
    good = sum(each.result.worst.share >= goal for each in found)
    reached = sum(case.reached for each in found for case in each.result.cases)
    episodes = sum(case.episodes for each in found for case in each.result.cases)
    low, high = wilson_interval(reached, episodes)
    worst = min(each.result.worst.share for each in found)
    minutes = median(each.minutes for each in found)
    cpu = median(each.cpu_minutes for each in found)
    steps = median(each.steps for each in found)
    return (
        f"{task:20} {good} of {len(found)}   {reached / episodes:.3f} ({low:.3f} to {high:.3f})   {worst:.3f}   "
        f"{minutes:7.1f} {cpu:7.1f} {steps:11,.0f}"
    )


def main() -> None:
    own = [task.name for task in all_tasks() if task not in TASKS]
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("tasks", nargs="*", default=own, metavar="TASK", help=", ".join(own))
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--steps", type=int)
    parser.add_argument("--episodes", type=int, default=500)
    parser.add_argument("--goal", type=float, default=0.9)
    chosen = parser.parse_args()
    rows = []
    for task in chosen.tasks:
        found = []
        for seed in range(FIRST_SEED, FIRST_SEED + chosen.seeds):
            with TemporaryDirectory() as folder:
                each = learned(task, seed, chosen.steps, chosen.episodes, Path(folder))
            found.append(each)
            worst = each.result.worst
            print(
                f"{task}, seed {seed}: {each.steps:,} steps, {each.minutes:.1f} min, mean {each.result.mean:.3f}, "
                f"worst {worst.share:.3f} ({worst.case})",
                flush=True,
            )
        rows.append(table_row(task, found, chosen.goal))
    print(f"\n{'task':20} learned   success, 95 % interval       worst   minutes     CPU  steps (medians)")
    print("\n".join(rows))


if __name__ == "__main__":
    main()
