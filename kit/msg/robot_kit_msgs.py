"""Services of our own: what Flatland's world services lack. Marked as ours, since no ROS 2 brings them."""

from kit.msg.builtin_interfaces import Time
from kit.msg.fields import boolean, int64, string, uint32, zero
from kit.msg.geometry_msgs import Pose2D, Twist
from kit.msg.message import Message, Service


class Reset(Service, ours=True):
    """The whole world back to its file, in one stroke: poses, speeds, contacts, clock, devices, models."""

    class Request(Message, ours=True):
        new_seed: boolean = zero
        """False: noise as in the run before; true: noise from ``seed``."""
        seed: int64 = zero

    class Response(Message, ours=True):
        success: boolean = zero
        message: string = zero


class Step(Service, ours=True):
    """So many ticks of a paused world; answered when they are done."""

    class Request(Message, ours=True):
        ticks: uint32 = zero

    class Response(Message, ours=True):
        success: boolean = zero
        message: string = zero
        stamp: Time = zero


class BodyState(Message, ours=True):
    """One body in world coordinates; the twist is that of its origin."""

    model: string = zero
    body: string = zero
    pose: Pose2D = zero
    twist: Twist = zero


class GetState(Service, ours=True):
    """Where everything is and how it moves."""

    class Request(Message, ours=True):
        pass

    class Response(Message, ours=True):
        stamp: Time = zero
        tick: int64 = zero
        paused: boolean = zero
        bodies: list[BodyState] = zero
