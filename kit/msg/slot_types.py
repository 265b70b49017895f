"""The types of a message's fields as rosidl_parser.definition has them, for programs that look into any message.

``message.SLOT_TYPES`` holds one for each field, in the order of ``__slots__``.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final


class AbstractType:
    """Any type of a field."""


class AbstractNestableType(AbstractType):
    """A type of which there may be arrays and sequences."""


@dataclass(frozen=True)
class BasicType(AbstractNestableType):
    """A number, truth value or byte: ``double``, ``int32``, ``boolean``, ``octet``."""

    typename: str


class AbstractGenericString(AbstractNestableType):
    """A text."""

    def has_maximum_size(self) -> bool:
        """Whether its length is bounded."""
        return isinstance(self, BoundedString | BoundedWString)


class AbstractString(AbstractGenericString):
    """A text of ``string``."""


@dataclass(frozen=True)
class BoundedString(AbstractString):
    """A text of at most ``maximum_size`` characters."""

    maximum_size: int


@dataclass(frozen=True)
class UnboundedString(AbstractString):
    """A text of any length."""


class AbstractWString(AbstractGenericString):
    """A text of ``wstring``."""


@dataclass(frozen=True)
class BoundedWString(AbstractWString):
    """A text of at most ``maximum_size`` characters."""

    maximum_size: int


@dataclass(frozen=True)
class UnboundedWString(AbstractWString):
    """A text of any length."""


@dataclass(frozen=True)
class NamespacedType(AbstractNestableType):
    """Another message."""

    namespaces: tuple[str, ...]
    name: str

    def namespaced_name(self) -> tuple[str, ...]:
        """Package, folder and name.

        >>> NamespacedType(("geometry_msgs", "msg"), "Point").namespaced_name()
        ('geometry_msgs', 'msg', 'Point')
        """
        return (*self.namespaces, self.name)


@dataclass(frozen=True)
class AbstractNestedType(AbstractType):
    """Several values of one type."""

    value_type: AbstractNestableType

    def has_maximum_size(self) -> bool:
        """Whether their number is bounded."""
        return not isinstance(self, UnboundedSequence)


@dataclass(frozen=True)
class Array(AbstractNestedType):
    """``size`` values."""

    size: int


class AbstractSequence(AbstractNestedType):
    """Values of which there may be more or fewer."""


@dataclass(frozen=True)
class BoundedSequence(AbstractSequence):
    """At most ``maximum_size`` values."""

    maximum_size: int


@dataclass(frozen=True)
class UnboundedSequence(AbstractSequence):
    """Any number of values."""


_ARRAY: Final = re.compile(r"(?P<of>.+)\[(?P<size>\d+)\]")
_SEQUENCE: Final = re.compile(r"sequence<(?P<of>[^,]+)(?:, (?P<size>\d+))?>")
_TEXT: Final = re.compile(r"(?P<wide>w?)string(?:<(?P<size>\d+)>)?")


def slot_type(idl: str) -> AbstractType:
    """The type that ``get_fields_and_field_types`` writes so.

    >>> slot_type("sequence<geometry_msgs/Point>")
    UnboundedSequence(value_type=NamespacedType(namespaces=('geometry_msgs', 'msg'), name='Point'))
    >>> slot_type("double[36]")
    Array(value_type=BasicType(typename='double'), size=36)
    """
    if found := _ARRAY.fullmatch(idl):
        return Array(_nestable(found["of"]), int(found["size"]))
    if found := _SEQUENCE.fullmatch(idl):
        of, size = _nestable(found["of"]), found["size"]
        return UnboundedSequence(of) if size is None else BoundedSequence(of, int(size))
    return _nestable(idl)


def _nestable(idl: str) -> AbstractNestableType:
    if found := _TEXT.fullmatch(idl):
        if found["size"] is None:
            return UnboundedWString() if found["wide"] else UnboundedString()
        return (BoundedWString if found["wide"] else BoundedString)(int(found["size"]))
    package, _, name = idl.partition("/")
    return NamespacedType((package, "msg"), name) if name else BasicType(idl)
