"""The resource index: of the kinds that packages register, it knows the packages and those with interfaces."""

from kit.ros.packages import find_packages, interface_packages, search_folders

_KINDS = ("packages", "rosidl_interfaces")


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
    from kit.msg.interfaces import interface_names

    names = [name.split("/", 1)[1] for name in interface_names(resource_name)]
    return "".join(f"{name}.{name.split('/')[0]}\n" for name in names), folder


__all__ = ["get_resource", "get_resources", "has_resource"]
