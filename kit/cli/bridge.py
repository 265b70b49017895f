"""``kit bridge``: joins a running world to a robot on ROS 2's wire."""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import partial, wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click

from kit.cli import options

if TYPE_CHECKING:
    from kit.bridge.bridge import Bridge, BridgeSettings
    from kit.bridge.shutdown import ShutdownDeadline
    from kit.bridge.wire import RemoteEndpoint, Wire

STOP_KEY: Final = " "
RESUME_KEY: Final = "g"
NODE_NAME: Final = "kit_bridge"
DISCOVERY_S: Final = 1.0
"""How long `--list` waits for what the robot tells of itself."""


@click.group(name="bridge")
def command() -> None:
    """Join a running world to a robot: topics and services both ways, on ROS 2's wire.

    Nothing passes but what is listed. Commands that move a robot are limited in
    speed, a watchdog stops the robot when they stay away, and `kit bridge stop`,
    typed in any terminal, stops it at once.
    """


@command.command("stop")
@options.workspace
def stop(workspace: Path | None) -> None:
    """Tell every robot behind a running bridge to stand, at once.

    The bridges go on, but let no command pass until `g` is pressed in their own
    terminal. Exit code 1 where no bridge runs, or one does not answer.
    """
    from kit.bridge.bridge import stop_bridges

    answers = stop_bridges(options.open_existing_workspace(workspace).folder)
    for name, answer in answers:
        click.echo(f"{name}: stopped {answer}")
    if not answers:
        click.echo("No bridge is running in this workspace: nothing was stopped.", err=True)
    if not answers or any("does not answer" in answer for _, answer in answers):
        raise SystemExit(1)


@dataclass(frozen=True, slots=True)
class BridgeRequest:
    """What both verbs ask for."""

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

    @click.option("--send", multiple=True, metavar="TOPIC", help="Let this topic out, to the robot.")
    @click.option("--receive", multiple=True, metavar="TOPIC", help="Let this topic in, from the robot.")
    @click.option(
        "--max-speed",
        type=click.FloatRange(0),
        default=0.5,
        show_default=True,
        help="The fastest command that passes [m/s].",
    )
    @click.option(
        "--max-turn",
        type=click.FloatRange(0),
        default=1.5,
        show_default=True,
        help="The fastest turn that passes [rad/s].",
    )
    @click.option(
        "--watchdog",
        type=click.FloatRange(0.05, 10),
        default=0.5,
        show_default=True,
        help="Stop a robot whose commands stay away for so long [s].",
    )
    @click.option(
        "--distro",
        type=click.Choice(("humble", "jazzy")),
        default="jazzy",
        show_default=True,
        help="The robot's ROS 2: jazzy for all that are newer, too.",
    )
    @click.option("--dry-run", is_flag=True, help="Show what would be sent; connect to no robot.")
    @click.option("--list", "listed", is_flag=True, help="List what the robot has, and end.")
    @click.option(
        "--every",
        type=click.FloatRange(0.1),
        default=2.0,
        show_default=True,
        help="Print the rates so often [s].",
    )
    @click.option("--world", metavar="NAME", envvar="KIT_WORLD", help="Which world, if several run.")
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
        from kit.bridge.bridge import BridgeSettings
        from kit.bridge.motion_guard import SpeedLimit
        from kit.bridge.wire import BridgeError, BridgeRoute, Direction

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
            options.fail(str(problem))

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
    help="The robot's router; by default tcp/localhost:7447. May be given more than once.",
)
@click.option(
    "--listen",
    multiple=True,
    metavar="ENDPOINT",
    help="Be the router instead, tcp/0.0.0.0:7447, for robots that connect here.",
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
    """Join the running world to a robot whose ROS 2 speaks rmw_zenoh.

    On the robot: RMW_IMPLEMENTATION=rmw_zenoh_cpp, and one
    `ros2 run rmw_zenoh_cpp rmw_zenohd`.

    \b
    kit bridge zenoh --connect tcp/192.168.1.7:7447 --list
    kit bridge zenoh --connect tcp/192.168.1.7:7447 --dry-run \\
        --send /cmd_vel --receive /scan:=/robot/scan
    the same without --dry-run

    NAME:=ROBOT_NAME gives a topic or service another name on the robot. Times in
    headers stay those of their sender.

    Twist, TwistStamped and the two Ackermann types are known to move robots:
    they are slowed down to the limits, and stopped by the watchdog, on their way
    out as on their way in. So a command sent once moves a robot for the
    watchdog's time only: send it again and again, as teleop nodes do. Other
    types pass as they are.

    Space stops every robot, `g` lets commands pass again, Ctrl-C stops and ends,
    a second Ctrl-C at once; `kit bridge stop` stops from any terminal. What has
    not ended after 10 s is named, and the process ended with exit code 3. Where
    the line itself is cut, nothing that is said here reaches the robot any more:
    one that runs the kit's bridge stands within its watchdog's time, and any
    other needs a time limit in its own base, or a person beside its switch.

    There is no password: whoever reaches the router can send to it. Use a network
    of your own, or an SSH tunnel.

    Proved against zenoh-ros2-sdk, an independent implementation of the same
    wire, and between two kits, both on one machine. Not proved: a real rmw_zenoh,
    and a real robot. Begin with its wheels off the ground.
    """
    from kit.bridge.zenoh_wire import DEFAULT_ENDPOINT, ZenohAddress, ZenohWire

    if connect and listen:
        raise click.UsageError("--connect and --listen contradict each other: give one of them.")
    address = ZenohAddress(connect or (DEFAULT_ENDPOINT,), listen, domain)
    verb = "listening at" if listen else "by the router at"
    where = f"{verb} {', '.join(address.listen or address.connect)}, domain {domain}"
    _run(request, where, lambda: ZenohWire(address, f"/{NODE_NAME}"))


@command.command("dds")
@domain_option
@click.option(
    "--interface",
    metavar="NAME|ADDRESS",
    help="The network interface; by default Cyclone's choice, or $CYCLONEDDS_URI's.",
)
@click.option(
    "--peer",
    multiple=True,
    metavar="ADDRESS",
    help="Look for the robot there; where multicast does not reach it.",
)
@with_bridge_options
def dds(request: BridgeRequest, domain: int, interface: str | None, peer: tuple[str, ...]) -> None:
    """Join the running world to a robot whose ROS 2 speaks DDS: topics only.

    For robots that cannot change to rmw_zenoh: what `kit bridge zenoh --help` says
    of names, limits, the watchdog and stopping holds here too. Services do not
    pass: each DDS middleware of ROS 2 has its own way.

    \b
    kit bridge dds --domain 7 --list
    kit bridge dds --domain 7 --send /cmd_vel --receive /scan

    There is no password: whoever is in the domain can send to it. Use a network
    of your own.

    Proved against cyclonedds with types written by hand, on one machine. Not
    proved: a real rmw_cyclonedds or rmw_fastrtps, and a real robot. Begin with
    its wheels off the ground.
    """
    from kit.bridge.dds_wire import DdsAddress, DdsWire

    address = DdsAddress(domain, interface, peer)
    _run(request, f"by DDS in domain {domain}", lambda: DdsWire(address))


def _run(request: BridgeRequest, where: str, open_wire: Callable[[], Wire]) -> None:
    from kit.bridge.bridge import Bridge, StopSocket
    from kit.bridge.shutdown import ShutdownDeadline
    from kit.bridge.wire import DryRunWire
    from kit.cli.ros.world_client import connect_to_world

    with ShutdownDeadline(partial(click.echo, err=True)) as deadline:
        if request.is_listing:
            _list_endpoints(open_wire)
            return
        settings = request.settings()
        folder = options.open_existing_workspace(request.workspace).folder
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
                opened.enter_context(_keys(bridge, deadline))
                opened.enter_context(_status_printer(bridge, request.every))
                opened.callback(deadline.begin)  # first of all: whatever takes long or hangs comes after it
                client.spin(node)


def _list_endpoints(open_wire: Callable[[], Wire]) -> None:
    wire = open_wire()
    try:
        time.sleep(DISCOVERY_S)
        lines = describe_endpoints(wire.endpoints())
    finally:
        wire.close()
    click.echo("\n".join(lines) or "Connected; nobody in this domain has told of anything.")


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
    keys = "Space stops the robot, g goes on, Ctrl-C stops and ends; or `kit bridge stop`."
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
def _keys(bridge: Bridge, deadline: ShutdownDeadline) -> Iterator[None]:
    """Lets keys stop the robot and go on, where there is a terminal."""
    if not sys.stdin.isatty():
        yield
        return
    import termios
    import tty

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
            click.echo(f"STOPPED: {', '.join(bridge.stop()) or 'nothing moves yet'}. g goes on.")
        elif key == RESUME_KEY:
            bridge.resume()
            click.echo("Commands pass again.")
