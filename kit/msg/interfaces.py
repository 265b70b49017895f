"""Finds message, service and action classes, and those of services' events, by their ROS names.

Each is built from its text at first use. The texts of ROS's own packages lie in
``definitions/PACKAGE/{msg,srv,action}``; ``register_packages`` adds those of a workspace, which are read from the
packages' source folders, and ``ReceivedInterfaces`` those that another process has described.
"""

from __future__ import annotations

import copyreg
import os
import sys
import threading
from collections.abc import Mapping
from functools import cache
from typing import Any, Final, cast

from kit.msg.class_builder import Interface, build_interface
from kit.msg.definition_parser import SECTIONS, DefinitionError
from kit.msg.definition_writer import (
    DEFINITIONS,
    DISTROS,
    PACKAGES,
    Definitions,
    definition,
    fields_of,
    is_shipped,
    mark_part,
    same_interface,
)
from kit.msg.fields import MessageKind, SequenceKind
from kit.msg.message import Action, Field, Message, MessageType, Service, make_message_class, short_type_name
from kit.msg.renamed_packages import RENAMED_PACKAGES

_MAX_DEPTH: Final = 50
"""How deep messages may be nested in each other."""

_CUSTOM_PACKAGES: Final = frozenset({"flatland_msgs", "robot_kit_msgs", "turtlebot3_msgs"})
# Gone from ROS 2 since Lyrical, but Flatland's services use it.
_CUSTOM_TYPES: Final = frozenset({"geometry_msgs/msg/Pose2D"})
_ACTION_PARTS: Final = {
    "_SendGoal": "SendGoalService",
    "_GetResult": "GetResultService",
    "_FeedbackMessage": "FeedbackMessage",
}
"""The endings of the names of an action's services and message, and the attributes of ``Impl`` that hold them."""
EVENT_SUFFIX: Final = "_Event"
"""The ending of the name of the message of a service's events."""

__all__ = [
    "DISTROS",
    "EVENT_SUFFIX",
    "PACKAGES",
    "DefinitionError",
    "Interface",
    "ReceivedInterfaces",
    "UnknownInterface",
    "definition",
    "definition_source",
    "fields_of",
    "find_action",
    "find_interface",
    "find_interface_or_event",
    "find_message",
    "find_service",
    "interface_names",
    "interfaces",
    "known_packages",
    "message_kind",
    "package_attribute",
    "register_packages",
    "service_event_class",
]


class UnknownInterface(LookupError):
    """No message, service or action has this name."""


class _InterfaceRegistry:
    """The packages with interfaces that this process knows, and the classes built so far."""

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self._folders: dict[str, str] = {}
        self._signatures: dict[str, tuple[object, ...]] = {}
        self._classes: dict[str, Interface] = {}
        self._unfinished: list[str] = []
        self.received: dict[str, Interface] = {}
        """Interfaces of packages that are not known here, as another process has last described them."""

    @property
    def packages(self) -> tuple[str, ...]:
        return tuple(sorted({*PACKAGES, *self._folders}))

    def register(self, folders: Mapping[str, str]) -> None:
        """Adds packages; classes of a package that has changed since are built again."""
        with self._lock:
            for package, folder in folders.items():
                if package in PACKAGES:
                    continue
                signature = (folder, *_file_signatures(folder))
                if self._signatures.get(package, signature) != signature:
                    self._classes = {
                        name: cls for name, cls in self._classes.items() if name.split("/")[0] in PACKAGES
                    }
                self._folders[package], self._signatures[package] = folder, signature

    def names(self, package: str) -> list[str]:
        """The ROS names of a package's interfaces, sorted."""
        folder = self._folder(package)
        return [
            f"{package}/{part}/{file.removesuffix(f'.{part}')}"
            for part in sorted(SECTIONS)
            for file in _list_files(os.path.join(folder, part))
            if file.endswith(f".{part}")
        ]

    def source(self, name: str) -> tuple[str, str]:
        """The file of an interface, and its text. Raises FileNotFoundError."""
        package, part, own_name = name.split("/")
        file = os.path.join(self._folder(package), part, f"{own_name}.{part}")
        if not os.path.isfile(file):  # a named pipe would have us wait for ever
            raise FileNotFoundError(file)
        with open(file, encoding="utf-8") as stream:
            return file, stream.read()

    def find(self, name: str) -> Interface | None:
        """The class called ``package/part/Name``; None if there is none. Raises DefinitionError."""
        found = self._classes.get(name)
        return found if found is not None else self._build(name)

    def _folder(self, package: str) -> str:
        if package in PACKAGES:
            return os.path.join(DEFINITIONS, package)
        return self._folders[package]

    def _build(self, name: str) -> Interface | None:
        package, part, own_name = name.split("/")
        if part not in SECTIONS or not own_name.isidentifier():
            return None
        if part == "action" and "_" in own_name:
            return self._part_of_action(name)
        if package not in PACKAGES and package not in self._folders:
            return self.received.get(name)
        with self._lock:
            if name in self._classes:
                return self._classes[name]
            try:
                file, text = self.source(name)
            except (FileNotFoundError, NotADirectoryError):
                return None
            except UnicodeDecodeError:
                raise DefinitionError(self._path(name), 1, 1, "the file is not UTF-8 text") from None
            if name in self._unfinished:
                raise DefinitionError(file, 1, 1, f"{name} contains itself")
            if len(self._unfinished) == _MAX_DEPTH:
                raise DefinitionError(file, 1, 1, f"messages are nested more than {_MAX_DEPTH} deep")
            self._unfinished.append(name)
            try:
                built = build_interface(
                    name,
                    text,
                    file,
                    self._find_part,
                    is_custom=package in _CUSTOM_PACKAGES or name in _CUSTOM_TYPES or package not in PACKAGES,
                )
                self._classes[name] = same_interface(built)
            finally:
                self._unfinished.pop()
            return self._classes[name]

    def _path(self, name: str) -> str:
        package, part, own_name = name.split("/")
        return os.path.join(self._folder(package), part, f"{own_name}.{part}")

    def _find_part(self, name: str) -> type[Message]:
        found = self.find(name)
        if found is None:
            raise UnknownInterface(_unknown(name))
        return cast(type[Message], found)

    def _part_of_action(self, name: str) -> Interface | None:
        """The service or message of an action, as ``my_msgs/action/Dock_SendGoal``."""
        for suffix, attribute in _ACTION_PARTS.items():
            if name.endswith(suffix):
                action = self.find(name.removesuffix(suffix))
                return getattr(cast(type[Action], action).Impl, attribute) if action else None
        return None


_registry: Final = _InterfaceRegistry()


def register_packages(folders: Mapping[str, str]) -> None:
    """Adds packages by the folder that holds their ``msg``, ``srv`` and ``action`` folders.

    A package that the kit ships keeps its shipped definitions.
    """
    _registry.register(folders)


def known_packages() -> tuple[str, ...]:
    """The names of all packages with interfaces: shipped and registered ones, sorted."""
    return _registry.packages


def interfaces(package: str) -> tuple[Interface, ...]:
    """The classes of one of the known packages, sorted by name."""
    return tuple(find_interface(name) for name in sorted(_registry.names(package)))


def interface_names(package: str | None = None) -> tuple[str, ...]:
    """The ROS names of all interfaces, or of one package's, sorted. Builds no class."""
    packages = known_packages() if package is None else (package,)
    return tuple(sorted(name for each in packages for name in _registry.names(each)))


def find_interface(name: str) -> Interface:
    """The class called ``geometry_msgs/msg/Twist``, also ``geometry_msgs/Twist``; services and actions likewise.

    Raises UnknownInterface, naming the nearest one, and DefinitionError if its text cannot be read.
    """
    parts = name.split("/")
    parts[0] = RENAMED_PACKAGES.get(parts[0], parts[0])
    if len(parts) == 3:
        found = _registry.find("/".join(parts))
        if found is not None:
            return found
    elif len(parts) == 2:
        for part in SECTIONS:
            found = _registry.find(f"{parts[0]}/{part}/{parts[1]}")
            if found is not None:
                return found
    raise UnknownInterface(_unknown(name))


def _unknown(name: str) -> str:
    from kit.plain_text import nearest_name  # only a mistake needs it

    near = nearest_name(name, interface_names())
    hint = f"; did you mean '{near}'?" if near else ""
    return f"there is no message or service '{name}'{hint}"


def find_message(name: str) -> type[Message]:
    """The message class of this name. Raises UnknownInterface, also if it is a service."""
    cls = find_interface(name)
    if not issubclass(cls, Message):
        raise UnknownInterface(f"'{name}' is {_kind_of(cls)}, not a message")
    return cls


def find_service(name: str) -> type[Service]:
    """The service class of this name. Raises UnknownInterface, also if it is a message."""
    cls = find_interface(name)
    if not issubclass(cls, Service):
        raise UnknownInterface(f"'{name}' is {_kind_of(cls)}, not a service")
    return cls


def find_action(name: str) -> type[Action]:
    """The action class of this name. Raises UnknownInterface, also if it is a message or a service."""
    cls = find_interface(name)
    if not issubclass(cls, Action):
        raise UnknownInterface(f"'{name}' is {_kind_of(cls)}, not an action")
    return cls


def _kind_of(cls: Interface) -> str:
    if issubclass(cls, Message):
        return "a message"
    return "a service" if issubclass(cls, Service) else "an action"


def package_attribute(module: str, package: str, parts: tuple[str, ...], name: str) -> Any:
    """What ``module.name`` is in a module of a package's interfaces: for the module's ``__getattr__``.

    The class becomes an attribute of the module, so that it is asked for once. Raises AttributeError.
    """
    if name == "__all__":
        return sorted(full.split("/")[2] for full in _registry.names(package) if full.split("/")[1] in parts)
    if not name.startswith("_"):
        is_generated = module.rpartition(".")[2].startswith("_")
        whole, *inner = name.split("_") if is_generated else [name]
        for part in parts:
            found = _inner_class(_registry.find(f"{package}/{part}/{whole}"), inner)
            if found is not None:
                setattr(sys.modules[module], name, found)
                return found
    raise AttributeError(f"module '{module}' has no attribute '{name}'", name=name, obj=sys.modules[module])


def _inner_class(interface: Any, words: list[str]) -> Any:
    """What a module that rosidl makes has besides its interface, by the words of its name: ``Spawn_Request`` in
    ``turtlesim.srv._spawn``. None if there is none of this name."""
    for word in words:
        if word == EVENT_SUFFIX[1:] and isinstance(interface, type) and issubclass(interface, Service):
            return service_event_class(interface)
        part = _ACTION_PARTS.get(f"_{word}")
        whole = interface if part is None else getattr(interface, "Impl", None)
        interface = getattr(whole, part or word, None)
    return interface


def _find_part(ros_type: str) -> Any:
    package, part, name = ros_type.split("/")
    whole, *inner = name.split("_")
    return _inner_class(find_interface(f"{package}/{part}/{whole}"), inner)


def _reduce_class(cls: MessageType) -> str | tuple[Any, ...]:
    """How a message class is pickled: by its type's name, as its module is there only where programs are run."""
    return (_find_part, (cls.__ros_type__,)) if "__ros_fields__" in vars(cls) else cls.__qualname__


copyreg.pickle(MessageType, _reduce_class)


def definition_source(name: str) -> str:
    """The text of an interface's definition file, with its comments. Raises UnknownInterface."""
    return _registry.source(find_interface(name).__ros_type__)[1]


def definition_file(name: str) -> str:
    """The path of an interface's definition file. Raises UnknownInterface."""
    return _registry.source(find_interface(name).__ros_type__)[0]


def _list_files(folder: str) -> list[str]:
    try:
        return sorted(os.listdir(folder))
    except (FileNotFoundError, NotADirectoryError):
        return []


def _file_signatures(folder: str) -> list[object]:
    """Name, time and size of every definition file in a package's folder."""
    found: list[object] = []
    for part in SECTIONS:
        for file in _list_files(os.path.join(folder, part)):
            try:
                status = os.stat(os.path.join(folder, part, file))
            except FileNotFoundError:
                continue
            found.append((part, file, status.st_mtime_ns, status.st_size))
    return found


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
        interface=srv_type.__name__,
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


class ReceivedInterfaces:
    """The definitions that one other process has sent, and the classes that it means by their names.

    A running world, and a terminal beside it, need not know the packages in which another terminal's program has its
    messages. The kit's own interfaces are the same everywhere and are never described.
    """

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
        part = _ACTION_PARTS.get(name.removeprefix(base))
        if part is None or not issubclass(cls, Action):
            raise UnknownInterface(f"there is no interface '{name}'")
        return getattr(cls.Impl, part)

    def _build(self, name: str, depth: int) -> Interface:
        if name in self._classes:
            return cast(Interface, self._classes[name])
        if depth == _MAX_DEPTH:
            raise DefinitionError(name, 1, 1, f"messages are nested more than {_MAX_DEPTH} deep")

        def find_part(part: str) -> type[Message]:
            # A name with /msg/ is a message's.
            found = self._build(part, depth + 1) if part in self._texts else find_interface(part)
            return cast(type[Message], found)

        built = build_interface(name, self._texts[name], name, find_part, is_custom=True)
        self._classes[name] = cls = same_interface(built)
        _registry.received[name] = cls
        return cls
