"""Launch descriptions and what they consist of: entities, some of them actions, carried out where their condition is true."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, Protocol

from kit.ros.launch.bounds import MAX_ACTIONS
from kit.ros.launch.context import LaunchContext, LaunchError, calling_location
from kit.ros.launch.substitutions import (
    SomeText,
    describe_substitutions,
    normalize_to_substitutions,
    perform_substitutions,
)

_TRUE, _FALSE = ("true", "1"), ("false", "0")


class Condition:
    """A condition that calls ``predicate(context)``."""

    def __init__(self, *, predicate: Callable[[LaunchContext], bool]) -> None:
        self._predicate = predicate

    def evaluate(self, context: LaunchContext) -> bool:
        return bool(self._predicate(context))


class IfCondition(Condition):
    """True if the text is ``true`` or ``1``."""

    def __init__(self, predicate_expression: SomeText | bool) -> None:
        text: Any = (
            str(predicate_expression) if isinstance(predicate_expression, bool) else predicate_expression
        )
        self._expression = normalize_to_substitutions(text)
        super().__init__(predicate=self._is_true)

    def _is_true(self, context: LaunchContext) -> bool:
        text = perform_substitutions(context, self._expression)
        if text.strip().lower() not in (*_TRUE, *_FALSE):
            raise LaunchError(
                f"{describe_substitutions(self._expression)} is '{text}': a condition must be one of {', '.join(_TRUE + _FALSE)}"
            )
        return text.strip().lower() in _TRUE


class UnlessCondition(IfCondition):
    """True if the text is ``false`` or ``0``."""

    def _is_true(self, context: LaunchContext) -> bool:
        return not super()._is_true(context)


class LaunchConfigurationEquals(Condition):
    """True if a launch argument has this value; with None: if it has none."""

    def __init__(self, launch_configuration_name: str, expected_value: SomeText | None) -> None:
        self._name = launch_configuration_name
        self._expected = None if expected_value is None else normalize_to_substitutions(expected_value)
        super().__init__(predicate=self._is_equal)

    def _is_equal(self, context: LaunchContext) -> bool:
        value = context.launch_configurations.get(self._name)
        return value == (None if self._expected is None else perform_substitutions(context, self._expected))


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """True if a launch argument does not have this value."""

    def _is_equal(self, context: LaunchContext) -> bool:
        return not super()._is_equal(context)


class ArgumentDeclaration(Protocol):
    """A ``DeclareLaunchArgument``."""

    name: str
    description: str
    choices: list[str] | None

    @property
    def shown_default(self) -> str | None: ...


class LaunchDescriptionEntity:
    """Something that a launch carries out."""

    def visit(self, context: LaunchContext) -> Iterable[LaunchDescriptionEntity] | None:
        """Carries the entity out; returns the entities to carry out next."""
        raise NotImplementedError(f"{type(self).__name__}.visit")

    def sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        """The entities it contains, as far as they are known before it is carried out."""
        return ()

    def declared_arguments(self) -> list[ArgumentDeclaration]:
        """The launch arguments that it declares itself, without those of ``sub_entities``."""
        return []


class Action(LaunchDescriptionEntity):
    """An entity that may depend on a condition."""

    completes_later = False
    """Whether it goes on after ``execute``, as a process does; then the launch service tells when it is complete."""

    def __init__(self, *, condition: Condition | None = None) -> None:
        self.condition = condition
        self.location = calling_location()
        """The line of the launch file that made it."""

    def visit(self, context: LaunchContext) -> Iterable[LaunchDescriptionEntity] | None:
        if self.condition is not None and not self.condition.evaluate(context):
            return None
        followed_by = self.execute(context)
        if not self.completes_later:
            context.report_complete(self)
        return followed_by

    def execute(self, context: LaunchContext) -> Iterable[LaunchDescriptionEntity] | None:
        """Carries the action out; defined by subclasses."""
        raise NotImplementedError(f"{type(self).__name__}.execute")


class LaunchDescription(LaunchDescriptionEntity):
    """The entities of a launch file: the result of its ``generate_launch_description``."""

    def __init__(
        self,
        initial_entities: Iterable[LaunchDescriptionEntity] | None = None,
        *,
        deprecated_reason: str | None = None,
    ) -> None:
        self.entities = to_entities(initial_entities)
        self.deprecated_reason = deprecated_reason

    def add_action(self, action: Action) -> None:
        self.entities.append(action)

    def add_entity(self, entity: LaunchDescriptionEntity) -> None:
        self.entities.append(entity)

    def visit(self, context: LaunchContext) -> Iterable[LaunchDescriptionEntity]:
        if self.deprecated_reason is not None:
            context.request("log", "WARN", f"this launch file is deprecated: {self.deprecated_reason}")
        return self.entities

    def sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        return self.entities

    def get_launch_arguments(self) -> list[ArgumentDeclaration]:
        """The arguments that it and its entities declare, each name once. Raises LaunchError if they are too many to look at."""
        found: dict[str, ArgumentDeclaration] = {}
        waiting: list[Any] = [self]
        visited = 0
        while waiting:
            entity = waiting.pop(0)
            visited += 1
            if visited > MAX_ACTIONS:
                raise LaunchError(
                    f"more than {MAX_ACTIONS:,} actions; does one contain itself?",
                    getattr(entity, "location", None),
                )
            if isinstance(entity, LaunchDescriptionEntity):
                for argument in entity.declared_arguments():
                    found.setdefault(argument.name, argument)
                waiting[:0] = entity.sub_entities()
        return list(found.values())


def to_entities(actions: Any) -> list[LaunchDescriptionEntity]:
    """Normalizes None, one entity, or nested iterables of entities to a list. Raises TypeError for anything else."""
    if actions is None:
        return []
    if isinstance(actions, LaunchDescriptionEntity):
        return [actions]
    if isinstance(actions, Iterable):
        return [entity for entry in actions for entity in to_entities(entry)]
    raise TypeError(f"an action, or a list of actions, is needed here, not {type(actions).__name__}")
