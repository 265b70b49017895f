"""Substitutions that decide, combine and name: booleans, choices, joined texts, unique names, parameters."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Final

from kit.ros.launch.errors import SubstitutionFailure
from kit.ros.launch.substitutions import (
    SomeText,
    Substitution,
    as_text,
    describe_substitutions,
    normalize_to_substitutions,
    perform_substitutions,
)

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext

TRUE: Final = ("true", "yes", "on", "1")
FALSE: Final = ("false", "no", "off", "0")


def perform_boolean(context: LaunchContext, text: SomeText) -> bool:
    """Determines a text that must be a boolean. Raises SubstitutionFailure."""
    value = perform_substitutions(context, text).strip().lower()
    if value not in (*TRUE, *FALSE):
        raise SubstitutionFailure(
            f"{describe_substitutions(text)} is '{value}': a boolean must be one of {', '.join(TRUE + FALSE)}"
        )
    return value in TRUE


class AllSubstitution(Substitution):
    """``true`` if all its arguments are true."""

    def __init__(self, *args: Any) -> None:
        self.values = [normalize_to_substitutions(as_text(value)) for value in args]

    def perform(self, context: LaunchContext) -> str:
        return str(self._combine([perform_boolean(context, value) for value in self.values])).lower()

    def describe(self) -> str:
        return f"{type(self).__name__}({' '.join(describe_substitutions(value) for value in self.values)})"

    def _combine(self, values: Iterable[bool]) -> bool:
        return all(values)


class AnySubstitution(AllSubstitution):
    """``true`` if one of its arguments is true."""

    def _combine(self, values: Iterable[bool]) -> bool:
        return any(values)


class AndSubstitution(AllSubstitution):
    """``true`` if both arguments are true."""

    def __init__(self, left: Any, right: Any) -> None:
        super().__init__(left, right)


class OrSubstitution(AnySubstitution):
    """``true`` if one of two arguments is true."""

    def __init__(self, left: Any, right: Any) -> None:
        super().__init__(left, right)


class NotSubstitution(AllSubstitution):
    """``true`` if its argument is false."""

    def __init__(self, value: Any) -> None:
        super().__init__(value)

    def _combine(self, values: Iterable[bool]) -> bool:
        return not all(values)


class IfElseSubstitution(Substitution):
    """One of two texts, by a condition."""

    def __init__(self, condition: Any, if_value: SomeText = "", else_value: SomeText = "") -> None:
        if not if_value and not else_value:
            raise ValueError("IfElseSubstitution needs an if_value or an else_value")
        self.condition = normalize_to_substitutions(as_text(condition))
        self.if_value, self.else_value = (
            normalize_to_substitutions(if_value),
            normalize_to_substitutions(else_value),
        )

    def perform(self, context: LaunchContext) -> str:
        chosen = self.if_value if perform_boolean(context, self.condition) else self.else_value
        return perform_substitutions(context, chosen)

    def describe(self) -> str:
        return f"IfElseSubstitution({describe_substitutions(self.condition)})"


class StringJoinSubstitution(Substitution):
    """Texts with a delimiter between them."""

    def __init__(self, substitutions: Iterable[SomeText], delimiter: SomeText = "") -> None:
        self.substitutions = [normalize_to_substitutions(part) for part in substitutions]
        self.delimiter = normalize_to_substitutions(delimiter)

    def perform(self, context: LaunchContext) -> str:
        return perform_substitutions(context, self.delimiter).join(
            perform_substitutions(context, part) for part in self.substitutions
        )


class StringStripSubstitution(Substitution):
    """A text without the white space around it."""

    def __init__(self, value: SomeText) -> None:
        self.value = normalize_to_substitutions(value)

    def perform(self, context: LaunchContext) -> str:
        return perform_substitutions(context, self.value).strip()


class IsEmptySubstitution(Substitution):
    """``true`` if a text is empty."""

    def __init__(self, value: SomeText) -> None:
        self.value = normalize_to_substitutions(value)

    def perform(self, context: LaunchContext) -> str:
        return str(not perform_substitutions(context, self.value)).lower()


class NotEmptySubstitution(IsEmptySubstitution):
    """``true`` if a text is not empty."""

    def perform(self, context: LaunchContext) -> str:
        return str(super().perform(context) == "false").lower()


class AnonName(Substitution):
    """A name that no other node has: the same one for the same name within a launch."""

    def __init__(self, name: SomeText) -> None:
        self.name = normalize_to_substitutions(name)

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self.name)
        number = context.anonymous_names.setdefault(name, len(context.anonymous_names) + 1)
        return f"{name}_{number}"


class LaunchLogDir(Substitution):
    """The folder for log files."""

    def perform(self, context: LaunchContext) -> str:
        return context.environment.get("ROS_LOG_DIR") or context.environment.get("TMPDIR", "/tmp")


class ParameterSubstitution(Substitution):
    """The value that ``SetParameter`` has given a parameter before; ``Parameter`` in launch_ros."""

    def __init__(self, name: SomeText, *, default: SomeText | None = None) -> None:
        self.name = normalize_to_substitutions(name)
        self.default = None if default is None else normalize_to_substitutions(default)

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self.name)
        for known, value in reversed(context.scope.parameters):
            if known == name:
                return value.removeprefix('"').removesuffix('"')
        if self.default is None:
            raise SubstitutionFailure(f"parameter '{name}' is not set: SetParameter comes before its use")
        return perform_substitutions(context, self.default)

    def describe(self) -> str:
        return f"Parameter({describe_substitutions(self.name)})"
