"""Interfaces that another process has described: the classes built from them, and what can be wrong with them."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.msg.definition_parser import DefinitionError
from kit.msg.definition_writer import definitions_of
from kit.msg.geometry_msgs import Point
from kit.msg.interfaces import UnknownInterface, find_interface, register_packages
from kit.msg.received_interfaces import ReceivedInterfaces
from kit.msg.std_srvs import SetBool

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
