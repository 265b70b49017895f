"""sensor_msgs_py.point_cloud2 of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.point_clouds import (
    DUMMY_FIELD_PREFIX,
    create_cloud,
    create_cloud_xyz32,
    dtype_from_fields,
    read_points,
    read_points_list,
    read_points_numpy,
)

__all__ = [
    "DUMMY_FIELD_PREFIX",
    "create_cloud",
    "create_cloud_xyz32",
    "dtype_from_fields",
    "read_points",
    "read_points_list",
    "read_points_numpy",
]
