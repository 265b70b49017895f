"""The child as a ROS 2 program: its nodes in a graph whose time and messages come from the kit."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable
from types import MappingProxyType, ModuleType
from typing import Any, Final

from kit.host.child.conversation import Conversation
from kit.host.child.program import Program
from kit.host.child.pump import PipePump
from kit.host.codec import Codec, NotFiniteError
from kit.host.failure import Failure, FailureKind, GuestError
from kit.host.remote import Census, Mirror
from kit.host.wire import Json
from kit.msg.message import Message
from kit.ros import names_folder
from kit.ros.context import set_default_graph
from kit.ros.graph import Graph
from kit.ros.node import Node
from kit.ros.service import Call


def run(program: Program, conversation: Conversation, start: dict[str, Json]) -> None:
    """Runs the program from its start to its end: its ``main()``, or its one class of nodes."""
    sys.path.insert(0, str(names_folder()))
    sys.argv = [program.file, *start["args"]]
    embassy = Embassy(conversation, start["now"])
    set_default_graph(embassy.graph)
    _keep_simulated_time(embassy.graph)
    embassy.hear(start["events"])
    try:
        module = program.load("__main__")
        if not embassy.has_had_nodes:
            _begin(module, program)
    except SystemExit as stop:
        # `sys.exit(main())` at the end of a file is how a program ends that has done its work.
        if stop.code not in (None, 0) or len(program.frames(stop.__traceback__)) > 1:
            raise
    for thread in threading.enumerate():
        if thread is not threading.current_thread() and not thread.daemon:
            thread.join()
    if not embassy.has_had_nodes:
        raise _nothing_to_run("The program came to its end without making a node.", program)
    embassy.end()


def _begin(module: ModuleType, program: Program) -> None:
    """What the file itself has not begun: as ``ros2 run`` would call it."""
    main = getattr(module, "main", None)
    if callable(main):
        main()
        return
    classes = [cls for cls in vars(module).values() if isinstance(cls, type) and issubclass(cls, Node)]
    own = [cls for cls in classes if cls.__module__ == module.__name__]
    last = [cls for cls in own if not any(cls is not other and issubclass(other, cls) for other in own)]
    if len(last) != 1:
        found = "none" if not last else " and ".join(cls.__name__ for cls in last)
        raise _nothing_to_run(
            f"There is no main() to call. Without one, there must be one class derived from Node; there is {found}.",
            program,
        )
    import rclpy

    rclpy.init()
    make: Callable[[], Node] = last[0]
    rclpy.spin(make())


def _nothing_to_run(message: str, program: Program) -> GuestError:
    return GuestError(Failure(FailureKind.EXCEPTION, message, program.relative(program.file)))


def _keep_simulated_time(graph: Graph) -> None:
    """``time.sleep`` waits, and ``time.time`` counts, in the time of the world, as everything here does.

    A controller that uses them then behaves the same at every speed. The other clocks stay: the library's own
    time-outs are built on them.
    """

    def sleep(seconds: float) -> None:
        """Waits in simulated time."""
        if seconds < 0:
            raise ValueError("sleep length must be non-negative")
        graph.wait(lambda: False, graph.now_ns + int(seconds * 1e9), what="time.sleep()")

    time.sleep = sleep  # type: ignore[assignment]  # for any number, where the stub has a list of kinds
    time.time_ns = lambda: graph.now_ns
    time.time = lambda: graph.now_ns / 1e9


class Embassy:
    """The child's graph, and what goes to and fro between it and the kit's."""

    def __init__(self, conversation: Conversation, now_ns: int) -> None:
        self.graph = Graph(now_ns, pump=PipePump(self))
        self._conversation = conversation
        self._codec = Codec(in_child=True)
        self._mirror = Mirror(self.graph, self)
        self._census = Census(self.graph, self._mirror)
        self._events: list[Json] = []
        self.has_had_nodes = False
        self.graph.watch(self._overhear)

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
        news = self._census.news()
        self._events += news
        self.has_had_nodes = self.has_had_nodes or bool(news)

    def _overhear(self, _: int, node: Node, topic: str, message: Message) -> None:
        """Everything that the program's own nodes publish, whether or not anybody listens."""
        if "/srv/" not in type(message).__ros_type__:
            self._tell_news()
            number = self._census.publisher(node.handle, topic)
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
                _HEARD.get(name, Embassy._hear_news)(self, name, fields)
            self.graph.notify()

    def _hear_news(self, name: str, fields: list[Json]) -> None:
        self._tell_news()
        self._mirror.take_in(name, fields)
        self._census.seen()

    def _hear_message(self, _: str, fields: list[Json]) -> None:
        number, content = fields
        subscription: Any = self._census.ends.get(number)
        if subscription is not None:  # it may have been destroyed since
            subscription.arrive(self._codec.unpack(subscription.msg_type, content))

    def _hear_request(self, _: str, fields: list[Json]) -> None:
        identity, number, content = fields
        service: Any = self._census.ends.get(identity)
        if service is not None:
            asker: Any = _Asker(self, identity)
            service.arrive(Call(asker, number, self._codec.unpack(service.srv_type.Request, content)))

    def _hear_response(self, _: str, fields: list[Json]) -> None:
        identity, number, content = fields
        client: Any = self._census.ends.get(identity)
        if client is not None:
            client.arrive(number, self._codec.unpack(client.srv_type.Response, content))

    def answer(self, service: int, number: int, response: Message) -> None:
        """One of the program's services has answered one of the kit's clients."""
        self._events.append(["response", service, number, self._codec.pack(response)])


class _Asker:
    """Stands for whoever asked, in a call that came from the kit."""

    def __init__(self, embassy: Embassy, service: int) -> None:
        self._embassy = embassy
        self._service = service

    def arrive(self, number: int, response: Message) -> None:
        self._embassy.answer(self._service, number, response)


_HEARD: Final = MappingProxyType(
    {
        "message": Embassy._hear_message,
        "request": Embassy._hear_request,
        "response": Embassy._hear_response,
    }
)
