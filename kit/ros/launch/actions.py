"""Launch actions that start no process: arguments, environment, groups, includes, timers, functions, shutdown."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from kit.ros.launch.conditions import Condition
from kit.ros.launch.context import LaunchContext
from kit.ros.launch.entity import (
    Action,
    ArgumentDeclaration,
    LaunchDescription,
    LaunchDescriptionEntity,
    to_entities,
)
from kit.ros.launch.errors import LaunchError
from kit.ros.launch.event_handlers import EventHandler
from kit.ros.launch.events import Event
from kit.ros.launch.events import Shutdown as ShutdownEvent
from kit.ros.launch.loops import with_loop_values
from kit.ros.launch.sources import LaunchDescriptionSource
from kit.ros.launch.substitutions import (
    SomeText,
    Substitution,
    describe_substitutions,
    normalize_to_substitutions,
    perform_substitutions,
)

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


class SetLaunchConfiguration(Action):
    """Sets the value of a launch argument."""

    def __init__(self, name: SomeText, value: SomeText, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name, self.value = normalize_to_substitutions(name), normalize_to_substitutions(value)

    def execute(self, context: LaunchContext) -> None:
        context.launch_configurations[perform_substitutions(context, self.name)] = perform_substitutions(
            context, self.value
        )


class UnsetLaunchConfiguration(Action):
    """Removes the value of a launch argument."""

    def __init__(self, name: SomeText, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name = normalize_to_substitutions(name)

    def execute(self, context: LaunchContext) -> None:
        context.launch_configurations.pop(perform_substitutions(context, self.name), None)


class SetEnvironmentVariable(Action):
    """Sets a variable for every process that is started afterwards."""

    def __init__(self, name: SomeText, value: SomeText, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name, self.value = normalize_to_substitutions(name), normalize_to_substitutions(value)

    def execute(self, context: LaunchContext) -> None:
        context.environment[perform_substitutions(context, self.name)] = perform_substitutions(
            context, self.value
        )


class AppendEnvironmentVariable(SetEnvironmentVariable):
    """Appends to a variable's value, or prepends."""

    def __init__(
        self,
        name: SomeText,
        value: SomeText,
        *,
        prepend: bool = False,
        separator: SomeText = ":",
        condition: Condition | None = None,
    ) -> None:
        super().__init__(name, value, condition=condition)
        self.prepend, self.separator = prepend, normalize_to_substitutions(separator)

    def execute(self, context: LaunchContext) -> None:
        name, value = perform_substitutions(context, self.name), perform_substitutions(context, self.value)
        parts = [part for part in (context.environment.get(name), value) if part]
        joined = perform_substitutions(context, self.separator).join(
            reversed(parts) if self.prepend else parts
        )
        context.environment[name] = joined


class UnsetEnvironmentVariable(Action):
    """Removes a variable."""

    def __init__(self, name: SomeText, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name = normalize_to_substitutions(name)

    def execute(self, context: LaunchContext) -> None:
        context.environment.pop(perform_substitutions(context, self.name), None)


class LogInfo(Action):
    """Logs a line."""

    def __init__(self, *, msg: SomeText, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.msg = normalize_to_substitutions(msg)

    def execute(self, context: LaunchContext) -> None:
        context.request("log", "INFO", perform_substitutions(context, self.msg))


class _Step(LaunchDescriptionEntity):
    """Wraps a function of the context as an entity."""

    def __init__(self, step: Callable[[LaunchContext], Any]) -> None:
        self._step = step

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        found = self._step(context)
        return found if isinstance(found, list) else []


class GroupAction(Action):
    """Several actions under one condition; their settings apply only inside the group, unless ``scoped`` is false."""

    def __init__(
        self,
        actions: Entities,
        *,
        scoped: bool = True,
        forwarding: bool = True,
        launch_configurations: dict[str, SomeText] | None = None,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.actions = to_entities(actions)
        self.scoped, self.forwarding = scoped, forwarding
        self.launch_configurations = dict(launch_configurations or {})

    def sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        return self.actions

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        given = [SetLaunchConfiguration(name, value) for name, value in self.launch_configurations.items()]
        inside = [*given, *self.actions]
        if not self.scoped:
            return inside
        forget = [] if self.forwarding else [_Step(lambda context: context.launch_configurations.clear())]
        return [_Step(LaunchContext.push), *forget, *inside, _Step(LaunchContext.pop)]


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
        return [*given, _Step(self._include)]

    def _include(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        self._enter(context)
        return [_Included(self.source), _Step(lambda context: context.files.pop())]

    def _enter(self, context: LaunchContext) -> None:
        path = self.source.path(context)
        if path in context.files:
            circle = " -> ".join(context.files[context.files.index(path) :])
            raise LaunchError(f"launch files include each other without end: {circle} -> {path}")
        context.files.append(path)


class _Included(LaunchDescriptionEntity):
    def __init__(self, source: LaunchDescriptionSource) -> None:
        self._source = source

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        return [self._source.load(context)]


class TimerAction(Action):
    """Carries out actions ``period`` seconds later."""

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
                f"the period of a TimerAction is '{text}', which is no number of seconds"
            ) from None
        values = context.loop_values  # of the round in which the timer is started
        actions = with_loop_values(values, self.actions) if values else self.actions
        self._cancel = context.start_timer(seconds, actions)

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


__all__ = [
    "AppendEnvironmentVariable",
    "DeclareLaunchArgument",
    "EmitEvent",
    "GroupAction",
    "IncludeLaunchDescription",
    "LaunchDescription",
    "LogInfo",
    "OpaqueFunction",
    "RegisterEventHandler",
    "SetEnvironmentVariable",
    "SetLaunchConfiguration",
    "Shutdown",
    "Substitution",
    "TimerAction",
    "UnregisterEventHandler",
    "UnsetEnvironmentVariable",
    "UnsetLaunchConfiguration",
]
