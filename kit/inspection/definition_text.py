"""What ``kit ros interface show`` prints: an interface as its file is written, with or without its comments."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from kit.msg.definition_parser import parse_definition
from kit.msg.fields import MessageKind, item_kind
from kit.msg.interfaces import PACKAGES, Interface, definition, definition_source
from kit.msg.message import Message, Service

_SINCE: Final = re.compile(r"\s*# added in \w+\s*$")


@dataclass(frozen=True, slots=True)
class CommentOptions:
    """Which comments are shown."""

    own: bool = True
    """Those of the interface's own file."""
    nested: bool = False
    """Those of the messages in it."""


def definition_text(cls: Interface, comments: CommentOptions = CommentOptions()) -> str:
    """The text of an interface, with those of all messages in it, each level indented by a tab.

    Raises DefinitionError.
    """
    return "".join(f"{line}\n" for line in _definition_lines(cls, comments.own, comments.nested, 0))


def _definition_lines(cls: Interface, comments: bool, nested_comments: bool, depth: int) -> Iterator[str]:
    text, kind, messages = _source(cls)
    sections = parse_definition(text, kind, cls.__ros_type__)
    fields = {
        member.line: field.kind
        for message, section in zip(messages, sections, strict=True)
        for member, field in zip(section.fields, message.__ros_fields__, strict=True)
    }
    for number, line in enumerate(text.splitlines(), start=1):
        shown = _SINCE.sub("", line).rstrip() if comments else line.partition("#")[0].rstrip()
        if not shown and not comments:
            continue
        package = cls.__ros_type__.partition("/")[0]
        if (
            number in fields and package in PACKAGES
        ):  # ROS 2's own files name a neighbour by its own name alone
            shown = shown.removeprefix(f"{package}/")
        yield "\t" * depth + shown if shown else ""
        item = item_kind(fields[number]) if number in fields else None
        if isinstance(item, MessageKind):
            yield from _definition_lines(item.cls, nested_comments, nested_comments, depth + 1)


def _source(cls: Interface) -> tuple[str, str, tuple[type[Message], ...]]:
    """The text of an interface, the kind of file that it is, and the messages of its sections."""
    kind, messages = "msg", _sections(cls)
    if not issubclass(cls, Message):
        kind = "srv" if issubclass(cls, Service) else "action"
    try:
        return definition_source(cls.__ros_type__), kind, messages
    except (LookupError, FileNotFoundError):  # a part of an action, which has no file of its own
        return definition(cls), kind, messages


def _sections(cls: Interface) -> tuple[type[Message], ...]:
    if issubclass(cls, Message):
        return (cls,)
    return (cls.Request, cls.Response) if issubclass(cls, Service) else (cls.Goal, cls.Result, cls.Feedback)
