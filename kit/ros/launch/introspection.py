"""Describes launch descriptions as text, an entity on a line: ``launch.LaunchIntrospector``."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from kit.ros.launch.entity import LaunchDescription, LaunchDescriptionEntity
from kit.ros.launch.event_handlers import EventHandler
from kit.ros.launch.substitutions import Substitution, describe_substitutions

INDENT = "    "


def indent(lines: Iterable[str], indention: str = INDENT) -> list[str]:
    """Returns the lines, indented."""
    return [f"{indention}{line}" for line in lines]


def tree_like_indent(lines: Iterable[str], indention: str = "├── ") -> list[str]:
    """Returns the lines as the branches of a tree; lines that are branches of another already go below it."""
    return [f"{'│   ' if line.startswith((' ', '│', '├', '└')) else indention}{line}" for line in lines]


def format_substitutions(substitutions: Any) -> str:
    """Returns a text of substitutions as one line."""
    return describe_substitutions(substitutions)


def format_entities(entities: Iterable[LaunchDescriptionEntity]) -> list[str]:
    """Returns the lines of entities and of what they contain."""
    lines: list[str] = []
    for entity in entities:
        lines += format_action(entity)
        lines += indent(format_entities(entity.sub_entities()))
    return lines


def format_action(action: LaunchDescriptionEntity) -> list[str]:
    """Returns the line of an entity: what it is and what it was given."""
    given = {
        name.lstrip("_"): value
        for name, value in vars(action).items()
        if value not in (None, [], (), {}) and name not in ("condition", "location", "entities")
    }
    details = ", ".join(f"{name}={_described(value)}" for name, value in given.items() if _is_told(value))
    return [f"{type(action).__name__}({details})"]


def format_event_handler(event_handler: EventHandler) -> list[str]:
    """Returns the line of an event handler."""
    return [f"{type(event_handler).__name__}()"]


def _is_told(value: Any) -> bool:
    if isinstance(value, (list, tuple)):
        return all(_is_told(each) for each in value)
    return isinstance(value, (str, int, float, Substitution))


def _described(value: Any) -> str:
    is_text = isinstance(value, Substitution) or (
        isinstance(value, (list, tuple)) and any(isinstance(each, Substitution) for each in value)
    )
    return describe_substitutions(value) if is_text else repr(value)


class LaunchIntrospector:
    """Describes a launch description as text, without carrying it out."""

    def format_launch_description(self, launch_description: LaunchDescription) -> str:
        """Returns the launch description as a text of many lines."""
        name = f"<{type(launch_description).__module__}.{type(launch_description).__name__}>"
        return "\n".join([name, *tree_like_indent(format_entities(launch_description.entities))])
