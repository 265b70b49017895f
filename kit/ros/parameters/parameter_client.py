"""Reads, sets and watches the parameters of other nodes: rclpy's ``AsyncParameterClient`` and ``ParameterEventHandler``."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any

from kit.msg.rcl_interfaces import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    ListParameters,
    ParameterEvent,
    SetParameters,
    SetParametersAtomically,
)
from kit.msg.rcl_interfaces import Parameter as ParameterMessage
from kit.ros.execution.callback_groups import CallbackGroup
from kit.ros.execution.task import Future
from kit.ros.graph.graph import Graph
from kit.ros.node.client import Client
from kit.ros.node.node import Node, create_graph_node
from kit.ros.node.qos import QoSProfile, qos_profile_parameter_events, qos_profile_services_default
from kit.ros.node.time import S_TO_NS
from kit.ros.parameters.parameter import Parameter
from kit.ros.parameters.parameter_files import parameter_dict_from_yaml_file

DoneCallback = Callable[["Future[Any]"], Any]


class AsyncParameterClient:
    """Reads and sets the parameters of the node ``remote_node_name``. Every request returns a future at once;
    ``callback(future)`` is called when its response has come."""

    def __init__(
        self,
        node: Node,
        remote_node_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> None:
        self.remote_node_name = remote_node_name
        self.node = node

        def client(definition: Any, name: str) -> Client[Any, Any]:
            return node.create_client(
                definition,
                f"{remote_node_name}/{name}",
                qos_profile=qos_profile,
                callback_group=callback_group,
            )

        self._get = client(GetParameters, "get_parameters")
        self._list = client(ListParameters, "list_parameters")
        self._set = client(SetParameters, "set_parameters")
        self._types = client(GetParameterTypes, "get_parameter_types")
        self._describe = client(DescribeParameters, "describe_parameters")
        self._set_atomically = client(SetParametersAtomically, "set_parameters_atomically")

    @property
    def _clients(self) -> tuple[Client[Any, Any], ...]:
        return (self._list, self._set, self._get, self._types, self._describe, self._set_atomically)

    def services_are_ready(self) -> bool:
        """True if the other node serves all six."""
        return all(client.service_is_ready() for client in self._clients)

    def wait_for_services(self, timeout_sec: float | None = None) -> bool:
        """Waits until it does; True if so. ``timeout_sec`` None or negative: without a limit."""
        graph = self.node.handle.graph
        has_limit = timeout_sec is not None and timeout_sec >= 0
        until = graph.now_ns + int((timeout_sec or 0) * S_TO_NS) if has_limit else None
        for client in self._clients:
            rest = None if until is None else max(0, until - graph.now_ns) / S_TO_NS
            if not client.wait_for_service(rest):
                return False
        return True

    def list_parameters(
        self,
        prefixes: Sequence[str] | None = None,
        depth: int | None = None,
        callback: DoneCallback | None = None,
    ) -> Future[Any]:
        """The names under the prefixes, at most ``depth`` parts below them; None: all."""
        request = ListParameters.Request(prefixes=list(prefixes or ()), depth=depth or 0)
        return _call(self._list, request, callback)

    def get_parameters(self, names: Sequence[str], callback: DoneCallback | None = None) -> Future[Any]:
        """The values; of type NOT_SET for a name that is not declared."""
        return _call(self._get, GetParameters.Request(names=list(names)), callback)

    def describe_parameters(self, names: Sequence[str], callback: DoneCallback | None = None) -> Future[Any]:
        return _call(self._describe, DescribeParameters.Request(names=list(names)), callback)

    def get_parameter_types(self, names: Sequence[str], callback: DoneCallback | None = None) -> Future[Any]:
        return _call(self._types, GetParameterTypes.Request(names=list(names)), callback)

    def set_parameters(
        self, parameters: Sequence[Parameter | ParameterMessage], callback: DoneCallback | None = None
    ) -> Future[Any]:
        """Sets one after the other; the response has a result for each."""
        return _call(self._set, SetParameters.Request(parameters=_as_messages(parameters)), callback)

    def set_parameters_atomically(
        self, parameters: Sequence[Parameter | ParameterMessage], callback: DoneCallback | None = None
    ) -> Future[Any]:
        """Sets all or none."""
        request = SetParametersAtomically.Request(parameters=_as_messages(parameters))
        return _call(self._set_atomically, request, callback)

    def delete_parameters(self, names: Sequence[str], callback: DoneCallback | None = None) -> Future[Any]:
        """Takes the values of parameters away, where their types allow that."""
        return self.set_parameters([Parameter(name) for name in names], callback)

    def load_parameter_file(
        self, parameter_file: str, use_wildcard: bool = False, callback: DoneCallback | None = None
    ) -> Future[Any]:
        """Sets the values that a YAML file has for the other node; ``use_wildcard``: also those under ``/**``."""
        return self.set_parameters(self._read_file(parameter_file, use_wildcard), callback)

    def load_parameter_file_atomically(
        self, parameter_file: str, use_wildcard: bool = False, callback: DoneCallback | None = None
    ) -> Future[Any]:
        """Sets the parameters of ``load_parameter_file``, all or none."""
        return self.set_parameters_atomically(self._read_file(parameter_file, use_wildcard), callback)

    def _read_file(self, parameter_file: str, use_wildcard: bool) -> list[ParameterMessage]:
        found = parameter_dict_from_yaml_file(parameter_file, use_wildcard, [self.remote_node_name])
        return list(found.values())


def _as_messages(parameters: Sequence[Parameter | ParameterMessage]) -> list[ParameterMessage]:
    return [
        parameter.to_parameter_msg() if isinstance(parameter, Parameter) else parameter
        for parameter in parameters
    ]


def _call(client: Client[Any, Any], request: Any, callback: DoneCallback | None) -> Future[Any]:
    future = client.call_async(request)
    if callback is not None:
        future.add_done_callback(callback)
    return future


ParameterCallback = Callable[[ParameterMessage], Any]
EventCallback = Callable[[ParameterEvent], Any]


@dataclass(frozen=True, eq=False, slots=True)
class ParameterCallbackHandle:
    """A callback for one parameter of one node."""

    parameter_name: str
    node_name: str
    callback: ParameterCallback


@dataclass(frozen=True, eq=False, slots=True)
class ParameterEventCallbackHandle:
    """A callback for every change of parameters."""

    callback: EventCallback


class ParameterEventHandler:
    """Listens on ``/parameter_events``, where every node tells which of its parameters have been declared or set.

    Callbacks are called newest first: those for single parameters, then those for whole events.
    """

    def __init__(
        self,
        node: Node,
        qos_profile: QoSProfile = qos_profile_parameter_events,
        callback_group: CallbackGroup | None = None,
        event_callbacks: Any = None,
        qos_overriding_options: Any = None,
        raw: bool = False,
    ) -> None:
        """``raw`` has no effect: events are read before they are handled."""
        self.node, self.qos_profile = node, qos_profile
        self._parameter_handles: list[ParameterCallbackHandle] = []
        self._event_handles: list[ParameterEventCallbackHandle] = []
        self._nodes: frozenset[str] = frozenset()
        self.parameter_event_subscription = node.create_subscription(
            ParameterEvent,
            "/parameter_events",
            self._on_event,
            qos_profile,
            callback_group=callback_group,
            event_callbacks=event_callbacks,
            qos_overriding_options=qos_overriding_options,
        )

    def destroy(self) -> None:
        """Stops listening."""
        self.node.destroy_subscription(self.parameter_event_subscription)

    def add_parameter_callback(
        self, parameter_name: str, node_name: str, callback: ParameterCallback
    ) -> ParameterCallbackHandle:
        """Has ``callback(parameter)`` called when this parameter of this node has been declared or set.

        A node's name without a slash is in the namespace of the handler's own node; an empty one means that node.
        """
        handle = ParameterCallbackHandle(parameter_name, self._full_name(node_name), callback)
        self._parameter_handles.insert(0, handle)
        return handle

    def remove_parameter_callback(self, handle: ParameterCallbackHandle) -> None:
        """Undoes ``add_parameter_callback``. Raises RuntimeError if it is undone already."""
        _remove(self._parameter_handles, handle)

    def add_parameter_event_callback(self, callback: EventCallback) -> ParameterEventCallbackHandle:
        """Has ``callback(event)`` called for every event."""
        handle = ParameterEventCallbackHandle(callback)
        self._event_handles.insert(0, handle)
        return handle

    def remove_parameter_event_callback(self, handle: ParameterEventCallbackHandle) -> None:
        """Undoes ``add_parameter_event_callback``. Raises RuntimeError if it is undone already."""
        _remove(self._event_handles, handle)

    def configure_nodes_filter(self, node_names: Iterable[str] | None = None) -> bool:
        """Handles events of these nodes only, named in full; without names, of all. Returns whether that is possible."""
        self._nodes = frozenset(node_names or ())
        return True

    @staticmethod
    def get_parameter_from_event(
        event: ParameterEvent, parameter_name: str, node_name: str
    ) -> ParameterMessage | None:
        """The parameter of this name, if the event is this node's and tells of it."""
        if event.node != node_name:
            return None
        changed = ParameterEventHandler.get_parameters_from_event(event)
        return next((each for each in changed if each.name == parameter_name), None)

    @staticmethod
    def get_parameters_from_event(event: ParameterEvent) -> Iterator[ParameterMessage]:
        """The parameters that have been declared or set, without those removed."""
        return chain(event.new_parameters, event.changed_parameters)

    def _on_event(self, event: ParameterEvent) -> None:
        if self._nodes and event.node not in self._nodes:
            return
        for handle in list(self._parameter_handles):
            parameter = self.get_parameter_from_event(event, handle.parameter_name, handle.node_name)
            if parameter is not None:
                handle.callback(parameter)
        for each in list(self._event_handles):
            each.callback(event)

    def _full_name(self, name: str) -> str:
        if not name:
            return self.node.get_fully_qualified_name()
        return name if name.startswith("/") else f"{self.node.get_namespace().rstrip('/')}/{name}"


def _remove(handles: list[Any], handle: object) -> None:
    if handle not in handles:
        raise RuntimeError("Callback doesn't exist")
    handles.remove(handle)


class ParameterTuner:
    """Keeps a node's parameters at the numbers wanted, also after the node has been started again. Never waits."""

    def __init__(self, graph: Graph, node: str, namespace: str = "") -> None:
        self._node = create_graph_node(graph, f"{node}_tuner", namespace)
        self._client = AsyncParameterClient(self._node, node)
        self._sent: dict[str, float] | None = None

    def update(self, wanted: Mapping[str, float]) -> None:
        """Sends a node its changed parameters, and a new node all; call this a few times per second."""
        if not self._client.services_are_ready():
            self._sent = None
        elif self._sent != wanted:
            self._sent = dict(wanted)
            self._client.set_parameters([Parameter(name, value=value) for name, value in wanted.items()])

    def close(self) -> None:
        self._node.destroy_node()
