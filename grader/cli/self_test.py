"""``grader self-test``: an assignment tried out on its own starter, solution and wrong solutions."""

from __future__ import annotations

from pathlib import Path

import click

from grader.cli import options


@click.command()
@click.argument("folder", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.option(
    "--solutions",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    help="Where the solution and the wrong ones lie, if not in FOLDER.",
)
@options.level
def command(folder: Path, solutions: Path | None, level: int | None) -> None:
    """Try out the assignment in FOLDER: its starter fails politely, its solution earns everything, each of its wrong
    solutions loses what its file name says. Then the odds that a good work fails by bad luck.

    Exit code: 0 all is as it should be; 1 it is not; 2 the assignment cannot be read.
    """
    from grader.grading import GradingOptions, LevelTooLow
    from grader.reports.cleaning import plain
    from grader.self_test import SUCCESSES, try_works, unfair_fail_odds

    assignment = options.read_assignment(folder)
    terms = GradingOptions(
        options.as_level(level), secret=assignment.has_secrets, may_fall=not assignment.has_secrets
    )
    click.echo(f"{assignment.title}: {len(assignment.criteria)} criteria")
    failed = False
    try:
        for proof in try_works(assignment, terms, solutions):
            failed |= bool(proof.problems)
            click.echo(f"{'[no]' if proof.problems else '[ok]'} {proof.name:<32} {proof.summary}")
            for problem in proof.problems:
                click.echo(f"     {plain(problem, 600)}")
    except LevelTooLow as error:
        options.fail(str(error))
    chances = tuple(unfair_fail_odds(assignment, secret=assignment.has_secrets))
    if chances:
        click.echo("\nThe odds that a work fails by bad luck, if in each episode it succeeds with")
        click.echo(f"{'':<32}" + "".join(f"{success:>9.0%}" for success in SUCCESSES))
        for each in chances:
            rule = f"{each.criterion} ({each.passes} of {each.episodes})"
            click.echo(f"{rule:<32}" + "".join(f"{unfair:>9.1%}" for unfair in each.unfair))
    raise SystemExit(options.FAILED if failed else 0)
