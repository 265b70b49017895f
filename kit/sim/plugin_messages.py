"""What plugins read and write alike: topics, rates, variances, and the messages of poses and speeds."""

from __future__ import annotations

import math
import re

from kit.geometry import Pose
from kit.msg import geometry_msgs
from kit.msg.builtin_interfaces import Time
from kit.msg.std_msgs import Header
from kit.msg.tf2_msgs import TFMessage
from kit.plain_text import quoted
from kit.world.yaml_section import Section

TF_TOPIC = "/tf"
_TOPIC = re.compile(r"/?[A-Za-z_]\w*(/[A-Za-z_]\w*)*", re.ASCII)


def read_topic(section: Section, key: str, default: str) -> str:
    """A topic's name as ROS 2 wants it; under the model's namespace unless it starts with a slash."""
    name = section.name(key, default)
    if section.has(key) and not _TOPIC.fullmatch(name):
        section.error(
            f"{quoted(name)} is not a topic name: use letters, digits, _ and /, no digit after a /", key
        )
        return default
    return name


def read_rate(section: Section, key: str, default: float = math.inf) -> float:
    """Updates per second [Hz]; inf means at every step."""
    return section.number(key, default, minimum=0, infinite=True)


def read_variances(section: Section, key: str) -> tuple[float, ...]:
    """Three variances, by default no noise."""
    variances = section.numbers(key, (0.0, 0.0, 0.0), length=3)
    if min(variances) < 0:
        section.error(f"{quoted(key)} contains variances: they must not be below 0", key)
        return (0.0, 0.0, 0.0)
    return variances


def yaw_quaternion(theta: float) -> geometry_msgs.Quaternion:
    """A turn about the vertical axis."""
    return geometry_msgs.Quaternion(z=math.sin(theta / 2), w=math.cos(theta / 2))


def pose_message(pose: Pose) -> geometry_msgs.Pose:
    return geometry_msgs.Pose(
        position=geometry_msgs.Point(x=pose.x, y=pose.y), orientation=yaw_quaternion(pose.theta)
    )


def twist_message(forward: float, lateral: float, turn: float) -> geometry_msgs.Twist:
    return geometry_msgs.Twist(
        linear=geometry_msgs.Vector3(x=forward, y=lateral), angular=geometry_msgs.Vector3(z=turn)
    )


def transform_message(stamp: Time, parent: str, child: str, pose: Pose) -> geometry_msgs.TransformStamped:
    """Returns the transform of the frame ``child`` in the frame ``parent``."""
    return geometry_msgs.TransformStamped(
        header=Header(stamp=stamp, frame_id=parent),
        child_frame_id=child,
        transform=geometry_msgs.Transform(
            translation=geometry_msgs.Vector3(x=pose.x, y=pose.y), rotation=yaw_quaternion(pose.theta)
        ),
    )


def tf_message(*stamped: geometry_msgs.TransformStamped) -> TFMessage:
    return TFMessage(transforms=list(stamped))
