"""``kit crosstable``: trained on each group of cases, tested on all of them."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import click

from kit.cli import learning_options, options


@click.command()
@click.argument("task", default="hallway")
@click.option(
    "--groups", metavar="GROUPS", help="Only these groups, with commas between; `all` is all cases."
)
@click.option("--algo", default="ppo", show_default=True, help="By which algorithm.")
@click.option("--preset", type=click.Choice(("kit", "seed", "seed-text")), default="kit", show_default=True)
@click.option(
    "--seed", type=click.IntRange(0, 2**31 - 1), default=0, show_default=True, help="Of all chance."
)
@click.option("--steps", type=click.IntRange(1), help="At most for each group; by default the preset's.")
@learning_options.episodes
@click.option("--at-once", type=click.IntRange(1, 64), help="Trainings side by side; by default one a core.")
@click.option("--name", help="Of the table; by default made of task, algorithm and seed.")
@options.workspace
def command(
    task: str,
    groups: str | None,
    algo: str,
    preset: Literal["kit", "seed", "seed-text"],
    seed: int,
    steps: int | None,
    episodes: int,
    at_once: int | None,
    name: str | None,
    workspace: Path | None,
) -> None:
    """Make the table of TASK: the success on every case of agents that were trained on one group each. Interrupt it as
    you like; the same command goes on where it was.

    `hallway-seed-as-run` is the dissertation's Table 3.5 as it was run, `hallway-seed` as its text has it; likewise
    `wheelchairs-seed-as-run` and `wheelchairs-seed` for the agents of its Table 4.6. `hallway` and `wheelchairs` are the
    kit's own versions. The dissertation's means stand below these alone.
    """
    with learning_options.explained_errors():
        from kit.learning.environment.tasks import TaskSpec
        from kit.learning.training.algorithms import find_algorithm
        from kit.learning.training.optional_deps import require_learn_extra
        from kit.learning.training.runs import RunConfig
        from kit.learning.training.training_sweep import case_groups, format_crosstable, train_crosstable
        from kit.study.printed_tables import printed_means

        if find_algorithm(algo).needs_torch:
            require_learn_extra()
        config = RunConfig(TaskSpec(task), algo, preset, seed, steps)
        chosen = learning_options.split_names(groups) or case_groups(config)
        folder = (
            learning_options.runs_folder(workspace).parent
            / "tables"
            / (name or f"{config.choice.name}-{algo}-{preset}-{seed}")
        )
        try:
            columns = train_crosstable(
                folder, config, chosen, episodes=episodes, at_once=at_once, on_progress=click.echo
            )
        except KeyboardInterrupt:
            click.echo(f"\nThe trainings go on in {folder}. The same command takes them up.")
            raise SystemExit(130) from None
        number, compare = printed_means(task)
        click.echo("\n".join(format_crosstable(columns, compare)))
        if compare:
            click.echo(f"dissertation: means of its Table {number}; `kit study {number}` shows every cell.")
