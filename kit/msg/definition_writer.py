"""Writes the definitions of interfaces as text, alone or with those of all messages of a workspace in them.

Two classes with the same definitions are the same interface: ``same_interface`` keeps one class for both, whether its
definitions come from files or from another process.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import Any, Final
from weakref import WeakKeyDictionary

from kit.msg.class_builder import Interface
from kit.msg.fields import FieldKind, MessageKind, SequenceKind
from kit.msg.message import Action, Field, Message, Service

DEFINITIONS: Final = os.path.join(os.path.dirname(__file__), "definitions")
PACKAGES: Final = tuple(sorted(os.listdir(DEFINITIONS)))
"""Every ROS package whose definitions are shipped."""

DISTROS: Final = ("humble", "iron", "jazzy", "kilted", "lyrical")
"""The ROS 2 distributions a definition can be written for, oldest first."""

Definitions = dict[str, str]
"""Texts of interfaces by their ROS names; those that others need come before them."""

_classes: Final[dict[tuple[str, tuple[tuple[str, str], ...]], Interface]] = {}
"""Interfaces of workspaces by name and definitions."""
_definitions: Final[WeakKeyDictionary[Any, Definitions]] = WeakKeyDictionary()
"""The definitions of those classes, and of the parts of actions and the events of services among them."""


def fields_of(cls: type[Message], distro: str = DISTROS[-1]) -> tuple[Field, ...]:
    """The fields that the message has in a distribution: a few have grown one since Humble."""
    age = DISTROS.index(distro)
    return tuple(
        field for field in cls.__ros_fields__ if not field.since or DISTROS.index(field.since) <= age
    )


def definition(cls: Interface, distro: str = DISTROS[-1]) -> str:
    """The interface as its file defines it in a distribution, without the comments; ends with a newline."""
    if issubclass(cls, Service):
        return f"{definition(cls.Request, distro)}---\n{definition(cls.Response, distro)}"
    if issubclass(cls, Action):
        return "---\n".join(definition(part, distro) for part in (cls.Goal, cls.Result, cls.Feedback))
    lines = [
        f"{constant.kind.text} {constant.name}={_written(constant.value)}\n"
        for constant in cls.__ros_constants__
    ]
    for field in fields_of(cls, distro):
        default = "" if field.has_zero_default else f" {_written(field.default)}"
        lines.append(f"{field.kind.text} {field.name}{default}\n")
    return "".join(lines)


def _written(value: Any) -> str:
    """A constant or default as definitions write it."""
    if isinstance(value, bytes):
        return str(value[0])
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return '"' + value.replace('"', '\\"') + '"'
    if hasattr(value, "__iter__"):
        return f"[{', '.join(map(_written, value))}]"
    return str(value)


def same_interface(cls: Interface) -> Interface:
    """The class, or an earlier one with the same name and definitions. A class that the kit ships is returned as it is."""
    if is_shipped(cls.__ros_type__):
        return cls
    definitions: Definitions = {}
    _collect(cls, definitions)
    found = _classes.setdefault((cls.__ros_type__, tuple(sorted(definitions.items()))), cls)
    _definitions[found] = definitions
    if issubclass(found, Action):
        parts = (found.Impl.SendGoalService, found.Impl.GetResultService, found.Impl.FeedbackMessage)
        for part in parts:
            mark_part(part, found)
    return found


def mark_part(part: Any, whole: Any) -> None:
    """Records that a class is defined by the definition of another: an action's part, or a service's event."""
    if whole in _definitions:
        _definitions[part] = _definitions[whole]


def definitions_of(cls: Any) -> Definitions:
    """The definitions with which another process can build the class; empty for an interface that the kit ships.

    >>> from kit.msg.std_msgs import String
    >>> definitions_of(String)
    {}
    """
    return _definitions.get(cls, {})


def is_shipped(name: str) -> bool:
    """True for the interfaces of the packages that the kit brings."""
    return name.partition("/")[0] in PACKAGES


def _collect(cls: Interface, found: Definitions) -> None:
    """Adds the definitions of a class and of the messages in it that are not the kit's."""
    if is_shipped(cls.__ros_type__) or cls.__ros_type__ in found:
        return
    for message in _sections(cls):
        for field in message.__ros_fields__:
            nested = _message_of(field.kind)
            if nested is not None:
                _collect(nested, found)
    found[cls.__ros_type__] = definition(cls)


def _sections(cls: Interface) -> Iterator[type[Message]]:
    if issubclass(cls, Message):
        yield cls
    elif issubclass(cls, Service):
        yield from (cls.Request, cls.Response)
    else:
        yield from (cls.Goal, cls.Result, cls.Feedback)


def _message_of(kind: FieldKind) -> type[Message] | None:
    if isinstance(kind, SequenceKind):
        return _message_of(kind.item)
    return kind.cls if isinstance(kind, MessageKind) else None
