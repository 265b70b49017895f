"""Actions that start no process: arguments, includes, log lines, timers, functions, events."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from inspect import iscoroutinefunction
from types import MappingProxyType
from typing import Any, Final

from kit.ros.launch.context import LaunchContext, LaunchError
from kit.ros.launch.description_sources import LaunchDescriptionSource, load_launch_file
from kit.ros.launch.entity import (
    Action,
    ArgumentDeclaration,
    Condition,
    LaunchDescriptionEntity,
    to_entities,
)
from kit.ros.launch.event_handlers import EventHandler
from kit.ros.launch.events import Event
from kit.ros.launch.events import Shutdown as ShutdownEvent
from kit.ros.launch.loops import with_loop_values
from kit.ros.launch.settings import SetLaunchConfiguration, reset_settings, within_scope
from kit.ros.launch.substitutions import (
    SomeText,
    describe_substitutions,
    normalize_to_substitutions,
    perform_substitutions,
)
from kit.ros.launch.unavailable import SoftwareUnavailable

Entities = Iterable[LaunchDescriptionEntity]


class DeclareLaunchArgument(Action):
    """An argument of the launch file: ``name:=value`` on the command line."""

    def __init__(
        self,
        name: str,
        *,
        default_value: SomeText | None = None,
        description: str | None = None,
        choices: Iterable[str] | None = None,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.name = name
        self.default_value = None if default_value is None else normalize_to_substitutions(default_value)
        self.description = description or "no description given"
        self.choices = None if choices is None else list(choices)

    def declared_arguments(self) -> list[ArgumentDeclaration]:
        return [self]

    @property
    def shown_default(self) -> str | None:
        """The default as ``--show-args`` prints it."""
        return None if self.default_value is None else describe_substitutions(self.default_value)

    def execute(self, context: LaunchContext) -> None:
        if self.name not in context.launch_configurations:
            if self.default_value is None:
                raise LaunchError(
                    f"Required launch argument '{self.name}' (description: '{self.description}') was not "
                    f"provided: add {self.name}:=VALUE to the command"
                )
            context.launch_configurations[self.name] = perform_substitutions(context, self.default_value)
        value = context.launch_configurations[self.name]
        if self.choices is not None and value not in self.choices:
            raise LaunchError(
                f"Argument '{self.name}' provided value '{value}' is not valid. Valid options are: {self.choices}"
            )


class DeclareBooleanLaunchArgument(DeclareLaunchArgument):
    """An argument of the launch file that is ``true`` or ``false``, in any case."""

    def __init__(
        self,
        name: str,
        *,
        default_value: SomeText | bool | None = None,
        description: str | None = None,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(
            name,
            default_value=str(default_value) if isinstance(default_value, bool) else default_value,
            description=description,
            choices=("true", "false", "True", "False", "TRUE", "FALSE"),
            condition=condition,
        )


LOG_LEVELS: Final = MappingProxyType(
    {
        "DEBUG": "DEBUG",
        "INFO": "INFO",
        "WARNING": "WARN",
        "WARN": "WARN",
        "ERROR": "ERROR",
        "CRITICAL": "FATAL",
    }
)
"""The levels of Python's logging, in which launch files give them, as ROS calls them."""


class Log(Action):
    """Logs a line at a level: DEBUG, INFO, WARNING, ERROR or CRITICAL."""

    def __init__(self, *, msg: SomeText, level: SomeText, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.msg, self.level = normalize_to_substitutions(msg), normalize_to_substitutions(level)

    def execute(self, context: LaunchContext) -> None:
        level = perform_substitutions(context, self.level).upper()
        if level not in LOG_LEVELS:
            raise LaunchError(f"'{level}' is not a log level; available: {', '.join(LOG_LEVELS)}")
        context.request("log", LOG_LEVELS[level], perform_substitutions(context, self.msg))


class LogInfo(Log):
    """Logs a line at level INFO."""

    def __init__(self, *, msg: SomeText, condition: Condition | None = None) -> None:
        super().__init__(msg=msg, level="INFO", condition=condition)


class LogWarning(Log):
    """Logs a line at level WARNING."""

    def __init__(self, *, msg: SomeText, condition: Condition | None = None) -> None:
        super().__init__(msg=msg, level="WARNING", condition=condition)


class LogError(Log):
    """Logs a line at level ERROR."""

    def __init__(self, *, msg: SomeText, condition: Condition | None = None) -> None:
        super().__init__(msg=msg, level="ERROR", condition=condition)


class LogDebug(Log):
    """Logs a line at level DEBUG."""

    def __init__(self, *, msg: SomeText, condition: Condition | None = None) -> None:
        super().__init__(msg=msg, level="DEBUG", condition=condition)


class _ContextStep(LaunchDescriptionEntity):
    """Calls a function with the context, and carries out what it returns."""

    def __init__(self, function: Callable[[LaunchContext], list[LaunchDescriptionEntity] | None]) -> None:
        self._function = function

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        return self._function(context) or []


class IncludeLaunchDescription(Action):
    """Includes another launch file, with its own arguments."""

    def __init__(
        self,
        launch_description_source: LaunchDescriptionSource | SomeText,
        *,
        launch_arguments: Mapping[Any, SomeText] | Iterable[tuple[SomeText, SomeText]] | None = None,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        if not isinstance(launch_description_source, LaunchDescriptionSource):
            launch_description_source = LaunchDescriptionSource(launch_description_source)
        self.source = launch_description_source
        pairs = launch_arguments.items() if isinstance(launch_arguments, Mapping) else launch_arguments
        self.launch_arguments = list(pairs or ())

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        given = [SetLaunchConfiguration(name, value) for name, value in self.launch_arguments]
        return [*given, _ContextStep(self._enter)]

    def _enter(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        path = self.source.path(context)
        if path in context.files:
            circle = " -> ".join(context.files[context.files.index(path) :])
            raise LaunchError(f"launch files include each other without end: {circle} -> {path}")
        context.files.append(path)
        return [
            _ContextStep(lambda context: [load_launch_file(context, path)]),
            _ContextStep(lambda context: [] if context.files.pop() else None),
        ]


class ScopedIncludeLaunchDescription(IncludeLaunchDescription):
    """Includes another launch file, which sees only the arguments given here and whose settings end with it."""

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        given = {
            perform_substitutions(context, name): perform_substitutions(context, value)
            for name, value in self.launch_arguments
        }
        return within_scope([*reset_settings(given), _ContextStep(self._enter)])


class TimerAction(Action):
    """Carries out actions ``period`` seconds later."""

    completes_later = True

    def __init__(
        self,
        *,
        period: float | SomeText,
        actions: Entities,
        cancel_on_shutdown: bool = True,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.period = normalize_to_substitutions(str(period) if isinstance(period, (int, float)) else period)
        self.actions = to_entities(actions)
        self._cancel: Callable[[], None] | None = None

    def sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        return self.actions

    def execute(self, context: LaunchContext) -> None:
        text = perform_substitutions(context, self.period)
        try:
            seconds = float(text)
        except ValueError:
            raise LaunchError(
                f"the period of a TimerAction is '{text}', which is not a number of seconds"
            ) from None
        values = context.loop_values  # of the round in which the timer is started
        actions = with_loop_values(values, self.actions) if values else self.actions
        self._cancel = context.start_timer(seconds, actions, self)

    def cancel(self) -> None:
        if self._cancel is not None:
            self._cancel()


class OpaqueFunction(Action):
    """Calls ``function(context, *args, **kwargs)`` and carries out the actions it returns."""

    def __init__(
        self,
        *,
        function: Callable[..., Any],
        args: Iterable[Any] | None = None,
        kwargs: dict[str, Any] | None = None,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.function, self.args, self.kwargs = function, tuple(args or ()), dict(kwargs or {})

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        return to_entities(self.function(context, *self.args, **self.kwargs))


class OpaqueCoroutine(Action):
    """A coroutine of the launch file: it is skipped, since a launch of the kit has no event loop of asyncio."""

    def __init__(
        self,
        *,
        coroutine: Callable[..., Any],
        args: Iterable[Any] | None = None,
        kwargs: dict[str, Any] | None = None,
        ignore_context: bool = False,
        condition: Condition | None = None,
    ) -> None:
        if not iscoroutinefunction(coroutine):
            raise TypeError(f"OpaqueCoroutine needs a coroutine function, not {type(coroutine).__name__}")
        super().__init__(condition=condition)

    def execute(self, context: LaunchContext) -> None:
        raise SoftwareUnavailable(
            "the kit carries out a launch step by step, without asyncio: use OpaqueFunction, and TimerAction to wait"
        )


class RegisterEventHandler(Action):
    """Registers an event handler."""

    def __init__(self, event_handler: EventHandler, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.event_handler = event_handler

    def execute(self, context: LaunchContext) -> None:
        context.register_event_handler(self.event_handler)


class UnregisterEventHandler(RegisterEventHandler):
    """Unregisters an event handler."""

    def execute(self, context: LaunchContext) -> None:
        context.unregister_event_handler(self.event_handler)


class EmitEvent(Action):
    """Emits an event."""

    def __init__(self, *, event: Event, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.event = event

    def execute(self, context: LaunchContext) -> None:
        context.emit(self.event)


class Shutdown(Action):
    """Shuts down everything that the launch has started."""

    def __init__(
        self, *, reason: str = "reason not given", condition: Condition | None = None, **_: Any
    ) -> None:
        super().__init__(condition=condition)
        self.reason = reason

    def execute(self, context: LaunchContext) -> None:
        context.emit(ShutdownEvent(reason=self.reason))
