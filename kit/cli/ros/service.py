"""``kit ros service``: the services of the running world."""

from __future__ import annotations

import sys

import click

from kit.cli.lazy_group import HintingGroup
from kit.cli.ros import topic
from kit.cli.ros.message_options import find_or_exit, make_message, parse_fields
from kit.cli.ros.world_client import (
    exit_with_error,
    print_names,
    print_names_of,
    print_types_of,
    with_world_client,
)
from kit.inspection.client import InspectionClient
from kit.inspection.graph_text import service_info, services
from kit.msg.interfaces import find_service


@click.group(cls=HintingGroup)
def command() -> None:
    """Inspect and call the services of the running world: requests that a node answers."""


@command.command("list")
@click.option("-t", "--show-types", is_flag=True, help="Show their types too.")
@click.option("-c", "--count-services", "--count", "count", is_flag=True, help="Print only their number.")
@click.option(
    "-a", "--all", "--include-hidden-services", "hidden", is_flag=True, help="Include hidden services."
)
@with_world_client
def list_services(client: InspectionClient, show_types: bool, count: bool, hidden: bool) -> None:
    """List the names of all services."""
    print_names(services(client.graph, hidden=hidden), count=count, show_types=show_types)


@command.command()
@click.argument("name", metavar="SERVICE")
@with_world_client
def info(client: InspectionClient, name: str) -> None:
    """Print a service's type, and how many servers and clients it has."""
    types = dict(services(client.graph, hidden=True)).get(name)
    if types is None:
        exit_with_error(f"Unknown service '{name}'")
    for line in service_info(client.graph, name, types):
        click.echo(line)


@command.command("type")
@click.argument("name", metavar="SERVICE")
@with_world_client
def type_of(client: InspectionClient, name: str) -> None:
    """Print a service's type."""
    print_types_of(name, services(client.graph, hidden=True))


@command.command()
@click.argument("type_name", metavar="TYPE")
@click.option("-c", "--count-services", "--count", "count", is_flag=True, help="Print only their number.")
@with_world_client
def find(client: InspectionClient, type_name: str, count: bool) -> None:
    """List the services of a type."""
    print_names_of(type_name, services(client.graph, hidden=True), count=count)


command.add_command(topic.echo_service)


@command.command()
@click.argument("name", metavar="SERVICE")
@click.argument("type_name", metavar="TYPE")
@click.argument("values", default="{}", metavar="[YAML]")
@click.option(
    "-r",
    "--rate",
    type=click.FloatRange(0, min_open=True),
    help="Repeat the call this many times per second.",
)
@click.option("--stdin", is_flag=True, help="Read the request from standard input.")
@with_world_client
def call(
    client: InspectionClient, name: str, type_name: str, values: str, rate: float | None, stdin: bool
) -> None:
    """Call a service and print its response.

    \b
    kit ros service call /pause std_srvs/srv/Empty
    kit ros service call /move_model flatland_msgs/srv/MoveModel \\
      "{name: serp, pose: {x: 0.5}}"
    """
    cls = find_or_exit(find_service, type_name)
    content = parse_fields(sys.stdin.read() if stdin else values)
    graph = client.graph
    service_client = client.node.create_client(cls, name)
    if not service_client.service_is_ready():
        click.echo("waiting for service to become available...")
        service_client.wait_for_service()
    while True:
        request = make_message(cls.Request, content, graph.now_ns)
        click.echo(f"requester: making request: {request!r}\n")
        asked_ns = graph.now_ns
        response = client.call(cls, name, request)
        click.echo(f"response:\n{response!r}\n")
        if rate is None:
            return
        graph.wait(lambda: False, asked_ns + int(1e9 / rate))
