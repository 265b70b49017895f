"""``kit ros interface show``: interfaces as their files are written."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from kit.inspection.definition_text import CommentOptions, definition_text
from kit.msg.definition_writer import is_shipped
from kit.msg.interfaces import find_interface, interface_names, register_packages
from tests.inspection.conftest import runner_for

READING = """\
# What a sensor says.

uint8 HIGH=2  # high enough

Place at # where
float64[] values
"""
PLACE = "# A place.\n\nstring<=10 name here   # its name\n"


@pytest.fixture
def shown_msgs(tmp_path: Path) -> Iterator[None]:
    folder = tmp_path / "src" / "shown_msgs"
    (folder / "msg").mkdir(parents=True)
    (folder / "msg" / "Reading.msg").write_text(READING)
    (folder / "msg" / "Place.msg").write_text(PLACE)
    (folder / "action").mkdir()
    (folder / "action" / "Read.action").write_text("# How often.\nuint8 count\n---\nReading[] found\n---\n")
    register_packages({"shown_msgs": str(folder)})
    return


@pytest.mark.usefixtures("shown_msgs")
def test_comments_of_the_file_itself_are_shown() -> None:
    text = definition_text(find_interface("shown_msgs/msg/Reading"))
    assert text == READING.replace("# where\n", "# where\n\tstring<=10 name here\n")


@pytest.mark.usefixtures("shown_msgs")
def test_all_comments_or_none() -> None:
    cls = find_interface("shown_msgs/msg/Reading")
    assert "\t# A place.\n\n\tstring<=10 name here   # its name\n" in definition_text(
        cls, CommentOptions(nested=True)
    )
    assert definition_text(cls, CommentOptions(own=False)) == (
        "uint8 HIGH=2\nPlace at\n\tstring<=10 name here\nfloat64[] values\n"
    )


@pytest.mark.usefixtures("shown_msgs")
def test_an_action_and_its_parts() -> None:
    assert definition_text(find_interface("shown_msgs/action/Read")) == (
        "# How often.\nuint8 count\n---\nReading[] found\n\tuint8 HIGH=2\n\tPlace at\n\t\tstring<=10 name here\n"
        "\tfloat64[] values\n---\n"
    )
    assert definition_text(find_interface("shown_msgs/action/Read_SendGoal")).endswith(
        "---\nbool accepted\nbuiltin_interfaces/Time stamp\n\tint32 sec\n\tuint32 nanosec\n"
    )


def test_every_shipped_interface_is_shown_with_a_sentence_about_it() -> None:
    for name in filter(is_shipped, interface_names()):
        text = definition_text(find_interface(name))
        assert "# added in" not in text
        first = text.splitlines()[0]
        assert first.startswith("# "), name
        assert first.endswith("."), name


def test_fields_of_shipped_interfaces_say_their_units() -> None:
    twist = definition_text(find_interface("geometry_msgs/msg/Twist"))
    assert "[m/s]" in twist
    assert "[rad/s]" in twist
    assert "#" not in "".join(line for line in twist.splitlines() if line.startswith("\t"))
    nested = definition_text(find_interface("nav_msgs/msg/Odometry"), CommentOptions(nested=True))
    assert any(line.startswith("\t") and "#" in line for line in nested.splitlines())


def test_options_of_the_verb(tmp_path: Path) -> None:
    kit_ros = runner_for(tmp_path)
    assert kit_ros("interface", "show", "std_msgs/msg/Bool", "--no-comments") == ("bool data\n", "", 0)
    assert kit_ros("interface", "show", "std_msgs/msg/Bool", "--no-comments", "--all-comments")[2] == 2
