"""Converts the parameters that a launch file gives to nodes to ``--ros-args``."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from kit.ros.exceptions import InvalidRosArguments
from kit.ros.launch.context import LaunchContext, LaunchError
from kit.ros.launch.entity import IfCondition
from kit.ros.launch.substitutions import (
    SomeText,
    Substitution,
    normalize_to_substitutions,
    perform_substitutions,
)


class ParameterValue:
    """A value with an explicit type, which is otherwise derived from its text."""

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.value, self.value_type = value, value_type

    def evaluate(self, context: LaunchContext) -> Any:
        if not isinstance(self.value, (str, Substitution, list, tuple)):
            return self.value
        text = perform_substitutions(context, self.value)
        if self.value_type is str:
            return text
        value = _parse_yaml_value(text)
        if self.value_type in (int, float, bool):
            if self.value_type is float and type(value) is int:
                value = float(value)
            if type(value) is not self.value_type:
                raise LaunchError(f"a parameter is to be of type {self.value_type.__name__}, but is '{text}'")
        return value


class ParameterFile:
    """A file of parameters."""

    def __init__(self, param_file: SomeText, *, allow_substs: bool | SomeText = False) -> None:
        self.param_file = normalize_to_substitutions(param_file)
        self.allow_substs = IfCondition(allow_substs)


class Parameter(ParameterValue):
    """A single parameter with its name."""

    def __init__(self, name: SomeText, value: Any, *, value_type: Any = None) -> None:
        super().__init__(value, value_type=value_type)
        self.name = normalize_to_substitutions(name)


def arguments(context: LaunchContext, given: Iterable[Any]) -> Iterator[str]:
    """Yields ``-p`` and ``--params-file`` arguments for a node's ``parameters`` list. Raises LaunchError."""
    for entry in given:
        if isinstance(entry, Mapping):
            for name, value in flatten_parameters(context, entry):
                yield from ("-p", f"{name}:={value}")
        elif isinstance(entry, Parameter):
            yield from (
                "-p",
                f"{perform_substitutions(context, entry.name)}:={to_argument_text(entry.evaluate(context))}",
            )
        else:
            source = entry.param_file if isinstance(entry, ParameterFile) else entry
            path = perform_substitutions(context, source)
            if not Path(path).is_file():
                raise LaunchError(f"the parameter file {path} does not exist")
            if isinstance(entry, ParameterFile) and entry.allow_substs.evaluate(context):
                yield from _substituted_arguments(context, path)
            else:
                yield from ("--params-file", path)


def _substituted_arguments(context: LaunchContext, path: str) -> Iterator[str]:
    """What a file says once the substitutions in its text are made; no process writes files for another one."""
    from kit.ros.launch.frontend.substitution_parser import SubstitutionSyntaxError, parse_substitutions
    from kit.ros.parameters.parameter_files import read_parameter_file

    def substitute(text: str) -> str:
        try:
            return perform_substitutions(context, parse_substitutions(text))
        except SubstitutionSyntaxError as problem:
            raise LaunchError(f"{path}: {problem}") from None

    for node, parameters in read_parameter_file(path, substitute):
        for each in parameters:
            yield from ("-p", f"{node}:{each.name}:={to_argument_text(each.value)}")


def flatten_parameters(
    context: LaunchContext, values: Mapping[Any, Any], prefix: str = ""
) -> Iterator[tuple[str, str]]:
    """Yields names and values, as text, of a dict of parameters; nested dicts are flattened."""
    for key, value in values.items():
        name = prefix + perform_substitutions(context, key)
        if isinstance(value, Mapping):
            yield from flatten_parameters(context, value, f"{name}.")
        else:
            yield name, to_argument_text(_evaluate(context, value))


def _evaluate(context: LaunchContext, value: Any) -> Any:
    """Evaluates a value as ROS 2 does: texts and substitutions are read as YAML, lists of them are joined first."""
    if isinstance(value, ParameterValue):
        return value.evaluate(context)
    if isinstance(value, (str, Path, Substitution)):
        return _parse_yaml_value(perform_substitutions(context, value))
    if isinstance(value, (list, tuple)):
        if any(isinstance(entry, Substitution) for entry in value):
            return _parse_yaml_value(perform_substitutions(context, value))
        return list(value)
    return value


def _parse_yaml_value(text: str) -> Any:
    from kit.ros.parameters.parameter_files import (  # only now: it takes PyYAML
        AmbiguousValue,
        parse_value,
    )

    try:
        return parse_value(text)
    except AmbiguousValue:
        raise
    except InvalidRosArguments:
        return text


def to_argument_text(value: Any) -> str:
    """The text that is parsed to this value on a command line."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (int, float)):
        return repr(value).replace("inf", ".inf").replace("nan", ".nan")
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(to_argument_text(entry) for entry in value)}]"
    raise LaunchError(f"no parameter can hold {value!r:.40}, a {type(value).__name__}")
