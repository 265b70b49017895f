"""The help of every command and group: whole, and in the marks that a terminal shows."""

from __future__ import annotations

from collections.abc import Iterator

import click
import pytest

from grader.__main__ import main as grader
from kit.cli import main as kit


def commands(command: click.Command, path: str) -> Iterator[tuple[str, click.Command]]:
    """A command and all below it, with the words that call each."""
    yield path, command
    if isinstance(command, click.Group):
        context = click.Context(command, info_name=path)
        for name in command.list_commands(context):
            if (below := command.get_command(context, name)) is not None:
                yield from commands(below, f"{path} {name}")


@pytest.mark.parametrize(("name", "root"), [("kit", kit), ("grader", grader)])
def test_help_cuts_no_sentence_and_has_no_marks_of_other_formats(name: str, root: click.Command) -> None:
    found = dict(commands(root, name))
    assert len(found) > 10
    for path, command in found.items():
        context = click.Context(command, info_name=path, terminal_width=80)
        text = command.get_help(context)
        assert "``" not in text, path
        listed = text.partition("\nCommands:\n")[2]
        assert "..." not in listed, path
        if isinstance(command, click.Group):
            assert all(f"  {each} " in listed for each in shown(command, context)), path


def shown(group: click.Group, context: click.Context) -> list[str]:
    """The commands of a group that are not hidden; of the outermost one, whose list is written, none."""
    if context.info_name in ("kit", "grader", "kit ros"):
        return []
    named = {name: group.get_command(context, name) for name in group.list_commands(context)}
    return [name for name, each in named.items() if each is not None and not each.hidden]


def test_a_group_within_a_group_offers_the_nearest_command() -> None:
    with pytest.raises(click.UsageError, match="Did you mean `kit ros topic echo`"):
        kit.main(["ros", "topic", "ehco"], prog_name="kit", standalone_mode=False)
