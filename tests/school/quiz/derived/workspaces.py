"""What the questions on workspaces ask, worked out by setuptools and by the references of the lesson's exercises."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from kit.school.lessons.reading import lessons_folder
from kit.school.quiz.items import QuizItem
from tests.kit_content import lesson_reference
from tests.school.quiz.derived.finding import Derivation, Finding

LESSON = lessons_folder() / "33-a-real-workspace"
SOURCES = LESSON / "layout" / "starter" / "ros2_ws" / "src"


def order_reference() -> Any:
    return lesson_reference(LESSON.name, "order")


def run_setup(folder: Path, *words: str) -> None:
    """Has setuptools carry out a package's setup.py, as colcon does with packages of the type ament_python."""
    pytest.importorskip("setuptools")  # not the project's own: a Python of 3.12 or later comes without
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "setup.py", "-q", *words],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr


def sourced_last(item: QuizItem, folder: Path) -> Finding:
    system, own = "/opt/ros/humble/camera", "~/ros2_ws/camera"
    return Finding(
        order_reference().found([{"camera": system}, {"camera": own}], "camera"),
        {
            "The one in /opt/ros/humble": system,
            "Neither of the two": None,
            "The one in ~/ros2_ws/src": own,
        },
    )


def first_of_a_build(item: QuizItem, folder: Path) -> Finding:
    first, *_ = order_reference().build_order({"A": ["B", "C"], "B": ["C"], "C": ["rclpy"]})
    return Finding(f"Package {first}", {option.text: option.text for option in item.options})


def listed_is_installed(item: QuizItem, folder: Path) -> Finding:
    """Strikes the launch folder out of one of the two files, and looks whether the launch file is installed."""
    missing_with = set()
    for name, line in (("setup.py", "launch/*"), ("package.xml", "launch_ros")):
        package = folder / name / "scout_bringup"
        shutil.copytree(SOURCES / "scout_bringup", package)
        file = package / name
        file.write_text("".join(each for each in file.read_text().splitlines(True) if line not in each))
        run_setup(package, "egg_info", "install_data", "--install-dir", str(folder / name / "install"))
        if not (folder / name / "install/share/scout_bringup/launch/scout.launch.py").is_file():
            missing_with.add(name)
    return Finding(
        frozenset(missing_with),
        {
            "setup.py does not list it": frozenset({"setup.py"}),
            "package.xml does not name it": frozenset({"package.xml"}),
            "It must lie in install, not in src": frozenset(),
        },
    )


WORKSPACES: dict[str, Derivation] = {
    "sourced-last": sourced_last,
    "first-of-a-build": first_of_a_build,
    "listed-is-installed": listed_is_installed,
}
