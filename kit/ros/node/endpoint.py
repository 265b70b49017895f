"""What publishers, subscriptions, services and clients share: a node, a name, an end."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, Self

from kit.ros.exceptions import InvalidHandle
from kit.ros.execution.task import Task
from kit.ros.node.event_handler import QoSIncompatibility

if TYPE_CHECKING:
    from kit.ros.execution.callback_groups import CallbackGroup
    from kit.ros.graph.node_handle import NodeHandle
    from kit.ros.node.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
    from kit.ros.node.node import Node
    from kit.ros.node.qos import QoSPolicyKind


class Destroyable(ABC):
    """Something that a node made and that can be done away with; also as a context manager."""

    _handle: NodeHandle
    _destroyed = False

    @property
    def handle(self) -> NodeHandle:
        """What the library knows of its node."""
        return self._handle

    @property
    def node(self) -> Node:
        """Whose it is."""
        return self._handle.node

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()

    def destroy(self) -> None:
        """Takes it out of the graph. Using it afterwards raises InvalidHandle."""
        if not self._destroyed:
            self._destroyed = True
            with self._handle.graph.lock:
                self._unregister()
                self._handle.remove_entity(self)

    @abstractmethod
    def _unregister(self) -> None:
        """Undoes what making it did outside its node."""

    def _check_not_destroyed(self) -> None:
        if self._destroyed:
            raise InvalidHandle(f"cannot use {self}: it has been destroyed")


class Entity(Destroyable):
    """Something with a callback."""

    callback_group: CallbackGroup

    def destroy(self) -> None:
        super().destroy()
        self.callback_group.entities.discard(self)

    @abstractmethod
    def take(self) -> Any:
        """See ``ReadyItem``."""

    @abstractmethod
    def run(self, taken: Any) -> Any:
        """See ``ReadyItem``."""

    def discard_queue(self) -> None:
        """Forgets the work that waits in it. With the graph's lock held."""


class IncompatibilityReporter:
    """What an end of a topic does about partners whose quality of service does not fit."""

    def __init__(
        self, handle: NodeHandle, callbacks: PublisherEventCallbacks | SubscriptionEventCallbacks | None
    ) -> None:
        self._handle = handle
        self._callbacks = callbacks
        self._count = 0

    def report(self, policy: QoSPolicyKind, warning: str) -> None:
        """Calls the event callback for it, or else warns."""
        self._count += 1
        callbacks = self._callbacks
        if callbacks is not None and callbacks.incompatible_qos is not None:
            task: Task[Any] = Task(callbacks.incompatible_qos, (QoSIncompatibility(policy, self._count),))
            task.set_owner(self._handle)
            self._handle.ready_queue.put(task)
        elif callbacks is None or callbacks.use_default_callbacks:
            self._handle.logger.warning(warning)
