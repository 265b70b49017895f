"""Substitutions of a launch file: texts that are determined when it is carried out."""

from __future__ import annotations

import shutil
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final

from kit.plain_text import nearest_name
from kit.ros.launch.bounds import MAX_TEXT_LENGTH
from kit.ros.launch.context import LaunchContext, SubstitutionFailure
from kit.ros.launch.expressions import ExpressionTooLarge, evaluate

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
    """Determines the text now. Raises SubstitutionFailure for one of more than ``MAX_TEXT_LENGTH`` characters, and what a
    substitution raises."""
    parts: list[str] = []
    length = 0
    for piece in normalize_to_substitutions(text):
        parts.append(piece.perform(context))
        length += len(parts[-1])
        if length > MAX_TEXT_LENGTH:
            raise SubstitutionFailure(f"a text gets longer than {MAX_TEXT_LENGTH:,} characters")
    return "".join(parts)


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
            return evaluate(expression, context.location)
        except ExpressionTooLarge as problem:
            raise SubstitutionFailure(f"the expression {expression!r} is not computed: {problem}.") from None
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
                f"LocalSubstitution('{self.expression}') fails: {problem}; available here: {there}"
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
