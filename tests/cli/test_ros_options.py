"""``kit ros`` has ROS 2's documented options, or its help names those that it has not."""

from __future__ import annotations

import csv
from collections import defaultdict
from importlib import import_module
from pathlib import Path

import click
from click.testing import CliRunner

from kit.cli import main
from kit.cli.ros import ABSENT, VERBS
from kit.cli.ros.documented_options import ABSENT_COMMANDS, ABSENT_OPTIONS
from tests.cases import every_case

TABLE = Path(__file__).with_name("ros2_options.csv")
"""The options that `ros2 COMMAND --help` documents."""

COMMANDS = {
    "action": "echo find info list send_goal type",
    "bag": "burst convert info list play record reindex",
    "component": "",
    "daemon": "",
    "doctor": "",
    "interface": "list package packages proto show",
    "launch": "",
    "lifecycle": "get list nodes set",
    "multicast": "",
    "node": "info list",
    "param": "delete describe dump get list load set",
    "pkg": "create executables list prefix xml",
    "run": "",
    "security": "",
    "service": "call echo find info list type",
    "test": "",
    "topic": "bw delay echo find hz info list pub type",
    "wtf": "",
}
"""The commands that `ros2 --help` and `ros2 COMMAND --help` document."""


def documented() -> dict[str, set[str]]:
    found: dict[str, set[str]] = defaultdict(set)
    with TABLE.open(newline="") as file:
        for row in csv.DictReader(file):
            found[row["command"]].add(row["option"])
    return found


def command_of(verb: str) -> click.Command:
    module, _, attribute = VERBS[verb][0].partition(":")
    command: click.Command = getattr(import_module(module), attribute or "command")
    return command


def options_of(name: str) -> set[str]:
    verb, _, part = name.partition(" ")
    command = command_of(verb)
    if part:
        assert isinstance(command, click.Group)
        command = command.commands[part]
    return {opt for option in command.params for opt in option.opts}


@every_case("name", documented())
def test_a_documented_option_is_there_or_told_as_not_there(name: str) -> None:
    there, absent = options_of(name), set(ABSENT_OPTIONS.get(name, ()))
    assert not there & absent
    assert {option for option in documented()[name] if option.startswith("--")} <= there | absent
    output = CliRunner().invoke(main, ["ros", *name.split(), "--help"], terminal_width=400).output
    if absent:
        assert f"Options of `ros2 {name}` that are not here: " in output
        told = "".join(output.partition("that are not here: ")[2].split()).rstrip(".").split(",")
        assert set(told) == absent


def test_a_documented_command_is_there_or_told_as_not_there() -> None:
    assert COMMANDS.keys() - VERBS.keys() == ABSENT.keys()
    told = " ".join(CliRunner().invoke(main, ["ros", "--help"], terminal_width=400).output.split())
    assert f"Commands of `ros2` that are not here: {', '.join(ABSENT)}." in told
    for verb in COMMANDS.keys() - ABSENT.keys():
        command = command_of(verb)
        there = set(command.commands) if isinstance(command, click.Group) else set()
        absent = ABSENT_COMMANDS.get(verb, ())
        assert set(COMMANDS[verb].split()) - there == set(absent)
        if absent:
            told = CliRunner().invoke(main, ["ros", verb, "--help"], terminal_width=400).output
            assert f"that are not here: {', '.join(absent)}." in told


def test_nothing_is_told_as_not_there_that_nobody_documents() -> None:
    assert {name: set(options) - documented()[name] for name, options in ABSENT_OPTIONS.items()} == {
        name: set() for name in ABSENT_OPTIONS
    }


def test_packages_of_the_kit_are_listed() -> None:
    listed = CliRunner().invoke(main, ["ros", "pkg", "list"]).output.split()
    assert {"turtlesim", "geometry_msgs", "demo_nodes_py", "flatland_server"} <= set(listed)
    programs = CliRunner().invoke(main, ["ros", "pkg", "executables", "turtlesim"]).output.splitlines()
    assert programs == [
        f"turtlesim {name}" for name in ("draw_square", "mimic", "turtle_teleop_key", "turtlesim_node")
    ]


def test_a_type_of_the_same_package_is_shown_by_its_own_name() -> None:
    shown = (
        CliRunner()
        .invoke(main, ["ros", "interface", "show", "geometry_msgs/msg/Twist", "--no-comments"])
        .output
    )
    assert shown.splitlines()[:2] == ["Vector3 linear", "\tfloat64 x"]
