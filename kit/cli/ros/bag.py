"""``kit ros bag``: recordings that ROS 2's tools open."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kit.cli import bag_storage
from kit.cli.bag_storage import Storage
from kit.cli.lazy_group import HintingGroup
from kit.cli.options import ListOptionsCommand
from kit.cli.ros.world_client import exit_with_error, with_world_client
from kit.inspection.client import InspectionClient
from kit.msg.interfaces import UnknownInterface, find_message
from kit.plain_text import counted
from kit.ros.node.node import Node
from kit.ros.node.publisher import Publisher

if TYPE_CHECKING:
    from kit.ros.bags import Bag, BagRecorder


@click.group(cls=HintingGroup)
def command() -> None:
    """Record and play bags: messages of topics, with their simulated times."""


def topic_options(verb: str) -> Callable[[Any], Any]:
    """The options by which topics are chosen."""

    def add(function: Any) -> Any:
        for option in (
            click.option(
                "--topics", "chosen", multiple=True, metavar="TOPIC ...", help=f"{verb} only these topics."
            ),
            click.option("-e", "--regex", help=f"{verb} only topics that match this regular expression."),
            click.option(
                "-x",
                "--exclude-regex",
                "--exclude",
                "exclude_regex",
                help="Leave out topics that match this one.",
            ),
            click.option(
                "--exclude-topics", multiple=True, metavar="TOPIC ...", help="Leave out these topics."
            ),
        ):
            function = option(function)
        return function

    return add


def _filter(
    regex: str | None, exclude_regex: str | None, exclude_topics: Sequence[str]
) -> Callable[[str], bool]:
    """Makes the function that says which topics are wanted; exits if an expression is none."""
    try:
        wanted, unwanted = re.compile(regex or ""), re.compile(exclude_regex or r"(?!)")
    except re.error as problem:
        exit_with_error(f"not a regular expression: {problem}")
    left_out = {_absolute(name) for name in exclude_topics}
    return lambda name: (
        name not in left_out and wanted.search(name) is not None and unwanted.search(name) is None
    )


def _absolute(name: str) -> str:
    return name if name.startswith("/") else f"/{name}"


@command.command(cls=ListOptionsCommand)
@click.argument("topics", nargs=-1)
@click.option(
    "-a", "--all", "every", is_flag=True, help="Record all topics, including those that appear later."
)
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    help="New folder to write (default: rosbag2_ with date and time).",
)
@click.option(
    "--include-hidden-topics",
    "hidden",
    is_flag=True,
    help="With -a: include hidden topics, such as those of actions.",
)
@click.option("-n", "--node-name", default="", help="Name of the recording node.")
@topic_options("Record")
@bag_storage.storage
@with_world_client
def record(
    client: InspectionClient,
    topics: Sequence[str],
    every: bool,
    output: Path | None,
    hidden: bool,
    node_name: str,
    chosen: Sequence[str],
    regex: str | None,
    exclude_regex: str | None,
    exclude_topics: Sequence[str],
    storage: Storage,
) -> None:
    """Record topics of the running world, until Ctrl-C.

    \b
    kit ros bag record -a -o my_drive
    kit ros bag record /static_laser /cmd_vel
    kit ros bag record --all --exclude-topics /rosout /parameter_events
    """
    from kit.ros.bag_storage import BagError
    from kit.ros.bags import RECORDER, BagRecorder

    topics = (*topics, *chosen)
    if (every or regex is not None) == bool(topics):
        exit_with_error("Give the topics to record, or -a for all of them, or --regex.")
    admits = _filter(regex, exclude_regex, exclude_topics)
    bag_storage.explain_storage(storage)
    folder = output or Path(f"rosbag2_{datetime.now():%Y_%m_%d-%H_%M_%S}")
    names = [_absolute(name) for name in topics] or None
    node = client.create_node(node_name or RECORDER)
    log = node.get_logger().info
    known: set[str] = set()

    try:
        recorder = BagRecorder(
            client.graph, folder, topics=names, storage=storage, node=node, hidden=hidden, admits=admits
        )

        for notice in recorder.notices:
            log(notice)

        def has_stopped() -> bool:
            recorder.exchange()
            for name in sorted(set(recorder.topics) - known):
                log(f"Subscribed to topic '{name}'")
                known.add(name)
            return recorder.failure is not None

        with _closing_recorder(recorder, log, folder):
            has_stopped()
            for name in recorder.missing:
                log(f"No node publishes '{name}' yet; waiting for it")
            log("Recording... press Ctrl-C to stop")
            client.graph.wait(has_stopped)
    except BagError as problem:
        exit_with_error(str(problem))


@command.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("-v", "--verbose", is_flag=True, hidden=True)
def info(folder: Path, verbose: bool) -> None:
    """Print the summary of a bag. Needs no running world."""
    from kit.inspection.bag_text import bag_info

    click.echo(bag_info(_read_bag(folder)))


@command.command(cls=ListOptionsCommand)
@click.argument("folder", required=False, type=click.Path(path_type=Path))
@click.option(
    "-i", "--input", "given", type=click.Path(path_type=Path), help="The bag, in place of the argument."
)
@click.option(
    "-r",
    "--rate",
    type=click.FloatRange(0, min_open=True),
    default=1.0,
    show_default=True,
    help="Playback rate.",
)
@click.option("-l", "--loop", is_flag=True, help="Play in a loop.")
@click.option("-p", "--start-paused", is_flag=True, help="Start when Enter is pressed.")
@click.option(
    "-d", "--delay", type=click.FloatRange(0), default=0.0, help="How long to wait before it starts [s]."
)
@click.option(
    "--start-offset", type=click.FloatRange(0), default=0.0, help="How far into the bag to start [s]."
)
@click.option("--playback-duration", type=click.FloatRange(0), help="Play so much of the bag [s].")
@click.option("--playback-until-sec", type=float, help="Play messages up to this time of the bag [s].")
@topic_options("Play")
@click.option("-m", "--remap", multiple=True, metavar="FROM:=TO ...", help="Rename topics.")
@click.option("--clock", type=float, is_flag=False, flag_value=40.0, hidden=True)
@click.option("--disable-keyboard-controls", is_flag=True, hidden=True)
@click.option("--disable-loan-message", is_flag=True, hidden=True)
@with_world_client
def play(
    client: InspectionClient,
    folder: Path | None,
    given: Path | None,
    rate: float,
    loop: bool,
    start_paused: bool,
    delay: float,
    start_offset: float,
    playback_duration: float | None,
    playback_until_sec: float | None,
    chosen: Sequence[str],
    regex: str | None,
    exclude_regex: str | None,
    exclude_topics: Sequence[str],
    remap: Sequence[str],
    clock: float | None,
    disable_keyboard_controls: bool,
    disable_loan_message: bool,
) -> None:
    """Play a bag in the running world, with the same intervals of simulated time.

    \b
    kit ros bag play my_drive --topics /cmd_vel /odom
    kit ros bag play my_drive --start-offset 5 --exclude-topics /rosout
    """
    from kit.ros.bag_storage import BagError
    from kit.ros.bags import read_messages

    folder = folder or given
    if folder is None:
        exit_with_error("Give the bag to play: kit ros bag play FOLDER")
    bag, topics = _read_bag(folder), tuple(_absolute(name) for name in chosen)
    admits = _filter(regex, exclude_regex, exclude_topics)
    first_ns = bag.start_ns + int(start_offset * 1e9)
    last_ns = bag.start_ns + bag.duration_ns
    if playback_duration is not None:
        last_ns = min(last_ns, first_ns + int(playback_duration * 1e9))
    if playback_until_sec is not None:
        last_ns = min(last_ns, int(playback_until_sec * 1e9))
    names = dict(entry.split(":=", 1) for entry in remap if ":=" in entry)
    if len(names) != len(remap):
        exit_with_error("--remap needs FROM:=TO, such as --remap /cmd_vel:=/left/cmd_vel")
    if clock is not None:
        click.echo("--clock is ignored: the world has its own clock, which all its nodes use.", err=True)
    if loop and bag.duration_ns == 0:
        exit_with_error(f"{folder}: cannot be played in a loop: all its messages have the same time")
    node, graph = client.create_node("rosbag2_player"), client.graph
    log = node.get_logger().info
    publishers = _publishers(node, bag, topics, names, admits)
    if start_paused:
        click.pause("Press Enter to start.")
    log(f"Set rate to {rate:g}; {bag.count} messages over {bag.duration_ns / 1e9:.3f} s")

    for each in bag.topics:
        if each.name not in publishers and (not topics or each.name in topics) and admits(each.name):
            log(f"'{each.name}' is left out: the kit does not know its type, {each.type}")
    try:
        client.wait_for_tick()
        graph.wait(lambda: False, graph.now_ns + int(delay * 1e9))
        while True:
            began_ns = None
            for time_ns, topic, message in read_messages(folder, tuple(publishers)):
                if first_ns <= time_ns <= last_ns:
                    if began_ns is None:  # the bag is open: that took time in which no message was due
                        client.hold_time()
                        began_ns = graph.now_ns
                    graph.wait(lambda: False, began_ns + int((time_ns - first_ns) / rate))
                    publishers[topic].publish(message)
            if not loop:
                return
            began_ns = graph.now_ns if began_ns is None else began_ns
            graph.wait(lambda: False, began_ns + int((last_ns - first_ns) / rate))
    except BagError as problem:
        exit_with_error(str(problem))


@contextmanager
def _closing_recorder(recorder: BagRecorder, log: Callable[[str], object], folder: Path) -> Iterator[None]:
    """Closes a recorder at the end, and says how many messages are kept."""
    try:
        with recorder:
            yield
    finally:
        log(f"{counted(recorder.count, 'message')} in {folder}")


def _read_bag(folder: Path) -> Bag:
    """The summary of a bag, restored before if its recording was killed; ends the command where there is none."""
    from kit.ros.bag_storage import BagError, restore_bags
    from kit.ros.bags import read_bag

    try:
        if not folder.exists():
            for notice in restore_bags(folder.absolute().parent):
                click.echo(notice, err=True)
        return read_bag(folder)
    except BagError as problem:
        exit_with_error(str(problem))


def _publishers(
    node: Node, bag: Bag, topics: Sequence[str], names: dict[str, str], admits: Callable[[str], bool]
) -> dict[str, Publisher[Any]]:
    strange = sorted(set(topics) - {topic.name for topic in bag.topics})
    if strange:
        exit_with_error(
            f"{bag.folder}: it has no topic {', '.join(strange)}; its topics: {', '.join(t.name for t in bag.topics)}"
        )
    made = {}
    for topic in bag.topics:
        if (not topics or topic.name in topics) and admits(topic.name):
            try:
                cls = find_message(topic.type)
            except UnknownInterface:
                continue  # told by the caller
            made[topic.name] = node.create_publisher(cls, names.get(topic.name, topic.name), topic.qos)
    return made
