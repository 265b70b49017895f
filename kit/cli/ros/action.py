"""``kit ros action``: the actions of the running world."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from typing import Any

import click

from kit.cli.lazy_group import HintingGroup
from kit.cli.process import INTERRUPTED
from kit.cli.ros.message_options import find_or_exit, make_message, parse_fields
from kit.cli.ros.world_client import (
    exit_with_error,
    print_names,
    print_names_of,
    print_types_of,
    with_world_client,
)
from kit.inspection.client import CHECK_INTERVAL_S, NODE_PREFIX, InspectionClient
from kit.inspection.graph_text import absolute_name
from kit.msg.interfaces import find_action
from kit.msg.message_text import MessageFormat, to_yaml
from kit.plain_text import nearest_name
from kit.ros.action.client import ActionClient, ClientGoalHandle
from kit.ros.action.goal_states import ENDED, STATUS_NAMES, uuid_bytes
from kit.ros.execution.task import Future
from kit.ros.graph.action_names import (
    action_names_and_types,
    all_served_actions,
    called_actions,
    served_actions,
)
from kit.ros.node.time import S_TO_NS


@click.group(cls=HintingGroup)
def command() -> None:
    """Inspect the actions of the running world and send goals, which take time and can be canceled."""


@command.command("list")
@click.option("-t", "--show-types", is_flag=True, help="Show their types too.")
@click.option("-c", "--count-actions", "--count", "count", is_flag=True, help="Print only their number.")
@with_world_client
def list_actions(client: InspectionClient, show_types: bool, count: bool) -> None:
    """List the names of all actions."""
    print_names(action_names_and_types(client.graph.directory), count=count, show_types=show_types)


@command.command()
@click.argument("name", metavar="ACTION")
@click.option("-t", "--show-types", is_flag=True, help="Show the action's type too.")
@click.option("-c", "--count", is_flag=True, help="Print only the numbers of clients and servers.")
@with_world_client
def info(client: InspectionClient, name: str, show_types: bool, count: bool) -> None:
    """Print an action's clients and servers.

    \b
    kit ros action info /fibonacci -t
    """
    click.echo(f"Action: {name}")
    for title, actions_of in (("clients", called_actions), ("servers", served_actions)):
        found = [
            (handle.full_name, dict(actions_of(handle))[absolute_name(name)])
            for handle in client.graph.directory.nodes
            if absolute_name(name) in dict(actions_of(handle))
        ]
        click.echo(f"Action {title}: {len(found)}")
        for node, types in [] if count else found:
            click.echo(f"    {node} [{', '.join(types)}]" if show_types else f"    {node}")


@command.command("type")
@click.argument("name", metavar="ACTION")
@with_world_client
def type_of(client: InspectionClient, name: str) -> None:
    """Print an action's type."""
    print_types_of(name, action_names_and_types(client.graph.directory))


@command.command()
@click.argument("type_name", metavar="TYPE")
@click.option("-c", "--count-actions", "--count", "count", is_flag=True, help="Print only their number.")
@with_world_client
def find(client: InspectionClient, type_name: str, count: bool) -> None:
    """List the actions of a type."""
    print_names_of(type_name, action_names_and_types(client.graph.directory), count=count)


@command.command("send_goal")
@click.argument("name", metavar="ACTION")
@click.argument("type_name", metavar="TYPE")
@click.argument("values", required=False, metavar="[YAML]")
@click.option("--stdin", "from_stdin", is_flag=True, help="Read the goal from standard input.")
@click.option("-f", "--feedback", is_flag=True, help="Print the feedback as well.")
@click.option(
    "-t",
    "--timeout",
    type=click.FloatRange(0),
    metavar="S",
    help="Longest time to wait for a server [s, simulated] (default: until Ctrl-C).",
)
@with_world_client
def send_goal(
    client: InspectionClient,
    name: str,
    type_name: str,
    values: str | None,
    from_stdin: bool,
    feedback: bool,
    timeout: float | None,
) -> None:
    """Send a goal, and print its result. Ctrl-C cancels the goal.

    \b
    kit ros action send_goal -f /fibonacci \\
      example_interfaces/action/Fibonacci "{order: 5}"
    """
    cls = find_or_exit(find_action, type_name)
    if from_stdin and values is not None:
        raise click.UsageError("Give the goal as YAML or with --stdin, not both.")
    content = parse_fields(sys.stdin.read() if from_stdin else values or "{}")
    goal = make_message(cls.Goal, content, client.graph.now_ns)
    node = client.create_node(f"{NODE_PREFIX}send_goal_{os.getpid()}")
    sender = _GoalSender(client, ActionClient(node, cls, name))
    sender.wait_for_server(name, timeout)
    click.echo(f"Sending goal:\n     {_yaml(goal)}")
    sender.send(goal, show_feedback=feedback)


class _GoalSender:
    """Sends one goal, and prints what becomes of it."""

    def __init__(self, client: InspectionClient, action_client: ActionClient) -> None:
        self._client = client
        self._action_client = action_client
        self._presses = 0
        """How often Ctrl-C was pressed since the goal was sent."""

    def wait_for_server(self, name: str, timeout_s: float | None) -> None:
        """Exits if there is none by then, or if the action has another type."""
        click.echo("Waiting for an action server to become available...")
        action_client, graph = self._action_client, self._client.graph
        if action_client.server_is_ready():
            return
        served = all_served_actions(graph.directory)
        own_type = action_client.action_type.__ros_type__
        types = served.get(action_client.action_name, [own_type])
        if own_type not in types:
            exit_with_error(f"'{name}' is of the type {', '.join(types)}, not {own_type}")
        near = nearest_name(action_client.action_name, served)
        hint = f" Did you mean '{near}'?" if near else f" There are: {', '.join(served) or 'none'}."
        click.echo(f"No node serves '{action_client.action_name}' yet.{hint}", err=True)
        until = None if timeout_s is None else graph.now_ns + int(timeout_s * S_TO_NS)
        if not graph.wait(action_client.server_is_ready, until):
            exit_with_error("Action server is not available")

    def send(self, goal: object, *, show_feedback: bool) -> None:
        """Sends the goal and waits for its end. Ctrl-C cancels it, and exits; the second one exits at once."""
        before = signal.signal(signal.SIGINT, self._on_interrupt)
        try:
            result = self._result_of(goal, show_feedback)
        finally:
            signal.signal(signal.SIGINT, before)
        if self._presses:
            raise SystemExit(INTERRUPTED)
        if result is not None:
            click.echo(f"Result:\n    {_yaml(result.result)}")
            click.echo(f"Goal finished with status: {STATUS_NAMES[result.status]}")

    def _on_interrupt(self, number: int, frame: object) -> None:
        # No exception at the first: the connection to the world must stay in step.
        self._presses += 1
        if self._presses > 1:
            raise KeyboardInterrupt

    def _result_of(self, goal: object, show_feedback: bool) -> Any:
        """The goal's result; None if it was rejected or canceled."""
        callback = _print_feedback if show_feedback else None
        handle = self._wait_for(self._action_client.send_goal_async(goal, callback))
        if not handle.accepted:
            click.echo("Goal was rejected.")
            return None
        click.echo(f"Goal accepted with ID: {uuid_bytes(handle.goal_id).hex()}\n")
        future = handle.get_result_async()
        result = self._wait_for(future, lambda: self._presses > 0)
        if not future.done() and handle.status not in ENDED:
            self._cancel(handle)
        return result

    def _cancel(self, handle: ClientGoalHandle) -> None:
        click.echo("Canceling goal...")
        answer = self._wait_for(handle.cancel_goal_async())
        if not any(each.goal_id == handle.goal_id for each in answer.goals_canceling):
            exit_with_error("Failed to cancel goal")
        click.echo("Goal canceled.")

    def _wait_for(self, future: Future[Any], is_over: Callable[[], bool] = lambda: False) -> Any:
        """The future's result, None if it ``is_over`` before; exits if the server goes first."""
        action_client = self._action_client
        self._client.spin(
            action_client.node,
            lambda: future.done() or is_over() or not action_client.pending_count,
            future,
            check_interval_s=CHECK_INTERVAL_S,
        )
        result = future.result()
        if result is None and not is_over():
            exit_with_error(f"The server of '{action_client.action_name}' is gone; the goal has no result.")
        return result


def _print_feedback(message: object) -> None:
    click.echo(f"Feedback:\n    {_yaml(message.feedback)}")  # type: ignore[attr-defined]  # a FeedbackMessage


def _yaml(message: object) -> str:
    return to_yaml(message, MessageFormat(longest=None))  # type: ignore[arg-type]  # a message
