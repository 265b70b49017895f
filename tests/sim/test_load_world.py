"""Worlds with devices, read and built."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import pytest

from kit.msg.std_msgs import String
from kit.sim.plugin import OutgoingMessage, Plugin, PluginContext
from kit.sim.plugins import plugin_readers
from kit.sim.simulation import Simulation
from kit.world.loading import load_world
from kit.world.plugin_reader import ModelScope
from kit.world.problems import WorldError
from kit.world.yaml_section import Section
from tests.sim.workshop import FLATLAND, OURS, Workshop


@dataclass(frozen=True)
class DummyParams:
    """What Flatland's dummy plugin wants to be told."""

    text: str
    number: float
    count: int

    def build(self, site: PluginContext) -> Plugin:
        return Dummy(self, site)


class Dummy(Plugin):
    def __init__(self, params: DummyParams, site: PluginContext) -> None:
        self._params = params
        self._publisher = site.publisher("dummy", String)
        self.endpoints = [self._publisher.endpoint]

    def after_step(self, dt: float) -> Iterable[OutgoingMessage]:
        return self._publisher.publish(lambda: String(data=self._params.text))


def read_dummy(section: Section, scope: ModelScope) -> DummyParams:
    text = section.text("dummy_param_string")
    if text != "dummy_test_123456":
        section.error(f"dummy_param_string must be dummy_test_123456, not {text}", "dummy_param_string")
    return DummyParams(text, section.number("dummy_param_float"), section.integer("dummy_param_int"))


DUMMY = {**plugin_readers, "DummyModelPlugin": read_dummy}
FOLDER = FLATLAND / "flatland_server" / "test" / "plugin_manager_tests"
needs_flatland = pytest.mark.skipif(not FOLDER.exists(), reason="Flatland's own worlds are not here")


@needs_flatland
def test_a_device_from_elsewhere() -> None:
    world = load_world(FOLDER / "load_dummy_test" / "world.yaml", plugin_readers=DUMMY)
    [spec] = world.models[0].plugins
    assert spec.params == DummyParams("dummy_test_123456", 0.123456, 123456)
    assert Simulation(world).step() == [OutgoingMessage("/dummy", String(data="dummy_test_123456"))]


@needs_flatland
@pytest.mark.parametrize(
    ("folder", "words"),
    [
        ("nonexistent_plugin", "RandomPlugin"),
        ("invalid_plugin_yaml", "name"),
        ("duplicate_plugin", "dummy_test_plugin"),
        ("plugin_throws_exception", "must be dummy_test_123456"),
    ],
)
def test_what_flatland_refuses(folder: str, words: str) -> None:
    with pytest.raises(WorldError, match=words):
        load_world(FOLDER / folder / "world.yaml", plugin_readers=DUMMY, root=FOLDER)


@needs_flatland
@pytest.mark.parametrize(
    ("folder", "words"),
    [
        ("laser_tests/invalid_A", "range"),
        ("laser_tests/invalid_B", "max"),
        ("bumper_tests/invalid_A", "random_body"),
        ("model_tf_publisher_tests/invalid_A", "random_body"),
        ("model_tf_publisher_tests/invalid_B", "random_body_1"),
    ],
)
def test_what_flatlands_plugins_refuse(workshop: Workshop, folder: str, words: str) -> None:
    with pytest.raises(WorldError, match=words):
        workshop.find(f"flatland:flatland_plugins/test/{folder}/world.yaml")


@needs_flatland
@pytest.mark.parametrize(
    "path",
    sorted(FLATLAND.glob("flatland_plugins/test/**/*world*.yaml")),
    ids=lambda path: f"{path.parent.name}-{path.name}",
)
def test_flatlands_worlds_run(path: Path) -> None:
    if "invalid" not in path.parent.name:
        simulation = Simulation(load_world(path, plugin_readers=plugin_readers, root=FLATLAND))
        simulation.step(20)
        assert simulation.tick == 20


def test_a_world_read_without_its_devices_says_what_to_do() -> None:
    world = load_world(OURS / "laser" / "world.yaml")
    with pytest.raises(TypeError, match=r"robot.model.yaml:\d+:\d+: .*kit.sim.simulation.load_world"):
        Simulation(world)
