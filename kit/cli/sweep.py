"""``kit sweep``: many trainings, one table."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import asdict
from functools import partial
from pathlib import Path

import click

from kit.cli import learning_options, messages, options
from kit.cli.executor_options import executor_options
from kit.cli.output_file import OutputFile
from kit.cli.process import INTERRUPTED
from kit.document.layout import lines_of
from kit.host.job_executors import ExecutorUnavailable
from kit.host.job_folder import JobExecutor
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.crosstable import (
    case_groups,
    check_crosstable,
    crosstable_columns,
    crosstable_tables,
)
from kit.learning.training.process_lock import LockedError
from kit.learning.training.run_check import check_run_config
from kit.learning.training.run_config import PresetName, RunConfig, RunError
from kit.learning.training.run_folders import NAME_PATTERN
from kit.learning.training.sweep_table import problems, sweep_rows, sweep_table, sweep_table_csv
from kit.learning.training.training_sweep import TrainingSweep, combine
from kit.learning.training.tuning import SettingRange, check_ranges, require_optuna, tune
from kit.plain_text import counted
from kit.study.printed_tables import printed_means
from kit.workspace import write_atomically


def _read_seeds(
    context: click.Context, parameter: click.Parameter, text: str | None
) -> tuple[int, ...] | None:
    """``5``: the seeds 0 to 4; ``100:110``: 100 to 109; ``3,7``: these."""
    if text is None:
        return None
    try:
        if ":" in text:
            low, high = (int(part) for part in text.split(":"))
            seeds = tuple(range(low, high))
        elif "," in text:
            seeds = tuple(int(part) for part in text.split(","))
        else:
            seeds = tuple(range(int(text)))
    except ValueError:
        seeds = ()
    if not seeds or min(seeds) < 0 or len(set(seeds)) < len(seeds):
        raise click.BadParameter("give a count, such as 5, a range, 100:110, or a list, 3,7.")
    return seeds


def _read_ranges(
    context: click.Context, parameter: click.Parameter, texts: tuple[str, ...]
) -> tuple[SettingRange, ...]:
    """``gamma=0.9:0.999``: a setting, and the least and the most that it may be."""
    found = []
    for text in texts:
        name, _, numbers = text.partition("=")
        try:
            low, high = (float(number) for number in numbers.split(":"))
        except ValueError:
            low, high = 1.0, 0.0
        if not -math.inf < low < high < math.inf:
            raise click.BadParameter(f"{text}: give NAME=LOW:HIGH, such as gamma=0.9:0.999.")
        found.append(SettingRange(name.strip(), low, high))
    if len({each.name for each in found}) < len(found):
        raise click.BadParameter("each setting can have one range.")
    return tuple(found)


@click.command()
@click.argument("tasks", metavar="TASK ...", nargs=-1, required=True)
@click.option(
    "--seeds",
    callback=_read_seeds,
    help="Number of seeds, or a range (100:110), or a list (3,7) (default: 5; with --crosstable 1).",
)
@click.option("--algos", default="ppo", show_default=True, help="Algorithms, separated by commas.")
@click.option(
    "--presets", default="kit", show_default=True, help="kit, seed, seed-text, separated by commas."
)
@click.option(
    "--rewards",
    default="",
    help="The kit's rewards by name, or Python files, separated by commas (default: the task's).",
)
@click.option(
    "--on",
    "cases",
    help="Cases or groups, separated by commas; each is trained separately (default: all; with --crosstable each group "
    "of the task, and all).",
)
@click.option(
    "--crosstable",
    is_flag=True,
    help="Test each policy on every case of TASK, trained on or not, and print that table.",
)
@learning_options.settings_option("NAME=NUMBERS", "several numbers are compared (gamma=0.95,0.99)")
@click.option(
    "--tune",
    "ranges",
    metavar="NAME=LOW:HIGH",
    multiple=True,
    callback=_read_ranges,
    help="Search a range of a setting with optuna (extra: tune); repeat for more.",
)
@click.option(
    "--trials",
    type=click.IntRange(1, 10_000),
    default=20,
    show_default=True,
    help="Settings tried by --tune.",
)
@click.option("--steps", type=click.IntRange(1), help="Most steps per training (default: the preset's).")
@learning_options.episodes
@click.option(
    "--goal",
    type=click.FloatRange(0, 1),
    help="Success rate in its worst case at which a seed has learned (default: the task's, else 0.9).",
)
@executor_options("Trainings in parallel", "Where trainings run; none only shows the results so far.")
@click.option(
    "--csv",
    "csv_file",
    type=OutputFile(),
    help="Write a CSV file with one row per training.",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.option("--name", help="Name of the sweep (default: made from its tasks and algorithms).")
@options.workspace
def command(
    tasks: tuple[str, ...],
    seeds: tuple[int, ...] | None,
    algos: str,
    presets: str,
    rewards: str,
    cases: str | None,
    crosstable: bool,
    settings: dict[str, tuple[float, ...]],
    ranges: tuple[SettingRange, ...],
    trials: int,
    steps: int | None,
    episodes: int,
    goal: float | None,
    executor: JobExecutor,
    csv_file: Path | None,
    as_json: bool,
    name: str | None,
    workspace: Path | None,
) -> None:
    """Train on every TASK with every algorithm, preset, reward and group of cases, with several seeds each, and print
    one table.

    One training shows little: another seed may fail. The table shows how many seeds have learned, and the interval
    that contains the true share with 95 % confidence (Wilson): 5 of 5 gives 0.57 to 1.00.

    \b
    kit sweep turn --seeds 10
    kit sweep smooth-turn --algos ppo,sac,td3 --csv smooth.csv
    kit sweep turn --rewards algorithm-3,mine.py --seeds 100:110
    kit sweep hallway --on doors,obstacles,all --executor slurm --jobs 20
    kit sweep turn --set gamma=0.95,0.98,0.99 --set n_steps=64,128
    kit sweep turn --tune gamma=0.9:0.999 --tune learning_rate=1e-4:1e-2
    kit sweep hallway --crosstable

    With --tune the table begins with the settings that need the fewest steps to learn; a seed that has not learned
    counts its most steps, and as many again for its share of failures. Try the best ones on other seeds.

    With --crosstable a column is one group of cases trained on and a row one case tested on; the cells are success
    rates, means of the seeds. `hallway-seed-as-run` is the dissertation's Table 3.5 as it was run, `hallway-seed` as
    its text describes it; likewise `wheelchairs-seed-as-run` and `wheelchairs-seed` for the agents of its Table 4.6.
    `hallway` and `wheelchairs` are the kit's own versions. For these tasks, the dissertation's means are printed below
    the table.

    You can interrupt it, even in the middle of a training; run the same command to continue. With --executor slurm
    it submits an array job of --jobs tasks and waits; dask needs --cluster. The workspace must then be on a disk that
    all machines share.

    Exit code: 0 every training has a result; 1 some failed; 130 interrupted by Ctrl-C.
    """
    if crosstable and (ranges or goal is not None):
        raise click.UsageError("--crosstable cannot be combined with --tune or --goal.")
    seeds = seeds or tuple(range(1 if crosstable else 5))
    with learning_options.explained_errors():
        split = learning_options.split_names
        known: dict[str, PresetName] = {"kit": "kit", "seed": "seed", "seed-text": "seed-text"}
        if not set(split(presets)) <= set(known) or not split(presets):
            raise click.BadParameter(
                "give kit, seed or seed-text, or several: kit,seed.", param_hint="--presets"
            )
        configs = combine(
            tasks,
            cases=split(cases) or (case_groups(TaskSpec(tasks[0])) if crosstable else ("all",)),
            algorithms=split(algos) or ("ppo",),
            presets=[known[each] for each in split(presets)],
            rewards=split(rewards),
            seeds=seeds,
            steps=steps,
            settings=settings,
        )
        if crosstable:
            check_crosstable(configs)
        for config in configs:
            if config.seed == seeds[0]:
                check_run_config(config)
        words = [configs[0].choice.name, *split(algos), *(["crosstable"] if crosstable else [])]
        title = name or "-".join(words)[:90]
        if not NAME_PATTERN.fullmatch(title):
            messages.fail(
                f"{title}: a sweep's name may contain letters, digits, '_', '-' and '.'; set one with --name."
            )
        folder = learning_options.runs_folder(workspace).parent / "sweeps" / title
        run = partial(run_sweep, executor=executor)
        try:
            if ranges:
                sweep = _tune(folder, configs, ranges, trials, episodes, goal, run)
            else:
                sweep = TrainingSweep.prepare(folder, configs, episodes)
                run(sweep)
        except ExecutorUnavailable as error:
            messages.fail(str(error))
        except KeyboardInterrupt:
            click.echo("\nFinished training is kept; run the same command to continue.", err=True)
            raise SystemExit(INTERRUPTED) from None
        if csv_file is not None:
            write_atomically(csv_file, sweep_table_csv(sweep).encode())
        failed = problems(sweep)
        if crosstable:
            _print_crosstable(sweep, failed, as_json=as_json)
        else:
            _print_table(sweep, goal, failed, as_json=as_json, best_first=bool(ranges))
        for line in failed:
            click.echo(line, err=True)
    raise SystemExit(1 if failed else 0)


def _tune(
    folder: Path,
    configs: Sequence[RunConfig],
    ranges: tuple[SettingRange, ...],
    trials: int,
    episodes: int,
    goal: float | None,
    run: Callable[[TrainingSweep], None],
) -> TrainingSweep:
    """Tunes one combination; ``configs``: that, with each seed."""
    seeds = list(dict.fromkeys(config.seed for config in configs))
    if len(configs) > len(seeds):
        raise click.UsageError(
            "--tune searches for one task, algorithm, preset, reward and group of cases at a time."
        )
    if both := {name for name, _ in configs[0].settings} & {each.name for each in ranges}:
        raise click.UsageError(f"{min(both)} is given by --set and by --tune.")
    require_optuna()
    check_ranges(configs[0], ranges)
    return tune(folder, configs[0], ranges, seeds, trials=trials, episodes=episodes, goal=goal, run=run)


def run_sweep(sweep: TrainingSweep, executor: JobExecutor) -> None:
    """Runs the trainings that have no result yet. Raises ExecutorUnavailable, KeyboardInterrupt, and RunError if another
    process does."""
    keys = sweep.waiting()
    if executor.name == "none" or not keys:
        return
    try:
        with sweep.kept_from_others():
            told = f"{counted(len(sweep.entries()), 'training')}, {len(keys)} to do, in {sweep.folder}"
            click.echo(told, err=True)
            with click.progressbar(length=len(keys), label="trained", file=sys.stderr) as bar:
                executor.run(sweep, keys, lambda key: bar.update(1))
    except LockedError:
        raise RunError(
            f"{sweep.folder}: another process trains this sweep now. Wait for it, or end it first."
        ) from None


def _print_table(
    sweep: TrainingSweep, goal: float | None, failed: Sequence[str], *, as_json: bool, best_first: bool
) -> None:
    rows = sweep_rows(sweep, goal)
    if best_first:
        rows = tuple(sorted(rows, key=lambda row: row.cost))
    if as_json:
        click.echo(json.dumps({"rows": [asdict(row) for row in rows], "problems": failed}, indent=2))
    else:
        click.echo("\n".join(lines_of([sweep_table(rows)])))


def _print_crosstable(sweep: TrainingSweep, failed: Sequence[str], *, as_json: bool) -> None:
    """Tests what is untested and prints the cross table, below it the dissertation's means."""
    columns = crosstable_columns(sweep)
    if as_json:
        found = [asdict(column) for column in columns]
        click.echo(json.dumps({"columns": found, "problems": failed}, indent=2))
        return
    if columns:
        number, compare = printed_means(sweep.entries()[0].config.choice.task)
        click.echo("\n".join(lines_of(crosstable_tables(columns, compare))))
        if compare:
            messages.say(f"dissertation: means of its Table {number}; `kit study {number}` shows every cell.")
    if waiting := len(sweep.waiting()) - len(failed):
        click.echo(f"{waiting} of {counted(len(sweep.entries()), 'training')} without a result yet.")
