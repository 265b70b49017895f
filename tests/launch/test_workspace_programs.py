"""A program or launch file that is started by its path sees the workspace in which it lies."""

from __future__ import annotations

import shutil
from pathlib import Path
from textwrap import dedent

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.ros.packages import PackageError, missing_package, workspace_folders
from kit.ros.share_folders import installed_share, with_original_paths
from tests.launch.conftest import Launched

PACKAGE = "<package><name>{name}</name><export><build_type>ament_python</build_type></export></package>"
SETUP = """
import os
from glob import glob
from setuptools import setup

package_name = "{name}"
setup(
    name=package_name,
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/" + package_name]),
        ("share/" + package_name, ["package.xml"] + glob("launch/*.launch.py")),
        (os.path.join("share", package_name, "config"), glob(os.path.join("params", "*.yaml"))),
        (f"share/{{package_name}}/launch", ["launch/other.launch.py"]),
    ],
    entry_points={{"console_scripts": ["{name} = {name}.program:main"]}},
)
"""
PROGRAM = """
import rclpy
from rclpy.node import Node
from my_pkg.helper import OWN
from other_pkg.helper import OWN as OTHER
from other_pkg.msg import Reading
{more}

def main():
    rclpy.init()
    node = Node("program")
    print("SEES", OWN, OTHER, Reading(value=2.0).value)
    node.destroy_node()

if __name__ == "__main__":
    main()
"""


@pytest.fixture
def source(tmp_path: Path) -> Path:
    """The folder ``src`` of a workspace with two packages, of which one has a message."""
    folder = tmp_path / "ws" / "src"
    for name in ("my_pkg", "other_pkg"):
        package = folder / name
        (package / name).mkdir(parents=True)
        (package / "package.xml").write_text(PACKAGE.format(name=name))
        (package / "setup.py").write_text(SETUP.format(name=name))
        (package / name / "__init__.py").touch()
        (package / name / "helper.py").write_text(f"OWN = '{name}'")
    (folder / "other_pkg" / "msg").mkdir()
    (folder / "other_pkg" / "msg" / "Reading.msg").write_text("float64 value\n")
    (folder / "my_pkg" / "my_pkg" / "program.py").write_text(PROGRAM.format(more=""))
    (folder / "my_pkg" / "my_pkg" / "relative.py").write_text(PROGRAM.format(more="from .helper import OWN"))
    (folder / "my_pkg" / "launch").mkdir()
    (folder / "my_pkg" / "params").mkdir()
    (folder / "my_pkg" / "params" / "speed.yaml").write_text("speed: 1\n")
    return folder


def kit(*words: str | Path, workspace: Path) -> str:
    result = CliRunner(env={"KIT_WORKSPACE": str(workspace)}).invoke(main, [str(word) for word in words])
    return result.output


@pytest.mark.sampled(2)
@pytest.mark.parametrize("name", ["program", "relative"])
def test_a_controller_sees_its_workspace(source: Path, name: str, tmp_path: Path) -> None:
    file = source / "my_pkg" / "my_pkg" / f"{name}.py"
    output = kit("run", "maze", "--controller", file, "--steps", "5", workspace=tmp_path / "kit")
    assert "SEES my_pkg other_pkg 2.0" in output


@pytest.mark.sampled(2)
@pytest.mark.parametrize("place", ["ws", "ws/scripts/deep", "ws/src", "robot-kit/controllers"])
def test_a_controller_in_no_package_sees_the_workspace_in_which_it_lies(
    source: Path, place: str, tmp_path: Path
) -> None:
    if place.startswith("robot-kit"):
        (tmp_path / "robot-kit").mkdir()
        source.rename(tmp_path / "robot-kit" / "packages")
    file = tmp_path / place / "drive.py"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(PROGRAM.format(more=""))
    output = kit("run", "maze", "--controller", file, "--steps", "5", workspace=tmp_path / "kit")
    assert "SEES my_pkg other_pkg 2.0" in output


def test_a_file_far_from_any_package_has_no_workspace(tmp_path: Path) -> None:
    (tmp_path / "ws" / "src" / "empty").mkdir(parents=True)
    assert workspace_folders(tmp_path / "ws" / "drive.py") == ()


@pytest.mark.sampled(2)
@pytest.mark.parametrize("name", ["program", "relative"])
def test_a_file_that_a_launch_file_runs_sees_its_workspace(
    source: Path, name: str, tmp_path: Path, launch: Launched
) -> None:
    file = tmp_path / "run.launch.py"
    program = source / "my_pkg" / "my_pkg" / f"{name}.py"
    file.write_text(
        "from launch import LaunchDescription\nfrom launch.actions import ExecuteProcess\n"
        f"def generate_launch_description(): return LaunchDescription([ExecuteProcess(cmd=['python3', {str(program)!r}])])"
    )
    out, _, status = launch(file, "--until", "1")
    assert "SEES my_pkg other_pkg 2.0" in out
    assert status == 0


def test_files_are_where_setup_py_installs_them(source: Path) -> None:
    package = source / "my_pkg"
    (package / "launch" / "drive.launch.py").touch()
    share = installed_share("my_pkg", package)
    assert (share / "drive.launch.py").is_file()
    assert (share / "launch" / "drive.launch.py").is_file()
    assert (share / "config" / "speed.yaml").read_text() == "speed: 1\n"
    assert (share / "params" / "speed.yaml").is_file()
    assert installed_share("my_pkg", package) == share
    (package / "launch" / "later.launch.py").touch()
    assert (installed_share("my_pkg", package) / "later.launch.py").is_file()
    (package / "extra.yaml").touch()
    assert (installed_share("my_pkg", package) / "extra.yaml").is_file()
    speed, folder = share / "params" / "speed.yaml", share / "config"
    sent = {"arguments": ["-p", f"world_path:='{folder}/x.yaml'"], "cwd": str(share), "file": str(speed)}
    assert with_original_paths(sent) == {
        "arguments": ["-p", f"world_path:='{package}/config/x.yaml'"],
        "cwd": str(package),
        "file": str(speed.resolve()),
    }
    shutil.rmtree(share.parent)


def test_a_package_whose_files_stay_where_they_are_has_its_own_folder(source: Path) -> None:
    assert installed_share("other_pkg", source / "other_pkg") == source / "other_pkg"


def test_an_included_launch_file_is_found_where_it_is_installed(source: Path, launch: Launched) -> None:
    folder = source / "my_pkg" / "launch"
    (folder / "part.launch.py").write_text(
        "from launch import LaunchDescription\nfrom launch.actions import LogInfo\n"
        "def generate_launch_description(): return LaunchDescription([LogInfo(msg='INCLUDED')])"
    )
    (folder / "all.launch.py").write_text(
        dedent(
            """
            import os
            from ament_index_python.packages import get_package_share_directory
            from launch import LaunchDescription, LaunchIntrospector
            from launch.actions import IncludeLaunchDescription, LogInfo
            from launch.substitutions import EnvironmentVariable, PathJoinSubstitution
            from launch_ros.substitutions import FindPackageShare

            os.environ["COLOUR"] = "red"

            def generate_launch_description():
                os.environ["SHAPE"] = "round"
                config = os.path.join(get_package_share_directory("my_pkg"), "config", "speed.yaml")
                description = LaunchDescription([
                    LogInfo(msg=[EnvironmentVariable("COLOUR"), " and ", EnvironmentVariable("SHAPE")]),
                    LogInfo(msg=open(config).read().strip()),
                    IncludeLaunchDescription(PathJoinSubstitution([FindPackageShare("my_pkg"), "part.launch.py"])),
                ])
                print(LaunchIntrospector().format_launch_description(description))
                print(len(os.popen("ros2 --help").read()) > 100)
                return description
            """
        )
    )
    out, err, status = launch(source / "my_pkg", "all.launch.py", "--until", "1")
    assert status == 0, err
    for text in ("red and round", "speed: 1", "INCLUDED", "LogInfo", "IncludeLaunchDescription", "True"):
        assert text in out


def test_a_broken_package_xml_is_an_error_with_its_line(source: Path, launch: Launched) -> None:
    file = source / "other_pkg" / "package.xml"
    file.write_text("<package>\n<name>other_pkg</name>\n<description>a & b</description>\n</package>\n")
    assert f"{file}:3:" in str(missing_package("other_pkg", [source]))
    (source / "my_pkg" / "launch" / "x.launch.py").write_text(
        "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n"
        "def generate_launch_description(): return LaunchDescription([Node(package='other_pkg', executable='x')])"
    )
    _, err, status = launch(source / "my_pkg", "x.launch.py", "--until", "1")
    assert status == 2
    assert f"{file}:3:" in err
    with pytest.raises(PackageError, match="package 'nobody' not found"):
        raise missing_package("nobody", [source])


def test_a_program_runs_by_the_folder_of_its_package(source: Path, tmp_path: Path) -> None:
    (source / "my_pkg" / "my_pkg" / "program.py").write_text(PROGRAM.format(more=""))
    output = kit("ros", "run", source / "my_pkg", "my_pkg", workspace=tmp_path / "kit")
    assert "SEES" in output


def test_a_package_without_a_launch_file_says_how_its_program_is_run(source: Path, tmp_path: Path) -> None:
    for file in (source / "my_pkg").rglob("*.launch.py"):
        file.unlink()
    output = kit("launch", source / "my_pkg", workspace=tmp_path / "kit")
    assert "`kit ros run my_pkg my_pkg`" in output


def test_pip_is_not_advised_for_what_lies_nearby(source: Path, tmp_path: Path) -> None:
    (source / "tools").mkdir()
    (source / "tools" / "wall_follower").mkdir()
    (source / "tools" / "deep").mkdir()
    file = source / "tools" / "deep" / "drive.py"
    (source / "tools" / "wall_follower.py").write_text("x = 1")
    file.write_text("import rclpy\nimport wall_follower\n")
    output = kit("ros", "run", file, workspace=tmp_path / "kit")
    assert "wall_follower" in output
    assert "pip install" not in output


CALLS = {
    "plain": "main()",
    "exits": "import sys\nsys.exit(main())",
    "guarded": "if __name__ == '__main__':\n    main()",
    "left": "",
    "told": "'main() is not called here'",
}


def test_main_runs_once_whoever_calls_it(tmp_path: Path, launch: Launched) -> None:
    """A program without nodes, too: what the file calls itself is not called again."""
    for name, call in CALLS.items():
        (tmp_path / f"{name}.py").write_text(f"def main():\n    print('{name}', flush=True)\n\n{call}\n")
    programs = [
        f"ExecuteProcess(cmd=['python3', {str(tmp_path / name)!r} + '.py'], name='p')" for name in CALLS
    ]
    file = tmp_path / "all.launch.py"
    file.write_text(
        "from launch import LaunchDescription\nfrom launch.actions import ExecuteProcess\n"
        f"def generate_launch_description():\n    return LaunchDescription([{', '.join(programs)}])\n"
    )
    out, _, status = launch(file, "--until", "1")
    assert status == 0
    printed = [line.split("] ", 1)[1] for line in out.splitlines() if line.startswith("[p-")]
    assert sorted(printed) == sorted(CALLS)
