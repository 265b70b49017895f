"""Points, poses, velocities, transforms: the interfaces of ROS 2's package geometry_msgs."""

from kit.msg.fields import float32, float64, float64_36, string, zero
from kit.msg.message import Message
from kit.msg.std_msgs import Header


class Vector3(Message):
    x: float64 = zero
    y: float64 = zero
    z: float64 = zero


class Accel(Message):
    linear: Vector3 = zero
    angular: Vector3 = zero


class AccelStamped(Message):
    header: Header = zero
    accel: Accel = zero


class AccelWithCovariance(Message):
    accel: Accel = zero
    covariance: float64_36 = zero


class AccelWithCovarianceStamped(Message):
    header: Header = zero
    accel: AccelWithCovariance = zero


class Inertia(Message):
    m: float64 = zero
    com: Vector3 = zero
    ixx: float64 = zero
    ixy: float64 = zero
    ixz: float64 = zero
    iyy: float64 = zero
    iyz: float64 = zero
    izz: float64 = zero


class InertiaStamped(Message):
    header: Header = zero
    inertia: Inertia = zero


class Point(Message):
    x: float64 = zero
    y: float64 = zero
    z: float64 = zero


class Point32(Message):
    x: float32 = zero
    y: float32 = zero
    z: float32 = zero


class PointStamped(Message):
    header: Header = zero
    point: Point = zero


class Polygon(Message):
    points: list[Point32] = zero


class PolygonStamped(Message):
    header: Header = zero
    polygon: Polygon = zero


class Quaternion(Message):
    x: float64 = zero
    y: float64 = zero
    z: float64 = zero
    w: float64 = 1.0


class Pose(Message):
    position: Point = zero
    orientation: Quaternion = zero


class Pose2D(Message, is_custom=True):
    """Gone from ROS 2 since Lyrical, but Flatland's services speak it: so it is ours."""

    x: float64 = zero
    y: float64 = zero
    theta: float64 = zero


class PoseArray(Message):
    header: Header = zero
    poses: list[Pose] = zero


class PoseStamped(Message):
    header: Header = zero
    pose: Pose = zero


class PoseWithCovariance(Message):
    pose: Pose = zero
    covariance: float64_36 = zero


class PoseWithCovarianceStamped(Message):
    header: Header = zero
    pose: PoseWithCovariance = zero


class QuaternionStamped(Message):
    header: Header = zero
    quaternion: Quaternion = zero


class Transform(Message):
    translation: Vector3 = zero
    rotation: Quaternion = zero


class TransformStamped(Message):
    header: Header = zero
    child_frame_id: string = zero
    transform: Transform = zero


class Twist(Message):
    linear: Vector3 = zero
    angular: Vector3 = zero


class TwistStamped(Message):
    header: Header = zero
    twist: Twist = zero


class TwistWithCovariance(Message):
    twist: Twist = zero
    covariance: float64_36 = zero


class TwistWithCovarianceStamped(Message):
    header: Header = zero
    twist: TwistWithCovariance = zero


class Vector3Stamped(Message):
    header: Header = zero
    vector: Vector3 = zero


class Wrench(Message):
    force: Vector3 = zero
    torque: Vector3 = zero


class WrenchStamped(Message):
    header: Header = zero
    wrench: Wrench = zero
