"""The state of a graph at one instant as frozen records, to draw, list or send.

Counts the messages of a graph per node and topic, with their rates, and keeps the latest message of one topic.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from kit.msg.message import type_name
from kit.ros.graph.action_names import CANCEL_GOAL, STATUS
from kit.ros.graph.directory import (
    GraphEndpoint,
    TopicPublisher,
    TopicSubscription,
    describe_mismatch,
)
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
