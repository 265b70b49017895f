"""What stands after ``--ros-args``: remappings, parameters, log levels, and mistakes in them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from kit.msg.std_msgs import String
from kit.msg.std_srvs import Trigger
from kit.ros.exceptions import InvalidNamespaceException, InvalidNodeNameException, InvalidRosArguments
from kit.ros.execution.arguments import parse_ros_arguments, split_ros_arguments
from kit.ros.execution.context import Context
from kit.ros.graph.graph import Graph
from kit.ros.log import LoggingSeverity
from kit.ros.node.node import Node, create_graph_node
from kit.run.episode import controller_arguments
from kit.run.scenario import find_scenario


def node_with(graph: Graph, *arguments: str, **settings: Any) -> Node:
    context = Context(graph)
    context.init(["program", "own", "--ros-args", *arguments, "--", "own too"])
    return Node("node", context=context, **settings)


def topic_of(node: Node, name: str) -> str:
    return node.create_publisher(String, name, 10).topic_name


class TestRemapping:
    @pytest.mark.parametrize(
        ("rule", "namespace", "topic", "becomes"),
        [
            ("chatter:=talk", None, "chatter", "/talk"),
            ("chatter:=talk", "/ns", "chatter", "/ns/talk"),
            ("/chatter:=talk", "/ns", "chatter", "/ns/chatter"),
            ("/ns/chatter:=/talk", "/ns", "chatter", "/talk"),
            ("~/secret:=open", None, "~/secret", "/open"),
            ("node:chatter:=talk", None, "chatter", "/talk"),
            ("other:chatter:=talk", None, "chatter", "/chatter"),
            ("rostopic://chatter:=talk", None, "chatter", "/talk"),
            ("rosservice://chatter:=talk", None, "chatter", "/chatter"),
            ("chatter:=~/private", None, "chatter", "/node/private"),
            ("/node:/chatter:=talk", None, "chatter", "/talk"),
            ("/ns/node:chatter:=talk", "/ns", "chatter", "/ns/talk"),
            ("/other/node:chatter:=talk", "/ns", "chatter", "/ns/chatter"),
            ("rostopic:=/foo/bar", None, "rostopic", "/foo/bar"),
            ("rostopic:///rosservice:=rostopic", None, "rosservice", "/rostopic"),
        ],
    )
    def test_a_topic(self, graph: Graph, rule: str, namespace: str | None, topic: str, becomes: str) -> None:
        assert topic_of(node_with(graph, "-r", rule, namespace=namespace), topic) == becomes

    def test_subscriptions_services_and_clients(self, graph: Graph) -> None:
        node = node_with(graph, "--remap", "a:=b", "-r", "s:=t")
        assert node.create_subscription(String, "a", print, 10).topic_name == "/b"
        assert node.create_service(Trigger, "s", lambda request, response: response).service_name == "/t"
        assert node.create_client(Trigger, "s").service_name == "/t"
        assert node.resolve_topic_name("a") == "/b"
        assert node.resolve_topic_name("a", only_expand=True) == "/a"
        assert node.resolve_service_name("s") == "/t"

    def test_the_first_rule_that_fits_counts(self, graph: Graph) -> None:
        assert topic_of(node_with(graph, "-r", "a:=b", "-r", "a:=c"), "a") == "/b"

    def test_names_and_namespaces(self, graph: Graph) -> None:
        node = node_with(graph, "-r", "__node:=renamed", "-r", "__ns:=/far/away")
        assert node.get_fully_qualified_name() == "/far/away/renamed"
        assert topic_of(node, "~/x") == "/far/away/renamed/x"
        assert node.get_logger().name == "far.away.renamed"

    def test_for_one_of_several_nodes(self, graph: Graph) -> None:
        arguments = ("-r", "node:__ns:=/left", "-r", "other:__ns:=/right")
        assert node_with(graph, *arguments).get_namespace() == "/left"

    def test_a_node_may_stay_out_of_it(self, graph: Graph) -> None:
        assert node_with(graph, "-r", "__node:=x", use_global_arguments=False).get_name() == "node"

    def test_a_nodes_own_arguments_come_first(self, graph: Graph) -> None:
        node = node_with(graph, "-r", "a:=all", cli_args=["--ros-args", "-r", "a:=own", "-p", "p:=1"])
        assert topic_of(node, "a") == "/own"
        assert node.declare_parameter("p", 0).value == 1

    def test_two_robots_from_one_program(self, graph: Graph) -> None:
        for name in ("left", "right"):
            assert topic_of(node_with(graph, "-r", f"__ns:=/{name}"), "cmd_vel") == f"/{name}/cmd_vel"


class TestLogLevels:
    def test_for_all_and_for_one(self, graph: Graph) -> None:
        node = node_with(graph, "--log-level", "warn", "--log-level", "node:=debug")
        assert node.get_logger().get_effective_level() is LoggingSeverity.DEBUG
        assert create_graph_node(graph, "other").get_logger().get_effective_level() is LoggingSeverity.WARN


class TestMistakes:
    @pytest.mark.parametrize(
        ("arguments", "said"),
        [
            (["-r"], "'-r' needs a value"),
            (["-r", "a=b"], "must look like from:=to"),
            (["-r", ":=b"], "must look like"),
            (["-r", "a:="], "new name is missing"),
            (["-r", "__nod:=x"], "only __node and __ns"),
            (["-p", "speed=1"], "must look like name:=value"),
            (["-p", "p:={a: 1}"], "cannot hold a mapping"),
            (["-p", "p:=[1"], "parameter value '[1'"),
            (["-p", "p:=[1, a]"], "one type"),
            (["-p", "foo:="], "the value is missing"),
            (["-p", "}foo:=/bar"], "no blanks and no braces"),
            (["-p", "f oo:=/bar"], "no blanks and no braces"),
            (["-r", "foo:="], "the new name is missing"),
            (["-r", ":=bar"], "must look like"),
            (["-r", ":__node:=name"], "must look like"),
            (["-r", "~:__node:=name"], "node name must not contain"),
            (["-r", "}foo:=/bar"], "unbalanced"),
            (["-r", "f oo:=/bar"], "alphanumerics"),
            (["-r", "foo:=/b ar"], "alphanumerics"),
            (["-r", "foo:=/b}ar"], "unbalanced"),
            (["-r", "rostopic://:=rosservice"], "must look like"),
            (["--params-file", "nowhere.yaml"], "nowhere.yaml"),
            (["--log-level", "loud"], "no log level 'loud'"),
            (["--frobnicate"], "unknown ROS argument '--frobnicate'"),
            (["stray"], "unknown ROS argument 'stray'"),
        ],
    )
    def test_are_named(self, arguments: list[str], said: str) -> None:
        with pytest.raises(InvalidRosArguments) as problem:
            parse_ros_arguments(["--ros-args", *arguments])
        assert said in str(problem.value)

    def test_bad_names_are_refused_with_the_place(self) -> None:
        with pytest.raises(InvalidNodeNameException):
            parse_ros_arguments(["--ros-args", "-r", "__node:=no spaces"])
        with pytest.raises(InvalidNamespaceException):
            parse_ros_arguments(["--ros-args", "-r", "__ns:=relative"])

    @pytest.mark.parametrize(
        ("text", "said"),
        [
            ("a: [1", "params.yaml:1"),
            ("a: 5", "params.yaml:1:4: needs a mapping"),
            ("- a", "params.yaml:1:1: needs a mapping"),
            ("n:\n  ros__parameters:\n    a:5\n    b: 6", "params.yaml:3:6: a space is missing"),
            ("n:\n  ros__parameters:\n    a:5", "params.yaml:3:5: a space is missing"),
            ("n:\n\tros__parameters: {a: 1}", "params.yaml:2:1: this line is indented with a tab"),
            ("ros__parameters: {a: 1}", "under the name of a node"),
            ("n:\n  ros__parameters:\n    a: [1, x]", "params.yaml:3:8"),
            ("n:\n  ros__parameters:\n    ? [1]\n    : 2", "plain text"),
            ("n:\n  ros__parameters: 5", "needs a mapping"),
        ],
    )
    def test_a_file_is_named_with_line_and_column(self, tmp_path: Path, text: str, said: str) -> None:
        file = tmp_path / "params.yaml"
        file.write_text(text)
        with pytest.raises(InvalidRosArguments) as problem:
            parse_ros_arguments(["--ros-args", "--params-file", str(file)])
        assert said in str(problem.value)

    def test_a_file_that_is_no_text(self, tmp_path: Path) -> None:
        file = tmp_path / "params.yaml"
        file.write_bytes(b"\xff\xfe\x00")
        with pytest.raises(InvalidRosArguments, match=r"params\.yaml"):
            parse_ros_arguments(["--ros-args", "--params-file", str(file)])


def test_a_programs_own_arguments_are_left_to_it() -> None:
    line = ["prog", "a", "--ros-args", "-r", "x:=y", "--", "b", "--ros-args", "-p", "c:=1"]
    assert split_ros_arguments(line) == (["prog", "a", "b"], ["-r", "x:=y", "-p", "c:=1"])
    assert parse_ros_arguments(["prog", "-r", "not for ros"]).remappings == ()


def test_what_ros_understands_and_means_nothing_here_is_let_through() -> None:
    parse_ros_arguments(["--ros-args", "--enclave", "/x", "--disable-rosout-logs", "--log-file-name", "x"])


def test_an_empty_file_gives_nothing(tmp_path: Path) -> None:
    file = tmp_path / "params.yaml"
    file.write_text("# nothing\n")
    assert parse_ros_arguments(["--ros-args", "--params-file", str(file)]).parameters == ()


@pytest.mark.parametrize(
    "text",
    [
        "1",
        "-0",
        "1.5",
        "1e3",
        "1E-5",
        "1e999",
        "NaN",
        "true",
        "null",
        '"true"',
        '"a # b: c"',
        "serp",
        "yes",
        "12_3x",
        "0x1F",
        "[1, 2]",
        "[1, 2.5]",
        "[1.0, -2e-7]",
        '["a", "b, c"]',
        "[true, false]",
        "[ 1 ,2 ]",
        "'it''s'",
        '"a\\tb"',
        "[]",
        ".5",
    ],
)
def test_a_value_means_what_it_means_in_a_parameter_file(text: str, tmp_path: Path) -> None:
    file = tmp_path / "parameters.yaml"
    file.write_text(f"/**: {{ros__parameters: {{speed: {text}}}}}\n")
    given, of_file = (
        parse_ros_arguments(["--ros-args", *words]).parameters[0].parameters[0]
        for words in (["-p", f"speed:={text}"], ["--params-file", str(file)])
    )
    assert (given.type_, given.value) == (of_file.type_, of_file.value)


@pytest.mark.parametrize("text", ["[[1], [2]]", "[" * 100_000, '{"a": 1}', "012"])
def test_a_value_that_no_parameter_can_have_is_refused(text: str) -> None:
    with pytest.raises(InvalidRosArguments):
        parse_ros_arguments(["--ros-args", "-p", f"speed:={text}"])


def test_a_controller_s_arguments_are_read_without_a_yaml_library() -> None:
    arguments = controller_arguments(find_scenario("turn", "turn_a_to_b"))
    program = f"""
import sys
from kit.ros.execution.arguments import parse_ros_arguments
assert parse_ros_arguments({arguments!r}).parameters
assert "yaml" not in sys.modules
"""
    subprocess.run([sys.executable, "-c", program], check=True)
