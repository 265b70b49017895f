"""A drive with one wheel in front that is driven and steered, and two behind that follow."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

from kit.msg.ackermann_msgs import AckermannDriveStamped
from kit.msg.geometry_msgs import Twist
from kit.plain_text import quoted
from kit.sim import motors
from kit.sim.bodies import clamp
from kit.sim.motors import SpeedLimits, read_speed_limits
from kit.sim.odometry import Odometry, OdometryParams, read_odometry_params
from kit.sim.plugin import CommandLimit, OutgoingMessage, Plugin, PluginContext, PluginType
from kit.sim.plugin_messages import read_topic
from kit.world.plugin_reader import ModelScope
from kit.world.records import Joint, JointAnchor
from kit.world.yaml_section import Section

POSITION_TOLERANCE = 1e-5
"""Largest deviation of a wheel from its required position [m]."""

Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class TricycleDriveParams:
    body: str
    front_wheel: str
    wheelbase: float
    """Distance of the rear axle behind the front wheel, which is at the body's origin [m]."""
    topic: str
    ackermann_topic: str
    """Topic of the commands in car's terms; empty for none."""
    max_steering: float
    """[rad], 0 for no limit."""
    linear: SpeedLimits
    steering: SpeedLimits
    veer: float
    """Curvature of the way when told to go straight [1/m]."""
    odometry: OdometryParams

    def build(self, context: PluginContext) -> TricycleDrive:
        return TricycleDrive(self, context)


def read_params(section: Section, scope: ModelScope) -> TricycleDriveParams:
    body = scope.body(section, "body")
    front = _read_wheel(section, scope, "front_wheel_joint", "revolute", body)
    left = _read_wheel(section, scope, "rear_left_wheel_joint", "weld", body)
    right = _read_wheel(section, scope, "rear_right_wheel_joint", "weld", body)
    wheelbase, separation = 1.0, 1.0
    if front and left and right:
        if math.hypot(*front.point) > POSITION_TOLERANCE:
            section.error("the front wheel must be at (0, 0) of the body", "front_wheel_joint")
        wheelbase, separation = _rear_axle(section, left.point, right.point)
    return TricycleDriveParams(
        body=body,
        front_wheel=front.body if front else "",
        wheelbase=wheelbase,
        topic=read_topic(section, "twist_sub", "cmd_vel"),
        ackermann_topic=read_topic(section, "ackermann_sub", "") if section.has("ackermann_sub") else "",
        max_steering=section.number("max_steer_angle", 0.0, minimum=0),
        linear=read_speed_limits(section, "linear_dynamics"),
        steering=_read_steering_limits(section),
        veer=section.number("veer", 0.0),
        odometry=replace(read_odometry_params(section), wheel_separation=separation),
    )


def _read_wheel(section: Section, scope: ModelScope, key: str, kind: str, body: str) -> JointAnchor | None:
    """The wheel at a joint's other end, and where it is on the body; None, with the mistake noted, if there is none."""
    name = scope.joint(section, key)
    joint = next((joint for joint in scope.model.joints if joint.name == name), None)
    if joint is None:
        return None
    if joint.kind != kind:
        section.error(f"{quoted(name)} must be a {kind} joint, not a {joint.kind} joint", key)
        return None
    ends = _joint_ends(joint, body)
    if ends is None:
        section.error(f"{quoted(name)} does not hold the body {quoted(body)}", key)
        return None
    on_body, on_wheel = ends
    if math.hypot(*on_wheel.point) > POSITION_TOLERANCE:
        section.error(f"the anchor of {quoted(name)} on the wheel must be (0, 0)", key)
        return None
    return JointAnchor(on_wheel.body, on_body.point)


def _joint_ends(joint: Joint, body: str) -> tuple[JointAnchor, JointAnchor] | None:
    """The joint's end on the body, and the other one."""
    first, second = joint.anchors
    if first.body == body:
        return first, second
    return (second, first) if second.body == body else None


def _rear_axle(section: Section, left: Point, right: Point) -> tuple[float, float]:
    """Wheelbase and distance of the rear wheels [m]."""
    separation = math.dist(left, right)
    if separation <= POSITION_TOLERANCE:
        section.error("the rear wheels must not be in the same place", "rear_left_wheel_joint")
        return 1.0, 1.0
    x, y = (left[0] + right[0]) / 2, (left[1] + right[1]) / 2
    slant = abs(left[0] - right[0])
    if abs(y) > POSITION_TOLERANCE or slant > POSITION_TOLERANCE or abs(x) <= POSITION_TOLERANCE:
        section.error(
            "the rear wheels must be side by side, equally far from the body's x axis, "
            f"and not beside the front wheel: the middle between them is ({x:g}, {y:g})",
            "rear_left_wheel_joint",
        )
        return 1.0, separation
    return -x, separation


def _read_steering_limits(section: Section) -> SpeedLimits:
    """Limits of the change of the steering angle: ``angular_dynamics``, or its two older keys."""
    limits = read_speed_limits(section, "angular_dynamics")
    acceleration = section.number("max_steer_acceleration", limits.acceleration, minimum=0)
    if section.has("max_steer_acceleration"):
        limits = replace(limits, acceleration=acceleration, deceleration=acceleration)
    return replace(limits, speed=section.number("max_angular_velocity", limits.speed, minimum=0))


class TricycleDrive(Plugin):
    """Moves a body as the last geometry_msgs/Twist says: ``linear.x`` is the front wheel's speed [m/s], ``angular.z``
    its steering **angle** [rad].

    =================================== ============================================================================
    body                                the body to move, whose origin is the front wheel
    front_wheel_joint                   a revolute joint at (0, 0) of the body
    rear_left_wheel_joint               weld joint, side by side with the other, on the left of the body's x axis
    rear_right_wheel_joint              weld joint on the right
    twist_sub                           topic of the commands
    ackermann_sub                       topic of ackermann_msgs/AckermannDriveStamped, as cars take it:
                                        ``drive.speed`` is the rear axle's speed, ``drive.steering_angle`` the angle
    max_steer_angle                     largest steering angle [rad]; 0: no limit
    veer                                curvature of the rear axle's way when told to go straight, to the left [1/m]; by
                                        default 0
    linear_dynamics                     limits of the speed; without it none
    angular_dynamics                    limits of the rate at which the steering angle changes, and of its change;
                                        without it none
    linear_dynamics.acceleration_limit  limit of gaining speed [m/s^2]; 0: none
    linear_dynamics.deceleration_limit  limit of losing speed [m/s^2]; by default that of gaining it; 0: none
    linear_dynamics.velocity_limit      limit of the speed [m/s]; 0: none
    angular_dynamics.acceleration_limit limit of gaining rate [rad/s^2]; 0: none
    angular_dynamics.deceleration_limit limit of losing rate [rad/s^2]; by default that of gaining it; 0: none
    angular_dynamics.velocity_limit     limit of the rate [rad/s]; 0: none
    max_steer_acceleration              older key for both limits of gaining and losing rate [rad/s^2]
    max_angular_velocity                older key for the limit of the rate [rad/s]
    =================================== ============================================================================

    Reports as DiffDrive does, with the same keys; wheels of the encoders are the rear ones, which turn as
    ``kit.sim.motors.tricycle_twist`` says. The front wheel turns with the steering. Like DiffDrive's, the last command
    holds for ever.
    """

    def __init__(self, params: TricycleDriveParams, context: PluginContext) -> None:
        self._params = params
        self._body = context.bodies[params.body]
        self._front_wheel = context.bodies[params.front_wheel]
        self._odometry = Odometry(params.odometry, context, self._body, origin_offset=params.wheelbase)
        fastest, steering = params.linear.speed, params.max_steering
        limits = CommandLimit("linear.x", fastest, "m/s"), CommandLimit("angular.z", steering, "rad")
        self.endpoints = [context.subscription(params.topic, Twist, limits), *self._odometry.endpoints]
        if params.ackermann_topic:
            limits = (
                CommandLimit("drive.speed", fastest, "m/s"),
                CommandLimit("drive.steering_angle", steering, "rad"),
            )
            self.endpoints.append(context.subscription(params.ackermann_topic, AckermannDriveStamped, limits))

    def reset(self, seed: int) -> None:
        self._command = (0.0, 0.0)
        self._is_rear_speed = False
        self._speed = self._steering = self._steering_rate = 0.0
        self._odometry.reset(seed)

    def accept(self, topic: str, message: Any) -> None:
        self._is_rear_speed = isinstance(message, AckermannDriveStamped)
        command = (
            (message.drive.speed, message.drive.steering_angle)
            if self._is_rear_speed
            else (message.linear.x, message.angular.z)
        )
        # A controller that divides by zero stops its robot; nan would spread through the whole world.
        self._command = command if all(map(math.isfinite, command)) else (0.0, 0.0)

    def before_step(self, dt: float) -> Iterable[OutgoingMessage]:
        params = self._params
        speed, angle = self._command
        if params.max_steering:
            angle = clamp(angle, params.max_steering)
        self._speed = params.linear.limited_speed(self._speed, speed, dt)
        rate = params.steering.limited_speed(self._steering_rate, (angle - self._steering) / dt, dt)
        steering = self._steering + rate * dt
        if params.max_steering:
            steering = clamp(steering, params.max_steering)
        rim_speed = self._speed / math.cos(self._steering) if self._is_rear_speed else self._speed
        forward, turn = motors.tricycle_twist(rim_speed, self._steering, params.wheelbase)
        veering = params.veer * forward
        turn += veering
        self._steering_rate = (steering - self._steering) / dt
        lateral = turn * params.wheelbase  # of the body's origin, which lies before the rear axle
        sent = self._odometry.step((forward, lateral, turn), dt)
        self._body.drive(forward, lateral, turn)
        slip = veering * params.wheelbase  # of the front wheel, across the body
        self._front_wheel.drive(
            rim_speed + slip * math.sin(self._steering),
            slip * math.cos(self._steering),
            turn + self._steering_rate,
        )
        self._steering = steering
        return sent


PLUGIN_TYPE = PluginType(
    "TricycleDrive",
    TricycleDrive,
    read_params,
    example="body: base\nfront_wheel_joint: front\nrear_left_wheel_joint: left\nrear_right_wheel_joint: right",
    parts=(Odometry,),
)
