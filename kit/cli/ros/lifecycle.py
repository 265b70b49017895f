"""``kit ros lifecycle``: the lifecycle nodes of the running world."""

from __future__ import annotations

from typing import Any, Final

import click

from kit.cli.lazy_group import HintingGroup
from kit.cli.ros.world_client import exit_with_error, with_world_client
from kit.inspection.client import InspectionClient
from kit.inspection.graph_text import absolute_name, node_names
from kit.msg.interfaces import find_service

GET_STATE_TYPE: Final = "lifecycle_msgs/srv/GetState"


@click.group(cls=HintingGroup)
def command() -> None:
    """Inspect and change the lifecycle nodes of the running world, which are configured and activated from outside."""


@command.command()
@click.option("-a", "--all", "hidden", is_flag=True, help="Include hidden nodes.")
@click.option("-c", "--count-nodes", "--count", "count", is_flag=True, help="Print only their number.")
@with_world_client
def nodes(client: InspectionClient, hidden: bool, count: bool) -> None:
    """List the full names of all lifecycle nodes."""
    found = _lifecycle_nodes(client, hidden=hidden)
    if count:
        click.echo(len(found))
        return
    for name in found:
        click.echo(name)


@command.command()
@click.argument("node", required=False)
@click.option("-a", "--all", "--include-hidden-nodes", "hidden", is_flag=True, help="Include hidden nodes.")
@click.option(
    "--timeout", type=click.FloatRange(0), metavar="S", help="Longest time to wait for an answer [s]."
)
@with_world_client
def get(client: InspectionClient, node: str | None, hidden: bool, timeout: float | None) -> None:
    """Print the state of a lifecycle node, or of all of them."""
    found = _lifecycle_nodes(client, hidden=hidden)
    for name in found if node is None else [_find_lifecycle_node(found, node)]:
        state = _call(client, name, "get_state", GET_STATE_TYPE, timeout_s=timeout).current_state
        click.echo(f"{'' if node else f'{name}: '}{state.label} [{state.id}]")


@command.command("list")
@click.argument("node")
@click.option("-a", "--all", "every", is_flag=True, help="List all transitions, not only those possible now.")
@click.option("--include-hidden-nodes", "hidden", is_flag=True, help="Include hidden nodes.")
@with_world_client
def list_transitions(client: InspectionClient, node: str, every: bool, hidden: bool) -> None:
    """List the transitions possible from a node's current state."""
    name = _find_lifecycle_node(_lifecycle_nodes(client, hidden=hidden), node)
    for each in _transitions(client, name, "get_transition_graph" if every else "get_available_transitions"):
        click.echo(f"- {each.transition.label} [{each.transition.id}]")
        click.echo(f"\tStart: {each.start_state.label}\n\tGoal: {each.goal_state.label}")


@command.command("set")
@click.argument("node")
@click.argument("transition")
@click.option("--include-hidden-nodes", "hidden", is_flag=True, help="Include hidden nodes.")
@with_world_client
def set_state(client: InspectionClient, node: str, transition: str, hidden: bool) -> None:
    """Request a transition of a node, by label or number.

    \b
    kit ros lifecycle set /talker configure
    """
    name = _find_lifecycle_node(_lifecycle_nodes(client, hidden=hidden), node)
    possible = [each.transition for each in _transitions(client, name, "get_available_transitions")]
    wanted = next((each for each in possible if transition in (each.label, str(each.id))), None)
    if wanted is None:
        ways = "".join(f"\n- {each.label} [{each.id}]" for each in possible)
        exit_with_error(f"Unknown transition requested, available ones are:{ways}")
    answer = _call(client, name, "change_state", "lifecycle_msgs/srv/ChangeState", transition=wanted)
    if not answer.success:
        exit_with_error("Transitioning failed")
    click.echo("Transitioning successful")


def _lifecycle_nodes(client: InspectionClient, *, hidden: bool) -> list[str]:
    """The full names of the nodes that offer the service ``get_state``, sorted."""
    served = dict(client.graph.directory.service_names_and_types())
    return [
        name
        for name in node_names(client.graph, hidden=hidden)
        if GET_STATE_TYPE in served.get(f"{name}/get_state", ())
    ]


def _find_lifecycle_node(names: list[str], name: str) -> str:
    if absolute_name(name) not in names:
        exit_with_error("Node not found")
    return absolute_name(name)


def _transitions(client: InspectionClient, node: str, service: str) -> Any:
    srv_type = "lifecycle_msgs/srv/GetAvailableTransitions"
    return _call(client, node, service, srv_type).available_transitions


def _call(
    client: InspectionClient,
    node: str,
    service: str,
    srv_type: str,
    *,
    timeout_s: float | None = None,
    **fields: Any,
) -> Any:
    cls = find_service(srv_type)
    return client.call(cls, f"{node}/{service}", cls.Request(**fields), timeout_s=timeout_s)
