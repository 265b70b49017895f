"""Finds message and service classes by their ROS names, and writes their definitions as .msg and .srv files do."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module

from kit.msg.message import Field, Message, Service
from kit.plain_text import nearest_name

PACKAGES = (
    "builtin_interfaces",
    "diagnostic_msgs",
    "flatland_msgs",
    "geometry_msgs",
    "nav_msgs",
    "rcl_interfaces",
    "robot_kit_msgs",
    "rosgraph_msgs",
    "sensor_msgs",
    "shape_msgs",
    "std_msgs",
    "std_srvs",
    "tf2_msgs",
    "trajectory_msgs",
    "unique_identifier_msgs",
    "visualization_msgs",
)
"""Every ROS package that ``kit.msg`` has a module for."""

DISTROS = ("humble", "iron", "jazzy", "kilted", "lyrical")
"""The ROS 2 distributions a definition can be written for, oldest first."""

Interface = type[Message] | type[Service]
"""A message or a service class."""


class UnknownInterface(LookupError):
    """No message or service has this name."""


def interfaces(package: str) -> tuple[Interface, ...]:
    """The messages and services of one of ``PACKAGES``, sorted by name."""
    return tuple(sorted(_members(package), key=lambda cls: cls.__ros_type__))


def interface_names() -> tuple[str, ...]:
    """The ROS names of all messages and services, sorted. Imports every package."""
    return tuple(cls.__ros_type__ for package in PACKAGES for cls in interfaces(package))


def find_interface(name: str) -> Interface:
    """The class called ``geometry_msgs/msg/Twist``, also ``geometry_msgs/Twist``; a service likewise.

    Raises UnknownInterface, naming the nearest one.
    """
    parts = name.split("/")
    if len(parts) in (2, 3) and parts[0] in PACKAGES:
        for cls in _members(parts[0]):
            found = cls.__ros_type__.split("/")
            if found[2] == parts[-1] and (len(parts) == 2 or found == parts):
                return cls
    near = nearest_name(name, interface_names())
    hint = f"; did you mean '{near}'?" if near else ""
    raise UnknownInterface(f"there is no message or service '{name}'{hint}")


def find_message(name: str) -> type[Message]:
    """The message class of this name. Raises UnknownInterface, also if it is a service."""
    cls = find_interface(name)
    if not issubclass(cls, Message):
        raise UnknownInterface(f"'{name}' is a service, not a message")
    return cls


def find_service(name: str) -> type[Service]:
    """The service class of this name. Raises UnknownInterface, also if it is a message."""
    cls = find_interface(name)
    if not issubclass(cls, Service):
        raise UnknownInterface(f"'{name}' is a message, not a service")
    return cls


def fields_of(cls: type[Message], distro: str = DISTROS[-1]) -> tuple[Field, ...]:
    """The fields that the message has in a distribution: a few have grown one since Humble."""
    age = DISTROS.index(distro)
    return tuple(
        field for field in cls.__ros_fields__ if not field.since or DISTROS.index(field.since) <= age
    )


def definition(cls: Interface, distro: str = DISTROS[-1]) -> str:
    """The interface as its .msg or .srv file defines it, without the comments; ends with a newline."""
    if issubclass(cls, Service):
        return f"{definition(cls.Request, distro)}---\n{definition(cls.Response, distro)}"
    lines = []
    for constant in cls.__ros_constants__:
        value = constant.value[0] if isinstance(constant.value, bytes) else constant.value
        lines.append(f"{constant.kind.text} {constant.name}={value}\n")
    for field in fields_of(cls, distro):
        default = "" if field.has_zero_default else f" {field.default}"
        lines.append(f"{field.kind.text} {field.name}{default}\n")
    return "".join(lines)


def _members(package: str) -> Iterator[Interface]:
    """The classes that a package's module defines itself, and not those it imports."""
    module = import_module(f"kit.msg.{package}")
    for cls in vars(module).values():
        if (
            isinstance(cls, type)
            and issubclass(cls, (Message, Service))
            and cls.__module__ == module.__name__
        ):
            yield cls
