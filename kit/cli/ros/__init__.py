"""``kit ros``: ROS 2's commands, for the world that runs in another terminal."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import click

from kit.cli import LazyGroup, Verbs

VERBS: Final[Verbs] = {
    "node": ("kit.cli.ros.node", "Inspect nodes: list, info."),
    "topic": (
        "kit.cli.ros.topic",
        "Inspect topics and publish messages: list, info, type, find, echo, hz, bw, delay, pub.",
    ),
    "service": ("kit.cli.ros.service", "Inspect and call services: list, info, type, find, call, echo."),
    "action": ("kit.cli.ros.action", "Inspect actions and send goals: list, info, type, find, send_goal."),
    "lifecycle": ("kit.cli.ros.lifecycle", "Inspect and change lifecycle nodes: nodes, get, list, set."),
    "param": (
        "kit.cli.ros.param",
        "Read and change parameters: list, get, set, describe, dump, load, delete.",
    ),
    "interface": (
        "kit.cli.ros.interface",
        "Show message, service and action types: list, show, proto, package, packages.",
    ),
    "bag": ("kit.cli.ros.bag", "Record and play bags, which ROS 2's tools open: record, play, info."),
    "run": ("kit.cli.ros.run", "Run a package's program, or a Python file, in the running world."),
    "launch": ("kit.cli.launch", "Same as `kit launch`."),
    "pkg": ("kit.cli.launch:package_command", "Same as `kit pkg`."),
    "doctor": ("kit.cli.doctor", "Same as `kit doctor`."),
}

ABSENT: Final[Mapping[str, str]] = {
    "component": "launch files start the composable nodes of a container, each in its own process.",
    "daemon": "no daemon is needed; the running world knows all nodes.",
    "multicast": "the kit uses no network here; `kit bridge` connects to a robot.",
    "security": "the kit uses no network here; only your own user can connect to a world.",
    "wtf": "use `kit ros doctor`.",
}
"""Verbs of ROS 2's that are not here."""


@click.group(
    name="ros",
    cls=LazyGroup,
    verbs=VERBS,
    absent=ABSENT,
    epilog="A world runs while `kit play`, `kit launch` or `kit run --serve` runs. If several run, the newest is used, "
    "or the one given by --world. Times are simulated. Ctrl-C stops a command that keeps running.",
)
def command() -> None:
    """Inspect a running world from a second terminal, as `ros2` does on a robot.

    Commands, arguments and output are the same as with `ros2`.

    \b
    kit ros node list
    kit ros topic echo /static_laser --once
    kit ros topic pub --once /cmd_vel geometry_msgs/msg/Twist "{linear: {x: 0.5}}"
    kit ros service call /pause std_srvs/srv/Empty
    """
