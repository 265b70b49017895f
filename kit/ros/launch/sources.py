"""Launch files on disk: loading them, in the process that carries them out."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType
from typing import Final

from kit.ros.launch.context import LaunchContext
from kit.ros.launch.entity import LaunchDescription
from kit.ros.launch.errors import LaunchError
from kit.ros.launch.substitutions import SomeText, normalize, perform

GENERATOR: Final = "generate_launch_description"


class LaunchDescriptionSource:
    """Where a launch description comes from: a Python launch file."""

    def __init__(self, launch_file_path: SomeText) -> None:
        self._path = normalize(launch_file_path)

    @property
    def location(self) -> str:
        return " + ".join(piece.describe() for piece in self._path)

    def path(self, context: LaunchContext) -> str:
        """The file. LaunchError if there is none."""
        path = Path(perform(context, self._path)).absolute()
        if not path.is_file():
            raise LaunchError(f"the launch file {path} does not exist")
        return str(path)

    def load(self, context: LaunchContext) -> LaunchDescription:
        """Runs the file and has it make its description. LaunchError, and what the file raises."""
        path = self.path(context)
        if path.endswith((".xml", ".yaml", ".yml")):
            raise LaunchError(f"{path}: the kit reads launch files in Python only, not in XML or YAML")
        module = ModuleType(Path(path).name.partition(".")[0])
        module.__file__ = path
        exec(compile(Path(path).read_bytes(), path, "exec", dont_inherit=True), module.__dict__)
        return description_of(module)


def description_of(module: ModuleType) -> LaunchDescription:
    """What the file's ``generate_launch_description`` returns. LaunchError."""
    generate = getattr(module, GENERATOR, None)
    if not callable(generate):
        raise LaunchError(f"{module.__file__}: there is no {GENERATOR}() in it")
    description = generate()
    if not isinstance(description, LaunchDescription):
        raise LaunchError(
            f"{module.__file__}: {GENERATOR}() must return a LaunchDescription, "
            f"not {type(description).__name__}"
        )
    return description
