"""Entities: what a launch description consists of, and the actions among them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from kit.ros.launch.errors import calling_place

if TYPE_CHECKING:
    from kit.ros.launch.actions import DeclareLaunchArgument
    from kit.ros.launch.conditions import Condition
    from kit.ros.launch.context import LaunchContext


class LaunchDescriptionEntity:
    """Something to be carried out."""

    def visit(self, context: LaunchContext) -> Iterable[LaunchDescriptionEntity] | None:
        """Carries it out; what it consists of is carried out next."""
        raise NotImplementedError(f"{type(self).__name__}.visit")

    def parts(self) -> Sequence[LaunchDescriptionEntity]:
        """What it consists of as far as that is known before it is carried out."""
        return ()


class Action(LaunchDescriptionEntity):
    """An entity that may depend on a condition."""

    def __init__(self, *, condition: Condition | None = None) -> None:
        self.condition = condition
        self.place = calling_place()
        """The line of the launch file that made it."""

    def visit(self, context: LaunchContext) -> Iterable[LaunchDescriptionEntity] | None:
        if self.condition is None or self.condition.evaluate(context):
            return self.execute(context)
        return None

    def execute(self, context: LaunchContext) -> Iterable[LaunchDescriptionEntity] | None:
        """What subclasses do."""
        raise NotImplementedError(f"{type(self).__name__}.execute")


class LaunchDescription(LaunchDescriptionEntity):
    """What ``generate_launch_description`` returns."""

    def __init__(
        self,
        initial_entities: Iterable[LaunchDescriptionEntity] | None = None,
        *,
        deprecated_reason: str | None = None,
    ) -> None:
        self.entities = entities(initial_entities)
        self.deprecated_reason = deprecated_reason

    def add_action(self, action: Action) -> None:
        self.entities.append(action)

    def add_entity(self, entity: LaunchDescriptionEntity) -> None:
        self.entities.append(entity)

    def visit(self, context: LaunchContext) -> Iterable[LaunchDescriptionEntity]:
        if self.deprecated_reason is not None:
            context.request("log", "WARN", f"this launch file is deprecated: {self.deprecated_reason}")
        return self.entities

    def parts(self) -> Sequence[LaunchDescriptionEntity]:
        return self.entities

    def get_launch_arguments(self) -> list[DeclareLaunchArgument]:
        """All arguments that it and its parts declare, each name once."""
        from kit.ros.launch.actions import DeclareLaunchArgument

        found: dict[str, DeclareLaunchArgument] = {}
        waiting: list[Any] = [self]
        while waiting:
            entity = waiting.pop(0)
            if isinstance(entity, DeclareLaunchArgument):
                found.setdefault(entity.name, entity)
            waiting[:0] = entity.parts() if isinstance(entity, LaunchDescriptionEntity) else ()
        return list(found.values())


def entities(found: Any) -> list[LaunchDescriptionEntity]:
    """What a function or an argument gave, as a list: nothing, one entity, or several. TypeError otherwise."""
    if found is None:
        return []
    if isinstance(found, LaunchDescriptionEntity):
        return [found]
    if isinstance(found, Iterable):
        return [entity for entry in found for entity in entities(entry)]
    raise TypeError(f"an action, or a list of actions, is needed here, not {type(found).__name__}")
