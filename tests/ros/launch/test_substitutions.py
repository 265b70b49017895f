"""Texts that are known only when a launch file is carried out."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from kit.ros.launch.actions import DeclareLaunchArgument, LogInfo
from kit.ros.launch.context import LaunchError
from kit.ros.launch.file_substitutions import FindPackageShare
from kit.ros.launch.settings import SetEnvironmentVariable
from kit.ros.launch.substitutions import (
    EnvironmentVariable,
    EqualsSubstitution,
    FindExecutable,
    LaunchConfiguration,
    NotEqualsSubstitution,
    PathJoinSubstitution,
    PythonExpression,
    TextSubstitution,
    ThisLaunchFile,
    ThisLaunchFileDir,
)
from kit.ros.packages import SEARCH_VARIABLE
from tests.cases import every_case
from tests.ros.launch.conftest import Play

ROOM = LaunchConfiguration("room")


@every_case(
    ("substitution", "text"),
    [
        (TextSubstitution(text="as it is"), "as it is"),
        (ROOM, "maze"),
        (LaunchConfiguration("none", default="usual"), "usual"),
        (LaunchConfiguration("none", default=["a", ROOM]), "amaze"),
        (["worlds/", ROOM, ".yaml"], "worlds/maze.yaml"),
        (PathJoinSubstitution(["/share", "world", [ROOM, ".yaml"]]), "/share/world/maze.yaml"),
        (PathJoinSubstitution(["/share"]) / "world" / ROOM, "/share/world/maze"),
        (EnvironmentVariable("HOME"), "/home/me"),
        (EnvironmentVariable("NONE", default_value="nobody"), "nobody"),
        (PythonExpression(["'", ROOM, "' == 'maze'"]), "True"),
        (PythonExpression("2 * pi > 6"), "True"),
        (EqualsSubstitution(ROOM, "maze"), "true"),
        (EqualsSubstitution("1", True), "true"),
        (NotEqualsSubstitution(ROOM, "house"), "true"),
        (FindExecutable(name="ros2"), "ros2"),
        (ThisLaunchFile(), "/pkg/launch/top.launch.py"),
        (ThisLaunchFileDir(), "/pkg/launch"),
    ],
)
def test_a_substitution_becomes_its_text(substitution: Any, text: str) -> None:
    run = Play(LogInfo(msg=substitution), room="maze", environment={"HOME": "/home/me", "PATH": ""})
    assert run.said == [text]


@every_case(
    ("substitution", "message"),
    [
        (LaunchConfiguration("rom"), "did you mean 'room'"),
        (LaunchConfiguration("colour"), "'colour' does not exist"),
        (EnvironmentVariable("NONE"), "'NONE' does not exist"),
        (PythonExpression("1 +"), "SyntaxError"),
        (PythonExpression(ROOM), "quotes of their own"),
        (FindExecutable(name="no_such_program"), "not found on the PATH"),
        (FindPackageShare("no_such_package"), "package 'no_such_package' not found"),
    ],
)
def test_substitution_failures_name_the_line(substitution: Any, message: str) -> None:
    with pytest.raises(LaunchError, match=message) as caught:
        Play(LogInfo(msg=substitution), room="maze", environment={"PATH": ""})
    assert caught.value.location is not None
    assert caught.value.location.file == __file__


@every_case("nonsense", [1, None, {"a": 1}, b"bytes", [1.5]])
def test_what_is_no_text_is_refused_where_it_is_written(nonsense: Any) -> None:
    with pytest.raises(TypeError, match="a text is needed here"):
        LogInfo(msg=nonsense)


def test_a_package_s_share_is_its_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "src" / "mine").mkdir(parents=True)
    (tmp_path / "src" / "mine" / "package.xml").write_text("<package><name>my_package</name></package>")
    monkeypatch.setenv(SEARCH_VARIABLE, str(tmp_path))
    run = Play(
        LogInfo(msg=FindPackageShare("my_package")), LogInfo(msg=FindPackageShare("my_package") / "world")
    )
    assert run.said == [str(tmp_path / "src/mine"), str(tmp_path / "src/mine/world")]


def test_arguments_have_defaults_choices_and_needs() -> None:
    declared = [
        DeclareLaunchArgument("a", default_value="1"),
        DeclareLaunchArgument("b", default_value=["x", LaunchConfiguration("a")]),
        LogInfo(msg=[LaunchConfiguration("a"), LaunchConfiguration("b")]),
    ]
    assert Play(*declared).said == ["1x1"]
    assert Play(*declared, a="2").said == ["2x2"]
    with pytest.raises(LaunchError, match=r"'speed'.*how fast.*speed:=VALUE"):
        Play(DeclareLaunchArgument("speed", description="how fast"))
    with pytest.raises(LaunchError, match=r"Valid options are: \['red', 'blue'\]"):
        Play(DeclareLaunchArgument("colour", choices=["red", "blue"]), colour="green")


def test_the_environment_can_be_set_and_asked() -> None:
    run = Play(SetEnvironmentVariable("A", ["x", "y"]), LogInfo(msg=EnvironmentVariable("A")))
    assert run.said == ["xy"]
