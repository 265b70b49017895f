"""Base classes of what a node makes (publishers, timers, ...), and guard conditions."""

from __future__ import annotations

import inspect
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from enum import IntEnum
from types import FunctionType, MethodType
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, Self, TypeVar

from kit.msg.message import type_name
from kit.ros.exceptions import InvalidHandle
from kit.ros.execution.callback_groups import NO_WORK, CallbackGroup
from kit.ros.graph.directory import GraphEndpoint, NodeEntry, NodeLike
from kit.ros.node.qos import QoSProfile

if TYPE_CHECKING:
    from kit.ros.execution.context import Context
    from kit.ros.graph.graph import Graph
    from kit.ros.graph.ready_queue import ReadyQueue


class EntityOwner(NodeEntry, Protocol):
    """The part of a NodeHandle that publishers, timers and the like use."""

    @property
    def graph(self) -> Graph: ...

    @property
    def context(self) -> Context: ...

    @property
    def ready_queue(self) -> ReadyQueue: ...

    @property
    def is_spun(self) -> bool: ...

    def remove_entity(self, entity: Destroyable) -> None: ...


class Destroyable(ABC):
    """Something that a node made and that can be destroyed; also a context manager, which destroys it."""

    _handle: EntityOwner
    _destroyed = False

    @property
    def handle(self) -> EntityOwner:
        """The internal record of its node."""
        return self._handle

    @property
    def node(self) -> NodeLike:
        """The node that made it."""
        return self._handle.node

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()

    def destroy(self) -> None:
        """Removes it from the graph. Using it afterwards raises InvalidHandle."""
        if not self._destroyed:
            self._destroyed = True
            with self._handle.graph.lock:
                self._unregister()
                self._handle.remove_entity(self)

    @abstractmethod
    def _unregister(self) -> None:
        """Removes what the constructor registered outside the node. With the graph's lock held."""

    def _check_not_destroyed(self) -> None:
        if self._destroyed:
            raise InvalidHandle(f"cannot use {self}: it has been destroyed")


class CallbackEntity(Destroyable):
    """Something with a callback: a ``ReadyItem``."""

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
        """Drops the work that waits in its queue. With the graph's lock held."""


E = TypeVar("E", bound=CallbackEntity)


def register_entity(entities: list[E], entity: E) -> E:
    """Adds a new entity to its node's list and to its callback group; returns it."""
    entities.append(entity)
    entity.callback_group.add_entity(entity)
    return entity


def accepted_argument_count(callback: Any, allowed: Sequence[int], what: str) -> int:
    """The number of arguments to call ``callback`` with: the first of ``allowed`` that it accepts.

    Checked when the callback is registered, so that a mistake shows there. Raises TypeError.
    """
    if not callable(callback):
        hint = " (give the function itself, without parentheses)" if callback is None else ""
        raise TypeError(f"the callback of {what} must be a function, not {type(callback).__name__}{hint}")
    if (count := _count_of_plain(callback)) in allowed:
        return count
    try:
        signature = inspect.signature(callback)
    except ValueError:  # some built-in functions have no signature
        return allowed[0]
    for count in allowed:
        try:
            signature.bind(*range(count))
        except TypeError:
            continue
        return count
    name = getattr(callback, "__qualname__", repr(callback))
    counts = " or ".join(str(count) for count in allowed)
    raise TypeError(
        f"the callback of {what} is called with {counts} argument(s), but {name}{signature} takes others"
    )


def _count_of_plain(callback: Any) -> int:
    """The only number of arguments that a function or method without any other parameters takes; -1 if it has others. A
    signature takes thirty times as long, and a node's own services alone have six."""
    is_method = isinstance(callback, MethodType)
    function = callback.__func__ if is_method else callback
    if not isinstance(function, FunctionType) or function.__dict__:  # such as what it wraps
        return -1
    code = function.__code__
    others = code.co_kwonlyargcount or code.co_flags & (inspect.CO_VARARGS | inspect.CO_VARKEYWORDS)
    return -1 if others or function.__defaults__ else code.co_argcount - is_method


class TopicEndpointTypeEnum(IntEnum):
    INVALID = 0
    PUBLISHER = 1
    SUBSCRIPTION = 2


class TopicEndpointInfo(NamedTuple):
    node_name: str
    node_namespace: str
    topic_type: str
    endpoint_type: TopicEndpointTypeEnum
    endpoint_gid: list[int]
    """16 bytes that are unique in the graph."""
    qos_profile: QoSProfile

    @classmethod
    def of(cls, endpoint: GraphEndpoint, kind: TopicEndpointTypeEnum) -> TopicEndpointInfo:
        return cls(
            endpoint.handle.name,
            endpoint.handle.namespace,
            type_name(endpoint.msg_type),
            kind,
            list(endpoint.number.to_bytes(16, "big")),
            endpoint.qos_profile,
        )


class GuardCondition(CallbackEntity):
    """Calls its callback once after ``trigger()``. ``Node.create_guard_condition`` makes one."""

    def __init__(
        self, handle: EntityOwner, callback: Callable[[], Any], callback_group: CallbackGroup
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
        """Has the callback run soon; may be called from any thread. Two calls before it has run are one."""
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
