"""``kit ros topic``: the topics of the running world; prints and measures their messages, and publishes."""

from __future__ import annotations

import re
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

import click

from kit.cli.existing_path import ExistingPath
from kit.cli.lazy_group import HintingGroup
from kit.cli.ros.message_options import QosOptions, find_or_exit, make_message, parse_fields, with_qos_options
from kit.cli.ros.world_client import (
    exit_with_error,
    print_names,
    print_names_of,
    print_types_of,
    with_world_client,
)
from kit.host.codec import NotFiniteError
from kit.inspection.client import InspectionClient
from kit.inspection.graph_text import absolute_name, services, topic_info, topic_summary, topics
from kit.inspection.meters import BANDWIDTH_WINDOW, RATE_WINDOW, BandwidthMeter, DelayMeter, RateMeter
from kit.msg.interfaces import find_message, find_service, service_event_class
from kit.msg.message import Message
from kit.msg.message_text import (
    DEFAULT_MAX_LENGTH,
    MessageFormat,
    NoSuchField,
    get_field,
    to_csv,
    to_yaml,
)
from kit.ros.exceptions import NameValidationException
from kit.ros.node.qos import QoSProfile, qos_profile_services_default
from kit.ros.node.time import Time
from kit.ros.serialization import Serializer

REPORT_INTERVAL_S: Final = 1.0
"""Interval between two reports of a meter [s, simulated]."""


_EVENT_TYPES: Final = ("REQUEST_SENT", "REQUEST_RECEIVED", "RESPONSE_SENT", "RESPONSE_RECEIVED")
"""The names of ``event_type`` of service_msgs/msg/ServiceEventInfo."""


def window_option(default: int) -> Callable[..., Any]:
    """The option for the number of messages that a meter averages over."""
    return click.option(
        "-w",
        "--window",
        type=click.IntRange(1),
        default=default,
        show_default=True,
        help="Window size, in messages.",
    )


@click.command()
@click.argument("topic")
@click.argument("type_name", required=False, metavar="[TYPE]")
@click.option("--once", is_flag=True, help="Print one message and exit.")
@click.option("--field", metavar="NAME.NAME", help="Print only this field of each message.")
@click.option("--filter", "condition", metavar="PYTHON", help="Print only messages m for which this is true.")
@click.option("--csv", is_flag=True, help="Print comma-separated values, one message per line.")
@click.option("--no-arr", is_flag=True, help="Print only the type and length of arrays.")
@click.option("--no-str", is_flag=True, help="Print only the type and length of strings.")
@click.option("--flow-style", is_flag=True, help="Print each array on one line.")
@click.option("-f", "--full-length", is_flag=True, help="Do not truncate arrays and strings.")
@click.option(
    "-l",
    "--truncate-length",
    type=click.IntRange(0),
    default=DEFAULT_MAX_LENGTH,
    show_default=True,
    help="Length at which arrays and strings are truncated.",
)
@with_qos_options
@with_world_client
def echo(
    client: InspectionClient,
    topic: str,
    type_name: str | None,
    once: bool,
    field: str | None,
    condition: str | None,
    csv: bool,
    no_arr: bool,
    no_str: bool,
    flow_style: bool,
    full_length: bool,
    truncate_length: int,
    qos_options: QosOptions,
) -> None:
    """Print the messages of a topic, until Ctrl-C.

    \b
    kit ros topic echo /static_laser --no-arr
    kit ros topic echo /odom --field pose.pose.position
    kit ros topic echo /cmd_vel --filter "m.linear.x > 0.2"
    """
    admits = _message_filter(condition)
    message_format = MessageFormat(
        None if full_length else truncate_length, not no_arr, not no_str, flow_style
    )
    cls = _message_class(client, topic, type_name)
    count = 0

    def show(message: Message) -> None:
        nonlocal count
        if not admits(message):
            return
        count += 1
        found = message if field is None else get_field(message, field)
        if csv:
            click.echo(to_csv(found, message_format) if isinstance(found, Message) else found)
        elif isinstance(found, Message):
            click.echo(to_yaml(found, message_format) + "---")
        else:
            click.echo(f"{found}\n---")

    _subscribe(client, cls, topic, show, qos_options)
    try:
        client.spin(client.node, lambda: once and count)
    except NoSuchField as problem:
        exit_with_error(str(problem))


@click.command("echo")
@click.argument("service")
@click.argument("type_name", required=False, metavar="[TYPE]")
@click.option("--once", is_flag=True, help="Print one event and exit.")
@click.option("--no-arr", is_flag=True, help="Print only the type and length of arrays.")
@click.option("--no-str", is_flag=True, help="Print only the type and length of strings.")
@click.option("-f", "--full-length", is_flag=True, help="Do not truncate arrays and strings.")
@with_world_client
def echo_service(
    client: InspectionClient,
    service: str,
    type_name: str | None,
    once: bool,
    no_arr: bool,
    no_str: bool,
    full_length: bool,
) -> None:
    """Print the requests and responses of a service, until Ctrl-C.

    Its server or client must enable this with configure_introspection(), as in ROS 2 Iron and later.

    \b
    kit ros service echo /add_two_ints
    """
    name = absolute_name(service)
    if type_name is None:
        types = dict(services(client.graph, hidden=True)).get(name)
        if types is None:
            exit_with_error(f"Unknown service '{service}'")
        type_name = types[0]
    cls = service_event_class(find_or_exit(find_service, type_name))
    message_format = MessageFormat(None if full_length else DEFAULT_MAX_LENGTH, not no_arr, not no_str)
    count = 0

    def show(event: Any) -> None:
        nonlocal count
        count += 1
        number = event.info.event_type
        text = to_yaml(event, message_format)
        click.echo(text.replace(f"event_type: {number}", f"event_type: {_EVENT_TYPES[number]}", 1) + "---")

    topic = f"{name}/_service_event"
    client.node.create_subscription(cls, topic, show, qos_profile_services_default)
    client.spin(client.node, lambda: once and count)


@click.command()
@click.argument("topic")
@window_option(RATE_WINDOW)
@click.option("--wall-time", is_flag=True, help="Use this machine's clock instead of the world's.")
@with_qos_options
@with_world_client
def hz(client: InspectionClient, topic: str, window: int, wall_time: bool, qos_options: QosOptions) -> None:
    """Print the rate of a topic's messages once a second, until Ctrl-C.

    The rate is in simulated time: a 10 Hz laser shows 10 Hz even at ten times the speed.
    """
    meter = RateMeter(window)
    message_count = 0

    def count_message(_: Message) -> None:
        nonlocal message_count
        message_count += 1
        meter.add(time.monotonic_ns() if wall_time else client.graph.now_ns)

    def report() -> None:
        nonlocal message_count
        text = meter.text()
        if message_count and text is not None:
            click.echo(text)
        message_count = 0

    _subscribe(client, _message_class(client, topic, wait=True), topic, count_message, qos_options)
    client.node.create_timer(REPORT_INTERVAL_S, report)
    client.spin(client.node)


@click.command()
@click.argument("topic")
@window_option(BANDWIDTH_WINDOW)
@with_qos_options
@with_world_client
def bw(client: InspectionClient, topic: str, window: int, qos_options: QosOptions) -> None:
    """Print a topic's bandwidth once a second, until Ctrl-C."""
    meter, serializer = BandwidthMeter(window), Serializer()

    def count_message(message: Message) -> None:
        meter.add(client.graph.now_ns, len(serializer.serialize(message)))

    def report() -> None:
        text = meter.text(client.graph.now_ns)
        if text is not None:
            click.echo(text)

    _subscribe(client, _message_class(client, topic, wait=True), topic, count_message, qos_options)
    click.echo(f"Subscribed to [{topic}]")
    client.node.create_timer(REPORT_INTERVAL_S, report)
    client.spin(client.node)


@click.command()
@click.argument("topic")
@window_option(RATE_WINDOW)
@with_qos_options
@with_world_client
def delay(client: InspectionClient, topic: str, window: int, qos_options: QosOptions) -> None:
    """Print the age of a topic's messages once a second, until Ctrl-C. The age follows from the time in the header."""
    cls = _message_class(client, topic, wait=True)
    if "header" not in cls.get_fields_and_field_types():
        exit_with_error("msg does not have header")
    meter = DelayMeter(window)

    def count_message(message: Any) -> None:
        meter.add(client.graph.now_ns, Time.from_msg(message.header.stamp).nanoseconds)

    def report() -> None:
        text = meter.text()
        if text is not None:
            click.echo(text)

    _subscribe(client, cls, topic, count_message, qos_options)
    client.node.create_timer(REPORT_INTERVAL_S, report)
    client.spin(client.node)


def _message_class(
    client: InspectionClient, topic: str, type_name: str | None = None, *, wait: bool = False
) -> type[Message]:
    """The class of a topic's messages, or exits; ``wait``: as soon as anybody uses the topic."""
    if type_name is not None:
        return find_or_exit(find_message, type_name)
    known = client.graph.directory.topics
    name = absolute_name(topic)
    if name not in known:
        click.echo(f"WARNING: topic [{topic}] does not appear to be published yet", err=True)
        if not wait:
            exit_with_error("Could not determine the type for the passed topic")
        client.graph.wait(lambda: name in known)
    types = known[name].type_names
    if len(types) > 1:
        exit_with_error(
            f"Cannot echo topic '{topic}', as it contains more than one type: [{', '.join(types)}]"
        )
    return find_or_exit(find_message, types[0])


def _message_filter(condition: str | None) -> Callable[[Message], bool]:
    """Whether a message is to be shown; exits for an expression that is none, or fails."""
    if condition is None:
        return lambda message: True
    try:
        code = compile(condition, "--filter", "eval")
    except SyntaxError as problem:
        exit_with_error(f"--filter '{condition}' is not a Python expression: {problem.msg}")

    def admits(message: Message) -> bool:
        try:
            return bool(eval(code, {"m": message}))  # the user's own words, as in ROS 2
        except Exception as problem:  # noqa: BLE001 - whatever the user's expression raises
            exit_with_error(f"--filter '{condition}' fails: {type(problem).__name__}: {problem}")

    return admits


def _subscribe(
    client: InspectionClient,
    cls: type[Message],
    topic: str,
    callback: Callable[[Any], None],
    qos_options: QosOptions,
) -> None:
    name = absolute_name(topic)
    client.node.create_subscription(
        cls, name, callback, qos_options.profile(client.graph.directory.matching_qos(name))
    )


@click.group(cls=HintingGroup)
def command() -> None:
    """Inspect the topics of the running world, named channels for messages, and publish to them."""


@command.command("list")
@click.option("-t", "--show-types", is_flag=True, help="Show their types too.")
@click.option("-c", "--count-topics", "--count", "count", is_flag=True, help="Print only their number.")
@click.option("-a", "--all", "--include-hidden-topics", "hidden", is_flag=True, help="Include hidden topics.")
@click.option("-v", "--verbose", is_flag=True, help="Show the numbers of publishers and subscriptions too.")
@with_world_client
def list_topics(client: InspectionClient, show_types: bool, count: bool, hidden: bool, verbose: bool) -> None:
    """List the names of all topics."""
    found = topics(client.graph, hidden=hidden)
    if verbose and not count:
        for line in topic_summary(client.graph, found):
            click.echo(line)
    else:
        print_names(found, count=count, show_types=show_types)


@command.command()
@click.argument("name", metavar="TOPIC")
@click.option("-v", "--verbose", is_flag=True, help="Show the node and quality of service of each endpoint.")
@with_world_client
def info(client: InspectionClient, name: str, verbose: bool) -> None:
    """Print a topic's type and its numbers of publishers and subscriptions.

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
@click.option("-c", "--count-topics", "--count", "count", is_flag=True, help="Print only their number.")
@click.option("--include-hidden-topics", "hidden", is_flag=True, help="Include hidden topics.")
@with_world_client
def find(client: InspectionClient, type_name: str, count: bool, hidden: bool) -> None:
    """List the topics of a type."""
    print_names_of(type_name, topics(client.graph, hidden=hidden), count=count)


for verb in (
    echo,
    hz,
    bw,
    delay,
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
    help="Messages per second, in simulated time.",
)
@click.option("-1", "--once", is_flag=True, help="Publish one message and exit.")
@click.option("-t", "--times", type=click.IntRange(0), default=0, help="Publish this many messages and exit.")
@click.option(
    "-p", "--print", "every", type=click.IntRange(0), default=1, help="Print only every Nth message."
)
@click.option(
    "-w",
    "--wait-matching-subscriptions",
    "matching",
    type=click.IntRange(0),
    help="Start when there are this many subscribers (default: 1 with --once and --times).",
)
@click.option("-n", "--node-name", help="Name of the publishing node.")
@click.option(
    "--yaml-file",
    type=ExistingPath(dir_okay=False, path_type=Path),
    help="Read the messages from this file: one after the other, divided by ---.",
)
@click.option("--stdin", is_flag=True, help="Read the message from standard input.")
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
    yaml_file: Path | None,
    stdin: bool,
    qos_options: QosOptions,
) -> None:
    """Publish a message on a topic: repeatedly until Ctrl-C, or once.

    \b
    kit ros topic pub --once /cmd_vel geometry_msgs/msg/Twist "{linear: {x: 0.5}}"
    kit ros topic pub -r 10 /chatter std_msgs/msg/String "data: hello"
    """
    if once and times:
        exit_with_error("--once and --times cannot be combined; give one of them")
    max_count = 1 if once else times
    cls = find_or_exit(find_message, type_name)
    texts = [values]
    if yaml_file is not None:
        texts = [
            text for text in re.split(r"^---\s*$", yaml_file.read_text("utf-8"), flags=re.M) if text.strip()
        ]
    elif stdin:
        texts = [sys.stdin.read()]
    contents = [parse_fields(text) for text in texts]
    if not contents:
        exit_with_error(f"{yaml_file}: there is no message in it")
    for content in contents:
        make_message(cls, content, 0)
    if yaml_file is not None and not max_count:
        max_count = len(contents)  # each once, as `ros2 topic pub` does
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
        message = make_message(cls, contents[(count - 1) % len(contents)], client.graph.now_ns)
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
