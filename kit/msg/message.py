"""Message and service classes that behave as the ones ROS 2 generates for Python (rosidl).

``class_builder`` makes them from the texts of definitions: ``__slots__``, one checking property per field, and a
keyword-only constructor. The constructor and the copier are compiled on first use, so a new class stays cheap.

The checks cannot be turned off (``check_fields`` is accepted and ignored): where ROS 2 lets a wrong value
through them, its C converter aborts the program later.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from operator import attrgetter
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn, Self, TypeVar, cast, dataclass_transform

from kit.msg import snake_case
from kit.msg.fields import (
    FieldError,
    FieldKind,
    FixedArrayKind,
    MessageKind,
    ScalarKind,
    SequenceKind,
    zero,
)

M = TypeVar("M", bound="Message")


if TYPE_CHECKING:
    from kit.msg.slot_types import AbstractType


class Field(NamedTuple):
    """One field of a message class."""

    name: str
    kind: FieldKind
    default: Any = zero
    since: str = ""
    """The first ROS 2 distribution that has it; empty if all do."""

    @property
    def slot(self) -> str:
        return f"_{self.name}"

    @property
    def has_zero_default(self) -> bool:
        """True if the definition has no default for it."""
        return self.default is zero


class Constant(NamedTuple):
    """A constant of a message class."""

    name: str
    kind: FieldKind
    value: Any


def _accessor(field: Field, put: Callable[[Any, Any], None]) -> property:
    kind, name, slot, exact, check = (
        field.kind,
        field.name,
        field.slot,
        field.kind.exact_type,
        field.kind.check,
    )

    def write(message: Message, value: Any) -> None:
        put(message, value if type(value) is exact else check(value, name))

    if not isinstance(kind, FixedArrayKind):
        return property(attrgetter(slot), write)
    as_ndarray = kind.as_ndarray

    def read(message: Message) -> Any:
        value = getattr(message, slot)
        if type(value) is array:
            value = as_ndarray(value)
            put(message, value)
        return value

    return property(read, write)


class _FieldTypes:
    """``_fields_and_field_types`` of a message class or a message, as rosidl has it."""

    def __get__(self, message: object, cls: type[Message]) -> dict[str, str]:
        return cls.get_fields_and_field_types()


class _SlotTypes:
    """``SLOT_TYPES`` of a message class or a message, as rosidl has it."""

    def __get__(self, message: object, cls: type[Message]) -> tuple[AbstractType, ...]:
        from kit.msg.slot_types import slot_type  # few programs look into messages so

        return tuple(slot_type(field.kind.idl) for field in cls.__ros_fields__)


class MessageType(type):
    """The type of message classes: gives each its slots and checking properties from its fields.

    A class without fields of its own, as a program's own variant of a message, is a plain subclass.
    """

    __ros_type__: str
    __ros_fields__: tuple[Field, ...] = ()
    __ros_constants__: tuple[Constant, ...]
    __ros_custom__: bool

    def __new__(mcs, name: str, bases: tuple[type, ...], namespace: dict[str, Any]) -> MessageType:
        if "__ros_fields__" not in namespace:
            if not bases:
                namespace["__slots__"] = ()
            return super().__new__(mcs, name, bases, namespace)
        fields: tuple[Field, ...] = namespace["__ros_fields__"]
        namespace["__slots__"] = tuple([field.slot for field in fields])
        cls = super().__new__(mcs, name, bases, namespace)
        for field in fields:
            setattr(cls, field.name, _accessor(field, cls.__dict__[field.slot].__set__))
        return cls


@dataclass_transform(kw_only_default=True)
class Message(metaclass=MessageType):
    """Base class of all messages."""

    __hash__ = None  # type: ignore[assignment]  # the idiom for "unhashable", as ROS 2's messages are

    def __init__(self, *values: Any, **fields: Any) -> None:
        _add_generated_methods(type(self)).__init__(self, *values, **fields)

    def __deepcopy__(self, memo: object) -> Self:
        """An independent copy, quickly; ``copy.deepcopy`` calls this."""
        return _add_generated_methods(type(self)).__deepcopy__(self, memo)

    @classmethod
    def get_fields_and_field_types(cls) -> dict[str, str]:
        """Field names and their types as ROS 2's interface language writes them, in order."""
        return {field.name: field.kind.idl for field in cls.__ros_fields__}

    _fields_and_field_types = _FieldTypes()
    SLOT_TYPES = _SlotTypes()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Message) or type(self) is not type(other):
            return False
        slots = (field.slot for field in type(self).__ros_fields__)
        return all(_equal(getattr(self, slot), getattr(other, slot)) for slot in slots)

    def __repr__(self) -> str:
        shown = (
            f"{field.name}={_format_value(getattr(self, field.name))}" for field in type(self).__ros_fields__
        )
        return f"{type(self).__ros_type__.replace('/', '.')}({', '.join(shown)})"


def make_message_class(
    ros_type: str,
    fields: Iterable[Field],
    constants: Iterable[Constant] = (),
    *,
    interface: str = "",
    is_custom: bool = False,
) -> type[Message]:
    """A new message class with these fields, of the module and the name that rosidl gives it: ``std_srvs.srv._set_bool``,
    ``SetBool_Request``. ``interface``: the interface that it is a part of, if it is one."""
    constants = tuple(constants)
    own_name = ros_type.rpartition("/")[2]
    namespace: dict[str, Any] = {constant.name: constant.value for constant in constants}
    namespace |= {
        "__module__": generated_module(ros_type, interface or own_name),
        "__qualname__": own_name,
        "__ros_type__": ros_type,
        "__ros_fields__": tuple(fields),
        "__ros_constants__": constants,
        "__ros_custom__": is_custom,
    }
    return cast(type[Message], MessageType(own_name, (Message,), namespace))


def generated_module(ros_type: str, interface: str) -> str:
    """The module that rosidl makes for an interface: ``geometry_msgs.msg._twist``."""
    return f"{'.'.join(ros_type.split('/')[:2])}._{snake_case(interface)}"


class ServiceType(type):
    """The type of service classes, so that ``type(Trigger)`` tells them from messages."""

    __ros_type__: str
    __ros_custom__: bool


class Service(metaclass=ServiceType):
    """A service: its ``Request`` and ``Response`` are message classes. It has no instances."""

    Request: type[Any]
    Response: type[Any]

    def __init__(self) -> None:
        name = type(self).__name__
        raise NotImplementedError(f"Service classes can not be instantiated: create {name}.Request()")


class Action:
    """An action: its ``Goal``, ``Result`` and ``Feedback`` are message classes. It has no instances.

    ``Impl`` has the services and messages that clients and servers exchange, named as in ROS 2.
    """

    __ros_type__: str
    __ros_custom__: bool
    Goal: type[Any]
    Result: type[Any]
    Feedback: type[Any]
    Impl: type[Any]

    def __init__(self) -> None:
        name = type(self).__name__
        raise NotImplementedError(f"Action classes can not be instantiated: create {name}.Goal()")


def type_name(cls: type[Message] | type[Service] | type[Action]) -> str:
    """The interface's ROS name: ``geometry_msgs/msg/Twist``, ``std_srvs/srv/SetBool``."""
    return cls.__ros_type__


def is_request_or_response(cls: type[Message]) -> bool:
    """True for the messages of services, among them those that carry actions; no topic has them."""
    name = cls.__ros_type__
    return name.endswith(("_Request", "_Response")) and "/msg/" not in name


def short_type_name(cls: type[Message]) -> str:
    """The message's name as definitions write it: ``geometry_msgs/Twist``."""
    package, _, name = cls.__ros_type__.split("/")
    return f"{package}/{name}"


def is_custom_interface(cls: type[Message] | type[Service] | type[Action]) -> bool:
    """True if this project defines the interface, and no ROS 2 installation has it."""
    return cls.__ros_custom__


def check_message(message: Message) -> None:
    """Checks every field again, at any depth. Raises FieldError with the path of the wrong field.

    Assignment is checked, but not what a program appends to a list that a message holds.
    """
    for field in type(message).__ros_fields__:
        _check_inside(getattr(message, field.slot), field.kind, field.name)


def _check_inside(value: Any, kind: FieldKind, path: str) -> None:
    if isinstance(kind, FixedArrayKind):  # its size and type cannot change in place
        return
    kind.check(value, path)
    if isinstance(value, Message):
        for field in type(value).__ros_fields__:
            _check_inside(getattr(value, field.slot), field.kind, f"{path}.{field.name}")
    elif isinstance(kind, SequenceKind) and not kind.type_code:
        for i, entry in enumerate(value):
            _check_inside(entry, kind.item, f"{path}[{i}]")


# The constructor and the copier, as plain straight-line code: three times as fast as a loop over fields.
# No name of a ROS field begins with an underscore, so the code's own names cannot clash with one.


def _add_generated_methods(cls: type[M]) -> type[M]:
    """Adds a generated constructor and copy method to the class, and returns the class."""
    cls = next(owner for owner in cls.__mro__ if "__ros_fields__" in vars(owner))
    names: dict[str, Any] = {
        "_type": type,
        "_zero": zero,
        "_make": object.__new__,
        "_cls": cls,
        "_refuse": _refuse_arguments,
        "_array": array,
        "_float": float,
        "_int": int,
    }
    parameters, body, copying = [], [], []
    for field in cls.__ros_fields__:
        name, slot, kind = field.name, field.slot, field.kind
        scalar_default = kind.zero() if field.default is zero else field.default
        names[f"_default_{name}"] = scalar_default if isinstance(kind, ScalarKind) else zero
        names |= {
            f"_check_{name}": kind.check,
            f"_exact_{name}": kind.exact_type,
            f"_start_{name}": kind.zero if field.default is zero else partial(kind.copy, field.default),
        }
        names[f"_copy_{name}"] = kind.copy
        parameters.append(f"{name}=_default_{name}, ")
        body.append(f"    _self.{slot} = {_constructor_expression(field)}")
        copying.append(f"    _new.{slot} = {_copy_expression(field)}")
    source = [
        f"def __init__(_self, *_values, {''.join(parameters)}check_fields=None, **_unknown):",
        "    if _unknown or _values: _refuse(_cls, _values, _unknown)",
        *body,
        "def __deepcopy__(_self, _memo):",
        "    _new = _make(_type(_self))",
        *copying,
        "    return _new",
    ]
    exec(compile("\n".join(source), f"<{cls.__ros_type__}>", "exec"), names)
    for method in ("__init__", "__deepcopy__"):
        names[method].__qualname__ = f"{cls.__qualname__}.{method}"
        setattr(cls, method, names[method])
    return cls


def _constructor_expression(field: Field) -> str:
    """The expression that turns the constructor's argument into the stored value."""
    name, kind = field.name, field.kind
    checked = f"_check_{name}({name}, '{name}')"
    if isinstance(kind, ScalarKind):
        fits = f"_type({name}) is _exact_{name}"
        if kind.low != kind.high:
            fits = (
                f"_type({name}) is _{kind.python_type.__name__} and {kind.low!r} <= {name} <= {kind.high!r}"
            )
        return f"{name} if {fits} else {checked}"
    start = f"_start_{name}()"
    if isinstance(kind, MessageKind):
        start = f"_exact_{name}()"
        checked = f"{name} if _type({name}) is _exact_{name} else {checked}"
    elif isinstance(kind, SequenceKind) and kind.length is None and field.default is zero:
        start = f"_array('{kind.type_code}')" if kind.type_code else "[]"
        if kind.type_code and kind.bound is None:
            fits = f"_type({name}) is _array and {name}.typecode == '{kind.type_code}'"
            checked = f"{name} if {fits} else {checked}"
    return f"{start} if {name} is _zero else {checked}"


def _copy_expression(field: Field) -> str:
    """The expression that copies a stored value."""
    kind, value = field.kind, f"_self.{field.slot}"
    if isinstance(kind, ScalarKind):
        return value
    if isinstance(kind, MessageKind):
        return f"{value}.__deepcopy__(None)"
    if isinstance(kind, SequenceKind) and isinstance(kind.item, ScalarKind):
        return f"{value}[:]"
    return f"_copy_{field.name}({value})"


def _refuse_arguments(cls: type[Message], values: Sequence[Any], unknown: Iterable[str]) -> NoReturn:
    from kit.plain_text import nearest_name

    known = [field.name for field in cls.__ros_fields__]
    if values:
        by_name = ", ".join(f"{name}=..." for name in known[: len(values)])
        raise TypeError(
            f"{cls.__name__} takes its fields by name only: write {cls.__name__}({by_name}). "
            f"Its fields are {', '.join(known) or 'none'}"
        )
    parts = []
    for name in unknown:
        near = nearest_name(name, known)
        parts.append(f"'{name}'" + (f" (did you mean '{near}'?)" if near else ""))
    raise FieldError(
        f"Invalid arguments passed to constructor: {cls.__ros_type__} has no field {', '.join(parts)}; "
        f"its fields are {', '.join(known) or 'none'}"
    )


# Comparing and showing


def _equal(a: Any, b: Any) -> bool:
    if type(a) is type(b) and not hasattr(a, "dtype"):
        return bool(a == b)
    # FixedArrayKind arrays are numpy or not yet: compare what they hold.
    if type(a) in (int, float) or type(b) in (int, float):
        return bool(a == b)
    return bool(list(a) == list(b))


def _format_value(value: Any) -> str:
    """Formats a value as rosidl does: arrays of numbers like lists, all else by ``repr``."""
    return repr(value.tolist()) if type(value) is array else repr(value)
