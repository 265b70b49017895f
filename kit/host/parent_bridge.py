"""The nodes of another process in our graph: proxies here, the real ones over there.

What reaches a proxy waits in ``inbox`` until it is fetched; what the other process tells is checked and done.
How the two talk, and whether one waits for the other, is the business of whoever owns the bridge.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType
from typing import Final, NamedTuple

from kit.host.codec import Codec
from kit.host.protocol import Event
from kit.host.proxy_nodes import GraphDiff, ProxyClient, ProxyNodes
from kit.host.wire import Json, ProtocolError, integer, items
from kit.msg.message import Message
from kit.ros.graph.graph import Graph
from kit.ros.node.publisher import Publisher
from kit.ros.node.service import Call, Service


class _Asked(NamedTuple):
    """A request to one of the other side's services that waits for its answer."""

    service: int
    call: Call


class Waiting(NamedTuple):
    """Something the other process is to be told, and since when."""

    time_ns: int
    event: list[Json]


class ParentBridge:
    """The other process's nodes, and what is to be told to it."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self.inbox: list[Waiting] = []
        self._asked: dict[int, _Asked] = {}
        self._codec = Codec(in_child=False)
        self._proxies = ProxyNodes(graph, self)
        self._diff = GraphDiff(graph, self._proxies)
        self._speaking = False

    @property
    def has_news(self) -> bool:
        """Whether there is something to tell."""
        return bool(self.inbox) or self._diff.has_news

    def news(self) -> list[Json]:
        """What has changed among the other nodes of the graph since the last time."""
        return self._diff.news()

    def fetch(self) -> list[Json]:
        """All that is to be told now."""
        waiting, self.inbox = self.inbox, []
        return [*self.news(), *(event for _, event in waiting)]

    def take_in(self, events: Iterable[Event]) -> None:
        """Does what the other process tells. ProtocolError if something is wrong with it."""
        with self._graph.lock:
            for event in events:
                _HEARD.get(event.name, ParentBridge._hear_news)(self, event)

    def clear(self) -> None:
        """Takes the nodes out of the graph."""
        self._proxies.clear()

    # What the other side says

    def _hear_news(self, event: Event) -> None:
        unchanged = not self._diff.has_news
        self._proxies.take_in(event.name, event.fields)
        if unchanged:
            self._diff.seen()

    def _hear_message(self, event: Event) -> None:
        identity, content = items(event.fields, 2)
        publisher = self._proxies.end(identity, Publisher)
        message = self._codec.unpack(publisher.msg_type, content)
        # Among themselves the other side's nodes have heard it already.
        self._speaking = True
        try:
            publisher.publish_without_copy(message)
        finally:
            self._speaking = False

    def _hear_request(self, event: Event) -> None:
        identity, number, content = items(event.fields, 3)
        client = self._proxies.end(identity, ProxyClient)
        client.ask(integer(number), self._codec.unpack(client.srv_type.Request, content))

    def _hear_response(self, event: Event) -> None:
        identity, number, content = items(event.fields, 3)
        service = self._proxies.end(identity, Service)
        asked = self._asked.pop(integer(number), None)
        if asked is None or asked.service != identity:
            raise ProtocolError("a response to a request that was not made")
        response = self._codec.unpack(service.srv_type.Response, content)
        self._graph.notify_message_listeners(service.handle.node, service.service_name, response)
        asked.call.client.enqueue(asked.call.number, response)
        self._graph.notify()

    # What the other side is told

    def on_message(self, subscription: int, message: Message) -> None:
        if not self._speaking:
            self._tell("message", subscription, self._codec.pack(message))

    def on_request(self, service: int, call: Call) -> None:
        number = self._graph.next_number()
        self._asked[number] = _Asked(service, call)
        self._tell("request", service, number, self._codec.pack(call.request))

    def on_response(self, client: int, number: int, response: Message) -> None:
        self._tell("response", client, number, self._codec.pack(response))

    def on_discard(self, end: int) -> None:
        self.inbox = [waiting for waiting in self.inbox if waiting.event[1] != end]

    def _tell(self, *event: Json) -> None:
        self.inbox.append(Waiting(self._graph.now_ns, list(event)))


_HEARD: Final[Mapping[str, Callable[[ParentBridge, Event], None]]] = MappingProxyType(
    {
        "message": ParentBridge._hear_message,
        "request": ParentBridge._hear_request,
        "response": ParentBridge._hear_response,
    }
)
