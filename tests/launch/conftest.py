"""Packages to launch, and ``kit launch`` in this process or in one of its own."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from textwrap import dedent, indent

import pytest
from click.testing import CliRunner

from kit.cli import main

PACKAGES = Path(__file__).parent.parent / "ros" / "packages"
TWO_ROBOTS = PACKAGES / "two_robots"

Launched = Callable[..., tuple[str, str, int]]


@pytest.fixture
def launch(tmp_path: Path) -> Launched:
    """``kit launch ...``: what it prints, what it complains, its exit code."""

    def run(*words: str | Path) -> tuple[str, str, int]:
        runner = CliRunner(env={"KIT_WORKSPACE": str(tmp_path / "workspace")})
        result = runner.invoke(main, ["launch", *map(str, words)])
        if result.exception is not None and not isinstance(result.exception, SystemExit):
            raise result.exception
        return result.stdout, result.stderr, result.exit_code

    return run


@contextmanager
def kit(workspace: Path, *words: str | Path) -> Iterator[subprocess.Popen[str]]:
    """``kit ...`` in a process of its own."""
    process = subprocess.Popen(
        [sys.executable, "-m", "kit", *map(str, words)],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env={**os.environ, "KIT_WORKSPACE": str(workspace)},
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


NODE = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import String

class {cls}(Node):
    def __init__(self):
        super().__init__("{name}")
{body}

def main(args=None):
    rclpy.init(args=args)
    rclpy.spin({cls}())
"""


class Workshop:
    """Writes small packages."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def package(self, name: str, launch: str, **programs: str) -> Path:
        """A package whose launch file holds these entities; each program is a module, or the body of a node."""
        folder = self.folder / name
        (folder / name).mkdir(parents=True)
        (folder / "launch").mkdir()
        (folder / "package.xml").write_text(f"<package><name>{name}</name></package>")
        points = [f"{program} = {name}.{program}:main" for program in programs]
        (folder / "setup.py").write_text(
            f"setup(name='{name}', entry_points={{'console_scripts': {points}}})"
        )
        (folder / name / "__init__.py").touch()
        for program, text in programs.items():
            if "def main" not in text:
                text = NODE.format(cls=program.title(), name=program, body=_body(text))
            (folder / name / f"{program}.py").write_text(text)
        (folder / "launch" / f"{name}.launch.py").write_text(
            "from launch import LaunchDescription\nfrom launch.actions import *\nfrom launch.conditions import *\n"
            "from launch.event_handlers import *; from launch.events import matches_action; from launch.events.process import *\n"
            "from launch.substitutions import *\n"
            "from launch_ros.actions import *\nfrom launch_ros.substitutions import *\n\n\n"
            f"def generate_launch_description():\n    return LaunchDescription([\n{indent(dedent(launch), ' ' * 8)}\n    ])\n"
        )
        return folder


def _body(text: str) -> str:
    """The rest of ``__init__``, and methods if there are any: those are written with four spaces."""
    if "\n    def " not in text:
        return indent(dedent(text), " " * 8)
    return text if text[0].isspace() else " " * 8 + text


@pytest.fixture
def workshop(tmp_path: Path) -> Workshop:
    return Workshop(tmp_path / "src")
