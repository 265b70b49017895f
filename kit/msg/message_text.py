"""Messages as ``topic echo`` prints them and ``rosidl_runtime_py`` returns them: YAML or CSV, long arrays and texts cut."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

import yaml

from kit.msg.fields import FieldKind, FixedArrayKind, SequenceKind
from kit.msg.message import Message

DEFAULT_MAX_LENGTH: Final = 128
"""Items and characters of one value that are shown by default."""

LINE_WIDTH: Final = 2**31 - 1
"""A line of YAML is never broken."""

_Dumper: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)


class NoSuchField(LookupError):
    """The message has no such field; the error names it."""


@dataclass(frozen=True, slots=True)
class MessageFormat:
    """Options for formatting a message: truncation, arrays, texts, flow style."""

    longest: int | None = DEFAULT_MAX_LENGTH
    """Longer arrays and texts are truncated to this length; None: never."""
    arrays: bool = True
    """Whether arrays are written in full, or only with type and length."""
    texts: bool = True
    flow: bool = False
    """Arrays and nested messages in one line each."""


def to_yaml(message: Message, message_format: MessageFormat = MessageFormat()) -> str:
    """The message's fields, one a line; ends with a newline."""
    return str(
        yaml.dump(
            as_plain_data(message, message_format),
            Dumper=_Dumper,
            sort_keys=False,
            allow_unicode=True,
            width=LINE_WIDTH,
            default_flow_style=message_format.flow,
        )
    )


def to_csv(message: Message, message_format: MessageFormat = MessageFormat()) -> str:
    """All values in the order of the definition, without names."""
    return ",".join(_cells(message, message_format))


def get_field(message: Message, path: str) -> Any:
    """The value at a path of field names joined by dots. Raises NoSuchField."""
    found: Any = message
    for name in path.split("."):
        if not isinstance(found, Message) or name not in type(found).get_fields_and_field_types():
            has = (
                ", ".join(type(found).get_fields_and_field_types()) if isinstance(found, Message) else "none"
            )
            raise NoSuchField(f"Invalid field '{path}': there is no '{name}'; available fields: {has}")
        found = getattr(found, name)
    return found


def as_plain_data(message: Message, message_format: MessageFormat = MessageFormat()) -> dict[str, Any]:
    """The message's fields by name, in the order of the definition; nested messages as dicts, arrays as lists."""
    return {
        field.name: _value(getattr(message, field.name), field.kind, message_format)
        for field in type(message).__ros_fields__
    }


def _value(value: Any, kind: FieldKind, message_format: MessageFormat) -> Any:
    if isinstance(value, Message):
        return as_plain_data(value, message_format)
    if isinstance(value, (str, bytes)):
        return _text(value, message_format)
    if isinstance(kind, FixedArrayKind):
        if not message_format.arrays:
            return f"<array type: {kind.idl}>"
        return _truncate(
            [_value(entry, kind.item, message_format) for entry in value.tolist()], message_format
        )
    if isinstance(kind, SequenceKind):
        if not message_format.arrays:
            return f"<sequence type: {kind.item.idl}, length: {len(value)}>"
        return _truncate([_value(entry, kind.item, message_format) for entry in value], message_format)
    return value


def _text(value: str | bytes, message_format: MessageFormat) -> str:
    text = value if isinstance(value, str) else value.decode("latin-1")
    if not message_format.texts:
        return f"<string length: <{len(text)}>>"
    return (
        text
        if message_format.longest is None or len(text) <= message_format.longest
        else text[: message_format.longest] + "..."
    )


def _truncate(values: list[Any], message_format: MessageFormat) -> list[Any]:
    return (
        values
        if message_format.longest is None or len(values) <= message_format.longest
        else [*values[: message_format.longest], "..."]
    )


def _cells(message: Message, message_format: MessageFormat) -> Iterator[str]:
    for field in type(message).__ros_fields__:
        yield from _cell(getattr(message, field.name), field.kind, message_format)


def _cell(value: Any, kind: FieldKind, message_format: MessageFormat) -> Iterator[str]:
    if isinstance(value, Message):
        yield from _cells(value, message_format)
    elif isinstance(kind, (SequenceKind, FixedArrayKind)):
        if not message_format.arrays:
            yield str(_value(value, kind, message_format))
            return
        for entry in _truncate(list(value), message_format):
            yield "..." if entry == "..." else next(iter(_cell(entry, kind.item, message_format)), "")
    else:
        yield str(_value(value, kind, message_format))
