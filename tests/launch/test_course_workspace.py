"""A workspace as a course hands it out: it runs as it lies, and ROS 2's own tools take it.

colcon and Debian's rosidl are no dependencies of the project: what needs them is skipped where they are not, with the
line that would bring them.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

from kit.launch.package_creation import create_package
from kit.msg.interfaces import find_action, find_message, register_packages
from kit.ros.packages import find_packages
from tests.launch.conftest import Launched

WORKSPACE = Path(__file__).parent / "course_ws"
INTERFACES = WORKSPACE / "src" / "course_interfaces"
COLCON = os.environ.get("COLCON") or shutil.which("colcon")
"""The build tool: on the PATH, or where the variable says."""

needs_colcon = pytest.mark.skipif(
    COLCON is None,
    reason="no colcon: pip install colcon-core colcon-ros colcon-common-extensions, in an environment of its own, "
    "and COLCON=.../bin/colcon",
)


@pytest.mark.long
@pytest.mark.parametrize("language", ["py", "xml", "yaml"])
def test_the_course_runs_unchanged(language: str, launch: Launched) -> None:
    said, complained, code = launch(
        WORKSPACE / "src" / "course_bringup", f"course.launch.{language}", "title:=views", "--plain"
    )
    everything = said + complained
    assert code == 0, everything
    for text in ("area 7.0", "counted [1, 2, 3] to 3", "battery 2.0 m kind 2", "views: a picture in /class"):
        assert f"[class.tour]: {text}" in everything
    (skipped,) = (line for line in everything.splitlines() if "skipped" in line)
    assert "package 'course_cpp' has no Python programs" in skipped
    assert f"course.launch.{language}" in skipped


@pytest.mark.long
def test_the_cpp_package_is_left_out_where_it_is_not_wanted(launch: Launched) -> None:
    said, complained, code = launch(
        WORKSPACE / "src" / "course_bringup", "course.launch.xml", "with_cpp:=false", "--plain"
    )
    assert code == 0
    assert "skipped" not in said + complained


def colcon_build(source: Path, base: Path, *packages: str) -> Path:
    """Builds packages with colcon; returns where they are installed."""
    assert COLCON is not None
    done = subprocess.run(
        [
            COLCON, "--log-base", str(base / "log"), "build", "--base-paths", str(source),
            "--build-base", str(base / "build"), "--install-base", str(base / "install"),
            "--packages-select", *packages,
        ],
        capture_output=True, text=True, check=False, timeout=300, cwd=base,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert f"Summary: {len(packages)} package" in done.stdout
    return base / "install"


@needs_colcon
@pytest.mark.long
def test_colcon_builds_what_kit_pkg_create_makes(tmp_path: Path) -> None:
    create_package("my_robot", tmp_path / "src")
    install = colcon_build(tmp_path / "src", tmp_path, "my_robot")
    assert (install / "my_robot" / "lib" / "my_robot" / "driver").is_file()
    share = install / "my_robot" / "share" / "my_robot"
    assert {"package.xml", "launch", "world"} <= {path.name for path in share.iterdir()}


@needs_colcon
@pytest.mark.long
def test_colcon_builds_the_course_s_python_packages(tmp_path: Path) -> None:
    # Beside them, colcon would want what cannot be built here: interfaces and C++ need ROS 2's own CMake packages.
    for name in ("course_py", "course_bringup"):
        shutil.copytree(WORKSPACE / "src" / name, tmp_path / "src" / name)
    install = colcon_build(tmp_path / "src", tmp_path, "course_py", "course_bringup")
    programs = {path.name for path in (install / "course_py" / "lib" / "course_py").iterdir()}
    assert programs == {"reading_publisher", "area_server", "count_server", "camera", "tour"}
    launch_files = install / "course_bringup" / "share" / "course_bringup" / "launch"
    assert len(list(launch_files.iterdir())) == 3


CONVERT = """
import pathlib, sys
from rosidl_adapter.parser import parse_action_file, parse_message_file, parse_service_file
folder = pathlib.Path(sys.argv[1])
def show(message):
    for constant in message.constants:
        print(message.msg_name, "constant", constant.type, constant.name, constant.value)
    for field in message.fields:
        print(message.msg_name, "field", field.type, field.name, field.default_value)
show(parse_message_file("course_interfaces", str(folder / "msg/Reading.msg")))
service = parse_service_file("course_interfaces", str(folder / "srv/ComputeArea.srv"))
show(service.request), show(service.response)
action = parse_action_file("course_interfaces", str(folder / "action/CountUntil.action"))
show(action.goal), show(action.result), show(action.feedback)
"""


@pytest.mark.long
def test_ros_s_own_parser_reads_the_interfaces_as_the_kit_does() -> None:
    """Debian's rosidl: fields, types, bounds, defaults and constants."""
    python = "/usr/bin/python3"
    found = subprocess.run([python, "-c", "import rosidl_adapter"], capture_output=True, check=False)
    if found.returncode:
        pytest.skip("no rosidl_adapter: apt-get install python3-rosidl")
    done = subprocess.run(
        [python, "-c", CONVERT, str(INTERFACES)], capture_output=True, text=True, check=False, env={}
    )
    assert done.returncode == 0, done.stderr
    register_packages({"course_interfaces": str(INTERFACES)})
    reading = find_message("course_interfaces/msg/Reading")()
    theirs = {tuple(line.split()[1:4]): line.split(maxsplit=4)[4] for line in done.stdout.splitlines()}
    assert theirs["field", "uint8", "kind"] == str(reading.kind)
    assert theirs["field", "string<=20", "unit"] == reading.unit
    assert theirs["field", "int32[3]", "counts"] == str(reading.counts.tolist())
    assert theirs["field", "bool", "valid"] == str(reading.valid)
    assert ("field", "float32[<=5]", "samples") in theirs
    assert theirs["constant", "uint8", "KIND_BATTERY"] == str(reading.KIND_BATTERY)
    goal = find_action("course_interfaces/action/CountUntil").Goal()
    assert float(theirs["field", "float64", "period"]) == goal.period
    kits = set(reading.get_fields_and_field_types()) | {
        "length",
        "width",
        "area",
        "target",
        "period",
        "reached",
        "current",
    }
    assert {name for kind, _, name in theirs if kind == "field"} == kits


def test_rosbags_gives_the_interfaces_the_same_hashes() -> None:
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    from kit.ros.serialization import Serializer

    folders = find_packages([WORKSPACE / "src"])
    register_packages({"course_interfaces": str(folders["course_interfaces"])})
    store = get_typestore(Stores.ROS2_JAZZY)
    text = (INTERFACES / "msg" / "Reading.msg").read_text()
    store.register(get_types_from_msg(text, "course_interfaces/msg/Reading"))
    wanted = store.hash_rihs01("course_interfaces/msg/Reading")
    assert Serializer().type_hash(find_message("course_interfaces/msg/Reading")) == wanted
