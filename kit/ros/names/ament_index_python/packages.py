import os
from pathlib import Path

from kit.ros.launch.unavailable import UNAVAILABLE_FOLDER, describe_unavailable
from kit.ros.packages import LAUNCH_VARIABLE, PackageError, find_packages, search_folders, share_folder


class PackageNotFoundError(KeyError):
    """There is no package of this name."""

    def __str__(self) -> str:
        return str(self.args[0])


def get_package_share_path(package_name: str, print_warning: bool = True) -> Path:
    """The share folder of a package. Raises PackageNotFoundError."""
    try:
        return share_folder(package_name)
    except PackageError as problem:
        if LAUNCH_VARIABLE in os.environ and describe_unavailable(package_name) is not None:
            return Path(UNAVAILABLE_FOLDER, package_name)  # what needs its files is skipped, the rest goes on
        raise PackageNotFoundError(str(problem)) from None


def get_package_share_directory(package_name: str, print_warning: bool = True) -> str:
    """The same, as a text."""
    return str(get_package_share_path(package_name))


def get_package_prefix(package_name: str) -> str:
    """Where a package is installed: nothing is here, so its own folder."""
    return str(get_package_share_path(package_name))


def get_packages_with_prefixes() -> dict[str, str]:
    return {name: str(folder) for name, folder in find_packages(search_folders()).items()}


__all__ = [
    "PackageNotFoundError",
    "get_package_prefix",
    "get_package_share_directory",
    "get_package_share_path",
    "get_packages_with_prefixes",
]
