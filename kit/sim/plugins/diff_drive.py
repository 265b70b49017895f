"""A drive with two wheels beside each other."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from kit.msg.geometry_msgs import Twist
from kit.sim.context import Device, Site
from kit.sim.keys import SpeedLimits, read_limits, read_topic
from kit.sim.odometry import Odometry, OdometryParams, read_odometry
from kit.sim.plugin import Outgoing, Plugin
from kit.world.plugin_reader import ModelScope, Section


@dataclass(frozen=True, slots=True)
class DiffDriveParams:
    body: str
    topic: str
    linear: SpeedLimits
    angular: SpeedLimits
    odometry: OdometryParams

    def build(self, site: Site) -> DiffDrive:
        return DiffDrive(self, site)


def read(section: Section, scope: ModelScope) -> DiffDriveParams:
    return DiffDriveParams(
        body=scope.body(section, "body"),
        topic=read_topic(section, "twist_sub", "cmd_vel"),
        linear=read_limits(section, "linear_dynamics"),
        angular=read_limits(section, "angular_dynamics"),
        odometry=read_odometry(section),
    )


class DiffDrive(Plugin):
    """Moves a body as the last geometry_msgs/Twist says: ``linear.x`` forward [m/s], ``angular.z`` turn [rad/s].

    At every step and for ever: there is no time-out. ``linear.y`` is ignored, for wheels do not go sideways. The
    body gets this velocity at its origin, wherever its mass is, unless something is in the way. There
    are no wheels and there is no slip; ``odometry: encoders`` reports as if there were.

    ======================== ==================================================================
    body                     the body to move
    twist_sub                topic of the commands (cmd_vel)
    linear_dynamics          ``acceleration_limit`` and ``velocity_limit`` (0: none),
    angular_dynamics         ``deceleration_limit`` (as for acceleration)
    odom_pub                 odometry/filtered, a nav_msgs/Odometry
    ground_truth_pub         odometry/ground_truth, the same without noise
    twist_pub                twist, a geometry_msgs/TwistStamped with the odometry's twist
    odom_frame_id            odom; ``ground_truth_frame_id`` is the same
    pub_rate                 reports per second; at every step by default
    enable_odom_pub, enable_twist_pub, enable_odom_tf_pub   all true
    odom_pose_noise, odom_twist_noise                       variances ``[x, y, yaw]``, 0
    odom_pose_covariance, odom_twist_covariance             36 numbers; the noise, by default
    odometry                 ``ideal``, or ``encoders``: see ``kit.sim.odometry.Odometry``
    wheel_separation         0.145 m, ``wheel_error`` 0.005, ``wheel_slip`` 0.002
    ======================== ==================================================================
    """

    def __init__(self, params: DiffDriveParams, site: Site) -> None:
        self._params = params
        self._body = site.bodies[params.body]
        self._odometry = Odometry(params.odometry, site, self._body)
        self.endpoints = [site.subscription(params.topic, Twist), *self._odometry.endpoints]

    def reset(self, seed: int) -> None:
        self._wanted = self._moving = (0.0, 0.0)
        self._odometry.reset(seed)

    def accept(self, topic: str, message: Any) -> None:
        command = (message.linear.x, message.angular.z)
        # A controller that divides by zero stops its robot; nan would spread through the whole world.
        self._wanted = command if all(map(math.isfinite, command)) else (0.0, 0.0)

    def before_step(self, dt: float) -> Iterable[Outgoing]:
        forward, turn = self._moving = (
            self._params.linear.limited(self._moving[0], self._wanted[0], dt),
            self._params.angular.limited(self._moving[1], self._wanted[1], dt),
        )
        sent = self._odometry.step((forward, 0.0, turn), dt)
        self._body.drive(forward, 0.0, turn)
        return sent


DEVICE = Device("DiffDrive", read, example="body: base")
