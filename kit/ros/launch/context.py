"""The state of a running launch file (arguments, environment, namespaces, event handlers), and its errors with their lines.

Entities and event handlers are built on the context; it knows them by the protocols below.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Final, NamedTuple, Protocol

from kit.ros.launch.events import Event, ExecutionComplete

_LIBRARY_FOLDER: Final = __file__.rpartition("/launch/")[0]
"""The folder of ``kit.ros``: frames below it are the library's, frames elsewhere the launch file's author's."""
_CALLING_FOLDER: Final = f"{_LIBRARY_FOLDER.rpartition('/')[0]}/host/"
"""The folder of ``kit.host``, which carries launch files out: no author's frame lies behind it."""


class LaunchFileLocation(NamedTuple):
    """A line of a launch file, or of a module it imports."""

    file: str
    line: int


class LaunchError(Exception):
    """A launch file that cannot be carried out; ``location`` is the line that caused it, if known."""

    def __init__(self, message: str, location: LaunchFileLocation | None = None) -> None:
        super().__init__(message)
        self.location = location


class SubstitutionFailure(LaunchError):
    """A substitution that cannot be performed."""


def calling_location() -> LaunchFileLocation | None:
    """The innermost line of the call stack that is outside this library; None if there is none."""
    frame = sys._getframe(1)
    while frame.f_code.co_filename.startswith(_LIBRARY_FOLDER):
        if frame.f_back is None:
            return None
        frame = frame.f_back
    if frame.f_code.co_filename.startswith(_CALLING_FOLDER):
        return None
    return LaunchFileLocation(frame.f_code.co_filename, frame.f_lineno)


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
    namespace: str = ""
    parameters: list[tuple[str, str]] = field(default_factory=list)
    """Names and values, as ``-p`` takes them, for every node that is started."""
    parameter_files: list[str] = field(default_factory=list)
    remappings: list[tuple[str, str]] = field(default_factory=list)

    def copy(self) -> Scope:
        return Scope(
            dict(self.configurations),
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
        self.start_timer: Callable[[float, Iterable[Any], Visitable], Callable[[], None]]
        """Carries out entities after some seconds, for an action that is complete then; returns what cancels it."""
        self.on_ready_to_test: Callable[[], object] = _ignore
        """Called when the tests of the launch may begin."""
        self.location: LaunchFileLocation | None = None
        """The line of the launch file that is being carried out."""
        self.anonymous_names: dict[str, int] = {}
        """The numbers that make names unique."""
        self.is_shutdown = False
        self._loop_values: list[dict[str, str]] = [{}]
        self._events: list[Event] = []
        self._scopes = [Scope()]
        self._initial_environment = dict(os.environ if environment is None else environment)
        self._environments = [dict(self._initial_environment)]
        self._own_environment = dict(os.environ)
        """The variables of this process as they were last seen."""

    @property
    def scope(self) -> Scope:
        return self._scopes[-1]

    @property
    def launch_configurations(self) -> dict[str, str]:
        return self.scope.configurations

    @property
    def environment(self) -> dict[str, str]:
        """The environment variables, with what the launch file itself has set in ``os.environ``."""
        environment, seen = self._environments[-1], self._own_environment
        if os.environ != seen:
            for name in seen.keys() - os.environ.keys():
                environment.pop(name, None)
            environment.update({name: value for name, value in os.environ.items() if seen.get(name) != value})
            self._own_environment = dict(os.environ)
        return environment

    def push_configurations(self) -> None:
        """Opens a scope: changes of arguments, namespace, parameters and remappings are undone by ``pop_configurations``."""
        self._scopes.append(self.scope.copy())

    def pop_configurations(self) -> None:
        """Raises LaunchError if no scope is open."""
        if len(self._scopes) == 1:
            raise LaunchError("PopLaunchConfigurations without PushLaunchConfigurations before it")
        self._scopes.pop()

    def reset_configurations(self, configurations: dict[str, str]) -> None:
        """Forgets namespace, parameters, remappings and all arguments but these."""
        self._scopes[-1] = Scope(configurations=dict(configurations))

    def push_environment(self) -> None:
        """Opens a scope: changes of environment variables are undone by ``pop_environment``."""
        self._environments.append(dict(self.environment))

    def pop_environment(self) -> None:
        """Raises LaunchError if no scope is open."""
        if len(self._environments) == 1:
            raise LaunchError("PopEnvironment without PushEnvironment before it")
        self._environments.pop()

    def replace_environment(self, variables: dict[str, str] | None = None) -> None:
        """Sets all environment variables; None: to those with which the launch began."""
        self._environments[-1] = dict(self._initial_environment if variables is None else variables)

    @property
    def locals(self) -> SimpleNamespace:
        """What ``LocalSubstitution`` can name: the event being handled, and the present launch file and its folder."""
        there: dict[str, Any] = {"event": self._events[-1]} if self._events else {}
        if self.files:
            path = self.files[-1]
            there["current_launch_file_path"] = path
            there["current_launch_file_directory"] = str(Path(path).parent)
        return SimpleNamespace(**there)

    def push_event(self, event: Event) -> None:
        """Makes it the event being handled until ``pop_event``."""
        self._events.append(event)

    def pop_event(self) -> None:
        self._events.pop()

    def would_handle_event(self, event: Event) -> bool:
        """True if a handler is registered that the event matches."""
        return any(handler.matches(event) for handler in self.handlers)

    @property
    def loop_values(self) -> dict[str, str]:
        """The values of the present rounds of all loops around, by name."""
        return self._loop_values[-1]

    def push_loop_values(self, values: dict[str, str]) -> None:
        """Adds the values of a round until ``pop_loop_values``."""
        self._loop_values.append(self.loop_values | values)

    def pop_loop_values(self) -> None:
        self._loop_values.pop()

    def report_complete(self, action: Visitable) -> None:
        """Emits ``ExecutionComplete`` for an action, if there is a handler for it."""
        event = ExecutionComplete(action=action)
        if self.would_handle_event(event):
            self.emit(event)

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
