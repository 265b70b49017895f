"""ament_index_python.resources of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.package_index import get_resource, get_resources, has_resource

__all__ = ["get_resource", "get_resources", "has_resource"]
