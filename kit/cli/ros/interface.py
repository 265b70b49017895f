"""``kit ros interface``: the types of messages and services."""

from __future__ import annotations

import click

from kit.cli.ros.message_values import find_or_exit
from kit.cli.ros.world_client import exit_with_error
from kit.inspection.graph_text import definition_text
from kit.inspection.message_text import MessageFormat, to_yaml
from kit.msg.interfaces import PACKAGES, find_interface, interface_names, interfaces
from kit.msg.message import Message, is_custom_interface


@click.group()
def command() -> None:
    """The types of messages and services. Needs no running world."""


@command.command("list")
@click.option("-m", "--only-msgs", is_flag=True, help="Only messages.")
@click.option("-s", "--only-srvs", is_flag=True, help="Only services.")
@click.option("-a", "--only-actions", is_flag=True, help="Only actions, of which the kit has none.")
def list_interfaces(only_msgs: bool, only_srvs: bool, only_actions: bool) -> None:
    """List the names of all types."""
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
def show(name: str) -> None:
    """Print a type's definition, with those of all types in it.

    \b
    kit ros interface show geometry_msgs/msg/Twist
    """
    cls = find_or_exit(find_interface, name)
    if is_custom_interface(cls):
        click.echo("# Not a part of ROS 2: the kit's own, or Flatland's.")
    click.echo(definition_text(cls), nl=False)


@command.command()
@click.argument("name", metavar="TYPE")
@click.option("--no-quotes", is_flag=True, help="Without the quotes around it.")
def proto(name: str, no_quotes: bool) -> None:
    """Print a message with its defaults, or a service's request, to copy and fill in."""
    cls = find_or_exit(find_interface, name)
    text = to_yaml(cls() if issubclass(cls, Message) else cls.Request(), MessageFormat(longest=None))
    click.echo(text if no_quotes else f'"{text}"')


@command.command()
@click.argument("name", metavar="PACKAGE")
def package(name: str) -> None:
    """List the types of one package."""
    if name not in PACKAGES:
        exit_with_error(f"Unknown package '{name}'; there are: {', '.join(PACKAGES)}")
    for cls in interfaces(name):
        click.echo(cls.__ros_type__)


@command.command()
@click.option("-m", "--only-msgs", is_flag=True, help="Only those with messages.")
@click.option("-s", "--only-srvs", is_flag=True, help="Only those with services.")
def packages(only_msgs: bool, only_srvs: bool) -> None:
    """List the packages that have types."""
    for name in PACKAGES:
        parts = {cls.__ros_type__.split("/")[1] for cls in interfaces(name)}
        if (not only_msgs or "msg" in parts) and (not only_srvs or "srv" in parts):
            click.echo(name)
