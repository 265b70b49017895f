"""Services that Flatland's world services lack. Marked as custom, since no ROS 2 installation has them."""

from kit.msg.builtin_interfaces import Time
from kit.msg.fields import boolean, int64, string, uint32, zero
from kit.msg.geometry_msgs import Pose2D, Twist
from kit.msg.message import Message, Service


class Reset(Service, is_custom=True):
    """Resets the whole world to its file: poses, speeds, contacts, clock, devices, models."""

    class Request(Message, is_custom=True):
        new_seed: boolean = zero
        """False: noise as in the run before; true: noise from ``seed``."""
        seed: int64 = zero

    class Response(Message, is_custom=True):
        success: boolean = zero
        message: string = zero


class Step(Service, is_custom=True):
    """So many ticks of a paused world; answered when they are done."""

    class Request(Message, is_custom=True):
        ticks: uint32 = zero

    class Response(Message, is_custom=True):
        success: boolean = zero
        message: string = zero
        stamp: Time = zero


class BodyState(Message, is_custom=True):
    """One body in world coordinates; the twist is that of its origin."""

    model: string = zero
    body: string = zero
    pose: Pose2D = zero
    twist: Twist = zero


class GetState(Service, is_custom=True):
    """The poses and velocities of all bodies."""

    class Request(Message, is_custom=True):
        pass

    class Response(Message, is_custom=True):
        stamp: Time = zero
        tick: int64 = zero
        paused: boolean = zero
        bodies: list[BodyState] = zero
