"""Finds the launch file that a command names, and runs it in a process of its own: sends it events, receives its requests."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, Literal, Protocol

from kit.host.failure import protocol_violation
from kit.host.output import ProgramOutput
from kit.host.process import HostedFile, StudentProcess
from kit.host.program_start import PackageProgram
from kit.host.protocol import Ended, Frame, Reply
from kit.host.sandbox.limits import INTERACTIVE_LIMITS, MIB
from kit.host.wire import Json, ProtocolError
from kit.launch.command_folder import with_commands
from kit.launch.launch_bounds import INTERACTIVE_BOUNDS, LaunchBounds
from kit.launch.requests import DeclaredArgument, Request, parse_request
from kit.plain_files import near_file
from kit.ros.packages import (
    LAUNCH_SUFFIXES,
    SEARCH_VARIABLE,
    Package,
    PackageError,
    broken_packages,
    find_packages,
    read_package,
)

LIMITS: Final = replace(INTERACTIVE_LIMITS, reply_s=10.0, frame=16 * MIB)


def declared_arguments(
    target: LaunchTarget, bounds: LaunchBounds = INTERACTIVE_BOUNDS, *, is_test: bool = False
) -> list[DeclaredArgument]:
    """The arguments that a launch file, or a test for launch_testing, declares, without carrying it out. Raises StudentCodeError."""
    only: Literal["launch", "test"] = "test" if is_test else "launch"
    with _start_child(target.file, target.folder, target.search, {}, bounds, only_arguments_of=only) as child:
        requests = _parse_requests(child, child.wait_started(), Ended)
    return [request for request in requests if isinstance(request, DeclaredArgument)]


class LaunchFile(Protocol):
    """What a launch needs of the process that runs its file. All failures are raised as StudentCodeError."""

    wake_ns: int | None
    """When its next timer is due [ns of the launch's time]; None without timers."""

    @property
    def is_busy(self) -> bool:
        """Whether the launch goes on for its sake, though no process runs."""

    def start(self) -> list[Request]:
        """Waits until the file is loaded; returns its first requests."""

    def advance(self, now_ns: int, events: list[Json]) -> list[Request]:
        """Sends events at a time of the launch; returns the requests that follow."""

    def end(self, events: list[Json]) -> None:
        """Sends the last events: every process has ended."""

    def exchange(self) -> list[Request] | None:
        """Exchanges messages, as a participant of the lock-step, and returns the requests that have come of its own accord; None
        if there was nothing to exchange."""

    def take_output(self) -> ProgramOutput:
        """Removes and returns what the file has printed."""

    def close(self) -> None:
        """Ends the process. May be called twice."""


class LaunchFileProcess(HostedFile):
    """One run of a launch file; the process starts with the constructor. All failures are raised as StudentCodeError."""

    def __init__(
        self,
        file: Path,
        folder: Path,
        search: Sequence[Path],
        arguments: Mapping[str, str],
        bounds: LaunchBounds = INTERACTIVE_BOUNDS,
    ) -> None:
        super().__init__(_start_child(file, folder, search, arguments, bounds))
        self.wake_ns: int | None = None

    @property
    def is_busy(self) -> bool:
        """Never: it acts only when it is told of something."""
        return False

    def start(self) -> list[Request]:
        """Waits until the file is loaded; returns its first requests."""
        return self._read_requests(self._process.wait_started())

    def advance(self, now_ns: int, events: list[Json]) -> list[Request]:
        """Sends events at a time of the launch; returns the requests that follow."""
        return self._read_requests(self._process.request("tick", now_ns, events))

    def end(self, events: list[Json]) -> None:
        """Does nothing: it acts only while its processes run."""

    def exchange(self) -> None:
        """Nothing: it has no nodes."""

    def _read_requests(self, frame: Frame | None) -> list[Request]:
        requests = _parse_requests(self._process, frame, Reply)
        self.wake_ns = frame.wake_ns if isinstance(frame, Reply) else None
        return requests


def _start_child(
    file: Path,
    folder: Path,
    search: Sequence[Path],
    arguments: Mapping[str, str],
    bounds: LaunchBounds,
    *,
    only_arguments_of: Literal["launch", "test"] | None = None,
) -> StudentProcess:
    # A bounded launch file sees neither the environment nor the user's working directory.
    environment = with_commands(os.environ) if bounds.is_interactive else {}
    package_program = PackageProgram(
        folder,
        Path.cwd() if bounds.is_interactive else folder,
        {**environment, SEARCH_VARIABLE: os.pathsep.join(map(str, search))},
    )
    start = {"seed": 0, "arguments": dict(arguments), "only_arguments_of": only_arguments_of}
    return StudentProcess(
        "launch",
        file,
        start,
        limits=bounds.file_limits or LIMITS,
        level=bounds.level,
        package=package_program,
    )


def _parse_requests(
    child: StudentProcess, frame: Frame | None, expected: type[Reply] | type[Ended]
) -> list[Request]:
    """Returns the requests of an answer: a launch file that runs replies, one that is only described has ended."""
    try:
        if not isinstance(frame, expected):
            raise ProtocolError("another kind of answer")
        return [parse_request(event) for event in frame.events]
    except (ProtocolError, TypeError) as problem:  # TypeError: too many or too few parts
        raise child.fail(protocol_violation(str(problem))) from None


SHARE_FOLDER: Final = Path(__file__).parent / "share"
"""The kit's copies of Flatland's packages: searched last, so that installed ones come first."""


@dataclass(frozen=True, slots=True)
class LaunchTarget:
    """A launch file with its package and search path."""

    file: Path
    folder: Path
    """The package's folder, or the file's own; messages name files relative to it."""
    search: tuple[Path, ...]
    """The folders in which packages are searched, in this order."""

    @property
    def name(self) -> str:
        """The name of the launch: ``maze`` for ``maze.launch.py``."""
        return self.file.name.partition(".")[0]


def find_launch_file(where: str, file: str | None, extra_folders: Iterable[Path]) -> LaunchTarget:
    """Finds the launch file that ``kit launch WHERE [FILE]`` means. ``extra_folders`` are searched for packages too.

    WHERE is a launch file, the folder of a package or of several, or a package's name. Raises PackageError.
    """
    path = Path(where).expanduser()
    extra_folders = (*extra_folders, SHARE_FOLDER)
    here = [Path.cwd(), Path.cwd() / "src", *extra_folders]
    if path.is_file():
        if path.suffix[1:] not in LAUNCH_SUFFIXES:
            raise PackageError(f"{where}: not a launch file; these are named NAME.launch.py, .xml or .yaml")
        if file is not None:
            raise PackageError(
                f"{where} is already a launch file, so {file!r} has no meaning; arguments look like NAME:=VALUE"
            )
        path = path.absolute()
        return _target_of(path, extra_folders)
    if not path.is_dir():
        packages = find_packages(here)
        if where not in packages:
            known = f" Packages found here: {', '.join(sorted(packages))}." if packages else ""
            known += "".join(f" One cannot be read: {reason}." for reason in broken_packages(here))
            near = near_file(where) or near_file(where, is_folder=True)
            hint = f" Did you mean {near}?" if near else ""
            raise PackageError(f"{where}: there is no such file, folder or package.{hint}{known}")
        path = packages[where]
    path = path.absolute()
    if (path / "package.xml").is_file():
        return _choose_launch_file(path, file, extra_folders)
    inside = find_packages([path])
    if len(inside) == 1:
        return _choose_launch_file(next(iter(inside.values())), file, extra_folders)
    if not inside:
        alone = sorted(found for suffix in LAUNCH_SUFFIXES for found in path.glob(f"*launch.{suffix}"))
        if len(alone) == 1 and file is None:
            return LaunchTarget(alone[0], path, _search_order(path, extra_folders))
        for reason in broken_packages([path]):
            raise PackageError(reason)
        raise PackageError(f"{path}: no package.xml here or below, so this is not a ROS 2 package")
    raise PackageError(
        f"{where}: it contains several packages: {', '.join(sorted(inside))}. Give the folder of one."
    )


def find_test_file(file: Path, extra_folders: Iterable[Path]) -> LaunchTarget:
    """A test for launch_testing as the launch file that it is. ``extra_folders`` are searched for packages too."""
    return _target_of(file.absolute(), (*extra_folders, SHARE_FOLDER))


def _target_of(file: Path, extra_folders: Iterable[Path]) -> LaunchTarget:
    """A launch file with the package in which it lies."""
    folder = next((each for each in file.parents if (each / "package.xml").is_file()), file.parent)
    return LaunchTarget(file, folder, _search_order(folder, extra_folders))


def _choose_launch_file(folder: Path, file: str | None, extra_folders: Iterable[Path]) -> LaunchTarget:
    package = read_package(folder)
    files = package.launch_files
    if file is not None:
        named = [each for each in files if each.name == file or str(each.relative_to(folder)) == file]
        if not named and (folder / file).is_file():
            named = [folder / file]
        if not named:
            raise PackageError(f"{folder}: it has no launch file {file}; available: {_names(files)}")
        return LaunchTarget(named[0], folder, _search_order(folder, extra_folders))
    if len(files) == 1:
        return LaunchTarget(files[0], folder, _search_order(folder, extra_folders))
    if not files:
        raise PackageError(
            f"{folder}: it has no launch file; none ends in launch.py, launch.xml or launch.yaml, here or in launch/."
            f"{_programs_text(package)}"
        )
    raise PackageError(f"{folder}: it has several launch files: {_names(files)}. Give one after the folder.")


def _programs_text(package: Package) -> str:
    """How its programs are run without a launch file; empty if it has none."""
    names = [each.name for each in package.executables]
    if not names:
        return ""
    run = f"`kit ros run {package.name} {names[0]}`"
    return (
        f" {run} runs its program."
        if len(names) == 1
        else f" {run} runs one of its programs: {', '.join(names)}."
    )


def _names(files: Sequence[Path]) -> str:
    return ", ".join(file.name for file in files) or "none"


def _search_order(folder: Path, extra_folders: Iterable[Path]) -> tuple[Path, ...]:
    """The package itself, then the folder that it lies in, whose other packages are its siblings; then the other folders.

    A folder that is no package has no siblings: above it may lie anything, up to the whole disk.
    """
    siblings = [folder.parent] if (folder / "package.xml").is_file() else []
    return tuple(dict.fromkeys([folder, *siblings, *extra_folders]))
