"""``grader gradebook``: the results of a queue as a table; late rules; what another grading changed."""

from __future__ import annotations

from pathlib import Path

import click

from grader.cli import options


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
    help="A CSV file: name, submitted; and student, where some hand in more than once.",
)
@click.option(
    "--choose",
    type=click.Choice(["latest", "in-time", "best"]),
    default="latest",
    show_default=True,
    help="Which of a student's submissions counts.",
)
@click.option(
    "--against",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="Another gradebook.json: print only what has changed since.",
)
@click.option("--json", "as_json", is_flag=True, help="JSON instead of CSV.")
def command(
    folder: Path, late: Path | None, times: Path | None, choose: str, against: Path | None, as_json: bool
) -> None:
    """Print the gradebook of the queue FOLDER: late rules, and which of several submissions counts, are applied now
    and kept nowhere."""
    from grader.cohort import gradebook
    from grader.cohort.choice import choose_submissions
    from grader.cohort.late import read_policy, read_submission_times
    from grader.cohort.queue import Queue, QueueError
    from grader.reports.cleaning import one_line
    from kit.world.problems import WorldError

    try:
        policy = None if late is None else read_policy(late)
        arrivals = {} if times is None else read_submission_times(times)
        table = gradebook.gradebook_rows(Queue(folder.absolute()), policy, arrivals)
        timeless = [row.name for row in table if row.name not in arrivals] if policy is not None else []
        table = choose_submissions(table, arrivals, choose)
        before = None if against is None else gradebook.read_json(against.read_text(encoding="utf-8"))
    except (WorldError, QueueError, ValueError, OSError) as error:
        options.fail(str(error))
    if timeless:
        named = ", ".join(map(one_line, timeless[:5])) + (", ..." if len(timeless) > 5 else "")
        click.echo(f"{len(timeless)} without a time count as in time: {named}", err=True)
    if before is not None:
        lines = list(gradebook.changes(before, table))
        click.echo("\n".join(lines) if lines else "nothing has changed")
    else:
        click.echo(gradebook.as_json(table) if as_json else gradebook.as_csv(table), nl=False)
