"""Creates a new ROS 2 package, which the kit launches without a build and which colcon can build."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from string import Template
from typing import Final

import yaml

from kit.controllers import FOLDER as CONTROLLERS
from kit.geometry import Pose
from kit.ros.packages import PackageError
from kit.workspace import draft_folder
from kit.world.catalogue import find_map

TEMPLATES: Final = Path(__file__).parent / "new_package"
NAME_PATTERN: Final = re.compile(r"[a-z][a-z0-9_]*")
DEPENDENCIES: Final = (
    "rclpy",
    "geometry_msgs",
    "sensor_msgs",
    "flatland_msgs",
    "flatland_server",
    "launch_ros",
)
FILE_PATTERN: Final = re.compile(r"[\w./-]+\.(?:yaml|yml|png|pgm|bmp|jpe?g|dat)\b")
RESERVED_NAMES: Final = frozenset(
    {"launch", "test", "rclpy", "std_msgs", "geometry_msgs", "sensor_msgs", "nav_msgs"}
)


@dataclass(frozen=True, slots=True)
class PackageOwner:
    """Who maintains a package, and under which licence; the account of this machine where nobody is named."""

    name: str = ""
    email: str = ""
    license: str = "MIT"


ACCOUNT = PackageOwner()


@dataclass(frozen=True, slots=True)
class PackageFrame:
    """What a package is called, what it needs, and which folders it installs."""

    name: str
    program: str
    description: str
    dependencies: tuple[str, ...]
    """Packages that it needs when it runs."""
    data_folders: tuple[str, ...]
    """Folders that are installed besides the code."""
    owner: PackageOwner = ACCOUNT


def create_package(
    name: str,
    destination: Path,
    *,
    node: str = "driver",
    map_name: str = "simple",
    dependencies: Sequence[str] = (),
    description: str = "",
    owner: PackageOwner = ACCOUNT,
) -> Path:
    """Creates a package in ``destination``, completely or not at all; returns its folder. Raises PackageError, UnknownMap.

    ``node``: the name of its program; ``map_name``: the map of the kit that is copied into its world; ``dependencies``:
    packages besides those that the program needs.
    """
    card = find_map(map_name)
    needed = tuple(dict.fromkeys((*DEPENDENCIES, *dependencies)))
    for each in dependencies:
        if not NAME_PATTERN.fullmatch(each):
            raise PackageError(f"'{each}' cannot be the name of a package that this one depends on")
    frame = PackageFrame(
        name, node, description or "A robot in a Flatland world", needed, ("launch", "world"), owner
    )
    with new_package_folder(name, destination, node) as folder:
        write_package_frame(folder, frame)
        text = Template((TEMPLATES / "launch.py.template").read_text(encoding="utf-8"))
        _write_new_file(folder / "launch" / f"{name}.launch.py", text.substitute(name=name, node=node))
        program = (CONTROLLERS / "random_walk.py").read_text(encoding="utf-8")
        _write_new_file(
            folder / name / f"{node}.py",
            program.replace('super().__init__("random_walk")', f'super().__init__("{node}")'),
        )
        copy_world(card.world_file, folder / "world")
    return destination / name


@contextmanager
def new_package_folder(name: str, destination: Path, program: str) -> Iterator[Path]:
    """Yields a folder to fill, which becomes the package's when that has gone well; else nothing stays.

    Raises PackageError for a name that cannot be, a folder that is there, and one that cannot be written.
    """
    for what, text in (("package", name), ("program", program)):
        if not NAME_PATTERN.fullmatch(text) or text in RESERVED_NAMES:
            raise PackageError(
                f"a {what} cannot be named '{text}': use lower-case letters, digits and underscores, a letter first, "
                "and no name that ROS 2 uses itself"
            )
    folder = destination / name
    if folder.exists():
        raise PackageError(f"{folder} already exists. Choose another name, or remove it.")
    try:
        destination.mkdir(parents=True, exist_ok=True)
        with draft_folder(destination) as draft:
            yield draft
            draft.rename(folder)
    except OSError as problem:
        raise PackageError(f"{folder}: cannot be created ({problem.strerror})") from None


def write_package_frame(folder: Path, frame: PackageFrame) -> None:
    """Writes what every package of the build type ament_python has; its program and its data are the caller's."""
    user = re.sub(r"[^A-Za-z0-9_.-]", "", os.environ.get("USER", "")) or "me"
    maintainer, email = frame.owner.name or user, frame.owner.email or f"{user}@example.org"
    installed = "".join(
        f"\n        ('share/' + package_name + '/{each}', glob('{each}/*'))," for each in frame.data_folders
    )
    words = {
        "name": frame.name,
        "node": frame.program,
        # They go into XML and Python.
        "maintainer": re.sub(r"[^\w .-]", "", maintainer),
        "email": re.sub(r"[^\w.@+-]", "", email),
        "description": re.sub(r"[^\w ,.()-]", "", frame.description),
        "license": re.sub(r"[^\w ,.()+-]", "", frame.owner.license),
        "dependencies": "\n".join(f"  <exec_depend>{each}</exec_depend>" for each in frame.dependencies),
        "installed": installed,
    }
    for file in ("package.xml", "setup.py", "setup.cfg"):
        text = Template((TEMPLATES / f"{file}.template").read_text(encoding="utf-8")).substitute(words)
        _write_new_file(folder / file, text)
    _write_new_file(folder / "resource" / frame.name, "")
    _write_new_file(folder / frame.name / "__init__.py", "")


def _write_new_file(file: Path, text: str) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text, encoding="utf-8")


def copy_world(world_file: Path, folder: Path) -> None:
    """Copies a world and the files that it names, and those that they name, into one folder; ``world.yaml`` is the world."""
    folder.mkdir()
    _copy_with_references(world_file.resolve(), folder, {world_file.resolve(): "world.yaml"})


def place_models(world_file: Path, poses: Mapping[str, Pose]) -> None:
    """Writes other poses of models into a world file; the rest of it stays as it is."""
    text = world_file.read_text(encoding="utf-8")
    root = yaml.compose(text, Loader=yaml.SafeLoader)
    assert isinstance(root, yaml.MappingNode)  # a world that has been read
    changes = [
        change
        for key, models in root.value
        if key.value == "models"
        for model in models.value
        if (change := _change_of_pose(model, poses)) is not None
    ]
    for first, end, new in sorted(changes, reverse=True):
        text = text[:first] + new + text[end:]
    world_file.write_text(text, encoding="utf-8")


def _change_of_pose(model: yaml.MappingNode, poses: Mapping[str, Pose]) -> tuple[int, int, str] | None:
    """Which characters of the file give way to what, for one model of it; None where its pose stays."""
    keys = {key.value: (key, value) for key, value in model.value}
    if keys["name"][1].value not in poses:
        return None
    pose = poses[keys["name"][1].value]
    new = f"[{pose.x:.6g}, {pose.y:.6g}, {pose.theta:.6g}]"
    if "pose" in keys:
        value = keys["pose"][1]
        return value.start_mark.index, value.end_mark.index, new if value.flow_style else f"{new}\n"
    key, value = keys["name"]
    before = ", " if model.flow_style else "\n" + " " * key.start_mark.column
    return value.end_mark.index, value.end_mark.index, f"{before}pose: {new}"


def _copy_with_references(file: Path, folder: Path, names: dict[Path, str]) -> None:
    """``names``: what has a name in ``folder`` already."""
    if file.suffix not in (".yaml", ".yml"):
        shutil.copy(file, folder / names[file])
        return

    def rename(found: re.Match[str]) -> str:
        other = (file.parent / found[0]).resolve()
        if not other.is_file():
            return found[0]
        if other not in names:
            name = other.name if other.name not in names.values() else f"{other.parent.name}_{other.name}"
            names[other] = name
            _copy_with_references(other, folder, names)
        return names[other]

    text = FILE_PATTERN.sub(rename, file.read_text(encoding="utf-8"))
    (folder / names[file]).write_text(text, encoding="utf-8")
