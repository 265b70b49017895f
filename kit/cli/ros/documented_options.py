"""Options and commands of ROS 2's that the kit does not have: the help of each command names them."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

import click

ABSENT_OPTIONS: Final[Mapping[str, tuple[str, ...]]] = MappingProxyType(
    {
        "topic echo": ("--raw", "--message-info", "--no-lost-messages", "--clear"),
        "topic hz": ("--filter", "--all"),
        "topic pub": ("--keep-alive", "--max-wait-time-secs"),
        "service call": (
            "--qos-profile",
            "--qos-depth",
            "--qos-history",
            "--qos-reliability",
            "--qos-durability",
        ),
        "service echo": ("--csv", "--flow-style", "--qos-profile"),
        "param set": ("--atomic",),
        "param load": ("--no-use-wildcard",),
        "test": ("--verbose", "--disable-isolation"),
        "bag record": (
            "--max-bag-size",
            "--max-bag-duration",
            "--max-cache-size",
            "--compression-mode",
            "--compression-format",
            "--compression-queue-size",
            "--compression-threads",
            "--qos-profile-overrides-path",
            "--storage-config-file",
            "--storage-preset-profile",
            "--snapshot-mode",
            "--ignore-leaf-topics",
            "--polling-interval",
            "--no-discovery",
            "--services",
            "--all-services",
            "--all-topics",
            "--topic-types",
            "--include-unpublished-topics",
            "--start-paused",
        ),
        "bag play": (
            "--qos-profile-overrides-path",
            "--storage-config-file",
            "--clock-topics",
            "--clock-topics-all",
            "--read-ahead-queue-size",
            "--services",
            "--wait-for-all-acked",
            "--publish-service-requests",
            "--playback-until-nsec",
            "--storage",
        ),
        "bag info": ("--topic-name", "--sort", "--storage"),
        "pkg create": ("--package-format", "--library-name"),
        "run": ("--prefix",),
        "launch": ("--noninteractive", "--debug", "--print", "--launch-prefix", "--launch-prefix-filter"),
    }
)
"""The options, by command."""

ABSENT_COMMANDS: Final[Mapping[str, tuple[str, ...]]] = MappingProxyType(
    {"action": ("echo",), "bag": ("burst", "convert", "list", "reindex")}
)
"""Commands of ROS 2's that the kit's groups do not have."""


def tell_what_is_absent(name: str, command: click.Command) -> click.Command:
    """Adds to the help of a command of ``kit ros`` which of ROS 2's options and commands it does not have; returns the command."""
    if isinstance(command, click.Group):
        for part in list(command.commands):
            tell_what_is_absent(f"{name} {part}", command.commands[part])
        if name in ABSENT_COMMANDS:
            command.epilog = (
                f"Commands of `ros2 {name}` that are not here: {', '.join(ABSENT_COMMANDS[name])}."
            )
    elif name in ABSENT_OPTIONS:
        command.epilog = f"Options of `ros2 {name}` that are not here: {', '.join(ABSENT_OPTIONS[name])}."
    return command
