"""An inertial measurement unit."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from kit.geometry import Pose
from kit.msg import sensor_msgs
from kit.msg.geometry_msgs import Vector3
from kit.msg.std_msgs import Header
from kit.msg.tf2_msgs import TFMessage
from kit.sim.plugin import OutgoingMessage, Plugin, PluginContext, PluginType
from kit.sim.plugin_clock import RandomStream, UpdateTimer
from kit.sim.plugin_messages import (
    TF_TOPIC,
    read_rate,
    read_topic,
    read_variances,
    tf_message,
    transform_message,
    yaw_quaternion,
)
from kit.world.plugin_reader import ModelScope
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class ImuChannel:
    """Three components of one quantity: the variances of their noise, and the covariance given with them."""

    noise: tuple[float, ...]
    covariance: tuple[float, ...]
    """9 numbers, row by row."""


@dataclass(frozen=True, slots=True)
class ImuParams:
    body: str
    enabled: bool
    frame: str
    topic: str
    ground_truth_topic: str
    orientation: ImuChannel
    angular_velocity: ImuChannel
    linear_acceleration: ImuChannel
    rate: float
    broadcast_tf: bool

    def build(self, context: PluginContext) -> Imu:
        return Imu(self, context)


def read_params(section: Section, scope: ModelScope) -> ImuParams:
    return ImuParams(
        body=scope.body(section, "body"),
        enabled=section.flag("enable_imu_pub", True),
        frame=section.name("imu_frame_id", "imu"),
        topic=read_topic(section, "imu_pub", "imu/filtered"),
        ground_truth_topic=read_topic(section, "ground_truth_pub", "imu/ground_truth"),
        orientation=_read_channel(section, "orientation"),
        angular_velocity=_read_channel(section, "angular_velocity"),
        linear_acceleration=_read_channel(section, "linear_acceleration"),
        rate=read_rate(section, "pub_rate"),
        broadcast_tf=section.flag("broadcast_tf", True),
    )


def _read_channel(section: Section, quantity: str) -> ImuChannel:
    noise = read_variances(section, f"{quantity}_noise")
    diagonal = [float(value) for value in np.diag(noise).ravel()]
    return ImuChannel(noise, section.numbers(f"{quantity}_covariance", diagonal, length=9))


_NO_NOISE = ImuChannel((0.0, 0.0, 0.0), (0.0,) * 9)


class Imu(Plugin):
    """Publishes sensor_msgs/Imu after the step, twice: with noise and as it is.

    ============================== ==================================================================
    body                           the body that carries it
    imu_pub                        topic of the measurements with noise
    enable_imu_pub                 whether to publish those with noise
    ground_truth_pub               topic of the measurements without noise
    imu_frame_id                   frame of the messages
    pub_rate                       messages per second [Hz]; .inf: at every step
    broadcast_tf                   whether to publish where its frame is on /tf
    orientation_noise              variances of roll, pitch, yaw [rad^2]
    angular_velocity_noise         variances of x, y, z [rad^2/s^2]
    linear_acceleration_noise      variances of x, y, z [m^2/s^4]
    orientation_covariance         3 x 3, row by row, in the messages [rad^2]; by default the noise's
    angular_velocity_covariance    likewise [rad^2/s^2]
    linear_acceleration_covariance likewise [m^2/s^4]
    ============================== ==================================================================

    Acceleration is the change of the body's velocity in this step over the step, in the body's own frame.
    Flatland multiplies by the publishing rate instead, which is infinite by default, and has a sign wrong in y.
    There is no gravity in a flat world.
    """

    def __init__(self, params: ImuParams, context: PluginContext) -> None:
        self._params = params
        self._context = context
        self._body = context.bodies[params.body]
        self._timer = UpdateTimer(params.rate, context.clock)
        self._frame = context.model.frame(params.frame)
        self._imu = context.publisher(params.topic, sensor_msgs.Imu)
        self._truth = context.publisher(params.ground_truth_topic, sensor_msgs.Imu, is_ground_truth=True)
        self._tf = context.publisher(TF_TOPIC, TFMessage)
        self.endpoints = [self._truth.endpoint]
        if params.enabled:
            self.endpoints.append(self._imu.endpoint)
        if params.broadcast_tf:
            self.endpoints.append(self._tf.endpoint)

    def reset(self, seed: int) -> None:
        self._noise = RandomStream(seed)
        self._before = self._body.velocity

    def after_step(self, dt: float) -> Iterable[OutgoingMessage]:
        before, now = self._before, self._body.velocity
        self._before = now
        if not self._timer.is_due():
            return ()
        ax, ay = (now[0] - before[0]) / dt, (now[1] - before[1]) / dt
        theta = self._body.pose.theta
        cos, sin = math.cos(theta), math.sin(theta)
        measured = theta, now[2], cos * ax + sin * ay, cos * ay - sin * ax
        sent = self._truth.publish(lambda: self._make_message(*measured, _NO_NOISE, _NO_NOISE, _NO_NOISE))
        if self._params.enabled:
            channels = (
                self._params.orientation,
                self._params.angular_velocity,
                self._params.linear_acceleration,
            )
            sent += self._imu.publish(lambda: self._make_message(*measured, *channels))
        if self._params.broadcast_tf:
            sent += self._tf.publish(self._make_transform)
        return sent

    def _make_message(
        self,
        theta: float,
        turn: float,
        ax: float,
        ay: float,
        orientation: ImuChannel,
        angular_velocity: ImuChannel,
        linear_acceleration: ImuChannel,
    ) -> sensor_msgs.Imu:
        _, _, yaw = self._add_noise(0, (0.0, 0.0, theta), orientation.noise)
        wx, wy, wz = self._add_noise(3, (0.0, 0.0, turn), angular_velocity.noise)
        ax, ay, az = self._add_noise(6, (ax, ay, 0.0), linear_acceleration.noise)
        return sensor_msgs.Imu(
            header=Header(stamp=self._context.clock.stamp, frame_id=self._frame),
            orientation=yaw_quaternion(yaw),
            orientation_covariance=np.array(orientation.covariance),
            angular_velocity=Vector3(x=wx, y=wy, z=wz),
            angular_velocity_covariance=np.array(angular_velocity.covariance),
            linear_acceleration=Vector3(x=ax, y=ay, z=az),
            linear_acceleration_covariance=np.array(linear_acceleration.covariance),
        )

    def _add_noise(self, first: int, values: Sequence[float], variances: Sequence[float]) -> list[float]:
        """Three values with normal noise; ``first`` numbers them within a step."""
        return [
            value + self._noise.normal(9 * self._context.clock.tick + first + i, math.sqrt(variance))
            for i, (value, variance) in enumerate(zip(values, variances, strict=True))
        ]

    def _make_transform(self) -> TFMessage:
        parent = self._context.model.frame(self._body.name)
        return tf_message(transform_message(self._context.clock.stamp, parent, self._frame, Pose()))


PLUGIN_TYPE = PluginType("Imu", Imu, read_params, example="body: base")
