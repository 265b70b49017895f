"""tf_transformations of ROS 2, as this project offers it."""

# Made by: python -m tests.ros.import_names

from kit.ros.rotations import (
    concatenate_matrices,
    euler_from_matrix,
    euler_from_quaternion,
    euler_matrix,
    identity_matrix,
    inverse_matrix,
    quaternion_about_axis,
    quaternion_conjugate,
    quaternion_from_euler,
    quaternion_from_matrix,
    quaternion_inverse,
    quaternion_matrix,
    quaternion_multiply,
    quaternion_slerp,
    translation_from_matrix,
    translation_matrix,
    unit_vector,
    vector_norm,
)

__all__ = [
    "concatenate_matrices",
    "euler_from_matrix",
    "euler_from_quaternion",
    "euler_matrix",
    "identity_matrix",
    "inverse_matrix",
    "quaternion_about_axis",
    "quaternion_conjugate",
    "quaternion_from_euler",
    "quaternion_from_matrix",
    "quaternion_inverse",
    "quaternion_matrix",
    "quaternion_multiply",
    "quaternion_slerp",
    "translation_from_matrix",
    "translation_matrix",
    "unit_vector",
    "vector_norm",
]
