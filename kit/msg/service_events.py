"""The messages of services' events, which service introspection publishes; they are made from the services."""

from __future__ import annotations

from functools import cache
from typing import Any

from kit.msg.definition_writer import mark_part
from kit.msg.fields import MessageKind, SequenceKind
from kit.msg.interfaces import find_interface, find_message, find_service
from kit.msg.message import Field, Message, Service, make_message_class, short_type_name

EVENT_SUFFIX = "_Event"


@cache
def service_event_class(srv_type: type[Service]) -> type[Message]:
    """The message of a service's events, ``example_interfaces/srv/AddTwoInts_Event``, as rosidl generates it."""
    info = find_message("service_msgs/msg/ServiceEventInfo")

    def at_most_one(name: str, cls: type[Message]) -> Field:
        return Field(name, SequenceKind(message_kind(cls), bound=1))

    event = make_message_class(
        f"{srv_type.__ros_type__}{EVENT_SUFFIX}",
        [
            Field("info", message_kind(info)),
            at_most_one("request", srv_type.Request),
            at_most_one("response", srv_type.Response),
        ],
        module=srv_type.__module__,
        qualname=f"{srv_type.__name__}{EVENT_SUFFIX}",
        is_custom=True,
    )
    mark_part(event, srv_type)
    return event


def find_interface_or_event(name: str) -> Any:
    """The interface of this name, also a service's event message. Raises UnknownInterface."""
    if name.endswith(EVENT_SUFFIX) and "/msg/" not in name:
        return service_event_class(find_service(name.removesuffix(EVENT_SUFFIX)))
    return find_interface(name)


def message_kind(cls: type[Message]) -> MessageKind:
    """The kind of a field that holds a message of type ``cls``."""
    return MessageKind(cls, short_type_name(cls), cls)
