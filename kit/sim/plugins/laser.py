"""A laser scanner."""

from __future__ import annotations

import math
from array import array
from collections.abc import Iterable
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from kit.arrays import Float32Array
from kit.geometry import Pose
from kit.kernels.lidar_index import make_beams
from kit.msg.sensor_msgs import LaserScan
from kit.msg.std_msgs import Header
from kit.msg.tf2_msgs import TFMessage
from kit.sim.laser_scene import Scanner
from kit.sim.plugin import OutgoingMessage, Plugin, PluginContext, PluginType
from kit.sim.plugin_clock import UpdateTimer
from kit.sim.plugin_messages import TF_TOPIC, read_rate, read_topic, tf_message, transform_message
from kit.world.plugin_reader import ModelScope
from kit.world.records import LaserMount
from kit.world.yaml_section import Section

MAX_RAYS = 10_000
MAX_TURNS = 2.0
"""Directions of more turns than this are no radians."""

REFLECTANCE_LAYER = "reflectance"
"""The layer whose walls and footprints shine."""

OUT_OF_RANGE = MappingProxyType({"nan": math.nan, "inf": math.inf})

SAME_HIT_DISTANCE = 1e-3
"""Two hits this near to each other [m] are one."""


@dataclass(frozen=True, slots=True)
class LaserParams:
    mount: LaserMount
    """The body that carries it, the layers it sees, and its pose on the body."""
    max_range: float
    angle_min: float
    angle_max: float
    angle_increment: float
    directions: tuple[float, ...]
    """Direction of each ray in the laser's frame [rad]."""
    topic: str
    frame: str
    broadcast_tf: bool
    always_publish: bool
    rate: float
    noise: float
    range_min: float
    """What the messages say of the nearest range [m]."""
    out_of_range: float
    """What the messages say where nothing is in range."""
    reflectance_bit: int
    """The bit of the layer "reflectance"; 0 where the world has none."""

    def build(self, context: PluginContext) -> Laser:
        return Laser(self, context)


def read_params(section: Section, scope: ModelScope) -> LaserParams:
    angles = section.section("angle")
    low = angles.number("min")
    high = angles.number("max")
    increment = angles.number("increment", above=0)
    angles.finish()
    if high < low:
        angles.error('"max" must not be below "min"', "max")
    if max(abs(low), abs(high)) > MAX_TURNS * math.tau:
        turns = max(abs(low), abs(high)) / math.tau
        angles.error(
            f'"min" and "max" are radians: {turns:.3g} turns. {high:g} degrees are {math.radians(high):.4g}',
            "max",
        )
    rays = math.floor((max(high, low) - low) / increment + 0.5) + 1
    if rays > MAX_RAYS:
        angles.error(f"{rays} rays are too many: at most {MAX_RAYS}", "increment")
        rays = 1
    directions = [low + i * increment for i in range(rays)]
    if section.flag("upside_down", False):
        directions = [-direction for direction in directions]
    if section.flag("flipped", False):
        directions.reverse()
    return LaserParams(
        mount=LaserMount(scope.body(section, "body"), scope.layers(section), section.pose("origin", Pose())),
        max_range=section.number("range", above=0),
        angle_min=low,
        angle_max=high,
        angle_increment=increment,
        directions=tuple(directions),
        topic=read_topic(section, "topic", "scan"),
        frame=section.name("frame", ""),
        broadcast_tf=section.flag("broadcast_tf", True),
        always_publish=section.flag("always_publish", False),
        rate=read_rate(section, "update_rate"),
        noise=section.number("noise_std_dev", 0.0, minimum=0),
        range_min=section.number("range_min", 0.0, minimum=0),
        out_of_range=section.choice("out_of_range", OUT_OF_RANGE, "nan"),
        reflectance_bit=scope.layer_bits.get(REFLECTANCE_LAYER, 0),
    )


class Laser(Plugin):
    """Publishes sensor_msgs/LaserScan: how far it is, in each direction, to the nearest wall or footprint.

    It scans before the step, all rays at one instant. Ray i points to ``angle.min + i * increment``,
    counter-clockwise; there are ``round((max - min) / increment) + 1``.

    ==================== ===============================================================================
    body                 the body that carries it
    range                how far it sees [m]
    angle                the directions of its rays, in its own frame
    angle.min, angle.max direction of the first and the last ray [rad]
    angle.increment      from one ray to the next [rad]
    topic                what it publishes
    frame                frame of the messages; by default the plugin's name
    origin               its pose on the body [m, m, rad]
    layers               what it sees: whatever is in one of these layers; all: in any
    update_rate          scans per second [Hz]; .inf: at every step
    noise_std_dev        standard deviation of the noise on each hit [m]
    range_min            what messages say of the nearest range [m]; nearer things are seen all the same
    out_of_range         what messages say where nothing is in range
    broadcast_tf         whether to publish where its frame is on /tf
    always_publish       whether to publish without subscribers too
    upside_down          mounted upside down: ray i points to the negative of its angle
    flipped              the message lists the rays from last to first
    ==================== ===============================================================================

    Sensor footprints are invisible, and so is a footprint around the laser; the
    rest of its own robot is not. Noise depends on the seed, the laser, the step and the ray alone.

    Where the world has a layer named ``reflectance``, intensities are 255 where the ray ends at something in that
    layer, else 0. In Flatland anything reflecting behind the first wall could shine through it; not here.
    """

    def __init__(self, params: LaserParams, context: PluginContext) -> None:
        self._params = params
        self._context = context
        self._has_subscribers = context.has_subscribers
        self._clock, self._scene = context.clock, context.laser_scene
        self._body = context.bodies[params.mount.body]
        self._timer = UpdateTimer(params.rate, context.clock)
        self._shows_nan = math.isnan(params.out_of_range)
        self._beams = make_beams(params.directions)
        scanned = context.laser_scene, self._beams, params.max_range, params.mount.bits
        self._scanner = Scanner(*scanned)
        self._reflections = Scanner(*scanned, params.reflectance_bit) if params.reflectance_bit else None
        self._name = context.model.name, context.name
        self._frame = context.model.frame(params.frame or context.name)
        self._blank_scan = LaserScan(
            header=Header(frame_id=self._frame),
            angle_min=params.angle_min,
            angle_max=params.angle_max,
            angle_increment=params.angle_increment,
            range_min=params.range_min,
            range_max=params.max_range,
        )
        """What all scans have in common; a copy is made sooner than a message."""
        scans = context.publisher(params.topic, LaserScan)
        self._topic = scans.topic
        self.endpoints = [scans.endpoint]
        if params.broadcast_tf:
            self.endpoints.append(context.publisher(TF_TOPIC, TFMessage).endpoint)

    def reset(self, seed: int) -> None:
        self._noise_key = seed

    def before_step(self, dt: float) -> Iterable[OutgoingMessage]:
        if not self._timer.is_due():
            return ()
        has_subscribers, params = self._has_subscribers, self._params
        sent = []
        if has_subscribers(self._topic) or params.always_publish:
            sent.append(OutgoingMessage(self._topic, self._scan_message()))
        if params.broadcast_tf and has_subscribers(TF_TOPIC):
            sent.append(OutgoingMessage(TF_TOPIC, self._make_transform()))
        return sent

    def _scan_message(self) -> LaserScan:
        params, clock, message = self._params, self._clock, self._blank_scan.__deepcopy__(None)
        pose = self._body.pose.compose(params.mount.origin)
        if self._reflections is not None:
            message.intensities = _intensities(self._scanner.scan(pose), self._reflections.scan(pose))
        ranges = self._scanner.scan(pose, (params.noise, self._noise_key, clock.tick))
        self._scene.keep_latest(self._name, pose, self._beams, ranges, params.max_range)
        reported = ranges if self._shows_nan else self._reported_ranges(ranges)
        message.header.stamp = clock.stamp
        message.ranges = array("f", reported.tobytes())
        return message

    def _reported_ranges(self, ranges: Float32Array) -> Float32Array:
        """The ranges as the message has them, where that is not NaN for nothing in range."""
        return np.where(np.isnan(ranges), np.float32(self._params.out_of_range), ranges)

    def _make_transform(self) -> TFMessage:
        parent = self._context.model.frame(self._body.name)
        return tf_message(
            transform_message(self._context.clock.stamp, parent, self._frame, self._params.mount.origin)
        )


def _intensities(ranges: Float32Array, reflecting: Float32Array) -> array[float]:
    """255 where the nearest thing reflects."""
    bright = reflecting <= ranges + SAME_HIT_DISTANCE
    return array("f", [255.0 if each else 0.0 for each in bright])


PLUGIN_TYPE = PluginType(
    "Laser",
    Laser,
    read_params,
    example="body: base\nrange: 10\nangle: {min: -3.14, max: 3.14, increment: 0.07}",
)
