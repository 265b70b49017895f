"""``kit bridge``: joins a running world to a robot on ROS 2's wire."""

from __future__ import annotations

import os
import sys
import termios
import threading
import time
import tty
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import partial, wraps
from pathlib import Path
from typing import Any, Final

import click

from kit.bridge.bridge import Bridge, BridgeSettings, StopSocket, stop_bridges
from kit.bridge.dds_wire import DdsAddress, DdsWire
from kit.bridge.motion_guard import SpeedLimit
from kit.bridge.shutdown import ShutdownDeadline
from kit.bridge.wire import BridgeError, BridgeRoute, Direction, DryRunWire, RemoteEndpoint, Wire
from kit.bridge.zenoh_wire import DEFAULT_ENDPOINT, ZenohAddress, ZenohWire
from kit.cli import messages, opening, options
from kit.cli.lazy_group import HintingGroup
from kit.cli.ros.world_client import connect_to_world
from kit.plain_text import escape_controls

STOP_KEY: Final = " "
RESUME_KEY: Final = "g"
NODE_NAME: Final = "kit_bridge"
DISCOVERY_S: Final = 1.0
"""How long `--list` waits for what the robot tells of itself."""


@click.group(cls=HintingGroup, name="bridge")
def command() -> None:
    """Connect a running world to a ROS 2 robot: topics and services, both ways.

    Only the topics and services that you list pass. The speed of commands that
    move a robot is limited, a watchdog stops the robot when commands stop coming,
    and `kit bridge stop` in any terminal stops it at once.
    """


@command.command("stop")
@options.workspace
def stop(workspace: Path | None) -> None:
    """Stop every robot behind a running bridge at once.

    The bridges keep running, but pass no command until `g` is pressed in their
    own terminal.

    Exit code: 0 all bridges stopped; 1 no bridge runs, or one does not answer.
    """
    answers = stop_bridges(opening.open_existing_workspace(workspace).folder)
    for name, answer in answers:
        click.echo(f"{name}: stopped {answer}")
    if not answers:
        click.echo("No bridge is running in this workspace: nothing was stopped.", err=True)
    if not answers or any("does not answer" in answer for _, answer in answers):
        raise SystemExit(1)


@dataclass(frozen=True, slots=True)
class BridgeRequest:
    """The options that both verbs have."""

    settings: Callable[[], BridgeSettings]
    """Raises BridgeError for routes that do not fit together."""
    is_dry: bool
    is_listing: bool
    every: float
    """Seconds between two prints of the rates."""
    world: str | None
    workspace: Path | None


def with_bridge_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """Decorator: adds the options that say what passes and how, and passes them on as one BridgeRequest."""

    @click.option("--send", multiple=True, metavar="TOPIC", help="Send this topic to the robot.")
    @click.option("--receive", multiple=True, metavar="TOPIC", help="Receive this topic from the robot.")
    @click.option(
        "--max-speed",
        type=click.FloatRange(0),
        default=0.5,
        show_default=True,
        help="Speed limit for commands [m/s].",
    )
    @click.option(
        "--max-turn",
        type=click.FloatRange(0),
        default=1.5,
        show_default=True,
        help="Turn rate limit for commands [rad/s].",
    )
    @click.option(
        "--watchdog",
        type=click.FloatRange(0.05, 10),
        default=0.5,
        show_default=True,
        help="Stop the robot after this long without a command [s].",
    )
    @click.option(
        "--distro",
        type=click.Choice(("humble", "jazzy")),
        default="jazzy",
        show_default=True,
        help="The robot's ROS 2; use jazzy for newer ones too.",
    )
    @click.option("--dry-run", is_flag=True, help="Show what would be sent without connecting to a robot.")
    @click.option("--list", "listed", is_flag=True, help="List the robot's topics and services, and exit.")
    @click.option(
        "--every",
        type=click.FloatRange(0.1),
        default=2.0,
        show_default=True,
        help="Interval between printed rates [s].",
    )
    @click.option("--world", metavar="NAME", envvar="KIT_WORLD", help="World to use, if several run.")
    @options.workspace
    @wraps(function)
    def verb(
        *,
        send: tuple[str, ...],
        receive: tuple[str, ...],
        serve: tuple[str, ...] = (),
        call: tuple[str, ...] = (),
        max_speed: float,
        max_turn: float,
        watchdog: float,
        distro: Any,
        dry_run: bool,
        listed: bool,
        every: float,
        world: str | None,
        workspace: Path | None,
        **rest: Any,
    ) -> None:
        asked = {
            Direction.SEND: send,
            Direction.RECEIVE: receive,
            Direction.SERVE: serve,
            Direction.CALL: call,
        }

        def settings() -> BridgeSettings:
            routes = (
                BridgeRoute.parse(direction, text) for direction, texts in asked.items() for text in texts
            )
            limit = SpeedLimit(max_speed, max_turn)
            return BridgeSettings(tuple(routes), limit, watchdog, distro, is_dry=dry_run)

        try:
            function(BridgeRequest(settings, dry_run, listed, every, world, workspace), **rest)
        except BridgeError as problem:
            messages.fail(str(problem))

    return verb


domain_option = click.option(
    "--domain",
    type=click.IntRange(0, 232),
    envvar="ROS_DOMAIN_ID",
    default=0,
    show_default=True,
    help="The robot's ROS_DOMAIN_ID.",
)


@command.command("zenoh")
@click.option(
    "--connect",
    multiple=True,
    metavar="ENDPOINT",
    help="The robot's router (default: tcp/localhost:7447); repeat for more.",
)
@click.option(
    "--listen",
    multiple=True,
    metavar="ENDPOINT",
    help="Act as the router instead, at tcp/0.0.0.0:7447, for robots that connect here.",
)
@domain_option
@click.option(
    "--serve", multiple=True, metavar="SERVICE", help="Offer this service of the world to the robot."
)
@click.option(
    "--call", multiple=True, metavar="SERVICE", help="Offer this service of the robot in the world."
)
@with_bridge_options
def zenoh(request: BridgeRequest, connect: tuple[str, ...], listen: tuple[str, ...], domain: int) -> None:
    """Connect the running world to a robot whose ROS 2 uses rmw_zenoh.

    On the robot, set RMW_IMPLEMENTATION=rmw_zenoh_cpp and start one
    `ros2 run rmw_zenoh_cpp rmw_zenohd`.

    \b
    kit bridge zenoh --connect tcp/192.168.1.7:7447 --list
    kit bridge zenoh --connect tcp/192.168.1.7:7447 --dry-run \\
        --send /cmd_vel --receive /scan:=/robot/scan
    then the same without --dry-run

    NAME:=ROBOT_NAME gives a topic or service another name on the robot. Header
    times are not changed.

    Twist, TwistStamped and the two Ackermann types move robots: in both
    directions, they are slowed down to the limits and stopped by the watchdog. A
    command sent once therefore moves a robot only for the watchdog's time; send
    it repeatedly, as teleop nodes do. Other types pass unchanged.

    Space stops every robot, `g` lets commands pass again, Ctrl-C stops the robots
    and exits, a second Ctrl-C exits at once; `kit bridge stop` stops them from any
    terminal. If something has not shut down after 10 s, the bridge names it and
    exits with code 3. If the connection fails, no stop command reaches the robot:
    a robot that runs the kit's bridge stops within its watchdog's time; any other
    needs a timeout in its own base, or a person at its emergency stop.

    There is no password: anyone who reaches the router can send commands to it.
    Use a private network or an SSH tunnel.

    Tested with zenoh-ros2-sdk, an independent implementation of the same protocol,
    and between two kits, both on one machine. Not tested with a real rmw_zenoh or
    a real robot. Start with its wheels off the ground.
    """
    if connect and listen:
        raise click.UsageError("--connect and --listen cannot be combined; give one of them.")
    address = ZenohAddress(connect or (DEFAULT_ENDPOINT,), listen, domain)
    verb = "listening at" if listen else "by the router at"
    where = f"{verb} {', '.join(address.listen or address.connect)}, domain {domain}"
    _run_bridge(request, where, lambda: ZenohWire(address, f"/{NODE_NAME}"))


@command.command("dds")
@domain_option
@click.option(
    "--interface",
    metavar="NAME|ADDRESS",
    help="Network interface (default: $CYCLONEDDS_URI's, else Cyclone's choice).",
)
@click.option(
    "--peer",
    multiple=True,
    metavar="ADDRESS",
    help="Look for the robot at this address, if multicast does not reach it.",
)
@with_bridge_options
def dds(request: BridgeRequest, domain: int, interface: str | None, peer: tuple[str, ...]) -> None:
    """Connect the running world to a robot whose ROS 2 uses DDS. Only topics pass.

    Use this for robots that cannot change to rmw_zenoh. Names, limits, the
    watchdog and stopping work as in `kit bridge zenoh --help`. Services do not
    pass, because each DDS middleware of ROS 2 implements them differently.

    \b
    kit bridge dds --domain 7 --list
    kit bridge dds --domain 7 --send /cmd_vel --receive /scan

    There is no password: anyone in the domain can send commands to it. Use a
    private network.

    Tested with cyclonedds and types written by hand, on one machine. Not tested
    with a real rmw_cyclonedds or rmw_fastrtps, or a real robot. Start with its
    wheels off the ground.
    """
    address = DdsAddress(domain, interface, peer)
    _run_bridge(request, f"by DDS in domain {domain}", lambda: DdsWire(address))


def _run_bridge(request: BridgeRequest, where: str, open_wire: Callable[[], Wire]) -> None:
    with ShutdownDeadline(partial(click.echo, err=True)) as deadline:
        if request.is_listing:
            _list_endpoints(open_wire)
            return
        settings = request.settings()
        folder = opening.open_existing_workspace(request.workspace).folder
        with connect_to_world(request.world, request.workspace) as client:
            for line in _describe_plan(settings, where, client.world):
                click.echo(line)
            node = client.create_node(NODE_NAME)
            with ExitStack() as opened:
                wire = DryRunWire() if settings.is_dry else open_wire()
                opened.callback(wire.close)  # by the bridge already, once there is one
                bridge = opened.enter_context(Bridge(node, wire, settings, click.echo))
                deadline.at_begin(bridge.stop)
                opened.enter_context(StopSocket(bridge, folder, client.world, click.echo))
                opened.enter_context(_stop_keys(bridge, deadline))
                opened.enter_context(_status_printer(bridge, request.every))
                opened.callback(deadline.begin)  # first of all: whatever takes long or hangs comes after it
                client.spin(node)


def _list_endpoints(open_wire: Callable[[], Wire]) -> None:
    wire = open_wire()
    try:
        time.sleep(DISCOVERY_S)
        lines = map(escape_controls, describe_endpoints(wire.endpoints()))
    finally:
        wire.close()
    click.echo("\n".join(lines) or "Connected; no topics or services were found in this domain.")


def describe_endpoints(endpoints: tuple[RemoteEndpoint, ...]) -> list[str]:
    """Lines that list what a robot has: each topic and service once, with its type and who has it."""
    roles: dict[tuple[str, str], set[str]] = {}
    for endpoint in endpoints:
        roles.setdefault((endpoint.name, endpoint.type_name), set()).add(endpoint.role)
    return [f"{name}  {kind}  {', '.join(sorted(having))}" for (name, kind), having in sorted(roles.items())]


def _describe_plan(settings: BridgeSettings, where: str, world: str) -> list[str]:
    """Says what will pass, before anything does."""
    head = f"{world} and a robot, {where}. Only this passes:"
    if settings.is_dry:
        head = (
            f"Dry run: nothing is connected or sent. Between {world} and a robot, {where}, this would pass:"
        )
    keys = "Space stops the robot, g resumes, Ctrl-C stops it and exits; `kit bridge stop` stops it too."
    return [head, *(f"  {route}" for route in settings.routes), keys]


@contextmanager
def _status_printer(bridge: Bridge, every: float) -> Iterator[None]:
    """Prints the rates now and then, in a thread of its own: a paused world must not silence it."""
    has_ended = threading.Event()

    def run() -> None:
        while not has_ended.wait(every):
            click.echo("\n".join(bridge.status_lines()))

    printer = threading.Thread(target=run, name="bridge-status", daemon=True)
    printer.start()
    try:
        yield
    finally:
        has_ended.set()
        printer.join(every)


@contextmanager
def _stop_keys(bridge: Bridge, deadline: ShutdownDeadline) -> Iterator[None]:
    """Lets keys stop the robot and go on, where there is a terminal."""
    if not sys.stdin.isatty():
        yield
        return
    descriptor = sys.stdin.fileno()
    before = termios.tcgetattr(descriptor)

    def restore() -> None:
        termios.tcsetattr(descriptor, termios.TCSANOW, before)  # does not wait for output that has stopped

    deadline.before_exit(restore)
    tty.setcbreak(descriptor)
    threading.Thread(target=_read_keys, args=(descriptor, bridge), name="bridge-keys", daemon=True).start()
    try:
        yield
    finally:
        restore()


def _read_keys(descriptor: int, bridge: Bridge) -> None:
    while key := os.read(descriptor, 1).decode(errors="replace"):
        if key == STOP_KEY:
            click.echo(f"STOPPED: {', '.join(bridge.stop()) or 'nothing moves yet'}. Press g to resume.")
        elif key == RESUME_KEY:
            bridge.resume()
            click.echo("Commands pass again.")
