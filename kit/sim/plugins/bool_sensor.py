"""A touch sensor of one body."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from kit.msg.std_msgs import Bool
from kit.sim.plugin import OutgoingMessage, Plugin, PluginContext, PluginType
from kit.sim.plugin_clock import UpdateTimer
from kit.sim.plugin_messages import read_rate, read_topic
from kit.world.plugin_reader import ModelScope
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class BoolSensorParams:
    body: str
    topic: str
    rate: float

    def build(self, context: PluginContext) -> BoolSensor:
        return BoolSensor(self, context)


def read_params(section: Section, scope: ModelScope) -> BoolSensorParams:
    first = scope.model.bodies[0].name if scope.model.bodies else ""
    return BoolSensorParams(
        body=scope.body(section, "body", first),
        topic=read_topic(section, "topic", "bool_sensor"),
        rate=read_rate(section, "update_rate"),
    )


class BoolSensor(Plugin):
    """Publishes std_msgs/Bool: whether anything touches the body now, or did since the last message.

    =========== ======================================================
    body        the body that feels; by default the first of the model
    topic       what it publishes
    update_rate messages per second [Hz]; .inf: at every step
    =========== ======================================================

    Footprints with ``sensor: true`` feel what overlaps them. In Flatland the topic gets the namespace
    twice; here once, like every other.
    """

    def __init__(self, params: BoolSensorParams, context: PluginContext) -> None:
        self._physics = context.physics
        self._body = context.bodies[params.body]
        self._timer = UpdateTimer(params.rate, context.clock)
        self._publisher = context.publisher(params.topic, Bool)
        self.endpoints = [self._publisher.endpoint]

    def reset(self, seed: int) -> None:
        self._has_touched = False

    def after_step(self, dt: float) -> Iterable[OutgoingMessage]:
        self._has_touched = self._has_touched or self._physics.is_touching(self._body)
        if not self._timer.is_due():
            return ()
        touched, self._has_touched = self._has_touched, False
        return self._publisher.publish(lambda: Bool(data=touched))


PLUGIN_TYPE = PluginType("BoolSensor", BoolSensor, read_params, example="")
