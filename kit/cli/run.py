"""``kit run``: runs a world without a screen and prints a summary."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

import click

from kit.cli import bag_storage, messages, opening, options
from kit.cli.bag_storage import Storage
from kit.cli.process import INTERRUPTED
from kit.controllers import find_controller
from kit.document.blocks import Picture, labelled_table
from kit.document.layout import lines_of
from kit.host.program_terminal import ProgramTerminal, has_user_terminal, piped_streams
from kit.inspection.server import InspectionServer
from kit.inspection.sockets import sockets_folder
from kit.kernels.compilation_progress import PROGRESS
from kit.plain_text import counted, escape_controls
from kit.ros.bags import BagRecorder
from kit.ros.graph.graph import Graph
from kit.run.headless import RunSummary, run_headless
from kit.run.lockstep import ClosableParticipant
from kit.run.pacing import MAXIMUM, REAL_TIME
from kit.run.scenario import find_scenario
from kit.run.view import format_log
from kit.workspace import WorkspaceError, open_workspace
from kit.world.problems import WorldError


@click.command()
@click.argument("place", metavar="MAP or WORLD.yaml")
@options.case
@options.controller
@options.seed
@options.root
@click.option(
    "--steps",
    type=click.IntRange(1),
    default=3000,
    show_default=True,
    help="Number of ticks to run, 0.01 s each.",
)
@click.option("--until-reached", is_flag=True, help="Stop when the robot reaches its target.")
@click.option(
    "--record",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Save the run to this file, for `kit replay`.",
)
@click.option(
    "--serve",
    is_flag=True,
    help="Let other terminals inspect the world (`kit ros`); runs in real time unless --speed is given.",
)
@click.option(
    "--speed",
    type=click.FloatRange(0, min_open=True),
    help="Simulated seconds per second (default: as fast as possible).",
)
@click.option(
    "--bag",
    type=click.Path(path_type=Path),
    help="Record all topics in this new folder, as `ros2 bag record` does.",
)
@bag_storage.storage
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
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
    """Run a world without a screen, as fast as possible, and print a summary. The controller's output goes to
    standard error.

    A controller may read the terminal (input(), single keys); the world then runs in real time.

    The same map, controller, steps and seed give the same run, bit for bit: compare the fingerprints.

    \b
    kit run maze --controller my_controller.py --steps 6000 --seed 1

    Exit code: 0 the run finished; 1 the controller failed; 2 an argument is wrong or names something that does not
    exist; 130 interrupted by Ctrl-C (143 by SIGTERM, 129 by a connection that is gone), with a summary of the steps that
    ran. --record and --bag keep them.
    """
    try:
        opened_workspace = open_workspace(workspace, make=False)
    except WorkspaceError as error:
        messages.fail(str(error))
    participants: list[Callable[[Graph], ClosableParticipant]] = []
    if serve:
        participants.append(
            lambda graph: InspectionServer(graph, sockets_folder(opened_workspace.folder), Path(place).stem)
        )
    if bag is not None:
        bag_storage.explain_storage(storage)
        participants.append(lambda graph: _record_bag(graph, bag, storage))
    try:
        with ExitStack() as stack:
            stack.enter_context(PROGRESS.told_by(lambda text: click.echo(text, err=True)))
            if has_user_terminal():
                streams = stack.enter_context(ProgramTerminal(shows_output=False)).streams
            else:
                streams = piped_streams()
            driver = find_controller(controller, opened_workspace.controllers)
            recording_file = opening.open_recording_file(record)
            summary = run_headless(
                find_scenario(place, case, root),
                driver,
                steps=steps,
                seed=seed,
                factor=speed or (REAL_TIME if serve else MAXIMUM),
                until_reached=until_reached,
                record=recording_file,
                participants=participants,
                on_message=lambda record: click.echo(format_log(record), err=True),
                streams=streams,
            )
    except (LookupError, WorldError) as error:
        messages.fail(str(error))
    except OSError as error:
        messages.fail(messages.describe_os_error(error))
    click.echo(json.dumps(summary.as_dict(), indent=2) if as_json else format_summary(summary))
    if recording_file is not None and recording_file.remark:
        click.echo(recording_file.remark, err=True)
    if summary.interrupted:
        for kept in filter(None, (record, bag)):
            click.echo(f"What ran until then is in {kept}.", err=True)
        raise SystemExit(INTERRUPTED)
    if summary.failure is not None:
        raise SystemExit(1)


def _record_bag(graph: Graph, folder: Path, storage: Storage) -> BagRecorder:
    recorder = BagRecorder(graph, folder, storage=storage)
    for notice in recorder.notices:
        click.echo(escape_controls(notice), err=True)
    return recorder


FAILURE_INDENT = 13


def format_summary(summary: RunSummary) -> str:
    """The summary as aligned lines for the terminal."""
    metrics = summary.metrics
    if metrics.target_m is None:
        target = "none in this world" if summary.ticks else "not measured: no steps were run"
    elif metrics.reached_s is None:
        target = f"not reached; {metrics.target_m:.2f} m away at the end"
    else:
        target = f"reached after {metrics.reached_s:.1f} s"
    end = (
        "no robot"
        if summary.pose is None
        else "x {:.3f} m, y {:.3f} m, heading {:.3f} rad".format(*summary.pose)
    )
    factor = metrics.time_s / summary.wall_s if summary.wall_s > 0 else 0.0
    rows = [
        ("place", summary.scenario),
        ("controller", f"{summary.controller}, seed {summary.seed}"),
        (
            "run",
            f"{summary.ticks} steps, {metrics.time_s:.2f} s of simulated time, {factor:.0f} times real time",
        ),
        ("target", target),
        ("distance", f"{metrics.distance_m:.2f} m, {counted(metrics.bumps, 'bump')}"),
        ("end", end),
        ("fingerprint", summary.fingerprint),
    ]
    if summary.interrupted:
        rows.append(("stopped", "by Ctrl-C or a signal"))
    failure = [] if summary.failure is None else str(summary.failure).splitlines()
    if failure:
        rows.append(("stopped", failure[0]))
    return "\n".join(
        lines_of([labelled_table(rows), Picture(tuple(failure[1:]), indent=FAILURE_INDENT, is_tight=True)])
    )
