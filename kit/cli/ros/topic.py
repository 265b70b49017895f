"""``kit ros topic``: the topics of the running world.

``kit ros topic pub``: publishes a message on a topic.
"""

from __future__ import annotations

import click

from kit.cli.ros import topic_subscribers
from kit.cli.ros.message_options import QosOptions, find_or_exit, make_message, parse_fields, with_qos_options
from kit.cli.ros.world_client import exit_with_error, print_names_of, print_types_of, with_world_client
from kit.host.codec import NotFiniteError
from kit.inspection.client import InspectionClient
from kit.inspection.ros_text import absolute_name, topic_info, topic_summary, topics
from kit.msg.interfaces import find_message
from kit.ros.exceptions import NameValidationException
from kit.ros.node.qos import QoSProfile


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
):
    command.add_command(verb)


@command.command()
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
