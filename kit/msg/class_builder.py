"""Builds message, service and action classes from the texts of their definitions."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any, cast

from kit.msg.definition_parser import DefinitionError, MemberText, SectionText, TypeText, parse_definition
from kit.msg.fields import (
    SCALARS,
    FieldError,
    FieldKind,
    FixedArrayKind,
    MessageKind,
    ScalarKind,
    SequenceKind,
    bounded_string,
    zero,
)
from kit.msg.message import (
    Action,
    Constant,
    Field,
    Message,
    Service,
    ServiceType,
    generated_module,
    make_message_class,
    short_type_name,
)

Interface = type[Message] | type[Service] | type[Action]
"""A message, service or action class."""

FindMessage = Callable[[str], type[Message]]
"""Finds the class of a message by its ROS name, as ``geometry_msgs/msg/Point``. Raises LookupError."""

_ITEM = re.compile(r"""\s*("(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*'|[^,\s][^,]*?)\s*(?:,|$)""")


def build_interface(
    ros_type: str, text: str, file: str, find_message: FindMessage, *, is_custom: bool
) -> Interface:
    """The class of an interface from its definition's text.

    ``file`` is named in errors. Raises DefinitionError.
    """
    _, part, name = ros_type.split("/")
    builder = _InterfaceBuilder(ros_type, file, find_message, is_custom)
    sections = parse_definition(text, part, file)
    if part == "msg":
        return builder.message(ros_type, sections[0])
    if part == "srv":
        return builder.service(ros_type, *(_Members(section) for section in sections))
    return builder.action(ros_type, name, sections)


def build_recorded_message(ros_type: str, text: str, find_message: FindMessage) -> type[Message]:
    """The class of a message from the definition that a bag carries, with those of all messages in it.

    Messages that ``find_message`` does not know are built from the same text. Raises DefinitionError.
    """
    own, *nested = re.split(r"={80}\nMSG: ", text)
    texts = {name.strip(): body for name, _, body in (part.partition("\n") for part in nested)}
    built: dict[str, type[Message]] = {}

    def find(name: str) -> type[Message]:
        short = name.replace("/msg/", "/")
        if short in built:
            return built[short]
        if short in texts:
            try:
                return find_message(name)
            except LookupError:
                # Only messages of actions have an underscore in their names.
                full = name.replace("/msg/", "/action/") if "_" in name.rpartition("/")[2] else name
                built[short] = build(full, texts.pop(short))
                return built[short]
        return find_message(name)

    def build(name: str, body: str) -> type[Message]:
        return _InterfaceBuilder(name, name, find, True).message(name, parse_definition(body, "msg", name)[0])

    return build(ros_type, own)


class _Members:
    """The fields of a message to build: parsed ones, or ready-made ones."""

    def __init__(self, section: SectionText | None = None, fields: tuple[Field, ...] = ()) -> None:
        self.section = section or SectionText([], [])
        self.fields = fields


class _InterfaceBuilder:
    """Builds the classes of one definition file."""

    def __init__(self, ros_type: str, file: str, find_message: FindMessage, is_custom: bool) -> None:
        self.package, self.part, self._name = ros_type.split("/")
        self._file = file
        self._find_message = find_message
        self._is_custom = is_custom

    def message(self, ros_type: str, section: SectionText, fields: tuple[Field, ...] = ()) -> type[Message]:
        return make_message_class(
            ros_type,
            [*fields, *map(self._field, section.fields)],
            map(self._constant, section.constants),
            interface=self._name,
            is_custom=self._is_custom,
        )

    def service(self, ros_type: str, request: _Members, response: _Members) -> type[Service]:
        cls = ServiceType(
            ros_type.rpartition("/")[2],
            (Service,),
            {
                **self._attributes(ros_type),
                "Request": self.message(f"{ros_type}_Request", request.section, request.fields),
                "Response": self.message(f"{ros_type}_Response", response.section, response.fields),
            },
        )
        return cast(type[Service], cls)

    def action(self, ros_type: str, name: str, sections: list[SectionText]) -> type[Action]:
        """The action, with the services and the message that carry it, as rosidl generates them."""
        goal, result, feedback = (
            self.message(f"{ros_type}_{word}", section)
            for word, section in zip(("Goal", "Result", "Feedback"), sections, strict=True)
        )
        goal_id = _message_field("goal_id", self._find_message("unique_identifier_msgs/msg/UUID"))
        stamp = _message_field("stamp", self._find_message("builtin_interfaces/msg/Time"))
        accepted, status = Field("accepted", SCALARS["bool"]), Field("status", SCALARS["int8"])
        impl = {
            "SendGoalService": self.service(
                f"{ros_type}_SendGoal",
                _Members(fields=(goal_id, _message_field("goal", goal))),
                _Members(fields=(accepted, stamp)),
            ),
            "GetResultService": self.service(
                f"{ros_type}_GetResult",
                _Members(fields=(goal_id,)),
                _Members(fields=(status, _message_field("result", result))),
            ),
            "FeedbackMessage": self.message(
                f"{ros_type}_FeedbackMessage",
                SectionText([], []),
                (goal_id, _message_field("feedback", feedback)),
            ),
            "GoalStatusMessage": self._find_message("action_msgs/msg/GoalStatusArray"),
            "CancelGoalService": self._find_message("action_msgs/srv/CancelGoal"),
        }
        place = {"__module__": generated_module(ros_type, name), "__qualname__": f"{name}.Impl"}
        return type(
            name,
            (Action,),
            {
                **self._attributes(ros_type),
                "Goal": goal,
                "Result": result,
                "Feedback": feedback,
                "Impl": type("Impl", (), place | impl),
            },
        )

    def _attributes(self, ros_type: str) -> dict[str, Any]:
        return {
            "__module__": generated_module(ros_type, self._name),
            "__qualname__": ros_type.rpartition("/")[2],
            "__ros_type__": ros_type,
            "__ros_custom__": self._is_custom,
        }

    def _error(self, member: MemberText, problem: object, *, at_value: bool = False) -> DefinitionError:
        column = member.value_column if at_value else member.column
        return DefinitionError(self._file, member.line, column, str(problem))

    def _field(self, member: MemberText) -> Field:
        kind = self._kind(member)
        if not member.value:
            return Field(member.name, kind, zero, member.since)
        return Field(member.name, kind, self._default(member, kind), member.since)

    def _constant(self, member: MemberText) -> Constant:
        kind = SCALARS.get(member.type.name)
        if kind is None or member.type.is_array or member.type.package:
            raise self._error(
                member, f"the constant '{member.name}' must be a number, a truth value or a string"
            )
        return Constant(member.name, kind, self._scalar(member, kind, member.value))

    def _kind(self, member: MemberText) -> FieldKind:
        parts = member.type
        item = self._item_kind(member, parts)
        if not parts.is_array:
            return item
        if parts.length is None:
            return SequenceKind(item, parts.bound)
        if isinstance(item, ScalarKind) and item.type_code:
            return FixedArrayKind(item, parts.length)
        return SequenceKind(item, length=parts.length)

    def _item_kind(self, member: MemberText, parts: TypeText) -> FieldKind:
        scalar = SCALARS.get(parts.name) if not parts.package else None
        if scalar is not None:
            return scalar if parts.limit is None else bounded_string(scalar, parts.limit)
        name = f"{parts.package or self.package}/msg/{parts.name}"
        try:
            cls = self._find_message(name)
        except LookupError as problem:
            hint = "; write std_msgs/Header" if name.endswith("/msg/Header") else ""
            raise DefinitionError(self._file, member.line, 1, f"{problem}{hint}") from None
        return MessageKind(cls, name.replace("/msg/", "/"), cls)

    def _default(self, member: MemberText, kind: FieldKind) -> Any:
        if isinstance(kind, ScalarKind):
            return self._scalar(member, kind, member.value)
        if isinstance(kind, MessageKind) or not isinstance(kind.item, ScalarKind):  # type: ignore[attr-defined]  # the other kinds all have items
            raise self._error(member, "a message has no default value", at_value=True)
        text = member.value
        if not (text.startswith("[") and text.endswith("]")):
            raise self._error(
                member, f"the default of '{member.name}' must be a list, as [1, 2]", at_value=True
            )
        item: ScalarKind = kind.item  # type: ignore[attr-defined]  # as above
        values = [self._scalar(member, item, found[1]) for found in _ITEM.finditer(text[1:-1])]
        try:
            return kind.check(values, member.name)
        except FieldError as problem:
            raise self._error(member, problem, at_value=True) from None

    def _scalar(self, member: MemberText, kind: ScalarKind, text: str) -> Any:
        """A value as definitions write it."""
        try:
            return kind.check(_parse_scalar(kind, text), member.name)
        except (ValueError, FieldError) as problem:
            reason = problem if isinstance(problem, FieldError) else f"'{text}' is no {kind.text}"
            raise self._error(member, reason, at_value=True) from None


def _message_field(name: str, cls: type[Message]) -> Field:
    return Field(name, MessageKind(cls, short_type_name(cls), cls))


def _parse_scalar(kind: ScalarKind, text: str) -> Any:
    if kind.python_type is str:
        if len(text) >= 2 and text[0] in "\"'" and text[-1] == text[0]:
            return text[1:-1].replace("\\" + text[0], text[0])
        return text
    if kind.python_type is bool:
        return {"true": True, "1": True, "false": False, "0": False}.get(text.lower(), text)
    if kind.python_type is float:
        return float(text)
    try:
        number = int(text)
    except ValueError:
        number = int(text, 0)
    return bytes((number,)) if kind.python_type is bytes else number
