"""``kit ros topic``: the topics of the running world."""

from __future__ import annotations

import click

from kit.cli.ros import topic_publisher, topic_subscribers
from kit.cli.ros.world_client import exit_with_error, print_names_of, print_types_of, with_world_client
from kit.inspection.client import InspectionClient
from kit.inspection.graph_text import topic_info, topic_summary, topics


@click.group()
def command() -> None:
    """The topics of the running world: named channels for messages."""


@command.command("list")
@click.option("-t", "--show-types", is_flag=True, help="With their types.")
@click.option("-c", "--count-topics", "--count", "count", is_flag=True, help="Only how many.")
@click.option("-a", "--all", "--include-hidden-topics", "hidden", is_flag=True, help="Hidden ones too.")
@click.option("-v", "--verbose", is_flag=True, help="With the numbers of publishers and subscriptions.")
@with_world_client
def list_topics(client: InspectionClient, show_types: bool, count: bool, hidden: bool, verbose: bool) -> None:
    """List the names of all topics."""
    found = topics(client.graph, hidden=hidden)
    if count:
        click.echo(len(found))
    elif verbose:
        for line in topic_summary(client.graph, found):
            click.echo(line)
    else:
        for name, types in found:
            click.echo(f"{name} [{', '.join(types)}]" if show_types else name)


@command.command()
@click.argument("name", metavar="TOPIC")
@click.option("-v", "--verbose", is_flag=True, help="With each endpoint: its node and quality of service.")
@with_world_client
def info(client: InspectionClient, name: str, verbose: bool) -> None:
    """Print a topic's type, and its numbers of publishers and subscriptions.

    \b
    kit ros topic info /static_laser -v
    """
    types = dict(topics(client.graph, hidden=True)).get(name)
    if types is None:
        exit_with_error(f"Unknown topic '{name}'")
    for line in topic_info(client.graph, name, types, verbose=verbose):
        click.echo(line)


@command.command("type")
@click.argument("name", metavar="TOPIC")
@with_world_client
def type_of(client: InspectionClient, name: str) -> None:
    """Print a topic's type."""
    print_types_of(name, topics(client.graph, hidden=True))


@command.command()
@click.argument("type_name", metavar="TYPE")
@click.option("-c", "--count-topics", "--count", "count", is_flag=True, help="Only how many.")
@click.option("--include-hidden-topics", "hidden", is_flag=True, help="Hidden ones too.")
@with_world_client
def find(client: InspectionClient, type_name: str, count: bool, hidden: bool) -> None:
    """List the topics of a type."""
    print_names_of(type_name, topics(client.graph, hidden=hidden), count=count)


for verb in (
    topic_subscribers.echo,
    topic_subscribers.hz,
    topic_subscribers.bw,
    topic_subscribers.delay,
    topic_publisher.pub,
):
    command.add_command(verb)
