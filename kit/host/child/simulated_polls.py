"""Makes a program in the child wait in the graph by asking again and again whether another thread has done something.

``while not event.is_set(): pass``, ``queue.get_nowait()`` in a loop, ``while thread.is_alive()``: each question of the
program's own code counts as a reading of the clock does (``kit.ros.graph.graph.MAX_READS``), so that simulated time passes,
as many questions on every machine. Of a queue, a question counts whose answer is the last one's: emptying a long queue takes
no time. A lock that is free is acquired a hundred times for the same, for locks also guard what is computed.

A loop that only looks at a variable or a ``deque`` asks nothing of anybody: it goes on by the processor's time.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from functools import wraps
from typing import Any

from kit.host.child.import_hooks import on_import
from kit.host.child.simulated_waits import SimulatedWaits
from kit.ros.graph.graph import Graph


def use_simulated_polls(graph: Graph, waits: SimulatedWaits, is_own_code: Callable[[str], bool]) -> None:
    """Makes the program's questions to what ``threading``, ``queue``, ``concurrent.futures`` and ROS offer count."""

    def count(owner: Any, name: str, is_counted: Callable[[Any], bool] = lambda answer: True) -> None:
        """Makes the uses of a function or property count by which the program's own code asks; ``is_counted`` gets the
        answer."""
        found = getattr(owner, name)
        real: Any = found.fget if isinstance(found, property) else found

        @wraps(real)
        def ask(*args: Any, **kwargs: Any) -> Any:
            answer = real(*args, **kwargs)
            if is_own_code(sys._getframe(1).f_code.co_filename) and is_counted(answer):
                graph.count_read()
            return answer

        setattr(owner, name, property(ask) if isinstance(found, property) else ask)

    def count_in_queue(kind: Any) -> None:
        for name in ("qsize", "empty", "full"):
            if hasattr(kind, name):
                count_size(kind, name)
        for name in ("get", "put"):
            count_failures(kind, name)

    def count_size(kind: Any, name: str) -> None:
        real, size_of = getattr(kind, name), kind.qsize

        @wraps(real)
        def ask(queue: Any) -> Any:
            if is_own_code(sys._getframe(1).f_code.co_filename):
                size = size_of(queue)
                if size == last_sizes(queue).get(name):
                    graph.count_read()
                last_sizes(queue)[name] = size
            return real(queue)

        setattr(kind, name, ask)

    def last_sizes(queue: Any) -> dict[str, int]:
        sizes: dict[str, int] = queue.__dict__.setdefault("_sizes_when_asked", {})
        return sizes

    def count_failures(kind: Any, name: str) -> None:
        real = getattr(kind, name)

        @wraps(real)
        def attempt(*args: Any, **kwargs: Any) -> Any:
            try:
                return real(*args, **kwargs)
            except Exception:  # what it raises says that it is too early
                if waits.is_program():
                    graph.count_read()
                raise

        setattr(kind, name, attempt)

    def replace_queues(module: Any) -> None:
        count_in_queue(module.Queue)
        count_in_queue(module.SimpleQueue)
        count_failures(
            module.SimpleQueue, "get_nowait"
        )  # which does not call ``get``, as that of ``Queue`` does

    def replace_futures(module: Any) -> None:
        count(module.Future, "done")
        count(module.Future, "running")

    def replace_goals(module: Any) -> None:
        for name in ("status", "is_active", "is_cancel_requested"):
            count(module.ServerGoalHandle, name)

    def replace_buffers(module: Any) -> None:
        count(module.Buffer, "can_transform", is_false)
        count_failures(module.Buffer, "lookup_transform")

    def is_false(answer: Any) -> bool:
        return not answer

    count(threading.Event, "is_set")
    count(threading.Event, "isSet")
    count(threading.Thread, "is_alive")
    count(threading.Semaphore, "acquire", is_false)
    count(threading, "active_count")
    count(threading, "activeCount")
    count(threading, "enumerate")
    on_import("queue", replace_queues)
    on_import("concurrent.futures._base", replace_futures)
    on_import("kit.ros.execution.task", lambda module: count(module.Future, "done"))
    on_import("kit.ros.action.client", lambda module: count(module.ClientGoalHandle, "status"))
    on_import("kit.ros.action.server", replace_goals)
    on_import("kit.ros.tf", replace_buffers)
