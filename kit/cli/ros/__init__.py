"""``kit ros``: ROS 2's commands, for the world that runs in another terminal."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import click

from kit.cli import LazyGroup, Verbs

VERBS: Final[Verbs] = {
    "node": ("kit.cli.ros.node", "The nodes of the world: list, info."),
    "topic": (
        "kit.cli.ros.topic",
        "Topics and their messages: list, info, type, find, echo, hz, bw, delay, pub.",
    ),
    "service": ("kit.cli.ros.service", "Services and their calls: list, info, type, find, call, echo."),
    "action": ("kit.cli.ros.action", "Actions and their goals: list, info, type, find, send_goal."),
    "lifecycle": ("kit.cli.ros.lifecycle", "Lifecycle nodes and their states: nodes, get, list, set."),
    "param": ("kit.cli.ros.param", "Parameters of nodes: list, get, set, describe, dump, load, delete."),
    "interface": (
        "kit.cli.ros.interface",
        "Types of messages and services: list, show, proto, package, packages.",
    ),
    "bag": ("kit.cli.ros.bag", "Recordings that ROS 2's tools open: record, play, info."),
    "run": ("kit.cli.ros.run", "Run a package's program, or a Python file, beside the running world."),
    "launch": ("kit.cli.launch", "The same as `kit launch`."),
    "pkg": ("kit.cli.launch:package_command", "The same as `kit pkg`."),
    "doctor": ("kit.cli.doctor", "The same as `kit doctor`."),
}

ABSENT: Final[Mapping[str, str]] = {
    "component": "a launch file starts the composable nodes of a container, each in a process of its own.",
    "daemon": "the world itself knows all nodes, and the verbs ask it.",
    "multicast": "nothing here goes over a network; `kit bridge` joins a robot.",
    "security": "nothing here goes over a network; only your own user can connect to a world.",
    "wtf": "it is called `kit ros doctor` here.",
}
"""Verbs of ROS 2's that are not here."""


@click.group(
    name="ros",
    cls=LazyGroup,
    verbs=VERBS,
    absent=ABSENT,
    epilog="A world runs while `kit play`, `kit launch` or `kit run --serve` does. With several, the newest is used, "
    "or the one named by --world. Times are simulated. Ctrl-C ends a command that keeps running.",
)
def command() -> None:
    """Look into a running world from a second terminal, as `ros2` does on a robot.

    The words after `kit ros` are those after `ros2`, and so is what they print.

    \b
    kit ros node list
    kit ros topic echo /static_laser --once
    kit ros topic pub --once /cmd_vel geometry_msgs/msg/Twist "{linear: {x: 0.5}}"
    kit ros service call /pause std_srvs/srv/Empty
    """
