"""Waits until messages have come on topics, for tests of a launch: launch_testing_ros."""

from __future__ import annotations

import threading
from collections import defaultdict, deque
from collections.abc import Callable, Iterable
from types import TracebackType
from typing import Any, Self

from kit.ros.execution.context import Context, get_default_context
from kit.ros.execution.executors import SingleThreadedExecutor
from kit.ros.node.node import Node
from kit.ros.node.time import S_TO_NS


class WaitForTopics:
    """Subscribes to topics, in a node of its own, until a message has come on each.

    ``topic_tuples``: pairs of a topic and its type. ``timeout``: how long to wait at most [s]. ``trigger``: called with the node
    and the other arguments once it has subscribed. Use it as a context manager, or call ``wait`` and then ``shutdown``.
    """

    def __init__(
        self,
        topic_tuples: Iterable[tuple[str, type]],
        timeout: float = 5.0,
        messages_received_buffer_length: int | None = 10,
        trigger: Callable[..., object] | None = None,
        node_namespace: str | None = None,
        *args: Any,
        **kwargs: Any,
    ) -> None:
        self.topic_tuples = list(topic_tuples)
        self.timeout = timeout
        self._trigger, self._arguments, self._named = trigger, args, kwargs
        self._received: defaultdict[str, deque[Any]] = defaultdict(
            lambda: deque(maxlen=messages_received_buffer_length)
        )
        self._context = Context(get_default_context().graph)
        self._context.init([])
        self._executor = SingleThreadedExecutor(context=self._context)
        self._node = Node(
            f"_test_node_{self._context.graph.next_number()}",
            namespace=node_namespace or "/",
            context=self._context,
        )
        self._executor.add_node(self._node)
        self._thread = threading.Thread(target=self._executor.spin, daemon=True, name="wait_for_topics")
        self._thread.start()

    def wait(self) -> bool:
        """Waits until a message has come on each topic; False after the time-out."""
        graph = self._context.graph
        for topic, message_type in self.topic_tuples:
            self._node.create_subscription(message_type, topic, self._recorder(topic), 10)
        if self._trigger is not None:
            self._trigger(self._node, *self._arguments, **self._named)
        until = graph.now_ns + round(self.timeout * S_TO_NS)
        return graph.wait(lambda: not self.topics_not_received(), until, what="WaitForTopics")

    def topics_received(self) -> set[str]:
        return {topic for topic, messages in self._received.items() if messages}

    def topics_not_received(self) -> set[str]:
        return {topic for topic, _ in self.topic_tuples} - self.topics_received()

    def received_messages(self, topic_name: str) -> list[Any]:
        """The newest messages of a topic, oldest first. Raises KeyError for a topic that was not asked for."""
        if topic_name not in {topic for topic, _ in self.topic_tuples}:
            raise KeyError(f"no topic '{topic_name}' is waited for")
        return list(self._received[topic_name])

    def shutdown(self) -> None:
        """Ends its node. May be called twice."""
        if self._context.ok():
            self._executor.shutdown()
            self._node.destroy_node()
            self._context.shutdown()

    def __enter__(self) -> Self:
        if not self.wait():
            missing = ", ".join(sorted(self.topics_not_received()))
            self.shutdown()
            raise RuntimeError(f"Did not receive messages on these topics: {missing}")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.shutdown()

    def _recorder(self, topic: str) -> Callable[[Any], None]:
        def record(message: Any) -> None:
            self._received[topic].append(message)
            self._context.graph.notify()

        return record
