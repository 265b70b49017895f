"""What devices put into messages: headers, poses, transforms."""

from __future__ import annotations

import math

from kit.geometry import Pose
from kit.msg import geometry_msgs
from kit.msg.builtin_interfaces import Time
from kit.msg.std_msgs import Header
from kit.msg.tf2_msgs import TFMessage

TF_TOPIC = "/tf"


def quaternion(theta: float) -> geometry_msgs.Quaternion:
    """A turn about the vertical axis."""
    return geometry_msgs.Quaternion(z=math.sin(theta / 2), w=math.cos(theta / 2))


def pose_message(pose: Pose) -> geometry_msgs.Pose:
    return geometry_msgs.Pose(
        position=geometry_msgs.Point(x=pose.x, y=pose.y), orientation=quaternion(pose.theta)
    )


def twist_message(forward: float, lateral: float, turn: float) -> geometry_msgs.Twist:
    return geometry_msgs.Twist(
        linear=geometry_msgs.Vector3(x=forward, y=lateral), angular=geometry_msgs.Vector3(z=turn)
    )


def transform(stamp: Time, parent: str, child: str, pose: Pose) -> geometry_msgs.TransformStamped:
    """Where the frame ``child`` lies in the frame ``parent``."""
    return geometry_msgs.TransformStamped(
        header=Header(stamp=stamp, frame_id=parent),
        child_frame_id=child,
        transform=geometry_msgs.Transform(
            translation=geometry_msgs.Vector3(x=pose.x, y=pose.y), rotation=quaternion(pose.theta)
        ),
    )


def transforms(*stamped: geometry_msgs.TransformStamped) -> TFMessage:
    return TFMessage(transforms=list(stamped))
