"""``static_transform_publisher`` of tf2_ros: its arguments, and the node that publishes the transform."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from kit.msg.geometry_msgs import Quaternion, Transform, TransformStamped, Vector3
from kit.msg.std_msgs import Header
from kit.msg.tf2_msgs import TFMessage
from kit.ros.exceptions import InvalidRosArguments
from kit.ros.execution.arguments import parse_ros_arguments, split_ros_arguments
from kit.ros.graph.graph import Graph
from kit.ros.node.node import Node, create_graph_node
from kit.ros.node.qos import DurabilityPolicy, QoSProfile
from kit.ros.node.time import Time
from kit.ros.rotations import quaternion_from_euler

EXECUTABLE: Final = "static_transform_publisher"
_NUMBERS: Final = ("x", "y", "z", "yaw", "pitch", "roll", "qx", "qy", "qz", "qw")
_FRAMES: Final = ("frame-id", "child-frame-id")


def publish_transform(graph: Graph, arguments: Sequence[str]) -> Node:
    """Makes the node that publishes the transform. Raises ValueError for wrong arguments."""
    try:
        ros = parse_ros_arguments(arguments)
    except InvalidRosArguments as problem:
        raise ValueError(str(problem)) from None
    numbers, parent, child = _parse_arguments(split_ros_arguments(arguments)[0])
    if "qw" in numbers or "qx" in numbers or "qy" in numbers or "qz" in numbers:
        rotation = tuple(numbers.get(name, 1.0 if name == "qw" else 0.0) for name in ("qx", "qy", "qz", "qw"))
    else:
        roll, pitch, yaw = (numbers.get(name, 0.0) for name in ("roll", "pitch", "yaw"))
        rotation = tuple(float(part) for part in quaternion_from_euler(roll, pitch, yaw))
    name = ros.node_name(EXECUTABLE)
    node = create_graph_node(graph, name, ros.namespace(name, "/"))
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    x, y, z, w = rotation
    transform = TransformStamped(
        header=Header(stamp=Time(nanoseconds=graph.now_ns).to_msg(), frame_id=parent),
        child_frame_id=child,
        transform=Transform(
            translation=Vector3(**{axis: numbers.get(axis, 0.0) for axis in ("x", "y", "z")}),
            rotation=Quaternion(x=x, y=y, z=z, w=w),
        ),
    )
    node.create_publisher(TFMessage, "/tf_static", latched).publish(TFMessage(transforms=[transform]))
    return node


def _parse_arguments(arguments: Sequence[str]) -> tuple[dict[str, float], str, str]:
    """Parses both spellings: ``x y z yaw pitch roll frame child`` (or with a quaternion), and ``--x 0 --frame-id map``."""
    if any(argument.startswith("--") for argument in arguments):
        pairs = dict(zip(arguments[::2], arguments[1::2], strict=False))
        names = {f"--{name}" for name in (*_NUMBERS, *_FRAMES)}
        unknown = sorted(pairs.keys() - names)
        if unknown or len(arguments) % 2:
            raise ValueError(f"unknown arguments: {' '.join(unknown or arguments)}")
        frames = [pairs.pop(f"--{name}", "") for name in _FRAMES]
        numbers = {name.removeprefix("--"): _number(value) for name, value in pairs.items()}
    elif len(arguments) in (8, 9):
        order = _NUMBERS[:6] if len(arguments) == 8 else (*_NUMBERS[:3], *_NUMBERS[6:])
        numbers = {name: _number(value) for name, value in zip(order, arguments[:-2], strict=True)}
        frames = list(arguments[-2:])
    else:
        raise ValueError(
            "needs x y z yaw pitch roll frame_id child_frame_id, or --x 0 ... --frame-id A --child-frame-id B"
        )
    if not all(frames) or frames[0] == frames[1]:
        raise ValueError("needs two different frames: --frame-id A --child-frame-id B")
    return numbers, frames[0], frames[1]


def _number(value: str) -> float:
    try:
        return float(value)
    except ValueError:
        raise ValueError(f"'{value}' is not a number") from None
