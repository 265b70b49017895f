"""Keeps a running node's parameters at the values wanted, also after the node has been started again."""

from __future__ import annotations

from collections.abc import Mapping

from kit.msg.rcl_interfaces import Parameter, ParameterType, ParameterValue, SetParameters
from kit.ros.graph.graph import Graph
from kit.ros.node.node import create_graph_node


class ParameterTuner:
    """Sets a node's parameters by its service ``set_parameters``. Never waits; skips a node without the service."""

    def __init__(self, graph: Graph, node: str, namespace: str = "") -> None:
        self._node = create_graph_node(graph, f"{node}_tuner", namespace)
        self._client = self._node.create_client(SetParameters, f"{node}/set_parameters")
        self._sent: dict[str, float] | None = None

    def update(self, wanted: Mapping[str, float]) -> None:
        """To be called a few times a second: tells the node what has changed, and a new node everything."""
        if not self._client.service_is_ready():
            self._sent = None
        elif self._sent != wanted:
            self._sent = dict(wanted)
            self._client.call_async(
                SetParameters.Request(
                    parameters=[
                        Parameter(
                            name=name,
                            value=ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=value),
                        )
                        for name, value in wanted.items()
                    ]
                )
            )

    def close(self) -> None:
        self._node.destroy_node()
