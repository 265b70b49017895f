"""What stands on a command line for a message: a type's name, and its values in YAML."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import yaml

from kit.cli.ros.world_client import exit_with_error
from kit.msg.builtin_interfaces import Time
from kit.msg.conversion import ConversionError, from_dict
from kit.msg.fields import Nested
from kit.msg.interfaces import UnknownInterface
from kit.msg.message import Message
from kit.msg.std_msgs import Header

T = TypeVar("T")


class _Loader(yaml.SafeLoader):
    """Also reads ``1e-3`` as a number."""


_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float", re.compile(r"[-+]?[0-9]+(\.[0-9]*)?[eE][-+]?[0-9]+$"), list("-+0123456789")
)


def interface_named(find: Callable[[str], T], name: str) -> T:
    """The message or service class of this name, or the end of the verb."""
    try:
        return find(name)
    except UnknownInterface as problem:
        exit_with_error(f"The passed type is invalid: {problem}")


def read_values(text: str) -> Mapping[str, Any]:
    """The fields in a text, or the end of the verb."""
    try:
        content = yaml.load(text, Loader=_Loader)
    except yaml.YAMLError as problem:
        exit_with_error(f"The passed value is no YAML: {' '.join(str(problem).split())}")
    if content in (None, ""):
        return {}
    if not isinstance(content, dict):
        exit_with_error(
            "The passed value needs to be a dictionary in YAML format, such as '{linear: {x: 0.5}}'"
        )
    return content


def filled(cls: type[Message], content: Mapping[str, Any], now_ns: int) -> Any:
    """A message with these fields, or the end of the verb. ``auto`` for a header, ``now`` for a time: the present."""
    try:
        return from_dict(cls, _dated(cls, content, now_ns))
    except ConversionError as problem:
        exit_with_error(f"Failed to populate field: {problem}")


def _dated(cls: type[Message], content: Mapping[str, Any], now_ns: int) -> dict[str, Any]:
    now = {"sec": now_ns // 1_000_000_000, "nanosec": now_ns % 1_000_000_000}
    kinds = {field.name: field.kind for field in cls.__ros_fields__}
    dated = dict(content)
    for name, value in content.items():
        kind = kinds.get(name)
        if not isinstance(kind, Nested):
            continue
        if kind.cls is Header and value == "auto":
            dated[name] = {"stamp": now}
        elif kind.cls is Time and value == "now":
            dated[name] = now
        elif isinstance(value, Mapping):
            dated[name] = _dated(kind.cls, value, now_ns)
    return dated
