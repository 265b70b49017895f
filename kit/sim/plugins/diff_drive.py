"""A drive with two wheels beside each other."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from kit.msg.geometry_msgs import Twist
from kit.sim.motors import SpeedLimits, read_speed_limits
from kit.sim.odometry import Odometry, OdometryParams, read_odometry_params
from kit.sim.plugin import CommandLimit, OutgoingMessage, Plugin, PluginContext, PluginType
from kit.sim.plugin_messages import read_topic
from kit.world.plugin_reader import ModelScope
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class DiffDriveParams:
    body: str
    topic: str
    linear: SpeedLimits
    angular: SpeedLimits
    veer: float
    """Curvature of the way when told to go straight [1/m]."""
    odometry: OdometryParams

    def build(self, context: PluginContext) -> DiffDrive:
        return DiffDrive(self, context)


def read_params(section: Section, scope: ModelScope) -> DiffDriveParams:
    return DiffDriveParams(
        body=scope.body(section, "body"),
        topic=read_topic(section, "twist_sub", "cmd_vel"),
        linear=read_speed_limits(section, "linear_dynamics"),
        angular=read_speed_limits(section, "angular_dynamics"),
        veer=section.number("veer", 0.0),
        odometry=read_odometry_params(section),
    )


class DiffDrive(Plugin):
    """Moves a body as the last geometry_msgs/Twist says: ``linear.x`` forward [m/s], ``angular.z`` turn [rad/s].

    At every step and for ever: there is no time-out. ``linear.y`` is ignored, for wheels do not go sideways. The
    body gets this velocity at its origin, wherever its mass is, unless something is in the way. There
    are no wheels and there is no slip; ``odometry: encoders`` reports as if there were.

    =================================== ======================================================================
    body                                the body to move
    twist_sub                           topic of the commands
    linear_dynamics                     limits of the forward speed; without it none
    angular_dynamics                    limits of the turn; without it none
    veer                                curvature of the way when told to go straight, to the left [1/m], as with
                                        wheels of unequal size; by default 0
    linear_dynamics.acceleration_limit  limit of gaining speed [m/s^2]; 0: none
    linear_dynamics.deceleration_limit  limit of losing speed [m/s^2]; by default that of gaining it; 0: none
    linear_dynamics.velocity_limit      limit of the speed [m/s]; 0: none
    angular_dynamics.acceleration_limit limit of gaining turn [rad/s^2]; 0: none
    angular_dynamics.deceleration_limit limit of losing turn [rad/s^2]; by default that of gaining it; 0: none
    angular_dynamics.velocity_limit     limit of the turn [rad/s]; 0: none
    =================================== ======================================================================
    """

    def __init__(self, params: DiffDriveParams, context: PluginContext) -> None:
        self._params = params
        self._body = context.bodies[params.body]
        self._is_limited = not (params.linear.is_unlimited and params.angular.is_unlimited)
        self._odometry = Odometry(params.odometry, context, self._body)
        limits = (
            CommandLimit("linear.x", params.linear.speed, "m/s"),
            CommandLimit("angular.z", params.angular.speed, "rad/s"),
        )
        self.endpoints = [context.subscription(params.topic, Twist, limits), *self._odometry.endpoints]

    def reset(self, seed: int) -> None:
        self._command = self._velocity = (0.0, 0.0)
        self._odometry.reset(seed)

    def accept(self, topic: str, message: Any) -> None:
        command = (message.linear.x, message.angular.z)
        # A controller that divides by zero stops its robot; nan would spread through the whole world.
        is_finite = math.isfinite(command[0]) and math.isfinite(command[1])
        self._command = command if is_finite else (0.0, 0.0)

    def before_step(self, dt: float) -> Iterable[OutgoingMessage]:
        forward, turn = self._command
        if self._is_limited:
            forward = self._params.linear.limited_speed(self._velocity[0], forward, dt)
            turn = self._params.angular.limited_speed(self._velocity[1], turn, dt)
            self._velocity = forward, turn
        turn += self._params.veer * forward
        sent = self._odometry.step((forward, 0.0, turn), dt)
        self._body.drive(forward, 0.0, turn)
        return sent


PLUGIN_TYPE = PluginType("DiffDrive", DiffDrive, read_params, example="body: base", parts=(Odometry,))
