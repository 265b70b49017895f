"""Substitutions: texts that are determined when the launch runs."""

from __future__ import annotations

import math
import shutil
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from kit.plain_text import nearest_name
from kit.ros.launch.errors import SubstitutionFailure

if TYPE_CHECKING:
    from kit.ros.launch.context import LaunchContext

KIT_COMMANDS = frozenset({"ros2"})
"""Commands that are always found, since the kit brings them."""


class Substitution:
    """A text that is determined when the launch runs, by the ``perform`` of a subclass."""

    def perform(self, context: LaunchContext) -> str:
        raise NotImplementedError(f"{type(self).__name__}.perform")

    def describe(self) -> str:
        return f"{type(self).__name__}()"

    def __repr__(self) -> str:
        return self.describe()


SomeText = str | Path | Substitution | Iterable[str | Path | Substitution]
"""A text argument of an action: pieces of an iterable are joined without separator."""


def normalize_to_substitutions(text: Any) -> list[Substitution]:
    """The text as a list of substitutions. Raises TypeError for anything else."""
    if isinstance(text, Substitution):
        return [text]
    if isinstance(text, (str, Path)):
        return [TextSubstitution(text=str(text))]
    if isinstance(text, Iterable) and not isinstance(text, (bytes, dict)):
        return [piece for entry in text for piece in normalize_to_substitutions(entry)]
    raise TypeError(
        f"a text is needed here, a substitution, or a list of these, not {type(text).__name__} ({text!r:.40})"
    )


def perform_substitutions(context: LaunchContext, text: SomeText) -> str:
    """Determines the text now."""
    return "".join(piece.perform(context) for piece in normalize_to_substitutions(text))


def describe_substitutions(text: SomeText) -> str:
    return " + ".join(piece.describe() for piece in normalize_to_substitutions(text))


class TextSubstitution(Substitution):
    """A constant text."""

    def __init__(self, *, text: str) -> None:
        if not isinstance(text, str):
            raise TypeError(f"TextSubstitution expects a text, not {type(text).__name__}")
        self.text = text

    def perform(self, context: LaunchContext) -> str:
        return self.text

    def describe(self) -> str:
        return f"'{self.text}'"


class LaunchConfiguration(Substitution):
    """The value of a launch argument."""

    def __init__(self, variable_name: SomeText, *, default: Any = None) -> None:
        self.variable_name = normalize_to_substitutions(variable_name)
        self.default = None if default is None else normalize_to_substitutions(as_text(default))

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self.variable_name)
        if name in context.launch_configurations:
            return context.launch_configurations[name]
        if self.default is not None:
            return perform_substitutions(context, self.default)
        near = nearest_name(name, context.launch_configurations)
        hint = f"did you mean '{near}'?" if near else "DeclareLaunchArgument comes before its use"
        raise SubstitutionFailure(f"launch configuration '{name}' does not exist; {hint}")

    def describe(self) -> str:
        return f"LaunchConfig({describe_substitutions(self.variable_name)})"


def as_text(value: Any) -> Any:
    """A number or boolean as text; anything else as it is."""
    return str(value) if isinstance(value, (bool, int, float)) else value


class PathJoinSubstitution(Substitution):
    """Parts of a path, with slashes between them."""

    def __init__(self, substitutions: Iterable[SomeText]) -> None:
        self.substitutions = [normalize_to_substitutions(part) for part in substitutions]

    def perform(self, context: LaunchContext) -> str:
        return str(Path(*(perform_substitutions(context, part) for part in self.substitutions)))

    def describe(self) -> str:
        return f"PathJoin({', '.join(describe_substitutions(part) for part in self.substitutions)})"

    def __truediv__(self, other: SomeText) -> PathJoinSubstitution:
        return PathJoinSubstitution([*self.substitutions, other])


class EnvironmentVariable(Substitution):
    """An environment variable."""

    def __init__(self, name: SomeText, *, default_value: SomeText | None = None) -> None:
        self.name = normalize_to_substitutions(name)
        self.default_value = None if default_value is None else normalize_to_substitutions(default_value)

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self.name)
        if name in context.environment:
            return context.environment[name]
        if self.default_value is None:
            raise SubstitutionFailure(f"environment variable '{name}' does not exist")
        return perform_substitutions(context, self.default_value)

    def describe(self) -> str:
        return f"EnvVar({describe_substitutions(self.name)})"


class PythonExpression(Substitution):
    """The value of a Python expression, as a text; the names of ``math`` can be used."""

    def __init__(self, expression: SomeText) -> None:
        self.expression = normalize_to_substitutions(expression)

    def perform(self, context: LaunchContext) -> str:
        expression = perform_substitutions(context, self.expression)
        try:
            # The launch file's author's own code, in the launch file's own process.
            return str(eval(expression, {}, dict(vars(math))))
        except Exception as problem:  # noqa: BLE001 - whatever the author's expression raises
            raise SubstitutionFailure(
                f"the expression {expression!r} fails: {type(problem).__name__}: {problem}. "
                "Texts in it need quotes of their own."
            ) from None

    def describe(self) -> str:
        return f"PythonExpr({describe_substitutions(self.expression)})"


class LocalSubstitution(Substitution):
    """Something of the event being handled, as ``event.returncode``; or ``current_launch_file_directory``."""

    def __init__(self, expression: str) -> None:
        if not isinstance(expression, str):
            raise TypeError(f"LocalSubstitution expects a text, not {type(expression).__name__}")
        self.expression = expression

    def perform(self, context: LaunchContext) -> str:
        try:
            # The launch file's author's own code, in the launch file's own process.
            return str(eval(f"locals.{self.expression}", {}, {"locals": context.locals}))
        except Exception as problem:  # noqa: BLE001 - whatever the author's expression raises
            there = ", ".join(vars(context.locals))
            raise SubstitutionFailure(
                f"LocalSubstitution('{self.expression}') fails: {problem}; here there are: {there}"
            ) from None

    def describe(self) -> str:
        return f"LocalVar('{self.expression}')"


class FindExecutable(Substitution):
    """The path of a program on PATH."""

    def __init__(self, *, name: SomeText) -> None:
        self.name = normalize_to_substitutions(name)

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self.name)
        found = shutil.which(name, path=context.environment.get("PATH"))
        if found is None and name not in KIT_COMMANDS:
            raise SubstitutionFailure(f"executable '{name}' not found on the PATH")
        return found or name

    def describe(self) -> str:
        return f"FindExec({describe_substitutions(self.name)})"


class ThisLaunchFile(Substitution):
    """The path of the launch file being carried out."""

    def perform(self, context: LaunchContext) -> str:
        return context.files[-1]


class ThisLaunchFileDir(Substitution):
    """The folder of the launch file being carried out."""

    def perform(self, context: LaunchContext) -> str:
        return str(Path(context.files[-1]).parent)


class EqualsSubstitution(Substitution):
    """``true`` if two texts are the same, else ``false``."""

    def __init__(self, left: SomeText, right: SomeText) -> None:
        self.left, self.right = (
            normalize_to_substitutions(as_text(left)),
            normalize_to_substitutions(as_text(right)),
        )

    def _equal(self, context: LaunchContext) -> bool:
        left, right = perform_substitutions(context, self.left), perform_substitutions(context, self.right)
        return left == right or {left.lower(), right.lower()} in ({"true", "1"}, {"false", "0"})

    def perform(self, context: LaunchContext) -> str:
        return str(self._equal(context)).lower()


class NotEqualsSubstitution(EqualsSubstitution):
    """``true`` if two texts differ, else ``false``."""

    def perform(self, context: LaunchContext) -> str:
        return str(not self._equal(context)).lower()
