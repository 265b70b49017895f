"""Which launch file is meant, and where packages are looked for."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from kit.ros.packages import PackageError, find_packages, read_package

SHARE: Final = Path(__file__).parent / "share"
"""What the kit has of Flatland's own packages: looked up last, so that real ones come first."""


@dataclass(frozen=True, slots=True)
class LaunchTarget:
    """A launch file, and what is around it."""

    file: Path
    folder: Path
    """Its package's, or its own: messages name files relative to it."""
    search: tuple[Path, ...]
    """Folders in which packages are looked for, in this order."""

    @property
    def name(self) -> str:
        """What the launch is called: ``maze`` of ``maze.launch.py``."""
        return self.file.name.partition(".")[0]


def find_launch(where: str, file: str | None, more: Iterable[Path]) -> LaunchTarget:
    """The launch file that ``kit launch WHERE [FILE]`` means. ``more``: where else packages are looked for.

    WHERE is a launch file, the folder of a package or of several, or a package's name. Raises PackageError.
    """
    path = Path(where).expanduser()
    more = (*more, SHARE)
    here = [Path.cwd(), Path.cwd() / "src", *more]
    if path.is_file():
        if path.suffix != ".py":
            raise PackageError(
                f"{where}: no launch file: the kit reads those in Python, called NAME.launch.py"
            )
        path = path.absolute()
        folder = next((each for each in path.parents if (each / "package.xml").is_file()), path.parent)
        return LaunchTarget(path, folder, _search(folder, more))
    if not path.is_dir():
        packages = find_packages(here)
        if where not in packages:
            known = f" Packages found here: {', '.join(sorted(packages))}." if packages else ""
            raise PackageError(f"{where}: there is no such file, folder or package.{known}")
        path = packages[where]
    path = path.absolute()
    if (path / "package.xml").is_file():
        return _in_package(path, file, more)
    inside = find_packages([path])
    if len(inside) == 1:
        return _in_package(next(iter(inside.values())), file, more)
    if not inside:
        alone = sorted(path.glob("*launch.py"))
        if len(alone) == 1 and file is None:
            return LaunchTarget(alone[0], path, _search(path, more))
        raise PackageError(f"{path}: no package.xml here or below, so this is no ROS 2 package")
    raise PackageError(
        f"{where}: several packages lie there: {', '.join(sorted(inside))}. Name one of their folders."
    )


def _in_package(folder: Path, file: str | None, more: Iterable[Path]) -> LaunchTarget:
    files = read_package(folder).launch_files
    if file is not None:
        named = [each for each in files if each.name == file or str(each.relative_to(folder)) == file]
        if not named and (folder / file).is_file():
            named = [folder / file]
        if not named:
            raise PackageError(f"{folder}: there is no launch file {file}; there are: {_names(files)}")
        return LaunchTarget(named[0], folder, _search(folder, more))
    if len(files) == 1:
        return LaunchTarget(files[0], folder, _search(folder, more))
    if not files:
        raise PackageError(
            f"{folder}: there is no launch file: none whose name ends in launch.py, here or in launch/"
        )
    raise PackageError(
        f"{folder}: there are several launch files: {_names(files)}. Name one after the folder."
    )


def _names(files: Sequence[Path]) -> str:
    return ", ".join(file.name for file in files) or "none"


def _search(folder: Path, more: Iterable[Path]) -> tuple[Path, ...]:
    """The package itself first, then what lies beside it, then the rest."""
    return tuple(dict.fromkeys([folder, folder.parent, *more]))
