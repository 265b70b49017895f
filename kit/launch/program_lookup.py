"""Finds and starts what a launch file asks for: a program of the kit's own, a package's program, or a command."""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

from kit.host.failure import StudentCodeError
from kit.host.node_process import NodeProcess
from kit.host.program_start import PackageProgram
from kit.host.program_terminal import ProgramStreams
from kit.host.python_command import python_command
from kit.inspection.sockets import WORLD_VARIABLE
from kit.launch.command_folder import with_commands
from kit.launch.processes import (
    BuiltinProcess,
    CommandProcess,
    NodeProgramProcess,
    Process,
    ProcessStartError,
    ProgramUnavailable,
)
from kit.launch.requests import StartRequest, WorldRequest, parse_world_request
from kit.msg.interfaces import register_packages
from kit.ros.exceptions import InvalidRosArguments, NameValidationException, ParameterException
from kit.ros.graph.graph import Graph
from kit.ros.launch.unavailable import describe_unavailable
from kit.ros.packages import (
    SEARCH_VARIABLE,
    PackageError,
    find_packages,
    import_folders,
    interface_packages,
    missing_package,
    read_package,
    workspace_folders,
)

if TYPE_CHECKING:
    from kit.run.session import SceneAddition
from kit.launch.launch_bounds import INTERACTIVE_BOUNDS, LaunchBounds
from kit.launch.static_transform import publish_transform


@dataclass(frozen=True, slots=True)
class StartContext:
    """The graph, settings and callbacks needed to start a process."""

    graph: Graph
    search: tuple[Path, ...]
    seed: int
    log: Callable[[str], None]
    """Logs a line of the launch."""
    request_world: Callable[[WorldRequest], None]
    request_view: Callable[[], None]
    workspace: Path | None
    world: str
    """The name by which other terminals find the launch."""
    bounds: LaunchBounds = INTERACTIVE_BOUNDS
    streams: ProgramStreams | None = None
    """What a program that is run by hand reads and writes."""
    on_loaded: Callable[[], object] | None = None
    """Called when a program has been loaded, before it goes on into the graph; None: it need not wait for that."""
    add_to_scene: Callable[[SceneAddition], None] = lambda addition: None
    """Has something drawn with the world."""


def is_builtin(request: StartRequest) -> bool:
    """True if the kit brings the program itself."""
    return (request.package, request.executable) in BUILTIN_PROGRAMS


def start_process(request: StartRequest, context: StartContext) -> Process:
    """Starts the process that is asked for. Raises ProcessStartError."""
    start_builtin = BUILTIN_PROGRAMS.get((request.package, request.executable))
    if start_builtin is not None:
        return start_builtin(request, context)
    try:
        if request.package is not None and request.executable is not None:
            return _start_program(request.package, request.executable, request, context)
        return _start_command(request, context)
    except (PackageError, StudentCodeError) as problem:
        raise ProcessStartError(f"{request.where}{problem}") from None


# Builtin programs


def _start_builtin_world(request: StartRequest, context: StartContext) -> Process:
    wanted = parse_world_request(request)
    context.request_world(wanted)
    context.log(f"{request.name}: the kit's own world replaces flatland_server: {wanted.path}")
    return BuiltinProcess()


def _start_builtin_view(request: StartRequest, context: StartContext) -> Process:
    context.request_view()
    context.log(f"{request.name}: the kit's own view replaces {request.executable}")
    return BuiltinProcess()


def _start_static_transform(request: StartRequest, context: StartContext) -> Process:
    try:
        return BuiltinProcess(publish_transform(context.graph, request.command))
    except ValueError as problem:
        raise ProcessStartError(f"{request.where}{request.executable}: {problem}") from None


def _start_turtlesim(request: StartRequest, context: StartContext) -> Process:
    from kit.launch.turtlesim.node import PERIOD_S, TurtlesimNode

    world = Path(__file__).parent / "share" / "turtlesim" / "world" / "world.yaml"
    try:
        turtles = TurtlesimNode(context.graph, request.command)
    except (InvalidRosArguments, NameValidationException, ParameterException) as problem:
        raise ProcessStartError(f"{request.where}turtlesim_node: {problem}") from None
    try:
        context.request_world(WorldRequest(world, 1 / PERIOD_S, PERIOD_S, True, request.where, True))
    except ProcessStartError:
        context.log(f"{request.name}: this launch already has a world and does not show a second one")
    else:
        context.request_view()
        context.add_to_scene(turtles)
    return BuiltinProcess(turtles.node)


def _start_keep_alive(request: StartRequest, context: StartContext) -> Process:
    return BuiltinProcess()


BUILTIN_PROGRAMS: Final[
    Mapping[tuple[str | None, str | None], Callable[[StartRequest, StartContext], Process]]
] = MappingProxyType(
    {
        ("flatland_server", "flatland_server"): _start_builtin_world,
        ("flatland_viz", "flatland_viz"): _start_builtin_view,
        ("rviz2", "rviz2"): _start_builtin_view,
        ("rqt_graph", "rqt_graph"): _start_builtin_view,
        ("tf2_ros", "static_transform_publisher"): _start_static_transform,
        ("turtlesim", "turtlesim_node"): _start_turtlesim,
        ("launch_testing", "keep_alive"): _start_keep_alive,
    }
)
"""Functions that start the programs that the kit brings itself, by package and executable."""


_NAMES_ROS2: Final = re.compile(r"(?<![\w/.-])ros2(?![\w.-])")
"""The command ``ros2`` in a line for the shell, not a path that ends so."""


# A package's program


def _start_program(
    package_name: str, executable_name: str, request: StartRequest, context: StartContext
) -> Process:
    folders = find_packages(context.search)
    if package_name not in folders:
        _require_available(package_name, request)
        if request.is_component:
            raise ProgramUnavailable(
                f"{request.where}package '{package_name}' not found (for its composable node '{executable_name}')"
            )
        own = ", ".join(sorted({f"{package}/{name}" for package, name in BUILTIN_PROGRAMS}))
        missing = missing_package(package_name, context.search, f" (for its executable '{executable_name}')")
        raise ProcessStartError(f"{request.where}{missing} The kit itself has {own}.")
    package = read_package(folders[package_name])
    if not package.executables and package.source is None:
        raise ProgramUnavailable(
            f"{request.where}package '{package_name}' has no Python programs, and the kit runs no others "
            f"(wanted: '{executable_name}'); its build type is {package.build_type or 'not given'}"
        )
    find = package.component if request.is_component else package.executable
    executable = find(executable_name)
    assert package.source is not None
    package_program = PackageProgram(
        package.folder,
        # A bounded program may not see where the kit was started: at level 2 that folder does not exist for it.
        request.cwd or (Path.cwd() if context.bounds.is_interactive else package.folder),
        _environment(request, context),
        executable.entry,
        tuple(dict.fromkeys([package.source, *import_folders(folders.values())])),
        _register_interfaces(folders),
    )
    return _start_node_program(package.file_of(executable), request.command, package_program, context)


def _require_available(name: str, request: StartRequest) -> None:
    """Raises ProgramUnavailable for a package or program that the kit is known not to have."""
    what = describe_unavailable(name)
    if what is not None:
        raise ProgramUnavailable(f"{request.where}{name} is not in the kit: {what}")


def _register_interfaces(folders: Mapping[str, Path]) -> dict[str, Path]:
    """Makes the interfaces of the packages known to this process; returns the packages that have some."""
    found = interface_packages(folders)
    register_packages({name: str(folder) for name, folder in found.items()})
    return found


def _start_node_program(
    file: Path, arguments: Sequence[str], package_program: PackageProgram, context: StartContext
) -> Process:
    node_process = NodeProcess(
        context.graph,
        file,
        args=arguments,
        seed=context.seed,
        limits=context.bounds.limits,
        level=context.bounds.level,
        package=package_program,
        streams=context.streams,
        loads_first=context.on_loaded is not None,
    )
    return NodeProgramProcess(node_process, context.on_loaded, is_interruptible=context.bounds.is_interactive)


def _environment(request: StartRequest, context: StartContext) -> dict[str, str]:
    variables = _kit_variables(context.search, context.workspace, context.world)
    environment = {**request.environment, **variables}
    return with_commands(environment) if context.bounds.is_interactive else environment


def _kit_variables(search: tuple[Path, ...], workspace: Path | None, world: str) -> dict[str, str]:
    """What a program must know to find packages, the workspace and the running world."""
    variables = {SEARCH_VARIABLE: os.pathsep.join(map(str, search)), WORLD_VARIABLE: world}
    return variables | ({} if workspace is None else {"KIT_WORKSPACE": str(workspace)})


# A Python file


def program_of_file(
    file: Path, cwd: Path, search: tuple[Path, ...], workspace: Path | None, world: str
) -> PackageProgram:
    """A file that is run by its path, in this process's environment, with what the workspace around it offers when sourced."""
    search = _search_of_file(file, search)
    environment = {**os.environ, **_kit_variables(search, workspace, world)}
    return _program_of_file(file, cwd, search, with_commands(environment))


def _search_of_file(file: Path, search: tuple[Path, ...]) -> tuple[Path, ...]:
    """The folders in which packages are searched for it: those of its own workspace first."""
    return tuple(dict.fromkeys([*workspace_folders(file), *search]))


def _program_of_file(
    file: Path, cwd: Path, search: tuple[Path, ...], environment: Mapping[str, str]
) -> PackageProgram:
    folders = find_packages(search)
    return PackageProgram(
        file.parent,
        cwd,
        environment,
        imports=import_folders(folders.values()),
        interfaces=_register_interfaces(folders),
    )


# Other commands


def _start_command(request: StartRequest, context: StartContext) -> Process:
    if not context.bounds.commands:
        raise ProcessStartError(
            f"{request.where}'{' '.join(request.command)[:60]}' is not started here; the kit only starts programs of packages, "
            "with Node(package=..., executable=...)"
        )
    command = list(request.command) if request.executable is None else [request.executable, *request.command]
    cwd = request.cwd or Path.cwd()
    name = Path(command[0]).name if command else ""
    if name.startswith("python") and len(command) > 1 and command[1].endswith(".py") and not request.shell:
        file = (cwd / command[1]).absolute()
        context = replace(context, search=_search_of_file(file, context.search))
        package_program = _program_of_file(file, cwd, context.search, _environment(request, context))
        return _start_node_program(file, command[2:], package_program, context)
    if not request.shell:
        _require_available(name, request)
        installed = Path(command[0]).parts[-3:] if command else ()
        if len(installed) == 3 and installed[0] == "lib" and not Path(command[0]).exists():
            # What ExecutableInPackage answers: nothing is installed here.
            return _start_program(
                installed[1], installed[2], replace(request, command=tuple(command[1:])), context
            )
    is_ros2 = name == "ros2" and not request.shell
    names_ros2 = _NAMES_ROS2.search(" ".join(command)) is not None
    if is_ros2:
        context.log(f"{request.name}: `kit ros` replaces `ros2`")
        command = python_command("kit", "ros", *command[1:])
    elif names_ros2 and request.shell:
        context.log(f"{request.name}: `kit ros` replaces `ros2`")
        command = [f'ros2() {{ {shlex.join(python_command("kit", "ros"))} "$@"; }};', *command]
    try:
        return CommandProcess(
            command,
            shell=request.shell,
            environment=_environment(request, context),
            cwd=cwd,
            is_of_kit=is_ros2 or names_ros2,
        )
    except OSError as problem:
        raise ProcessStartError(
            f"{request.where}'{' '.join(command)}' cannot be started: {problem.strerror or problem}"
        ) from None
