"""``kit runs``: the trainings there are, what they are asked to do, and their upkeep."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import click

from kit.cli import learning_options, options

if TYPE_CHECKING:
    from kit.learning.training.runs import TrainingRun


@click.command()
@click.argument("run", required=False)
@click.option("--pause", "order", flag_value="pause", help="Let it rest, with all it knows.")
@click.option("--go", "order", flag_value="go", help="Go on after a pause.")
@click.option("--stop", "order", flag_value="stop", help="End it; `kit train --resume` could go on.")
@click.option("--rename", "new_name", metavar="NAME", help="Give RUN another name.")
@click.option("--delete", "deleted", is_flag=True, help="Delete RUN with all it has learned; asks first.")
@click.option("--yes", is_flag=True, help="With --delete: do not ask.")
@click.option("--json", "as_json", is_flag=True, help="For machines.")
@options.workspace
def command(
    run: str | None,
    order: Literal["pause", "go", "stop"] | None,
    new_name: str | None,
    deleted: bool,
    yes: bool,
    as_json: bool,
    workspace: Path | None,
) -> None:
    """List the training runs with the disk that they take and the time that those at work still need at most; show RUN,
    ask it (by default the last one) to pause, go on or stop, rename or delete it.

    \b
    kit runs
    kit runs mine --rename first-try
    kit runs first-try --delete
    """
    if run is None and (new_name is not None or deleted):
        raise click.UsageError(f"Which run? `kit runs NAME {'--delete' if deleted else '--rename NEW'}`.")
    from kit.learning.training.run_upkeep import disk_bytes, format_runs, read_overviews, rename_run
    from kit.learning.training.runs import find_run, list_runs

    with learning_options.explained_errors():
        folder = learning_options.runs_folder(workspace)
        if new_name is not None:
            renamed = rename_run(find_run(folder, run), new_name)
            click.echo(f"{run} is called {renamed.name} now.")
        elif deleted:
            _delete(find_run(folder, run), yes)
        elif order is not None:
            _ask(find_run(folder, run), order)
        elif run is not None:
            _show(find_run(folder, run), as_json)
        elif as_json:
            rows = [
                {"name": each.name, **each.summary().as_dict(), "disk_bytes": disk_bytes(each)}
                for each in list_runs(folder)
            ]
            click.echo(json.dumps(rows, indent=2))
        else:
            found = list_runs(folder)
            click.echo(
                "\n".join(format_runs(read_overviews(found)))
                if found
                else "No runs yet. `kit train turn` starts one."
            )


def _delete(run: TrainingRun, yes: bool) -> None:
    from kit.learning.training.run_upkeep import delete_run, disk_bytes, size_text

    if not yes and not click.confirm(
        f"Delete {run.name} with its policies and curves ({size_text(disk_bytes(run))})?", default=False
    ):
        click.echo("Kept.")
        return
    click.echo(f"{run.name} is deleted; {size_text(delete_run(run))} are free again.")


def _ask(run: TrainingRun, order: Literal["pause", "go", "stop"]) -> None:
    from kit.learning.training.runs import RunError

    if not run.is_active:
        raise RunError(f"{run.name} is not being trained. `kit train --resume {run.name}` goes on with it.")
    run.send_command(order)
    click.echo(f"{run.name}: {order}.")


def _show(run: TrainingRun, as_json: bool) -> None:
    from kit.learning.training.run_text import format_event

    config, summary = run.config(), run.summary()
    if as_json:
        click.echo(json.dumps({"name": run.name, "config": config.as_dict(), **summary.as_dict()}, indent=2))
        return
    click.echo(
        f"{run.name}: {config.choice.title}, {config.algorithm}, preset {config.preset}, seed {config.seed}"
    )
    click.echo(f"{summary.state}, {summary.steps:,} steps in {summary.seconds:.1f} s  {summary.reason}")
    for title, test in (("last test", summary.last_evaluation), ("best", summary.best_evaluation)):
        if test is not None:
            click.echo(f"{title:10}{format_event(test).strip()}")
    click.echo(f"in {run.folder}")
