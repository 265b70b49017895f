"""``kit run``: a world without a screen, and what came of it."""

from __future__ import annotations

import json
from pathlib import Path

import click

from kit.cli import options


@click.command()
@click.argument("place", metavar="MAP or WORLD.yaml")
@options.case
@options.controller
@options.seed
@options.root
@click.option(
    "--steps", type=click.IntRange(1), default=3000, show_default=True, help="How many ticks of 0.01 s."
)
@click.option("--until-reached", is_flag=True, help="Stop when the target is reached.")
@click.option(
    "--record",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Keep the run in this file, for `kit replay`.",
)
@click.option("--json", "as_json", is_flag=True, help="For machines.")
@options.workspace
def command(
    place: str,
    case: str | None,
    controller: str,
    seed: int,
    root: Path | None,
    steps: int,
    until_reached: bool,
    record: Path | None,
    as_json: bool,
    workspace: Path | None,
) -> None:
    """Run a world without a screen, as fast as it goes, and print a summary.

    The same place, controller, steps and seed give the same run, to the bit: the fingerprint says so.

    \b
    kit run maze --controller my_controller.py --steps 6000 --seed 1

    Exit code: 0 the run went through; 1 the controller failed; 2 something named does not exist or is wrong.
    """
    from kit.controllers import find
    from kit.headless import run_headless
    from kit.places import find_place
    from kit.workspace import WorkspaceError, open_workspace
    from kit.world.problems import WorldError

    try:
        folder = open_workspace(workspace, make=False).controllers
        summary = run_headless(
            find_place(place, case, root),
            find(controller, folder),
            steps=steps,
            seed=seed,
            until_reached=until_reached,
            record=record,
        )
    except (LookupError, WorldError, WorkspaceError, OSError) as error:
        options.fail(str(error))
    click.echo(json.dumps(summary.as_dict(), indent=2) if as_json else summary.text())
    if summary.failure is not None:
        raise SystemExit(1)
