"""Which callbacks may run at the same time."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from kit.ros.graph.ready_queue import ReadyItem


class CallbackGroup:
    """A set of entities. Which of their callbacks may overlap is for the subclasses to say.

    An executor asks ``beginning_execution`` before each callback; work that is turned away waits in
    ``waiting_items`` until the group is free again.
    """

    def __init__(self) -> None:
        self.entities: set[ReadyItem] = set()
        self.waiting_items: deque[ReadyItem] = deque()

    def add_entity(self, entity: ReadyItem) -> None:
        self.entities.add(entity)

    def has_entity(self, entity: ReadyItem) -> bool:
        return entity in self.entities

    def can_execute(self, entity: ReadyItem) -> bool:
        """Whether a callback of the entity could begin now."""
        raise NotImplementedError

    def beginning_execution(self, entity: ReadyItem) -> bool:
        """Whether a callback of the entity begins now; if so, ``ending_execution`` must follow."""
        raise NotImplementedError  # not abstract: ROS 2's own class can be made too

    def ending_execution(self, entity: ReadyItem) -> None:
        raise NotImplementedError


class ReentrantCallbackGroup(CallbackGroup):
    """Every callback may run at any time, even beside itself."""

    def can_execute(self, entity: ReadyItem) -> bool:
        return True

    def beginning_execution(self, entity: ReadyItem) -> bool:
        return True

    def ending_execution(self, entity: ReadyItem) -> None:
        pass


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """One callback at a time; a coroutine that awaits still counts as running."""

    def __init__(self) -> None:
        super().__init__()
        self._active: ReadyItem | None = None

    @property
    def active(self) -> ReadyItem | None:
        """What is running now."""
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
