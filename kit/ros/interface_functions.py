"""Finds interfaces by name, and turns messages into dicts, YAML and CSV and back: what ``rosidl_runtime_py`` offers.

Facts of the functions: https://github.com/ros2/rosidl_runtime_py.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

from kit.msg.builtin_interfaces import Time
from kit.msg.conversion import from_dict
from kit.msg.interfaces import (
    definition_file,
    find_action,
    find_interface,
    find_message,
    find_service,
    interface_names,
    known_packages,
)
from kit.msg.message import Action, Message, Service
from kit.msg.message_text import MessageFormat, as_plain_data, to_csv, to_yaml
from kit.msg.std_msgs import Header


def get_interface(identifier: str) -> Any:
    """The class of ``PACKAGE/msg/NAME``, or of a service or an action. Raises ValueError without two slashes."""
    if len(parts := identifier.split("/")) != 3 or not all(parts):
        raise ValueError(
            f"Expected the full name of an interface, such as std_msgs/msg/String, got '{identifier}'"
        )
    _check_package(parts[0])
    return find_interface(identifier)


def get_message(identifier: str) -> type[Message]:
    """The class of a message, by ``PACKAGE/msg/NAME`` or ``PACKAGE/NAME``. Raises LookupError, ModuleNotFoundError."""
    return find_message(_completed(identifier, "msg"))


def get_service(identifier: str) -> type[Service]:
    """The class of a service, likewise."""
    return find_service(_completed(identifier, "srv"))


def get_action(identifier: str) -> type[Action]:
    """The class of an action, likewise."""
    return find_action(_completed(identifier, "action"))


def _check_package(name: str) -> None:
    if name not in known_packages():
        raise ModuleNotFoundError(f"No module named '{name}'", name=name)


def _completed(identifier: str, section: str) -> str:
    parts = identifier.split("/")
    if len(parts) == 2:
        parts.insert(1, section)
    if len(parts) != 3 or not all(parts):
        raise ValueError(f"Invalid name '{identifier}'. Expected PACKAGE/{section}/NAME")
    _check_package(parts[0])
    return "/".join(parts)


def is_message(cls: object) -> bool:
    return isinstance(cls, type) and issubclass(cls, Message)


def is_service(cls: object) -> bool:
    return isinstance(cls, type) and issubclass(cls, Service)


def is_action(cls: object) -> bool:
    return isinstance(cls, type) and issubclass(cls, Action)


def get_interface_packages() -> list[str]:
    """The packages that have interfaces."""
    return [package for package in known_packages() if interface_names(package)]


def get_interfaces(package_names: Sequence[str] = ()) -> dict[str, list[str]]:
    """The interfaces of packages, ``msg/NAME`` each; of all packages by default. Raises LookupError for an unknown one."""
    known = get_interface_packages()
    for package in package_names:
        if package not in known:
            raise LookupError(f"Unknown package '{package}'")
    return {
        package: [name.partition("/")[2] for name in interface_names(package)]
        for package in package_names or known
    }


def _interfaces_of_section(section: str, package_names: Sequence[str]) -> dict[str, list[str]]:
    found = {
        package: [name for name in names if name.startswith(f"{section}/")]
        for package, names in get_interfaces(package_names).items()
    }
    return {package: names for package, names in found.items() if names or package_names}


def get_message_interfaces(package_names: Sequence[str] = ()) -> dict[str, list[str]]:
    """The messages of packages."""
    return _interfaces_of_section("msg", package_names)


def get_service_interfaces(package_names: Sequence[str] = ()) -> dict[str, list[str]]:
    """The services of packages."""
    return _interfaces_of_section("srv", package_names)


def get_action_interfaces(package_names: Sequence[str] = ()) -> dict[str, list[str]]:
    """The actions of packages."""
    return _interfaces_of_section("action", package_names)


def get_interface_path(interface_name: str) -> str:
    """The path of an interface's definition, by its full name. Raises ValueError, LookupError."""
    return definition_file(get_interface(interface_name).__ros_type__)


def message_to_ordereddict(
    msg: Message, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> OrderedDict[str, Any]:
    """The message's fields in the order of the definition; nested messages likewise, arrays as lists.

    ``truncate_length``: longer arrays and texts are cut. ``no_arr``, ``no_str``: arrays, texts as their type and length.
    """
    return _ordered(as_plain_data(msg, MessageFormat(truncate_length, not no_arr, not no_str)))


def _ordered(data: Mapping[str, Any]) -> OrderedDict[str, Any]:
    def value_of(value: Any) -> Any:
        if isinstance(value, dict):
            return _ordered(value)
        return [value_of(each) for each in value] if isinstance(value, list) else value

    return OrderedDict((name, value_of(value)) for name, value in data.items())


def message_to_yaml(
    msg: Message,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool = False,
) -> str:
    """The message as YAML, with the options of ``message_to_ordereddict``; ``flow_style``: nested ones in one line."""
    return to_yaml(msg, MessageFormat(truncate_length, not no_arr, not no_str, flow_style))


def message_to_csv(
    msg: Message, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> str:
    """The message's values, separated by commas."""
    return to_csv(msg, MessageFormat(truncate_length, not no_arr, not no_str))


def set_message_fields(
    msg: Any, values: Mapping[str, Any], expand_header_auto: bool = False, expand_time_now: bool = False
) -> list[Callable[[Time], None]]:
    """Sets fields of a message; those of nested ones that are not given stay.

    Returns a function for each header that is ``auto`` and each time that is ``now``, where these are asked for: it takes the
    time. Raises AttributeError for a field that there is not, TypeError or ValueError for a value that does not fit.
    """
    if not isinstance(values, Mapping):
        raise TypeError(f"Value '{values}' is expected to be a dictionary but is a {type(values).__name__}")
    stamps: list[Callable[[Time], None]] = []
    for name, value in values.items():
        present = getattr(msg, name)
        if expand_header_auto and isinstance(present, Header) and value == "auto":
            stamps.append(partial(setattr, present, "stamp"))
        elif expand_time_now and isinstance(present, Time) and value == "now":
            stamps.append(partial(setattr, msg, name))
        elif isinstance(present, Message) and isinstance(value, Message):
            setattr(msg, name, value)
        elif isinstance(present, Message):
            stamps += set_message_fields(present, value, expand_header_auto, expand_time_now)
        else:
            setattr(msg, name, getattr(from_dict(type(msg), {name: value}), name))
    return stamps
