"""Messages as ROS 2 sends and stores them (CDR), and what identifies their types; by way of rosbags.

Not imported by the rest of ``kit.ros``: rosbags and numpy take a tenth of a second to load.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, Literal

import numpy as np
from rosbags.serde import SerdeError
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from kit.msg.fields import Fixed, Kind, Many, Nested, Scalar
from kit.msg.interfaces import definition, fields_of
from kit.msg.message import Message, is_ours

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

Distro = Literal["humble", "jazzy"]

_STORES: Final = {"humble": Stores.ROS2_HUMBLE, "jazzy": Stores.ROS2_JAZZY}

Convert = Callable[[Any], Any]


class Serializer:
    """Writes and reads messages as one ROS 2 distribution does: a few types have grown a field in between."""

    def __init__(self, distro: Distro = "jazzy") -> None:
        self.distro: Distro = distro
        self._there: dict[type[Message], Convert] = {}
        self._back: dict[type[Message], Convert] = {}

    @cached_property
    def typestore(self) -> Typestore:
        """The distribution's types; ours join them when they are first used."""
        return get_typestore(_STORES[self.distro])

    def serialize(self, message: Message) -> bytes:
        """The message in CDR, with its four bytes of header."""
        cls = type(message)
        if cls not in self._there:
            self._there[cls] = self._there_for(cls)
        return bytes(self.typestore.serialize_cdr(self._there[cls](message), cls.__ros_type__))

    def deserialize(self, data: bytes, cls: type[Message]) -> Any:
        """The message of type ``cls`` in ``data``. ValueError if it does not fit."""
        if cls not in self._back:
            self._know(cls)
            self._back[cls] = self._back_for(cls)
        try:
            return self._back[cls](self.typestore.deserialize_cdr(data, cls.__ros_type__))
        except (AssertionError, SerdeError, ValueError) as problem:
            raise ValueError(f"these bytes are no {cls.__ros_type__}: {problem}") from None

    def definition(self, cls: type[Message]) -> str:
        """The type's definition, with those of all types in it, as bags carry it."""
        self._know(cls)
        return self.typestore.generate_msgdef(cls.__ros_type__, ros_version=2)[0]

    def type_hash(self, cls: type[Message]) -> str:
        """The type's RIHS01 hash (REP 2011)."""
        self._know(cls)
        return self.typestore.hash_rihs01(cls.__ros_type__)

    def _know(self, cls: type[Message]) -> None:
        """Sees to it that the store has this type and those in it."""
        for field in fields_of(cls, self.distro):
            item = field.kind.item if isinstance(field.kind, Many) else field.kind
            if isinstance(item, Nested):
                self._know(item.cls)
        if cls.__ros_type__ not in self.typestore.types:
            assert is_ours(cls), cls
            self.typestore.register(get_types_from_msg(definition(cls, self.distro), cls.__ros_type__))

    def _there_for(self, cls: type[Message]) -> Convert:
        self._know(cls)
        make: Any = self.typestore.types[cls.__ros_type__]
        steps = [
            (field.name, field.slot, self._there_of(field.kind)) for field in fields_of(cls, self.distro)
        ]
        if not steps:  # CDR knows no empty structure
            return lambda message: make(structure_needs_at_least_one_member=0)
        return lambda message: make(**{name: step(getattr(message, slot)) for name, slot, step in steps})

    def _there_of(self, kind: Kind) -> Convert:
        if isinstance(kind, Nested):
            return self._there_for(kind.cls)
        if isinstance(kind, Fixed):
            code = kind.item.code
            return lambda value: np.frombuffer(value, code)
        if isinstance(kind, Many):
            if kind.code:
                code = kind.code
                return lambda value: np.frombuffer(value, code)
            item = self._there_of(kind.item)
            if isinstance(kind.item, Scalar) and kind.item.python in (bool, bytes):
                numbers = np.bool_ if kind.item.python is bool else np.int8
                return lambda values: np.array([item(value) for value in values], numbers)
            return lambda values: [item(value) for value in values]
        assert isinstance(kind, Scalar)
        return _first if kind.python is bytes else _same

    def _back_for(self, cls: type[Message]) -> Convert:
        steps = [(field.name, self._back_of(field.kind)) for field in fields_of(cls, self.distro)]
        return lambda found: cls(**{name: step(getattr(found, name)) for name, step in steps})

    def _back_of(self, kind: Kind) -> Convert:
        if isinstance(kind, Nested):
            return self._back_for(kind.cls)
        if isinstance(kind, Fixed) or (isinstance(kind, Many) and kind.code):
            code = kind.item.code if isinstance(kind, Fixed) else kind.code
            return lambda found: array(code, found.astype(code).tobytes())
        if isinstance(kind, Many):
            item = self._back_of(kind.item)
            return lambda found: [item(value) for value in found]
        assert isinstance(kind, Scalar)
        if kind.python is bytes:
            return lambda found: bytes([found & 0xFF])
        return bool if kind.python is bool else _same


def _same(value: Any) -> Any:
    return value


def _first(value: bytes) -> int:
    """A byte as rosbags counts it: from -128."""
    return (value[0] + 128) % 256 - 128
