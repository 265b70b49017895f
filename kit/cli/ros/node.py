"""``kit ros node``: the nodes of the running world."""

from __future__ import annotations

import click

from kit.cli.lazy_group import HintingGroup
from kit.cli.ros.world_client import exit_with_error, with_world_client
from kit.inspection.client import InspectionClient
from kit.inspection.graph_text import absolute_name, node_info, node_names


@click.group(cls=HintingGroup)
def command() -> None:
    """Inspect the nodes of the running world: programs, or parts of programs, that exchange messages."""


@command.command("list")
@click.option("-a", "--all", "hidden", is_flag=True, help="Include hidden nodes, such as this command's own.")
@click.option("-c", "--count-nodes", "--count", "count", is_flag=True, help="Print only their number.")
@with_world_client
def list_nodes(client: InspectionClient, hidden: bool, count: bool) -> None:
    """List the full names of all nodes."""
    names = node_names(client.graph, hidden=hidden)
    if len(set(names)) < len(names):
        click.echo(
            "WARNING: Be aware that there are nodes in the graph that share an exact name, "
            "which can have unintended side effects.",
            err=True,
        )
    if count:
        click.echo(len(names))
    else:
        for name in names:
            click.echo(name)


@command.command()
@click.argument("name", metavar="NODE")
@click.option("--include-hidden", "hidden", is_flag=True, help="Include hidden topics and services.")
@with_world_client
def info(client: InspectionClient, name: str, hidden: bool) -> None:
    """Print a node's subscribers, publishers, services and clients.

    \b
    kit ros node info /flatland_server
    """
    handles = [handle for handle in client.graph.directory.nodes if handle.full_name == absolute_name(name)]
    if not handles:
        exit_with_error(f"Unable to find node '{name}'")
    if len(handles) > 1:
        click.echo(
            f'There are {len(handles)} nodes in the graph with the exact name "{name}". '
            "You are seeing information about only one of them.",
            err=True,
        )
    for line in node_info(handles[0], hidden=hidden):
        click.echo(line)
