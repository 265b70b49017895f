"""Guard conditions: a callback that any thread can ask for."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from kit.ros.graph.ready_queue import NO_WORK
from kit.ros.node.callback_check import accepted_argument_count
from kit.ros.node.endpoint import Entity

if TYPE_CHECKING:
    from kit.ros.execution.callback_groups import CallbackGroup
    from kit.ros.graph.node_handle import NodeHandle


class GuardCondition(Entity):
    """``trigger()`` has the callback called once. ``Node.create_guard_condition`` makes one."""

    def __init__(
        self, handle: NodeHandle, callback: Callable[[], Any], callback_group: CallbackGroup
    ) -> None:
        accepted_argument_count(callback, (0,), "a guard condition")
        self._handle = handle
        self.callback = callback
        self.callback_group = callback_group
        self._triggered = False

    def __repr__(self) -> str:
        return f"guard condition of {self._handle.full_name}"

    __str__ = __repr__

    def trigger(self) -> None:
        """Any thread; triggering twice before the callback came calls it once."""
        self._check_not_destroyed()
        with self._handle.graph.lock:
            if not self._triggered:
                self._triggered = True
                self._handle.ready_queue.put(self)

    def take(self) -> Any:
        triggered, self._triggered = self._triggered, False
        return None if triggered else NO_WORK

    def run(self, taken: None) -> Any:
        return self.callback()

    def discard_queue(self) -> None:
        self._triggered = False

    def _unregister(self) -> None:
        self._triggered = False
