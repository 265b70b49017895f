"""Event handlers: what is carried out when something happens."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from kit.ros.launch.context import LaunchContext
from kit.ros.launch.entity import LaunchDescriptionEntity, entities
from kit.ros.launch.events import (
    Event,
    ProcessExited,
    ProcessIO,
    ProcessStarted,
    RunningProcessEvent,
    Shutdown,
)

Reaction = Callable[..., Any] | LaunchDescriptionEntity | Iterable[LaunchDescriptionEntity]
"""Actions, or a function ``(event, context)`` that returns some."""


class EventHandler:
    """Reacts to the events that ``matcher`` picks."""

    hears_output = False
    """Whether it wants to know of every line that a process prints."""

    def __init__(
        self, *, matcher: Callable[[Any], bool], entities: Reaction | None = None, handle_once: bool = False
    ) -> None:
        self._matcher = matcher
        self._reaction = entities
        self.handle_once = handle_once

    def matches(self, event: Event) -> bool:
        return self._matcher(event)

    def handle(self, event: Event, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """What is to be carried out now."""
        if self.handle_once:
            context.unregister_event_handler(self)
        return react(self._reaction, event, context)


def react(reaction: Reaction | None, event: Event, context: LaunchContext) -> list[LaunchDescriptionEntity]:
    """The actions of a reaction to an event."""
    if callable(reaction) and not isinstance(reaction, LaunchDescriptionEntity):
        return entities(reaction(event, context))
    return entities(reaction)


class _OnProcess(EventHandler):
    kind: type[RunningProcessEvent]

    def __init__(self, target_action: Any, reaction: Reaction, handle_once: bool) -> None:
        self._target = target_action
        super().__init__(matcher=self._is_meant, entities=reaction, handle_once=handle_once)

    def _is_meant(self, event: Any) -> bool:
        if not isinstance(event, self.kind):
            return False
        if self._target is None or self._target is event.action:
            return True
        is_function = callable(self._target) and not isinstance(self._target, LaunchDescriptionEntity)
        return is_function and bool(self._target(event.action))


class OnProcessExit(_OnProcess):
    """When a process has ended; ``target_action`` None: any."""

    kind = ProcessExited

    def __init__(self, *, target_action: Any = None, on_exit: Reaction, handle_once: bool = False) -> None:
        super().__init__(target_action, on_exit, handle_once)


class OnProcessStart(_OnProcess):
    """When a process has started."""

    kind = ProcessStarted

    def __init__(self, *, target_action: Any = None, on_start: Reaction, handle_once: bool = False) -> None:
        super().__init__(target_action, on_start, handle_once)


class OnProcessIO(_OnProcess):
    """When a process has printed something."""

    kind = ProcessIO
    hears_output = True

    def __init__(
        self,
        *,
        target_action: Any = None,
        on_stdin: Reaction | None = None,
        on_stdout: Reaction | None = None,
        on_stderr: Reaction | None = None,
    ) -> None:
        def choose(event: ProcessIO, context: LaunchContext) -> Any:
            return react(on_stdout if event.from_stdout else on_stderr, event, context)

        super().__init__(target_action, choose, handle_once=False)


class OnShutdown(EventHandler):
    """When everything is about to end."""

    def __init__(self, *, on_shutdown: Reaction, handle_once: bool = False) -> None:
        super().__init__(
            matcher=lambda event: isinstance(event, Shutdown), entities=on_shutdown, handle_once=handle_once
        )
