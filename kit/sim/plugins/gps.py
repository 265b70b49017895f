"""Satellite navigation."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from kit.geometry import Pose
from kit.msg.sensor_msgs import NavSatFix
from kit.msg.std_msgs import Header
from kit.msg.tf2_msgs import TFMessage
from kit.sim.plugin import OutgoingMessage, Plugin, PluginContext, PluginType
from kit.sim.plugin_clock import UpdateTimer
from kit.sim.plugin_messages import TF_TOPIC, read_rate, read_topic, tf_message, transform_message
from kit.world.plugin_reader import ModelScope
from kit.world.yaml_section import Section

SEMI_MAJOR_AXIS = 6378137.0
"""WGS 84's semi-major axis [m] ..."""
FLATTENING = 1.0 / 298.257223563
"""... and flattening."""


@dataclass(frozen=True, slots=True)
class GpsParams:
    body: str
    topic: str
    frame: str
    broadcast_tf: bool
    rate: float
    latitude: float
    longitude: float
    origin: Pose

    def build(self, context: PluginContext) -> Gps:
        return Gps(self, context)


def read_params(section: Section, scope: ModelScope) -> GpsParams:
    return GpsParams(
        body=scope.body(section, "body"),
        topic=read_topic(section, "topic", "gps/fix"),
        frame=section.name("frame", ""),
        broadcast_tf=section.flag("broadcast_tf", True),
        rate=read_rate(section, "update_rate", 10.0),
        latitude=section.number("ref_lat", 0.0, minimum=-90, maximum=90),
        longitude=section.number("ref_lon", 0.0, minimum=-180, maximum=180),
        origin=section.pose("origin", Pose()),
    )


class Gps(Plugin):
    """Publishes sensor_msgs/NavSatFix: latitude and longitude [degrees], before the step; altitude 0.

    ================ ========================================================================
    body             the body that carries the antenna
    origin           where on the body it is [m, m, rad]
    topic            what it publishes
    frame            frame of the messages; by default the plugin's name
    update_rate      fixes per second [Hz]
    ref_lat, ref_lon where the world's origin lies on earth [degrees]; x points east, y north
    broadcast_tf     whether to publish where its frame is on /tf
    ================ ========================================================================
    """

    def __init__(self, params: GpsParams, context: PluginContext) -> None:
        self._params = params
        self._context = context
        self._body = context.bodies[params.body]
        self._timer = UpdateTimer(params.rate, context.clock)
        self._frame = context.model.frame(params.frame or context.name)
        self._fix = context.publisher(params.topic, NavSatFix)
        self._tf = context.publisher(TF_TOPIC, TFMessage)
        self.endpoints = [self._fix.endpoint, *([self._tf.endpoint] if params.broadcast_tf else [])]

    def before_step(self, dt: float) -> Iterable[OutgoingMessage]:
        if not self._timer.is_due():
            return ()
        return self._fix.publish(self._make_message) + (
            self._tf.publish(self._make_transform) if self._params.broadcast_tf else []
        )

    def _make_message(self) -> NavSatFix:
        position = self._body.pose.compose(self._params.origin)
        latitude, longitude = geodetic_position(
            position.x, position.y, self._params.latitude, self._params.longitude
        )
        header = Header(stamp=self._context.clock.stamp, frame_id=self._frame)
        return NavSatFix(header=header, latitude=latitude, longitude=longitude)

    def _make_transform(self) -> TFMessage:
        parent = self._context.model.frame(self._body.name)
        return tf_message(
            transform_message(self._context.clock.stamp, parent, self._frame, self._params.origin)
        )


def geodetic_position(
    east: float, north: float, ref_latitude: float, ref_longitude: float
) -> tuple[float, float]:
    """Latitude and longitude [degrees] of a point on the plane that touches WGS 84 at the reference [degrees].

    By way of earth-centred coordinates; back to the ellipsoid with Bowring's formula (1976), whose error near
    the ground is far below a millimetre.
    """
    latitude, longitude = math.radians(ref_latitude), math.radians(ref_longitude)
    eccentricity2 = FLATTENING * (2.0 - FLATTENING)
    normal = SEMI_MAJOR_AXIS / math.sqrt(1.0 - eccentricity2 * math.sin(latitude) ** 2)
    outward = (
        normal * math.cos(latitude) - math.sin(latitude) * north
    )  # away from the axis, at the reference's side
    axial = normal * (1.0 - eccentricity2) * math.sin(latitude) + math.cos(latitude) * north
    radius = math.hypot(outward, east)
    pole = SEMI_MAJOR_AXIS * (1.0 - FLATTENING)
    reduced = math.atan2(axial * SEMI_MAJOR_AXIS, radius * pole)
    return (
        math.degrees(
            math.atan2(
                axial + eccentricity2 / (1.0 - eccentricity2) * pole * math.sin(reduced) ** 3,
                radius - eccentricity2 * SEMI_MAJOR_AXIS * math.cos(reduced) ** 3,
            )
        ),
        math.degrees(longitude + math.atan2(east, outward)),
    )


PLUGIN_TYPE = PluginType("Gps", Gps, read_params, example="body: base")
