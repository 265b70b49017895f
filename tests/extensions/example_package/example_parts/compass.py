"""A device: a compass."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from kit.msg.std_msgs import Float64
from kit.sim.plugin import OutgoingMessage, Plugin, PluginContext, PluginType
from kit.sim.plugin_messages import read_topic
from kit.world.plugin_reader import ModelScope
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class CompassParams:
    body: str
    topic: str

    def build(self, context: PluginContext) -> Compass:
        return Compass(self, context)


def read_params(section: Section, scope: ModelScope) -> CompassParams:
    return CompassParams(scope.body(section, "body"), read_topic(section, "topic", "compass"))


class Compass(Plugin):
    """Publishes std_msgs/Float64: the heading of a body [rad], counter-clockwise from the world's x axis.

    ===== ====================
    body  the body it is on
    topic what it publishes
    ===== ====================
    """

    def __init__(self, params: CompassParams, context: PluginContext) -> None:
        self._body = context.bodies[params.body]
        self._publisher = context.publisher(params.topic, Float64)
        self.endpoints = [self._publisher.endpoint]

    def after_step(self, dt: float) -> Iterable[OutgoingMessage]:
        return self._publisher.publish(lambda: Float64(data=self._body.pose.theta))


PLUGIN_TYPE = PluginType("Compass", Compass, read_params, example="body: base")
