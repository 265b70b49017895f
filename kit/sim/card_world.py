"""Loads the world of a map's card, and adds carts that go to and fro to a world."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from kit.sim.plugins.tween import TweenParams
from kit.sim.simulation import load_model, load_world
from kit.world.catalogue import MapCard, MovingCart, maps_folder
from kit.world.records import Model, World

CART_MODEL: Final = ("crossing", "slow_cart.model.yaml")
"""Folder and file of the cart that is added to maps."""


def load_card_world(card: MapCard) -> World:
    """Loads a map's world with the carts of its card. Raises WorldError."""
    return with_carts(load_world(card.world_file, root=card.root), card.carts)


def with_carts(world: World, carts: Sequence[MovingCart]) -> World:
    """The world with these carts in it. Raises WorldError."""
    if not carts:
        return world
    file = maps_folder().joinpath(*CART_MODEL)
    added = [
        _moving_cart(load_model(file, world, name=cart.name, namespace=cart.name, pose=cart.start), cart)
        for cart in carts
    ]
    return replace(world, models=(*world.models, *added))


def _moving_cart(model: Model, cart: MovingCart) -> Model:
    """A cart's model with the way of one cart."""
    plugins = tuple(
        replace(plugin, params=replace(plugin.params, delta=cart.delta, duration=cart.duration))
        if isinstance(plugin.params, TweenParams)
        else plugin
        for plugin in model.plugins
    )
    return replace(model, plugins=plugins)
