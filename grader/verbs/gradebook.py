"""``grader gradebook``: the results of a queue as a table; late rules; what another grading changed."""

from __future__ import annotations

from pathlib import Path

import click

from grader.verbs import options


@click.command()
@click.argument("folder", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.option(
    "--late",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="A YAML file: due, grace_minutes, per_day, least, latest_days.",
)
@click.option(
    "--times",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="A CSV file: name, submitted.",
)
@click.option(
    "--against",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Another gradebook.json: print only what has changed since.",
)
@click.option("--json", "as_json", is_flag=True, help="JSON instead of CSV.")
def command(folder: Path, late: Path | None, times: Path | None, against: Path | None, as_json: bool) -> None:
    """Print the gradebook of the queue FOLDER, with late rules applied now and kept nowhere."""
    from grader.cohort import gradebook
    from grader.cohort.late import read_policy, read_times
    from grader.cohort.queue import Queue, QueueError
    from kit.world.problems import WorldError

    try:
        policy = None if late is None else read_policy(late)
        table = gradebook.rows(Queue(folder.absolute()), policy, None if times is None else read_times(times))
        before = None if against is None else gradebook.read_json(against.read_text(encoding="utf-8"))
    except (WorldError, QueueError, ValueError, OSError) as error:
        options.fail(str(error))
    if before is not None:
        lines = list(gradebook.changes(before, table))
        click.echo("\n".join(lines) if lines else "nothing has changed")
    else:
        click.echo(gradebook.as_json(table) if as_json else gradebook.as_csv(table), nl=False)
