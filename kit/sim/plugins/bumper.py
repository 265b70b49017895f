"""A bumper all around a model."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from kit.msg.flatland_msgs import Collision, Collisions, Vector2
from kit.msg.std_msgs import Header
from kit.sim.plugin import OutgoingMessage, Plugin, PluginContext, PluginType
from kit.sim.plugin_clock import UpdateTimer
from kit.sim.plugin_messages import read_rate, read_topic
from kit.sim.state import Contact
from kit.world.plugin_reader import ModelScope
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class BumperParams:
    topic: str
    frame: str
    rate: float
    publish_all: bool
    exclude: frozenset[str]

    def build(self, context: PluginContext) -> Bumper:
        return Bumper(self, context)


def read_params(section: Section, scope: ModelScope) -> BumperParams:
    return BumperParams(
        topic=read_topic(section, "topic", "collisions"),
        frame=section.name("world_frame_id", "map"),
        rate=read_rate(section, "update_rate"),
        publish_all=section.flag("publish_all_collisions", True),
        exclude=frozenset(scope.bodies(section, "exclude")),
    )


class Bumper(Plugin):
    """Publishes flatland_msgs/Collisions: what the model's bodies touch, after each step.

    ====================== ==============================================================
    topic                  what it publishes
    world_frame_id         the frame named in the header
    update_rate            reports per second [Hz]; .inf: at every step
    publish_all_collisions report at every step while anything touches, whatever the rate
    exclude                names of bodies whose contacts are not reported
    ====================== ==============================================================

    Entity and body a are the model's own, and normals point from a to b. A wall is named by its layer's first
    name, as entity and as body. Sensor footprints are reported with no points. Forces are rough: the impulse of
    the contact over the step's length.
    """

    def __init__(self, params: BumperParams, context: PluginContext) -> None:
        self._params = params
        self._context, self._has_subscribers = context, context.has_subscribers
        self._timer = UpdateTimer(params.rate, context.clock)
        self._publisher = context.publisher(params.topic, Collisions)
        self.endpoints = [self._publisher.endpoint]

    def after_step(self, dt: float) -> Iterable[OutgoingMessage]:
        if not self._has_subscribers(self._publisher.topic):
            return ()
        due = self._timer.is_due()
        if not (due or self._params.publish_all):
            return ()
        found = list(self._own_collisions())
        if not due and not found:
            return ()
        header = Header(stamp=self._context.clock.stamp, frame_id=self._params.frame)
        return self._publisher.publish(lambda: Collisions(header=header, collisions=found))

    def _own_collisions(self) -> Iterator[Collision]:
        own = self._context.model.name
        for contact in self._context.physics.contacts():
            if contact.entity_a == own:
                if contact.body_a not in self._params.exclude:
                    yield _collision_message(contact)
            elif contact.entity_b == own and contact.body_b not in self._params.exclude:
                yield _collision_message(contact.reversed)


def _collision_message(contact: Contact) -> Collision:
    x, y = contact.normal
    return Collision(
        entity_a=contact.entity_a,
        body_a=contact.body_a,
        entity_b=contact.entity_b,
        body_b=contact.body_b,
        magnitude_forces=array("d", [contact.force] * len(contact.points)),
        contact_positions=[Vector2(x=px, y=py) for px, py in contact.points],
        contact_normals=[Vector2(x=x, y=y) for _ in contact.points],
    )


PLUGIN_TYPE = PluginType("Bumper", Bumper, read_params, example="")
