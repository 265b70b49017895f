"""Checks that a class is a message, service or action, and the type variables of rclpy's annotations."""

from __future__ import annotations

from typing import Any, TypeAlias, TypeVar

from kit.msg.message import Action, Message, Service
from kit.ros.exceptions import NoTypeSupportImportedException

Msg: TypeAlias = Message
Srv: TypeAlias = Service
MsgT = TypeVar("MsgT", bound=Message)
SrvT = TypeVar("SrvT", bound=Service)
SrvRequestT = TypeVar("SrvRequestT")
SrvResponseT = TypeVar("SrvResponseT")
SrvEventT = TypeVar("SrvEventT")
T = TypeVar("T")
AllowableParameterValue: TypeAlias = (
    bool | int | float | str | list[bytes] | list[bool] | list[int] | list[float] | list[str] | None
)
AllowableParameterValueT = TypeVar("AllowableParameterValueT")


def check_for_type_support(msg_or_srv_type: type) -> None:
    """Raises NoTypeSupportImportedException for what is no message, service or action."""
    _check(msg_or_srv_type, (Message, Service, Action), "message, service or action")


def check_is_valid_msg_type(msg_type: type) -> None:
    """Raises NoTypeSupportImportedException for what is no message."""
    _check(msg_type, (Message,), "message")


def check_is_valid_srv_type(srv_type: type) -> None:
    """Raises NoTypeSupportImportedException for what is no service."""
    _check(srv_type, (Service,), "service")


def _check(given: Any, wanted: tuple[type, ...], word: str) -> None:
    if not (isinstance(given, type) and issubclass(given, wanted)):
        raise NoTypeSupportImportedException(f"{given!r} is not the class of a {word}")
