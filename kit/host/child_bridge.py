"""A program's own graph, whose time and messages come from the graph of somebody else's process.

Its nodes are ordinary nodes; the other graph's are mirrored in it. So what is written for one graph works across
two processes: a student's node beside the kit, a second terminal beside a running world.
"""

from __future__ import annotations

from collections.abc import Callable
from types import MappingProxyType
from typing import Any, Final, Protocol

from kit.host.codec import Codec, NotFiniteError
from kit.host.proxy_nodes import GraphDiff, ProxyNodes
from kit.host.waiter import AllThreadsWaiter, Exchange
from kit.host.wire import Json
from kit.msg.message import Message
from kit.ros.graph.directory import GraphNode
from kit.ros.graph.graph import Graph, Waiter
from kit.ros.node.service import Call


class Conversation(Protocol):
    """Answers and questions in turn; ``kit.host.protocol`` lists them."""

    def answer(self, kind: str, *content: Json) -> None:
        """Answers the last question."""

    def next_question(self) -> list[Json]:
        """Waits for the next one: its kind and its content."""


class ChildBridge:
    """The child's graph, and what goes to and fro between it and the kit's."""

    def __init__(
        self, conversation: Conversation, now_ns: int, pump: Callable[[Exchange], Waiter] = AllThreadsWaiter
    ) -> None:
        self.graph = Graph(now_ns, waiter=pump(self))
        self._conversation = conversation
        self._codec = Codec(in_child=True)
        self._proxies = ProxyNodes(self.graph, self)
        self._diff = GraphDiff(self.graph, self._proxies)
        self._events: list[Json] = []
        self.has_had_nodes = False
        self.graph.add_message_listener(self._overhear)

    # Out

    def turn(self, wake_ns: int | None) -> None:
        """Answers that the program waits, and takes in the next question."""
        self._conversation.answer("reply", wake_ns, self._flush())
        _, now_ns, events = self._conversation.next_question()
        with self.graph.lock:
            self.graph.advance(now_ns)
            self.hear(events)

    def end(self) -> None:
        """Answers that the program is over."""
        self._conversation.answer("ended", self._flush())

    def _flush(self) -> list[Json]:
        with self.graph.lock:
            self._tell_news()
            events, self._events = self._events, []
        return events

    def _tell_news(self) -> None:
        news = self._diff.news()
        self._events += news
        self.has_had_nodes = self.has_had_nodes or bool(news)

    def _overhear(self, _: int, node: GraphNode, topic: str, message: Message) -> None:
        """Everything that the program's own nodes publish, whether or not anybody listens."""
        if "/srv/" not in type(message).__ros_type__:
            self._tell_news()
            number = self._diff.publisher(node.handle, topic)
            try:
                content = self._codec.pack(message)
            except NotFiniteError as problem:
                raise ValueError(
                    f"{problem} of the {type(message).__name__} for {topic} is not a finite number. "
                    "(A laser ray that meets nothing reads nan.)"
                ) from None
            self._events.append(["message", number, content])

    def on_message(self, subscription: int, message: Message) -> None:
        """Told already, by ``_overhear``."""

    def on_request(self, service: int, call: Call) -> None:
        self._tell_news()
        self._events.append(["request", call.client.number, call.number, self._codec.pack(call.request)])

    def on_response(self, client: int, number: int, response: Message) -> None:
        raise AssertionError("responses to the kit's clients go through their _Asker")

    def on_discard(self, end: int) -> None:
        """Nothing stays here."""

    # In

    def hear(self, events: list[Json]) -> None:
        """Takes in what the kit tells."""
        with self.graph.lock:
            for name, *fields in events:
                _HEARD.get(name, ChildBridge._hear_news)(self, name, fields)
            self.graph.notify()

    def _hear_news(self, name: str, fields: list[Json]) -> None:
        self._tell_news()
        self._proxies.take_in(name, fields)
        self._diff.seen()

    def _hear_message(self, _: str, fields: list[Json]) -> None:
        number, content = fields
        subscription: Any = self._diff.ends.get(number)
        if subscription is not None:  # it may have been destroyed since
            subscription.enqueue(self._codec.unpack(subscription.msg_type, content))

    def _hear_request(self, _: str, fields: list[Json]) -> None:
        identity, number, content = fields
        service: Any = self._diff.ends.get(identity)
        if service is not None:
            asker: Any = _Asker(self, identity)
            service.enqueue(Call(asker, number, self._codec.unpack(service.srv_type.Request, content)))

    def _hear_response(self, _: str, fields: list[Json]) -> None:
        identity, number, content = fields
        client: Any = self._diff.ends.get(identity)
        if client is not None:
            client.enqueue(number, self._codec.unpack(client.srv_type.Response, content))

    def answer(self, service: int, number: int, response: Message) -> None:
        """One of the program's services has answered one of the kit's clients."""
        self._events.append(["response", service, number, self._codec.pack(response)])


class _Asker:
    """Stands for whoever asked, in a call that came from the kit."""

    def __init__(self, bridge: ChildBridge, service: int) -> None:
        self._bridge = bridge
        self._service = service

    def enqueue(self, number: int, response: Message) -> None:
        self._bridge.answer(self._service, number, response)


_HEARD: Final = MappingProxyType(
    {
        "message": ChildBridge._hear_message,
        "request": ChildBridge._hear_request,
        "response": ChildBridge._hear_response,
    }
)
