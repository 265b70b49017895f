"""What every device promises, asked of each that lies in the folder: a new one is tested unasked."""

from __future__ import annotations

import pkgutil
from typing import Any

import pytest
import yaml

from kit.msg.geometry_msgs import Twist, Vector3
from kit.msg.message import check_message
from kit.msg.std_msgs import Bool
from kit.sim import plugins
from kit.sim.plugin import OutgoingMessage
from kit.sim.simulation import Simulation
from kit.world.problems import WorldError
from kit.world.records import World
from tests.sim.workshop import Workshop

SAYS = {Twist: Twist(linear=Vector3(x=0.3), angular=Vector3(z=0.4)), Bool: Bool(data=True)}
"""Something to say on each kind of topic that a device listens to."""

EVERY = [*plugins.plugin_types.values(), *plugins.world_plugin_types.values()]


def example_world(workshop: Workshop, type_: str, **changes: Any) -> World:
    """A car among walls with one device, as the device's own example has it."""
    device = {**plugins.plugin_types, **plugins.world_plugin_types}[type_]
    entry = {"type": type_, "name": "device", **(yaml.safe_load(device.example) or {}), **changes}
    wheels = {"front": (0, 0), "left": (-0.3, 0.1), "right": (-0.3, -0.1)}
    wheel = {"type": "circle", "radius": 0.02, "density": 1, "layers": []}
    car = {
        "bodies": [{"name": "base", "footprints": [workshop.rectangle(-0.35, 0.05, -0.1, 0.1)]}]
        + [{"name": name, "pose": [*at, 0], "footprints": [wheel]} for name, at in wheels.items()],
        "joints": [
            {
                "name": name,
                "type": "revolute" if name == "front" else "weld",
                "bodies": [{"name": "base", "anchor": at}, {"name": name, "anchor": [0, 0]}],
            }
            for name, at in wheels.items()
        ],
        "plugins": [entry] if type_ in plugins.plugin_types else [],
    }
    return workshop.world(
        {"robot": car},
        {"walls": [[0.5, -5, 0.5, 5], [-3, -5, -3, 5]]},
        namespaces={"robot": "ns"},
        plugins=[entry] if type_ in plugins.world_plugin_types else [],
    )


def run(simulation: Simulation, steps: int = 150) -> list[OutgoingMessage]:
    for endpoint in simulation.endpoints:
        if endpoint.direction == "subscribe":
            simulation.accept(endpoint.topic, SAYS[endpoint.type])
    return simulation.step(steps)


def test_the_folder_is_the_registry() -> None:
    files = {module.name.replace("_", "") for module in pkgutil.iter_modules(plugins.__path__)}
    assert {device.type.lower() for device in EVERY} == files
    assert {"BoolSensor", "Bumper", "DiffDrive", "Laser", "ModelTfPublisher", "TricycleDrive", "Tween"} <= {
        *plugins.plugin_types
    }
    assert "RandomWall" in plugins.world_plugin_types


@pytest.mark.parametrize("type_", [device.type for device in EVERY])
class TestDevice:
    def test_sends_what_it_declares(self, workshop: Workshop, type_: str) -> None:
        simulation = Simulation(example_world(workshop, type_))
        declared = {(e.topic, e.type) for e in simulation.endpoints if e.direction == "publish"}
        sent = run(simulation)
        assert {(out.topic, type(out.message)) for out in sent} == declared
        for out in sent:
            check_message(out.message)
            assert out.topic == "/tf" or out.topic.startswith("/ns/")

    def test_repeats_itself(self, workshop: Workshop, type_: str) -> None:
        world = example_world(workshop, type_)
        first, second = Simulation(world, seed=3), Simulation(world, seed=3)
        assert repr(run(first)) == repr(run(second))  # nan is not equal to itself
        assert first.state() == second.state()

    @pytest.mark.long_cases("TricycleDrive")
    def test_starts_again(self, workshop: Workshop, type_: str) -> None:
        simulation = Simulation(example_world(workshop, type_), seed=3)
        start, outlines = simulation.state(), simulation.outlines()
        sent = run(simulation)
        simulation.reset()
        assert (simulation.state(), simulation.outlines()) == (start, outlines)
        assert repr(run(simulation)) == repr(sent)

    def test_is_silent_when_nobody_listens_and_does_the_same(self, workshop: Workshop, type_: str) -> None:
        world = example_world(workshop, type_)
        heard, unheard = Simulation(world), Simulation(world, has_subscribers=lambda topic: False)
        run(heard)
        assert run(unheard) == []
        assert heard.state() == unheard.state()

    def test_refuses_a_key_that_it_does_not_know(self, workshop: Workshop, type_: str) -> None:
        with pytest.raises(WorldError, match="favourite_colour"):
            example_world(workshop, type_, favourite_colour="blue")

    def test_can_be_switched_off(self, workshop: Workshop, type_: str) -> None:
        assert Simulation(example_world(workshop, type_, enabled=False)).endpoints == []
