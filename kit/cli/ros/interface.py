"""``kit ros interface``: the types of messages, services and actions."""

from __future__ import annotations

import sys

import click

from kit.cli.lazy_group import HintingGroup
from kit.cli.ros.message_options import find_or_exit
from kit.cli.ros.world_client import exit_with_error, register_workspace_interfaces
from kit.inspection.definition_text import CommentOptions, definition_text
from kit.msg.interfaces import PACKAGES, find_interface, interface_names, known_packages
from kit.msg.message import Message, Service, is_custom_interface
from kit.msg.message_text import MessageFormat, to_yaml


@click.group(cls=HintingGroup)
def command() -> None:
    """Show message, service and action types. Needs no running world."""


@command.command("list")
@click.option("-m", "--only-msgs", is_flag=True, help="List only messages.")
@click.option("-s", "--only-srvs", is_flag=True, help="List only services.")
@click.option("-a", "--only-actions", is_flag=True, help="List only actions.")
def list_interfaces(only_msgs: bool, only_srvs: bool, only_actions: bool) -> None:
    """List the names of all types."""
    register_workspace_interfaces()
    every = not (only_msgs or only_srvs or only_actions)
    for title, part, wanted in (
        ("Messages", "msg", only_msgs),
        ("Services", "srv", only_srvs),
        ("Actions", "action", only_actions),
    ):
        if wanted or every:
            click.echo(f"{title}:")
            for name in interface_names():
                if name.split("/")[1] == part:
                    click.echo(f"    {name}")


@command.command()
@click.argument("name", metavar="TYPE")
@click.option("--all-comments", is_flag=True, help="Show the comments of nested types too.")
@click.option("--no-comments", is_flag=True, help="Leave out comments and empty lines.")
def show(name: str, all_comments: bool, no_comments: bool) -> None:
    """Print a type's definition with all nested types. - reads the type from standard input.

    \b
    kit ros interface show geometry_msgs/msg/Twist
    kit ros topic type /cmd_vel | kit ros interface show -
    """
    if all_comments and no_comments:
        raise click.UsageError("--all-comments and --no-comments cannot be combined.")
    if name == "-":
        name = sys.stdin.readline().strip()
    cls = find_or_exit(find_interface, name)
    if is_custom_interface(cls) and cls.__ros_type__.split("/")[0] in PACKAGES:
        click.echo("# Not a part of ROS 2: the kit's own, or Flatland's.")
    click.echo(definition_text(cls, CommentOptions(not no_comments, all_comments)), nl=False)


@command.command()
@click.argument("name", metavar="TYPE")
@click.option("--no-quotes", is_flag=True, help="Leave out the quotes around it.")
def proto(name: str, no_quotes: bool) -> None:
    """Print a message, request or goal with defaults, to copy and edit."""
    cls = find_or_exit(find_interface, name)
    if issubclass(cls, Message):
        message: Message = cls()
    else:
        message = cls.Request() if issubclass(cls, Service) else cls.Goal()
    text = to_yaml(message, MessageFormat(longest=None))
    click.echo(text if no_quotes else f'"{text}"')


@command.command()
@click.argument("name", metavar="PACKAGE")
def package(name: str) -> None:
    """List the types of one package."""
    register_workspace_interfaces()
    if name not in known_packages():
        exit_with_error(f"Unknown package '{name}'; available: {', '.join(known_packages())}")
    for full_name in interface_names(name):
        click.echo(full_name)


@command.command()
@click.option("-m", "--only-msgs", is_flag=True, help="List only packages with messages.")
@click.option("-s", "--only-srvs", is_flag=True, help="List only packages with services.")
@click.option("-a", "--only-actions", is_flag=True, help="List only packages with actions.")
def packages(only_msgs: bool, only_srvs: bool, only_actions: bool) -> None:
    """List the packages that have types."""
    register_workspace_interfaces()
    chosen = {("msg", only_msgs), ("srv", only_srvs), ("action", only_actions)}
    wanted = {part for part, is_wanted in chosen if is_wanted}
    for name in known_packages():
        if wanted <= {full_name.split("/")[1] for full_name in interface_names(name)}:
            click.echo(name)
