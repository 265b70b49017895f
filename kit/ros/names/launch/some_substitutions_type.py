"""launch.some_substitutions_type of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.launch.substitutions import SomeText as SomeSubstitutionsType

__all__ = ["SomeSubstitutionsType"]
