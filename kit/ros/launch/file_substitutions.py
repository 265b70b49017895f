"""Substitutions that look at files, programs and packages."""

from __future__ import annotations

import shlex
import subprocess
from pathlib import Path
from typing import Final, Literal, get_args

from kit.ros.launch.context import LaunchContext, SubstitutionFailure
from kit.ros.launch.substitutions import (
    PathJoinSubstitution,
    SomeText,
    Substitution,
    describe_substitutions,
    normalize_to_substitutions,
    perform_substitutions,
)
from kit.ros.launch.unavailable import (
    UNAVAILABLE_FOLDER,
    describe_unavailable,
    require_available,
    require_available_path,
)
from kit.ros.packages import PackageError, read_package
from kit.ros.share_folders import share_folder

OnStderr = Literal["fail", "ignore", "warn", "capture"]
COMMAND_S: Final = 8.0
"""How long a command of a substitution may take [s]. Less than a launch file's process has for an answer
(``kit.launch.launch_file_process``): else that would be ended first, without a word about the command."""


class PathSubstitution(PathJoinSubstitution):
    """A path; ``/`` appends to it."""

    def __init__(self, path: SomeText) -> None:
        super().__init__([path])


class FileContent(Substitution):
    """The text of a file."""

    def __init__(self, path: SomeText) -> None:
        self.path = normalize_to_substitutions(path)

    def perform(self, context: LaunchContext) -> str:
        path = perform_substitutions(context, self.path)
        require_available_path(path)
        try:
            return Path(path).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as problem:
            reason = problem.strerror if isinstance(problem, OSError) else "it is not UTF-8 text"
            raise SubstitutionFailure(f"the file {path} cannot be read: {reason}") from None

    def describe(self) -> str:
        return f"FileContent({describe_substitutions(self.path)})"


class Command(Substitution):
    """What a command prints. ``on_stderr``: what is done when it prints errors."""

    def __init__(self, command: SomeText, *, on_stderr: SomeText = "fail") -> None:
        self.command, self.on_stderr = (
            normalize_to_substitutions(command),
            normalize_to_substitutions(on_stderr),
        )

    def perform(self, context: LaunchContext) -> str:
        text = perform_substitutions(context, self.command)
        on_stderr = perform_substitutions(context, self.on_stderr)
        if on_stderr not in get_args(OnStderr):
            raise SubstitutionFailure(f"on_stderr is '{on_stderr}': one of {', '.join(get_args(OnStderr))}")
        words = shlex.split(text)
        if not words:
            raise SubstitutionFailure("the command is empty")
        require_available(Path(words[0]).name)
        try:
            done = subprocess.run(
                words,
                capture_output=True,
                text=True,
                env=context.environment,
                stdin=subprocess.DEVNULL,
                timeout=COMMAND_S,
                check=False,
            )
        except OSError as problem:
            raise SubstitutionFailure(f"the command '{text}' cannot be run: {problem.strerror}") from None
        except subprocess.TimeoutExpired:
            raise SubstitutionFailure(
                f"the command '{text}' has not ended within {COMMAND_S:g} s: run it before the launch, and read what it "
                "makes with FileContent"
            ) from None
        if done.returncode:
            raise SubstitutionFailure(
                f"the command '{text}' failed with exit code {done.returncode}: {done.stderr.strip()[:400]}"
            )
        if done.stderr and on_stderr == "fail":
            raise SubstitutionFailure(f"the command '{text}' printed errors: {done.stderr.strip()[:400]}")
        if done.stderr and on_stderr == "warn":
            context.request(
                "log", "WARN", f"the command '{text}' printed errors: {done.stderr.strip()[:400]}"
            )
        return done.stdout + (done.stderr if on_stderr == "capture" else "")

    def describe(self) -> str:
        return f"Command({describe_substitutions(self.command)})"


class FindPackageShare(Substitution):
    """The share folder of a package: here the folder that its ``package.xml`` lies in."""

    def __init__(self, package: SomeText) -> None:
        self.package = normalize_to_substitutions(package)

    def perform(self, context: LaunchContext) -> str:
        name = perform_substitutions(context, self.package)
        try:
            return str(share_folder(name))
        except PackageError as problem:
            if describe_unavailable(name) is not None:
                return f"{UNAVAILABLE_FOLDER}/{name}"
            raise SubstitutionFailure(str(problem)) from None

    def describe(self) -> str:
        return f"{type(self).__name__}(pkg={describe_substitutions(self.package)})"

    def __truediv__(self, other: SomeText) -> PathJoinSubstitution:
        return PathJoinSubstitution([[self], other])


class FindPackagePrefix(FindPackageShare):
    """Where a package is installed: nothing is here, so the same folder."""


class ExecutableInPackage(FindPackageShare):
    """The path under which a package's program would be installed; ``ExecuteProcess`` starts the program itself."""

    def __init__(self, executable: SomeText, package: SomeText) -> None:
        super().__init__(package)
        self.executable = normalize_to_substitutions(executable)

    def perform(self, context: LaunchContext) -> str:
        folder, name = super().perform(context), perform_substitutions(context, self.executable)
        require_available_path(folder)
        try:
            package = read_package(Path(folder))
            package.executable(name)
        except PackageError as problem:
            raise SubstitutionFailure(str(problem)) from None
        return str(Path(folder, "lib", package.name, name))
