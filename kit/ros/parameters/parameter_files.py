"""Parses parameter values: on a command line, and in the YAML files of ``--params-file``.

Text is read as ROS 2 reads it: ``yes`` and ``on`` are truth values, ``1e-3`` is a number, quotes make a text. ROS 2 itself
reads ``1:30`` and ``1_000`` as texts in a file and as numbers on a command line: they are refused in both.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml
from yaml import MappingNode, Mark, ScalarNode, SequenceNode
from yaml import Node as YamlNode

from kit.msg.rcl_interfaces import Parameter as ParameterMessage
from kit.msg.rcl_interfaces import ParameterValue
from kit.ros.exceptions import InvalidRosArguments
from kit.ros.parameters.parameter import GivenParameters, Parameter
from kit.yaml_numbers import ambiguity

PARAMETERS_KEY = "ros__parameters"

_TRUE = {"y", "Y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON"}
_FALSE = {"n", "N", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF"}
_INTEGER = re.compile(r"[-+]?(?:0x[0-9a-fA-F]+|[0-9]+)")
_FLOAT = re.compile(r"[-+]?(?:[0-9]+\.[0-9]*|\.[0-9]+|[0-9]+)(?:[eE][-+]?[0-9]+)?")
_SPECIAL = {".nan": math.nan, ".inf": math.inf, "+.inf": math.inf, "-.inf": -math.inf}


class AmbiguousValue(InvalidRosArguments):
    """A value that can be read in two ways; the error says which."""


@dataclass(frozen=True, slots=True)
class _TextSource:
    """The origin of a text, for messages."""

    name: str
    is_file: bool = True

    def error(self, message: str, mark: Mark | None) -> InvalidRosArguments:
        where = f":{mark.line + 1}:{mark.column + 1}" if self.is_file and mark is not None else ""
        return InvalidRosArguments(f"{self.name}{where}: {message}")


def parse_value(text: str) -> Any:
    """Parses a value on a command line: ``1`` an int, ``[1.0, 2.0]`` a list, ``x`` itself.

    Raises InvalidRosArguments for broken YAML and for what no parameter can hold.
    """
    source = _TextSource(f"parameter value '{text}'", is_file=False)
    node = _compose(text, source)
    return "" if node is None else _value(node, source)


def read_parameter_file(path: str, substitute: Callable[[str], str] = str) -> list[GivenParameters]:
    """Reads the values of a YAML file, in its order: ``node: {ros__parameters: {name: value}}``, also with namespaces.

    ``substitute`` changes the file's text first. Raises InvalidRosArguments, naming file and line.
    """
    try:
        text = Path(path).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as problem:
        reason = problem.strerror if isinstance(problem, OSError) else "it is not UTF-8 text"
        raise InvalidRosArguments(f"--params-file '{path}': {reason}") from None
    source = _TextSource(path)
    root = _compose(substitute(text), source)
    return [] if root is None else list(_node_parameters(root, "", source))


def parameter_dict_from_yaml_file(
    parameter_file: str,
    use_wildcard: bool = False,
    target_nodes: list[str] | None = None,
    namespace: str = "",
) -> dict[str, ParameterMessage]:
    """Reads the values of a YAML file as messages, by parameter name, of ``target_nodes`` or of all nodes.

    ``use_wildcard``: also what the file has for every node (``/**``). ``namespace`` comes before each parameter's
    name. Raises InvalidRosArguments for a file that cannot be read, RuntimeError if it has nothing for a target node.
    """
    given = read_parameter_file(parameter_file)
    wanted = None if target_nodes is None else {f"/{name.lstrip('/')}" for name in target_nodes}
    found: dict[str, ParameterMessage] = {}
    paths = set()
    for entry in given:
        path = f"/{entry.node.lstrip('/')}"
        is_wildcard = "*" in path
        if (is_wildcard and not use_wildcard) or (
            not is_wildcard and wanted is not None and path not in wanted
        ):
            continue
        paths.add(path)
        for parameter in entry.parameters:
            name = f"{namespace}.{parameter.name}" if namespace else parameter.name
            found[name] = Parameter(name, parameter.type_, parameter.value).to_parameter_msg()
    missing = sorted((wanted or set()) - paths)
    if missing and not any("*" in path for path in paths):
        raise RuntimeError(f"{parameter_file} has no parameters for {', '.join(missing)}")
    return found


def _compose(text: str, source: _TextSource) -> YamlNode | None:
    try:
        return yaml.compose(text, Loader=yaml.SafeLoader)
    except yaml.MarkedYAMLError as problem:
        from kit.yaml_slips import parser_mistake  # only where there is one

        slip = parser_mistake(problem, text)
        place = f":{slip.line}:{slip.column}" if source.is_file else ""
        raise InvalidRosArguments(f"{source.name}{place}: {slip.message}") from None
    except yaml.YAMLError as problem:
        raise source.error(str(problem), None) from None
    except RecursionError:
        raise source.error("it is nested too deeply", None) from None


def _node_parameters(node: YamlNode, path: str, source: _TextSource) -> Iterator[GivenParameters]:
    for key, value in _entries(node, source):
        if key == PARAMETERS_KEY:
            if not path:
                message = f"'{PARAMETERS_KEY}' must be under the name of a node, or under '/**'"
                raise source.error(message, node.start_mark)
            yield GivenParameters(path, tuple(_parameters(value, "", source)))
        else:
            yield from _node_parameters(value, f"{path}/{key.strip('/')}", source)


def _parameters(node: YamlNode, prefix: str, source: _TextSource) -> Iterator[Parameter]:
    for key, value in _entries(node, source):
        name = prefix + key
        if isinstance(value, MappingNode):
            yield from _parameters(value, f"{name}.", source)
        else:
            yield Parameter(name, value=_value(value, source))


def _entries(node: YamlNode, source: _TextSource) -> Iterator[tuple[str, YamlNode]]:
    if not isinstance(node, MappingNode):
        from kit.yaml_slips import missing_blank  # only where something is wrong

        slip = missing_blank(node.value) if isinstance(node, ScalarNode) else None
        message = slip or f"needs a mapping here: 'node: {{{PARAMETERS_KEY}: {{name: value}}}}'"
        raise source.error(message, node.start_mark)
    for key, value in node.value:
        if not isinstance(key, ScalarNode):
            raise source.error("a name must be a plain text", key.start_mark)
        yield key.value, value


def _value(node: YamlNode, source: _TextSource) -> Any:
    if isinstance(node, ScalarNode):
        if node.style in ("'", '"', "|", ">"):
            return node.value
        if told := ambiguity(node.value):
            raise AmbiguousValue(str(source.error(told, node.start_mark)))
        return _parse_scalar(node.value)
    if not isinstance(node, SequenceNode):
        raise source.error("a parameter cannot hold a mapping", node.start_mark)
    values = [_value(entry, source) for entry in node.value]
    if {type(entry) for entry in values} == {int, float}:
        values = [float(entry) for entry in values]
    try:
        Parameter.Type.from_parameter_value(values)
    except TypeError as problem:
        raise source.error(str(problem), node.start_mark) from None
    return values


def _parse_scalar(text: str) -> Any:
    if text in _TRUE or text in _FALSE:
        return text in _TRUE
    if _INTEGER.fullmatch(text):
        return int(text, 16 if "x" in text else 10)
    if _FLOAT.fullmatch(text) and math.isfinite(number := float(text)):  # as text, what is beyond all numbers
        return number
    return _SPECIAL.get(text.lower(), text)


def get_parameter_value(string_value: str) -> ParameterValue:
    """Parses a text to a parameter message; a text that is no other value stays a string. Raises AmbiguousValue."""
    try:
        value = parse_value(string_value)
    except AmbiguousValue:
        raise
    except InvalidRosArguments:
        value = string_value
    return Parameter("value", value=value).get_parameter_value()
