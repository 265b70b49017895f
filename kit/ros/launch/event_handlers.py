"""Event handlers: entities that are carried out when an event occurs."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable
from typing import Any

from kit.ros.launch.context import LaunchContext
from kit.ros.launch.entity import Action, LaunchDescriptionEntity, to_entities
from kit.ros.launch.events import (
    Event,
    ExecutionComplete,
    ProcessExited,
    ProcessIO,
    ProcessStarted,
    RunningProcessEvent,
    Shutdown,
    StateTransition,
)

Reaction = Callable[..., Any] | LaunchDescriptionEntity | Iterable[LaunchDescriptionEntity]
"""Actions, or a function ``(event, context)`` that returns actions; ``(event)`` for what a process prints."""


class EventHandler:
    """Carries out ``entities`` when an event occurs for which ``matcher(event)`` is true."""

    needs_output = False
    """Whether it needs an event for every line that a process prints."""

    def __init__(
        self, *, matcher: Callable[[Any], bool], entities: Reaction | None = None, handle_once: bool = False
    ) -> None:
        self._matcher = matcher
        self._reaction = entities
        self.handle_once = handle_once

    def matches(self, event: Event) -> bool:
        return self._matcher(event)

    def handle(self, event: Event, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """The entities to carry out now."""
        if self.handle_once:
            context.unregister_event_handler(self)
        return reaction_entities(self._reaction, event, context)


def reaction_entities(
    reaction: Reaction | None, event: Event, context: LaunchContext
) -> list[LaunchDescriptionEntity]:
    """The entities of a reaction; a function is called to get them."""
    if callable(reaction) and not isinstance(reaction, LaunchDescriptionEntity):
        return to_entities(reaction(event, context))
    return to_entities(reaction)


class _OnProcess(EventHandler):
    """Reacts to events of one kind, of one action's process or of any."""

    kind: type[RunningProcessEvent]

    def __init__(self, target_action: Any, reaction: Reaction, handle_once: bool) -> None:
        self._target = target_action
        super().__init__(matcher=self._matches_target, entities=reaction, handle_once=handle_once)

    def _matches_target(self, event: Any) -> bool:
        if not isinstance(event, self.kind):
            return False
        if self._target is None or self._target is event.action:
            return True
        is_function = callable(self._target) and not isinstance(self._target, LaunchDescriptionEntity)
        return is_function and bool(self._target(event.action))


class OnProcessExit(_OnProcess):
    """Reacts when a process has ended; ``target_action`` None: any process."""

    kind = ProcessExited

    def __init__(self, *, target_action: Any = None, on_exit: Reaction, handle_once: bool = False) -> None:
        super().__init__(target_action, on_exit, handle_once)


class OnProcessStart(_OnProcess):
    """Reacts when a process has started."""

    kind = ProcessStarted

    def __init__(self, *, target_action: Any = None, on_start: Reaction, handle_once: bool = False) -> None:
        super().__init__(target_action, on_start, handle_once)


class OnProcessIO(_OnProcess):
    """Reacts when a process has printed something."""

    kind = ProcessIO
    needs_output = True

    def __init__(
        self,
        *,
        target_action: Any = None,
        on_stdin: Reaction | None = None,
        on_stdout: Reaction | None = None,
        on_stderr: Reaction | None = None,
    ) -> None:
        def choose(event: ProcessIO, context: LaunchContext) -> Any:
            reaction = on_stdout if event.from_stdout else on_stderr
            if callable(reaction) and not isinstance(reaction, LaunchDescriptionEntity):
                # Alone among the handlers' functions, these are given the event only.
                return to_entities(reaction(event, context) if _takes_two(reaction) else reaction(event))
            return to_entities(reaction)

        super().__init__(target_action, choose, handle_once=False)


def _takes_two(function: Callable[..., Any]) -> bool:
    try:
        inspect.signature(function).bind(None, None)
    except (TypeError, ValueError):  # ValueError: a built-in function without a signature
        return False
    return True


class OnExecutionComplete(EventHandler):
    """Reacts when an action has been carried out; ``target_action`` None: any action."""

    def __init__(
        self, *, target_action: Action | None = None, on_completion: Reaction, handle_once: bool = False
    ) -> None:
        if target_action is not None and not isinstance(target_action, Action):
            raise ValueError("OnExecutionComplete requires an 'Action' as the target")
        super().__init__(
            matcher=lambda event: (
                isinstance(event, ExecutionComplete) and target_action in (None, event.action)
            ),
            entities=on_completion,
            handle_once=handle_once,
        )


class OnStateTransition(EventHandler):
    """Reacts when a lifecycle node of the launch has made a transition; what is None matches any."""

    def __init__(
        self,
        *,
        entities: Reaction,
        target_lifecycle_node: Any = None,
        transition: str | None = None,
        start_state: str | None = None,
        goal_state: str | None = None,
        handle_once: bool = False,
    ) -> None:
        def matches(event: Event) -> bool:
            return isinstance(event, StateTransition) and all(
                wanted is None or wanted == found
                for wanted, found in (
                    (target_lifecycle_node, event.action),
                    (transition, event.transition),
                    (start_state, event.start_state),
                    (goal_state, event.goal_state),
                )
            )

        super().__init__(matcher=matches, entities=entities, handle_once=handle_once)


class OnShutdown(EventHandler):
    """Reacts when the launch is shut down."""

    def __init__(self, *, on_shutdown: Reaction, handle_once: bool = False) -> None:
        super().__init__(
            matcher=lambda event: isinstance(event, Shutdown), entities=on_shutdown, handle_once=handle_once
        )
