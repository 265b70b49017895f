"""What holds while a launch file is carried out: arguments, environment, namespaces; and who waits for which event."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from kit.ros.launch.errors import LaunchError

if TYPE_CHECKING:
    from kit.ros.launch.entity import LaunchDescriptionEntity
    from kit.ros.launch.event_handlers import EventHandler
    from kit.ros.launch.events import Event
    from kit.ros.launch.substitutions import Substitution


@dataclass
class Scope:
    """What a group of actions can change for itself alone."""

    configurations: dict[str, str] = field(default_factory=dict)
    environment: dict[str, str] = field(default_factory=dict)
    namespace: str = ""
    parameters: list[tuple[str, str]] = field(default_factory=list)
    """For every node: names, and values as ``-p`` takes them."""
    remappings: list[tuple[str, str]] = field(default_factory=list)

    def copied(self) -> Scope:
        return Scope(
            dict(self.configurations),
            dict(self.environment),
            self.namespace,
            list(self.parameters),
            list(self.remappings),
        )


class LaunchContext:
    """Handed to substitutions, conditions, functions and event handlers."""

    def __init__(self, *, argv: Iterable[str] = (), environment: dict[str, str] | None = None) -> None:
        self.argv = list(argv)
        self.files: list[str] = []
        """The launch files being read, each included by the one before."""
        self.handlers: list[EventHandler] = []
        self.emit: Callable[[Event], None] = _nobody_listens
        """Has an event handled after what is being done."""
        self.request: Callable[..., None] = _nobody_listens
        """Asks whoever carries the launch out for something; see ``service``."""
        self.start_timer: Callable[[float, Iterable[LaunchDescriptionEntity]], Callable[[], None]]
        self.is_shutdown = False
        self._scopes = [Scope(environment=dict(os.environ if environment is None else environment))]

    @property
    def scope(self) -> Scope:
        return self._scopes[-1]

    @property
    def launch_configurations(self) -> dict[str, str]:
        return self.scope.configurations

    @property
    def environment(self) -> dict[str, str]:
        return self.scope.environment

    def push(self) -> None:
        """What is changed from here on holds until ``pop``."""
        self._scopes.append(self.scope.copied())

    def pop(self) -> None:
        self._scopes.pop()

    def perform_substitution(self, substitution: Substitution) -> str:
        return substitution.perform(self)

    def register_event_handler(self, event_handler: EventHandler) -> None:
        self.handlers.insert(0, event_handler)
        if event_handler.hears_output:
            self.request("listen")

    def unregister_event_handler(self, event_handler: EventHandler) -> None:
        if event_handler not in self.handlers:
            raise LaunchError("this event handler is not registered")
        self.handlers.remove(event_handler)

    def emit_event_sync(self, event: Event) -> None:
        self.emit(event)


def _nobody_listens(*_: Any) -> None:
    """Outside a run nothing is carried out."""
