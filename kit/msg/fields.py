"""The kinds of fields of a ROS message: how values of each kind are checked, copied and written in definitions.

Python types are those of ROS 2's own Python messages: ``float``,
``int``, ``bool``, ``str``, one ``bytes`` for a ``byte``; ``array.array`` for an unbounded or bounded sequence
of numbers; ``numpy.ndarray`` for a fixed-length one; ``list`` for every other sequence.
"""

from __future__ import annotations

import struct
from array import array
from collections.abc import Iterable, Sequence, Set
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Protocol

if TYPE_CHECKING:
    from numpy.typing import NDArray


class FieldError(AssertionError):
    """A value that a message field cannot hold. ROS 2 Humble raises AssertionError too."""


class FieldKind(Protocol):
    """One kind of field."""

    @property
    def exact_type(self) -> type | None:
        """Values of exactly this type need no check; None: every value is checked."""

    @property
    def text(self) -> str:
        """The kind as in a .msg file: ``float64[36]``, ``geometry_msgs/Point[]``."""

    @property
    def idl(self) -> str:
        """The kind as in ``get_fields_and_field_types``: ``double[36]``, ``sequence<geometry_msgs/Point>``."""

    def zero(self) -> Any:
        """A new default value."""

    def check(self, value: Any, name: str) -> Any:
        """Returns the value as the message stores it. Raises FieldError, which names the field."""

    def copy(self, value: Any) -> Any:
        """A copy of a stored value."""


def _type_error(name: str, wanted: str, value: object, hint: str = "") -> FieldError:
    found = type(value).__name__
    if type(value).__module__ not in ("builtins", "array", type(value).__name__):
        found = f"{type(value).__module__}.{found}"
    return FieldError(
        f"The '{name}' field must be of type '{wanted}', not {found}" + (f": {hint}" if hint else "")
    )


class ScalarKind(NamedTuple):
    """A number, truth value, text or byte."""

    text: str
    idl: str
    python_type: type
    low: float = 0
    high: float = 0
    """Allowed range, both ends included; equal when there is none."""
    type_code: str = ""
    """Its ``array.array`` type code, if sequences of it are arrays."""
    exact_type: type | None = None
    max_length: int | None = None
    """The largest number of characters of a bounded string."""

    def zero(self) -> Any:
        return b"\0" if self.python_type is bytes else self.python_type()

    def copy(self, value: Any) -> Any:
        return value

    def check(self, value: Any, name: str) -> Any:
        fits = isinstance(value, self.python_type)
        if not fits:
            raise _type_error(name, self.python_type.__name__, value, self._hint(value))
        if self.python_type is bytes and len(value) != 1:
            raise FieldError(f"The '{name}' field must be one byte, not {len(value)}")
        if self.max_length is not None and len(value) > self.max_length:
            raise FieldError(
                f"The '{name}' field must have at most {self.max_length} characters, not {len(value)}"
            )
        # A NaN or an infinity fits every float: hence the comparisons as they are.
        if self.low != self.high and (value < self.low or value > self.high) and value - value == 0:
            raise FieldError(
                f"The '{name}' field must be a {self.text}, {self.low} to {self.high}, not {value}"
            )
        # True is a whole number to Python, and 1 to whoever receives it.
        return int(value) if self.python_type is int else value

    def _hint(self, value: object) -> str:
        if self.python_type is float and type(value) is int:
            return f"write {value}.0 (ROS 2 does not convert whole numbers)"
        if type(value).__module__ == "numpy" or (
            self.python_type in (int, float) and isinstance(value, (float, bool))
        ):
            return f"write {self.python_type.__name__}(...) around the value"
        if self.python_type is str:
            return "write str(...) around the value"
        if self.python_type is bool and isinstance(value, int):
            return f"write {bool(value)}"
        return ""


class MessageKind(NamedTuple):
    """Another message."""

    cls: type[Any]
    text: str
    """``geometry_msgs/Point``"""
    exact_type: type | None = None

    @property
    def idl(self) -> str:
        return self.text

    def zero(self) -> Any:
        return self.cls()

    def copy(self, value: Any) -> Any:
        return value.__deepcopy__(None)

    def check(self, value: Any, name: str) -> Any:
        if not isinstance(value, self.cls):
            hint = ""
            if isinstance(value, type) and issubclass(value, self.cls):
                hint = f"the class itself was given; write {value.__name__}()"
            raise _type_error(name, self.cls.__name__, value, hint)
        return value


def _to_list(value: Any, name: str, wanted: str) -> list[Any]:
    """The items of a sequence or set; text and numpy arrays are refused, as ROS 2 refuses them."""
    if isinstance(value, (Sequence, Set)) and not isinstance(value, str):
        return list(value)
    if isinstance(value, array):
        return value.tolist()
    hint = "write .tolist() after it" if hasattr(value, "tolist") else ""
    if isinstance(value, Iterable) and not hint and not isinstance(value, str):
        hint = "write list(...) around it"
    raise _type_error(name, f"sequence of {wanted}", value, hint)


def _check_items(value: Any, name: str, item: FieldKind) -> list[Any]:
    """Checked items of a sequence."""
    check = item.check
    return [check(entry, f"{name}[{i}]") for i, entry in enumerate(_to_list(value, name, item.idl))]


@dataclass(frozen=True, slots=True)
class SequenceKind:
    """A sequence of any length, of at most ``bound`` items, or of exactly ``length`` items that are no numbers."""

    item: FieldKind
    bound: int | None = None
    exact_type: type | None = None
    length: int | None = None
    type_code: str = field(init=False, repr=False, compare=False)
    """The type code of the array it is kept in; empty if it is kept in a list."""

    def __post_init__(self) -> None:
        code = self.item.type_code if isinstance(self.item, ScalarKind) else ""
        object.__setattr__(self, "type_code", code)

    @property
    def text(self) -> str:
        if self.length is not None:
            return f"{self.item.text}[{self.length}]"
        return f"{self.item.text}[]" if self.bound is None else f"{self.item.text}[<={self.bound}]"

    @property
    def idl(self) -> str:
        if self.length is not None:
            return f"{self.item.idl}[{self.length}]"
        return (
            f"sequence<{self.item.idl}>" if self.bound is None else f"sequence<{self.item.idl}, {self.bound}>"
        )

    def zero(self) -> Any:
        if self.length is not None:
            return [self.item.zero() for _ in range(self.length)]
        return array(self.type_code) if self.type_code else []

    def copy(self, value: Any) -> Any:
        if self.type_code:
            return value[:]
        copy = self.item.copy
        return [copy(entry) for entry in value]

    def check(self, value: Any, name: str) -> Any:
        if self.type_code and type(value) is array:
            if value.typecode != self.type_code:
                raise FieldError(
                    f"The '{name}' field must be array('{self.type_code}', ...) ({self.item.text}), "
                    f"not array('{value.typecode}', ...)"
                )
            kept: Any = value
        elif self.type_code:
            kept = _to_array(self.type_code, _check_items(value, name, self.item), name)
        else:
            checked = _check_items(value, name, self.item)
            # A list stays the caller's own, as in ROS 2: what is appended to it later is sent too.
            kept = value if type(value) is list else checked
        if self.bound is not None and len(kept) > self.bound:
            raise FieldError(f"The '{name}' field must have at most {self.bound} items, not {len(kept)}")
        if self.length is not None and len(kept) != self.length:
            raise FieldError(f"The '{name}' field must have exactly {self.length} items, not {len(kept)}")
        return kept


def item_kind(kind: FieldKind) -> FieldKind:
    """Of a sequence the kind of its items, else the kind itself."""
    return kind.item if isinstance(kind, SequenceKind) else kind


def _to_array(code: str, items: list[Any], name: str) -> array[Any]:
    try:
        return array(code, items)
    except OverflowError as problem:
        raise FieldError(f"The '{name}' field: {problem}") from None


@dataclass(frozen=True, slots=True)
class FixedArrayKind:
    """Exactly ``length`` numbers.

    Stored as an ``array.array`` until the field is read, and from then on as a ``numpy.ndarray``, so that a program
    that never reads a covariance never imports numpy.
    """

    item: ScalarKind
    length: int
    exact_type: type | None = None
    _zeros: array[Any] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(
            self,
            "_zeros",
            array(self.item.type_code, bytes(self.length * struct.calcsize(self.item.type_code))),
        )

    @property
    def text(self) -> str:
        return f"{self.item.text}[{self.length}]"

    @property
    def idl(self) -> str:
        return f"{self.item.idl}[{self.length}]"

    def zero(self) -> Any:
        return self._zeros[:]

    def copy(self, value: Any) -> Any:
        return value[:] if type(value) is array else value.copy()

    def as_ndarray(self, value: Any) -> NDArray[Any]:
        """The kept value as the numpy array that ROS 2 gives."""
        import numpy

        return numpy.frombuffer(value, dtype=self.item.type_code).copy() if type(value) is array else value

    def check(self, value: Any, name: str) -> Any:
        # Not isinstance against numpy.ndarray, which would have to import numpy.
        if type(value).__name__ == "ndarray" and hasattr(value, "dtype"):
            if value.dtype.char != self.item.type_code:
                raise FieldError(
                    f"The '{name}' field must be a numpy array of {self.item.text}, not of {value.dtype}: "
                    f"write .astype('{self.item.text}')"
                )
            kept: Any = value
            count = value.size
        else:
            kept = _to_array(self.item.type_code, _check_items(value, name, self.item), name)
            count = len(kept)
        if count != self.length:
            raise FieldError(f"The '{name}' field must have exactly {self.length} items, not {count}")
        return kept


class _Zero:
    """The default of a field that starts as its kind's zero: 0, empty, or a new message."""

    def __repr__(self) -> str:
        return "zero"


zero: Any = _Zero()

_FLOAT32_MAX = (2 - 2**-23) * 2.0**127

FLOAT32 = ScalarKind("float32", "float", float, -_FLOAT32_MAX, _FLOAT32_MAX, "f")
FLOAT64 = ScalarKind("float64", "double", float, type_code="d", exact_type=float)
INT8 = ScalarKind("int8", "int8", int, -(2**7), 2**7 - 1, "b")
INT16 = ScalarKind("int16", "int16", int, -(2**15), 2**15 - 1, "h")
INT32 = ScalarKind("int32", "int32", int, -(2**31), 2**31 - 1, "i")
INT64 = ScalarKind("int64", "int64", int, -(2**63), 2**63 - 1, "q")
UINT8 = ScalarKind("uint8", "uint8", int, 0, 2**8 - 1, "B")
UINT16 = ScalarKind("uint16", "uint16", int, 0, 2**16 - 1, "H")
UINT32 = ScalarKind("uint32", "uint32", int, 0, 2**32 - 1, "I")
UINT64 = ScalarKind("uint64", "uint64", int, 0, 2**64 - 1, "Q")

CHAR = ScalarKind("char", "uint8", int, 0, 2**8 - 1, "B")
BYTE = ScalarKind("byte", "octet", bytes)
BOOL = ScalarKind("bool", "boolean", bool, exact_type=bool)
STRING = ScalarKind("string", "string", str, exact_type=str)
WSTRING = ScalarKind("wstring", "wstring", str, exact_type=str)

SCALARS: Final = {
    kind.text: kind
    for kind in (
        BOOL,
        BYTE,
        CHAR,
        FLOAT32,
        FLOAT64,
        INT8,
        INT16,
        INT32,
        INT64,
        UINT8,
        UINT16,
        UINT32,
        UINT64,
        STRING,
        WSTRING,
    )
}
"""The kinds of single values by their names in definitions."""


def bounded_string(kind: ScalarKind, length: int) -> ScalarKind:
    """A string kind of at most ``length`` characters."""
    return ScalarKind(f"{kind.text}<={length}", f"{kind.idl}<{length}>", str, max_length=length)
