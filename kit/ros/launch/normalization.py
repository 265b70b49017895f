"""Functions of ``launch.utilities`` and ``launch_ros.utilities`` by which actions and substitutions of a user's own read arguments."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, TypeAlias

from kit.ros.launch.context import LaunchContext
from kit.ros.launch.entity import LaunchDescriptionEntity, to_entities
from kit.ros.launch.processes import join_namespaces
from kit.ros.launch.substitutions import (
    SomeText,
    Substitution,
    normalize_to_substitutions,
    perform_substitutions,
)

SomeEntities: TypeAlias = LaunchDescriptionEntity | Iterable[LaunchDescriptionEntity]
ENTITY_TYPES = (LaunchDescriptionEntity, Iterable)
TEXT_TYPES = (str, Substitution, Iterable)
VALID_TRUE_EXPRESSIONS = ["true", "1"]
VALID_FALSE_EXPRESSIONS = ["false", "0"]


def normalize_to_list_of_substitutions(subs: SomeText) -> list[Substitution]:
    """Returns a text as a list of substitutions. Raises TypeError for anything else."""
    return normalize_to_substitutions(subs)


def normalize_to_list_of_entities(entities: Any) -> list[LaunchDescriptionEntity]:
    """Returns one entity or nested iterables of entities as a list. Raises TypeError for anything else."""
    return to_entities(entities)


def perform(context: LaunchContext, subs: Iterable[Substitution]) -> str:
    """Determines a text now."""
    return perform_substitutions(context, list(subs))


def ensure_argument_type(argument: Any, types: Any, argument_name: str, caller: str | None = None) -> None:
    """Raises TypeError for an argument that is of none of the types."""
    allowed = tuple(types) if isinstance(types, Iterable) else (types,)
    if not isinstance(argument, allowed):
        names = ", ".join(each.__name__ for each in allowed)
        place = f" of {caller}" if caller else ""
        raise TypeError(f"{argument_name}{place} must be of type {names}, not {type(argument).__name__}")


def is_a(obj: Any, entity_type: type) -> bool:
    """Returns whether an object is of a type."""
    return isinstance(obj, entity_type)


def is_a_subclass(obj: Any, entity_type: type) -> bool:
    """Returns whether an object or a class is of a type."""
    return isinstance(obj, entity_type) or (isinstance(obj, type) and issubclass(obj, entity_type))


def evaluate_condition_expression(context: LaunchContext, expression: Iterable[Substitution]) -> bool:
    """Returns whether a text says true. Raises ValueError for one that says neither true nor false."""
    text = perform(context, expression).strip().lower()
    if text not in (*VALID_TRUE_EXPRESSIONS, *VALID_FALSE_EXPRESSIONS):
        raise ValueError(f"'{text}': a condition must be one of true, 1, false, 0")
    return text in VALID_TRUE_EXPRESSIONS


def is_namespace_absolute(namespace: str) -> bool:
    """Returns whether a namespace begins with a slash."""
    return namespace.startswith("/")


def is_root_namespace(namespace: str) -> bool:
    """Returns whether a namespace is the root."""
    return namespace == "/"


def make_namespace_absolute(namespace: str | None) -> str | None:
    """Returns a namespace with a slash in front; None stays None."""
    return namespace if namespace is None or namespace.startswith("/") else f"/{namespace}"


def prefix_namespace(base: str | None, namespace: str | None) -> str | None:
    """Returns a namespace within another; an absolute one as it is, and None if there is neither."""
    if base is None or namespace is None:
        return base if namespace is None else namespace
    return join_namespaces(base, namespace)
