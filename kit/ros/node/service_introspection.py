"""Service introspection: a service and its clients publish each request and response, for tools to watch.

The topic is ``<service>/_service_event``. In its messages ``info`` says what has happened, and ``request`` and
``response`` hold at most one message each.
"""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, Any, cast

from kit.msg.interfaces import service_event_class
from kit.msg.message import Message, Service
from kit.ros.graph.directory import ServiceEndpoint
from kit.ros.node.qos import QoSProfile

if TYPE_CHECKING:
    from kit.ros.node.clock import Clock
    from kit.ros.node.publisher import Publisher


class ServiceIntrospectionState(IntEnum):
    """How much of a service's calls is published."""

    OFF = 0
    METADATA = 1
    """Which endpoint has sent or received something, and when."""
    CONTENTS = 2
    """The request or response as well."""


class ServiceEventKind(IntEnum):
    """The values of ``ServiceEventInfo.event_type``."""

    REQUEST_SENT = 0
    REQUEST_RECEIVED = 1
    RESPONSE_SENT = 2
    RESPONSE_RECEIVED = 3


class ServiceEventPublisher:
    """The events of one service or client. It publishes nothing until it is configured."""

    def __init__(self, endpoint: ServiceEndpoint) -> None:
        self._endpoint = endpoint
        self._clock: Clock | None = None
        self._publisher: Publisher[Any] | None = None
        self._state = ServiceIntrospectionState.OFF

    def configure(self, clock: Clock, profile: QoSProfile, state: ServiceIntrospectionState) -> None:
        """Starts publishing, changes what is published, or stops. Raises ValueError for an unknown state."""
        self._state = ServiceIntrospectionState(state)
        self._clock = clock
        self.destroy()
        if self._state is not ServiceIntrospectionState.OFF:
            # The directory's protocol of a node has no methods that make endpoints; every node that may come here has.
            node = cast(Any, self._endpoint.handle.node)
            topic = f"{self._endpoint.service_name}/_service_event"
            srv_type: type[Service] = self._endpoint.srv_type
            self._publisher = node.create_publisher(service_event_class(srv_type), topic, profile)

    def publish(self, kind: ServiceEventKind, client: ServiceEndpoint, number: int, message: Message) -> None:
        """Publishes that ``message`` was sent or received in call ``number`` of ``client``."""
        if self._publisher is None or self._clock is None:
            return
        event = self._publisher.msg_type()
        event.info.event_type = int(kind)
        event.info.stamp = self._clock.now().to_msg()
        event.info.client_gid = list(client.number.to_bytes(16, "big"))
        event.info.sequence_number = number
        if self._state is ServiceIntrospectionState.CONTENTS:
            is_request = kind in (ServiceEventKind.REQUEST_SENT, ServiceEventKind.REQUEST_RECEIVED)
            setattr(event, "request" if is_request else "response", [message])
        self._publisher.publish(event)

    def destroy(self) -> None:
        """Stops publishing."""
        if self._publisher is not None:
            self._publisher.destroy()
            self._publisher = None
