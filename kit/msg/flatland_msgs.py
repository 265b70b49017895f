"""Flatland's interfaces, field for field as its ROS 2 port has them; marked as custom, since no ROS 2 installation has them."""

from kit.msg.fields import boolean, float64, float64_array, string, zero
from kit.msg.geometry_msgs import Pose2D
from kit.msg.message import Message, Service
from kit.msg.std_msgs import Header


class Vector2(Message, is_custom=True):
    x: float64 = zero
    y: float64 = zero


class Collision(Message, is_custom=True):
    """Two bodies that touch: none, one or two points; normals point from a, the reporting model, to b."""

    entity_a: string = zero
    body_a: string = zero
    entity_b: string = zero
    body_b: string = zero
    magnitude_forces: float64_array = zero
    contact_positions: list[Vector2] = zero
    contact_normals: list[Vector2] = zero


class Collisions(Message, is_custom=True):
    header: Header = zero
    collisions: list[Collision] = zero


class DebugTopicList(Message, is_custom=True):
    topics: list[string] = zero


class MoveModel(Service, is_custom=True):
    class Request(Message, is_custom=True):
        name: string = zero
        pose: Pose2D = zero

    class Response(Message, is_custom=True):
        success: boolean = zero
        message: string = zero


class SpawnModel(Service, is_custom=True):
    class Request(Message, is_custom=True):
        yaml_path: string = zero
        name: string = zero
        ns: string = zero
        pose: Pose2D = zero

    class Response(Message, is_custom=True):
        success: boolean = zero
        message: string = zero


class DeleteModel(Service, is_custom=True):
    class Request(Message, is_custom=True):
        name: string = zero

    class Response(Message, is_custom=True):
        success: boolean = zero
        message: string = zero


class ChangeRate(Service, is_custom=True):
    class Request(Message, is_custom=True):
        rate: float64 = zero

    class Response(Message, is_custom=True):
        success: boolean = zero
        message: string = zero
