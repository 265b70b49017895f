"""Waitables: objects that a program adds to those that an executor waits for.

``Node.add_waitable`` adds one. Whenever something happens, the executor asks it what it waits for (``add_to_wait_set``)
and whether that is ready (``is_ready``); if so it takes the data and executes it in its callback group. In the kit a
waitable waits for guard conditions; messages, requests and time come to callbacks of the node, which may trigger one.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Generic, NoReturn, TypeVar

from kit.ros.execution.callback_groups import NO_WORK, CallbackGroup, ItemOwner
from kit.ros.execution.context import Context, get_default_context
from kit.ros.execution.task import Future

T = TypeVar("T")


class NumberOfEntities:
    """How many entities of each kind a waitable has."""

    __slots__ = (
        "num_clients",
        "num_events",
        "num_guard_conditions",
        "num_services",
        "num_subscriptions",
        "num_timers",
    )

    def __init__(
        self,
        num_subs: int = 0,
        num_gcs: int = 0,
        num_timers: int = 0,
        num_clients: int = 0,
        num_services: int = 0,
        num_events: int = 0,
    ) -> None:
        self.num_subscriptions = num_subs
        self.num_guard_conditions = num_gcs
        self.num_timers = num_timers
        self.num_clients = num_clients
        self.num_services = num_services
        self.num_events = num_events

    def __iadd__(self, other: NumberOfEntities) -> NumberOfEntities:
        for name in self.__slots__:
            setattr(self, name, getattr(self, name) + getattr(other, name))
        return self

    def __add__(self, other: NumberOfEntities) -> NumberOfEntities:
        found = NumberOfEntities()
        found += self
        found += other
        return found

    def __repr__(self) -> str:
        counts = (
            self.num_subscriptions,
            self.num_guard_conditions,
            self.num_timers,
            self.num_clients,
            self.num_services,
            self.num_events,
        )
        return f"<{type(self).__name__}({', '.join(map(str, counts))})>"


class WaitableGuardCondition:
    """A guard condition that a program makes for a waitable: rclpy's ``GuardCondition``. It belongs to no node.

    As in ROS 2, its callback is called only for one that ``Node.create_guard_condition`` has made.
    """

    def __init__(
        self,
        callback: Callable[[], Any] | None,
        callback_group: CallbackGroup | None,
        context: Context | None = None,
    ) -> None:
        self.callback, self.callback_group = callback, callback_group
        self._graph = (context or get_default_context()).graph
        self._is_triggered = False

    @property
    def handle(self) -> GuardConditionHandle:
        """The handle that a wait set takes."""
        return GuardConditionHandle(self)

    def trigger(self) -> None:
        """Wakes the wait sets that hold this condition; may be called from any thread."""
        with self._graph.lock:
            self._is_triggered = True
            self._graph.notify()

    def take_trigger(self) -> bool:
        """True if it was triggered since the last call. With the graph's lock held."""
        triggered, self._is_triggered = self._is_triggered, False
        return triggered

    def destroy(self) -> None:
        """Forgets that it was triggered."""
        self._is_triggered = False


class GuardConditionHandle:
    """The handle of a guard condition; ``with`` it, the guard condition stays as it is."""

    def __init__(self, guard: WaitableGuardCondition) -> None:
        self.guard = guard

    def __enter__(self) -> GuardConditionHandle:
        return self

    def __exit__(self, *_: object) -> None:
        """Does nothing: the kit's guard conditions hold nothing that could be freed."""


class WaitSet:
    """What one waitable waits for, and what of it is ready: guard conditions that were triggered since the last look."""

    def __init__(self) -> None:
        self._ready: list[bool] = []

    def add_guard_condition(self, handle: GuardConditionHandle) -> int:
        """Adds a guard condition by its handle; returns its index. It counts as triggered once."""
        self._ready.append(handle.guard.take_trigger())
        return len(self._ready) - 1

    def add_subscription(self, subscription: object) -> NoReturn:
        """Raises NotImplementedError, as the others do: only guard conditions can be waited for."""
        raise NotImplementedError(
            "here a waitable waits for guard conditions: trigger one in a callback of the node for the rest"
        )

    add_timer = add_client = add_service = add_event = add_subscription

    def is_ready(self, entity_type: str, index: int) -> bool:
        """True if the entity of this index is ready; ``entity_type`` is ``guard_condition``."""
        if entity_type != "guard_condition":
            self.add_subscription(entity_type)
        return self._ready[index]


class Waitable(Generic[T]):
    """Something that an executor waits for and executes. Its methods are defined by subclasses."""

    def __init__(self, callback_group: CallbackGroup) -> None:
        self.callback_group = callback_group
        self._futures: list[Future[Any]] = []

    def __enter__(self) -> None:
        """Begins a use of its entities; nothing to do here."""

    def __exit__(self, *_: object) -> None:
        """Ends that use; nothing to do here."""

    def add_future(self, future: Future[Any]) -> None:
        self._futures.append(future)

    def remove_future(self, future: Future[Any]) -> None:
        self._futures.remove(future)

    def is_ready(self, wait_set: WaitSet) -> bool:
        """True if something of what it waits for is ready."""
        raise NotImplementedError(f"{type(self).__name__}.is_ready")

    def take_data(self) -> T:
        """Takes what is ready, so that it is not ready any more."""
        raise NotImplementedError(f"{type(self).__name__}.take_data")

    async def execute(self, taken_data: T) -> None:
        """Does the work with what ``take_data`` returned."""
        raise NotImplementedError(f"{type(self).__name__}.execute")

    def get_num_entities(self) -> NumberOfEntities:
        """How many entities it waits for."""
        raise NotImplementedError(f"{type(self).__name__}.get_num_entities")

    def add_to_wait_set(self, wait_set: WaitSet) -> None:
        """Adds what it waits for, and notes the indices."""
        raise NotImplementedError(f"{type(self).__name__}.add_to_wait_set")


class WaitableItem:
    """A waitable of a node as an item of the node's ready queue: a ``PolledItem``."""

    def __init__(self, handle: ItemOwner, waitable: Waitable[Any]) -> None:
        self.handle = handle
        self.waitable = waitable
        self.is_queued = False
        waitable.callback_group.add_entity(self)

    @property
    def callback_group(self) -> CallbackGroup:
        return self.waitable.callback_group

    def poll(self) -> bool:
        """True if there is something to execute. With the graph's lock held."""
        wait_set = WaitSet()
        self.waitable.add_to_wait_set(wait_set)
        return self.waitable.is_ready(wait_set)

    def take(self) -> Any:
        if not self.is_queued:
            return NO_WORK
        self.is_queued = False
        return self.waitable.take_data()

    def run(self, taken: Any) -> Any:
        return self.waitable.execute(taken)

    def discard(self) -> None:
        """Removes it from its callback group; what waits is not executed any more."""
        self.is_queued = False
        self.callback_group.entities.discard(self)
