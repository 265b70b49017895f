"""ParameterEventHandler: functions that are called when parameters of any node change."""

from __future__ import annotations

import pytest

from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node
from kit.ros.parameters.parameter import Parameter, parameter_value_to_python
from kit.ros.parameters.parameter_event_handler import ParameterEventHandler


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
