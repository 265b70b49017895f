"""``kit ros topic pub``: publishes a message on a topic."""

from __future__ import annotations

import click

from kit.cli.ros.message_values import find_or_exit, make_message, parse_fields
from kit.cli.ros.qos_options import QosOptions, with_qos_options
from kit.cli.ros.world_client import exit_with_error, with_world_client
from kit.host.codec import NotFiniteError
from kit.inspection.client import InspectionClient
from kit.inspection.graph_text import absolute_name
from kit.msg.interfaces import find_message
from kit.ros.exceptions import NameValidationException
from kit.ros.node.qos import QoSProfile


@click.command()
@click.argument("topic")
@click.argument("type_name", metavar="TYPE")
@click.argument("values", default="{}", metavar="[YAML]")
@click.option(
    "-r",
    "--rate",
    type=click.FloatRange(0, min_open=True),
    default=1.0,
    show_default=True,
    help="How often a second, in the world's time.",
)
@click.option("-1", "--once", is_flag=True, help="Once.")
@click.option("-t", "--times", type=click.IntRange(0), default=0, help="So many times.")
@click.option(
    "-p", "--print", "every", type=click.IntRange(0), default=1, help="Print only every so manieth message."
)
@click.option(
    "-w",
    "--wait-matching-subscriptions",
    "matching",
    type=click.IntRange(0),
    help="Begin when there are so many subscribers; 1 with --once and --times.",
)
@click.option("-n", "--node-name", help="Name of this command's node.")
@with_qos_options
@with_world_client
def pub(
    client: InspectionClient,
    topic: str,
    type_name: str,
    values: str,
    rate: float,
    once: bool,
    times: int,
    every: int,
    matching: int | None,
    node_name: str | None,
    qos_options: QosOptions,
) -> None:
    """Publish a message on a topic: repeatedly until Ctrl-C, or once.

    \b
    kit ros topic pub --once /cmd_vel geometry_msgs/msg/Twist "{linear: {x: 0.5}}"
    kit ros topic pub -r 10 /chatter std_msgs/msg/String "data: hello"
    """
    if once and times:
        exit_with_error("--once and --times contradict each other; give one of them")
    max_count = 1 if once else times
    cls = find_or_exit(find_message, type_name)
    content = parse_fields(values)
    make_message(cls, content, 0)
    try:
        node = client.create_node(node_name) if node_name else client.node
        publisher = node.create_publisher(
            cls, absolute_name(topic), qos_options.profile(QoSProfile(depth=10))
        )
    except NameValidationException as problem:
        exit_with_error(str(problem))
    min_subscriptions = matching if matching is not None else bool(max_count)
    if publisher.get_subscription_count() < min_subscriptions:
        click.echo(f"Waiting for at least {min_subscriptions:d} matching subscription(s)...")
        client.graph.wait(lambda: publisher.get_subscription_count() >= min_subscriptions)
    click.echo("publisher: beginning loop")
    count = 0

    def publish() -> None:
        nonlocal count
        count += 1
        message = make_message(cls, content, client.graph.now_ns)
        if every and count % every == 0:
            click.echo(f"publishing #{count}: {message!r}\n")
        publisher.publish(message)

    try:
        publish()
        if max_count != 1:
            node.create_timer(1 / rate, publish)
            client.spin(node, lambda: max_count and count >= max_count)
    except (NotFiniteError, ValueError) as problem:
        exit_with_error(str(problem))
