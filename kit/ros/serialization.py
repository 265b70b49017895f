"""Serializes messages as ROS 2 does (CDR), and computes definitions and hashes of types. Uses the rosbags library.

Not imported by the rest of ``kit.ros``: rosbags and numpy take a tenth of a second to load.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable
from functools import cache, cached_property
from typing import Any, Final, Literal, TypeVar

import numpy as np
from rosbags.interfaces import Nodetype
from rosbags.serde import SerdeError
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from kit.msg.fields import FieldKind, FixedArrayKind, MessageKind, ScalarKind, SequenceKind, item_kind
from kit.msg.interfaces import definition, fields_of, message_kind, service_event_class
from kit.msg.message import Field, Message, Service, make_message_class, short_type_name

Distro = Literal["humble", "jazzy"]

_CHAR: Final = (Nodetype.BASE, ("char", 0))
_UINT8_TYPE: Final = (Nodetype.BASE, ("uint8", 0))
_STORES: Final = {"humble": Stores.ROS2_HUMBLE, "jazzy": Stores.ROS2_JAZZY}

M = TypeVar("M", bound=Message)

Convert = Callable[[Any], Any]


class Serializer:
    """Serializes messages for one ROS 2 distribution: a few types have gained a field between distributions."""

    def __init__(self, distro: Distro = "jazzy") -> None:
        self.distro: Distro = distro
        self._to_rosbags: dict[type[Message], Convert] = {}
        self._from_rosbags: dict[type[Message], Convert] = {}

    @cached_property
    def typestore(self) -> Typestore:
        """The types of the distribution; the kit's own are added when they are first used."""
        store = get_typestore(_STORES[self.distro])
        for name, (constants, described) in store.fielddefs.items():
            store.fielddefs[name] = constants, [(field, _without_char(node)) for field, node in described]
        return store

    def serialize(self, message: Message) -> bytes:
        """The message in CDR, with its four bytes of header."""
        cls = type(message)
        if cls not in self._to_rosbags:
            self._to_rosbags[cls] = self._to_rosbags_for(cls)
        return bytes(self.typestore.serialize_cdr(self._to_rosbags[cls](message), cls.__ros_type__))

    def deserialize(self, data: bytes, cls: type[Message]) -> Any:
        """The message of type ``cls`` in ``data``. ValueError if it does not fit."""
        if cls not in self._from_rosbags:
            self._register(cls)
            self._from_rosbags[cls] = self._from_rosbags_for(cls)
        try:
            return self._from_rosbags[cls](self.typestore.deserialize_cdr(data, cls.__ros_type__))
        except (AssertionError, SerdeError, ValueError) as problem:
            raise ValueError(f"these bytes are no {cls.__ros_type__}: {problem}") from None

    def definition(self, cls: type[Message]) -> str:
        """The type's definition, with those of all types in it, as bags carry it."""
        self._register(cls)  # refuses what cannot be recorded
        parts: dict[str, str] = {}
        self._collect_definitions(cls, parts)
        (own, *nested) = parts.items()
        separator = "=" * 80
        return "".join([own[1], *(f"{separator}\nMSG: {name}\n{text}" for name, text in nested)])

    def _collect_definitions(self, cls: type[Message], parts: dict[str, str]) -> None:
        name = short_type_name(cls)
        if name not in parts:
            parts[name] = definition(cls, self.distro)
            for field in fields_of(cls, self.distro):
                item = item_kind(field.kind)
                if isinstance(item, MessageKind):
                    self._collect_definitions(item.cls, parts)

    def type_hash(self, cls: type[Message]) -> str:
        """The type's RIHS01 hash (REP 2011)."""
        self._register(cls)
        return self.typestore.hash_rihs01(cls.__ros_type__)

    def service_type_hash(self, cls: type[Service]) -> str:
        """A service's RIHS01 hash (REP 2011): that of a structure of its request, response and event."""
        parts = {
            "request_message": cls.Request,
            "response_message": cls.Response,
            "event_message": service_event_class(cls),
        }
        whole = make_message_class(
            cls.__ros_type__,
            [Field(name, message_kind(part)) for name, part in parts.items()],
        )
        return self.type_hash(whole)

    def _register(self, cls: type[Message]) -> None:
        """Adds the type, and those of its fields, to the type store if they are missing."""
        for field in fields_of(cls, self.distro):
            item = item_kind(field.kind)
            if isinstance(item, ScalarKind) and item.text.startswith("wstring"):
                raise ValueError(
                    f"{cls.__ros_type__}: the field '{field.name}' is a wstring, which cannot be recorded; "
                    "use string"
                )
            if isinstance(item, MessageKind):
                self._register(item.cls)
        if cls.__ros_type__ not in self.typestore.types:
            ((constants, members),) = get_types_from_msg(
                definition(cls, self.distro), short_type_name(cls)
            ).values()
            fields = fields_of(cls, self.distro)
            named = [
                (name, _without_char(_with_type_name(description, field.kind)))
                for (name, description), field in zip(members, fields, strict=True)
            ]
            self.typestore.register({cls.__ros_type__: (constants, named)})

    def _to_rosbags_for(self, cls: type[Message]) -> Convert:
        self._register(cls)
        make: Any = self.typestore.types[cls.__ros_type__]
        steps = [
            (field.name, field.slot, self._to_rosbags_kind(field.kind))
            for field in fields_of(cls, self.distro)
        ]
        if not steps:  # CDR knows no empty structure
            return lambda message: make(structure_needs_at_least_one_member=0)
        return lambda message: make(**{name: step(getattr(message, slot)) for name, slot, step in steps})

    def _to_rosbags_kind(self, kind: FieldKind) -> Convert:
        if isinstance(kind, MessageKind):
            return self._to_rosbags_for(kind.cls)
        if isinstance(kind, FixedArrayKind):
            code = kind.item.type_code
            return lambda value: np.frombuffer(value, code)
        if isinstance(kind, SequenceKind):
            if kind.type_code:
                code = kind.type_code
                return lambda value: np.frombuffer(value, code)
            item = self._to_rosbags_kind(kind.item)
            if isinstance(kind.item, ScalarKind) and kind.item.python_type in (bool, bytes):
                numbers = np.bool_ if kind.item.python_type is bool else np.int8
                return lambda values: np.array([item(value) for value in values], numbers)
            return lambda values: [item(value) for value in values]
        assert isinstance(kind, ScalarKind)
        return _signed_byte if kind.python_type is bytes else _identity

    def _from_rosbags_for(self, cls: type[Message]) -> Convert:
        steps = [(field.name, self._from_rosbags_kind(field.kind)) for field in fields_of(cls, self.distro)]
        return lambda found: cls(**{name: step(getattr(found, name)) for name, step in steps})

    def _from_rosbags_kind(self, kind: FieldKind) -> Convert:
        if isinstance(kind, MessageKind):
            return self._from_rosbags_for(kind.cls)
        if isinstance(kind, FixedArrayKind) or (isinstance(kind, SequenceKind) and kind.type_code):
            code = kind.item.type_code if isinstance(kind, FixedArrayKind) else kind.type_code
            return lambda found: array(code, found.astype(code).tobytes())
        if isinstance(kind, SequenceKind):
            item = self._from_rosbags_kind(kind.item)
            return lambda found: [item(value) for value in found]
        assert isinstance(kind, ScalarKind)
        if kind.python_type is bytes:
            return lambda found: bytes([found & 0xFF])
        return bool if kind.python_type is bool else _identity


def _with_type_name(description: Any, kind: FieldKind) -> Any:
    """rosbags' description of a field with the full name of its message: definitions leave out ``msg`` or ``action``."""
    item = item_kind(kind)
    if not isinstance(item, MessageKind):
        return description
    name = (Nodetype.NAME, item.cls.__ros_type__)
    return name if item is kind else (description[0], (name, description[1][1]))


def _without_char(description: Any) -> Any:
    """A field with uint8 for char: ROS 2 makes a uint8 of it before it computes a hash, which rosbags does not."""
    if description == _CHAR:
        return _UINT8_TYPE
    label, content = description
    if isinstance(content, tuple) and content[0] == _CHAR:
        return label, (_UINT8_TYPE, content[1])
    return description


@cache
def _serializer() -> Serializer:
    """The serializer of programs, which have no distribution in mind."""
    return Serializer()


def serialize_message(message: Message) -> bytes:
    """A message in CDR, as a network carries it. Raises TypeError if it is no message."""
    if not isinstance(message, Message):
        raise TypeError(f"a message is needed here, not {type(message).__name__}")
    return _serializer().serialize(message)


def deserialize_message(serialized_message: bytes, message_type: type[M]) -> M:
    """The message of a type in CDR. Raises ValueError if the bytes do not fit."""
    message: M = _serializer().deserialize(serialized_message, message_type)
    return message


def _identity(value: Any) -> Any:
    return value


def _signed_byte(value: bytes) -> int:
    """A byte as rosbags represents it: from -128 to 127."""
    return (value[0] + 128) % 256 - 128
