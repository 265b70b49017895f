"""Message and service classes that behave as the ones ROS 2 generates for Python (rosidl).

A class body is the interface definition::

    class Twist(Message):
        linear: Vector3 = zero
        angular: Vector3 = zero

From it the metaclass makes ``__slots__``, one checking property per field, and a keyword-only constructor.
The constructor and the copier are compiled on first use, so importing a package of messages stays cheap.

The checks cannot be turned off (``check_fields`` is accepted and ignored): where ROS 2 lets a wrong value
through them, its C converter aborts the program later.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import (
    Annotated,
    Any,
    ClassVar,
    NoReturn,
    Self,
    TypeVar,
    cast,
    dataclass_transform,
    get_args,
    get_origin,
)

from kit.msg.fields import (
    AddedIn,
    FieldError,
    FieldKind,
    FixedArrayKind,
    MaxItems,
    MessageKind,
    ScalarKind,
    SequenceKind,
    zero,
)

M = TypeVar("M", bound="Message")


@dataclass(frozen=True, slots=True)
class Field:
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


@dataclass(frozen=True, slots=True)
class Constant:
    """A constant of a message class."""

    name: str
    kind: FieldKind
    value: Any


# Reading a class body


def _kind(annotation: Any) -> tuple[FieldKind, str]:
    """The kind of an annotation, and the first distribution with the field (empty: all)."""
    if get_origin(annotation) is Annotated:
        kind: FieldKind | None = None
        since = ""
        for extra in annotation.__metadata__:
            if isinstance(extra, AddedIn):
                since = extra.distro
            elif isinstance(extra, MaxItems):
                kind = replace(
                    cast(SequenceKind, kind or _kind(annotation.__origin__)[0]), bound=extra.length
                )
            else:
                kind = extra
        return kind or _kind(annotation.__origin__)[0], since
    if isinstance(annotation, str):
        raise TypeError(
            f"'{annotation}' is only the name of a field's type; a module of messages needs the type itself"
        )
    if get_origin(annotation) is list:
        return SequenceKind(_kind(get_args(annotation)[0])[0]), ""
    package, _, name = annotation.__ros_type__.split("/")
    return MessageKind(annotation, f"{package}/{name}", annotation), ""


def _ros_type(module: str, qualname: str) -> str:
    """``geometry_msgs/msg/Twist``, ``std_srvs/srv/SetBool_Request``."""
    service, _, part = qualname.rpartition(".")
    package = module.rpartition(".")[2]
    return f"{package}/srv/{service}_{part}" if service else f"{package}/msg/{part}"


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


class MessageType(type):
    """Builds a message class from its annotations.

    ``is_custom`` marks an interface that this project defines, and that no ROS 2 installation has;
    ``ros_type`` names one that is not written in a module of ``kit.msg``.
    """

    __ros_type__: str
    __ros_fields__: tuple[Field, ...] = ()
    __ros_constants__: tuple[Constant, ...]
    __ros_custom__: bool

    def __new__(
        mcs,
        name: str,
        bases: tuple[type, ...],
        namespace: dict[str, Any],
        *,
        is_custom: bool = False,
        ros_type: str = "",
    ) -> MessageType:
        if any(base.__ros_fields__ for base in bases if isinstance(base, MessageType)):
            # A program's own variant of a message: a plain subclass, with the same fields.
            return super().__new__(mcs, name, bases, namespace)
        fields: list[Field] = []
        constants: list[Constant] = []
        for entry, annotation in namespace.get("__annotations__", {}).items() if bases else ():
            if get_origin(annotation) is ClassVar:
                constants.append(Constant(entry, _kind(get_args(annotation)[0])[0], namespace[entry]))
            else:
                kind, since = _kind(annotation)
                fields.append(Field(entry, kind, namespace.pop(entry, zero), since))
        namespace["__slots__"] = tuple(field.slot for field in fields)
        cls = super().__new__(mcs, name, bases, namespace)
        for field in fields:
            setattr(cls, field.name, _accessor(field, cls.__dict__[field.slot].__set__))
        cls.__ros_type__ = ros_type or _ros_type(cls.__module__, cls.__qualname__)
        cls.__ros_fields__ = tuple(fields)
        cls.__ros_constants__ = tuple(constants)
        cls.__ros_custom__ = is_custom
        return cls


@dataclass_transform(kw_only_default=True)
class Message(metaclass=MessageType):
    """Base class of all messages."""

    __hash__ = None  # type: ignore[assignment]  # the idiom for "unhashable", as ROS 2's messages are

    def __init__(self, **fields: Any) -> None:
        _add_generated_methods(type(self)).__init__(self, **fields)

    def __deepcopy__(self, memo: object) -> Self:
        """An independent copy, quickly; ``copy.deepcopy`` calls this."""
        return _add_generated_methods(type(self)).__deepcopy__(self, memo)

    @classmethod
    def get_fields_and_field_types(cls) -> dict[str, str]:
        """Field names and their types as ROS 2's interface language writes them, in order."""
        return {field.name: field.kind.idl for field in cls.__ros_fields__}

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


class ServiceType(type):
    """Gives a service class its ROS name."""

    __ros_type__: str
    __ros_custom__: bool

    def __new__(
        mcs, name: str, bases: tuple[type, ...], namespace: dict[str, Any], *, is_custom: bool = False
    ) -> ServiceType:
        cls = super().__new__(mcs, name, bases, namespace)
        cls.__ros_type__ = f"{cls.__module__.rpartition('.')[2]}/srv/{name}"
        cls.__ros_custom__ = is_custom
        return cls


class Service(metaclass=ServiceType):
    """A service: its ``Request`` and ``Response`` are message classes. It has no instances."""

    Request: type[Any]
    Response: type[Any]

    def __init__(self) -> None:
        name = type(self).__name__
        raise NotImplementedError(f"Service classes can not be instantiated: create {name}.Request()")


def type_name(cls: type[Message] | type[Service]) -> str:
    """The interface's ROS name: ``geometry_msgs/msg/Twist``, ``std_srvs/srv/SetBool``."""
    return cls.__ros_type__


def is_custom_interface(cls: type[Message] | type[Service]) -> bool:
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
        "_refuse": _refuse_unknown,
        "_array": array,
        "_float": float,
        "_int": int,
    }
    parameters, body, copying = [], [], []
    for field in cls.__ros_fields__:
        name, slot, kind = field.name, field.slot, field.kind
        names[f"_default_{name}"] = (
            kind.zero() if isinstance(kind, ScalarKind) and field.default is zero else field.default
        )
        names |= {
            f"_check_{name}": kind.check,
            f"_exact_{name}": kind.exact_type,
            f"_start_{name}": kind.zero,
        }
        names[f"_copy_{name}"] = kind.copy
        parameters.append(f"{name}=_default_{name}, ")
        body.append(f"    _self.{slot} = {_constructor_expression(field)}")
        copying.append(f"    _new.{slot} = {_copy_expression(field)}")
    source = [
        f"def __init__(_self, *, {''.join(parameters)}check_fields=None, **_unknown):",
        "    if _unknown: _refuse(_cls, _unknown)",
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
    elif isinstance(kind, SequenceKind):
        start = f"_array('{kind.type_code}')" if kind.type_code else "[]"
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


def _refuse_unknown(cls: type[Message], unknown: Iterable[str]) -> NoReturn:
    from kit.plain_text import nearest_name

    known = [field.name for field in cls.__ros_fields__]
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
