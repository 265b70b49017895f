"""What a request to start a process means: which of the kit's own things, whose program, or which command."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Final

from kit.host.failure import GuestError
from kit.host.node_process import Guest
from kit.host.package_program import Installed
from kit.host.sandbox.confinement import DESK_LEVEL, Level
from kit.host.sandbox.limits import DESK, GIB, MIB, Limits
from kit.inspection.world_sockets import WORLD_VARIABLE
from kit.launch.errors import CannotStart
from kit.launch.processes import CommandProcess, GuestProcess, OwnNode, Process, kit_command
from kit.launch.requests import Start
from kit.launch.static_transform import publish_transform
from kit.launch.world import WorldWanted, world_wanted
from kit.ros.graph.graph import Graph
from kit.ros.packages import SEARCH_VARIABLE, PackageError, find_packages, read_package

PROGRAM_LIMITS: Final = replace(
    DESK,
    start_s=120.0,
    reply_s=20.0,
    memory=32 * GIB,
    open_files=1024,
    file_size=4 * GIB,
    output=MIB,
    frame=16 * MIB,
)
"""Of a package's program: it may import a learning library and train."""


@dataclass(frozen=True, slots=True)
class Bounds:
    """How far what a launch starts is bounded. The defaults are the desk's: it is its user's own."""

    level: Level = DESK_LEVEL
    limits: Limits = PROGRAM_LIMITS
    file_limits: Limits | None = None
    """Of the launch file's own process; None: the usual ones."""
    commands: bool = True
    """Whether anything but packages' programs may be run."""
    most: int | None = None
    """Processes that one launch may start."""


DESK_BOUNDS: Final = Bounds()


@dataclass(frozen=True, slots=True)
class Means:
    """What is needed to start something."""

    graph: Graph
    search: tuple[Path, ...]
    seed: int
    say: Callable[[str], None]
    """A line in the launch's log."""
    want_world: Callable[[WorldWanted], None]
    want_view: Callable[[], None]
    workspace: Path | None
    world: str
    """What other terminals call this launch."""
    bounds: Bounds = DESK_BOUNDS


def is_ours(request: Start) -> bool:
    """Whether the kit has something of its own for it."""
    return (request.package, request.executable) in STAND_INS


def start(request: Start, means: Means) -> Process:
    """Starts it. Raises CannotStart."""
    stand_in = STAND_INS.get((request.package, request.executable))
    if stand_in is not None:
        return stand_in(request, means)
    try:
        if request.package is not None and request.executable is not None:
            return _start_program(request.package, request.executable, request, means)
        return _start_command(request, means)
    except (PackageError, GuestError) as problem:
        raise CannotStart(f"{request.where}{problem}") from None


# What the kit has itself


def _be_the_world(request: Start, means: Means) -> Process:
    wanted = world_wanted(request)
    means.want_world(wanted)
    means.say(f"{request.name}: the kit's own world stands in for flatland_server: {wanted.path}")
    return OwnNode()


def _be_the_view(request: Start, means: Means) -> Process:
    means.want_view()
    means.say(f"{request.name}: the kit's own view stands in for {request.executable}")
    return OwnNode()


def _publish_a_transform(request: Start, means: Means) -> Process:
    try:
        return OwnNode(publish_transform(means.graph, request.command))
    except ValueError as problem:
        raise CannotStart(f"{request.where}{request.executable}: {problem}") from None


STAND_INS: Final[Mapping[tuple[str | None, str | None], Callable[[Start, Means], Process]]] = (
    MappingProxyType(
        {
            ("flatland_server", "flatland_server"): _be_the_world,
            ("flatland_viz", "flatland_viz"): _be_the_view,
            ("rviz2", "rviz2"): _be_the_view,
            ("rqt_graph", "rqt_graph"): _be_the_view,
            ("tf2_ros", "static_transform_publisher"): _publish_a_transform,
        }
    )
)
"""By package and executable."""


# A package's program


def _start_program(package_name: str, executable_name: str, request: Start, means: Means) -> Process:
    folders = find_packages(means.search)
    if package_name not in folders:
        own = ", ".join(sorted({f"{package}/{name}" for package, name in STAND_INS}))
        there = ", ".join(sorted(folders)) or "none"
        raise CannotStart(
            f"{request.where}package '{package_name}' not found (for its executable '{executable_name}'). "
            f"Packages found: {there}. The kit itself has {own}."
        )
    package = read_package(folders[package_name])
    if not package.executables and package.source is None:
        raise CannotStart(
            f"{request.where}package '{package_name}' has no programs in Python: the kit runs no others "
            f"(wanted: '{executable_name}')"
        )
    executable = package.executable(executable_name)
    sources = [read_package(folder).source for folder in folders.values()]
    assert package.source is not None
    installed = Installed(
        package.folder,
        request.cwd or Path.cwd(),
        _environment(request, means),
        f"{executable.module}:{executable.function}",
        tuple(dict.fromkeys([package.source, *(source for source in sources if source is not None)])),
    )
    return _guest(package.file_of(executable), request.command, installed, means)


def _guest(file: Path, arguments: Sequence[str], installed: Installed, means: Means) -> Process:
    guest = Guest(
        means.graph,
        file,
        args=arguments,
        seed=means.seed,
        limits=means.bounds.limits,
        level=means.bounds.level,
        installed=installed,
    )
    return GuestProcess(guest)


def _environment(request: Start, means: Means) -> dict[str, str]:
    ours = {SEARCH_VARIABLE: os.pathsep.join(map(str, means.search)), WORLD_VARIABLE: means.world}
    if means.workspace is not None:
        ours["KIT_WORKSPACE"] = str(means.workspace)
    return {**request.environment, **ours}


# Any other command


def _start_command(request: Start, means: Means) -> Process:
    if not means.bounds.commands:
        raise CannotStart(
            f"{request.where}'{' '.join(request.command)[:60]}' is not started here: only programs of packages are, "
            "with Node(package=..., executable=...)"
        )
    command = list(request.command) if request.executable is None else [request.executable, *request.command]
    cwd = request.cwd or Path.cwd()
    name = Path(command[0]).name if command else ""
    if name.startswith("python") and len(command) > 1 and command[1].endswith(".py") and not request.shell:
        file = (cwd / command[1]).absolute()
        installed = Installed(file.parent, cwd, _environment(request, means))
        return _guest(file, command[2:], installed, means)
    if name == "ros2" and not request.shell:
        means.say(f"{request.name}: `kit ros` stands in for `ros2`")
        command = kit_command(["ros", *command[1:]])
    try:
        return CommandProcess(command, shell=request.shell, environment=_environment(request, means), cwd=cwd)
    except OSError as problem:
        raise CannotStart(
            f"{request.where}'{' '.join(command)}' cannot be started: {problem.strerror or problem}"
        ) from None
