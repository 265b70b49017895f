"""Transforms messages of geometry_msgs. ROS 2 has this in ``tf2_geometry_msgs``.

``Buffer.transform`` and ``convert`` know these types once this module has been imported, as in ROS 2.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from kit.msg.geometry_msgs import (
    Point,
    PointStamped,
    Pose,
    PoseStamped,
    PoseWithCovarianceStamped,
    Quaternion,
    Transform,
    TransformStamped,
    Vector3,
    Vector3Stamped,
)
from kit.ros.rotations import quaternion_multiply, rotate_vector
from kit.ros.tf_conversion import ConvertRegistration, DoTransform, TransformRegistration


def do_transform_point(point: PointStamped, transform: TransformStamped) -> PointStamped:
    """The point in the frame ``transform.header.frame_id``."""
    result = PointStamped(header=_header(transform))
    result.point = _point(point.point, transform.transform)
    return result


def do_transform_vector3(vector3: Vector3Stamped, transform: TransformStamped) -> Vector3Stamped:
    """The vector, rotated; a vector has no place, so it is not moved."""
    vector = vector3.vector
    x, y, z = rotate_vector(_quaternion(transform.transform.rotation), (vector.x, vector.y, vector.z))
    return Vector3Stamped(header=_header(transform), vector=Vector3(x=x, y=y, z=z))


def do_transform_pose(pose: Pose, transform: TransformStamped) -> Pose:
    """The pose, without a header."""
    if isinstance(pose, PoseStamped):
        raise TypeError(
            "do_transform_pose takes a Pose; for a PoseStamped there is do_transform_pose_stamped"
        )
    turn = quaternion_multiply(_quaternion(transform.transform.rotation), _quaternion(pose.orientation))
    return Pose(
        position=_point(pose.position, transform.transform),
        orientation=Quaternion(**dict(zip("xyzw", map(float, turn), strict=True))),
    )


def do_transform_pose_stamped(pose: PoseStamped, transform: TransformStamped) -> PoseStamped:
    """The pose in the frame ``transform.header.frame_id``."""
    return PoseStamped(header=_header(transform), pose=do_transform_pose(pose.pose, transform))


def do_transform_pose_with_covariance_stamped(
    pose: PoseWithCovarianceStamped, transform: TransformStamped
) -> PoseWithCovarianceStamped:
    """The pose and its covariance in the frame ``transform.header.frame_id``."""
    result = PoseWithCovarianceStamped(header=_header(transform))
    result.pose.pose = do_transform_pose(pose.pose.pose, transform)
    covariance: Any = transform_covariance(pose.pose.covariance.tolist(), transform)
    result.pose.covariance = covariance  # the field takes any sequence of 36 numbers
    return result


def transform_covariance(cov_in: Sequence[float], transform: TransformStamped) -> list[float]:
    """The 6 x 6 covariance, as 36 numbers, with its position and its rotation part rotated."""
    turn = _quaternion(transform.transform.rotation)
    columns = [rotate_vector(turn, axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))]
    rotation = [[columns[j][i] for j in range(3)] for i in range(3)]
    result = [0.0] * 36
    for row in (0, 3):
        for column in (0, 3):
            for i in range(3):
                for j in range(3):
                    result[(row + i) * 6 + column + j] = sum(
                        rotation[i][k] * float(cov_in[(row + k) * 6 + column + m]) * rotation[j][m]
                        for k in range(3)
                        for m in range(3)
                    )
    return result


def to_msg_msg(msg: Any) -> Any:
    """The message itself."""
    return msg


from_msg_msg = to_msg_msg


def _register_messages() -> None:
    """Makes ``Buffer.transform`` and ``convert`` know the types of geometry_msgs."""
    transforms: dict[type[Any], DoTransform] = {
        PointStamped: do_transform_point,
        Vector3Stamped: do_transform_vector3,
        PoseStamped: do_transform_pose_stamped,
        PoseWithCovarianceStamped: do_transform_pose_with_covariance_stamped,
    }
    conversions = ConvertRegistration()
    for cls, function in transforms.items():
        TransformRegistration().add(cls, function)
        conversions.add_to_msg(cls, to_msg_msg)
        conversions.add_from_msg(cls, from_msg_msg)


def _header(transform: TransformStamped) -> Any:
    return transform.header.__deepcopy__(None)


def _quaternion(rotation: Quaternion) -> tuple[float, float, float, float]:
    return rotation.x, rotation.y, rotation.z, rotation.w


def _point(point: Point, transform: Transform) -> Point:
    x, y, z = rotate_vector(_quaternion(transform.rotation), (point.x, point.y, point.z))
    move = transform.translation
    return Point(x=x + move.x, y=y + move.y, z=z + move.z)


_register_messages()
