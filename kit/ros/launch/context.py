"""The state of a running launch file: arguments, environment, namespaces, event handlers.

Entities and event handlers are built on the context; it knows them by the protocols below.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol

from kit.ros.launch.errors import LaunchError

if TYPE_CHECKING:
    from kit.ros.launch.events import Event


class Visitable(Protocol):
    """A launch description entity."""

    def visit(self, context: LaunchContext) -> Iterable[Any] | None: ...


class RegisteredHandler(Protocol):
    """An event handler."""

    needs_output: bool

    def matches(self, event: Event) -> bool: ...

    def handle(self, event: Event, context: LaunchContext) -> Iterable[Any]: ...


class PerformableText(Protocol):
    """A substitution."""

    def perform(self, context: LaunchContext) -> str: ...


@dataclass
class Scope:
    """The settings that a group of actions can change without affecting what is outside the group."""

    configurations: dict[str, str] = field(default_factory=dict)
    environment: dict[str, str] = field(default_factory=dict)
    namespace: str = ""
    parameters: list[tuple[str, str]] = field(default_factory=list)
    """Names and values, as ``-p`` takes them, for every node that is started."""
    parameter_files: list[str] = field(default_factory=list)
    remappings: list[tuple[str, str]] = field(default_factory=list)

    def copy(self) -> Scope:
        return Scope(
            dict(self.configurations),
            dict(self.environment),
            self.namespace,
            list(self.parameters),
            list(self.parameter_files),
            list(self.remappings),
        )


class LaunchContext:
    """The argument of substitutions, conditions, functions and event handlers."""

    def __init__(self, *, argv: Iterable[str] = (), environment: dict[str, str] | None = None) -> None:
        self.argv = list(argv)
        self.files: list[str] = []
        """The launch files being loaded, each included by the one before."""
        self.handlers: list[RegisteredHandler] = []
        self.emit: Callable[[Event], None] = _ignore
        """Queues an event; it is handled after the present action."""
        self.request: Callable[..., None] = _ignore
        """Sends a request to the process that runs the launch; see ``service``."""
        self.read_markup: Callable[[str, bytes], Any] = _ignore
        """Reads a launch file in XML or YAML, given its path and content, into a launch description."""
        self.start_timer: Callable[[float, Iterable[Any]], Callable[[], None]]
        self.anonymous_names: dict[str, int] = {}
        """The numbers that make names unique."""
        self.is_shutdown = False
        self._loop_values: list[dict[str, str]] = [{}]
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
        """Opens a scope: changes from here on are undone by ``pop``."""
        self._scopes.append(self.scope.copy())

    def pop(self) -> None:
        self._scopes.pop()

    @property
    def loop_values(self) -> dict[str, str]:
        """The values of the present rounds of all loops around, by name."""
        return self._loop_values[-1]

    def push_loop_values(self, values: dict[str, str]) -> None:
        """Adds the values of a round until ``pop_loop_values``."""
        self._loop_values.append(self.loop_values | values)

    def pop_loop_values(self) -> None:
        self._loop_values.pop()

    def perform_substitution(self, substitution: PerformableText) -> str:
        return substitution.perform(self)

    def register_event_handler(self, event_handler: RegisteredHandler) -> None:
        self.handlers.insert(0, event_handler)
        if event_handler.needs_output:
            self.request("listen")

    def unregister_event_handler(self, event_handler: RegisteredHandler) -> None:
        if event_handler not in self.handlers:
            raise LaunchError("this event handler is not registered")
        self.handlers.remove(event_handler)

    def emit_event_sync(self, event: Event) -> None:
        self.emit(event)


def _ignore(*_: Any) -> None:
    """Does nothing: no launch is running."""
