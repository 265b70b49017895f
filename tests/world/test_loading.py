"""World, layer and model files become records: every key, every default."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from kit.geometry import Pose
from kit.world.loading import load_model, load_world
from kit.world.plugin_reader import PluginReader, WorldPluginReader
from kit.world.problems import WorldError
from kit.world.records import ALL_LAYERS, Circle, JointAnchor, LaserMount, Polygon, SourceLocation

WriteFiles = Callable[[Mapping[str, str | bytes]], Path]


def test_the_least_that_a_world_may_be(write: WriteFiles) -> None:
    world = load_world(write({"world.yaml": "properties: {}\nlayers: []\n"}))
    assert (world.layers, world.models, world.plugins, world.layer_bits) == ((), (), (), {})
    assert (world.velocity_iterations, world.position_iterations) == (10, 10)


def test_every_default(write: WriteFiles) -> None:
    world = load_world(write({}))
    (layer,), (model,) = world.layers, world.models
    assert (layer.name, layer.names, layer.bits, layer.color, layer.properties) == (
        "walls",
        ("walls",),
        1,
        (1, 1, 1, 1),
        {},
    )
    assert (model.pose, model.namespace, model.joints, model.plugins) == (Pose(), "", (), ())
    (body,) = model.bodies
    assert (body.pose, body.kind, body.color) == (Pose(), "dynamic", (1, 1, 1, 0.5))
    assert (body.linear_damping, body.angular_damping) == (0, 0)
    (footprint,) = body.footprints
    assert footprint.shape == Circle((0, 0), 0.1)
    assert (footprint.friction, footprint.restitution, footprint.sensor, footprint.collision) == (
        0,
        0,
        False,
        True,
    )
    assert (footprint.layers, footprint.category, footprint.mask) == (("all",), ALL_LAYERS, ALL_LAYERS)
    assert footprint.location == SourceLocation(model.file, 4, 9)


EVERY_KEY = {
    "world.yaml": """\
properties: {velocity_iterations: 11, position_iterations: 12}
layers:
  - name: "2d"
    map: picture.yaml
    color: [0, 1, 0, 0.675]
    properties: {height: 2, tags: [a, {b: no}]}
  - name: ["3d", "4d"]
  - name: [floor]
    map: map.yaml
models:
  - {name: robot1, model: robot.model.yaml}
  - name: robot2
    model: robot.model.yaml
    pose: [3, 4.5, 3.14159]
    namespace: second
plugins:
  - {name: builder, type: RandomWall, layer: 4d, robot_name: robot2}
""",
    "picture.yaml": """\
image: picture.png
resolution: 0.050000
origin: [0.05e0, -5e-2, 1.57]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
mode: trinary
""",
    "map.yaml": "type: line_segments\ndata: lines.dat\nscale: 0.1\norigin: [-1.20, -5, 1.23]\n",
    "lines.dat": "1 2 3 4\n-1 -2 -3 -4\n",
    "robot.model.yaml": """\
bodies:
  - name: base
    type: kinematic
    pose: [1, 2, 0.5]
    color: [1, 1, 0, 0.25]
    linear_damping: 0.1
    angular_damping: 0.125
    enabled: true
    footprints:
      - type: circle
        center: [0.01, 0.02]
        radius: 1.777
        layers: ["4d", floor]
        sensor: yes
        density: 0
      - type: polygon
        density: 982.24
        friction: 0.59
        restitution: 0.234
        collision: false
        points: [[-0.1, 0.1], [-0.1, -0.1], [0, 0], [0.1, -0.1], [0.1, 0.1], [0.1, 0]]
  - name: wheel
    type: static
    footprints:
      - {type: circle, radius: 0.2, density: 1, layers: []}
  - {name: spare, enabled: false, footprints: not even a list}
joints:
  - name: weld
    type: weld
    angle: 1.57079633
    frequency: 10
    damping: 0.5
    collide_connected: true
    color: [0.1, 0.2, 0.3, 0.4]
    bodies:
      - {name: base, anchor: [-1, 0]}
      - {name: wheel, anchor: [0, 0.5]}
  - name: hinge
    type: revolute
    limits: [-0.002, 3.735]
    bodies: [{name: wheel, anchor: [0, 0]}, {name: base, anchor: [0, 0]}]
  - name: free
    type: revolute
    bodies: [{name: wheel, anchor: [0, 0]}, {name: base, anchor: [0, 0]}]
  - {name: spare, enabled: no, type: unknown}
plugins:
  - {type: Laser, name: eye, body: base, range: 5, origin: [1, 0, 0], layers: [floor]}
  - {type: "flatland_plugins::Laser", name: other eye, body: wheel, range: 2}
  - {type: Laser, name: closed eye, enabled: false}
""",
}


@pytest.fixture
def full(write: WriteFiles) -> Path:
    world = write(EVERY_KEY)
    Image.new("L", (3, 3), 0).save(world.parent / "picture.png")
    return world


def test_layers_with_every_key(full: Path) -> None:
    world = load_world(full)
    assert (world.velocity_iterations, world.position_iterations) == (11, 12)
    assert dict(world.layer_bits) == {"2d": 1, "3d": 2, "4d": 4, "floor": 8}
    picture, names, floor = world.layers
    assert [layer.bits for layer in world.layers] == [0b1, 0b110, 0b1000]
    assert picture.color == (0, 1, 0, 0.675)
    assert picture.properties == {"height": 2, "tags": ("a", {"b": "no"})}
    assert (names.name, names.names, names.walls) == ("3d", ("3d", "4d"), None)
    assert picture.walls is not None
    assert floor.walls is not None
    assert (len(picture.walls.local_segments), picture.walls.origin) == (4, Pose(0.05, -0.05, 1.57))
    assert (picture.walls.file.name, picture.walls.drawing_file.name) == ("picture.yaml", "picture.png")
    assert floor.walls.origin == Pose(-1.2, -5, 1.23)
    assert np.allclose(floor.walls.local_segments, [[0.1, 0.2, 0.3, 0.4], [-0.1, -0.2, -0.3, -0.4]])
    x, y = Pose(-1.2, -5, 1.23).transform_point(0.1, 0.2)
    assert np.allclose(floor.walls.segments[0, :2], [x, y])


def test_models_with_every_key(full: Path) -> None:
    first, second = load_world(full).models
    assert (first.pose, second.pose, second.namespace) == (Pose(), Pose(3, 4.5, 3.14159), "second")
    assert first.file == full.parent / "robot.model.yaml"
    assert [body.name for body in first.bodies] == ["base", "wheel"]
    base, wheel = first.bodies
    assert (base.kind, base.pose, base.color) == ("kinematic", Pose(1, 2, 0.5), (1, 1, 0, 0.25))
    assert (base.linear_damping, base.angular_damping, wheel.kind) == (0.1, 0.125, "static")
    circle, polygon = base.footprints
    assert circle.shape == Circle((0.01, 0.02), 1.777)
    assert (circle.sensor, circle.layers, circle.category, circle.mask) == (
        True,
        ("4d", "floor"),
        0b1100,
        0b1100,
    )
    assert polygon.shape == Polygon(((-0.1, -0.1), (0.1, -0.1), (0.1, 0.1), (-0.1, 0.1)))
    assert (polygon.density, polygon.friction, polygon.restitution) == (982.24, 0.59, 0.234)
    assert (polygon.category, polygon.mask) == (ALL_LAYERS, 0)
    assert (wheel.footprints[0].layers, wheel.footprints[0].category) == ((), 0)


def test_joints_with_every_key(full: Path) -> None:
    weld, hinge, free = load_world(full).models[0].joints
    assert weld.anchors == (JointAnchor("base", (-1, 0)), JointAnchor("wheel", (0, 0.5)))
    assert (weld.kind, weld.angle, weld.frequency, weld.damping) == ("weld", 1.57079633, 10, 0.5)
    assert (weld.collide_connected, weld.color, weld.limits) == (True, (0.1, 0.2, 0.3, 0.4), None)
    assert (hinge.kind, hinge.limits, hinge.collide_connected) == ("revolute", (-0.002, 3.735), False)
    assert free.limits is None


def test_plugins_get_what_their_readers_make_of_their_keys(
    full: Path, devices: Mapping[str, PluginReader], world_devices: Mapping[str, WorldPluginReader]
) -> None:
    world = load_world(full, plugin_readers=devices, world_plugin_readers=world_devices)
    eye, other = world.models[0].plugins
    assert [(plugin.name, plugin.type) for plugin in (eye, other)] == [
        ("eye", "Laser"),
        ("other eye", "Laser"),
    ]
    assert getattr(eye.params, "mount", None) == LaserMount("base", 8, Pose(1, 0, 0))
    assert getattr(other.params, "mount", None) == LaserMount("wheel", ALL_LAYERS)
    assert eye.location == SourceLocation(full.parent / "robot.model.yaml", 47, 5)
    (builder,) = world.plugins
    assert (builder.type, getattr(builder.params, "model", None)) == ("RandomWall", "robot2")


def test_without_readers_parameters_stay_as_they_are_written(full: Path) -> None:
    world = load_world(full)
    assert world.models[0].plugins[0].params == {
        "body": "base",
        "range": 5,
        "origin": (1, 0, 0),
        "layers": ("floor",),
    }
    assert world.plugins[0].params == {"layer": "4d", "robot_name": "robot2"}


def test_a_world_plugin_may_only_name_what_there_is(
    write: WriteFiles, world_devices: Mapping[str, WorldPluginReader]
) -> None:
    world = write({})
    world.write_text(
        world.read_text() + "plugins: [{name: b, type: RandomWall, layer: wals, robot_name: robto, x: 1}]\n"
    )
    with pytest.raises(WorldError) as caught:
        load_world(world, world_plugin_readers=world_devices)
    assert len(caught.value.problems) == 3
    assert all(word in str(caught.value) for word in ('"walls"', '"robot"', '"x"'))


def test_the_same_name_in_different_models_and_namespaces_is_fine(write: WriteFiles) -> None:
    models = "models: [{name: a, model: robot.model.yaml, namespace: n}, {name: b, model: robot.model.yaml, namespace: n}]"
    world = load_world(write({"world.yaml": f"properties: {{}}\nlayers: []\n{models}\n"}))
    assert [model.topic("scan") for model in world.models] == ["/n/scan", "/n/scan"]


def test_a_layer_called_all_is_a_layer_only_beside_others(write: WriteFiles) -> None:
    body = "bodies:\n  - name: {0}\n    footprints: [{{type: circle, radius: 1, density: 0, layers: {1}}}]\n"
    world = write(
        {
            "world.yaml": "properties: {}\nlayers: [{name: [a, all]}]\nmodels: [{name: m, model: robot.model.yaml}]\n"
        }
    )
    model = world.parent / "robot.model.yaml"
    for layers, bits in (("[all]", ALL_LAYERS), ("[all, a]", 0b11), ("[all, all]", 0b10), ("[a]", 0b01)):
        model.write_text(body.format("base", layers))
        assert load_world(world).models[0].bodies[0].footprints[0].category == bits


def test_sixteen_names_are_enough(write: WriteFiles) -> None:
    names = [f"layer{i}" for i in range(16)]
    world = load_world(write({"world.yaml": f"properties: {{}}\nlayers: [{{name: [{', '.join(names)}]}}]\n"}))
    assert [world.layer_bits[name] for name in names] == [1 << i for i in range(16)]
    assert world.layers[0].bits == ALL_LAYERS


def test_walls_cannot_be_changed(write: WriteFiles) -> None:
    walls = load_world(write({})).layers[0].walls
    assert walls is not None
    with pytest.raises(ValueError, match="read-only"):
        walls.local_segments[0, 0] = 1


def test_one_model_is_loaded_for_a_running_world(full: Path, devices: Mapping[str, PluginReader]) -> None:
    bits = load_world(full).layer_bits
    file = full.parent / "robot.model.yaml"
    model = load_model(
        file, name="new", namespace="ns", pose=Pose(1, 2, math.pi), layer_bits=bits, plugin_readers=devices
    )
    assert (model.name, model.namespace, model.pose, model.file) == ("new", "ns", Pose(1, 2, math.pi), file)
    assert model.bodies[0].footprints[0].category == 0b1100


def test_a_model_for_a_running_world_may_be_wrong_or_missing(full: Path) -> None:
    with pytest.raises(WorldError, match="no such file"):
        load_model(full.parent / "nobody.yaml", name="new", layer_bits={})
    with pytest.raises(WorldError, match="4d"):
        load_model(full.parent / "robot.model.yaml", name="new", layer_bits={})


def test_a_large_world_loads_well_under_a_second(write: WriteFiles) -> None:
    layers = "".join(f"  - {{name: layer{i}, map: map{i}.yaml}}\n" for i in range(16))
    models = "".join(
        f"  - {{name: robot{i}, model: robot.model.yaml, pose: [{i}, 0, 0]}}\n" for i in range(50)
    )
    picture = np.full((500, 500), 255, dtype=np.uint8)
    picture[10:490:12, 10:490:12] = 0
    files: dict[str, str | bytes] = {
        f"map{i}.yaml": f"image: {i}.png\nresolution: 0.05\norigin: [0, 0, 0]\noccupied_thresh: 0.65\n"
        for i in range(16)
    }
    world = write({"world.yaml": f"properties: {{}}\nlayers:\n{layers}models:\n{models}", **files})
    for i in range(16):
        Image.fromarray(picture).save(world.parent / f"{i}.png")
    start = time.process_time()
    loaded = load_world(world)
    assert time.process_time() - start < 1.0
    assert sum(len(layer.walls.local_segments) for layer in loaded.layers if layer.walls) > 5000 * 16
