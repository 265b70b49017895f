"""Transforms messages from frame to frame: which function does so for which type.

ROS 2 has this in ``tf2_ros.buffer_interface``. Whoever needs a type imports what knows it: ``kit.ros.geometry_transforms``.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

from kit.msg.builtin_interfaces import Time as TimeMessage
from kit.msg.geometry_msgs import TransformStamped
from kit.ros.node.time import Duration, Time

DoTransform = Callable[[Any, TransformStamped], Any]

_NO_WAIT = Duration()


class TypeException(Exception):
    """No function is known that transforms or converts this type."""


class NotImplementedException(Exception):
    """A buffer does not offer this."""


class TransformRegistration:
    """The functions that transform messages, by their type. There is one table in the program."""

    _by_type: ClassVar[dict[type[Any], DoTransform]] = {}

    def add(self, key: type[Any], callback: DoTransform) -> None:
        self._by_type[key] = callback

    def get(self, key: type[Any]) -> DoTransform:
        """Raises TypeException for a type that is not registered."""
        try:
            return self._by_type[key]
        except KeyError:
            raise TypeException(
                f"Type {key.__name__} is not loaded or supported; for geometry_msgs: import tf2_geometry_msgs"
            ) from None


class ConvertRegistration:
    """The functions that convert objects from and to messages, by type. There is one table in the program."""

    _to_msg: ClassVar[dict[type[Any], Callable[[Any], Any]]] = {}
    _from_msg: ClassVar[dict[type[Any], Callable[[Any], Any]]] = {}
    _convert: ClassVar[dict[tuple[type[Any], type[Any]], Callable[[Any], Any]]] = {}

    def add_from_msg(self, key: type[Any], callback: Callable[[Any], Any]) -> None:
        self._from_msg[key] = callback

    def add_to_msg(self, key: type[Any], callback: Callable[[Any], Any]) -> None:
        self._to_msg[key] = callback

    def add_convert(self, key: tuple[type[Any], type[Any]], callback: Callable[[Any], Any]) -> None:
        self._convert[key] = callback

    def get_from_msg(self, key: type[Any]) -> Callable[[Any], Any]:
        return _find_conversion(self._from_msg, key, key)

    def get_to_msg(self, key: type[Any]) -> Callable[[Any], Any]:
        return _find_conversion(self._to_msg, key, key)

    def get_convert(self, key: tuple[type[Any], type[Any]]) -> Callable[[Any], Any]:
        return _find_conversion(self._convert, key, key[1])


def _find_conversion(
    table: dict[Any, Callable[[Any], Any]], key: Any, kind: type[Any]
) -> Callable[[Any], Any]:
    """Raises TypeException."""
    if key not in table:
        raise TypeException(f"Type {kind.__name__} is not loaded or supported")
    return table[key]


def convert(a: Any, b_type: type[Any]) -> Any:
    """The object as a ``b_type``, through a message if there is no direct way. Raises TypeException."""
    registration = ConvertRegistration()
    try:
        return registration.get_convert((type(a), b_type))(a)
    except TypeException:
        if isinstance(a, b_type):
            return a
        return registration.get_from_msg(b_type)(registration.get_to_msg(type(a))(a))


class BufferInterface:
    """Transforms stamped messages by the transforms that a subclass looks up."""

    def __init__(self) -> None:
        self.registration = TransformRegistration()

    def lookup_transform(
        self, target_frame: str, source_frame: str, time: Time | TimeMessage, timeout: Duration = _NO_WAIT
    ) -> TransformStamped:
        raise NotImplementedException

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Time | TimeMessage,
        source_frame: str,
        source_time: Time | TimeMessage,
        fixed_frame: str,
        timeout: Duration = _NO_WAIT,
    ) -> TransformStamped:
        raise NotImplementedException

    def transform(
        self,
        object_stamped: Any,
        target_frame: str,
        timeout: Duration = _NO_WAIT,
        new_type: type[Any] | None = None,
    ) -> Any:
        """The message in ``target_frame``, at its own time; with ``new_type``, converted to that.

        Raises TypeException for a type that no imported package transforms, and what ``lookup_transform`` raises.
        """
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        found = self.lookup_transform(target_frame, header.frame_id, header.stamp, timeout)
        result = do_transform(object_stamped, found)
        return result if new_type is None else convert(result, new_type)

    def transform_full(
        self,
        object_stamped: Any,
        target_frame: str,
        target_time: Time | TimeMessage,
        fixed_frame: str,
        timeout: Duration = _NO_WAIT,
        new_type: type[Any] | None = None,
    ) -> Any:
        """Transforms as ``transform`` does, to another time; ``fixed_frame`` does not move between the two times."""
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        found = self.lookup_transform_full(
            target_frame, target_time, header.frame_id, header.stamp, fixed_frame, timeout
        )
        result = do_transform(object_stamped, found)
        return result if new_type is None else convert(result, new_type)
