"""Joint trajectories: the interfaces of ROS 2's package trajectory_msgs."""

from kit.msg.builtin_interfaces import Duration
from kit.msg.fields import float64_array, string, zero
from kit.msg.geometry_msgs import Transform, Twist
from kit.msg.message import Message
from kit.msg.std_msgs import Header


class JointTrajectoryPoint(Message):
    positions: float64_array = zero
    velocities: float64_array = zero
    accelerations: float64_array = zero
    effort: float64_array = zero
    time_from_start: Duration = zero


class JointTrajectory(Message):
    header: Header = zero
    joint_names: list[string] = zero
    points: list[JointTrajectoryPoint] = zero


class MultiDOFJointTrajectoryPoint(Message):
    transforms: list[Transform] = zero
    velocities: list[Twist] = zero
    accelerations: list[Twist] = zero
    time_from_start: Duration = zero


class MultiDOFJointTrajectory(Message):
    header: Header = zero
    joint_names: list[string] = zero
    points: list[MultiDOFJointTrajectoryPoint] = zero
