"""The joints of two driven wheels."""

from __future__ import annotations

import math
from array import array
from collections.abc import Iterable
from dataclasses import dataclass

from kit.msg import sensor_msgs
from kit.msg.std_msgs import Header
from kit.sim.plugin import OutgoingMessage, Plugin, PluginContext, PluginType
from kit.sim.plugin_clock import UpdateTimer
from kit.sim.plugin_messages import read_rate, read_topic
from kit.world.plugin_reader import ModelScope
from kit.world.yaml_section import Section


@dataclass(frozen=True, slots=True)
class JointStatesParams:
    body: str
    topic: str
    joints: tuple[str, str]
    """Names of the left and the right wheel's joint."""
    wheel_radius: float
    wheel_separation: float
    rate: float

    def build(self, context: PluginContext) -> JointStates:
        return JointStates(self, context)


def read_params(section: Section, scope: ModelScope) -> JointStatesParams:
    joints = section.texts("joints", ("wheel_left_joint", "wheel_right_joint"))
    if len(joints) != 2:
        section.error("two names are needed: of the left and of the right wheel's joint", "joints")
        joints = ("left", "right")
    return JointStatesParams(
        body=scope.body(section, "body"),
        topic=read_topic(section, "topic", "joint_states"),
        joints=(joints[0], joints[1]),
        wheel_radius=section.number("wheel_radius", 0.033, above=0),
        wheel_separation=section.number("wheel_separation", 0.16, above=0),
        rate=read_rate(section, "update_rate"),
    )


class JointStates(Plugin):
    """Publishes sensor_msgs/JointState after the step: how far two wheels have turned [rad], and how fast [rad/s].

    ================ ================================================
    body             the body between the wheels
    topic            what it publishes
    joints           names of the left and of the right wheel's joint
    wheel_radius     radius of both wheels [m]
    wheel_separation distance between the wheels [m]
    update_rate      messages per second [Hz]; .inf: at every step
    ================ ================================================

    The wheels turn as the body really moves: against a wall they stand.
    """

    def __init__(self, params: JointStatesParams, context: PluginContext) -> None:
        self._params = params
        self._context = context
        self._body = context.bodies[params.body]
        self._timer = UpdateTimer(params.rate, context.clock)
        self._publisher = context.publisher(params.topic, sensor_msgs.JointState)
        self.endpoints = [self._publisher.endpoint]

    def reset(self, seed: int) -> None:
        self._angles = [0.0, 0.0]

    def after_step(self, dt: float) -> Iterable[OutgoingMessage]:
        params = self._params
        vx, vy, turn = self._body.velocity
        theta = self._body.pose.theta
        forward = math.cos(theta) * vx + math.sin(theta) * vy
        speeds = [
            (forward + side * turn * params.wheel_separation / 2) / params.wheel_radius for side in (-1, 1)
        ]
        self._angles = [angle + speed * dt for angle, speed in zip(self._angles, speeds, strict=True)]
        if not self._timer.is_due():
            return ()
        return self._publisher.publish(lambda: self._make_message(speeds))

    def _make_message(self, speeds: list[float]) -> sensor_msgs.JointState:
        return sensor_msgs.JointState(
            header=Header(stamp=self._context.clock.stamp),
            name=list(self._params.joints),
            position=array("d", self._angles),
            velocity=array("d", speeds),
        )


PLUGIN_TYPE = PluginType("JointStates", JointStates, read_params, example="body: base")
