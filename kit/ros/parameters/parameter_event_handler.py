"""Calls functions when parameters change, of any node: rclpy's ``ParameterEventHandler``."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import chain
from typing import TYPE_CHECKING, Any

from kit.msg.rcl_interfaces import Parameter as ParameterMessage
from kit.msg.rcl_interfaces import ParameterEvent
from kit.ros.node.qos import QoSProfile, qos_profile_parameter_events

if TYPE_CHECKING:
    from kit.ros.execution.callback_groups import CallbackGroup
    from kit.ros.node.node import Node

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
