"""The interfaces of a workspace that another process has described, and the classes that it means by their names.

A running world, and a terminal beside it, need not know the packages in which another terminal's program has its
messages. The kit's own interfaces are the same everywhere and are never described.
"""

from __future__ import annotations

from typing import Any, cast

from kit.msg.class_builder import build_interface
from kit.msg.definition_parser import SECTIONS, DefinitionError
from kit.msg.definition_writer import Definitions, is_shipped, same_interface
from kit.msg.interfaces import (
    ACTION_PARTS,
    EVENT_SUFFIX,
    MAX_DEPTH,
    Interface,
    UnknownInterface,
    find_interface,
    find_interface_or_event,
    register_received,
    service_event_class,
)
from kit.msg.message import Action, Message, Service


class ReceivedInterfaces:
    """The definitions that one other process has sent."""

    def __init__(self) -> None:
        self._texts: Definitions = {}
        self._classes: dict[str, Any] = {}
        """What was built of them, by name."""

    def add(self, name: str, text: str) -> None:
        """Adds the definition of ``package/part/Name``, or replaces it. Raises DefinitionError for a wrong name."""
        parts = name.split("/")
        if len(parts) != 3 or parts[1] not in SECTIONS or not all(part.isidentifier() for part in parts):
            raise DefinitionError(name, 1, 1, "this is not the name of an interface")
        if is_shipped(name):
            raise DefinitionError(name, 1, 1, "an interface of the kit cannot be replaced")
        if self._texts.get(name) != text:
            self._texts[name] = text
            self._classes.clear()

    def find(self, name: str) -> Any:
        """The class of an interface, of an action's part or of a service's event.

        Raises UnknownInterface, and DefinitionError if its text cannot be read.
        """
        if name not in self._classes:
            self._classes[name] = self._find(name)
        return self._classes[name]

    def _find(self, name: str) -> Any:
        package, _, own_name = name.rpartition("/")
        base = f"{package}/{own_name.partition('_')[0]}"  # the names of interfaces have no underscores
        if base not in self._texts:
            return find_interface_or_event(name)
        cls = self._build(base, 0)
        if name == base:
            return cls
        if name == f"{base}{EVENT_SUFFIX}" and issubclass(cls, Service):
            return service_event_class(cls)
        part = ACTION_PARTS.get(name.removeprefix(base))
        if part is None or not issubclass(cls, Action):
            raise UnknownInterface(f"there is no interface '{name}'")
        return getattr(cls.Impl, part)

    def _build(self, name: str, depth: int) -> Interface:
        if name in self._classes:
            return cast(Interface, self._classes[name])
        if depth == MAX_DEPTH:
            raise DefinitionError(name, 1, 1, f"messages are nested more than {MAX_DEPTH} deep")

        def find_part(part: str) -> type[Message]:
            # A name with /msg/ is a message's.
            found = self._build(part, depth + 1) if part in self._texts else find_interface(part)
            return cast(type[Message], found)

        package, part, _ = name.split("/")
        built = build_interface(
            name, self._texts[name], name, find_part, module=f"{package}.{part}", is_custom=True
        )
        self._classes[name] = cls = same_interface(built)
        register_received(cls)
        return cls
