"""Every shipped message equals what rosbags knows of ROS 2; those that another process has described are built likewise."""

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
from kit.msg.definition_parser import DefinitionError
from kit.msg.definition_writer import definitions_of
from kit.msg.geometry_msgs import Point
from kit.msg.interfaces import (
    PACKAGES,
    ReceivedInterfaces,
    UnknownInterface,
    definition,
    fields_of,
    find_action,
    find_interface,
    find_message,
    find_service,
    interface_names,
    interfaces,
    register_packages,
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


def test_a_message_is_pickled_by_its_type() -> None:
    """In another process too, which has not imported the module before."""
    goal = find_action("example_interfaces/action/Fibonacci").Goal(order=3)
    text = pickle.dumps([find_message("std_msgs/String")(data="hello"), goal])
    code = f"import pickle; found = pickle.loads({text!r}); print(found[0].data, found[1].order)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert run.stdout == "hello 3\n", run.stderr


def test_a_class_says_of_itself_what_rosidls_does() -> None:
    twist, request = find_message("geometry_msgs/Twist"), find_service("std_srvs/srv/SetBool").Request
    action = find_action("example_interfaces/action/Fibonacci")
    assert [
        (each.__module__, each.__name__)
        for each in (twist, request, action.Goal, action.Impl.SendGoalService)
    ] == [
        ("geometry_msgs.msg._twist", "Twist"),
        ("std_srvs.srv._set_bool", "SetBool_Request"),
        ("example_interfaces.action._fibonacci", "Fibonacci_Goal"),
        ("example_interfaces.action._fibonacci", "Fibonacci_SendGoal"),
    ]
    fields = {"linear": "geometry_msgs/Vector3", "angular": "geometry_msgs/Vector3"}
    assert twist._fields_and_field_types == twist()._fields_and_field_types == fields


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
    made = make_message_class("my_msgs/msg/Foo_Request", ())
    assert not is_request_or_response(made), "a message of a topic, however it is called"


SIZE, MEASURE, MOVE = "far_msgs/msg/Size", "far_msgs/srv/Measure", "far_msgs/action/Move"
TEXTS = {
    SIZE: "uint8 SMALL=1\nfloat64 width 0.5\ngeometry_msgs/Point[] corners\n",
    MEASURE: "far_msgs/Size size\n---\nbool done\n",
    MOVE: "far_msgs/Size[<=3] sizes\n---\nint32 count\n---\nfloat32 left\n",
}


def received(**replaced: str) -> ReceivedInterfaces:
    found = ReceivedInterfaces()
    for name, text in (TEXTS | replaced).items():
        found.add(name, text)
    return found


def test_classes_are_built_from_what_was_received() -> None:
    interfaces = received()
    size = interfaces.find(SIZE)(corners=[Point(x=1.0)])
    assert (size.width, size.SMALL, size.corners[0].x) == (0.5, 1, 1.0)
    assert interfaces.find(MEASURE).Request(size=size).size is not None
    parts = ("SendGoal", "GetResult", "FeedbackMessage")
    assert [interfaces.find(f"{MOVE}_{part}").__ros_type__ for part in parts] == [
        f"{MOVE}_{p}" for p in parts
    ]
    assert interfaces.find(f"{MEASURE}_Event")().request == []
    assert interfaces.find("std_srvs/srv/SetBool") is SetBool
    assert find_interface(SIZE) is interfaces.find(SIZE)


def test_the_same_definitions_are_the_same_interface() -> None:
    """Otherwise two terminals with the same package could not talk to each other."""
    one, two = received(), received()
    changed = received(**{SIZE: "float64 height\n"})
    for name in (SIZE, MEASURE, MOVE, f"{MOVE}_SendGoal"):
        assert one.find(name) is two.find(name)
        assert changed.find(name) is not one.find(name)


def test_a_package_that_becomes_known_later_has_the_same_classes(tmp_path: Path) -> None:
    interfaces = ReceivedInterfaces()
    interfaces.add("later_msgs/msg/Mark", "int32 id\n")
    before = interfaces.find("later_msgs/msg/Mark")
    (tmp_path / "msg").mkdir()
    (tmp_path / "msg" / "Mark.msg").write_text("# which one\nint32   id  # from 0 on\n")
    register_packages({"later_msgs": str(tmp_path)})
    assert find_interface("later_msgs/msg/Mark") is before


def test_messages_nested_without_end_are_refused(tmp_path: Path) -> None:
    """Python would give up with an error of its own, somewhere in the middle."""
    (tmp_path / "msg").mkdir()
    for number in range(60):
        (tmp_path / "msg" / f"Part{number}.msg").write_text(f"Part{number + 1} part\n")
    (tmp_path / "msg" / "Part60.msg").write_text("int8 x\n")
    register_packages({"deep_msgs": str(tmp_path)})
    with pytest.raises(DefinitionError, match="nested more than 50 deep"):
        find_interface("deep_msgs/msg/Part0")
    assert find_interface("deep_msgs/msg/Part20").__ros_type__ == "deep_msgs/msg/Part20"


def test_what_is_needed_to_build_a_class_is_told_in_order() -> None:
    interfaces = received()
    assert list(definitions_of(interfaces.find(MEASURE))) == [SIZE, MEASURE]
    for name in (f"{MOVE}_SendGoal", f"{MOVE}_FeedbackMessage"):
        assert list(definitions_of(interfaces.find(name))) == [SIZE, MOVE]
    assert list(definitions_of(interfaces.find(f"{MEASURE}_Event"))) == [SIZE, MEASURE]
    assert definitions_of(Point) == definitions_of(SetBool) == {}
    again = ReceivedInterfaces()
    for name, text in definitions_of(interfaces.find(MOVE)).items():
        again.add(name, text)
    assert again.find(MOVE) is interfaces.find(MOVE)


@pytest.mark.parametrize(
    "name", ["far_msgs/Size", "far_msgs/txt/Size", "far msgs/msg/Size", "std_msgs/msg/String"]
)
def test_names_that_are_none_or_the_kit_s_are_refused(name: str) -> None:
    with pytest.raises(DefinitionError):
        ReceivedInterfaces().add(name, "int32 id\n")


def test_definitions_that_are_wrong_or_missing_are_refused() -> None:
    for text in ("int32\n", "far_msgs/Nothing it\n", "far_msgs/Size inside\n"):
        with pytest.raises(DefinitionError):
            received(**{SIZE: text}).find(MEASURE)
    with pytest.raises(UnknownInterface):
        received().find("far_msgs/msg/Nothing")
    with pytest.raises(UnknownInterface):
        received().find(f"{MEASURE}_SendGoal")


def test_nesting_costs_no_more_than_its_depth() -> None:
    interfaces = ReceivedInterfaces()
    for i in range(40):
        nested = f"deep_msgs/M{i + 1} a\ndeep_msgs/M{i + 1} b\n" if i < 39 else "int32 a\n"
        interfaces.add(f"deep_msgs/msg/M{i}", nested)
    assert interfaces.find("deep_msgs/msg/M38").__ros_type__ == "deep_msgs/msg/M38"
