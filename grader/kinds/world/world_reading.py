"""Reads a submitted world. Runs in the world process."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from grader.kinds.world.facts import (
    BodyFacts,
    Box,
    CollisionFacts,
    EndpointFacts,
    JointFacts,
    ModelFacts,
    PluginFacts,
    PoseTriple,
    ShapeFacts,
    SightFacts,
    WallFacts,
    WorldFacts,
)
from kit.arrays import FloatArray
from kit.geometry import Pose
from kit.msg.message import type_name
from kit.render.scene import Disc, Scene, SceneBody
from kit.render.world_text import scene_rows
from kit.run.scene_bodies import scene_bodies
from kit.sim.plugins.laser import LaserParams
from kit.sim.simulation import Simulation, SimulationError, load_world
from kit.world import records
from kit.world.collision_rules import CollisionBody, CollisionRules, ContactKind
from kit.world.problems import WorldError
from kit.world.records import Circle, Layer, World

COLUMNS, ROWS = 60, 16
"""Size of the picture, in characters."""


def read_world_facts(file: Path) -> tuple[WorldFacts, World | None]:
    """Reads a world; returns its facts, and the world itself if it can be read."""
    try:
        world = load_world(file)
        simulation = Simulation(world)
    except WorldError as error:
        return WorldFacts.of_unreadable(error, file), None
    except SimulationError as error:
        return WorldFacts((f"{file.name}: {error}",)), None
    return _world_facts(world, simulation), world


def _world_facts(world: World, simulation: Simulation) -> WorldFacts:
    touching = CollisionRules(world)
    maps = {layer.name: _map_name(layer) for layer in world.layers if layer.walls is not None}

    def thing_name(thing: CollisionBody) -> tuple[str, str]:
        return ("", maps[thing.body]) if thing.model is None else (thing.model, thing.body)

    return WorldFacts(
        layers=tuple(world.layer_bits),
        walls=tuple(_wall_facts(layer) for layer in world.layers if layer.walls is not None),
        models=tuple(_model_facts(model, world.layer_bits) for model in world.models),
        collisions=tuple(
            CollisionFacts(
                thing_name(a), thing_name(b), verdict.kind is ContactKind.COLLIDES, verdict.explanation
            )
            for a, b, verdict in touching.contact_rules()
        ),
        sights=tuple(
            SightFacts(laser.name, thing_name(thing), seeing.is_visible, seeing.explanation)
            for laser, thing, seeing in touching.visibilities()
        ),
        endpoints=tuple(
            EndpointFacts(model.name, end.topic, type_name(end.type), end.direction == "publish")
            for model in world.models
            for end in simulation.model_endpoints(model.name)
        ),
        picture=draw_world(world, simulation),
    )


def _map_name(layer: Layer) -> str:
    assert layer.walls is not None
    return layer.walls.file.name.partition(".")[0]


def _wall_facts(layer: Layer) -> WallFacts:
    assert layer.walls is not None
    points = layer.walls.segments.reshape(-1, 2)
    box: Box | None = None
    if len(points):
        (left, bottom), (right, top) = points.min(axis=0).tolist(), points.max(axis=0).tolist()
        box = left, bottom, right, top
    return WallFacts(
        _map_name(layer), layer.walls.drawing_file.name, layer.names, box, len(layer.walls.local_segments)
    )


def _model_facts(model: records.Model, layer_bits: Mapping[str, int]) -> ModelFacts:
    poses = {body.name: body.pose for body in model.bodies}
    return ModelFacts(
        model.name,
        model.namespace,
        _pose_triple(model.pose),
        tuple(
            BodyFacts(
                body.name, body.kind, _pose_triple(body.pose), tuple(map(_shape_facts, body.footprints))
            )
            for body in model.bodies
        ),
        tuple(_joint_facts(joint, poses) for joint in model.joints),
        tuple(_plugin_facts(plugin, layer_bits) for plugin in model.plugins),
    )


def _shape_facts(footprint: records.Footprint) -> ShapeFacts:
    shape = footprint.shape
    if isinstance(shape, Circle):
        (x, y), radius = shape.center, shape.radius
        kind, box = "circle", (x - radius, y - radius, x + radius, y + radius)
    else:
        xs, ys = zip(*shape.points, strict=True)
        kind, box = "polygon", (min(xs), min(ys), max(xs), max(ys))
    return ShapeFacts(kind, box, footprint.sensor, footprint.collision, footprint.density)


def _joint_facts(joint: records.Joint, poses: dict[str, Pose]) -> JointFacts:
    first, second = joint.anchors
    return JointFacts(
        joint.name,
        joint.kind,
        (first.body, second.body),
        (poses[first.body].transform_point(*first.point), poses[second.body].transform_point(*second.point)),
    )


def _plugin_facts(plugin: records.PluginSpec, layer_bits: Mapping[str, int]) -> PluginFacts:
    params = plugin.params
    if isinstance(params, LaserParams):
        rays = params.directions
        layers = tuple(name for name, bits in layer_bits.items() if bits & params.mount.bits)
        return PluginFacts(
            plugin.name,
            plugin.type,
            params.mount.body,
            len(rays),
            rays[0],
            rays[-1],
            params.max_range,
            layers,
        )
    return PluginFacts(plugin.name, plugin.type, str(getattr(params, "body", "")), 0, 0.0, 0.0, 0.0)


def draw_world(
    world: World,
    simulation: Simulation,
    *,
    target: Disc | None = None,
    trail: FloatArray | None = None,
) -> str:
    """Draws the present state of the world in plain characters."""
    scene = Scene(
        walls=world.wall_segments,
        bodies=_scene_bodies(simulation),
        targets=() if target is None else (target,),
        trails=() if trail is None else (trail,),
    )
    return "\n".join(row.rstrip() for row in scene_rows(scene, COLUMNS, ROWS))


def _scene_bodies(simulation: Simulation) -> tuple[SceneBody, ...]:
    names = simulation.model_names
    driven = [
        name
        for name in names
        if any(end.direction == "subscribe" for end in simulation.model_endpoints(name))
    ]
    return scene_bodies(simulation.outlines(), {name: simulation.pose(name) for name in names}, driven)


def _pose_triple(pose: Pose) -> PoseTriple:
    return pose.x, pose.y, pose.theta
