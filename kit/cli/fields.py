"""``kit fields``: charges on a map, the field they make, and the test drives of the two robots that follow it."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from kit.cli import messages, options, terminal_options
from kit.cli.existing_path import ExistingPath
from kit.cli.full_screen import show_screen
from kit.cli.lazy_group import HintingGroup
from kit.controllers import find_controller, prepare_workspace
from kit.run.scenario import Scenario, case_names, find_scenario
from kit.workspace import WorkspaceError
from kit.world.problems import WorldError

if TYPE_CHECKING:
    from kit.fields.controller_setup import ControllerSetup
    from kit.study.pairs import PairSummary, PrintedPairResult
    from kit.tui.app import KitApp
    from kit.tui.screens.fields import FieldsScreen

FAILED: Final = 1
"""Exit code of ``test``: not every run reached the target."""

PICTURE: Final = (78, 30)
"""Columns and rows of a picture in plain text."""

BOTH: Final = ("fields", "abreast")

_CHARGES = click.option(
    "--charges",
    type=ExistingPath(dir_okay=False, path_type=Path),
    help="Use this charge file instead of the map's own.",
)
_RUNS = click.option(
    "--runs", type=click.IntRange(1, 1000), default=20, show_default=True, help="Runs per case."
)
_JSON = click.option("--json", "as_json", is_flag=True, help="Print JSON.")


@click.group(cls=HintingGroup)
def command() -> None:
    """Show and test potential fields, also for two robots that drive as one.

    \b
    kit fields show pair_turn_180   the field, its charges and its traps
    kit fields test pair_turn_180   test the controllers, case by case
    kit fields table                the dissertation's Tables 4.6 and 5.3

    A map's charges are in charges.yaml beside its world.yaml; without that file they are derived from the walls.
    `kit help world-format` lists its keys. A world file of your own has a field where a model named beacon marks the target.
    """


@command.command()
@click.argument("place", default="pair_turn_180", metavar="[MAP or WORLD.yaml]")
@options.case
@options.controller_option("fields")
@click.option("--plain", is_flag=True, help="Print the field, the charges and the traps as text.")
@_CHARGES
@click.option(
    "--derived", is_flag=True, help="Derive the charges from the walls, even if the map has a charge file."
)
@options.seed
@options.workspace
@terminal_options.glyphs
@terminal_options.color
def show(
    place: str,
    case: str | None,
    controller: str,
    plain: bool,
    charges: Path | None,
    derived: bool,
    seed: int,
    workspace: Path | None,
    glyphs: str | None,
    color: str | None,
) -> None:
    """Show the field of a map. The picture has arrows on the floor, charges, traps, and the forces on each robot.

    On the full screen, `i` selects an intensity, `[` and `]` change it, `o` shows the planner's field instead.
    """
    with _explained_errors():
        try:
            opened_workspace = prepare_workspace(workspace)
        except WorkspaceError as error:
            messages.fail(str(error))
        scenario = replace(_find_place(place, case), charges=charges)
        setup = _open_setup(scenario, derived)
        terminal = terminal_options.decide(plain=plain, glyphs=glyphs, color=color)
        find_controller(controller, opened_workspace.controllers)
    if terminal.plain.value:
        for line in _describe_field(scenario, setup):
            click.echo(line)
        return

    def make_screen(app: KitApp) -> FieldsScreen:
        from kit.tui.screens.fields import FieldsScreen

        return FieldsScreen(
            app.kit_theme,
            place,
            controller,
            case=case,
            folder=opened_workspace.controllers,
            runs=opened_workspace.runs,
            seed=seed,
            derived=derived,
            charges=charges,
        )

    show_screen(terminal, make_screen)


@command.command()
@click.argument("place", metavar="MAP")
@options.case
@click.option(
    "--controller",
    "controllers",
    multiple=True,
    default=BOTH,
    show_default=True,
    help="Controller to test, by name or file; repeat for more.",
)
@_CHARGES
@_RUNS
@options.seed
@_JSON
def test(
    place: str,
    case: str | None,
    controllers: tuple[str, ...],
    charges: Path | None,
    runs: int,
    seed: int,
    as_json: bool,
) -> None:
    """Run the cases of a map and print how well the robots drive.

    The starts vary slightly from run to run.

    Exit code: 0 every run of every controller reached the target; 1 some did not; 2 an argument is wrong or names
    something that does not exist.
    """
    from kit.study.pairs import run_repeatedly

    found = []
    with _explained_errors():
        drivers = [find_controller(each) for each in controllers]
        # Without a case there is no target: then loading says so.
        for name in [case] if case is not None else case_names(place) or [None]:
            scenario = replace(_find_place(place, name), charges=charges)
            for driver in drivers:
                found.append(run_repeatedly(scenario, driver, runs=runs, seed=seed))
                if not as_json:
                    _print_test(found[-1], first=len(found) == 1)
    if as_json:
        click.echo(json.dumps([asdict(each) for each in found], indent=2))
    if any(each.accuracy < 1.0 for each in found):
        raise SystemExit(FAILED)


@command.command()
@_RUNS
@options.seed
@_JSON
def table(runs: int, seed: int, as_json: bool) -> None:
    """Print the dissertation's Tables 4.6 and 5.3 beside new runs. Of Table 4.6, only the APF columns are printed.

    `fields` is the dissertation's controller, `abreast` the kit's. Adjacency is the share of the time that the two
    robots are side by side. `rays` measures it with four laser rays (equations 4.7 to 4.9); the lasers' noise limits
    it to 0.96. `poses` computes it from the poses (equations 4.2 to 4.6, corrected). The dissertation does not say
    which of the two its `adj` is for potential fields; `fields` is well below it by rays and close to it by poses.
    """
    from kit.study.pairs import TABLE_46, run_tables

    drivers = tuple(find_controller(name) for name in BOTH)
    if not as_json:
        click.echo(f"{'':<16}  dissertation  {'fields':^20}  {'abreast':^20}")
        click.echo(
            f"{'':<16}  {'acc':>5} {'adj':>6}  {'acc':>6} {'rays':>6} {'poses':>6}  {'acc':>6} {'rays':>6} {'poses':>6}"
        )
        click.echo("Table 4.6")
    printed: list[tuple[PrintedPairResult, tuple[PairSummary, ...]]] = []
    failures: list[str] = []
    with _explained_errors():
        for number, (row, ours) in enumerate(run_tables(runs, seed, drivers)):
            printed.append((row, ours))
            failures += [
                f"{row.title}, {each.controller}: {count} of {each.runs} {why}"
                for each in ours
                for count, why in each.failures
            ]
            if as_json:
                continue
            if number == len(TABLE_46):
                click.echo("Table 5.3, the map of tutorial 3")
            click.echo(_table_row(row, ours))
    if as_json:
        facts = [asdict(row) | {each.controller: asdict(each) for each in ours} for row, ours in printed]
        click.echo(json.dumps(facts, indent=2))
        return
    for line in failures:
        click.echo(line)


def _table_row(row: PrintedPairResult, ours: tuple[PairSummary, ...]) -> str:
    theirs = f"{_number_text(row.accuracy):>5} {_number_text(row.adjacency):>6}"
    cells = "  ".join(map(_measures_text, ours))
    return f"  {row.title:<14}  {theirs}  {cells}"


def _measures_text(each: PairSummary) -> str:
    """Success and adjacency by both measures; none where a program failed, which is no result of the method."""
    if each.broken:
        return " ".join([f"{'-':>6}"] * 3)
    return f"{each.accuracy:6.2f} {each.by_rays:6.2f} {each.by_geometry:6.2f}"


def _number_text(value: float | None) -> str:
    return "-" if value is None else f"{value:.2f}"


def _print_test(summary: PairSummary, *, first: bool) -> None:
    if first:
        click.echo(
            f"{'case':<20} {'controller':<10} {'runs':>4} {'acc':>5} {'adj':>5} {'rays':>5} {'graded':>6} "
            f"{'path m':>6} {'time s':>6} {'wall m':>6} {'jerk':>6}"
        )
    each = summary
    click.echo(
        f"{each.case:<20} {each.controller:<10} {each.runs:>4} {each.accuracy:>5.2f} {each.by_geometry:>5.2f} "
        f"{each.by_rays:>5.2f} {each.adjacency_score:>6.2f} {each.path_m:>6.2f} {each.time_s:>6.1f} "
        f"{each.nearest_wall_m:>6.2f} {each.jerk:>6.2f}"
    )
    for count, failure in each.failures:
        click.echo(f"  {count} of {each.runs} {failure}")


def _describe_field(scenario: Scenario, setup: ControllerSetup) -> Iterator[str]:
    """The field in characters and in words."""
    from kit.fields.controller_setup import mean_position
    from kit.fields.planner import Unreachable
    from kit.render.camera import Camera
    from kit.render.encode import AsciiEncoder
    from kit.render.field import FieldPicture, with_field
    from kit.render.painter import Painter
    from kit.run.session import Session
    from kit.run.view import ViewBuilder

    picture = FieldPicture(setup)
    traps = picture.traps()
    with Session(scenario) as session:
        scene = ViewBuilder(session).build().scene
    camera = Camera.fit(scene.bounds, *PICTURE)
    yield from (
        Painter(AsciiEncoder())
        .paint(with_field(scene, picture, camera, picture.forces, traps), camera)
        .rows()
    )
    layout = setup.layout
    yield f"charges: {layout.source or 'derived from the walls'}"
    yield "intensities: " + ", ".join(
        f"{name} {value:g}" for name, value in asdict(layout.intensities).items()
    )
    for difference in setup.layout_differences():
        yield f"unlike the walls: {difference}"
    for trap in traps:
        yield f"trap (!) at ({trap.x:.2f}, {trap.y:.2f}): {trap.share:.0%} of the floor leads there"
    start = mean_position(scenario.starts)
    verdict = "lead to the target" if setup.flow.reaches(*start) else "do not lead to the target"
    yield f"from the start, the forces {verdict}"
    try:
        yield f"the planner's ride takes {setup.plan_trajectory(scenario.starts).seconds:.1f} s"
    except Unreachable as reason:
        yield str(reason)


def _open_setup(scenario: Scenario, derived: bool) -> ControllerSetup:
    from kit.fields.controller_setup import ControllerSetup

    if scenario.case is None:
        raise LookupError(
            f"{scenario.name} has no target, so it has no field. Put a model named beacon there, or write about.yaml beside it:\n"
            "    robot: serp\n    cases:\n      - {name: one, start: [1, 1, 0], target: [3, 2]}\n"
            "Or choose one of the kit's maps; `kit maps` lists them."
        )
    return ControllerSetup.load(
        scenario.world.file,
        scenario.partners,
        scenario.case.target,
        scenario.case.target_radius,
        derived=derived,
        charges=scenario.charges,
    )


def _find_place(name: str, case: str | None) -> Scenario:
    return find_scenario(name, case)


@contextmanager
def _explained_errors() -> Iterator[None]:
    """A mistake of the user's ends the verb with its message."""
    try:
        yield
    except (LookupError, ValueError, WorldError, OSError) as error:
        messages.fail(messages.describe_error(error))
