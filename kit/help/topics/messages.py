"""Messages, services and actions: every interface that comes with the kit, with its fields."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

from kit.document.blocks import CellStyle, Chapter, Column, Table
from kit.help.topic import HelpTopic, Shelf, chapter
from kit.msg.interfaces import definition_source, interface_names, known_packages

_COLUMNS: Final = tuple(Column(title, CellStyle.TEXT) for title in ("Name", "Fields"))
_PARTS: Final = "---"
_CONSTANT: Final = re.compile(r"^\S+\s+\w+\s*=(?!=)")


def _chapters() -> tuple[Chapter, ...]:
    return (
        chapter(
            "How to use them",
            """
Import them as in ROS 2: `from geometry_msgs.msg import Twist`. `kit ros interface show geometry_msgs/msg/Twist` prints a
definition with its comments and constants, `kit ros interface list` all names.

A program's own interfaces are read from the `msg`, `srv` and `action` folders of its package; nothing has to be built. A
service has two parts, request and response; an action has three: goal, result, feedback. Parts are separated by `|` here.
""",
        ),
        *map(_package_chapter, known_packages()),
    )


def _package_chapter(package: str) -> Chapter:
    table = Table(package.replace("_", "-"), "", _COLUMNS, tuple(_interface_rows(package)))
    return chapter(package, table)


def _interface_rows(package: str) -> Iterator[tuple[str, str]]:
    for name in interface_names(package):
        parts = re.split(rf"^{_PARTS}$", definition_source(name), flags=re.MULTILINE)
        yield name.partition("/")[2], " | ".join(", ".join(_field_lines(part)) or "nothing" for part in parts)


def _field_lines(part: str) -> Iterator[str]:
    """Type and name of each field, without constants and comments."""
    for line in part.splitlines():
        field = line.partition("#")[0].strip()
        if field and not _CONSTANT.match(field):
            yield " ".join(field.split())


TOPIC: Final = HelpTopic(
    "Messages", "every ROS 2 message, service and action that comes with the kit", Shelf.REFERENCE, _chapters
)
