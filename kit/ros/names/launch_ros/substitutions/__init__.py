"""launch_ros.substitutions of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.launch.file_substitutions import (
    ExecutableInPackage,
    FindPackagePrefix as FindPackage,
    FindPackagePrefix,
    FindPackageShare,
)
from kit.ros.launch.substitutions import ParameterSubstitution as Parameter

__all__ = ["ExecutableInPackage", "FindPackage", "FindPackagePrefix", "FindPackageShare", "Parameter"]
