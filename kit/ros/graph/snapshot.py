"""The state of a graph at one instant as frozen records, to draw, list or send.

Counts the messages of a graph per node and topic, with their rates, and keeps the latest message of one topic.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Final, NamedTuple

from kit.msg.conversion import FieldValue, field_values
from kit.msg.message import Message, type_name
from kit.ros.graph.directory import (
    GraphEndpoint,
    GraphNode,
    TopicPublisher,
    TopicSubscription,
    describe_mismatch,
)
from kit.ros.graph.naming import CANCEL_GOAL, STATUS
from kit.ros.node.qos import QoSProfile

if TYPE_CHECKING:
    from kit.ros.graph.graph import Graph


INFRASTRUCTURE_TOPICS: Final = frozenset({"/rosout", "/parameter_events", "/clock", "/tf", "/tf_static"})
INFRASTRUCTURE_SERVICES: Final = frozenset(
    {
        "describe_parameters",
        "get_parameters",
        "get_parameter_types",
        "list_parameters",
        "set_parameters",
        "set_parameters_atomically",
    }
)
"""The parameter services, which every node has under its own name."""


@dataclass(frozen=True, slots=True)
class EndpointState:
    """A publisher or a subscription: its node, type and quality of service."""

    node: str
    """The full name."""
    type: str
    qos: QoSProfile


@dataclass(frozen=True, slots=True)
class EndpointMismatch:
    """A publisher and a subscription of one topic between which no message passes."""

    publisher: str
    subscription: str
    """The full names of their nodes."""
    reason: str


@dataclass(frozen=True, slots=True)
class TopicState:
    name: str
    types: tuple[str, ...]
    publishers: tuple[EndpointState, ...]
    subscriptions: tuple[EndpointState, ...]
    mismatches: tuple[EndpointMismatch, ...]

    @property
    def is_infrastructure(self) -> bool:
        """True for topics that ROS itself uses; of an action, its feedback is not among them."""
        return self.name in INFRASTRUCTURE_TOPICS or self.name.endswith(f"/{STATUS}")


@dataclass(frozen=True, slots=True)
class ServiceState:
    name: str
    types: tuple[str, ...]
    servers: tuple[str, ...]
    clients: tuple[str, ...]
    """The full names of the nodes."""

    @property
    def is_infrastructure(self) -> bool:
        """True for the parameter services; and of an action's services for the one that cancels goals, so that its
        goals, results and feedback are shown."""
        owner, _, last = self.name.rpartition("/")
        return (last in INFRASTRUCTURE_SERVICES and owner in self.servers) or self.name.endswith(
            f"/{CANCEL_GOAL}"
        )


@dataclass(frozen=True, slots=True)
class GraphState:
    """All nodes in the order of their creation; topics and services by name."""

    version: int
    """``Directory.version``: two states with the same version are equal."""
    nodes: tuple[str, ...]
    """Full names; nodes of the same name count once."""
    topics: tuple[TopicState, ...]
    services: tuple[ServiceState, ...]


def snapshot(graph: Graph) -> GraphState:
    """Takes a snapshot of the graph, from any thread."""
    with graph.lock:
        directory = graph.directory
        return GraphState(
            directory.version,
            tuple(dict.fromkeys(handle.full_name for handle in directory.nodes)),
            tuple(
                TopicState(
                    name,
                    tuple(topic.type_names),
                    _endpoint_states(topic.publishers),
                    _endpoint_states(topic.subscriptions),
                    tuple(_mismatches(topic.publishers, topic.subscriptions)),
                )
                for name, topic in sorted(directory.topics.items())
            ),
            tuple(
                _service(graph, name) for name in sorted(directory.services.keys() | directory.clients.keys())
            ),
        )


def _endpoint_states(endpoints: Iterable[GraphEndpoint]) -> tuple[EndpointState, ...]:
    return tuple(
        EndpointState(endpoint.handle.full_name, type_name(endpoint.msg_type), endpoint.qos_profile)
        for endpoint in endpoints
    )


def _mismatches(
    publishers: Iterable[TopicPublisher], subscriptions: Iterable[TopicSubscription]
) -> Iterable[EndpointMismatch]:
    subscriptions = tuple(subscriptions)
    for publisher in publishers:
        for subscription in subscriptions:
            reason = describe_mismatch(publisher, subscription)
            if reason is not None:
                yield EndpointMismatch(publisher.handle.full_name, subscription.handle.full_name, reason)


def _service(graph: Graph, name: str) -> ServiceState:
    servers, clients = graph.directory.services.get(name, []), graph.directory.clients.get(name, [])
    types = {type_name(endpoint.srv_type) for endpoint in servers} | {
        type_name(endpoint.srv_type) for endpoint in clients
    }
    return ServiceState(
        name,
        tuple(sorted(types)),
        tuple(dict.fromkeys(endpoint.handle.full_name for endpoint in servers)),
        tuple(dict.fromkeys(endpoint.handle.full_name for endpoint in clients)),
    )


RATE_WINDOW: Final = 50
"""Number of messages over which a rate is averaged."""

SILENT_AFTER: Final = 3.0
"""A flow is silent after this many of its own periods, or after so many seconds if that is longer."""


class MessageFlow(NamedTuple):
    """The messages of one node on one topic or service."""

    node: str
    """Full name of the node."""
    name: str
    """Name of the topic or service."""
    is_service: bool = False
    response_to: str | None = None
    """For the responses of a service: the node that sent the request."""


@dataclass(frozen=True, slots=True)
class FlowStats:
    """Number and rate of the messages of a flow."""

    count: int
    rate: float | None
    """Messages per second of the graph's time; None while it is silent or too new."""


@dataclass(slots=True)
class _FlowCounter:
    count: int = 0
    times: deque[int] = field(default_factory=lambda: deque(maxlen=RATE_WINDOW))
    """Times of the last messages [ns]."""

    def add(self, time_ns: int) -> None:
        times = self.times
        if times and time_ns < times[-1]:  # time has jumped back
            times.clear()
        self.count += 1
        times.append(time_ns)

    def rate(self, now_ns: int) -> float | None:
        times = self.times
        if len(times) < 2 or times[-1] == times[0]:
            return None
        period = (times[-1] - times[0]) / (len(times) - 1)
        if not 0 <= now_ns - times[-1] <= max(SILENT_AFTER * period, SILENT_AFTER * 1e9):
            return None
        return 1e9 / period


HISTORY: Final = 300
"""Messages of the selected topic whose numbers are kept."""


class FieldSample(NamedTuple):
    """The numbers of one message."""

    time_ns: int
    """When it was published, in the graph's time [ns]."""
    values: Mapping[str, FieldValue]
    """Values by path, as ``kit.msg.conversion`` names them."""


class TopicStats:
    """Counts the messages of a graph until ``stop()``. May be read from any thread."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self._counters: dict[MessageFlow, _FlowCounter] = {}
        self._requesters: dict[str, deque[str]] = {}
        self._selected: str | None = None
        self._latest_message: Message | None = None
        self._history: deque[FieldSample] = deque(maxlen=HISTORY)
        self.stop = graph.add_message_listener(self._count_message)

    def select(self, name: str | None) -> None:
        """Chooses the topic or service whose latest message and history are kept."""
        with self.graph.lock:
            if name != self._selected:
                self._selected, self._latest_message = name, None
                self._history.clear()

    @property
    def latest_message(self) -> Message | None:
        """The latest message of the selected topic, request or response of the service, since it was selected: a
        copy, not to be changed."""
        return self._latest_message

    def history(self) -> tuple[FieldSample, ...]:
        """The numbers of the last ``HISTORY`` messages of the selected topic since it was selected, oldest first.
        A reset of the time starts it again."""
        with self.graph.lock:
            return tuple(self._history)

    def flow_stats(self) -> Mapping[MessageFlow, FlowStats]:
        """Number and rate of all flows since the beginning."""
        with self.graph.lock:
            now = self.graph.now_ns
            return MappingProxyType(
                {
                    flow: FlowStats(counter.count, counter.rate(now))
                    for flow, counter in self._counters.items()
                }
            )

    def _count_message(self, time_ns: int, node: GraphNode, name: str, message: Message) -> None:
        """Called for every message with the graph's lock held, so it must be quick."""
        flow = self._flow(node.handle.full_name, name, type_name(type(message)))
        counter = self._counters.get(flow)
        if counter is None:
            counter = self._counters[flow] = _FlowCounter()
        counter.add(time_ns)
        if name == self._selected:
            self._latest_message = message.__deepcopy__(None)
            if self._history and time_ns < self._history[-1].time_ns:  # time has jumped back
                self._history.clear()
            self._history.append(FieldSample(time_ns, field_values(message)))

    def _flow(self, sender: str, name: str, kind: str) -> MessageFlow:
        if kind.endswith("_Request"):
            self._requesters.setdefault(name, deque(maxlen=RATE_WINDOW)).append(sender)
            return MessageFlow(sender, name, is_service=True)
        if kind.endswith("_Response"):
            waiting = self._requesters.get(name)
            return MessageFlow(
                sender, name, is_service=True, response_to=waiting.popleft() if waiting else None
            )
        return MessageFlow(sender, name)
