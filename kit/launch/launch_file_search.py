"""Finds the launch file that a command names, and the folders in which packages are searched."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from kit.ros.packages import LAUNCH_SUFFIXES, PackageError, find_packages, read_package

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
            raise PackageError(f"{where}: no launch file: these are called NAME.launch.py, .xml or .yaml")
        path = path.absolute()
        folder = next((each for each in path.parents if (each / "package.xml").is_file()), path.parent)
        return LaunchTarget(path, folder, _search_order(folder, extra_folders))
    if not path.is_dir():
        packages = find_packages(here)
        if where not in packages:
            known = f" Packages found here: {', '.join(sorted(packages))}." if packages else ""
            raise PackageError(f"{where}: there is no such file, folder or package.{known}")
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
        raise PackageError(f"{path}: no package.xml here or below, so this is no ROS 2 package")
    raise PackageError(
        f"{where}: several packages lie there: {', '.join(sorted(inside))}. Name one of their folders."
    )


def _choose_launch_file(folder: Path, file: str | None, extra_folders: Iterable[Path]) -> LaunchTarget:
    files = read_package(folder).launch_files
    if file is not None:
        named = [each for each in files if each.name == file or str(each.relative_to(folder)) == file]
        if not named and (folder / file).is_file():
            named = [folder / file]
        if not named:
            raise PackageError(f"{folder}: there is no launch file {file}; there are: {_names(files)}")
        return LaunchTarget(named[0], folder, _search_order(folder, extra_folders))
    if len(files) == 1:
        return LaunchTarget(files[0], folder, _search_order(folder, extra_folders))
    if not files:
        raise PackageError(
            f"{folder}: there is no launch file: none whose name ends in launch.py, launch.xml or launch.yaml, here or in launch/"
        )
    raise PackageError(
        f"{folder}: there are several launch files: {_names(files)}. Name one after the folder."
    )


def _names(files: Sequence[Path]) -> str:
    return ", ".join(file.name for file in files) or "none"


def _search_order(folder: Path, extra_folders: Iterable[Path]) -> tuple[Path, ...]:
    """The package itself, then its parent folder, then the other folders."""
    return tuple(dict.fromkeys([folder, folder.parent, *extra_folders]))
