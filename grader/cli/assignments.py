"""``grader new``, ``checks`` and ``self-test``: verbs for teachers who write an assignment."""

from __future__ import annotations

import inspect
import json
import shlex
import sys
from dataclasses import fields
from pathlib import Path
from typing import Final

import click

from grader.budgets import budget_lines
from grader.check import Check
from grader.cli import confinement, exits, loading, options
from grader.cli.progress import shown_progress
from grader.driving.starts import start_problems
from grader.evidence_digest import ASSIGNMENT_FILE
from grader.grading import GradingOptions
from grader.grading_level import LevelTooLow
from grader.kinds.contract import KINDS_PACKAGE, find_kind, kind_names
from grader.new_assignment import example_of_exercise, example_of_kind, make_assignment
from grader.reading import SECRET_FILE
from grader.reports.cleaning import plain
from grader.self_test import SUCCESS_RATES, try_works, unfair_fail_odds, works_of
from kit.cli.existing_path import ExistingPath
from kit.cli.messages import describe_os_error
from kit.document.blocks import Block, CellStyle, Column, Table, Text, labelled_table
from kit.document.layout import lines_of
from kit.plain_text import counted, quoted, suggestion

SHARE_HELP: Final = (
    "share: {none: ..., full: ..., steps: N}: the values that earn no points and all points. With secret seeds, points are given "
    "in N steps, by default 4, rounded to the nearest below all; of `seeds: secret` alone, each episode earns all or "
    "nothing unless `steps` is given."
)
MISTAKES_HELP: Final = (
    "mistakes: [{when: TEXT, from: 0, to: 1, passed: ID, hint: TEXT}]: a hint for a recognised mistake, shown before "
    "the others. `when` is a part of the feedback text, `from` and `to` bound the measured value, `passed` is an "
    "earlier criterion that earned all points; every condition that is given must hold."
)


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option(
    "--kind",
    type=click.Choice(kind_names()),
    metavar="KIND",
    help="What students submit; `grader checks` names the kinds (default: controller).",
)
@click.option(
    "--from",
    "exercise",
    metavar="LESSON/EXERCISE",
    help="Start from a lesson's exercise with its solutions: 11/your_reward.",
)
def new(folder: Path, kind: str | None, exercise: str | None) -> None:
    """Create the assignment FOLDER: a working example with starter, solution and wrong solutions.

    \b
    grader new hall --kind controller
    grader new hall --from 11/your_reward

    Change it step by step, and run `grader self-test FOLDER` after each step.
    """
    if kind is not None and exercise is not None:
        exits.fail("Give --kind or --from, not both: an exercise has a kind of its own.")
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        exits.fail(f"{folder} already exists and is not empty; choose another folder.")
    try:
        example = example_of_kind(kind or "controller") if exercise is None else example_of_exercise(exercise)
        make_assignment(example, folder)
        assignment = loading.load_assignment(folder)
    except LookupError as error:
        exits.fail(str(error))
    except OSError as error:
        exits.fail(f"Cannot create {folder}: {describe_os_error(error)}")
    shown = shlex.quote(str(folder))
    click.echo(f"{folder}: {assignment.kind}, ready. Try it: grader self-test {shown}")
    if assignment.secret_seeds:
        click.echo(
            f"{folder}/{SECRET_FILE} has new seeds, which are on this machine alone. Keep it to yourself."
        )
    elif assignment.has_secrets:
        click.echo(
            f"{folder}/{SECRET_FILE} is that of the example, which everybody has who has the kit: write your own."
        )
    click.echo(f"Then edit {folder}/{ASSIGNMENT_FILE}: `grader help sheet` explains its keys,")
    click.echo(f"`grader checks {assignment.kind}` lists the checks. For students: grader release {shown}")


def _feedback(check: Check) -> str:
    """What a check tells a student, with dots where it names what it has measured."""
    full = check.format(check.anchors.full)
    return check.feedback.format(actual="...", full=full, where="...", passed="...", count="...")


def _kinds_as_json() -> str:
    """Every kind with its checks, and the limits of programs, for pages about them."""
    kinds = [
        {
            "kind": name,
            "about": inspect.getdoc(sys.modules[f"{KINDS_PACKAGE}.{name}.kind"]),
            "endings": find_kind(name).endings,
            "checks": [
                {
                    "check": check_name,
                    "feedback": _feedback(each),
                    "none": each.format(each.anchors.none),
                    "full": each.format(each.anchors.full),
                    "with": {field.name: repr(field.default) for field in fields(each.params)},
                }
                for check_name, each in find_kind(name).checks.items()
            ],
        }
        for name in kind_names()
        if find_kind(name)
    ]
    return json.dumps({"kinds": kinds, "budget": dict(budget_lines())}, indent=1)


@click.command()
@click.argument("kind", required=False, default="controller")
@click.option("--json", "machine_readable", is_flag=True, help="Print all kinds and their checks as JSON.")
def checks(kind: str, machine_readable: bool) -> None:
    """List the checks that an assignment of this KIND can use: what each measures, which values earn no points and all
    points (unless `share` sets others), and the parameters for `with`.

    \b
    grader checks reward
    """
    if machine_readable:
        click.echo(_kinds_as_json())
        return
    if kind not in kind_names():
        exits.fail(f"There is no kind {quoted(kind)}: {suggestion(kind, kind_names())}")
    rows: list[tuple[str, str]] = []
    for name, check in find_kind(kind).checks.items():
        none, full = check.format(check.anchors.none), check.format(check.anchors.full)
        params = ", ".join(f"{each.name}: {each.default!r}" for each in fields(check.params))
        parts = [
            f"“{none}” earns nothing, “{full}” everything" if full else "",
            f"with: {params}" if params else "",
        ]
        rows += [(name, _feedback(check)), ("", "; ".join(filter(None, parts)))]
    others = ", ".join(each for each in kind_names() if each != kind)
    budget = "budget: {KEY: NUMBER, ...} sets limits for every program that runs:"
    blocks: list[Block] = [
        labelled_table(row for row in rows if row[1]),
        Text(SHARE_HELP),
        Text(MISTAKES_HELP),
        labelled_table(budget_lines(), budget, indent=2),
        Text(f"Other kinds: {others}."),
    ]
    click.echo("\n".join(lines_of(blocks)))


@click.command()
@click.argument("folder", type=ExistingPath(file_okay=False, path_type=Path))
@click.option(
    "--solutions",
    type=ExistingPath(file_okay=False, path_type=Path),
    help="Folder with the solution and the wrong solutions, if not FOLDER.",
)
@options.level
@click.option(
    "--jobs",
    type=click.IntRange(1),
    default=1,
    show_default=True,
    help="Works that are graded at once.",
)
def self_test(folder: Path, solutions: Path | None, level: str | None, jobs: int) -> None:
    """Test the assignment in FOLDER: no seed may put the robot into a wall, the starter must run but not pass, the solution must
    earn all points, and each wrong solution must lose the criterion in its file name. Then print how likely a good submission is
    to fail by bad luck.

    A wrong solution is a whole file, or a .diff from the solution: diff -U1 solution.py wrong.py.

    Exit code: 0 all tests pass; 1 some fail; 2 the assignment cannot be read.
    """
    assignment = loading.load_assignment(folder)
    loading.warn_of_short_seeds(assignment)
    works = works_of(assignment, solutions)
    click.echo(
        f"{assignment.title}: {counted(len(assignment.tests), 'criterion', 'criteria')}, {counted(len(works), 'work')} to grade"
    )
    problems = tuple(start_problems(assignment))
    for problem in problems:
        click.echo(f"[no] {problem}")
    failed = bool(problems)
    try:
        with shown_progress(None) as show_progress:
            grading_options = GradingOptions(
                confinement.to_level(level),
                secret=assignment.has_secrets,
                may_lower_level=not assignment.has_secrets,
                show_progress=show_progress,
            )
            for number, report in enumerate(try_works(assignment, grading_options, solutions, jobs=jobs), 1):
                show_progress("")
                failed |= bool(report.problems)
                mark = "[no]" if report.problems else "[ok]"
                click.echo(f"{number:>2}/{len(works)} {mark} {report.name:<32} {report.summary}")
                for problem in report.problems:
                    click.echo(f"     {plain(problem, 600)}")
    except LevelTooLow as error:
        exits.fail(str(error))
    chances = tuple(unfair_fail_odds(assignment, secret=assignment.has_secrets))
    if chances:
        title = "Probability that a submission fails by bad luck, if each episode succeeds with probability"
        columns = (Column("", CellStyle.TEXT), *(Column(f"{success:.0%}") for success in SUCCESS_RATES))
        odds = tuple(
            (
                f"{each.criterion} ({each.required_passes} of {each.episodes})",
                *(f"{unfair:.1%}" for unfair in each.probabilities),
            )
            for each in chances
        )
        click.echo("\n" + "\n".join(lines_of([Table("odds", title, columns, odds, is_ruled=False)])))
    raise SystemExit(exits.EXIT_FAILED if failed else 0)
