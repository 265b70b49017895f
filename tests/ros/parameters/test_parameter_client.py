"""AsyncParameterClient with the parameter files that it reads, and ParameterEventHandler."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node, create_graph_node
from kit.ros.parameters.parameter import Parameter, parameter_value_to_python
from kit.ros.parameters.parameter_client import AsyncParameterClient, ParameterEventHandler, ParameterTuner
from kit.ros.parameters.parameter_files import parameter_dict_from_yaml_file

FILE = """
robot:
  ros__parameters: {speed: 1.5, name: r2}
/**:
  ros__parameters: {level: 3}
other:
  ros__parameters: {speed: 9.0}
"""


@pytest.fixture
def server(graph: Graph) -> Node:
    node = create_graph_node(graph, "robot")
    node.declare_parameter("speed", 0.5)
    node.declare_parameter("name", "")
    return node


@pytest.fixture
def client(graph: Graph) -> AsyncParameterClient:
    return AsyncParameterClient(create_graph_node(graph, "asking"), "robot")


@pytest.fixture
def file(tmp_path: Path) -> str:
    path = tmp_path / "robot.yaml"
    path.write_text(FILE)
    return str(path)


def test_it_knows_whether_the_node_is_there(graph: Graph, client: AsyncParameterClient) -> None:
    assert not client.services_are_ready()
    create_graph_node(graph, "robot")
    assert client.services_are_ready()
    assert client.wait_for_services(timeout_sec=0)


def test_it_reads_and_sets(graph: Graph, client: AsyncParameterClient, server: Node) -> None:
    done: list[Any] = []
    change = client.set_parameters(
        [Parameter("speed", value=2.0), Parameter("name", value="x").to_parameter_msg()], callback=done.append
    )
    wrong = client.set_parameters_atomically([Parameter("speed", value="fast")])
    values = client.get_parameters(["speed", "nothing"])
    types = client.get_parameter_types(["name"])
    names = client.list_parameters(["speed"])
    about = client.describe_parameters(["speed"])
    graph.run_due()
    assert done == [change]
    assert [result.successful for result in change.result().results] == [True, True]
    assert not wrong.result().result.successful
    assert [parameter_value_to_python(value) for value in values.result().values] == [2.0, None]
    assert list(types.result().types) == [Parameter.Type.STRING.value]
    assert names.result().result.names == ["speed"]
    assert about.result().descriptors[0].name == "speed"
    assert server.get_parameter("speed").value == 2.0


def test_it_loads_a_file(graph: Graph, client: AsyncParameterClient, server: Node, file: str) -> None:
    loaded = client.load_parameter_file(file)
    graph.run_due()
    assert all(result.successful for result in loaded.result().results)
    assert (server.get_parameter("speed").value, server.get_parameter("name").value) == (1.5, "r2")


def test_a_file_as_messages(file: str) -> None:
    def read(*arguments: Any, **options: Any) -> dict[str, Any]:
        found = parameter_dict_from_yaml_file(file, *arguments, **options)
        assert all(message.name == name for name, message in found.items())
        return {name: parameter_value_to_python(message.value) for name, message in found.items()}

    assert read(target_nodes=["/robot"]) == {"speed": 1.5, "name": "r2"}
    assert read(True, ["robot"]) == {"speed": 1.5, "name": "r2", "level": 3}
    assert read(target_nodes=["other"], namespace="a") == {"a.speed": 9.0}
    assert read() == {"speed": 9.0, "name": "r2"}
    with pytest.raises(RuntimeError, match="no parameters for /nobody"):
        read(target_nodes=["nobody"])


def test_changes_of_own_and_other_nodes_are_told() -> None:
    graph, told = Graph(), []
    own, other = create_graph_node(graph, "own"), create_graph_node(graph, "other", namespace="/far")
    handler = ParameterEventHandler(own)

    def note(parameter: object) -> None:
        told.append((parameter.name, parameter_value_to_python(parameter.value)))

    handler.add_parameter_callback("speed", "", note)
    first = handler.add_parameter_callback("speed", "/far/other", note)
    events = []
    whole = handler.add_parameter_event_callback(lambda event: events.append(event.node))
    own.declare_parameter("speed", 1.0)
    own.declare_parameter("name", "a")
    other.declare_parameter("speed", 2.0)
    graph.run_due()
    other.set_parameters([Parameter("speed", value=3.0)])
    graph.run_due()
    assert told == [("speed", 1.0), ("speed", 2.0), ("speed", 3.0)]
    assert events == ["/own", "/own", "/far/other", "/far/other"]

    handler.remove_parameter_callback(first)
    handler.remove_parameter_event_callback(whole)
    with pytest.raises(RuntimeError):
        handler.remove_parameter_callback(first)
    own.set_parameters([Parameter("speed", value=4.0)])
    other.set_parameters([Parameter("speed", value=5.0)])
    graph.run_due()
    assert told[3:] == [("speed", 4.0)]
    assert len(events) == 4

    assert handler.configure_nodes_filter(["/far/other"])
    own.set_parameters([Parameter("speed", value=6.0)])
    graph.run_due()
    assert len(told) == 4
    handler.configure_nodes_filter()
    handler.destroy()
    own.set_parameters([Parameter("speed", value=7.0)])
    graph.run_due()
    assert len(told) == 4


def test_a_tuner_tells_also_a_node_that_was_started_again(graph: Graph, server: Node) -> None:
    tuner = ParameterTuner(graph, "robot")

    def speed_of(node: Node, wanted: float) -> float:
        tuner.update({"speed": wanted})
        graph.run_due()
        return float(node.get_parameter("speed").value)

    assert (speed_of(server, 2.0), speed_of(server, 3.0)) == (2.0, 3.0)
    server.destroy_node()
    tuner.update({"speed": 3.0})  # nobody is there to be told
    again = create_graph_node(graph, "robot")
    again.declare_parameter("speed", 0.5)
    assert speed_of(again, 3.0) == 3.0
    tuner.close()
    assert again.get_node_names() == ["robot"]
