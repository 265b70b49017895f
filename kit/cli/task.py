"""``kit task``: tasks of one's own: make, check and show them."""

from __future__ import annotations

import os
import shutil
import tempfile
from pathlib import Path

import click

from kit.cli import learning_options, messages, terminal_options
from kit.cli.existing_path import ExistingPath
from kit.cli.lazy_group import HintingGroup
from kit.cli.output_file import OutputFile
from kit.document.blocks import Text, labelled_table
from kit.document.layout import Page, lines_of
from kit.learning.authoring.new_task import NewTaskError, new_task_file, write_task
from kit.learning.authoring.task_archive import TaskArchiveError, pack_task, unpack_task
from kit.learning.authoring.task_check import check_task
from kit.learning.authoring.task_text import (
    build_case_scene,
    describe_case,
    key_tables,
    task_blocks,
    tasks_table,
)
from kit.learning.policies.policy_node import node_refusals
from kit.learning.tasks.catalogue import dissertation_tasks, find_task, first_tasks
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.own_files import own_task_files, workspace_folders, workspace_task_file
from kit.learning.tasks.task_reader import TASK_FILE, read_task, task_name
from kit.learning.training.run_check import check_reward
from kit.plain_text import counted, wrap
from kit.render.encode import ENCODERS
from kit.render.world_text import scene_rows
from kit.school.game.level_task import MEMORY, SEED, memory_steps, needs_memory, task_text
from kit.school.game.levels import GameLevel, UnknownLevel, find_level
from kit.school.game.task_levels import race_command, race_refusals


@click.group(cls=HintingGroup)
def command() -> None:
    """Define your own task: a YAML file with start, target, observations, actions and reward.

    \b
    kit task new mine --from turn
    kit task new mine --level depot  to train for a level of the game
    kit task keys                    list all keys of a task file
    kit task check mine
    kit task show mine
    kit train mine
    kit task pack mine               one file to share, with world and reward
    kit task unpack mine.zip

    A task with many cases can start with the easy ones; `kit task show` prints the stages:

    \b
    curriculum:
      - {on: [straight], success: 0.8}   next stage once each case reaches 0.8
      - {on: [straight, doors]}          0.9 if not given; then all cases
    """


@command.command()
@click.argument("name")
@click.option(
    "--from",
    "source",
    default="turn",
    show_default=True,
    help="One of the kit's tasks or maps, a map of your own, or a folder with a world.yaml.",
)
@click.option(
    "--level", help="Instead: a level of the game, by its name or number, for an agent to race there."
)
def new(name: str, source: str, level: str | None) -> None:
    """Create a task file, ready to train. It is NAME/task.yaml here, or FOLDER/NAME.yaml beside your own world."""
    with learning_options.explained_errors():
        try:
            if level is not None:
                _new_of_level(name, find_level(level))
                return
            file = new_task_file(name, source, Path())
        except (NewTaskError, UnknownLevel) as error:
            messages.fail(str(error))
        read = read_task(file)
        check_task(read)
        own = workspace_task_file(name)
        found_by_name = file.parent.name == name or (own is not None and own.samefile(file))
        shown = name if found_by_name else file
        messages.say(f"{file}: edit it; `kit task check {shown}` checks it, `kit train {shown}` trains it.")
        _say_whether_it_can_be_raced(read.task)


def _new_of_level(name: str, level: GameLevel) -> None:
    """Writes the task of a level, and says how to come from it to the race. Raises NewTaskError and UnknownLevel."""
    file = write_task(name, task_text(level), Path(name, TASK_FILE))
    check_task(read_task(file))
    steps = memory_steps(level)
    chosen = (
        f" --algo {MEMORY}{f' --steps {steps} --seed {SEED}' if steps else ''}" if needs_memory(level) else ""
    )
    messages.say(f"{file}: edit it, or train with it as it is:")
    click.echo(f"  kit train {name}{chosen} --name {name}")
    click.echo(f"  kit game race {level.command_name} --agent {name}")


@command.command()
@click.argument("task")
def check(task: str) -> None:
    """Check TASK, its worlds and its own reward. Print every error with its place.

    TASK can be a packed task."""
    with learning_options.explained_errors(), tempfile.TemporaryDirectory() as folder:
        shown = task
        if Path(task).suffix == ".zip" and Path(task).is_file():
            try:
                task = str(unpack_task(Path(task), Path(folder)))
            except TaskArchiveError as error:
                messages.fail(str(error))
        found = find_task(task)
        assert found.file is not None  # every task is a file
        check_task(read_task(found.file))
        if found.reward_file is not None:
            check_reward(found.reward_file, found)
        cases = len(found.map_cases())
        place = shown if shown != task else found.file
        click.echo(f"{place}: valid, version {found.version}; {counted(cases, 'case')}")
        _say_whether_it_can_be_raced(found)


@command.command()
@click.argument("task")
@click.option(
    "--output",
    "archive",
    type=OutputFile(),
    help="File to write (default: NAME.zip here).",
)
def pack(task: str, archive: Path | None) -> None:
    """Pack TASK into one zip file to share, with its world, pictures, models and reward."""
    with learning_options.explained_errors():
        found = find_task(task)
        assert found.file is not None  # every task is a file
        archive = archive or Path(f"{found.name}.zip")
        try:
            files = pack_task(found.file, archive)
        except TaskArchiveError as error:
            messages.fail(str(error))
        for file in files:
            click.echo(f"  {os.path.relpath(file, files[0].parent)}")
        click.echo(f"{archive}: {counted(len(files), 'file')}; `kit task unpack {archive}` unpacks it.")


@command.command()
@click.argument("archive", type=ExistingPath(dir_okay=False, path_type=Path))
@click.option(
    "--dest",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path(),
    help="Folder to unpack into (default: this one).",
)
def unpack(archive: Path, dest: Path) -> None:
    """Unpack a packed task and check it. ARCHIVE is a file made by `kit task pack`; the folder gets the task's name."""
    with learning_options.explained_errors():
        try:
            file = unpack_task(archive, dest)
        except TaskArchiveError as error:
            messages.fail(str(error))
        messages.say(
            f"{file}: valid; `kit task show {file.parent}` shows it, `kit train {file.parent}` trains it."
        )


@command.command()
@click.argument("task")
@learning_options.on
@terminal_options.glyphs
def show(task: str, on: str | None, glyphs: str | None) -> None:
    """Show TASK. Print starts (S) and targets on each map, observations, actions, reward, and how episodes end."""
    with learning_options.explained_errors():
        found = find_task(task)
        if on is not None:
            found = found.on(*learning_options.split_names(on))
        encoder = ENCODERS[terminal_options.decide(glyphs=glyphs).glyphs.value](True)
        columns, rows = shutil.get_terminal_size()
        for card, case in found.map_cases():
            click.echo("\n".join(wrap(describe_case(found, case), columns - 1)))
            scene = build_case_scene(found, card, case)
            click.echo("\n".join(scene_rows(scene, columns - 1, max(8, rows // 2), encoder)) + "\n")
        click.echo("\n".join(lines_of(task_blocks(found), _terminal_page())))


@command.command()
def keys() -> None:
    """Print every key of a task file, and every name that a reward may use."""
    click.echo("\n".join(lines_of(key_tables(), _terminal_page())))


@command.command(name="list")
def list_tasks() -> None:
    """List the kit's tasks, and your own task files in the workspace."""
    own = [(task_name(file), str(file)) for file in own_task_files(workspace_folders())]
    ways = "`kit task show NAME` shows one, `kit task new MINE --from NAME` starts your own from it."
    tables = [
        tasks_table(first_tasks()),
        tasks_table(dissertation_tasks(), "As in the dissertation:", indent=2),
        *([labelled_table(own, "Your own:", indent=2)] if own else []),
    ]
    click.echo("\n".join(lines_of([*tables, Text(ways)])))


def _say_whether_it_can_be_raced(task: LearningTask) -> None:
    """Prints how a trained agent of a task is raced, or why it cannot be, before anybody trains one."""
    if race := race_command(task, "RUN"):
        messages.say(f"`{race}` races an agent that has learned it.")
    for reason in race_refusals(task):
        messages.say(f"It cannot be raced: a level of the game cannot have {reason}.")
    for reason in node_refusals(task):
        messages.say(f"Its agents can be neither raced nor exported as a node or a package: {reason}.")


def _terminal_page() -> Page:
    """As wide as the terminal, at most 100 columns."""
    return Page(width=min(100, shutil.get_terminal_size().columns - 1))
