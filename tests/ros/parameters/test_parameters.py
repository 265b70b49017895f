"""Parameters: declared, overridden, read, set, described, watched, and their services."""

from __future__ import annotations

from array import array
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from kit.msg.rcl_interfaces import (
    DescribeParameters,
    FloatingPointRange,
    GetParameters,
    GetParameterTypes,
    IntegerRange,
    ListParameters,
    ParameterDescriptor,
    ParameterEvent,
    SetParameters,
    SetParametersAtomically,
    SetParametersResult,
)
from kit.ros.exceptions import (
    InvalidParameterException,
    InvalidParameterTypeException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from kit.ros.execution.context import Context, context_of
from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node, create_graph_node
from kit.ros.parameters.parameter import Parameter, parameter_value_to_python
from kit.ros.parameters.parameter_files import AmbiguousValue, get_parameter_value, parse_value
from tests.cases import every_case

Type = Parameter.Type


@pytest.fixture
def node(graph: Graph) -> Node:
    return create_graph_node(graph, "node")


def node_with(graph: Graph, *arguments: str, name: str = "node", **settings: Any) -> Node:
    """A node started with ``--ros-args`` and these."""
    context = Context(graph)
    context.init(["program", "--ros-args", *arguments])
    return Node(name, context=context, **settings)


class TestDeclaring:
    @pytest.mark.parametrize(
        ("value", "kind"),
        [
            (True, Type.BOOL),
            (3, Type.INTEGER),
            (0.5, Type.DOUBLE),
            (np.float64(0.5), Type.DOUBLE),
            ("text", Type.STRING),
            ([b"a"], Type.BYTE_ARRAY),
            ([True, False], Type.BOOL_ARRAY),
            ([1, 2], Type.INTEGER_ARRAY),
            (array("d", [1.0]), Type.DOUBLE_ARRAY),
            ((1.0, 2.0), Type.DOUBLE_ARRAY),
            (["a"], Type.STRING_ARRAY),
        ],
    )
    def test_the_default_decides_the_type(self, node: Node, value: Any, kind: Type) -> None:
        declared = node.declare_parameter("p", value)
        assert (declared.value, declared.type_) == (value, kind)
        assert node.get_parameter("p") == declared
        assert node.describe_parameter("p").type == kind.value
        message = declared.to_parameter_msg()
        assert list(np.atleast_1d(parameter_value_to_python(message.value))) == list(np.atleast_1d(value))
        assert Parameter.from_parameter_msg(message).type_ is kind

    def test_twice_is_once_too_often(self, node: Node) -> None:
        node.declare_parameter("p", 1)
        with pytest.raises(ParameterAlreadyDeclaredException, match="p"):
            node.declare_parameter("p", 2)

    @pytest.mark.parametrize("value", [{"a": 1}, object(), [1, "a"], [1, 2.0], [None]])
    def test_a_value_must_be_one_of_the_types(self, node: Node, value: Any) -> None:
        with pytest.raises(TypeError):
            node.declare_parameter("p", value)

    def test_a_name_must_be_one(self, node: Node) -> None:
        with pytest.raises(InvalidParameterException):
            node.declare_parameter("", 1)
        with pytest.raises(TypeError):
            node.declare_parameter(7, 1)

    def test_many_at_once_under_a_prefix(self, node: Node) -> None:
        node.declare_parameters(
            "pid", [("p", 1.0), ("i", 0.5, ParameterDescriptor(description="integral")), ("free",)]
        )
        assert {
            name: parameter.value for name, parameter in node.get_parameters_by_prefix("pid").items()
        } == {
            "p": 1.0,
            "i": 0.5,
            "free": None,
        }
        assert node.describe_parameter("pid.i").description == "integral"
        for wrong in ([()], [("a", 1, None, 2)], ["name"], [("a", 1, "text")]):
            with pytest.raises(TypeError):
                node.declare_parameters("", wrong)

    def test_a_type_alone_waits_for_its_value(self, node: Node) -> None:
        node.declare_parameter("p", Type.DOUBLE)
        with pytest.raises(ParameterUninitializedException):
            node.get_parameter("p")
        assert node.get_parameter_or("p", Parameter("p", value=1.5)).value == 1.5
        node.set_parameters([Parameter("p", value=2.5)])
        assert node.get_parameter("p").value == 2.5
        with pytest.raises(ValueError, match="NOT_SET"):
            node.declare_parameter("q", Type.NOT_SET)

    def test_a_name_alone_may_become_anything(self, node: Node) -> None:
        node.declare_parameter("p")
        assert node.get_parameter("p").value is None
        for value in (1, "a", 0.5):
            assert node.set_parameters([Parameter("p", value=value)])[0].successful
            assert node.get_parameter("p").value == value

    def test_every_node_has_use_sim_time(self, graph: Graph, node: Node, alone: Graph) -> None:
        assert node.get_parameter("use_sim_time").value is True
        assert create_graph_node(alone, "node").get_parameter("use_sim_time").value is False


class TestReading:
    def test_an_undeclared_parameter_is_an_error_with_the_nearest_name(self, node: Node) -> None:
        node.declare_parameter("speed", 1.0)
        with pytest.raises(ParameterNotDeclaredException, match=r"did you mean 'speed'\?"):
            node.get_parameter("sped")
        assert not node.has_parameter("sped")
        assert node.get_parameter_or("sped").value is None
        assert node.get_parameter_or("sped", Parameter("x", value=1)).value == 1

    def test_a_list_of_names(self, node: Node) -> None:
        node.declare_parameters("", [("a", 1), ("b", 2)])
        assert [parameter.value for parameter in node.get_parameters(["b", "a"])] == [2, 1]
        assert node.get_parameter_types(["a"]) == [Type.INTEGER]
        with pytest.raises(TypeError, match="list of names"):
            node.get_parameters("ab")

    def test_a_node_may_allow_undeclared_parameters(self, graph: Graph) -> None:
        node = Node("lax", context=context_of(graph), allow_undeclared_parameters=True)
        assert node.get_parameter("p").value is None
        node.set_parameters([Parameter("p", value=3)])
        assert node.get_parameter("p").value == 3

    def test_names_by_prefix_and_depth(self, node: Node) -> None:
        node.declare_parameters("", [("a", 1), ("b.c", 1), ("b.d.e", 1)])
        assert node.list_parameters(["b"], 0).names == ["b.c", "b.d.e"]
        assert node.list_parameters(["b"], 1).names == ["b.c"]
        assert node.list_parameters([], 1).names == ["use_sim_time", "a"]
        assert node.list_parameters(["b"], 0).prefixes == ["b", "b.d"]


class TestSetting:
    def test_another_type_is_refused(self, node: Node) -> None:
        node.declare_parameter("speed", 1.0)
        (result,) = node.set_parameters([Parameter("speed", value=2)])
        assert not result.successful
        assert "Wrong parameter type, expected 'DOUBLE' got 'INTEGER'" in result.reason
        assert node.get_parameter("speed").value == 1.0

    def test_an_empty_list_is_of_every_list_type(self, node: Node) -> None:
        node.declare_parameter("p", [1.0])
        assert node.set_parameters([Parameter("p", Type.DOUBLE_ARRAY, [])])[0].successful

    def test_what_stands_before_an_undeclared_one_stays_set(self, node: Node) -> None:
        node.declare_parameter("a", 1)
        with pytest.raises(ParameterNotDeclaredException):
            node.set_parameters([Parameter("a", value=2), Parameter("nobody", value=2)])
        assert node.get_parameter("a").value == 2
        with pytest.raises(TypeError, match="Parameter"):
            node.set_parameters([("a", 2)])

    def test_all_or_none(self, node: Node) -> None:
        node.declare_parameters("", [("a", 1), ("b", 1)])
        result = node.set_parameters_atomically([Parameter("a", value=2), Parameter("b", value="x")])
        assert not result.successful
        assert node.get_parameter("a").value == 1
        assert node.set_parameters_atomically([Parameter("a", value=2), Parameter("b", value=2)]).successful
        assert node.get_parameter("b").value == 2

    @pytest.mark.parametrize(
        ("descriptor", "good", "bad"),
        [
            (
                ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=10, step=5)]),
                [0, 5, 10],
                [3, 11],
            ),
            (
                ParameterDescriptor(
                    floating_point_range=[FloatingPointRange(from_value=0.0, to_value=1.0, step=0.1)]
                ),
                [0.0, 0.3, 1.0],
                [0.35, -0.1, 1.1],
            ),
        ],
    )
    def test_ranges_hold(
        self, node: Node, descriptor: ParameterDescriptor, good: list[Any], bad: list[Any]
    ) -> None:
        node.declare_parameter("p", good[0], descriptor)
        assert all(node.set_parameters([Parameter("p", value=value)])[0].successful for value in good)
        assert not any(node.set_parameters([Parameter("p", value=value)])[0].successful for value in bad)
        with pytest.raises(InvalidParameterValueException):
            node.declare_parameter("q", bad[0], descriptor)
        assert not node.has_parameter("q")

    def test_what_is_read_only_stays(self, node: Node) -> None:
        node.declare_parameter("p", 1, ParameterDescriptor(read_only=True))
        assert not node.set_parameters([Parameter("p", value=2)])[0].successful
        with pytest.raises(ParameterImmutableException):
            node.undeclare_parameter("p")
        with pytest.raises(ParameterImmutableException):
            node.set_descriptor("p", ParameterDescriptor())

    def test_undeclaring(self, node: Node) -> None:
        node.declare_parameter("p", 1)
        node.undeclare_parameter("p")
        assert not node.has_parameter("p")
        with pytest.raises(ParameterNotDeclaredException):
            node.undeclare_parameter("p")

    def test_a_new_descriptor_holds_from_then_on(self, node: Node) -> None:
        node.declare_parameter("p", 1)
        limits = ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=3)])
        held = node.set_descriptor("p", limits, Parameter("p", value=2).get_parameter_value())
        assert held.integer_value == 2
        assert not node.set_parameters([Parameter("p", value=9)])[0].successful
        with pytest.raises(InvalidParameterValueException):
            node.set_descriptor("p", limits, Parameter("p", value=9).get_parameter_value())


class TestCallbacks:
    def test_one_may_refuse_with_a_reason(self, node: Node) -> None:
        node.declare_parameter("speed", 1.0)

        def check(parameters: list[Parameter]) -> SetParametersResult:
            too_fast = any(parameter.value > 2.0 for parameter in parameters)
            return SetParametersResult(successful=not too_fast, reason="too fast" if too_fast else "")

        node.add_on_set_parameters_callback(check)
        (result,) = node.set_parameters([Parameter("speed", value=3.0)])
        assert (result.successful, result.reason) == (False, "too fast")
        node.remove_on_set_parameters_callback(check)
        assert node.set_parameters([Parameter("speed", value=3.0)])[0].successful

    def test_the_forgotten_return_is_named(self, node: Node) -> None:
        node.declare_parameter("p", 1)
        node.add_on_set_parameters_callback(lambda parameters: None)
        with pytest.raises(TypeError, match="SetParametersResult"):
            node.set_parameters([Parameter("p", value=2)])

    def test_before_and_after(self, node: Node) -> None:
        node.declare_parameters("", [("a", 1), ("b", 1)])
        after: list[list[str]] = []
        node.add_pre_set_parameters_callback(lambda parameters: [*parameters, Parameter("b", value=5)])
        node.add_post_set_parameters_callback(lambda parameters: after.append([p.name for p in parameters]))
        assert node.set_parameters_atomically([Parameter("a", value=2)]).successful
        assert node.get_parameter("b").value == 5
        assert after == [["a", "b"]]

    def test_each_is_set_together_with_what_is_added_to_it(self, node: Node) -> None:
        node.declare_parameters("", [("a", 1), ("b", 1), ("c", 1)])
        node.add_pre_set_parameters_callback(lambda given: [*given, Parameter("b", value=given[0].value)])
        node.add_on_set_parameters_callback(
            lambda given: SetParametersResult(successful=all(each.name != "c" for each in given))
        )
        results = node.set_parameters([Parameter("a", value=2), Parameter("c", value=9)])
        assert [result.successful for result in results] == [True, False]
        assert [node.get_parameter(name).value for name in "abc"] == [2, 2, 1]

    def test_a_callback_that_leaves_nothing_refuses(self, node: Node) -> None:
        node.declare_parameter("a", 1)
        node.add_pre_set_parameters_callback(lambda parameters: [])
        (result,) = node.set_parameters([Parameter("a", value=2)])
        assert not result.successful
        assert "pre_set" in result.reason

    def test_changes_are_published(self, graph: Graph) -> None:
        listener = create_graph_node(graph, "listener")
        events: list[ParameterEvent] = []
        listener.create_subscription(ParameterEvent, "/parameter_events", events.append, 100)
        graph.advance(1_500_000_000)
        node = create_graph_node(graph, "node", "/ns")
        node.declare_parameter("p", 1)
        node.set_parameters([Parameter("p", value=2)])
        graph.run_due()
        mine = [event for event in events if event.node == "/ns/node"]
        assert [parameter.name for event in mine for parameter in event.new_parameters] == [
            "use_sim_time",
            "p",
        ]
        assert mine[-1].changed_parameters[0].value.integer_value == 2
        assert mine[-1].stamp.nanosec == 500_000_000


class TestCommandLine:
    def test_a_value_given_takes_the_defaults_place(self, graph: Graph) -> None:
        node = node_with(graph, "-p", "speed:=0.5", "-p", "name:=bot", "-p", "walls:=[1, 2]")
        assert node.declare_parameter("speed", 1.0).value == 0.5
        assert node.declare_parameter("name", "x").value == "bot"
        assert node.declare_parameter("walls", [0]).value == [1, 2]
        assert node.declare_parameter("free").value is None

    def test_it_can_be_ignored(self, graph: Graph) -> None:
        assert node_with(graph, "-p", "p:=5").declare_parameter("p", 1, ignore_override=True).value == 1

    def test_a_whole_number_for_a_double_is_refused_as_in_ros(self, graph: Graph) -> None:
        node = node_with(graph, "-p", "speed:=1")
        with pytest.raises(
            InvalidParameterTypeException, match="'1' of type 'INTEGER', expecting type 'DOUBLE'"
        ):
            node.declare_parameter("speed", 1.0)

    def test_it_can_be_meant_for_one_node(self, graph: Graph) -> None:
        arguments = ("-p", "left:speed:=1.0", "-p", "right:speed:=2.0")
        speeds = [
            node_with(graph, *arguments, name=name).declare_parameter("speed", 0.0).value
            for name in ("left", "right", "up")
        ]
        assert speeds == [1.0, 2.0, 0.0]

    def test_what_the_program_gives_wins(self, graph: Graph) -> None:
        node = node_with(graph, "-p", "p:=1", parameter_overrides=[Parameter("p", value=2)])
        assert node.declare_parameter("p", 0).value == 2

    def test_all_that_is_given_can_be_declared(self, graph: Graph) -> None:
        node = node_with(graph, "-p", "a.b:=1", automatically_declare_parameters_from_overrides=True)
        assert node.get_parameter("a.b").value == 1

    def test_a_file_with_wildcards_and_nested_names(self, graph: Graph, tmp_path: Path) -> None:
        file = tmp_path / "params.yaml"
        file.write_text(
            "/**:\n  ros__parameters:\n    speed: 0.1\n    deep: {er: {est: 3}}\n    yes_text: 'yes'\n    flag: on\n"
            "node:\n  ros__parameters: {speed: 0.2}\n"
            "/ns:\n  node:\n    ros__parameters: {speed: 0.3}\n"
        )
        node = node_with(graph, "--params-file", str(file))
        assert node.declare_parameter("speed", 0.0).value == 0.2
        assert node.declare_parameter("deep.er.est", 0).value == 3
        assert node.declare_parameter("yes_text", "").value == "yes"
        assert node.declare_parameter("flag", False).value is True
        far = node_with(graph, "--params-file", str(file), "-r", "__ns:=/ns")
        assert far.declare_parameter("speed", 0.0).value == 0.3
        assert (
            node_with(graph, "--params-file", str(file), name="other").declare_parameter("speed", 0.0).value
            == 0.1
        )
        later = node_with(graph, "--params-file", str(file), "-p", "speed:=0.9")
        assert later.declare_parameter("speed", 0.0).value == 0.9


@every_case("text", ["012", "-010", "[1, 017]", "08", "1_000", "1:30", "[1.0, 1:30.5]", "0b11"])
def test_a_number_that_can_be_read_in_two_ways_is_refused(text: str) -> None:
    """By YAML 1.1 it is another number, or one at all."""
    for read in (get_parameter_value, parse_value):
        with pytest.raises(AmbiguousValue, match="two ways"):
            read(text)


@every_case(
    ("text", "value"),
    [
        ("007", 7),
        ("'012'", "012"),
        ("'1_000'", "1_000"),
        ("00:11:22:33", "00:11:22:33"),
        ("_1", "_1"),
        ("1", 1),
        ("-1", -1),
        ("0x10", 16),
        ("1.0", 1.0),
        ("1e-3", 0.001),
        (".5", 0.5),
        (".inf", float("inf")),
        ("-.INF", float("-inf")),
        ("inf", "inf"),
        ("1e999", "1e999"),
        ("[.inf, 1]", [float("inf"), 1.0]),
        ("true", True),
        ("off", False),
        ("'1'", "1"),
        ('"true"', "true"),
        ("hello", "hello"),
        ("", ""),
        ("[1, 2]", [1, 2]),
        ("[1, 2.5]", [1.0, 2.5]),
        ("[a, b]", ["a", "b"]),
        ("[]", []),
        ("{a: 1}", "{a: 1}"),
        ("[1", "[1"),
        ("[1, a]", "[1, a]"),
    ],
)
def test_a_text_means_a_value(text: str, value: Any) -> None:
    found = parameter_value_to_python(get_parameter_value(text))
    assert (found, type(found)) == (value, type(value))


class TestServices:
    """What ``ros2 param`` asks for."""

    def ask(self, graph: Graph, definition: Any, name: str, **fields: Any) -> Any:
        client = create_graph_node(graph, "asker").create_client(definition, f"/ns/node/{name}")
        future = client.call_async(definition.Request(**fields))
        graph.run_due()
        return future.result()

    @pytest.fixture
    def served(self, graph: Graph) -> Node:
        node = create_graph_node(graph, "node", "/ns")
        node.declare_parameter("speed", 1.0, ParameterDescriptor(description="m/s"))
        return node

    def test_list_get_types_describe(self, graph: Graph, served: Node) -> None:
        assert self.ask(graph, ListParameters, "list_parameters").result.names == ["use_sim_time", "speed"]
        values = self.ask(graph, GetParameters, "get_parameters", names=["speed", "nothing"]).values
        assert [parameter_value_to_python(value) for value in values] == [1.0, None]
        types = self.ask(graph, GetParameterTypes, "get_parameter_types", names=["speed"]).types
        assert list(types) == [Type.DOUBLE.value]
        (described,) = self.ask(graph, DescribeParameters, "describe_parameters", names=["speed"]).descriptors
        assert (described.name, described.description) == ("speed", "m/s")

    def test_set(self, graph: Graph, served: Node) -> None:
        messages = [
            Parameter("speed", value=2.0).to_parameter_msg(),
            Parameter("nothing", value=1).to_parameter_msg(),
            Parameter("speed", value="fast").to_parameter_msg(),
        ]
        results = self.ask(graph, SetParameters, "set_parameters", parameters=messages).results
        assert [result.successful for result in results] == [True, False, False]
        assert "undeclared" in results[1].reason
        assert served.get_parameter("speed").value == 2.0

    def test_set_atomically(self, graph: Graph, served: Node) -> None:
        messages = [
            Parameter("speed", value=2.0).to_parameter_msg(),
            Parameter("x", value=1).to_parameter_msg(),
        ]
        result = self.ask(
            graph, SetParametersAtomically, "set_parameters_atomically", parameters=messages
        ).result
        assert not result.successful
        assert served.get_parameter("speed").value == 1.0

    def test_they_can_be_left_out(self, graph: Graph) -> None:
        Node("node", context=context_of(graph), start_parameter_services=False)
        assert graph.directory.services == {}


class TestParameter:
    def test_type_and_value_must_agree(self) -> None:
        with pytest.raises(ValueError, match="do not agree"):
            Parameter("p", Type.STRING, 5)
        with pytest.raises(TypeError):
            Parameter("p", "STRING", "x")

    def test_an_unknown_type_in_a_message(self) -> None:
        message = Parameter("p", value=1).to_parameter_msg()
        message.value.type = 77
        with pytest.raises(RuntimeError, match="77"):
            parameter_value_to_python(message.value)
