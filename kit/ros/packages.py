"""Finds and reads ROS 2 packages on disk without building them: their names, programs and launch files.

Nothing of a package is run: its ``setup.py`` is read as a syntax tree. A package's *share* folder is its own
folder here, so that ``world/x.yaml`` lies where an installed package would have it.
"""

from __future__ import annotations

import ast
import configparser
import os
import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final
from xml.etree import ElementTree

from kit.plain_files import read_plain_file
from kit.plain_text import quoted

MAX_NESTING: Final = 8
"""How many folders above a program's file its package's may be."""

MAX_DEPTH: Final = 3
"""Depth to which search folders are searched for packages, as in a workspace: ``src/group/package``."""

MAX_VALUE_SIZE: Final = 100_000
"""Letters or entries of a value that a ``setup.py`` puts together."""

MAX_MANIFEST_BYTES: Final = 1 << 20
"""Size of each of the files that describe a package."""

MAX_NAME_LENGTH: Final = 100
_NAME: Final = re.compile(rf"[A-Za-z0-9][\w.-]{{0,{MAX_NAME_LENGTH - 1}}}", re.ASCII)
"""Of a package: it is that of a folder too."""

SOURCE_FOLDERS: Final = ("src", "packages")
"""The folders of a workspace in which its packages lie: of colcon's, and of the kit's own."""

SEARCH_VARIABLE: Final = "KIT_PACKAGE_PATH"
"""Environment variable with the folders in which packages are searched."""

LAUNCH_VARIABLE: Final = "KIT_LAUNCH_FILE"
"""Environment variable that is set in a process that carries out a launch file."""

LAUNCH_SUFFIXES: Final = ("py", "xml", "yaml", "yml")
"""How the names of launch files end."""

INTERFACE_FOLDERS: Final = ("msg", "srv", "action")
"""The folders of a package that hold its definitions of messages, services and actions."""

_INSTALLED_PROGRAMS: Final = re.compile(r"install\s*\(\s*PROGRAMS\s([^()]*)\)", re.IGNORECASE)

CONSOLE_SCRIPTS: Final = "console_scripts"
"""The group of entry points in which a package names its programs."""

COMPONENT_GROUP: Final = "rclpy_components"
"""The group in which a package in Python names its composable nodes."""

_GROUPS: Final = (CONSOLE_SCRIPTS, COMPONENT_GROUP)

_COMPONENT_PLACE: Final = re.compile(r"(?P<module>\w+(?:(?:\.|::)\w+)*)(?:::|:|\.)(?P<class>\w+)")

IGNORE_MARKERS: Final = ("COLCON_IGNORE", "AMENT_IGNORE")
"""Folders with one of these files are skipped, as by colcon."""


class PackageError(Exception):
    """A package cannot be read or found; the message names the file, the line and what to do."""


@dataclass(frozen=True, slots=True)
class PackageExecutable:
    """A program of a package, started by ``ros2 run PACKAGE NAME``."""

    name: str
    module: str
    function: str
    script: Path | None = None
    """The file that is run as it is, as CMake installs it; then there are no module and function."""

    @property
    def entry(self) -> str | None:
        """``package.module:function``; None for a script."""
        return None if self.script is not None else f"{self.module}:{self.function}"


@dataclass(frozen=True, slots=True)
class Package:
    name: str
    folder: Path
    version: str = "0.0.0"
    description: str = ""
    build_type: str = ""
    executables: tuple[PackageExecutable, ...] = ()
    source: Path | None = None
    """The folder its modules are imported from; None if it has no programs in Python."""
    components: tuple[PackageExecutable, ...] = ()
    """The classes that it offers as composable nodes, by their plugin names."""

    @property
    def launch_files(self) -> tuple[Path, ...]:
        """Launch files in its folder or in ``launch``, in Python, XML or YAML, sorted by name."""
        patterns = [f"*launch.{suffix}" for suffix in LAUNCH_SUFFIXES]
        found = [
            path
            for pattern in patterns
            for start in ("", "launch/**/")
            for path in self.folder.glob(start + pattern)
        ]
        return tuple(sorted(found, key=lambda path: (path.name, path)))

    def executable(self, name: str) -> PackageExecutable:
        """The program of this name. Raises PackageError, which lists the existing ones."""
        for each in self.executables:
            if each.name == name:
                return each
        there = ", ".join(each.name for each in self.executables) or "none"
        raise PackageError(f"package '{self.name}' has no executable '{name}'; it has: {there}")

    def component(self, plugin: str) -> PackageExecutable:
        """The class of a composable node, by its plugin name or by ``module:Class``. Raises PackageError."""
        for each in self.components:
            if each.name == plugin:
                return each
        place = _COMPONENT_PLACE.fullmatch(plugin)
        if place is not None:
            found = PackageExecutable(plugin, place["module"].replace("::", "."), place["class"])
            try:
                self.file_of(found)
            except PackageError:
                pass  # reported with the names that there are
            else:
                return found
        there = ", ".join(each.name for each in self.components) or f"write {self.name}.MODULE:CLASS"
        raise PackageError(
            f"package '{self.name}' has no composable node '{plugin}' in Python; it has: {there}"
        )

    def file_of(self, executable: PackageExecutable) -> Path:
        """The file of a program's module. Raises PackageError."""
        if executable.script is not None:
            return executable.script
        source = self.source or self.folder
        base = source.joinpath(*executable.module.split("."))
        for path in (base.with_suffix(".py"), base / "__init__.py"):
            if path.is_file():
                return path
        raise PackageError(
            f"package '{self.name}': executable '{executable.name}' is the module '{executable.module}', "
            f"but there is no {base.with_suffix('.py')}"
        )


def read_package(folder: Path) -> Package:
    """Reads the package in a folder with a ``package.xml``. Raises PackageError."""
    file = folder / "package.xml"
    try:
        root = _parse(file)
    except FileNotFoundError:
        raise PackageError(f"{folder}: no package.xml here, so this is not a ROS 2 package") from None
    except OSError as problem:
        raise PackageError(f"{file}: {problem.strerror}") from None
    name = (root.findtext("name") or "").strip()
    if not name:
        raise PackageError(f"{file}: the package has no <name>")
    executables, components, source = _read_programs(folder)
    return Package(
        name,
        folder,
        (root.findtext("version") or "0.0.0").strip(),
        " ".join((root.findtext("description") or "").split()),
        (root.findtext("export/build_type") or "").strip(),
        executables,
        source,
        components,
    )


def find_packages(folders: Iterable[Path]) -> dict[str, Path]:
    """The folders of the packages in and below some folders, by name; the first of a name counts."""
    found: dict[str, Path] = {}
    for start in folders:
        for folder in _package_folders(start, MAX_DEPTH):
            try:
                name = (_parse(folder / "package.xml").findtext("name") or "").strip()
            except (OSError, PackageError):
                continue  # reading it by its folder reports the error
            found.setdefault(name, folder)
    found.pop("", None)
    return found


def workspace_folders(file: Path) -> tuple[Path, ...]:
    """The folders in which the packages lie that a program's file sees when its workspace is sourced: its own package first.

    A file in no package sees the packages of the workspace in which it lies: those of the nearest folder above it that
    has some in ``src`` or ``packages``, or, of its own folder, beside it. None if there are none.
    """
    package = next((each for each in file.parents[:MAX_NESTING] if (each / "package.xml").is_file()), None)
    if package is not None:
        source = next((each for each in package.parents[:MAX_DEPTH] if each.name == "src"), package.parent)
        return (package, source)
    if any(file.parent.glob("*/package.xml")):
        return (file.parent,)
    above = (each / name for each in file.parents[:MAX_NESTING] for name in SOURCE_FOLDERS)
    return next(((each,) for each in above if any(True for _ in _package_folders(each, MAX_DEPTH))), ())


def import_folders(packages: Iterable[Path]) -> tuple[Path, ...]:
    """The folders from which the Python modules of some packages are imported; of one that cannot be read, its own."""
    found: dict[Path, None] = {}
    for folder in packages:
        try:
            package = read_package(folder)
        except PackageError:
            found[folder] = None
            continue
        if package.source is not None or (folder / package.name / "__init__.py").is_file():
            found[package.source or folder] = None
    return tuple(found)


def broken_packages(folders: Iterable[Path]) -> Iterator[str]:
    """Why each package in and below some folders that has no readable ``package.xml`` cannot be found: its file and line."""
    for folder in dict.fromkeys(each for start in folders for each in _package_folders(start, MAX_DEPTH)):
        try:
            _parse(folder / "package.xml")
        except PackageError as problem:
            yield str(problem)
        except OSError:
            continue


def _parse(file: Path) -> ElementTree.Element:
    """Reads a ``package.xml``. Raises PackageError for what is no XML, with its place, and for a name that cannot be a folder's;
    and OSError."""
    try:
        root = ElementTree.fromstring(read_plain_file(file, MAX_MANIFEST_BYTES))
    except ElementTree.ParseError as problem:
        raise _broken_xml(file, problem) from None
    except (LookupError, ValueError) as problem:  # the encoding that its first line names
        raise PackageError(f"{file}:1: broken XML: {problem}; write it in UTF-8") from None
    name = (root.findtext("name") or "").strip()
    if name and not _NAME.fullmatch(name):
        raise PackageError(
            f"{file}: {quoted(name[:MAX_NAME_LENGTH])} is no name of a package: it may have letters, digits, '_', '-' and '.', at "
            f"most {MAX_NAME_LENGTH}"
        )
    return root


def read_manifest_texts(folder: Path, tag: str) -> tuple[str, ...]:
    """The texts of all elements of this tag in a package's manifest. Raises PackageError."""
    return tuple("".join(each.itertext()).strip() for each in _parse(folder / "package.xml").iter(tag))


def _broken_xml(file: Path, problem: ElementTree.ParseError) -> PackageError:
    line, column = problem.position
    # expat's own message ends with the place in a form of its own.
    return PackageError(f"{file}:{line}:{column + 1}: broken XML: {problem.msg.partition(': line')[0]}")


def missing_package(name: str, folders: Sequence[Path], for_what: str = "") -> PackageError:
    """The error for a package that cannot be found: what there is, and which packages cannot be read."""
    there = ", ".join(sorted(find_packages(folders))) or "none"
    broken = "".join(f" It may be this one: {reason}." for reason in broken_packages(folders))
    return PackageError(f"package '{name}' not found{for_what}; available: {there}.{broken}")


def interface_packages(packages: Mapping[str, Path]) -> dict[str, Path]:
    """The packages, by name, that define messages, services or actions of their own."""
    return {
        name: folder
        for name, folder in packages.items()
        if any(True for part in INTERFACE_FOLDERS for _ in folder.glob(f"{part}/*.{part}"))
    }


def search_folders() -> list[Path]:
    """The folders in which this program searches for packages."""
    return [Path(entry) for entry in os.environ.get(SEARCH_VARIABLE, "").split(os.pathsep) if entry]


def _package_folders(folder: Path, deep: int) -> Iterator[Path]:
    try:
        with os.scandir(folder) as listed:  # once: a folder may have hundreds of others below it
            entries = {entry.name: entry for entry in listed}
    except OSError:
        return
    if any(name in entries for name in IGNORE_MARKERS):
        return
    if "package.xml" in entries and _is(entries["package.xml"].is_file):
        yield folder
        return
    if deep == 0:
        return
    for name in sorted(entries):
        if not name.startswith(".") and _is(entries[name].is_dir):
            yield from _package_folders(folder / name, deep - 1)


def _is(kind: Callable[[], bool]) -> bool:
    """Whether an entry is of a kind; False for a link that leads where this user may not look."""
    try:
        return kind()
    except OSError:
        return False


# Programs


def _read_programs(
    folder: Path,
) -> tuple[tuple[PackageExecutable, ...], tuple[PackageExecutable, ...], Path | None]:
    """The Python programs of a package, its composable nodes in Python, and the folder of their modules."""
    lines: dict[str, list[str]] = {group: [] for group in _GROUPS}
    source: Path | None = None
    setup = folder / "setup.py"
    if setup.is_file():
        arguments = _setup_arguments(setup)
        entry_points = arguments.get("entry_points", {})
        if isinstance(entry_points, Mapping):
            for group, found in lines.items():
                found += _strings(entry_points.get(group, ()))
        directories = arguments.get("package_dir")
        source = folder / str(directories.get("", "")) if isinstance(directories, Mapping) else folder
    if (folder / "setup.cfg").is_file():
        for group, found in lines.items():
            found += _from_configuration(folder / "setup.cfg", group)
        source = source or folder
    if (folder / "pyproject.toml").is_file():
        for group, found in lines.items():
            found += _from_project(folder / "pyproject.toml", group)
        source = source or folder
    scripts = _from_cmake(folder / "CMakeLists.txt") if (folder / "CMakeLists.txt").is_file() else ()
    if scripts:
        source = source or folder
    programs, components = ([_executable(line, folder) for line in found] for found in lines.values())
    return (*programs, *scripts), tuple(components), source


def _executable(line: str, folder: Path) -> PackageExecutable:
    name, equals, target = (part.strip() for part in line.partition("="))
    module, colon, function = (part.strip() for part in target.partition(":"))
    if not (name and equals and module and colon and function):
        raise PackageError(
            f"{folder / 'setup.py'}: the entry point '{line}' must look like 'name = package.module:function'"
        )
    return PackageExecutable(name, module, function)


def _strings(found: Any) -> list[str]:
    if isinstance(found, str):
        return [line for line in found.splitlines() if line.strip()]
    return [entry for entry in found if isinstance(entry, str)] if isinstance(found, Sequence) else []


def _from_configuration(file: Path, group: str) -> list[str]:
    parser = configparser.ConfigParser(interpolation=None)
    try:
        parser.read_string(read_plain_file(file, MAX_MANIFEST_BYTES).decode())
    except (OSError, ValueError, configparser.Error) as problem:
        raise PackageError(f"{file}: {' '.join(str(problem).split())}") from None
    return _strings(parser.get("options.entry_points", group, fallback=""))


def _from_cmake(file: Path) -> tuple[PackageExecutable, ...]:
    """The Python scripts that a package built by CMake installs as programs."""
    try:
        text = re.sub(r"#.*", "", read_plain_file(file, MAX_MANIFEST_BYTES).decode())
    except (OSError, ValueError) as problem:
        raise PackageError(f"{file}: {problem}") from None
    words = [
        word.strip('"') for found in _INSTALLED_PROGRAMS.findall(text) for word in _before_destination(found)
    ]
    paths = [file.parent / word for word in words if "$" not in word and word.endswith(".py")]
    return tuple(PackageExecutable(path.name, "", "", path) for path in paths if path.is_file())


def _before_destination(arguments: str) -> list[str]:
    words = arguments.split()
    return words[: words.index("DESTINATION")] if "DESTINATION" in words else []


def _from_project(file: Path, group: str) -> list[str]:
    try:
        points: Any = tomllib.loads(read_plain_file(file, MAX_MANIFEST_BYTES).decode())
    except (OSError, ValueError, RecursionError) as problem:
        raise PackageError(f"{file}: {problem}") from None
    for key in ("project", *(("scripts",) if group == CONSOLE_SCRIPTS else ("entry-points", group))):
        points = points.get(key, {})
        if not isinstance(points, dict):
            raise PackageError(f"{file}: '{key}' must be a table")
    return [f"{name} = {target}" for name, target in points.items()]


def _setup_arguments(file: Path) -> dict[str, Any]:
    """The keyword arguments of the file's ``setup`` call that are plain values."""
    try:
        tree = ast.parse(read_plain_file(file, MAX_MANIFEST_BYTES), str(file))
    except (OSError, ValueError, RecursionError, MemoryError) as problem:  # the last two: nested too deeply
        raise PackageError(f"{file}: cannot be read ({problem})") from None
    except SyntaxError as problem:
        raise PackageError(f"{file}:{problem.lineno}: {problem.msg}") from None
    names: dict[str, Any] = {}
    arguments: dict[str, Any] = {}
    for statement in tree.body:
        if isinstance(statement, ast.Assign) and isinstance(statement.targets[0], ast.Name):
            try:
                names[statement.targets[0].id] = _value(statement.value, names)
            except _NotConstant:
                continue
        for call in ast.walk(statement):
            if isinstance(call, ast.Call) and _called_name(call) == "setup":
                for keyword in call.keywords:
                    if keyword.arg == "data_files":
                        arguments[keyword.arg] = _data_files(keyword.value, names, file.parent)
                    elif keyword.arg in ("entry_points", "package_dir"):
                        arguments[keyword.arg] = _constant(keyword.value, names, file)
    return arguments


def _data_files(node: ast.expr, names: Mapping[str, Any], folder: Path) -> list[tuple[str, list[str]]]:
    """The entries of ``data_files`` that can be evaluated without running the file: where files go, and which.

    ``glob`` and ``os.path.join`` are understood.
    """
    found: list[tuple[str, list[str]]] = []
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        return _data_files(node.left, names, folder) + _data_files(node.right, names, folder)
    if isinstance(node, ast.Name) and isinstance(names.get(node.id), list):
        entries: list[Any] = names[node.id]
        return [(each[0], each[1]) for each in entries if isinstance(each, list) and len(each) == 2]
    for entry in node.elts if isinstance(node, (ast.List, ast.Tuple)) else ():
        if isinstance(entry, ast.Tuple) and len(entry.elts) == 2:
            try:
                target = _value(entry.elts[0], names)
                files = _file_list(entry.elts[1], names, folder)
            except (_NotConstant, TypeError):
                continue
            if isinstance(target, str):
                found.append((target, [file for file in files if isinstance(file, str)]))
    return found


def _file_list(node: ast.expr, names: Mapping[str, Any], folder: Path) -> list[Any]:
    """A list of files, with what ``glob`` finds in a package's folder."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        return _file_list(node.left, names, folder) + _file_list(node.right, names, folder)
    if isinstance(node, ast.Call) and _called_name(node) == "glob" and node.args:
        pattern = _text(node.args[0], names)
        if Path(pattern).is_absolute() or ".." in Path(pattern).parts or not pattern:
            return []  # a package's files are its own
        return sorted(str(file.relative_to(folder)) for file in folder.glob(pattern))
    return list(_value(node, names))


def installed_files(name: str, folder: Path) -> dict[str, Path]:
    """The files that a package's ``setup.py`` installs into its share folder at another place than in its own folder: the
    place in the share folder -> the file."""
    setup = folder / "setup.py"
    try:
        entries = _setup_arguments(setup).get("data_files", []) if setup.is_file() else []
    except PackageError:
        return {}
    moved: dict[str, Path] = {}
    prefix = f"share/{name}"
    for target, files in entries:
        inside = os.path.normpath(target)
        if inside != prefix and not inside.startswith(f"{prefix}/"):
            continue
        for file in files:
            source = folder / file
            place = str(Path(inside[len(prefix) + 1 :], source.name))
            if not source.resolve().is_relative_to(folder.resolve()):
                continue  # a package's files are its own
            if source.is_file() and not (folder / place).exists():
                moved[place] = source
    return moved


def _called_name(call: ast.Call) -> str:
    return call.func.id if isinstance(call.func, ast.Name) else getattr(call.func, "attr", "")


class _NotConstant(Exception):
    """An expression that cannot be evaluated without running the file."""

    def __init__(self, node: ast.AST) -> None:
        self.line = getattr(node, "lineno", 0)


def _constant(node: ast.expr, names: Mapping[str, Any], file: Path) -> Any:
    try:
        return _value(node, names)
    except _NotConstant as problem:
        raise PackageError(
            f"{file}:{problem.line}: this is computed when the file runs, which the kit does not do; "
            "write the entry points as plain texts"
        ) from None


def _value(node: ast.expr, names: Mapping[str, Any]) -> Any:
    """Evaluates an expression of literals, names of literals, and texts formatted from them."""
    if isinstance(node, ast.Constant):
        return node.value
    if isinstance(node, ast.Name) and node.id in names:
        return names[node.id]
    if isinstance(node, (ast.List, ast.Tuple)):
        return [_value(entry, names) for entry in node.elts]
    if isinstance(node, ast.Dict) and None not in node.keys:
        try:
            return {
                _value(key, names): _value(value, names)
                for key, value in zip(node.keys, node.values, strict=True)
                if key is not None
            }
        except TypeError:  # a list as a key
            raise _NotConstant(node) from None
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        left, right = _value(node.left, names), _value(node.right, names)
        if type(left) is type(right) and isinstance(left, (str, list)):
            if len(left) + len(right) > MAX_VALUE_SIZE:  # doubled line by line, it would fill the memory
                raise _NotConstant(node)
            return left + right
    if isinstance(node, ast.Call) and _called_name(node) == "join" and node.args and not node.keywords:
        return str(Path(*(_text(each, names) for each in node.args)))
    if isinstance(node, ast.JoinedStr):
        text = "".join(_format_part(part, names) for part in node.values)
        if len(text) > MAX_VALUE_SIZE:
            raise _NotConstant(node)
        return text
    raise _NotConstant(node)


def _format_part(node: ast.expr, names: Mapping[str, Any]) -> str:
    if isinstance(node, ast.FormattedValue) and node.conversion == -1 and node.format_spec is None:
        return _text(node.value, names)
    return _text(node, names)


def _text(node: ast.expr, names: Mapping[str, Any]) -> str:
    """The text of a plain value. Not of a list: one that holds another twice, and so on, has a text without end."""
    value = _value(node, names)
    if isinstance(value, (list, dict)):
        raise _NotConstant(node)
    return str(value)
