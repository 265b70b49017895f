"""A sensor that says whether something touches a body."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from kit.msg.std_msgs import Bool
from kit.sim.clock import UpdateTimer
from kit.sim.context import Device, Site
from kit.sim.keys import read_rate, read_topic
from kit.sim.plugin import Outgoing, Plugin
from kit.world.plugin_reader import ModelScope, Section


@dataclass(frozen=True, slots=True)
class BoolSensorParams:
    body: str
    topic: str
    rate: float

    def build(self, site: Site) -> BoolSensor:
        return BoolSensor(self, site)


def read(section: Section, scope: ModelScope) -> BoolSensorParams:
    first = scope.model.bodies[0].name if scope.model.bodies else ""
    return BoolSensorParams(
        body=scope.body(section, "body", first),
        topic=read_topic(section, "topic", "bool_sensor"),
        rate=read_rate(section, "update_rate"),
    )


class BoolSensor(Plugin):
    """Publishes std_msgs/Bool: whether anything touches the body now, or did since the last message.

    ============ ===========================================================
    body         the body that feels (the first)
    topic        bool_sensor
    update_rate  messages per second; at every step by default
    ============ ===========================================================

    Footprints with ``sensor: true`` feel what overlaps them. In Flatland the topic gets the namespace
    twice; here once, like every other.
    """

    def __init__(self, params: BoolSensorParams, site: Site) -> None:
        self._physics = site.physics
        self._body = site.bodies[params.body]
        self._timer = UpdateTimer(params.rate, site.clock)
        self._bool = site.publisher(params.topic, Bool)
        self.endpoints = [self._bool.endpoint]

    def reset(self, seed: int) -> None:
        self._touched = False

    def after_step(self, dt: float) -> Iterable[Outgoing]:
        self._touched = self._touched or self._physics.is_touching(self._body)
        if not self._timer.due():
            return ()
        touched, self._touched = self._touched, False
        return self._bool.send(lambda: Bool(data=touched))


DEVICE = Device("BoolSensor", read, example="")
