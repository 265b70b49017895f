"""What differs on a level from its map: slower motors, a slippery floor, drifting odometry, fog, a battery, moving carts."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

from kit.geometry import Pose
from kit.run.scenario import Scenario
from kit.sim.motors import SpeedLimits
from kit.sim.plugins.diff_drive import DiffDriveParams
from kit.sim.plugins.tricycle_drive import TricycleDriveParams
from kit.sim.plugins.tween import TweenParams
from kit.sim.simulation import load_model
from kit.world.catalogue import maps_folder
from kit.world.records import Model, PluginSpec

CART_MODEL: Final = ("crossing", "slow_cart.model.yaml")
"""Folder and file of the cart that levels add to maps."""
SPEED: Final = 0.5
"""What the robot's motors give on a level, and what its keys ask for [m/s]."""
TURN_RATE: Final = 1.5
"""[rad/s]"""
PAIR_SPEED: Final = 0.52
"""The same for each of two wheelchairs: the outer one drives faster than the point between them [m/s]."""


@dataclass(frozen=True, slots=True)
class MovingCart:
    """A cart that goes to and fro by itself."""

    name: str
    start: Pose
    delta: Pose
    """From one end of its way to the other."""
    duration: float
    """Time from one end to the other [s]."""


@dataclass(frozen=True, slots=True)
class LevelConditions:
    """What differs on a level from its map."""

    acceleration: float = 0.0
    """Greatest change of speed [m/s^2], as on ice; three times as many rad/s^2 of turning. 0: none."""
    wheel_error: float = 0.0
    """The encoders' wheels differ by this share from what they are taken for; 0: odometry is exact."""
    fog: bool = False
    """Whether only what the laser has seen is drawn, and the target only once the robot is near."""
    charge: float = 0.0
    """Distance that one charge of the battery lasts [m]; 0: for ever."""
    docks: tuple[tuple[float, float], ...] = ()
    """Where standing still recharges the battery [m, m]."""
    carts: tuple[MovingCart, ...] = ()


UNCHANGED: Final = LevelConditions()


def apply_conditions(scenario: Scenario, conditions: LevelConditions) -> Scenario:
    """The scenario under a level's conditions. Raises WorldError."""
    world = scenario.world
    driven = set(scenario.partners)
    top_speed = PAIR_SPEED if len(driven) > 1 else SPEED
    models = [
        replace(model, plugins=tuple(_limited(each, conditions, top_speed) for each in model.plugins))
        if model.name in driven
        else model
        for model in world.models
    ]
    file = maps_folder().joinpath(*CART_MODEL)
    for cart in conditions.carts:
        model = load_model(file, world, name=cart.name, namespace="", pose=cart.start)
        models.append(_moving(model, cart))
    return replace(scenario, world=replace(world, models=tuple(models)))


def _limited(plugin: PluginSpec, conditions: LevelConditions, top_speed: float) -> PluginSpec:
    """A drive's plugin with the level's motors and odometry; any other as it is."""
    params = plugin.params
    if not isinstance(params, DiffDriveParams | TricycleDriveParams):
        return plugin
    acceleration = conditions.acceleration
    odometry = params.odometry
    if conditions.wheel_error:
        odometry = replace(odometry, use_encoders=True, wheel_error=conditions.wheel_error)
    linear = SpeedLimits(acceleration, acceleration, top_speed)
    if isinstance(params, TricycleDriveParams):
        return replace(plugin, params=replace(params, linear=linear, odometry=odometry))
    angular = SpeedLimits(3.0 * acceleration, 3.0 * acceleration, TURN_RATE)
    return replace(plugin, params=replace(params, linear=linear, angular=angular, odometry=odometry))


def _moving(model: Model, cart: MovingCart) -> Model:
    """A cart's model with the way of one cart."""
    plugins = tuple(
        replace(plugin, params=replace(plugin.params, delta=cart.delta, duration=cart.duration))
        if isinstance(plugin.params, TweenParams)
        else plugin
        for plugin in model.plugins
    )
    return replace(model, plugins=plugins)
