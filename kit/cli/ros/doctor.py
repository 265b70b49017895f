"""``kit ros doctor``: what may be wrong with the running world, the packages and this shell, and reports on them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import click

from kit.cli import opening, options
from kit.cli.ros.world_client import connect_to_world, package_folders
from kit.host.program_start import ROS_DISTRO
from kit.inspection.client import InspectionClient
from kit.inspection.diagnosis import NO_WORLD, DiagnosisCheck, Report, checks, reports
from kit.inspection.sockets import WORLD_VARIABLE, running_worlds, sockets_folder
from kit.ros.packages import find_packages


@click.command
@click.option("-r", "--report", "wants_report", is_flag=True, help="Print reports on all subjects.")
@click.option(
    "-rf", "--report-failed", is_flag=True, help="Print reports only on those whose checks have failed."
)
@click.option(
    "-ep", "--exclude-packages", is_flag=True, help="Leave out the packages of this folder and the workspace."
)
@click.option("-iw", "--include-warnings", is_flag=True, help="Let a check that only warns fail.")
@click.option(
    "--world",
    metavar="NAME",
    envvar=WORLD_VARIABLE,
    help="World to check, if several run (default: $KIT_WORLD, else the newest).",
)
@options.workspace
def command(
    wants_report: bool,
    report_failed: bool,
    exclude_packages: bool,
    include_warnings: bool,
    world: str | None,
    workspace: Path | None,
) -> None:
    """Check the running world: topics that nobody publishes or hears, QoS that does not match, packages that cannot be read.

    The terminal and the machine are the subject of `kit doctor`.

    \b
    kit ros doctor
    kit ros doctor --report
    """
    folders = () if exclude_packages else package_folders(workspace)
    with _client(world, workspace) as client:
        graph = None if client is None else client.graph
        made = list(checks(graph, folders, os.environ, ROS_DISTRO))
        failed = {check.category for check in made if not check.passes(warnings_fail=include_warnings)}
        if not wants_report:
            _print_checks(made, failed, has_world=graph is not None)
        if wants_report or report_failed:
            name = "" if client is None else client.world
            for report in reports(graph, name, find_packages(folders), os.environ, ROS_DISTRO):
                if (wants_report or report.category in failed) and not (
                    exclude_packages and report.category == "package"
                ):
                    _print_report(report)


@contextmanager
def _client(world: str | None, workspace: Path | None) -> Iterator[InspectionClient | None]:
    """Connects to the world; None if none was named and none runs."""
    folder = sockets_folder(opening.open_existing_workspace(workspace).folder)
    if world is None and not running_worlds(folder):
        yield None
        return
    with connect_to_world(world, workspace) as client:
        yield client


def _print_checks(made: list[DiagnosisCheck], failed: set[str], *, has_world: bool) -> None:
    for check in made:
        for kind, found in (("ERROR", check.errors), ("WARNING", check.warnings)):
            for text in found:
                click.echo(f"{kind}: {text}", err=True)
    if not has_world:
        click.echo(f"{NO_WORLD.capitalize()}: its nodes and topics are not checked.", err=True)
    if failed:
        click.echo(f"\n{len(failed)}/{len(made)} check(s) failed\n")
        click.echo(f"Failed modules: {' '.join(sorted(failed))}")
    else:
        click.echo(f"\nAll {len(made)} checks passed\n")


def _print_report(report: Report) -> None:
    click.echo(f"\n   {report.title}")
    width = max(len(name) for name, _ in report.rows)
    for name, value in report.rows:
        click.echo(f"{name:<{width}} : {value}")
