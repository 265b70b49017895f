"""Where packages lie, and the index of their resources. ROS 2 has this in ``ament_index_python``.

Of the kinds of resources that packages register, it knows the packages and those with interfaces.
"""

from __future__ import annotations

import os
from pathlib import Path

from kit.msg.interfaces import interface_names
from kit.ros.launch.unavailable import UNAVAILABLE_FOLDER, describe_unavailable
from kit.ros.packages import (
    LAUNCH_VARIABLE,
    PackageError,
    find_packages,
    interface_packages,
    search_folders,
)
from kit.ros.share_folders import share_folder

_KINDS = ("packages", "rosidl_interfaces")


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
    """The package's share folder, as a text."""
    return str(get_package_share_path(package_name))


def get_package_prefix(package_name: str) -> str:
    """Where a package is installed: nothing is here, so its own folder."""
    return str(get_package_share_path(package_name))


def get_packages_with_prefixes() -> dict[str, str]:
    return {name: str(folder) for name, folder in find_packages(search_folders()).items()}


def get_resources(resource_type: str) -> dict[str, str]:
    """The packages that have a resource of this kind, with their folders. ValueError for an empty kind."""
    if not resource_type:
        raise ValueError("The resource type must not be empty")
    packages = find_packages(search_folders())
    found = interface_packages(packages) if resource_type == "rosidl_interfaces" else packages
    return {name: str(packages[name]) for name in found} if resource_type in _KINDS else {}


def has_resource(resource_type: str, resource_name: str) -> str | bool:
    """The folder of the package that has the resource, or False."""
    return get_resources(resource_type).get(resource_name, False)


def get_resource(resource_type: str, resource_name: str) -> tuple[str, str]:
    """The resource's content and the package's folder. Raises LookupError."""
    if not resource_name:
        raise ValueError("The resource name must not be empty")
    folder = has_resource(resource_type, resource_name)
    if not isinstance(folder, str):
        raise LookupError(f"Could not find the resource '{resource_name}' of type '{resource_type}'")
    if resource_type == "packages":
        return "", folder
    names = [name.split("/", 1)[1] for name in interface_names(resource_name)]
    return "".join(f"{name}.{name.split('/')[0]}\n" for name in names), folder
