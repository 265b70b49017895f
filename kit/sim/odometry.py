"""Odometry of drives: publishes odometry, ground truth, twist and the transform of the odometry frame."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from kit.arrays import FloatArray
from kit.geometry import Pose
from kit.kernels import kernels
from kit.msg import geometry_msgs, nav_msgs
from kit.msg.std_msgs import Header
from kit.msg.tf2_msgs import TFMessage
from kit.sim.bodies import BodyTwist, PhysicalBody
from kit.sim.plugin import OutgoingMessage, PluginContext, PluginPublisher
from kit.sim.plugin_clock import RandomStream, UpdateTimer, stream_key
from kit.sim.plugin_messages import (
    TF_TOPIC,
    pose_message,
    read_rate,
    read_topic,
    read_variances,
    tf_message,
    transform_message,
    twist_message,
)
from kit.world.yaml_section import Section

Covariances = tuple[FloatArray, FloatArray]
"""Covariances of pose and twist, (36,) each."""

_NO_COVARIANCE: Covariances = np.zeros(36), np.zeros(36)

ENCODER_MODES = MappingProxyType({"ideal": False, "encoders": True})


@dataclass(frozen=True, slots=True)
class OdometryParams:
    """The keys that all drives share; see ``Odometry``."""

    odom_topic: str
    ground_truth_topic: str
    twist_topic: str
    odom_frame: str
    ground_truth_frame: str
    rate: float
    publish_odom: bool
    publish_twist: bool
    publish_tf: bool
    pose_noise: tuple[float, ...]
    """Variances of x, y [m^2], yaw [rad^2]."""
    twist_noise: tuple[float, ...]
    """Variances of forward, lateral [m^2/s^2], turn [rad^2/s^2]."""
    pose_covariance: tuple[float, ...]
    """36 numbers, row by row."""
    twist_covariance: tuple[float, ...]
    use_encoders: bool
    wheel_separation: float
    """[m]"""
    wheel_error: float
    """Standard deviation of a wheel's radius, as a fraction."""
    wheel_slip: float
    """Standard deviation of a wheel's measured distance, in m per square root of a metre."""


def read_odometry_params(section: Section) -> OdometryParams:
    odom_frame = section.name("odom_frame_id", "odom")
    pose_noise = read_variances(section, "odom_pose_noise")
    twist_noise = read_variances(section, "odom_twist_noise")
    return OdometryParams(
        odom_topic=read_topic(section, "odom_pub", "odometry/filtered"),
        ground_truth_topic=read_topic(section, "ground_truth_pub", "odometry/ground_truth"),
        twist_topic=read_topic(section, "twist_pub", "twist"),
        odom_frame=odom_frame,
        ground_truth_frame=section.name("ground_truth_frame_id", odom_frame),
        rate=read_rate(section, "pub_rate"),
        publish_odom=section.flag("enable_odom_pub", True),
        publish_twist=section.flag("enable_twist_pub", True),
        publish_tf=section.flag("enable_odom_tf_pub", True),
        pose_noise=pose_noise,
        twist_noise=twist_noise,
        pose_covariance=section.numbers("odom_pose_covariance", _diagonal_covariance(pose_noise), length=36),
        twist_covariance=section.numbers(
            "odom_twist_covariance", _diagonal_covariance(twist_noise), length=36
        ),
        use_encoders=section.choice("odometry", ENCODER_MODES, "ideal"),
        wheel_separation=section.number("wheel_separation", 0.145, above=0),
        wheel_error=section.number("wheel_error", 0.005, minimum=0),
        wheel_slip=section.number("wheel_slip", 0.002, minimum=0),
    )


def _diagonal_covariance(variances: Sequence[float]) -> tuple[float, ...]:
    """Builds a 6 x 6 covariance, in ROS's order x, y, z, roll, pitch, yaw."""
    x, y, yaw = variances
    return tuple(float(v) for v in np.diag([x, y, 0.0, 0.0, 0.0, yaw]).ravel())


class Odometry:
    """Reports the motion of one body that a drive moves.

    Ground truth is the true pose; ``odometry: ideal`` is the same, plus white noise with the given variances. With
    ``odometry: encoders`` it is what encoders on two wheels, ``wheel_separation`` apart, make of the commanded
    motion, and drifts: the radius of each wheel is wrong by a fraction drawn once, and every distance is
    measured with an error that grows with the root of its length. Against a wall the wheels slip, and the
    encoders count on; lifted and put elsewhere (``move_model``), they do not notice.

    Poses are those before the step, twists those just commanded, in the body's own frame: Flatland's ROS 2 port
    gives them in the world frame, against the definition of nav_msgs/Odometry.

    ===================== =================================================================================
    odom_pub              topic of the odometry, a nav_msgs/Odometry
    ground_truth_pub      topic of the same without noise
    twist_pub             topic of the odometry's twist, a geometry_msgs/TwistStamped
    odom_frame_id         frame of the odometry
    ground_truth_frame_id frame of the ground truth; by default that of the odometry
    pub_rate              reports per second [Hz]; .inf: at every step
    enable_odom_pub       whether to publish odometry and ground truth
    enable_twist_pub      whether to publish the twist
    enable_odom_tf_pub    whether to publish the odometry's transform on /tf
    odom_pose_noise       variances of x, y [m^2] and yaw [rad^2]
    odom_twist_noise      variances of forward, lateral [m^2/s^2] and turn [rad^2/s^2]
    odom_pose_covariance  6 x 6, row by row, in the messages; by default the noise's
    odom_twist_covariance likewise
    odometry              ``ideal``, or ``encoders`` for an estimate that drifts
    wheel_separation      distance of the two wheels with encoders [m]
    wheel_error           standard deviation of a wheel's radius, as a fraction
    wheel_slip            standard deviation of a wheel's measured distance, per square root of a metre [m]
    ===================== =================================================================================
    """

    def __init__(
        self, params: OdometryParams, context: PluginContext, body: PhysicalBody, origin_offset: float = 0.0
    ) -> None:
        """``origin_offset``: how far the body's origin lies before the axle of the two wheels [m]."""
        self._params = params
        self._body = body
        self._origin_offset = origin_offset
        self._clock, self._has_subscribers = context.clock, context.has_subscribers
        self._timer = UpdateTimer(params.rate, context.clock)
        self._base_frame = context.model.frame(body.name)
        self._odom_frame = context.model.frame(params.odom_frame)
        self._truth_frame = context.model.frame(params.ground_truth_frame)
        self._odom = context.publisher(params.odom_topic, nav_msgs.Odometry)
        self._truth = context.publisher(params.ground_truth_topic, nav_msgs.Odometry, is_ground_truth=True)
        self._twist = context.publisher(params.twist_topic, geometry_msgs.TwistStamped)
        self._tf = context.publisher(TF_TOPIC, TFMessage)
        enabled = {
            self._odom: params.publish_odom,
            self._truth: params.publish_odom,
            self._twist: params.publish_twist,
            self._tf: params.publish_tf,
        }
        self._covariances = np.array(params.pose_covariance), np.array(params.twist_covariance)
        self._enabled = [(publisher, publisher.topic) for publisher, is_on in enabled.items() if is_on]
        self.endpoints = [publisher.endpoint for publisher, _ in self._enabled]

    def reset(self, seed: int) -> None:
        self._noise_stream = RandomStream(seed)
        self._wheel_stream = RandomStream(stream_key(seed, "wheel radius"))
        self._wheel_errors: tuple[float, float] | None = None
        """Shares by which each wheel is larger; drawn at the first step, which needs the kernels anyway."""
        self._slip_stream = RandomStream(stream_key(seed, "wheel slip"))
        self._encoder_pose = self._body.pose
        """The body's pose according to its encoders."""

    def step(self, twist: BodyTwist, dt: float) -> list[OutgoingMessage]:
        """Returns the messages that are due, before the body moves with ``twist`` for ``dt``."""
        sent = self._make_messages(twist) if self._timer.is_due() else []
        if self._params.use_encoders:
            self._update_encoder_pose(twist, dt)
        return sent

    def _update_encoder_pose(self, twist: BodyTwist, dt: float) -> None:
        """Integrates the motion that the encoders measure."""
        half = self._params.wheel_separation / 2
        left, right = (
            self._encoder_distance(side, (twist[0] - twist[2] * offset) * dt)
            for side, offset in enumerate((half, -half))
        )
        forward, turn = (left + right) / 2 / dt, (right - left) / (2 * half) / dt
        self._encoder_pose = Pose(
            *kernels.twist_step(*self._encoder_pose, forward, turn * self._origin_offset, turn, dt)
        )

    def _encoder_distance(self, wheel: int, distance: float) -> float:
        """Returns the distance [m] that a wheel's encoder measures."""
        if self._wheel_errors is None:
            deviation = self._params.wheel_error
            self._wheel_errors = (
                self._wheel_stream.normal(0, deviation),
                self._wheel_stream.normal(1, deviation),
            )
        slip = self._slip_stream.normal(2 * self._clock.tick + wheel, self._params.wheel_slip)
        return distance * (1.0 + self._wheel_errors[wheel]) + slip * math.sqrt(abs(distance))

    def _make_messages(self, twist: BodyTwist) -> list[OutgoingMessage]:
        has_subscribers = self._has_subscribers
        wanted = [publisher for publisher, topic in self._enabled if has_subscribers(topic)]
        if not wanted:
            return []
        true = self._body.pose
        pose = self._add_noise(
            0, self._encoder_pose if self._params.use_encoders else true, self._params.pose_noise
        )
        noisy_twist = self._add_noise(3, twist, self._params.twist_noise)
        header = Header(stamp=self._clock.stamp, frame_id=self._base_frame)
        makers: dict[PluginPublisher, Callable[[], object]] = {
            self._odom: lambda: self._odometry_message(
                self._odom_frame, Pose(*pose), noisy_twist, self._covariances
            ),
            self._truth: lambda: self._odometry_message(self._truth_frame, true, twist, _NO_COVARIANCE),
            self._twist: lambda: geometry_msgs.TwistStamped(header=header, twist=twist_message(*noisy_twist)),
            self._tf: lambda: tf_message(
                transform_message(self._clock.stamp, self._odom_frame, self._base_frame, Pose(*pose))
            ),
        }
        return [OutgoingMessage(publisher.topic, makers[publisher]()) for publisher in wanted]

    def _add_noise(self, first_index: int, values: BodyTwist | Pose, variances: Sequence[float]) -> BodyTwist:
        """Three values with normal noise; ``first_index`` numbers them within a step."""
        a, b, c = (
            value + self._noise_stream.normal(6 * self._clock.tick + first_index + i, math.sqrt(variance))
            for i, (value, variance) in enumerate(zip(values, variances, strict=True))
        )
        return a, b, c

    def _odometry_message(
        self, frame: str, pose: Pose, twist: BodyTwist, covariances: Covariances
    ) -> nav_msgs.Odometry:
        of_pose, of_twist = covariances
        return nav_msgs.Odometry(
            header=Header(stamp=self._clock.stamp, frame_id=frame),
            child_frame_id=self._base_frame,
            pose=geometry_msgs.PoseWithCovariance(pose=pose_message(pose), covariance=of_pose.copy()),
            twist=geometry_msgs.TwistWithCovariance(twist=twist_message(*twist), covariance=of_twist.copy()),
        )
