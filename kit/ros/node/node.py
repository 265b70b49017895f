"""Nodes: they make publishers, subscriptions, services, clients and timers.

Services by which other programs read and set the log levels of a node's loggers.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from types import ModuleType
from typing import TYPE_CHECKING, Any, Self, TypeVar

from kit.msg.interfaces import find_message, find_service
from kit.msg.message import Action, Message, MessageType, ServiceType
from kit.msg.message import Service as ServiceDefinition
from kit.msg.rcl_interfaces import Log as LogMessage
from kit.msg.rcl_interfaces import ParameterEvent
from kit.ros.exceptions import InvalidHandle, NotInitializedException
from kit.ros.execution.arguments import RosArguments, parse_ros_arguments
from kit.ros.execution.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup
from kit.ros.execution.context import Context, context_of, get_default_context
from kit.ros.graph.graph import Graph
from kit.ros.graph.naming import absolute_namespace, validate_namespace, validate_node_name
from kit.ros.log import LoggerSettings, LoggingSeverity, LogRecord, RcutilsLogger
from kit.ros.node.client import Client
from kit.ros.node.clock import Clock, ROSClock
from kit.ros.node.endpoint import Destroyable, GuardCondition, register_entity
from kit.ros.node.events import PublisherEventCallbacks, SubscriptionEventCallbacks
from kit.ros.node.node_handle import NodeGraphMethods, NodeHandle
from kit.ros.node.parameter_methods import NodeParameterMethods
from kit.ros.node.publisher import Publisher
from kit.ros.node.qos import (
    QoSProfile,
    qos_or_depth,
    qos_profile_parameter_events,
    qos_profile_rosout_default,
    qos_profile_services_default,
)
from kit.ros.node.qos_overrides import QoSOverridingOptions, declare_qos_parameters
from kit.ros.node.service import Service
from kit.ros.node.subscription import Subscription
from kit.ros.node.time import S_TO_NS, Time
from kit.ros.node.timer import TIMER_WITHOUT_CALLBACK, Rate, Timer
from kit.ros.parameters.parameter import Parameter
from kit.ros.parameters.parameter_services import ParameterServices
from kit.ros.parameters.parameter_store import ParameterStore

if TYPE_CHECKING:
    from kit.ros.execution.executors import Executor
    from kit.ros.node.waitable import Waitable


class LoggerServices:
    """``~/get_logger_levels`` and ``~/set_logger_levels``, for nodes made with ``enable_logger_service``."""

    def __init__(self, log: LoggerSettings, create_service: Callable[..., object]) -> None:
        self._log = log
        self._level = find_message("rcl_interfaces/msg/LoggerLevel")
        self._result = find_message("rcl_interfaces/msg/SetLoggerLevelsResult")
        create_service(
            find_service("rcl_interfaces/srv/GetLoggerLevels"), "~/get_logger_levels", self._get_levels
        )
        create_service(
            find_service("rcl_interfaces/srv/SetLoggerLevels"), "~/set_logger_levels", self._set_levels
        )

    def _get_levels(self, request: Any, response: Any) -> Any:
        response.levels = [
            self._level(name=name, level=int(self._log.levels.get(name, LoggingSeverity.UNSET)))
            for name in request.names
        ]
        return response

    def _set_levels(self, request: Any, response: Any) -> Any:
        response.results = [self._set_level(entry.name, entry.level) for entry in request.levels]
        return response

    def _set_level(self, name: str, level: int) -> Any:
        try:
            self._log.set_level(name, LoggingSeverity(level))
        except ValueError:
            return self._result(successful=False, reason=f"there is no log level {level}")
        return self._result(successful=True)


HIDDEN_NODE_PREFIX = "_"
"""Lists leave nodes out whose name begins with it."""

M = TypeVar("M", bound=Message)


class Node(NodeGraphMethods, NodeParameterMethods):
    """A program's participant in the graph: it has publishers, subscriptions, services, clients, timers, parameters.

    Its callbacks run in lock-step with the graph, or wherever an executor spins it.
    """

    def __init__(
        self,
        node_name: str,
        *,
        context: Context | None = None,
        cli_args: list[str] | None = None,
        namespace: str | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        start_parameter_services: bool = True,
        parameter_overrides: list[Parameter] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        enable_logger_service: bool = False,
    ) -> None:
        context = context or get_default_context()
        if not context.ok():
            raise NotInitializedException("cannot create node")
        arguments = parse_ros_arguments(cli_args or ())
        if use_global_arguments:
            arguments = arguments.followed_by(context.arguments)
        self.__handle = _make_handle(self, context, arguments, node_name, namespace)
        handle = self.__handle
        self.__group = MutuallyExclusiveCallbackGroup()
        self.__clock = ROSClock(handle.graph)
        overrides = arguments.parameters_of(handle.name, handle.namespace)
        overrides |= {parameter.name: parameter for parameter in parameter_overrides or ()}
        handle.logger = RcutilsLogger(handle.logger_name, handle.graph.log)
        handle.parameters = ParameterStore(overrides, allow_undeclared=allow_undeclared_parameters)
        handle.graph.directory.add_node(handle)
        if enable_rosout:
            rosout = self.create_publisher(LogMessage, "/rosout", qos_profile_rosout_default)
            handle.logger.publish = lambda record: rosout.publish_without_copy(_as_message(record))
        events = self.create_publisher(ParameterEvent, "/parameter_events", qos_profile_parameter_events)
        handle.parameters.publish_event = lambda event: _publish_event(handle, events, event)
        self.declare_parameter("use_sim_time", handle.graph.is_simulated)
        if start_parameter_services:
            ParameterServices(self, self.create_service)
        if enable_logger_service:
            LoggerServices(handle.graph.log, self.create_service)
        if automatically_declare_parameters_from_overrides:
            rest = [(name, entry.value) for name, entry in overrides.items() if not self.has_parameter(name)]
            self.declare_parameters("", rest, ignore_override=True)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy_node()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.__handle.full_name}>"

    # Properties

    @property
    def handle(self) -> NodeHandle:
        """The internal record of the node."""
        return self.__handle

    @property
    def context(self) -> Context:
        return self.__handle.context

    @property
    def executor(self) -> Executor | None:
        """The executor that it was added to last, or None."""
        return self.__handle.executor

    @executor.setter
    def executor(self, new_executor: Executor | None) -> None:
        current = self.__handle.executor
        if current is new_executor:
            return
        if current is not None:
            current.remove_node(self)
        if new_executor is not None:
            new_executor.add_node(self)

    @property
    def default_callback_group(self) -> CallbackGroup:
        return self.__group

    @property
    def publishers(self) -> Iterator[Publisher[Any]]:
        yield from self.__handle.publishers

    @property
    def subscriptions(self) -> Iterator[Subscription[Any]]:
        yield from self.__handle.subscriptions

    @property
    def clients(self) -> Iterator[Client[Any, Any]]:
        yield from self.__handle.clients

    @property
    def services(self) -> Iterator[Service[Any, Any]]:
        yield from self.__handle.services

    @property
    def timers(self) -> Iterator[Timer]:
        yield from self.__handle.timers

    @property
    def waitables(self) -> Iterator[Waitable[Any]]:
        yield from (item.waitable for item in self.__handle.waitables)

    @property
    def guards(self) -> Iterator[GuardCondition]:
        yield from self.__handle.guards

    def get_name(self) -> str:
        return self.__handle.name

    def get_namespace(self) -> str:
        return self.__handle.namespace

    def get_fully_qualified_name(self) -> str:
        return self.__handle.full_name

    def get_clock(self) -> Clock:
        return self.__clock

    def get_logger(self) -> RcutilsLogger:
        return self.__handle.logger

    # Making entities

    def create_publisher(
        self,
        msg_type: type[M],
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: PublisherEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        publisher_class: type[Publisher[M]] = Publisher,
    ) -> Publisher[M]:
        """A publisher; a number for ``qos_profile`` is its depth.

        Raises InvalidTopicNameException, TypeError or ValueError for what is wrong with the arguments.
        """
        handle, profile = self.__existing_handle(), qos_or_depth(qos_profile)
        _check_type(msg_type, MessageType, "message", "String from std_msgs.msg")
        name = self.resolve_topic_name(topic)
        if qos_overriding_options is not None:
            profile = declare_qos_parameters("publisher", self, name, profile, qos_overriding_options)
        publisher = publisher_class(
            handle,
            msg_type,
            name,
            profile,
            event_callbacks,
            callback_group or self.__group,
        )
        handle.publishers.append(publisher)
        with handle.graph.lock:
            handle.graph.directory.note_endpoint()
        return publisher

    def create_subscription(
        self,
        msg_type: type[M],
        topic: str,
        callback: Callable[..., Any],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
    ) -> Subscription[M]:
        """A subscription that calls ``callback(message)``; a number for ``qos_profile`` is its depth.

        ``raw``: the callback gets the message as bytes (CDR); ``rclpy.serialization`` reads them.

        Raises InvalidTopicNameException, TypeError or ValueError for what is wrong with the arguments.
        """
        handle, profile = self.__existing_handle(), qos_or_depth(qos_profile)
        _check_type(msg_type, MessageType, "message", "String from std_msgs.msg")
        name = self.resolve_topic_name(topic)
        if qos_overriding_options is not None:
            profile = declare_qos_parameters("subscription", self, name, profile, qos_overriding_options)
        subscription = Subscription(
            handle,
            msg_type,
            name,
            callback,
            callback_group or self.__group,
            profile,
            event_callbacks,
            raw=raw,
        )
        register_entity(handle.subscriptions, subscription)
        with handle.graph.lock:
            handle.graph.directory.note_endpoint()
        return subscription

    def create_client(
        self,
        srv_type: type[ServiceDefinition],
        srv_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Client[Any, Any]:
        """A client. Raises InvalidServiceNameException, TypeError."""
        handle = self.__existing_handle()
        _check_type(srv_type, ServiceType, "service", "Trigger from std_srvs.srv")
        name = self.resolve_service_name(srv_name)
        client: Client[Any, Any] = Client(handle, srv_type, name, callback_group or self.__group, qos_profile)
        return register_entity(handle.clients, client)

    def create_service(
        self,
        srv_type: type[ServiceDefinition],
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Service[Any, Any]:
        """A service answering with ``callback(request, response)``. Raises InvalidServiceNameException, TypeError."""
        handle = self.__existing_handle()
        _check_type(srv_type, ServiceType, "service", "Trigger from std_srvs.srv")
        name = self.resolve_service_name(srv_name)
        group = callback_group or self.__group
        service: Service[Any, Any] = Service(handle, srv_type, name, callback, group, qos_profile)
        return register_entity(handle.services, service)

    def create_timer(
        self,
        timer_period_sec: float,
        callback: Callable[..., Any] | None,
        callback_group: CallbackGroup | None = None,
        clock: Clock | None = None,
        autostart: bool = True,
    ) -> Timer:
        """Calls back every ``timer_period_sec`` seconds, for the first time after one. ValueError if negative."""
        handle = self.__existing_handle()
        period = int(float(timer_period_sec) * S_TO_NS)
        if period < 0:
            raise ValueError(f"timer period must be non-negative, not {timer_period_sec}")
        if callback is None:  # allowed, as in ROS 2, where it stays without a word
            handle.logger.warning(TIMER_WITHOUT_CALLBACK)
        group = callback_group or self.__group
        return register_entity(
            handle.timers, Timer(handle, callback, group, period, clock or self.__clock, autostart=autostart)
        )

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """A rate of ``frequency`` Hz. ValueError if it is not positive."""
        handle = self.__existing_handle()
        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        rate = Rate(handle, int(S_TO_NS / frequency))
        handle.rates.append(rate)
        return rate

    def create_guard_condition(
        self, callback: Callable[[], Any], callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        """A guard condition; any thread may trigger it."""
        handle = self.__existing_handle()
        return register_entity(
            handle.guards, GuardCondition(handle, callback, callback_group or self.__group)
        )

    def add_waitable(self, waitable: Waitable[Any]) -> None:
        """Has the node's executor wait for it too, and execute it."""
        from kit.ros.node.waitable import WaitableItem  # only now: few programs need it

        handle = self.__existing_handle()
        item = WaitableItem(handle, waitable)
        with handle.graph.lock:
            handle.waitables.append(item)
            handle.ready_queue.polled.append(item)
            handle.graph.notify()

    def remove_waitable(self, waitable: Waitable[Any]) -> None:
        """Raises ValueError if it was not added."""
        handle = self.__handle
        item = next((each for each in handle.waitables if each.waitable is waitable), None)
        if item is None:
            raise ValueError(f"{waitable!r} is not a waitable of {handle.full_name}")
        with handle.graph.lock:
            handle.waitables.remove(item)
            handle.ready_queue.polled.remove(item)
            item.discard()

    # Destroying entities

    def destroy_publisher(self, publisher: Publisher[Any]) -> bool:
        """Destroys a publisher; False if it is not this node's. Likewise the others."""
        return _destroy(self.__handle.publishers, publisher)

    def destroy_subscription(self, subscription: Subscription[Any]) -> bool:
        return _destroy(self.__handle.subscriptions, subscription)

    def destroy_client(self, client: Client[Any, Any]) -> bool:
        return _destroy(self.__handle.clients, client)

    def destroy_service(self, service: Service[Any, Any]) -> bool:
        return _destroy(self.__handle.services, service)

    def destroy_timer(self, timer: Timer) -> bool:
        return _destroy(self.__handle.timers, timer)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        return _destroy(self.__handle.guards, guard)

    def destroy_rate(self, rate: Rate) -> bool:
        return _destroy(self.__handle.rates, rate)

    def destroy_node(self) -> None:
        """Removes the node and everything it has entity from the graph."""
        handle = self.__handle
        if handle.destroyed:
            return
        if handle.executor is not None:
            handle.executor.remove_node(self)
        for entity in handle.all_entities():
            entity.destroy()
        for item in list(handle.waitables):
            self.remove_waitable(item.waitable)
        with handle.graph.lock:
            handle.destroyed = True
            handle.graph.directory.remove_node(handle)

    def __existing_handle(self) -> NodeHandle:
        if self.__handle.destroyed:
            raise InvalidHandle(f"cannot use node {self.__handle.full_name}: it has been destroyed")
        return self.__handle


def create_graph_node(graph: Graph, name: str, namespace: str | None = None) -> Node:
    """Makes a plain node in a graph, in the context that the graph's nodes share."""
    return Node(name, context=context_of(graph), namespace=namespace)


def _make_handle(
    node: Node, context: Context, arguments: RosArguments, name: str, namespace: str | None
) -> NodeHandle:
    """A handle with the names after remapping. Raises InvalidNodeNameException, InvalidNamespaceException."""
    validate_node_name(name)
    given = absolute_namespace(namespace)
    validate_namespace(given)
    return NodeHandle(node, context, arguments, arguments.node_name(name), arguments.namespace(name, given))


def check_action_type(interface: object) -> None:
    """Raises TypeError if it is no action class."""
    if not (isinstance(interface, type) and issubclass(interface, Action)):
        raise _wrong_type(interface, "an action", "Fibonacci from example_interfaces.action")


def _check_type(interface: object, expected: type, what: str, example: str) -> None:
    if not isinstance(interface, expected):
        raise _wrong_type(interface, f"a {what}", example)


def _wrong_type(interface: object, what: str, example: str) -> TypeError:
    found = interface.__name__ if isinstance(interface, (type, ModuleType)) else repr(interface)
    return TypeError(f"{what} class is needed here, like {example}, not {found}")


def _destroy(entities: Sequence[Destroyable], entity: Destroyable) -> bool:
    found = entity in entities
    if found:
        entity.destroy()
    return found


def _as_message(record: LogRecord) -> LogMessage:
    """A log line as a ``/rosout`` message."""
    return LogMessage(
        stamp=Time(nanoseconds=record.time_ns).to_msg(),
        level=record.severity.value,
        name=record.name,
        msg=record.text,
        file=record.file,
        function=record.function,
        line=record.line,
    )


def _publish_event(handle: NodeHandle, publisher: Publisher[ParameterEvent], event: ParameterEvent) -> None:
    event.stamp = Time(nanoseconds=handle.graph.now_ns).to_msg()
    event.node = handle.full_name
    publisher.publish_without_copy(event)
