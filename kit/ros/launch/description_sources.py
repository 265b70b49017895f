"""Where a launch file includes another from: a file in Python, XML or YAML."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType
from typing import Final

from kit.ros.launch.context import LaunchContext, LaunchError
from kit.ros.launch.entity import (
    LaunchDescription,
)
from kit.ros.launch.substitutions import (
    SomeText,
    normalize_to_substitutions,
    perform_substitutions,
)
from kit.ros.launch.unavailable import require_available_path

GENERATOR_FUNCTION: Final = "generate_launch_description"
TEST_GENERATOR_FUNCTION: Final = "generate_test_description"
MARKUP_SUFFIXES: Final = (".xml", ".yaml", ".yml")
"""Suffixes of launch files that are not in Python."""


class LaunchDescriptionSource:
    """A launch file as the source of a launch description."""

    def __init__(self, launch_file_path: SomeText) -> None:
        self._path = normalize_to_substitutions(launch_file_path)

    @property
    def location(self) -> str:
        return " + ".join(piece.describe() for piece in self._path)

    def path(self, context: LaunchContext) -> str:
        """The absolute path of the file. Raises LaunchError if it does not exist."""
        path = Path(perform_substitutions(context, self._path)).absolute()
        require_available_path(str(path))
        if not path.is_file():
            raise LaunchError(f"the launch file {path} does not exist")
        return str(path)


def load_launch_file(context: LaunchContext, path: str) -> LaunchDescription:
    """Executes the file at ``path`` and returns its description. Raises LaunchError, and what the file raises."""
    if path.endswith(MARKUP_SUFFIXES):
        description: LaunchDescription = context.read_markup(path, Path(path).read_bytes())
        return description
    module = ModuleType(Path(path).name.partition(".")[0])
    module.__file__ = path
    exec(compile(Path(path).read_bytes(), path, "exec", dont_inherit=True), module.__dict__)
    return description_of(module, f"{path}: ")


def description_of(module: ModuleType, where: str = "") -> LaunchDescription:
    """Calls the module's ``generate_launch_description``. Raises LaunchError, whose message begins with ``where``."""
    generate = getattr(module, GENERATOR_FUNCTION, None)
    if not callable(generate):
        hint = ""
        if hasattr(module, TEST_GENERATOR_FUNCTION):
            hint = f", but {TEST_GENERATOR_FUNCTION}(): it is a test, which `kit ros launch_test` runs"
        raise LaunchError(f"{where}there is no {GENERATOR_FUNCTION}() in it{hint}")
    description = generate()
    if not isinstance(description, LaunchDescription):
        raise LaunchError(
            f"{where}{GENERATOR_FUNCTION}() must return a LaunchDescription, not {type(description).__name__}"
        )
    return description
