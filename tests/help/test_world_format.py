"""The page of the world format says what the readers do: its keys, what must be given, and what is taken otherwise."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest
import yaml

from kit.help.topics import world_format
from kit.help.topics.world_format import (
    EXAMPLE,
    TOPIC,
    device_documentation,
    device_keys,
    map_keys,
    model_keys,
    world_keys,
)
from kit.sim.plugin import PluginType, WorldPluginType
from kit.sim.plugins import plugin_readers, plugin_types, world_plugin_readers, world_plugin_types
from kit.sim.simulation import Simulation
from kit.world.documents import open_document
from kit.world.key_table import FormatKey, format_keys, key_meanings
from kit.world.layer_reader import LayerReader
from kit.world.loading import load_world, read_world
from kit.world.model_loading import read_model
from kit.world.plugin_reader import FLATLAND_PREFIX, ModelScope, WorldScope
from kit.world.problems import WorldError
from kit.world.yaml_section import Section

ROOT = Path(__file__).parents[2]
DEVICES: dict[str, PluginType | WorldPluginType] = {**plugin_types, **world_plugin_types}
FORMATS = {
    "world": (world_keys, (read_world.__doc__ or "",)),
    "map": (map_keys, (LayerReader.read_map.__doc__ or "",)),
    "model": (model_keys, (read_model.__doc__ or "",)),
}
PLUGIN_KEYS = {"type", "name", "enabled"}


@pytest.mark.parametrize("name", FORMATS)
def test_every_key_of_a_file_is_explained_and_no_other(name: str) -> None:
    keys, documentation = FORMATS[name]
    meanings = [key for each in documentation for key in key_meanings(each)]
    assert sorted(meanings) == sorted(each.key for each in keys())


@pytest.mark.parametrize("type_", DEVICES)
def test_every_key_of_a_device_is_explained_and_no_other(type_: str) -> None:
    meanings = [key for each in device_documentation(DEVICES[type_]) for key in key_meanings(each)]
    assert sorted(meanings) == sorted(each.key for each in device_keys(DEVICES[type_]))


def test_keys_are_found_that_are_asked_for_in_the_place_of_others() -> None:
    """Also where a choice that is not the first one leads there; a condition says only what a choice decides."""

    def read(section: Section) -> None:
        if section.text("form", choices=("circle", "box")) == "box":
            section.number("width") if section.has("width") else section.number("corners")
        else:
            section.number("radius") if section.has("radius") else section.text("circle_of")

    found = {each.key: each.only_with for each in format_keys(read)}
    assert set(found) == {"form", "radius", "circle_of", "width", "corners"}
    assert (found["radius"], found["width"]) == ("form: circle", "form: box")


def written_keys(content: object, prefix: str = "") -> Iterator[str]:
    """The keys of a file, as ``FormatKey`` names them."""
    if isinstance(content, dict):
        for key, value in content.items():
            yield f"{prefix}{key}"
            yield from written_keys(value, f"{prefix}{key}.")
    elif isinstance(content, list):
        for each in content:
            yield from written_keys(each, f"{prefix.removesuffix('.')}[].")


def kit_files() -> Iterator[tuple[str, Path, Any]]:
    """The kit's world, map and model files."""
    for file in sorted((ROOT / "maps").rglob("*.yaml")):
        content = yaml.safe_load(file.read_text())
        if not isinstance(content, dict):
            continue
        if "layers" in content:
            yield "world", file, content
        elif "bodies" in content:
            yield "model", file, content
        elif "origin" in content:
            yield "map", file, content


@pytest.mark.parametrize("name", FORMATS)
def test_the_pages_know_every_key_of_the_maps(name: str) -> None:
    known = {each.key for each in FORMATS[name][0]()}
    found = [(file, content) for kind, file, content in kit_files() if kind == name]
    assert len(found) > 5
    unknown = []
    for file, content in found:
        plugins = content.pop("plugins", [])
        unknown += [
            (file, key)
            for key in written_keys(content)
            if key not in known and not key.startswith("layers[].properties.")
        ]
        for plugin in plugins:
            device = DEVICES[plugin["type"].removeprefix(FLATLAND_PREFIX)]
            known_here = {each.key for each in device_keys(device)} | PLUGIN_KEYS
            unknown += [(file, key) for key in written_keys(plugin) if key not in known_here]
    assert unknown == []


def read_device(device: PluginType | WorldPluginType, content: Mapping[str, Any], file: Path) -> object:
    """The parameters that a device's reader makes of its keys."""
    file.write_text(yaml.safe_dump(dict(content)))
    with open_document(file) as section:
        if isinstance(device, PluginType):
            wheels = {"front": (0.0, 0.0), "left": (-0.3, 0.1), "right": (-0.3, -0.1)}
            return device.read_params(section, ModelScope(_model(file.parent, wheels), {"walls": 1}))
        world = load_world(_world(file.parent))
        return device.read_params(section, WorldScope(world.layers, world.models, world.layer_bits))


def _model(folder: Path, wheels: Mapping[str, tuple[float, float]]) -> Any:
    circle = {"type": "circle", "radius": 0.02, "density": 1}
    content = {
        "bodies": [{"name": name, "footprints": [circle]} for name in ("base", *wheels)],
        "joints": [
            {
                "name": name,
                "type": "revolute" if name == "front" else "weld",
                "bodies": [{"name": "base", "anchor": list(at)}, {"name": name, "anchor": [0, 0]}],
            }
            for name, at in wheels.items()
        ],
    }
    (folder / "car.yaml").write_text(yaml.safe_dump(content))
    world = {"properties": {}, "layers": [], "models": [{"name": "robot", "model": "car.yaml"}]}
    (folder / "car_world.yaml").write_text(yaml.safe_dump(world))
    return load_world(folder / "car_world.yaml").models[0]


def _world(folder: Path) -> Path:
    for name, text in EXAMPLE.items():
        (folder / name).write_text(text)
    return folder / "world.yaml"


def _with(content: Mapping[str, Any], key: str, value: Any) -> dict[str, Any]:
    name, _, rest = key.partition(".")
    if not rest:
        return {**content, name: value}
    return {**content, name: _with(content.get(name, {}), rest, value)}


def _without(content: Mapping[str, Any], key: str) -> dict[str, Any]:
    name, _, rest = key.partition(".")
    if not rest:
        return {each: value for each, value in content.items() if each != name}
    return {**content, name: _without(content[name], rest)}


def _value(key: FormatKey) -> Any:
    count, times, item = (key.default or "").partition(" times ")
    return [yaml.safe_load(item)] * int(count) if times else yaml.safe_load(key.default or "")


@pytest.mark.parametrize("type_", DEVICES)
def test_a_default_that_is_written_out_changes_nothing(type_: str, tmp_path: Path) -> None:
    device = DEVICES[type_]
    example = yaml.safe_load(device.example) or {}
    plain = read_device(device, example, tmp_path / "device.yaml")
    for key in device_keys(device):
        if key.default in (None, "none", '""'):  # an empty text is what stands for a key that is left out
            continue
        written = _with(example, key.key, _value(key))
        if not (key.only_with or "body" in key.type):
            assert read_device(device, written, tmp_path / "device.yaml") == plain, key


@pytest.mark.parametrize("type_", DEVICES)
def test_what_is_required_must_be_given(type_: str, tmp_path: Path) -> None:
    device = DEVICES[type_]
    example = yaml.safe_load(device.example) or {}
    required = {each.key for each in device_keys(device) if each.default is None}
    assert required == set(written_keys(example))
    for key in required:
        with pytest.raises(WorldError, match=f'"{key.rpartition(".")[2]}" is missing'):
            read_device(device, _without(example, key), tmp_path / "device.yaml")


def test_the_whole_world_of_the_page_runs(tmp_path: Path) -> None:
    world = load_world(
        _world(tmp_path), plugin_readers=plugin_readers, world_plugin_readers=world_plugin_readers
    )
    simulation = Simulation(world)
    simulation.step(10)
    assert {each.topic for each in simulation.endpoints} >= {"/scan", "/cmd_vel"}


def test_a_key_of_one_choice_names_that_choice() -> None:
    conditions = {each.key: each.only_with for each in (*model_keys(), *map_keys())}
    assert conditions["bodies[].footprints[].radius"] == "type: circle"
    assert conditions["joints[].limits"] == "type: revolute"
    assert conditions["data"] == "type: line_segments"
    assert conditions["resolution"] == "type: image"
    assert conditions["bodies[].name"] == ""


def test_every_device_has_a_chapter() -> None:
    titles = [each.title for each in TOPIC.chapters()]
    assert {f"Device {each}" for each in DEVICES} <= set(titles)
    assert world_format.TOPIC is TOPIC
