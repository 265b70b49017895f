"""``kit world``: checks a world file, and reports its errors, collisions and laser views."""

from __future__ import annotations

import json
from pathlib import Path

import click

from kit.cli import options
from kit.cli.existing_path import ExistingPath
from kit.cli.lazy_group import HintingGroup
from kit.plain_files import near_file
from kit.plain_text import counted
from kit.sim.plugins import plugin_readers, world_plugin_readers
from kit.world.catalogue import WORLD_FILE, UnknownMap, allowed_root_of, find_map, map_names, own_map_folder
from kit.world.loading import load_world
from kit.world.problems import Problem, WorldError
from kit.world.report import world_report, world_report_data


@click.group(cls=HintingGroup)
def command() -> None:
    """Check a world: errors, which models collide, what each laser sees."""


@command.command()
@click.argument("world", metavar="FILE_OR_MAP")
@click.option(
    "--root",
    type=ExistingPath(file_okay=False, path_type=Path),
    help="Folder that the world file may read.  [default: its own]",
)
@click.option(
    "--env",
    "variables",
    metavar="NAME[=VALUE]",
    multiple=True,
    help="Environment variable that env() in the world may read; repeat for more.  [default: none]",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def check(world: str, root: Path | None, variables: tuple[str, ...], as_json: bool) -> None:
    """Check a world with all its files. Print every error, or its contents and which models collide.

    FILE_OR_MAP is a world file, a folder with a world.yaml, or the name of one of the kit's maps.

    Exit code: 0 the world is valid; 1 it has errors; 2 there is no such world.
    """
    file, own_root = _find_world(world)
    try:
        loaded = load_world(
            file,
            plugin_readers=plugin_readers,
            world_plugin_readers=world_plugin_readers,
            root=root or own_root,
            environment=dict(map(options.environment_variable, variables)),
        )
    except WorldError as error:
        if as_json:
            click.echo(
                json.dumps({"ok": False, "problems": [_problem_as_dict(p) for p in error.problems]}, indent=2)
            )
        else:
            click.echo(error)
            count = len(error.problems)
            click.echo("\n" + counted(count, "problem"), err=True)
        raise SystemExit(1) from None
    click.echo(
        json.dumps({"ok": True, **world_report_data(loaded)}, indent=2) if as_json else world_report(loaded)
    )


def _find_world(world: str) -> tuple[Path, Path | None]:
    """The world file meant, and the folder it may use if that is not its own."""
    path = Path(world)
    try:
        if world not in map_names() and not path.exists():
            path = own_map_folder(world) or path
        if path.is_dir():
            path /= WORLD_FILE
        if path.exists():
            return path, allowed_root_of(path)
    except OSError as error:  # no permission; a name too long
        raise click.UsageError(f"Cannot open {path}: {error.strerror}.") from None
    if len(Path(world).parts) > 1 or path.suffix or "\\" in world:
        near = near_file(world)
        hint = f" Did you mean {near}?" if near else ""
        raise click.UsageError(f"There is no file {path}.{hint}")
    try:
        card = find_map(world)
    except UnknownMap as error:
        raise click.UsageError(str(error)) from None
    return card.world_file, card.root


def _problem_as_dict(problem: Problem) -> dict[str, str | int]:
    location = problem.location
    return {
        "file": str(location.file),
        "line": location.line,
        "column": location.column,
        "message": problem.message,
    }
