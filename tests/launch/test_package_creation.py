"""New packages: complete, launched as they lie, and such as setuptools and colcon take."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
import yaml
from click.testing import CliRunner

from kit.cli import main
from kit.geometry import Pose
from kit.launch.package_creation import create_package, place_models
from kit.ros.packages import PackageError, read_package
from kit.run.scenario import scenario_in_file
from kit.world.catalogue import UnknownMap
from tests.launch.conftest import Launched


@pytest.fixture
def kit(tmp_path: Path) -> Callable[..., tuple[str, str, int]]:
    def run(*words: str) -> tuple[str, str, int]:
        result = CliRunner(env={"KIT_WORKSPACE": str(tmp_path / "workspace")}).invoke(main, words)
        return result.stdout, result.stderr, result.exit_code

    return run


@pytest.mark.parametrize("map_name", ["simple", "maze", "turn"])
def test_a_new_package_is_launched_as_it_lies(map_name: str, launch: Launched, tmp_path: Path) -> None:
    folder = create_package("my_robot", tmp_path / "src", map_name=map_name, node="walker")
    package = read_package(folder)
    assert package.file_of(package.executable("walker")) == folder / "my_robot" / "walker.py"
    scenario_in_file(folder / "world" / "world.yaml")  # nothing outside the package is named
    out, err, code = launch(folder, "speed:=0.3", "--until", "1")
    assert code == 0, err
    assert "[walker-2]: process started" in out


def install_with_setuptools(folder: Path, target: Path) -> Path:
    """Does what colcon does with a package of the build type ament_python; returns what it installed as shared data."""
    pytest.importorskip("setuptools")  # not the project's own: a Python of 3.12 or later comes without
    words = ("egg_info", "install_data", "--install-dir", str(target))
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "setup.py", "-q", *words],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return target / "share"


def test_setuptools_installs_what_the_launch_file_names(tmp_path: Path) -> None:
    folder = create_package("my_robot", tmp_path)
    share = install_with_setuptools(folder, tmp_path / "install")
    assert (share / "ament_index/resource_index/packages/my_robot").is_file()
    assert (share / "my_robot/package.xml").is_file()
    assert (share / "my_robot/launch/my_robot.launch.py").is_file()
    installed = {path.name for path in (share / "my_robot/world").iterdir()}
    assert installed == {path.name for path in (folder / "world").iterdir()}
    points = (folder / "my_robot.egg-info/entry_points.txt").read_text()
    assert "driver = my_robot.driver:main" in points


@pytest.mark.parametrize("name", ["My", "9lives", "with-dash", "", "launch", "../up"])
def test_names_that_cannot_be_are_refused(name: str, tmp_path: Path) -> None:
    with pytest.raises(PackageError, match="cannot be named"):
        create_package(name, tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_nothing_is_overwritten_and_nothing_half_made(tmp_path: Path) -> None:
    create_package("mine", tmp_path)
    with pytest.raises(PackageError, match="already exists"):
        create_package("mine", tmp_path)
    with pytest.raises(UnknownMap):
        create_package("yours", tmp_path, map_name="atlantis")
    with pytest.raises(PackageError, match="cannot be created"):
        create_package("theirs", Path("/proc/nowhere"))
    assert [path.name for path in tmp_path.iterdir()] == ["mine"]


@pytest.mark.long
def test_packages_and_programs_are_listed(kit: Callable[..., tuple[str, str, int]], tmp_path: Path) -> None:
    out, err, code = kit("pkg", "create", "my_robot")
    assert (err, code) == ("", 0)
    assert out.endswith("\nkit launch my_robot\n")
    folder = tmp_path / "workspace" / "packages" / "my_robot"
    assert kit("pkg") == kit("pkg", "executables", "my_robot") == ("my_robot driver\n", "", 0)
    listed, err, code = kit("pkg", "list")
    assert (err, code) == ("", 0)
    assert (listed, "", 0) == kit("ros", "pkg", "list")
    assert {"my_robot", "std_msgs", "turtlesim"} <= set(listed.split())  # as ros2: all that can be imported
    assert kit("pkg", "prefix", "my_robot") == (f"{folder}\n", "", 0)
    assert "tf2_ros tf2_echo" in kit("pkg", "executables", "tf2_ros")[0].splitlines()
    assert kit("pkg", "prefix", "my_robot", "--share") == (f"{folder}\n", "", 0)
    (file,) = kit("pkg", "executables", "my_robot", "--full-path")[0].splitlines()
    assert file == str(folder / "my_robot" / "driver.py")
    assert kit("pkg", "xml", "my_robot")[0] == (folder / "package.xml").read_text()
    assert kit("pkg", "xml", "my_robot", "--tag", "name") == ("my_robot\n", "", 0)
    assert kit("pkg", "xml", "my_robot", "-t", "nothing")[2] == 2
    out, err, code = kit("pkg", "executables", "yours")
    assert code == 2
    assert "not found; available: my_robot" in err
    assert kit("pkg", "create", "my_robot")[2] == 2
    assert kit("launch", "my_robot", "--steps", "5")[2] == 0


def test_models_are_placed_and_the_rest_of_a_world_stays(tmp_path: Path) -> None:
    file = tmp_path / "world.yaml"
    text = """models:
  - name: serp   # the robot
    model: serp.model.yaml
    pose: [1, 2, 3]   # somewhere
  - {name: cart, model: cart.model.yaml}
  - name: beacon
    model: beacon.model.yaml
"""
    file.write_text(text)
    place_models(file, {"serp": Pose(0.5, -1.0, 0.25), "cart": Pose(2.0, 2.0), "nobody": Pose()})
    found = yaml.safe_load(file.read_text())["models"]
    assert [each.get("pose") for each in found] == [[0.5, -1.0, 0.25], [2, 2, 0], None]
    assert "# the robot" in file.read_text()
    assert "# somewhere" in file.read_text()
    assert [each["model"] for each in found] == [f"{name}.model.yaml" for name in ("serp", "cart", "beacon")]


def test_a_package_is_created_by_a_tutorials_own_command(
    kit: Callable[..., tuple[str, str, int]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In the current folder, as there; ``kit pkg create`` keeps packages together, and says where."""
    (tmp_path / "src").mkdir()
    monkeypatch.chdir(tmp_path / "src")
    words = "--build-type ament_python --license Apache-2.0 --node-name my_node my_package --dependencies rclpy std_msgs"
    out, _, code = kit("ros", "pkg", "create", *words.split())
    assert code == 0
    folder = tmp_path / "src" / "my_package"
    assert out.startswith(f"destination directory: {tmp_path / 'src'}\n")
    assert out.endswith(f"\nkit launch {folder}\n")
    manifest = (folder / "package.xml").read_text()
    assert kit("ros", "pkg", "executables", "my_package")[0] == "my_package my_node\n"
    kept = tmp_path / "workspace" / "packages"
    assert kit("pkg", "create", "mine")[0].startswith(f"destination directory: {kept}\n")
    assert (kept / "mine").is_dir()
    assert "<license>Apache-2.0</license>" in manifest
    assert manifest.count("depend>rclpy<") == manifest.count("depend>std_msgs<") == 1
    assert kit("ros", "pkg", "create", "other", "--dependencies", "a<b")[2] == 2
    assert kit("ros", "pkg", "create", "--build-type", "ament_cmake", "other")[2] == 2
