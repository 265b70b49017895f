"""tf2_ros.buffer_interface of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.tf_conversion import (
    BufferInterface,
    ConvertRegistration,
    NotImplementedException,
    TransformRegistration,
    TypeException,
    convert,
)

__all__ = [
    "BufferInterface",
    "ConvertRegistration",
    "NotImplementedException",
    "TransformRegistration",
    "TypeException",
    "convert",
]
