"""Conditions decide whether an action is carried out."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from kit.ros.launch.errors import LaunchError
from kit.ros.launch.substitutions import (
    SomeText,
    describe_substitutions,
    normalize_to_substitutions,
    perform_substitutions,
)

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext

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
