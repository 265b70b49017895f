"""What world and model files mean, found out by reading them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from kit.msg.geometry_msgs import Twist
from kit.school.quiz.items import QuizItem
from kit.sim.simulation import Simulation, load_world
from kit.world.catalogue import find_map
from kit.world.collision_rules import CollisionRules, ContactKind
from kit.world.problems import WorldError
from kit.world.records import ALL_LAYERS, World
from tests.school.quiz.derived.finding import Derivation, Finding
from tests.sim.workshop import Workshop
from tests.world.picture_walls import walls_from_image


def image_named_in(item: QuizItem, folder: Path) -> Finding:
    """Of the maze's files, the one with the line; and what its reader says that the walls come from."""
    card = find_map("maze")
    (layer,) = load_world(card.world_file, root=card.root).layers
    assert layer.walls is not None
    picture = layer.walls.drawing_file.name
    naming = [path.name for path in card.folder.glob("*.yaml") if f"image: {picture}" in path.read_text()]
    assert naming == [layer.walls.file.name]
    assert picture not in card.world_file.read_text()
    return Finding(
        "world" if naming == [card.world_file.name] else "map",
        {
            "The map file that a layer of the world names": "map",
            "The world file, in its list of layers": "world",
            "The configuration of the viewer, such as RViz": "viewer",
        },
    )


def map_size(item: QuizItem, folder: Path) -> Finding:
    """A dark frame shows how far the picture reaches."""
    walls = _frame(folder, 200, 100, 0.5)
    width, height = (walls[:, i::2].max() - walls[:, i::2].min() for i in (0, 1))
    return Finding(f"{width:g} m by {height:g} m", {option.text: option.text for option in item.options})


def map_origin(item: QuizItem, folder: Path) -> Finding:
    _frame(folder, 20, 10, 0.5)
    (folder / "map.yaml").write_text(
        json.dumps({"image": "map.png", "resolution": 0.5, "origin": [-1, -2, 0], "occupied_thresh": 0.65})
    )
    (folder / "world.yaml").write_text(
        json.dumps({"properties": {}, "layers": [{"name": "solid", "map": "map.yaml"}]})
    )
    walls = load_world(folder / "world.yaml").layers[0].walls
    assert walls is not None
    low = walls.segments.reshape(-1, 2).min(axis=0)
    high = walls.segments.reshape(-1, 2).max(axis=0)
    corners = {
        "Its lower left corner": tuple(low),
        "Its middle": tuple((low + high) / 2),
        "Its upper left corner": (low[0], high[1]),
    }
    return Finding((-1.0, -2.0), corners)


def white_picture(item: QuizItem, folder: Path) -> Finding:
    Image.fromarray(np.full((20, 20), 255, dtype=np.uint8)).save(folder / "white.png")
    walls = walls_from_image(folder / "white.png", resolution=0.1, occupied_thresh=0.65)
    found = {0: "none", 4: "rim"}.get(len(walls), "other")
    return Finding(found, {"Four, along its rim": "rim", "None at all": "none", "One large block": "block"})


def sixteen_names(item: QuizItem, folder: Path) -> Finding:
    """Names that nothing uses, in a world without anything."""

    def takes(count: int) -> bool:
        layers = [{"name": f"layer{number}"} for number in range(count)]
        (folder / "world.yaml").write_text(json.dumps({"properties": {}, "layers": layers}))
        try:
            load_world(folder / "world.yaml")
        except WorldError:
            return False
        return True

    assert takes(16)
    return Finding(
        takes(17),
        {
            "Sixteen, unused ones included": False,
            "Sixteen, unused ones not counted": True,
            "As many as models and maps": "none, since there are no models",
        },
    )


def relative_path(item: QuizItem, folder: Path) -> Finding:
    """A model of the same name in each of the folders, each with a body of another name."""
    places = {
        "In the one you start the program in": folder / "here",
        "In the one the world file lies in": folder / "world",
        "In your workspace folder": folder / "workspace",
    }
    for number, place in enumerate(places.values()):
        (place / "robots").mkdir(parents=True)
        body = {"name": f"body{number}", "footprints": []}
        (place / "robots" / "serp.model.yaml").write_text(json.dumps({"bodies": [body]}))
    (folder / "world" / "world.yaml").write_text(
        json.dumps(
            {"properties": {}, "layers": [], "models": [{"name": "serp", "model": "robots/serp.model.yaml"}]}
        )
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder / "here")
        patch.setenv("KIT_WORKSPACE", str(folder / "workspace"))
        world = load_world(folder / "world" / "world.yaml")
    return Finding(
        world.models[0].bodies[0].name, {text: f"body{number}" for number, text in enumerate(places)}
    )


# Models and plugins


def plugin_subscribes(item: QuizItem, folder: Path) -> Finding:
    """Each plugin alone on a robot: what its endpoints are."""
    shop = Workshop(folder)
    extra = {
        "Laser": {"range": 1, "angle": {"min": 0, "max": 1, "increment": 1}},
        "DiffDrive": {},
        "Bumper": {},
    }
    found = []
    for option in item.options:
        on = {} if option.text == "Bumper" else {"body": "base"}
        plugin = {"type": option.text, "name": "it", **on, **extra[option.text]}
        world = shop.world({"robot": shop.model(shop.circle(0.1), plugins=[plugin])})
        if any(end.direction == "subscribe" for end in Simulation(world).endpoints):
            found.append(option.text)
    (subscriber,) = found
    return Finding(subscriber, {option.text: option.text for option in item.options})


def default_layers(item: QuizItem, folder: Path) -> Finding:
    shop = Workshop(folder)
    world = shop.world({"robot": shop.model(shop.circle(0.1))}, {"first": (), "second": ()})
    (footprint,) = world.models[0].bodies[0].footprints
    return Finding(
        footprint.category,
        {"In none of them": 0, "In the world's first one": 1, "In all of them": ALL_LAYERS},
    )


def footprint_kind(item: QuizItem, folder: Path) -> Finding:
    """The key that the question shows, on a footprint that shares a layer with a robot and its laser."""
    key = {"sensor: true": {"sensor": True}, "collision: false": {"collision": False}}
    (setting,) = [value for words, value in key.items() if words in item.question]
    touching = CollisionRules(_robot_and(folder, setting))
    robot, thing = (next(t for t in touching.bodies if t.model == name) for name in ("robot", "thing"))
    touch = touching.contact_rule(robot, thing).kind
    seen = touching.visibility(touching.lasers[0], thing).is_visible
    return Finding(
        (touch, seen),
        {
            "It notices the robot, lets it through, and is not seen": (ContactKind.SENSES, False),
            "It lets the robot through, and the laser sees it": (ContactKind.PASSES, True),
            "It stops the robot, and the laser does not see it": (ContactKind.COLLIDES, False),
        },
    )


def welded_bodies(item: QuizItem, folder: Path) -> Finding:
    """Joined, they do not collide; unjoined, they do, so it is not the model that keeps them apart."""
    joined, loose = (_two_bodies(folder / name, joint=name == "joined") for name in ("joined", "loose"))
    reason = "collide" if joined else "joined" if loose else "one model"
    return Finding(
        reason,
        {
            "Yes: they share a layer": "collide",
            "No: they are joined": "joined",
            "No: they are of one model": "one model",
        },
    )


def two_namespaces(item: QuizItem, folder: Path) -> Finding:
    shop = Workshop(folder)
    drive = {"type": "DiffDrive", "name": "drive", "body": "base", "twist_sub": "cmd_vel"}
    model = shop.model(shop.circle(0.1), plugins=[drive])
    world = shop.world({"one": model, "other": model}, namespaces={"one": "red", "other": "blue"})
    ends = Simulation(world).endpoints
    found = frozenset(end.topic for end in ends if end.direction == "subscribe" and end.type is Twist)
    return Finding(
        found,
        {
            "/cmd_vel for both robots": frozenset({"/cmd_vel"}),
            "/cmd_vel/red and /cmd_vel/blue": frozenset({"/cmd_vel/red", "/cmd_vel/blue"}),
            "/red/cmd_vel and /blue/cmd_vel": frozenset({"/red/cmd_vel", "/blue/cmd_vel"}),
        },
    )


def _frame(folder: Path, columns: int, rows: int, resolution: float) -> np.ndarray:
    picture = np.zeros((rows, columns), dtype=np.uint8)
    picture[1:-1, 1:-1] = 255
    Image.fromarray(picture).save(folder / "map.png")
    return walls_from_image(folder / "map.png", resolution=resolution, occupied_thresh=0.65)


def _robot_and(folder: Path, setting: dict[str, bool]) -> World:
    shop = Workshop(folder)
    eye = {
        "type": "Laser",
        "name": "eye",
        "body": "base",
        "range": 5,
        "angle": {"min": -1, "max": 1, "increment": 1},
        "layers": ["shared"],
    }
    robot = shop.model(shop.circle(0.1, layers=["shared"]), plugins=[eye])
    thing = shop.model(shop.circle(0.1, layers=["shared"], **setting))
    return shop.world({"robot": robot, "thing": thing}, {"shared": ()})


def _two_bodies(folder: Path, *, joint: bool) -> bool:
    folder.mkdir()
    shop = Workshop(folder)
    model = {
        "bodies": [
            {"name": name, "footprints": [shop.circle(0.1, layers=["shared"])]} for name in ("base", "wheel")
        ],
        "joints": [
            {
                "name": "weld",
                "type": "weld",
                "bodies": [{"name": name, "anchor": [0, 0]} for name in ("base", "wheel")],
            }
        ]
        if joint
        else [],
    }
    touching = CollisionRules(shop.world({"robot": model}, {"shared": ()}))
    return touching.contact_rule(*touching.bodies).kind is ContactKind.COLLIDES


def odometry_variance(item: QuizItem, folder: Path) -> Finding:
    """Of the numbers offered, the one with which the x of the odometry is wrong by 0.1 m."""
    errors = {}
    for number, option in enumerate(item.options):
        shop = Workshop(folder / str(number))
        shop.folder.mkdir()
        drive = {
            "type": "DiffDrive",
            "name": "drive",
            "body": "base",
            "odom_pose_noise": [float(option.text), 0, 0],
        }
        model = {"bodies": [{"name": "base", "footprints": [shop.circle(0.1)]}], "plugins": [drive]}
        sent = Simulation(shop.world({"robot": model}), seed=1).step(4000)
        x = [each.message.pose.pose.position.x for each in sent if each.topic == "/odometry/filtered"]
        errors[option.text] = float(np.std(x))
    best = min(errors, key=lambda text: abs(errors[text] - 0.1))
    assert errors[best] == pytest.approx(0.1, rel=0.2)
    return Finding(best, {text: text for text in errors})


def joint_anchor(item: QuizItem, folder: Path) -> Finding:
    """Of the anchors offered, the one that lies on the base's own: the kit refuses no other so far apart."""
    base, trailer = np.array([0.0, 0.0]), np.array([-0.6, 0.0])
    joint = (base + trailer) / 2
    return Finding(
        tuple((joint - trailer).round(6).tolist()),
        {option.text: tuple(json.loads(option.text)) for option in item.options},
    )


def right_wheel(item: QuizItem, folder: Path) -> Finding:
    """Turned clockwise by a quarter, what was ahead is on the right."""
    ahead = np.array([0.2, 0.0])
    clockwise = np.array([[0.0, 1.0], [-1.0, 0.0]])
    return Finding(
        float((clockwise @ ahead)[1]), {option.text: float(option.text) for option in item.options}
    )


def twelve_corners(item: QuizItem, folder: Path) -> Finding:
    angles = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    points = np.column_stack([np.cos(angles), np.sin(angles)]).round(6).tolist()
    footprint = {"type": "polygon", "density": 1, "points": points}
    try:
        world = Workshop(folder).world({"robot": {"bodies": [{"name": "base", "footprints": [footprint]}]}})
    except WorldError:
        found = 0
    else:
        found = len(world.models[0].bodies[0].footprints[0].shape.points)
    means = {"It refuses the model, with an error": 0, "It takes only the first eight corners": 8}
    return Finding(found, {option.text: means.get(option.text, 12) for option in item.options})


WORLDS: dict[str, Derivation] = {
    "odometry-variance": odometry_variance,
    "joint-anchor": joint_anchor,
    "right-wheel": right_wheel,
    "twelve-corners": twelve_corners,
    "image-named-in": image_named_in,
    "map-size": map_size,
    "map-origin": map_origin,
    "white-picture": white_picture,
    "sixteen-names": sixteen_names,
    "relative-path": relative_path,
    "plugin-subscribes": plugin_subscribes,
    "default-layers": default_layers,
    "footprint-kind": footprint_kind,
    "welded-bodies": welded_bodies,
    "two-namespaces": two_namespaces,
}
