"""Every shipped message equals what rosbags knows of ROS 2's distributions, fields, constants and hashes."""

from __future__ import annotations

import pickle
import subprocess
import sys
from importlib import import_module
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
    find_action,
    find_interface,
    find_message,
    find_service,
    interface_names,
    interfaces,
)
from kit.msg.message import Message, Service, is_request_or_response, make_message_class, type_name
from kit.msg.sensor_msgs import LaserScan, Range
from kit.msg.std_srvs import SetBool
from tests.cases import every_case
from tests.msg.stubs import stub_files

STORES = MappingProxyType({"humble": Stores.ROS2_HUMBLE, "jazzy": Stores.ROS2_JAZZY})
MESSAGES = [cls for package in PACKAGES for cls in interfaces(package) if issubclass(cls, Message)]
TYPESTORES = {distro: get_typestore(name) for distro, name in STORES.items()}
SHARED = [
    pytest.param(cls, distro, id=f"{type_name(cls)}-{distro}")
    for cls in MESSAGES
    for distro, store in TYPESTORES.items()
    if type_name(cls) in store.fielddefs
]


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
        return f"{content[0]}<={content[1]}" if content[1] else str(content[0])
    if node == Nodetype.NAME:
        return str(content).replace("/msg/", "/")
    item, count = content
    size = "" if not count else str(count) if node == Nodetype.ARRAY else f"<={count}"
    return f"{spelled(item)}[{size}]"


@every_case(("cls", "distro"), SHARED)
def test_fields_are_those_of_the_distribution(cls: type[Message], distro: str) -> None:
    _, fields = TYPESTORES[distro].fielddefs[type_name(cls)]
    theirs = [(name, spelled(kind)) for name, kind in fields if name != "structure_needs_at_least_one_member"]
    assert [(field.name, field.kind.text) for field in fields_of(cls, distro)] == theirs


@every_case(("cls", "distro"), SHARED)
def test_constants_are_those_of_the_distribution(cls: type[Message], distro: str) -> None:
    constants, _ = TYPESTORES[distro].fielddefs[type_name(cls)]
    for name, _, value in constants:
        ours = getattr(cls, name)
        assert (ours[0] if isinstance(ours, bytes) else ours) == value


def test_hashes_are_those_of_the_distribution(distro: str, store: Typestore) -> None:
    ours = get_typestore(Stores.EMPTY)
    for cls in MESSAGES:
        if "/msg/" in type_name(cls) and "wstring" not in definition(cls):  # which rosbags does not know
            ours.register(get_types_from_msg(definition(cls, distro), type_name(cls)))
    theirs = {name: store.hash_rihs01(name) for name in map(type_name, MESSAGES) if name in store.fielddefs}
    assert len(theirs) > 130
    assert {name: ours.hash_rihs01(name) for name in theirs} == theirs
    assert ours.hash_rihs01("flatland_msgs/msg/Collisions").startswith("RIHS01_")
    # Ours by mark, since newer distributions dropped it, but the same as theirs where they have it.
    assert ours.hash_rihs01("geometry_msgs/msg/Pose2D") == store.hash_rihs01("geometry_msgs/msg/Pose2D")


def test_the_packages_that_packages_for_flatland_need_are_whole() -> None:
    humble = get_typestore(Stores.ROS2_HUMBLE)
    for package in (
        "action_msgs",
        "builtin_interfaces",
        "diagnostic_msgs",
        "geometry_msgs",
        "lifecycle_msgs",
        "nav_msgs",
        "rcl_interfaces",
        "sensor_msgs",
        "std_msgs",
        "tf2_msgs",
        "trajectory_msgs",
    ):
        theirs = {name for name in humble.fielddefs if name.startswith(f"{package}/msg/")}
        assert theirs <= {type_name(cls) for cls in interfaces(package)}


def test_every_package_of_definitions_is_listed_and_has_its_module() -> None:
    folder = Path(kit.msg.__file__).parent
    assert {path.name for path in (folder / "definitions").iterdir()} == set(PACKAGES)
    for package in PACKAGES:
        module = import_module(f"kit.msg.{package}")
        assert {getattr(module, name) for name in module.__all__} == set(interfaces(package))
    with pytest.raises(ModuleNotFoundError):
        import_module("kit.msg.nonsense")


def test_a_message_is_pickled_by_its_module() -> None:
    """In another process too, which has not imported the module before."""
    text = pickle.dumps(find_message("std_msgs/String")(data="hello"))
    code = f"import pickle; print(pickle.loads({text!r}).data)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert run.stdout == "hello\n", run.stderr


def test_stubs_are_those_that_the_definitions_give() -> None:
    root = Path(kit.__file__).parent
    written = {str(path.relative_to(root)): path.read_text() for path in root.rglob("*.pyi")}
    assert written == stub_files(), "run: python -m tests.msg.stubs"


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


def test_only_messages_of_services_are_requests_and_responses() -> None:
    action = find_action("example_interfaces/action/Fibonacci")
    service = find_service("std_srvs/srv/SetBool")
    for cls in (service.Request, service.Response, action.Impl.SendGoalService.Request):
        assert is_request_or_response(cls)
    for other in (find_message("std_msgs/msg/String"), action.Impl.FeedbackMessage, action.Goal):
        assert not is_request_or_response(other)
    made = make_message_class("my_msgs/msg/Foo_Request", (), module=__name__, qualname="Foo")
    assert not is_request_or_response(made), "a message of a topic, however it is called"
