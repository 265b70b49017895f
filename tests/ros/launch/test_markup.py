"""Launch files in XML and YAML: the same requests as in Python, every mistake with its place, each substitution's text."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from kit.launch.launch_file_process import LIMITS
from kit.ros.launch import file_substitutions
from kit.ros.launch.context import LaunchContext, LaunchError
from kit.ros.launch.description_sources import load_launch_file
from kit.ros.launch.frontend.markup_reader import read_launch_description
from kit.ros.launch.frontend.substitution_parser import (
    SubstitutionSyntaxError,
    parse_substitutions,
    split_words,
)
from kit.ros.launch.service import LaunchService
from kit.ros.launch.substitutions import perform_substitutions
from kit.ros.packages import SEARCH_VARIABLE
from tests.cases import every_case

PYTHON = """
from launch import LaunchDescription
from launch.actions import *
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import *
from launch_ros.actions import Node, PushRosNamespace, RosTimer, SetParameter, SetRemap, SetROSLogDir
from launch_ros.parameter_descriptions import ParameterValue

def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("room", default_value="maze", description="which", choices=["maze", "hall"]),
        DeclareLaunchArgument("fast", default_value="true"),
        SetLaunchConfiguration("file", [LaunchConfiguration("room"), ".yaml"]),
        SetEnvironmentVariable("COLOR", "red"),
        AppendEnvironmentVariable("COLOR", "blue"),
        LogInfo(msg=["in ", LaunchConfiguration("room")]),
        GroupAction([
            PushRosNamespace("robot1"),
            SetParameter("gain", 2),
            SetRemap("out", "/out"),
            Node(
                package="demo", executable="drive", name="driver", arguments=["--mode", "a b"],
                parameters=[{"speed": 0.5, "names": ["a", "b"], "label": ParameterValue("7", value_type=str),
                             "pid": {"p": 1, "i": 0.25}}],
                remappings=[("cmd_vel", "/robot/cmd_vel")], additional_env={"LEVEL": "3"},
            ),
        ]),
        Node(package="demo", executable="slow", condition=UnlessCondition(LaunchConfiguration("fast"))),
        Node(package="demo", executable="quick", condition=IfCondition(LaunchConfiguration("fast"))),
        ExecuteProcess(cmd=["ros2", "topic", "list"], cwd="/tmp"),
        TimerAction(period=2.0, actions=[LogInfo(msg="later")]),
        PushEnvironment(),
        PushLaunchConfigurations(),
        DeclareBooleanLaunchArgument("slow", default_value="false"),
        SetROSLogDir("/logs"),
        SetLaunchConfiguration("room", "changed"),
        LogWarning(msg=LaunchConfiguration("room")),
        ExecuteProcess(cmd=["env"]),
        PopLaunchConfigurations(),
        ResetEnvironment(),
        Log(msg=LaunchConfiguration("room"), level="error"),
        ReplaceEnvironmentVariables({"A": "1"}),
        ExecuteProcess(cmd=["env"]),
        PopEnvironment(),
        RosTimer(period=1.0, actions=[LogDebug(msg="sooner")]),
    ])
"""
XML = """<?xml version="1.0"?>
<launch version="0.1.1">
  <arg name="room" default="maze" description="which">
    <choice value="maze"/>
    <choice value="hall"/>
  </arg>
  <arg name="fast" default="true"/>
  <let name="file" value="$(var room).yaml"/>
  <set_env name="COLOR" value="red"/>
  <append_env name="COLOR" value="blue"/>
  <log message="in $(var room)"/>
  <group>
    <push-ros-namespace namespace="robot1"/>
    <set_parameter name="gain" value="2"/>
    <set_remap from="out" to="/out"/>
    <node pkg="demo" exec="drive" name="driver" args="--mode 'a b'">
      <env name="LEVEL" value="3"/>
      <param name="speed" value="0.5"/>
      <param name="names" value="a,b" value-sep=","/>
      <param name="label" value="7" type="str"/>
      <param name="pid"><param name="p" value="1"/><param name="i" value="0.25"/></param>
      <remap from="cmd_vel" to="/robot/cmd_vel"/>
    </node>
  </group>
  <node pkg="demo" exec="slow" unless="$(var fast)"/>
  <node pkg="demo" exec="quick" if="$(var fast)"/>
  <executable cmd="ros2 topic list" cwd="/tmp"/>
  <timer period="2.0"><log message="later"/></timer>
  <push_env/>
  <push_vars/>
  <bool_arg name="slow" default="false"/>
  <set_ros_log_dir new_log_dir="/logs"/>
  <let name="room" value="changed"/>
  <log_warning message="$(var room)"/>
  <executable cmd="env"/>
  <pop_vars/>
  <reset_env/>
  <log message="$(var room)" level="error"/>
  <rep_env><env name="A" value="1"/></rep_env>
  <executable cmd="env"/>
  <pop_env/>
  <ros_timer period="1.0"><log_debug message="sooner"/></ros_timer>
</launch>
"""
YAML = """launch:
- arg:
    name: room
    default: maze
    description: which
    choice: [{value: maze}, {value: hall}]
- arg: {name: fast, default: 'true'}
- let: {name: file, value: $(var room).yaml}
- set_env: {name: COLOR, value: red}
- append_env: {name: COLOR, value: blue}
- log: {message: in $(var room)}
- group:
  - push_ros_namespace: {namespace: robot1}
  - set_parameter: {name: gain, value: 2}
  - set_remap: {from: out, to: /out}
  - node:
      pkg: demo
      exec: drive
      name: driver
      args: --mode 'a b'
      env: [{name: LEVEL, value: '3'}]
      param:
      - {name: speed, value: 0.5}
      - {name: names, value: [a, b]}
      - {name: label, value: '7', type: str}
      - name: pid
        param: [{name: p, value: 1}, {name: i, value: 0.25}]
      remap: [{from: cmd_vel, to: /robot/cmd_vel}]
- node: {pkg: demo, exec: slow, unless: $(var fast)}
- node: {pkg: demo, exec: quick, if: $(var fast)}
- executable: {cmd: ros2 topic list, cwd: /tmp}
- timer:
    period: 2.0
    children:
    - log: {message: later}
- push_env: {}
- push_vars: {}
- bool_arg: {name: slow, default: 'false'}
- set_ros_log_dir: {new_log_dir: /logs}
- let: {name: room, value: changed}
- log_warning: {message: $(var room)}
- executable: {cmd: env}
- pop_vars: {}
- reset_env: {}
- log: {message: $(var room), level: error}
- rep_env: {env: [{name: A, value: '1'}]}
- executable: {cmd: env}
- pop_env: {}
- ros_timer:
    period: 1.0
    children:
    - log_debug: {message: sooner}
"""


def requests(file: Path, text: str) -> list[Any]:
    """What carrying the file out asks for, now and three seconds later; without the places in the file."""
    file.write_text(text)
    service = LaunchService(str(file), {}, environment={})
    description = load_launch_file(service.context, str(file))
    found = [*service.start(description), *service.advance(3_000_000_000, [])]
    for _, *content in found:
        for part in content:
            if isinstance(part, dict):
                part.pop("file"), part.pop("line")
                if "arguments" in part:
                    part["arguments"] = sorted(_pairs(part["arguments"]))
    return found


def _pairs(words: list[str]) -> list[str]:
    """Options with their values, since the order of parameters does not matter."""
    found: list[str] = []
    for word in words:
        if found and found[-1] in ("-p", "-r", "--mode"):
            found[-1] += f" {word}"
        else:
            found.append(word)
    return found


@pytest.mark.usefixtures("import_names")
@pytest.mark.parametrize(("suffix", "text"), [("xml", XML), ("yaml", YAML)], ids=["xml", "yaml"])
def test_three_languages_ask_for_the_same(suffix: str, text: str, tmp_path: Path) -> None:
    wanted = requests(tmp_path / "a.launch.py", PYTHON)
    assert requests(tmp_path / f"a.launch.{suffix}", text) == wanted
    kinds = [kind for kind, *_ in wanted]
    assert kinds == [
        "log",
        *["process"] * 3,
        "timer",
        "log",
        "process",
        "log",
        "process",
        "timer",
        "log",
        "log",
    ]
    assert [content[1] for kind, *content in wanted if kind == "log"] == [
        "in maze",
        "changed",
        "maze",
        "sooner",
        "later",
    ]
    assert [each[2]["environment"] for each in wanted[6:9:2]] == [
        {"COLOR": "red:blue", "ROS_LOG_DIR": "/logs"},
        {"A": "1"},
    ]
    assert wanted[1][2]["environment"] == {"COLOR": "red:blue", "LEVEL": "3"}
    assert '-p label:="7"' in wanted[1][2]["arguments"]


@every_case(
    ("file", "text", "wanted"),
    [
        ("a.launch.xml", "<launch>\n  <nod pkg='a'/>\n</launch>", (2, "column 3", "did you mean <node>")),
        ("a.launch.xml", "<launch>\n  <node exec='b' pgk='a'/>\n</launch>", (2, "column 3", "did you mean 'pkg'")),
        ("a.launch.xml", "<launch><node pkg='a'/></launch>", (1, "column 9", "needs 'exec'")),
        ("a.launch.xml", "<launch>\n<log message='a'>", (2, "column", "not XML")),
        ("a.launch.xml", "<robot/>", (1, "column 1", "starts with <launch>")),
        ("a.launch.xml", "<launch>\n\n<log message='$(vra x)'/></launch>", (3, "column 1", "did you mean 'var'")),
        ("a.launch.xml", "<launch><log message='$(var x'/></launch>", (1, "column 9", "is not closed")),
        ("a.launch.xml", "<launch><timer period='1'>hm</timer></launch>", (1, "column", "'hm' does not belong")),
        ("a.launch.xml", "<launch><log message='a' if='1' unless='0'/></launch>", (1, "column 9", "both 'if'")),
        ("a.launch.xml", "<launch><log message='a'><env name='a' value='b'/></log></launch>", (1, "", "<env>")),
        ("a.launch.yaml", "launch:\n- nod: {pkg: a}\n", (2, "column 3", "did you mean <node>")),
        ("a.launch.yaml", "launch:\n- node: {pkg: a, exec: b\n", (2, "column 9", "not closed")),
        ("a.launch.yaml", "- node: {pkg: a}\n", (1, "column 1", "starts with 'launch:'")),
        ("a.launch.yaml", "launch:\n- node\n", (2, "column 3", "a single key")),
        ("a.launch.yaml", "launch:\n- log: hello\n", (2, "column 3", "come below it")),
        ("a.launch.yaml", "launch: 3\n", (1, "column 9", "a list of actions")),
    ],
)  # fmt: skip
def test_a_mistake_is_named_with_its_line_and_column(
    file: str, text: str, wanted: tuple[int, str, str]
) -> None:
    line, column, words = wanted
    with pytest.raises(LaunchError) as caught:
        read_launch_description(f"/launch/{file}", text.encode())
    assert caught.value.location is not None
    assert (caught.value.location.file, caught.value.location.line) == (f"/launch/{file}", line)
    assert column in str(caught.value)
    assert words in str(caught.value)


def test_all_mistakes_come_at_once() -> None:
    text = "<launch>\n<nod/>\n<log/>\n<log message='$(nothing)'/>\n</launch>"
    with pytest.raises(LaunchError) as caught:
        read_launch_description("/launch/a.launch.xml", text.encode())
    assert "/launch/a.launch.xml:3:1: <log> needs 'message'" in str(caught.value)
    assert "/launch/a.launch.xml:4:1:" in str(caught.value)


FACTS = [
    ("$(var room)", "maze"),
    ("a$(var room)b$(var room)", "amazebmaze"),
    ("$(var none usual)", "usual"),
    ("$(var none '')", ""),
    ("\\$(var room)", "$(var room)"),
    ("$(env HOME)", "/home/ada"),
    ("$(env NONE other)", "other"),
    ("$(optenv NONE)", ""),
    ("$(eval '1 + 2')", "3"),
    ('$(eval \'"$(var room)" == "maze"\')', "True"),
    ("$(equals $(var room) maze)", "true"),
    ("$(not-equals $(var room) maze)", "false"),
    ("$(not true)", "false"),
    ("$(and true $(equals a a))", "true"),
    ("$(or false 0)", "false"),
    ("$(any false no yes)", "true"),
    ("$(all true 1 on)", "true"),
    ("$(if $(equals $(var room) maze) small large)", "small"),
    ("$(if false small)", ""),
    ("$(dirname)/x", "/pkg/launch/x"),
    ("$(filename)", "/pkg/launch/top.launch.xml"),
    ("$(find-pkg-share demo)/world", "{packages}/demo/world"),
    ("$(find-pkg-prefix demo)", "{packages}/demo"),
    ("$(exec-in-pkg drive demo)", "{packages}/demo/lib/demo/drive"),
    ("$(file-content {packages}/demo/note.txt)", "a note\n"),
    ("$(command 'printf hello')", "hello"),
    ("$(command 'sh -c \"printf out; printf err >&2\"' ignore)", "out"),
    ("$(command 'sh -c \"printf out; printf err >&2\"' capture)", "outerr"),
    ("$(anon node) $(anon node) $(anon other)", "node_1 node_1 other_2"),
    ("$(param gain)", "2"),
    ("$(param none 5)", "5"),
    ("$(path-join a b $(var room))", "a/b/maze"),
    ("$(string-join , a b)", "a,b"),
    ("$(string-strip '  a b ')", "a b"),
    ("$(is-empty '')$(is-empty a)", "truefalse"),
    ("$(not-empty $(var room))", "true"),
    ("$(find-exec ros2)", "ros2"),
    ("$(find-pkg-share gazebo_ros)/launch", "/not-available-in-the-kit/gazebo_ros/launch"),
]
"""What each substitution of launch's documentation gives."""


@pytest.fixture
def context(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> LaunchContext:
    demo = tmp_path / "demo"
    (demo / "demo").mkdir(parents=True)
    (demo / "package.xml").write_text("<package><name>demo</name></package>")
    (demo / "setup.py").write_text("setup(entry_points={'console_scripts': ['drive = demo.drive:main']})")
    (demo / "note.txt").write_text("a note\n")
    monkeypatch.setenv(SEARCH_VARIABLE, str(tmp_path))
    made = LaunchContext(environment={"HOME": "/home/ada", "PATH": "/usr/bin:/bin"})
    made.launch_configurations["room"] = "maze"
    made.files.append("/pkg/launch/top.launch.xml")
    made.scope.parameters.append(("gain", "2"))
    return made


@pytest.mark.parametrize(("text", "wanted"), FACTS, ids=[text for text, _ in FACTS])
def test_each_substitution_gives_what_launch_gives(
    text: str, wanted: str, context: LaunchContext, tmp_path: Path
) -> None:
    parts = parse_substitutions(text.replace("{packages}", str(tmp_path)))
    assert perform_substitutions(context, parts) == wanted.replace("{packages}", str(tmp_path))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("$(file-content /no/such)", "cannot be read"),
        ("$(command 'no-such-program')", "cannot be run"),
        ("$(command 'sh -c \"exit 3\"')", "exit code 3"),
        ("$(command 'sh -c \"printf no >&2\"')", "printed errors: no"),
        ("$(command 'xacro robot.urdf')", "xacro is not in the kit"),
        ("$(exec-in-pkg nothing demo)", "no executable 'nothing'"),
        ("$(find-pkg-share nothing)", "package 'nothing' not found"),
        ("$(param none)", "'none' is not set"),
        ("$(not perhaps)", "a boolean must be one of"),
        ("$(env NONE)", "'NONE' does not exist"),
    ],
)
def test_what_cannot_be_determined_says_why(text: str, words: str, context: LaunchContext) -> None:
    with pytest.raises(LaunchError, match=words):
        perform_substitutions(context, parse_substitutions(text))


def test_a_command_may_take_so_long_and_that_is_less_than_the_launch_file_may(
    context: LaunchContext, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert min(LIMITS.start_s, LIMITS.reply_s) > file_substitutions.COMMAND_S
    monkeypatch.setattr(file_substitutions, "COMMAND_S", 0.2)
    with pytest.raises(LaunchError, match=r"'sleep 60' has not ended within 0\.2 s: run it before"):
        perform_substitutions(context, parse_substitutions("$(command 'sleep 60')"))


def test_a_substitution_needs_its_arguments() -> None:
    for text in ("$(var)", "$(equals a)", "$(dirname a)", "$()", "$(var 'a)"):
        with pytest.raises(SubstitutionSyntaxError):
            parse_substitutions(text)


LOOPS = {
    "launch.py": """
from launch import LaunchDescription
from launch.actions import *
from launch.substitutions import *
from launch_ros.actions import Node

def each(name, id, speed=1):
    return [Node(package="demo", executable="drive", name=name, parameters=[{"id": id}]),
            TimerAction(period=1.0, actions=[LogInfo(msg=f"{name} {speed}")])]

def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("robots", default_value="{name: ada, id: 1};{name: bob, id: 2, speed: 3}"),
        ForEach(LaunchConfiguration("robots"), function=each),
        ForLoop(2, function=lambda i: [LogInfo(msg=f"i={i}")]),
    ])
""",
    "launch.xml": """<launch>
  <arg name="robots" default="{name: ada, id: 1};{name: bob, id: 2, speed: 3}"/>
  <for_each values="$(var robots)">
    <node pkg="demo" exec="drive" name="$(for-var name)"><param name="id" value="$(for-var id)"/></node>
    <timer period="1.0"><log message="$(for-var name) $(for-var speed 1)"/></timer>
  </for_each>
  <for len="2" name="i"><log message="i=$(index i)"/></for>
</launch>""",
    "launch.yaml": """launch:
- arg: {name: robots, default: "{name: ada, id: 1};{name: bob, id: 2, speed: 3}"}
- for_each:
    values: $(var robots)
    children:
    - node: {pkg: demo, exec: drive, name: $(for-var name), param: [{name: id, value: $(for-var id)}]}
    - timer: {period: 1.0, children: [{log: {message: $(for-var name) $(for-var speed 1)}}]}
- for: {len: 2, name: i, children: [{log: {message: i=$(index i)}}]}
""",
}


@pytest.mark.usefixtures("import_names")
def test_loops_ask_for_the_same_in_three_languages(tmp_path: Path) -> None:
    asked = {suffix: requests(tmp_path / f"a.{suffix}", text) for suffix, text in LOOPS.items()}
    wanted = asked["launch.py"]
    assert [content[-1] for kind, *content in wanted if kind == "log"] == ["i=0", "i=1", "ada 1", "bob 3"]
    nodes = [content[-1]["arguments"] for kind, *content in wanted if kind == "process"]
    assert [["-r __node:=ada" in words, "-p id:=2" in words] for words in nodes] == [
        [True, False],
        [False, True],
    ]
    assert asked["launch.xml"] == asked["launch.yaml"] == wanted


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("<for len='many' name='i'/>", "'many', which is not a whole number"),
        ("<for_each values='{a: 1};b'><log message='a'/></for_each>", "'b' does not"),
        ("<for_each values='{a: 012}'><log message='a'/></for_each>", "two ways: it is 10"),
        ("<for_each values='{a: 1:30}'><log message='a'/></for_each>", "the number 90"),
        ("<for_each values='{a: 1}'><log message='$(for-var b)'/></for_each>", "no value 'b'; available: a"),
        ("<log message='$(index i)'/>", "no loop is around it"),
    ],
)
def test_a_mistake_in_a_loop_is_named(text: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(LaunchError, match=words):
        requests(tmp_path / "a.launch.xml", f"<launch>{text}</launch>")


COMPONENTS = {
    "xml": """<launch><node_container pkg="rclcpp_components" exec="component_container" name="c" namespace="">
      <composable_node pkg="demo" plugin="demo::Talker" name="ada" namespace="rig">
        <param name="speed" value="0.5"/><remap from="out" to="/out"/><extra_arg name="use_intra_process_comms" value="true"/>
      </composable_node></node_container>
      <load_composable_node target="c"><composable_node pkg="demo" plugin="demo.ears:Ears"/></load_composable_node>
      </launch>""",
    "yaml": """launch:
- node_container:
    pkg: rclcpp_components
    exec: component_container
    name: c
    namespace: ''
    composable_node:
    - pkg: demo
      plugin: demo::Talker
      name: ada
      namespace: rig
      param: [{name: speed, value: 0.5}]
      remap: [{from: out, to: /out}]
      extra_arg: [{name: use_intra_process_comms, value: 'true'}]
- load_composable_node:
    target: c
    composable_node: [{pkg: demo, plugin: 'demo.ears:Ears'}]
""",
}


@pytest.mark.parametrize("suffix", COMPONENTS)
def test_composable_nodes_are_asked_for_as_programs_of_their_own(suffix: str, tmp_path: Path) -> None:
    talker, ears = (
        content[-1] for _, *content in requests(tmp_path / f"a.launch.{suffix}", COMPONENTS[suffix])
    )
    assert (talker["kind"], talker["package"], talker["executable"]) == ("component", "demo", "demo::Talker")
    assert talker["arguments"] == [
        "--ros-args",
        "-p speed:=0.5",
        "-r __node:=ada",
        "-r __ns:=/rig",
        "-r out:=/out",
    ]
    assert (ears["kind"], ears["executable"], ears["arguments"]) == ("component", "demo.ears:Ears", [])


def test_words_of_a_command_are_split_as_a_shell_does(context: LaunchContext) -> None:
    words = split_words(parse_substitutions("a  'b c' d$(var room)e \"\" $(env HOME)"))
    assert [perform_substitutions(context, word) if word else "" for word in words] == [
        "a", "b c", "dmazee", "", "/home/ada",
    ]  # fmt: skip
