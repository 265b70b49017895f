"""Callback groups decide which callbacks may run at the same time; ready items are what they admit."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any, Final, Protocol

if TYPE_CHECKING:
    from kit.ros.log import RcutilsLogger

NO_WORK: Final = object()
"""Returned by ``ReadyItem.take`` if the work is gone: cancelled, destroyed, or already done."""


class ItemQueue(Protocol):
    """The part of a ReadyQueue that items and tasks use."""

    @property
    def items(self) -> deque[ReadyItem]: ...

    def put(self, item: ReadyItem) -> None: ...


class QueueOwner(Protocol):
    """Something with a ready queue: an executor, or a node's handle."""

    @property
    def ready_queue(self) -> ItemQueue: ...


class ItemOwner(QueueOwner, Protocol):
    """The part of a NodeHandle that the scheduling of its items needs."""

    @property
    def logger(self) -> RcutilsLogger: ...

    @property
    def full_name(self) -> str: ...


class ReadyItem(Protocol):
    """Something with a callback: a subscription, timer, service, client, guard condition or task."""

    @property
    def handle(self) -> ItemOwner | None:
        """The handle of its node; None for a task without a node."""

    @property
    def callback_group(self) -> CallbackGroup | None:
        """The group whose rule it obeys; None: it may run at any time."""

    def take(self) -> Any:
        """Takes the next piece of work out of its queue, or returns NO_WORK. Called with the graph's lock held."""

    def run(self, taken: Any) -> Any:
        """Runs the callback for what ``take`` returned. A coroutine it returns is continued by the ready queue."""


TakenWork = tuple[ReadyItem, Any]
"""An item whose turn it is, and what its ``take`` returned."""


class CallbackGroup:
    """A set of entities; its subclasses define which of their callbacks may overlap.

    ``beginning_execution`` is called before each callback; an item that is refused waits in ``waiting_items``
    until the group is free again.
    """

    def __init__(self) -> None:
        self.entities: set[ReadyItem] = set()
        self.waiting_items: deque[ReadyItem] = deque()

    def add_entity(self, entity: ReadyItem) -> None:
        self.entities.add(entity)

    def has_entity(self, entity: ReadyItem) -> bool:
        return entity in self.entities

    def can_execute(self, entity: ReadyItem) -> bool:
        """True if a callback of the entity could begin now."""
        raise NotImplementedError

    def beginning_execution(self, entity: ReadyItem) -> bool:
        """Admits a callback of the entity, or returns False. If admitted, ``ending_execution`` must follow."""
        raise NotImplementedError  # not abstract: ROS 2's own class can be made too

    def ending_execution(self, entity: ReadyItem) -> None:
        raise NotImplementedError


class ReentrantCallbackGroup(CallbackGroup):
    """Any callback may run at any time, also several times at once."""

    def can_execute(self, entity: ReadyItem) -> bool:
        return True

    def beginning_execution(self, entity: ReadyItem) -> bool:
        return True

    def ending_execution(self, entity: ReadyItem) -> None:
        pass


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """One callback runs at a time; a coroutine that awaits still counts as running."""

    def __init__(self) -> None:
        super().__init__()
        self._active: ReadyItem | None = None

    @property
    def active(self) -> ReadyItem | None:
        """The entity whose callback is running, or None."""
        return self._active

    def can_execute(self, entity: ReadyItem) -> bool:
        return self._active is None

    def beginning_execution(self, entity: ReadyItem) -> bool:
        if self._active is not None:
            return False
        self._active = entity
        return True

    def ending_execution(self, entity: ReadyItem) -> None:
        self._active = None
