"""Publishes the transforms of a model's bodies."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from kit.msg.tf2_msgs import TFMessage
from kit.sim.plugin import OutgoingMessage, Plugin, PluginContext, PluginType
from kit.sim.plugin_clock import UpdateTimer
from kit.sim.plugin_messages import TF_TOPIC, read_rate, tf_message, transform_message
from kit.world.plugin_reader import ModelScope
from kit.world.records import Model
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class ModelTfPublisherParams:
    reference: str
    world_frame: str | None
    """None where the world is not published."""
    rate: float
    exclude: frozenset[str]

    def build(self, context: PluginContext) -> ModelTfPublisher:
        return ModelTfPublisher(self, context)


def read_params(section: Section, scope: ModelScope) -> ModelTfPublisherParams:
    world_frame = section.name("world_frame_id", "map").removeprefix("/")
    first = scope.model.bodies[0].name if scope.model.bodies else ""
    return ModelTfPublisherParams(
        reference=scope.body(section, "reference", first),
        world_frame=world_frame if section.flag("publish_tf_world", False) else None,
        rate=read_rate(section, "update_rate"),
        exclude=frozenset(scope.bodies(section, "exclude")),
    )


def frame_in_world(model: Model) -> str:
    """The frame on /tf that says where a model is in the world; empty where nothing publishes it."""
    for plugin in model.plugins:
        params = plugin.params
        if isinstance(params, ModelTfPublisherParams) and params.world_frame is not None:
            return model.frame(params.reference)
    return ""


class ModelTfPublisher(Plugin):
    """Publishes on /tf where the model's bodies are, before each step.

    ================ ===============================================================================
    reference        the body in whose frame the others are given; by default the first of the model
    publish_tf_world whether to publish where the reference is in the world too
    world_frame_id   the world's frame
    update_rate      updates per second [Hz]; .inf: at every step
    exclude          names of bodies that are left out
    ================ ===============================================================================

    Bodies' frames are named ``namespace_body``; the world's, which all models share, has no prefix.
    """

    def __init__(self, params: ModelTfPublisherParams, context: PluginContext) -> None:
        self._params = params
        self._context = context
        self._reference = context.bodies[params.reference]
        self._timer = UpdateTimer(params.rate, context.clock)
        self._tf = context.publisher(TF_TOPIC, TFMessage)
        self.endpoints = [self._tf.endpoint]

    def before_step(self, dt: float) -> Iterable[OutgoingMessage]:
        return self._tf.publish(self._transforms) if self._timer.is_due() else ()

    def _transforms(self) -> TFMessage:
        stamp, frame = self._context.clock.stamp, self._context.model.frame
        parent, pose = frame(self._params.reference), self._reference.pose
        found = [
            transform_message(stamp, parent, frame(body.name), pose.relative(body.pose))
            for body in self._context.bodies.values()
            if body is not self._reference and body.name not in self._params.exclude
        ]
        if self._params.world_frame is not None:
            found.append(transform_message(stamp, self._params.world_frame, parent, pose))
        return tf_message(*found)


PLUGIN_TYPE = PluginType("ModelTfPublisher", ModelTfPublisher, read_params, example="")
