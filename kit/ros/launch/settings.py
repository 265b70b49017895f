"""Launch actions that change what the following actions see: arguments and environment variables, and groups that limit it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from kit.ros.launch.context import LaunchContext
from kit.ros.launch.entity import Action, Condition, LaunchDescriptionEntity, to_entities
from kit.ros.launch.substitutions import SomeText, normalize_to_substitutions, perform_substitutions


def perform_mapping(context: LaunchContext, values: Mapping[Any, SomeText]) -> dict[str, str]:
    """Determines names and values now."""
    return {
        perform_substitutions(context, name): perform_substitutions(context, value)
        for name, value in values.items()
    }


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


class PushLaunchConfigurations(Action):
    """Keeps the values of all launch arguments until ``PopLaunchConfigurations``."""

    def execute(self, context: LaunchContext) -> None:
        context.push_configurations()


class PopLaunchConfigurations(Action):
    """Goes back to the values that ``PushLaunchConfigurations`` kept."""

    def execute(self, context: LaunchContext) -> None:
        context.pop_configurations()


class ResetLaunchConfigurations(Action):
    """Removes all launch arguments but those given here, whose values are determined before."""

    def __init__(
        self,
        launch_configurations: Mapping[Any, SomeText] | None = None,
        *,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.launch_configurations = dict(launch_configurations or {})

    def execute(self, context: LaunchContext) -> None:
        context.reset_configurations(perform_mapping(context, self.launch_configurations))


class PushEnvironment(Action):
    """Keeps the environment variables until ``PopEnvironment``."""

    def execute(self, context: LaunchContext) -> None:
        context.push_environment()


class PopEnvironment(Action):
    """Goes back to the environment variables that ``PushEnvironment`` kept."""

    def execute(self, context: LaunchContext) -> None:
        context.pop_environment()


class ResetEnvironment(Action):
    """Sets the environment variables to those with which the launch began."""

    def execute(self, context: LaunchContext) -> None:
        context.replace_environment()


class ReplaceEnvironmentVariables(Action):
    """Removes all environment variables and sets these."""

    def __init__(
        self, environment: Mapping[Any, SomeText] | None = None, *, condition: Condition | None = None
    ) -> None:
        super().__init__(condition=condition)
        self.variables = dict(environment or {})

    def execute(self, context: LaunchContext) -> None:
        context.replace_environment(perform_mapping(context, self.variables))


class GroupAction(Action):
    """Several actions under one condition; their settings apply only inside the group, unless ``scoped`` is false.

    Without ``forwarding``, the group sees none of the arguments outside it but its own ``launch_configurations``,
    and the environment with which the launch began.
    """

    def __init__(
        self,
        actions: Iterable[LaunchDescriptionEntity],
        *,
        scoped: bool = True,
        forwarding: bool = True,
        launch_configurations: Mapping[Any, SomeText] | None = None,
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
        if not self.scoped:
            return [*given, *self.actions]
        begin = given if self.forwarding else reset_settings(self.launch_configurations)
        return within_scope([*begin, *self.actions])


def within_scope(entities: Iterable[LaunchDescriptionEntity]) -> list[LaunchDescriptionEntity]:
    """The entities, with what undoes their settings after them."""
    return [
        PushLaunchConfigurations(),
        PushEnvironment(),
        *entities,
        PopEnvironment(),
        PopLaunchConfigurations(),
    ]


def reset_settings(kept: Mapping[Any, SomeText]) -> list[LaunchDescriptionEntity]:
    """Actions that start with these launch arguments alone."""
    return [ResetLaunchConfigurations(kept), ResetEnvironment()]
