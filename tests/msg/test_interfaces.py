"""Every shipped message equals what rosbags knows of ROS 2's distributions, fields, constants and hashes."""

from __future__ import annotations

from pathlib import Path
from types import MappingProxyType
from typing import Any

import pytest
from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

import kit.msg
from kit.msg.interfaces import (
    PACKAGES,
    UnknownInterface,
    definition,
    fields_of,
    find_interface,
    find_message,
    find_service,
    interface_names,
    interfaces,
)
from kit.msg.message import Message, Service, is_custom_interface, type_name
from kit.msg.sensor_msgs import LaserScan, Range
from kit.msg.std_srvs import SetBool

STORES = MappingProxyType({"humble": Stores.ROS2_HUMBLE, "jazzy": Stores.ROS2_JAZZY})
MESSAGES = [cls for package in PACKAGES for cls in interfaces(package) if issubclass(cls, Message)]
SHARED = [cls for cls in MESSAGES if not is_custom_interface(cls) and "/msg/" in type_name(cls)]


def named(cls: type[Any]) -> str:
    return type_name(cls)


@pytest.fixture(scope="module", params=sorted(STORES))
def distro(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def store(distro: str) -> Typestore:
    return get_typestore(STORES[distro])


def spelled(kind: Any) -> str:
    """A store's field type as a .msg file writes it."""
    node, content = kind
    if node == Nodetype.BASE:
        return str(content[0])
    if node == Nodetype.NAME:
        return str(content).replace("/msg/", "/")
    item, count = content
    size = "" if not count else str(count) if node == Nodetype.ARRAY else f"<={count}"
    return f"{spelled(item)}[{size}]"


@pytest.mark.parametrize("cls", SHARED, ids=named)
def test_fields_are_those_of_the_distribution(cls: type[Message], distro: str, store: Typestore) -> None:
    _, fields = store.fielddefs[type_name(cls)]
    theirs = [(name, spelled(kind)) for name, kind in fields if name != "structure_needs_at_least_one_member"]
    assert [(field.name, field.kind.text) for field in fields_of(cls, distro)] == theirs


@pytest.mark.parametrize("cls", SHARED, ids=named)
def test_constants_are_those_of_the_distribution(cls: type[Message], distro: str, store: Typestore) -> None:
    constants, _ = store.fielddefs[type_name(cls)]
    for name, _, value in constants:
        ours = getattr(cls, name)
        assert (ours[0] if isinstance(ours, bytes) else ours) == value


def test_hashes_are_those_of_the_distribution(distro: str, store: Typestore) -> None:
    ours = get_typestore(Stores.EMPTY)
    for cls in MESSAGES:
        if "/msg/" in type_name(cls):
            ours.register(get_types_from_msg(definition(cls, distro), type_name(cls)))
    theirs = {type_name(cls): store.hash_rihs01(type_name(cls)) for cls in SHARED}
    assert {name: ours.hash_rihs01(name) for name in theirs} == theirs
    assert ours.hash_rihs01("flatland_msgs/msg/Collisions").startswith("RIHS01_")
    # Ours by mark, since newer distributions dropped it, but the same as theirs where they have it.
    assert ours.hash_rihs01("geometry_msgs/msg/Pose2D") == store.hash_rihs01("geometry_msgs/msg/Pose2D")


def test_the_packages_that_packages_for_flatland_need_are_whole() -> None:
    humble = get_typestore(Stores.ROS2_HUMBLE)
    for package in ("builtin_interfaces", "geometry_msgs", "nav_msgs", "sensor_msgs", "std_msgs", "tf2_msgs"):
        theirs = {name for name in humble.fielddefs if name.startswith(f"{package}/msg/")}
        assert theirs <= {type_name(cls) for cls in interfaces(package)}


def test_every_module_of_messages_is_listed() -> None:
    modules = {path.stem for path in Path(kit.msg.__file__).parent.glob("*_*.py")} - {"__init__"}
    assert modules == set(PACKAGES)


def test_a_field_that_came_later_is_left_out_before() -> None:
    assert "variance" in definition(Range, "jazzy")
    assert "variance" not in definition(Range, "humble")


def test_a_definition_reads_like_its_file() -> None:
    assert definition(SetBool) == "bool data\n---\nbool success\nstring message\n"
    assert definition(LaserScan).splitlines()[-1] == "float32[] intensities"
    assert "float64 w 1.0\n" in definition(find_message("geometry_msgs/msg/Quaternion"))
    assert "int8 STATUS_FIX=0\n" in definition(find_message("sensor_msgs/msg/NavSatStatus"))


def test_names_find_classes_in_both_spellings() -> None:
    assert find_interface("sensor_msgs/msg/LaserScan") is find_message("sensor_msgs/LaserScan") is LaserScan
    assert find_service("std_srvs/srv/SetBool") is SetBool
    for name in interface_names():
        assert type_name(find_interface(name)) == name


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("geometry_msgs/msg/Twst", "geometry_msgs/msg/Twist"),
        ("geometry_mgs/msg/Twist", "geometry_msgs/msg/Twist"),
        ("std_srvs/msg/SetBool", "std_srvs/srv/SetBool"),
        ("", "''"),
        ("Twist", "'Twist'"),
        ("../../etc/passwd", "etc"),
    ],
)
def test_an_unknown_name_is_answered_with_the_nearest(name: str, hint: str) -> None:
    with pytest.raises(UnknownInterface) as problem:
        find_interface(name)
    assert hint in str(problem.value)


def test_messages_and_services_are_not_mixed_up() -> None:
    with pytest.raises(UnknownInterface, match="is a service"):
        find_message("std_srvs/srv/SetBool")
    with pytest.raises(UnknownInterface, match="is a message"):
        find_service("std_msgs/msg/String")
    assert issubclass(SetBool, Service)
