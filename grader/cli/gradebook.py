"""``grader gradebook``: the grades of a class, what has changed, files for learning platforms, and pages for students."""

from __future__ import annotations

from pathlib import Path

import click

from grader.cli import exits
from grader.cohort.choice_rules import RULES
from grader.cohort.class_findings import attention_blocks, class_blocks
from grader.cohort.class_list import ClassRules, class_table
from grader.cohort.exports import EXPORTS
from grader.cohort.feedback import write_feedback
from grader.cohort.gradebook import as_json, read_json
from grader.cohort.gradebook_changes import changes
from grader.cohort.lateness import read_policy
from grader.cohort.marks import read_marks
from grader.cohort.queue import Queue, QueueError
from grader.cohort.roster import read_roster
from grader.cohort.statistics import class_document
from grader.cohort.submission_times import read_submission_times
from kit.cli.existing_path import ExistingPath
from kit.cli.messages import describe_error
from kit.cli.output_file import OutputFile
from kit.document.layout import document_lines, lines_of
from kit.plain_text import counted
from kit.workspace import write_atomically
from kit.world.problems import WorldError

FILE = ExistingPath(dir_okay=False, path_type=Path)


@click.command()
@click.argument("folder", type=ExistingPath(file_okay=False, path_type=Path))
@click.option(
    "--roster",
    type=FILE,
    help="CSV file with name, email, id, login, group; or an export of Moodle, Canvas, Gradescope or GitHub Classroom.",
)
@click.option(
    "--late",
    type=FILE,
    help="YAML file with due, zone, grace_minutes, grace_days, per_day, least, latest_days, extensions.",
)
@click.option(
    "--times",
    type=FILE,
    help="CSV file with name and submitted; also student, if some submit more than once. Or Moodle's worksheet.",
)
@click.option(
    "--marks",
    type=FILE,
    help="YAML file with your own points, extra points and comments, by student.",
)
@click.option(
    "--choose",
    type=click.Choice(list(RULES)),
    default="latest",
    show_default=True,
    help="The submission that counts for each student.",
)
@click.option("--against", type=FILE, help="Print only what has changed since this gradebook.json.")
@click.option(
    "--for",
    "platform",
    type=click.Choice(list(EXPORTS)),
    default="csv",
    show_default=True,
    help="The form: CSV with everything, or the file that Moodle or Canvas imports.",
)
@click.option("--decimal-comma", is_flag=True, help="Write 2,5 instead of 2.5.")
@click.option("--json", "as_json_text", is_flag=True, help="Print JSON instead of CSV.")
@click.option("--output", type=OutputFile(), help="Write to this file.")
@click.option(
    "--feedback",
    type=click.Path(file_okay=False, path_type=Path),
    help="Write a page for each student into this folder, as HTML and Markdown.",
)
@click.option("--statistics", is_flag=True, help="Print how the class did on each criterion instead.")
def gradebook(
    folder: Path,
    roster: Path | None,
    late: Path | None,
    times: Path | None,
    marks: Path | None,
    choose: str,
    against: Path | None,
    platform: str,
    decimal_comma: bool,
    as_json_text: bool,
    output: Path | None,
    feedback: Path | None,
    statistics: bool,
) -> None:
    """Print the gradebook of the queue FOLDER. Roster, late rules, own marks and the choice among several submissions apply
    only to this output: give the same files again after every regrade.

    \b
    grader gradebook grades --roster class.csv --late late.yaml --times times.csv
    grader gradebook grades --roster class.csv --for moodle --output upload.csv
    grader gradebook grades --roster class.csv --feedback pages
    grader gradebook grades --statistics

    A date as `due` means the end of that day. Times need their offset (+01:00, Z) or a `zone` in the late rules, such as
    Europe/Lisbon. Standard error says how `due` was read, what fits nobody, and who needs a look.
    """
    try:
        queue = Queue(folder.absolute())
        policy = None if late is None else read_policy(late)
        zone = None if policy is None else policy.zone
        rules = ClassRules(
            policy,
            None if times is None else read_submission_times(times, zone),
            choose,
            None if roster is None else read_roster(roster),
            None if marks is None else read_marks(marks),
        )
        found = class_table(queue, rules)
        assignment = queue.assignment()
        before = None if against is None else read_json(against.read_text(encoding="utf-8"))
    except (WorldError, QueueError, ValueError, OSError) as error:
        exits.fail(describe_error(error))
    table = found.rows
    if policy is not None:
        click.echo(policy.due_text, err=True)
    for remark in found.remarks:
        exits.warn(remark)
    if before is not None:
        lines = list(changes(before, table))
        text = ("\n".join(lines) if lines else "nothing has changed") + "\n"
    elif statistics:
        text = "\n".join(document_lines(class_document(assignment, table))) + "\n"
    elif as_json_text:
        text = as_json(table)
    else:
        text = EXPORTS[platform](
            table, rules.roster, assignment.title, assignment.max_points, decimal_comma=decimal_comma
        )
    if (look := [*attention_blocks(table), *class_blocks(table)]) and (
        roster is not None or feedback is not None
    ):
        exits.warn("\n".join(lines_of(look)))
    try:
        if feedback is not None:
            count = write_feedback(queue, table, feedback.absolute())
            click.echo(f"{feedback}: {counted(count, 'page')}, and _class.html on the class", err=True)
        if output is not None:
            write_atomically(output.absolute(), text.encode())
        elif feedback is None:
            click.echo(text, nl=False)
    except OSError as error:
        exits.fail(describe_error(error))
