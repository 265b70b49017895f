"""What a launch file's actions ask for, in which order, and what follows from what happens."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from kit.ros.launch.actions import (
    DeclareBooleanLaunchArgument,
    DeclareLaunchArgument,
    EmitEvent,
    IncludeLaunchDescription,
    LogError,
    LogInfo,
    OpaqueCoroutine,
    OpaqueFunction,
    RegisterEventHandler,
    ScopedIncludeLaunchDescription,
    Shutdown,
    TimerAction,
    UnregisterEventHandler,
)
from kit.ros.launch.context import LaunchError
from kit.ros.launch.description_sources import LaunchDescriptionSource
from kit.ros.launch.entity import (
    IfCondition,
    LaunchConfigurationEquals,
    LaunchConfigurationNotEquals,
    LaunchDescription,
    UnlessCondition,
)
from kit.ros.launch.event_handlers import (
    OnExecutionComplete,
    OnProcessExit,
    OnProcessIO,
    OnProcessStart,
    OnShutdown,
)
from kit.ros.launch.events import (
    ShutdownProcess,
    matches_action,
    matches_executable,
    matches_name,
    matches_pid,
)
from kit.ros.launch.processes import (
    Executable,
    ExecuteLocal,
    ExecuteProcess,
    LifecycleTransition,
    Node,
    PushRosNamespace,
    SetParameter,
    SetRemap,
    SetROSLogDir,
)
from kit.ros.launch.settings import (
    AppendEnvironmentVariable,
    GroupAction,
    PopEnvironment,
    PopLaunchConfigurations,
    PushEnvironment,
    PushLaunchConfigurations,
    ReplaceEnvironmentVariables,
    ResetEnvironment,
    ResetLaunchConfigurations,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    UnsetEnvironmentVariable,
    UnsetLaunchConfiguration,
)
from kit.ros.launch.substitutions import LaunchConfiguration, LocalSubstitution
from tests.cases import every_case
from tests.ros.launch.conftest import Play


@every_case(
    ("condition", "holds"),
    [
        (IfCondition("true"), True),
        (IfCondition("1"), True),
        (IfCondition("False"), False),
        (IfCondition(True), True),
        (UnlessCondition("false"), True),
        (UnlessCondition(LaunchConfiguration("flag")), False),
        (LaunchConfigurationEquals("flag", "true"), True),
        (LaunchConfigurationNotEquals("flag", "true"), False),
        (LaunchConfigurationEquals("other", None), True),
    ],
)
def test_a_condition_decides(condition: Any, holds: bool) -> None:
    assert Play(LogInfo(msg="here", condition=condition), flag="true").said == (["here"] if holds else [])


def test_a_condition_that_says_neither_is_refused() -> None:
    with pytest.raises(LaunchError, match="is 'maybe'"):
        Play(LogInfo(msg="here", condition=IfCondition(LaunchConfiguration("flag"))), flag="maybe")


def test_what_a_group_sets_holds_inside() -> None:
    show = lambda: LogInfo(msg=[LaunchConfiguration("a", default="-"), LaunchConfiguration("b", default="-")])  # noqa: E731 - one per use
    run = Play(
        SetLaunchConfiguration("a", "1"),
        GroupAction([SetLaunchConfiguration("b", "2"), show()], launch_configurations={"a": "9"}),
        show(),
        GroupAction([SetLaunchConfiguration("b", "3")], scoped=False),
        show(),
        GroupAction([show()], forwarding=False),
        UnsetLaunchConfiguration("b"),
        show(),
        GroupAction([show()], condition=IfCondition("false")),
    )
    assert run.said == ["92", "1-", "13", "--", "1-"]


def test_the_environment_of_a_process() -> None:
    run = Play(
        SetEnvironmentVariable("A", "1"),
        AppendEnvironmentVariable("A", "2"),
        AppendEnvironmentVariable("A", "0", prepend=True),
        GroupAction([UnsetEnvironmentVariable("B"), ExecuteProcess(cmd=["x"], additional_env={"C": "3"})]),
        ExecuteProcess(cmd=["x"], env={"D": "4"}),
        ExecuteProcess(cmd=["x"]),
        environment={"B": "b"},
    )
    assert [each["environment"] for each in run.started] == [
        {"A": "0:1:2", "C": "3"},
        {"D": "4"},
        {"A": "0:1:2", "B": "b"},
    ]


def test_a_node_s_command_line(tmp_path: Path) -> None:
    file = tmp_path / "values.yaml"
    file.write_text("")
    run = Play(
        Node(
            package="pkg",
            executable="exe",
            name="one",
            namespace="left",
            arguments=["own", LaunchConfiguration("rate")],
            ros_arguments=["--log-level", "debug"],
            parameters=[
                {
                    "rate": LaunchConfiguration("rate"),
                    "loud": LaunchConfiguration("loud"),
                    "name": "yes it is",
                },
                {"a": {"b": 1, "c": [1.5, 2.0]}, "text": "'7'", "flag": True, "list": ["x", "y"]},
                str(file),
            ],
            remappings=[("scan", "/scan"), (LaunchConfiguration("loud"), "quiet")],
            output="screen",
            emulate_tty=True,
        ),
        rate="20.0",
        loud="true",
    )
    assert run.arguments == [
        "own", "20.0", "--ros-args", "--log-level", "debug", "-r", "__node:=one", "-r", "__ns:=/left",
        "-p", "rate:=20.0", "-p", "loud:=true", "-p", 'name:="yes it is"', "-p", "a.b:=1", "-p", "a.c:=[1.5, 2.0]",
        "-p", 'text:="7"', "-p", "flag:=true", "-p", 'list:=["x", "y"]', "--params-file", str(file),
        "-r", "scan:=/scan", "-r", "true:=quiet",
    ]  # fmt: skip


def test_groups_push_namespaces_parameters_and_remappings() -> None:
    run = Play(
        GroupAction(
            [
                PushRosNamespace("fleet"),
                SetParameter("use_sim_time", True),
                SetRemap("scan", "laser"),
                GroupAction([PushRosNamespace("one"), Node(executable="a")]),
                Node(executable="b", namespace="two"),
                Node(executable="c", namespace="/three"),
            ]
        ),
        Node(executable="d"),
    )
    rest = ["-p", "use_sim_time:=true", "-r", "scan:=laser"]
    assert [each["arguments"] for each in run.started] == [
        ["--ros-args", "-r", "__ns:=/fleet/one", *rest],
        ["--ros-args", "-r", "__ns:=/fleet/two", *rest],
        ["--ros-args", "-r", "__ns:=/three", *rest],
        [],
    ]


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Node(executable="a", parameters=[{"x": object()}]), "no parameter can hold"),
        (lambda: Node(executable="a", parameters=["/nowhere.yaml"]), "/nowhere.yaml does not exist"),
        (lambda: TimerAction(period="soon", actions=[]), "not a number of seconds"),
        (lambda: IncludeLaunchDescription("/nowhere.launch.py"), "does not exist"),
    ],
)
def test_errors_name_the_line_of_the_launch_file(make: Any, message: str) -> None:
    with pytest.raises(LaunchError, match=message) as caught:
        Play(make())
    assert caught.value.location is not None
    assert caught.value.location.file == __file__


def test_unknown_arguments_of_an_action_are_refused_at_once() -> None:
    with pytest.raises(TypeError, match="'ouput'"):
        Node(executable="a", ouput="screen")


def test_timers_go_off_in_the_launch_s_time() -> None:
    later = TimerAction(
        period=2.0, actions=[LogInfo(msg="second"), TimerAction(period=1.0, actions=[LogInfo(msg="third")])]
    )
    cancelled = TimerAction(period=1.5, actions=[LogInfo(msg="never")])
    run = Play(
        later,
        cancelled,
        TimerAction(period=LaunchConfiguration("wait"), actions=[LogInfo(msg="first")]),
        wait="1",
    )
    assert run.service.wake_ns == 1_000_000_000
    cancelled.cancel()
    run.advance(1.0)
    assert run.said == ["first"]
    run.advance(2.0)
    assert run.said == ["second"]
    run.advance(2.9)
    assert run.said == []
    run.advance(3.0)
    assert run.said == ["third"]
    assert run.service.wake_ns is None


def test_a_timer_is_announced_unless_a_timer_has_set_it_and_takes_no_process_s_number() -> None:
    """Whoever waits for all timers would wait for one that sets itself again without end."""

    def again(context: Any) -> list[Any]:
        return [ExecuteProcess(cmd=["x"]), TimerAction(period=1.0, actions=[OpaqueFunction(function=again)])]

    run = Play(OpaqueFunction(function=again), ExecuteProcess(cmd=["y"]))
    assert run.requests[1] == ["timer", 1_000_000_000]
    for now in (1.0, 2.0):
        run.advance(now)
        assert run.kinds == ["process"]
    assert run.requests[0][1] == 4
    run.advance(2.5, ("exited", 1, 10, 0))
    assert "timer" not in run.kinds


def test_functions_return_actions() -> None:
    def choose(context: Any, count: int, *, word: str) -> list[LogInfo]:
        return [LogInfo(msg=context.launch_configurations[word])] * count

    run = Play(
        OpaqueFunction(function=choose, args=[2], kwargs={"word": "room"}),
        OpaqueFunction(function=lambda context: None),
        room="maze",
    )
    assert run.said == ["maze", "maze"]


def test_what_happens_to_processes_is_reacted_to() -> None:
    server, client = ExecuteProcess(cmd=["server"]), ExecuteProcess(cmd=["client"])
    run = Play(
        server,
        RegisterEventHandler(OnProcessStart(target_action=server, on_start=[client])),
        RegisterEventHandler(
            OnProcessExit(
                target_action=client,
                on_exit=lambda event, context: LogInfo(msg=f"{event.process_name} {event.returncode}"),
            )
        ),
        RegisterEventHandler(
            OnProcessIO(
                target_action=server,
                on_stdout=lambda event: LogInfo(msg=event.text.decode().upper()),
                on_stderr=lambda event, context: [LogInfo(msg=event.text.decode())],
            )
        ),
    )
    run.advance(0.0, ("started", 1, 11))
    assert [each["command"] for each in run.started] == [["client"]]
    run.advance(0.0, ("started", 2, 12), ("printed", 1, "trouble", False))
    assert run.said == ["trouble"]
    run.advance(0.0, ("printed", 1, "fine", True))
    assert run.said == ["FINE"]
    run.advance(0.0, ("exited", 2, 12, 3))
    assert run.said == ["client-2 3"]


def test_a_process_is_started_again() -> None:
    run = Play(ExecuteProcess(cmd=["x"], respawn=True, respawn_delay=0.5))
    run.advance(1.0, ("exited", 1, 11, 1))
    assert run.started == []
    assert run.service.wake_ns == 1_500_000_000
    run.advance(1.5)
    assert [each["command"] for each in run.started] == [["x"]]


def test_the_end_of_one_can_be_the_end_of_all() -> None:
    main = Node(executable="main", on_exit=Shutdown(reason="main is done"))
    run = Play(
        main,
        RegisterEventHandler(OnShutdown(on_shutdown=[LogInfo(msg="good bye")])),
        ExecuteProcess(cmd=["x"]),
    )
    run.advance(1.0, ("exited", 1, 11, 0))
    assert run.said == ["good bye"]
    assert run.requests[-1] == ["shutdown", "main is done"]


def test_a_process_can_be_ended_and_handlers_withdrawn() -> None:
    victim = ExecuteProcess(cmd=["x"])
    handler = OnProcessExit(on_exit=[LogInfo(msg="heard")])
    run = Play(
        ExecuteProcess(cmd=["other"]),
        victim,
        RegisterEventHandler(handler),
        UnregisterEventHandler(handler),
        EmitEvent(event=ShutdownProcess(process_matcher=matches_action(victim))),
    )
    assert ["end", 2] in run.requests
    run.advance(0.0, ("exited", 2, 12, 0))
    assert run.said == []


def show(name: str) -> LogInfo:
    """Logs the value of a launch argument, and ``-`` without one."""
    return LogInfo(msg=LaunchConfiguration(name, default="-"))


def test_settings_are_pushed_popped_and_reset() -> None:
    run = Play(
        SetLaunchConfiguration("a", "1"),
        PushLaunchConfigurations(),
        SetLaunchConfiguration("a", "2"),
        show("a"),
        ResetLaunchConfigurations({"b": ["was ", LaunchConfiguration("a")]}),
        show("a"),
        show("b"),
        PopLaunchConfigurations(),
        show("a"),
        PushEnvironment(),
        SetEnvironmentVariable("A", "new"),
        ExecuteProcess(cmd=["x"]),
        ReplaceEnvironmentVariables({"C": "3"}),
        ExecuteProcess(cmd=["x"]),
        ResetEnvironment(),
        ExecuteProcess(cmd=["x"]),
        SetEnvironmentVariable("A", "again"),
        PopEnvironment(),
        ExecuteProcess(cmd=["x"]),
        environment={"A": "a"},
    )
    assert run.said == ["2", "-", "was 2", "1"]
    assert [each["environment"] for each in run.started] == [{"A": "new"}, {"C": "3"}, {"A": "a"}, {"A": "a"}]
    for alone in (PopLaunchConfigurations(), PopEnvironment()):
        with pytest.raises(LaunchError, match="before it"):
            Play(alone)


def test_a_group_without_forwarding_sees_only_its_own_settings() -> None:
    """ROS 2 keeps namespaces, parameters and remappings among the configurations: these are forgotten, too."""
    node = Node(package="p", executable="x")
    run = Play(
        SetLaunchConfiguration("a", "1"),
        SetEnvironmentVariable("E", "1"),
        PushRosNamespace("robot"),
        SetRemap("scan", "laser"),
        GroupAction(
            [show("a"), show("b"), node],
            forwarding=False,
            launch_configurations={"b": ["a was ", LaunchConfiguration("a")]},
        ),
        show("b"),
        node,
    )
    assert run.said == ["-", "a was 1", "-"]
    inside, outside = run.started
    assert (inside["arguments"], inside["environment"]) == ([], {})
    assert "__ns:=/robot" in outside["arguments"]
    assert outside["environment"] == {"E": "1"}


def test_an_action_that_is_complete_is_reported() -> None:
    process, timer, line = ExecuteProcess(cmd=["x"]), TimerAction(period=2.0, actions=[]), LogInfo(msg="line")
    run = Play(
        *(
            RegisterEventHandler(OnExecutionComplete(target_action=each, on_completion=[LogInfo(msg=text)]))
            for each, text in ((process, "process done"), (timer, "timer done"), (line, "line done"))
        ),
        process,
        timer,
        line,
    )
    assert run.said == ["line", "line done"]
    run.advance(1.0, ("exited", 1, 10, 0))
    assert run.said == ["process done"]
    run.advance(2.0)
    assert run.said == ["timer done"]
    with pytest.raises(ValueError, match="target"):
        OnExecutionComplete(target_action="line", on_completion=[])  # type: ignore[arg-type]  # what it must refuse


def test_a_reaction_can_name_the_event() -> None:
    run = Play(
        RegisterEventHandler(
            OnProcessExit(on_exit=[LogInfo(msg=["code ", LocalSubstitution("event.returncode")])])
        ),
        RegisterEventHandler(
            OnShutdown(on_shutdown=[LogInfo(msg=["why: ", LocalSubstitution("event.reason")])])
        ),
        LogInfo(msg=LocalSubstitution("current_launch_file_directory")),
        ExecuteProcess(cmd=["x"]),
    )
    assert run.said == ["/pkg/launch"]
    run.advance(1.0, ("exited", 1, 10, 7))
    assert run.said == ["code 7"]
    run.advance(2.0, ("interrupted", "the user"))
    assert run.said == ["why: the user"]
    with pytest.raises(LaunchError, match="current_launch_file_path"):
        Play(LogInfo(msg=LocalSubstitution("event.reason")))


@pytest.mark.parametrize("matches", [matches_pid(10), matches_name("prog-1"), matches_executable("prog")])
def test_a_process_is_found_by_number_name_or_program(matches: Any) -> None:
    run = Play(ExecuteProcess(cmd=["/usr/bin/prog", "--x"]), ExecuteProcess(cmd=["other"]))
    stop = RegisterEventHandler(
        OnProcessStart(on_start=[EmitEvent(event=ShutdownProcess(process_matcher=matches))], handle_once=True)
    )
    for entity in stop.visit(run.service.context) or ():
        entity.visit(run.service.context)
    run.advance(0.0, ("started", 1, 10))
    assert ["end", 1] in run.requests
    assert ["end", 2] not in run.requests


def test_boolean_arguments_levels_and_coroutines() -> None:
    async def coroutine(context: Any) -> None:
        raise AssertionError("is not run")

    run = Play(
        DeclareBooleanLaunchArgument("flag", default_value=True),
        show("flag"),
        LogError(msg="oh"),
        OpaqueCoroutine(coroutine=coroutine),
    )
    logged = [content for kind, *content in run.requests if kind == "log"]
    assert logged[:2] == [["INFO", "True"], ["ERROR", "oh"]]
    assert logged[2][0] == "WARN"
    assert "OpaqueFunction" in logged[2][1]
    with pytest.raises(LaunchError, match="maybe"):
        Play(DeclareBooleanLaunchArgument("flag"), flag="maybe")


def test_a_scoped_include_sees_only_its_arguments(tmp_path: Path) -> None:
    inner = write(
        tmp_path / "inner.launch.py",
        "LaunchDescription([LogInfo(msg=[LaunchConfiguration('a', default='-'), LaunchConfiguration('b', default='-')]),"
        " SetLaunchConfiguration('a', 'changed')])",
    )
    run = Play(
        SetLaunchConfiguration("a", "1"),
        ScopedIncludeLaunchDescription(inner, launch_arguments={"b": LaunchConfiguration("a")}),
        show("a"),
        show("b"),
    )
    assert run.said == ["-1", "1", "-"]


def test_nodes_go_through_transitions() -> None:
    run = Play(LifecycleTransition(lifecycle_node_names=["lidar", "/arm"], transition_ids=[1, "3"]))
    assert run.requests == [["transition", name, number] for name in ("/lidar", "/arm") for number in (1, 3)]
    with pytest.raises(LaunchError, match="'go'"):
        Play(LifecycleTransition(lifecycle_node_names=["lidar"], transition_ids=["go"]))


def test_an_executable_and_the_folder_for_logs() -> None:
    described = Executable(cmd=["prog"], arguments=["--fast"], additional_env={"A": "1"})
    run = Play(
        GroupAction(
            [SetROSLogDir("/logs"), SetROSLogDir("mine"), ExecuteLocal(process_description=described)]
        ),
        ExecuteProcess(cmd=["x"]),
    )
    first, second = run.started
    assert first["command"] == ["prog", "--fast"]
    assert first["environment"] == {"A": "1", "ROS_LOG_DIR": "/logs/mine"}
    assert second["environment"] == {}


@pytest.mark.parametrize(
    "process", [{"cmd": []}, {"cmd": [" "]}, {"cmd": ["", "x"]}, {"cmd": ["", " "], "shell": True}]
)
def test_an_empty_command_is_refused(process: dict[str, Any]) -> None:
    with pytest.raises(LaunchError, match="its command is empty"):
        Play(ExecuteProcess(**process))
    assert Play(ExecuteProcess(cmd=["", "x"], shell=True)).started[0]["title"] == "process"


def write(file: Path, body: str) -> str:
    file.write_text(
        "from kit.ros.launch.actions import *\nfrom kit.ros.launch.settings import *\nfrom kit.ros.launch.entity import LaunchDescription\n"
        "from kit.ros.launch.substitutions import LaunchConfiguration, ThisLaunchFileDir\n"
        f"def generate_launch_description():\n    return {body}\n"
    )
    return str(file)


def test_other_launch_files_are_included(tmp_path: Path) -> None:
    inner = write(
        tmp_path / "inner.launch.py",
        "LaunchDescription([LogInfo(msg=['in ', LaunchConfiguration('room'), ' ', ThisLaunchFileDir()])])",
    )
    run = Play(
        IncludeLaunchDescription(LaunchDescriptionSource(inner), launch_arguments={"room": "maze"}.items()),
        IncludeLaunchDescription(inner, condition=IfCondition("false")),
        LogInfo(msg="out"),
    )
    assert run.said == [f"in maze {tmp_path}", "out"]


def test_launch_files_that_include_each_other_are_found_out(tmp_path: Path) -> None:
    one, two = tmp_path / "one.launch.py", tmp_path / "two.launch.py"
    write(one, f"LaunchDescription([IncludeLaunchDescription({str(two)!r})])")
    write(two, f"LaunchDescription([IncludeLaunchDescription({str(one)!r})])")
    with pytest.raises(LaunchError, match=r"one\.launch\.py -> .*two\.launch\.py -> .*one\.launch\.py"):
        Play(IncludeLaunchDescription(str(one)))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x = 1", "no generate_launch_description"),
        ("def generate_launch_description(): return []", "must return a LaunchDescription, not list"),
    ],
)
def test_a_file_that_is_no_launch_file_is_refused(text: str, message: str, tmp_path: Path) -> None:
    file = tmp_path / "odd.launch.py"
    file.write_text(text)
    with pytest.raises(LaunchError, match=message):
        Play(IncludeLaunchDescription(str(file)))


def test_a_launch_file_may_be_in_xml(tmp_path: Path) -> None:
    (tmp_path / "a.launch.xml").write_text("<launch><log message='hello'/></launch>")
    played = Play(IncludeLaunchDescription(LaunchDescriptionSource(str(tmp_path / "a.launch.xml"))))
    assert played.said == ["hello"]


def test_all_declared_arguments_are_found_wherever_they_stand() -> None:
    description = LaunchDescription(
        [
            DeclareLaunchArgument("a", default_value=["x", LaunchConfiguration("b")]),
            GroupAction([DeclareLaunchArgument("b", choices=["1"])]),
            TimerAction(period=1.0, actions=[DeclareLaunchArgument("a"), DeclareLaunchArgument("c")]),
        ]
    )
    declared = description.get_launch_arguments()
    assert [each.name for each in declared] == ["a", "b", "c"]
    assert declared[0].shown_default == "'x' + LaunchConfig('b')"
