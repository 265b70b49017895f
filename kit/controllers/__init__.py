"""Floor 4: controllers that come with the kit, each an ordinary ROS 2 node file that also runs on a robot."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from pathlib import Path

from kit.extensions import folders
from kit.plain_files import near_file
from kit.plain_text import unknown_name
from kit.workspace import Workspace, expand_home, open_workspace, unusable_workspace_error, write_atomically

FOLDER = Path(__file__).parent
TEMPLATE = FOLDER / "template.py"
FIRST_CONTROLLER = "my_controller.py"
PROGRAM_SUFFIXES = frozenset((".py", ""))
"""A program of ROS may be without an ending. What has another is no program, though a YAML file may read like one."""


@dataclass(frozen=True, slots=True)
class ControllerFile:
    """A node file that can drive a robot: its name, its file, and the first line of what it says of itself."""

    name: str
    file: Path
    title: str


def controller_title(file: Path) -> str:
    """The first line of a Python file's docstring, or nothing. The file is read, never run."""
    try:
        return (ast.get_docstring(ast.parse(file.read_bytes())) or "").partition("\n")[0]
    except (OSError, SyntaxError, ValueError, RecursionError, MemoryError):  # the last two: nested too deeply
        return ""


def kit_controllers() -> tuple[ControllerFile, ...]:
    """The kit's own controllers, the two that the kit opens with first, then the worked examples, then those of others'
    packages."""
    own = (FOLDER / f"{name}.py" for name in ("random_walk", "teleop", "teleop_pair", "fields", "abreast"))
    of_others = (file for _, folder in folders("controllers") for file in sorted(folder.glob("[!._]*.py")))
    names = [*own, *sorted((FOLDER / "examples").glob("*.py"))]
    names += [file for file in of_others if file.stem not in {each.stem for each in names}]
    return tuple(ControllerFile(file.stem, file, controller_title(file)) for file in names)


def user_controllers(folder: Path) -> tuple[ControllerFile, ...]:
    """The user's controllers: every ``.py`` file of ``folder``, by name."""
    files = sorted(
        file for file in folder.glob("*.py") if not file.name.startswith((".", "_")) and file.is_file()
    )
    return tuple(ControllerFile(file.stem, file, controller_title(file)) for file in files)


def find_controller(name: str, folder: Path | None = None) -> ControllerFile:
    """A controller by path, from here or from the user's ``folder``, or by name: theirs first, then the kit's own.

    Raises LookupError that names what there is.
    """
    path = expand_home(name)
    if path.suffix.lower() == ".py" or "/" in name or "\\" in name:
        places = [path, *([] if folder is None else [folder / path])]
        for file in places:
            if file.is_file() and file.suffix.lower() in PROGRAM_SUFFIXES:
                return ControllerFile(file.stem, file.absolute(), controller_title(file))
        if path.exists():
            raise LookupError(f"{name}: a controller is a Python file, NAME.py; this is {_kind_of(path)}.")
        tried = "" if folder is None or path.is_absolute() else f", neither here nor in {folder}"
        near_path = near_file(name)
        hint = f" Did you mean {near_path}?" if near_path else ""
        raise LookupError(f"{name}: there is no such file{tried}.{hint}")
    known = {item.name: item for item in (*kit_controllers(), *(user_controllers(folder) if folder else ()))}
    if name in known:
        return known[name]
    if path.exists():
        raise LookupError(f"{name}: a controller is a Python file, NAME.py; this is {_kind_of(path)}.")
    raise LookupError(unknown_name("controller", name, known))


def _kind_of(path: Path) -> str:
    if path.is_dir():
        return "a folder"
    return "a file of another kind" if path.is_file() else "not a regular file"


def prepare_workspace(folder: Path | None = None) -> Workspace:
    """Opens the user's workspace and copies a controller to start from into it where it has none.

    Files that exist are never overwritten. Raises WorkspaceError.
    """
    workspace = open_workspace(folder)
    if not any(workspace.controllers.glob("*.py")):
        try:
            write_atomically(workspace.controllers / FIRST_CONTROLLER, TEMPLATE.read_bytes())
        except OSError as error:
            raise unusable_workspace_error(workspace.folder, error) from None
    return workspace
