"""``kit ros bag``: recordings that ROS 2's tools open."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from kit.cli import options
from kit.cli.options import Storage
from kit.cli.ros.world_client import exit_with_error, with_world_client
from kit.inspection.client import InspectionClient
from kit.msg.interfaces import UnknownInterface, find_message
from kit.ros.node.node import Node
from kit.ros.node.publisher import Publisher

if TYPE_CHECKING:
    from kit.ros.bags import Bag, BagRecorder


@click.group()
def command() -> None:
    """Record and play bags: messages of topics, with their simulated times."""


@command.command()
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
@options.storage
@with_world_client
def record(
    client: InspectionClient,
    topics: Sequence[str],
    every: bool,
    output: Path | None,
    hidden: bool,
    storage: Storage,
) -> None:
    """Record topics of the running world, until Ctrl-C.

    \b
    kit ros bag record -a -o my_drive
    kit ros bag record /static_laser /cmd_vel
    """
    from kit.ros.bag_storage import BagError
    from kit.ros.bags import RECORDER, BagRecorder

    if every == bool(topics):
        exit_with_error("Give the topics to record, or -a for all of them.")
    options.explain_storage(storage)
    folder = output or Path(f"rosbag2_{datetime.now():%Y_%m_%d-%H_%M_%S}")
    chosen = None if every else [name if name.startswith("/") else f"/{name}" for name in topics]
    node = client.create_node(RECORDER)
    log = node.get_logger().info
    known: set[str] = set()

    try:
        recorder = BagRecorder(client.graph, folder, topics=chosen, storage=storage, node=node, hidden=hidden)

        for notice in recorder.notices:
            log(notice)

        def has_stopped() -> bool:
            recorder.exchange()
            for name in sorted(set(recorder.topics) - known):
                log(f"Subscribed to topic '{name}'")
                known.add(name)
            return recorder.failure is not None

        with _told(recorder, log, folder):
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
    from kit.inspection.ros_text import bag_info

    click.echo(bag_info(_read(folder)))


@command.command()
@click.argument("folder", type=click.Path(path_type=Path))
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
@click.option("--topics", multiple=True, help="Play only this topic; repeat for more.")
@click.option("-m", "--remap", multiple=True, metavar="FROM:=TO", help="Rename a topic.")
@click.option("--clock", type=float, is_flag=False, flag_value=40.0, hidden=True)
@with_world_client
def play(
    client: InspectionClient,
    folder: Path,
    rate: float,
    loop: bool,
    start_paused: bool,
    topics: Sequence[str],
    remap: Sequence[str],
    clock: float | None,
) -> None:
    """Play a bag in the running world, with the same intervals of simulated time.

    \b
    kit ros bag play my_drive --topics /cmd_vel
    """
    from kit.ros.bag_storage import BagError
    from kit.ros.bags import read_messages

    bag = _read(folder)
    names = dict(entry.split(":=", 1) for entry in remap if ":=" in entry)
    if len(names) != len(remap):
        exit_with_error("--remap needs FROM:=TO, such as --remap /cmd_vel:=/left/cmd_vel")
    if clock is not None:
        click.echo("--clock is ignored: the world has its own clock, which all its nodes use.", err=True)
    if loop and bag.duration_ns == 0:
        exit_with_error(f"{folder}: cannot be played in a loop: all its messages have the same time")
    node, graph = client.create_node("rosbag2_player"), client.graph
    log = node.get_logger().info
    publishers = _publishers(node, bag, topics, names)
    if start_paused:
        click.pause("Press Enter to start.")
    log(f"Set rate to {rate:g}; {bag.count} messages over {bag.duration_ns / 1e9:.3f} s")

    for each in bag.topics:
        if each.name not in publishers and (not topics or each.name in topics):
            log(f"'{each.name}' is left out: the kit does not know its type, {each.type}")
    try:
        while True:
            client.wait_for_tick()
            began_ns = graph.now_ns
            for time_ns, topic, message in read_messages(folder, tuple(publishers)):
                graph.wait(lambda: False, began_ns + int((time_ns - bag.start_ns) / rate))
                publishers[topic].publish(message)
            if not loop:
                return
            graph.wait(lambda: False, began_ns + int(bag.duration_ns / rate))
    except BagError as problem:
        exit_with_error(str(problem))


@contextmanager
def _told(recorder: BagRecorder, log: Callable[[str], object], folder: Path) -> Iterator[None]:
    """Closes a recorder at the end, and says how many messages are kept."""
    try:
        with recorder:
            yield
    finally:
        log(f"{recorder.count} messages in {folder}")


def _read(folder: Path) -> Bag:
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
    node: Node, bag: Bag, topics: Sequence[str], names: dict[str, str]
) -> dict[str, Publisher[Any]]:
    strange = sorted(set(topics) - {topic.name for topic in bag.topics})
    if strange:
        exit_with_error(
            f"{bag.folder}: it has no topic {', '.join(strange)}; its topics: {', '.join(t.name for t in bag.topics)}"
        )
    made = {}
    for topic in bag.topics:
        if not topics or topic.name in topics:
            try:
                cls = find_message(topic.type)
            except UnknownInterface:
                continue  # told by the caller
            made[topic.name] = node.create_publisher(cls, names.get(topic.name, topic.name), topic.qos)
    return made
