"""Creates a new ROS 2 package, which the kit launches without a build and which colcon can build."""

from __future__ import annotations

import os
import re
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from string import Template
from typing import Final

from kit.controllers import FOLDER as CONTROLLERS
from kit.ros.packages import PackageError
from kit.world.catalogue import find_map

TEMPLATES: Final = Path(__file__).parent / "new_package"
NAME_PATTERN: Final = re.compile(r"[a-z][a-z0-9_]*")
RESERVED_NAMES: Final = frozenset(
    {"launch", "test", "rclpy", "std_msgs", "geometry_msgs", "sensor_msgs", "nav_msgs"}
)


def create_package(name: str, destination: Path, *, node: str = "driver", map_name: str = "simple") -> Path:
    """Creates a package in ``destination``, completely or not at all; returns its folder. Raises PackageError, UnknownMap.

    ``node``: the name of its program; ``map_name``: the map of the kit that is copied into its world.
    """
    for what, text in (("package", name), ("program", node)):
        if not NAME_PATTERN.fullmatch(text) or text in RESERVED_NAMES:
            raise PackageError(
                f"a {what} cannot be called '{text}': small letters, digits and underscores, a letter first, "
                "and no name that ROS 2 uses itself"
            )
    card = find_map(map_name)
    folder = destination / name
    if folder.exists():
        raise PackageError(f"{folder} is there already. Choose another name, or remove it.")
    try:
        destination.mkdir(parents=True, exist_ok=True)
        part = Path(tempfile.mkdtemp(dir=destination, prefix=f".{name}."))
        try:
            _write_files(part, name, node)
            _copy_world(card.world_file, part / "world")
            part.chmod(0o755)
            part.rename(folder)
        except BaseException:  # Ctrl-C too: no half-written package stays; raised again
            shutil.rmtree(part, ignore_errors=True)
            raise
    except OSError as problem:
        raise PackageError(f"{folder}: cannot be made ({problem.strerror})") from None
    return folder


def _write_files(folder: Path, name: str, node: str) -> None:
    user = re.sub(r"[^A-Za-z0-9_.-]", "", os.environ.get("USER", "")) or "me"
    words = {
        "name": name,
        "node": node,
        "maintainer": user,
        "email": f"{user}@example.org",
        "description": "A robot in a Flatland world",
        "license": "MIT",
    }
    for template, file in (
        ("package.xml", "package.xml"),
        ("setup.py", "setup.py"),
        ("setup.cfg", "setup.cfg"),
        ("launch.py", f"launch/{name}.launch.py"),
    ):
        text = Template((TEMPLATES / f"{template}.template").read_text(encoding="utf-8")).substitute(words)
        _write(folder / file, text)
    _write(folder / "resource" / name, "")
    _write(folder / name / "__init__.py", "")
    program = (CONTROLLERS / "random_walk.py").read_text(encoding="utf-8")
    _write(
        folder / name / f"{node}.py",
        program.replace('super().__init__("random_walk")', f'super().__init__("{node}")'),
    )


def _write(file: Path, text: str) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8")


def _copy_world(world_file: Path, folder: Path) -> None:
    """Copies a map's files into one folder; the world names its models relative to it."""
    folder.mkdir()
    text = world_file.read_text(encoding="utf-8")
    for found in _model_files(text):
        shutil.copy(world_file.parent / found, folder / Path(found).name)
        text = text.replace(found, Path(found).name)
    (folder / "world.yaml").write_text(text, encoding="utf-8")
    for path in world_file.parent.iterdir():
        if path.suffix in (".yaml", ".png", ".dat") and path.name not in ("world.yaml", "about.yaml"):
            shutil.copy(path, folder / path.name)


def _model_files(world: str) -> Iterator[str]:
    yield from sorted(set(re.findall(r"model:\s*(\S+\.yaml)", world)))
