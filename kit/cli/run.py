"""``kit run``: a world without a screen, and what came of it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import click

from kit.cli import options
from kit.cli.options import Storage

INTERRUPTED = 130
"""Exit code after Ctrl-C, as shells have it."""


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
@click.option(
    "--serve",
    is_flag=True,
    help="Let other terminals look in meanwhile (`kit ros`); in real time, if no --speed is given.",
)
@click.option(
    "--speed",
    type=click.FloatRange(0, min_open=True),
    help="Simulated seconds per second; by default as fast as it goes.",
)
@click.option(
    "--bag",
    type=click.Path(path_type=Path),
    help="Keep what is said on all topics in this new folder, as ROS 2's `bag record` does.",
)
@options.storage
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
    serve: bool,
    speed: float | None,
    bag: Path | None,
    storage: Storage,
    as_json: bool,
    workspace: Path | None,
) -> None:
    """Run a world without a screen, as fast as it goes, and print a summary; before it, on standard error, what
    the controller says.

    The same place, controller, steps and seed give the same run, to the bit: the fingerprint says so.

    \b
    kit run maze --controller my_controller.py --steps 6000 --seed 1

    Exit code: 0 the run went through; 1 the controller failed; 2 something named does not exist or is wrong; 130
    Ctrl-C, after the summary of what was run.
    """
    from kit.controllers import find_controller
    from kit.ros.graph.graph import Graph
    from kit.run.headless import run_headless
    from kit.run.lockstep import ClosableParticipant
    from kit.run.pacing import MAXIMUM, REAL_TIME
    from kit.run.scenario import find_scenario
    from kit.run.view import format_log
    from kit.workspace import WorkspaceError, open_workspace
    from kit.world.problems import WorldError

    try:
        desk = open_workspace(workspace, make=False)
    except WorkspaceError as error:
        options.fail(str(error))
    company: list[Callable[[Graph], ClosableParticipant]] = []
    if serve:
        from kit.inspection.server import InspectionServer
        from kit.inspection.world_sockets import sockets_folder

        company.append(lambda graph: InspectionServer(graph, sockets_folder(desk.folder), Path(place).stem))
    if bag is not None:
        from kit.ros.bags import BagRecorder

        options.explain_storage(storage)
        company.append(lambda graph: BagRecorder(graph, bag, storage=storage))
    try:
        summary = run_headless(
            find_scenario(place, case, root),
            find_controller(controller, desk.controllers),
            steps=steps,
            seed=seed,
            factor=speed or (REAL_TIME if serve else MAXIMUM),
            until_reached=until_reached,
            record=record,
            company=company,
            on_message=lambda record: click.echo(format_log(record), err=True),
        )
    except (LookupError, WorldError) as error:
        options.fail(str(error))
    except OSError as error:
        options.fail(options.reason(error))
    click.echo(json.dumps(summary.as_dict(), indent=2) if as_json else summary.text())
    if summary.interrupted:
        raise SystemExit(INTERRUPTED)
    if summary.failure is not None:
        raise SystemExit(1)
