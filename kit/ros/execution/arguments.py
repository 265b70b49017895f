"""Parses the ROS arguments of a command line, after ``--ros-args``: remappings, parameters, log levels."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from fnmatch import fnmatchcase
from typing import Any, NamedTuple

from kit.ros.exceptions import InvalidRosArguments, NameValidationException
from kit.ros.graph.naming import (
    expand_topic_name,
    full_name,
    validate_namespace,
    validate_node_name,
    validate_topic_name,
)
from kit.ros.log import LoggingSeverity, get_logging_severity_from_string
from kit.ros.parameters.parameter import GivenParameters, Parameter

NODE_NAME = "__node"
NAMESPACE = "__ns"


class Remapping(NamedTuple):
    """``[node:]match:=replacement``. ``match`` may be a name, ``__node`` or ``__ns``."""

    match: str
    replacement: str
    node: str | None = None
    """The node it applies to, by its name, or for topics and services by its full name; None: all."""
    kind: str = ""
    """``rostopic`` or ``rosservice``: applies to topics or services only."""


class RosArguments(NamedTuple):
    """The parsed arguments, in the order in which they were given."""

    remappings: tuple[Remapping, ...] = ()
    parameters: tuple[GivenParameters, ...] = ()
    log_levels: tuple[tuple[str, LoggingSeverity], ...] = ()
    """Logger names and levels; the empty name is the default level."""

    def followed_by(self, other: RosArguments) -> RosArguments:
        """Joins two sets of arguments; these take precedence: the first matching remapping counts, the last parameter."""
        return RosArguments(
            self.remappings + other.remappings,
            other.parameters + self.parameters,
            self.log_levels + other.log_levels,
        )

    def node_name(self, name: str) -> str:
        return self._replacement_of(NODE_NAME, name) or name

    def namespace(self, name: str, namespace: str) -> str:
        return self._replacement_of(NAMESPACE, name) or namespace

    def topic(self, name: str, node_name: str, namespace: str) -> str:
        """The absolute topic name after remapping."""
        return self._remap(name, node_name, namespace, "rostopic")

    def service(self, name: str, node_name: str, namespace: str) -> str:
        """The absolute service name after remapping."""
        return self._remap(name, node_name, namespace, "rosservice")

    def parameters_of(self, node_name: str, namespace: str) -> dict[str, Parameter]:
        """The parameter values for a node; the last one given for a name counts."""
        name = full_name(node_name, namespace)
        found: dict[str, Parameter] = {}
        for entry in self.parameters:
            if _matches(entry.node, name):
                found |= {parameter.name: parameter for parameter in entry.parameters}
        return found

    def _replacement_of(self, match: str, node_name: str) -> str | None:
        for rule in self.remappings:
            if rule.match == match and rule.node in (None, node_name):
                return rule.replacement
        return None

    def _remap(self, name: str, node_name: str, namespace: str, kind: str) -> str:
        absolute = expand_topic_name(name, node_name, namespace)
        names = (None, node_name, full_name(node_name, namespace))
        for rule in self.remappings:
            if (
                rule.match not in (NODE_NAME, NAMESPACE)
                and rule.node in names
                and rule.kind in ("", kind)
                and expand_topic_name(rule.match, node_name, namespace) == absolute
            ):
                return expand_topic_name(rule.replacement, node_name, namespace)
        return absolute


def split_ros_arguments(args: Iterable[str]) -> tuple[list[str], list[str]]:
    """The program's own arguments, and those between ``--ros-args`` and ``--`` or the end."""
    own: list[str] = []
    ros: list[str] = []
    inside = False
    for arg in args:
        if arg == "--ros-args":
            inside = True
        elif inside and arg == "--":
            inside = False
        else:
            (ros if inside else own).append(arg)
    return own, ros


def parse_ros_arguments(args: Iterable[str]) -> RosArguments:
    """Parses the ROS part of a command line. Raises InvalidRosArguments."""
    rest = iter(split_ros_arguments(args)[1])
    remappings: list[Remapping] = []
    parameters: list[GivenParameters] = []
    levels: list[tuple[str, LoggingSeverity]] = []
    for flag in rest:
        if flag in ("-r", "--remap"):
            remappings.append(_remapping(_value(rest, flag)))
        elif flag in ("-p", "--param"):
            parameters.append(_parse_parameter(_value(rest, flag)))
        elif flag == "--params-file":
            parameters += _file(_value(rest, flag))
        elif flag == "--log-level":
            levels.append(_log_level(_value(rest, flag)))
        elif flag in _IGNORED_OPTIONS:
            _value(rest, flag)
        elif flag not in _IGNORED_FLAGS:
            known = "-r/--remap, -p/--param, --params-file, --log-level"
            raise InvalidRosArguments(
                f"unknown ROS argument '{flag}'; after --ros-args there can be: {known}"
            )
    return RosArguments(tuple(remappings), tuple(parameters), tuple(levels))


_IGNORED_OPTIONS = ("-e", "--enclave", "--log-config-file", "--log-file-name")
"""Options of ROS 2 that have no effect here."""

_IGNORED_FLAGS = tuple(
    f"--{state}-{what}-logs"
    for state in ("enable", "disable")
    for what in ("rosout", "stdout", "external-lib")
)


def _value(rest: Iterator[str], flag: str) -> str:
    value = next(rest, None)
    if value is None:
        raise InvalidRosArguments(f"'{flag}' needs a value after it")
    return value


def _split_rule(text: str, flag: str, shape: str) -> tuple[str | None, str, str]:
    """Splits ``[node:]left:=right``."""
    left, separator, right = text.partition(":=")
    node, colon, name = left.rpartition(":")
    if not separator or not name or (colon and not node):
        raise InvalidRosArguments(f"{flag} '{text}': must look like {shape}")
    return node or None, name, right


def _remapping(text: str) -> Remapping:
    kind = ""
    rest = text
    for scheme in ("rostopic", "rosservice"):
        if text.startswith(f"{scheme}://"):
            kind, rest = scheme, text[len(scheme) + 3 :]
    node, match, replacement = _split_rule(
        rest, "-r", "from:=to, node:from:=to, __node:=name or __ns:=/namespace"
    )
    match = {"__name": NODE_NAME}.get(match, match)
    checks: dict[str, Callable[[str], bool]] = {NODE_NAME: validate_node_name, NAMESPACE: validate_namespace}
    if match in checks:
        checks[match](replacement)
    elif match.startswith("__"):
        raise InvalidRosArguments(f"-r '{text}': there is only __node and __ns")
    elif not replacement:
        raise InvalidRosArguments(f"-r '{text}': the new name is missing")
    try:
        for name in () if match in checks else (match, replacement):
            validate_topic_name(name)
        if node is not None:
            validate_node_name(node.rpartition("/")[2])
    except NameValidationException as problem:
        raise InvalidRosArguments(f"-r '{text}': {str(problem).splitlines()[0].removesuffix(':')}") from None
    return Remapping(match, replacement, node, kind)


def _parse_parameter(text: str) -> GivenParameters:
    node, name, value = _split_rule(text, "-p", "name:=value or node:name:=value")
    if not value:
        raise InvalidRosArguments(f"-p '{text}': the value is missing; an empty text is written ''")
    if set(name) & set("{} \t"):
        raise InvalidRosArguments(f"-p '{text}': a parameter's name has no blanks and no braces")
    pattern = "/**" if node is None else node if node.startswith("/") else f"/**/{node}"
    return GivenParameters(pattern, (Parameter(name, value=_parse_value(value)),))


def _parse_value(text: str) -> Any:
    """Parses a value as YAML. What JSON means alike, as are all values that the kit gives to programs, is read as JSON: PyYAML
    takes longer to import than all else that a node needs to start."""
    value = None
    if "\\" not in text and text.isprintable():  # else a text may mean something else in JSON
        with suppress(ValueError, RecursionError):
            value = json.loads(text)
    values = value if isinstance(value, list) else [value]
    kinds = {type(each) for each in values}
    if kinds in ({bool}, {str}, {int}) or (kinds == {float} and all(map(math.isfinite, values))):
        return value
    from kit.ros.parameters.parameter_files import parse_value

    return parse_value(text)


def _file(path: str) -> list[GivenParameters]:
    from kit.ros.parameters.parameter_files import read_parameter_file  # only now: it takes PyYAML

    return read_parameter_file(path)


def _log_level(text: str) -> tuple[str, LoggingSeverity]:
    name, separator, level = text.rpartition(":=")
    try:
        return (name if separator else ""), get_logging_severity_from_string(level)
    except RuntimeError as problem:
        raise InvalidRosArguments(f"--log-level '{text}': {problem}") from None


def _matches(pattern: str, name: str) -> bool:
    """True if a node pattern matches: ``*`` is one part of a name, ``**`` any number of them."""
    return _parts_match(pattern.strip("/").split("/"), name.strip("/").split("/"))


def _parts_match(pattern: Sequence[str], name: Sequence[str]) -> bool:
    if not pattern:
        return not name
    if pattern[0] == "**":
        return any(_parts_match(pattern[1:], name[skip:]) for skip in range(len(name) + 1))
    return bool(name) and fnmatchcase(name[0], pattern[0]) and _parts_match(pattern[1:], name[1:])
