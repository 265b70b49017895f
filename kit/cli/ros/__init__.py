"""``kit ros``: ROS 2's commands, for the world that runs in another terminal."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import click

from kit.cli.lazy_group import LazyGroup, Verbs
from kit.cli.plain_flag import PLAIN_OPTION
from kit.cli.ros.documented_options import tell_what_is_absent

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
    "launch_test": (
        "kit.cli.ros.launch_test",
        "Run a test for launch_testing: its launch, its tests, and those after the end.",
    ),
    "test": ("kit.cli.ros.launch_test", "Same as `kit ros launch_test`."),
    "pkg": ("kit.cli.launch:package_command", "As `kit pkg`; `create` creates in the current folder."),
    "doctor": ("kit.cli.ros.doctor", "Check the running world, packages and this shell; report on them."),
    "wtf": ("kit.cli.ros.doctor", "Same as `kit ros doctor`."),
}

ABSENT: Final[Mapping[str, str]] = {
    "component": "launch files start the composable nodes of a container, each in its own process.",
    "daemon": "no daemon is needed; the running world knows all nodes.",
    "multicast": "the kit uses no network here; `kit bridge` connects to a robot.",
    "security": "the kit uses no network here; only your own user can connect to a world.",
}
"""Verbs of ROS 2's that are not here."""


class RosGroup(LazyGroup):
    """The group of ROS 2's commands: their help tells which options they do not have."""

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        command = super().get_command(ctx, cmd_name)
        return command and tell_what_is_absent(cmd_name, command)


@click.group(
    name="ros",
    cls=RosGroup,
    everywhere=(PLAIN_OPTION,),
    verbs=VERBS,
    absent=ABSENT,
    epilog="A world runs while `kit drive`, `kit launch` or `kit run --serve` runs. If several run, the newest is used, "
    "or the one given by --world. Times are simulated. Ctrl-C stops a command that keeps running. A command takes effect when it "
    "arrives, at no certain instant of simulated time: one that is to come at the same instant in every run belongs in a launch "
    f"file, in a TimerAction. Commands of `ros2` that are not here: {', '.join(ABSENT)}.",
)
def command() -> None:
    """Inspect a running world from a second terminal, as `ros2` does on a robot.

    Commands, arguments and output are those of `ros2`. The help of each command names what `ros2` has besides.

    \b
    kit ros node list
    kit ros topic echo /static_laser --once
    kit ros topic pub --once /cmd_vel geometry_msgs/msg/Twist "{linear: {x: 0.5}}"
    kit ros service call /pause std_srvs/srv/Empty
    """
