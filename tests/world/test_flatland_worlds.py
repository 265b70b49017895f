"""Flatland's own public worlds: the good ones load with their known numbers, the bad ones are refused rightly.

They lie beside the project, not in it; without them these tests are skipped.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import pytest

from kit.geometry import Pose
from kit.world.documents import AllowedRoot, WorldDocuments
from kit.world.loading import load_world
from kit.world.plugin_reader import ModelScope, PluginReader
from kit.world.problems import ProblemCollector, WorldError
from kit.world.records import SourceLocation, World
from kit.world.yaml_section import Section
from tests.cases import every_case

FLATLAND = Path(__file__).resolve().parents[3] / "shared" / "flatland_worlds" / "avidbots-flatland"
LOAD = "flatland_server/test/load_world_tests"
MANAGER = "flatland_server/test/plugin_manager_tests"
PLUGINS = "flatland_plugins/test"

pytestmark = pytest.mark.skipif(not FLATLAND.is_dir(), reason=f"Flatland's worlds are not at {FLATLAND}")


@dataclass(frozen=True)
class Numbers:
    """What is known of a good world: of each layer entry its names and walls, of each model its parts."""

    layers: tuple[tuple[tuple[str, ...], int | None], ...]
    models: tuple[tuple[str, int, int, tuple[str, ...]], ...]


ONE_MAP = ((("layer_1",), 8),)
TWO_MAPS = ((("layer_1",), 8), (("layer_2",), 8))
DUMMY_MAP = ((("2d",), 8),)

GOOD = {
    f"{LOAD}/simple_test_A/world.yaml": Numbers(
        ((("2d",), 12), (("3d", "4d", "5d"), 16), (("lines",), 3), (("robot",), None)),
        (("turtlebot1", 5, 4, ()), ("turtlebot2", 5, 4, ()), ("chair1", 1, 0, ()), ("person1", 1, 0, ())),
    ),
    f"{MANAGER}/load_dummy_test/world.yaml": Numbers(
        DUMMY_MAP, (("turtlebot1", 1, 0, ("DummyModelPlugin",)),)
    ),
    f"{MANAGER}/collision_test/world.yaml": Numbers(
        DUMMY_MAP, (("turtlebot1", 1, 0, ()), ("person1", 1, 0, ()))
    ),
    f"{PLUGINS}/laser_tests/range_test/world.yaml": Numbers(TWO_MAPS, (("robot1", 1, 0, ("Laser",) * 3),)),
    f"{PLUGINS}/laser_tests/range_test/world.cw.yaml": Numbers(TWO_MAPS, (("robot1", 1, 0, ("Laser",)),)),
    f"{PLUGINS}/laser_tests/range_test/world.cw.asymmetrical.yaml": Numbers(
        TWO_MAPS, (("robot1", 1, 0, ("Laser", "Laser", "ModelTfPublisher")),)
    ),
    f"{PLUGINS}/laser_tests/intensity_test/world.yaml": Numbers(
        (*TWO_MAPS, (("reflectance",), 4)), (("robot1", 1, 0, ("Laser",) * 3),)
    ),
    f"{PLUGINS}/bumper_tests/collision_test/world.yaml": Numbers(
        ((("layer_1",), 4),), (("robot1", 2, 1, ("Bumper", "Bumper")),)
    ),
    f"{PLUGINS}/model_tf_publisher_tests/tf_publish_test_A/world.yaml": Numbers(
        ONE_MAP, (("robot1", 6, 1, ("ModelTfPublisher",)),)
    ),
    f"{PLUGINS}/model_tf_publisher_tests/tf_publish_test_B/world.yaml": Numbers(
        ONE_MAP, (("robot1", 6, 1, ("ModelTfPublisher",)),)
    ),
    **{
        f"{PLUGINS}/tween_tests/{mode}.world.yaml": Numbers(ONE_MAP, (("robot1", 1, 0, ("Tween",)),))
        for mode in ("once", "yoyo", "loop")
    },
    f"{PLUGINS}/update_timer_test/world.yaml": Numbers(ONE_MAP, (("robot1", 1, 0, ()),)),
}

BAD: dict[str, tuple[str, int, tuple[str, ...]]] = {
    # world: the file and line of the mistake, and words that its message must contain
    f"{LOAD}/random_path": ("world.yaml", 1, ("no such file",)),
    f"{LOAD}/world_invalid_A": ("world.yaml", 1, ("properties", "missing")),
    f"{LOAD}/world_invalid_B": ("world.yaml", 5, ("color", "4")),
    f"{LOAD}/world_invalid_C": ("world.yaml", 6, ("unknown", "random_param_1")),
    f"{LOAD}/world_invalid_D": ("world.yaml", 5, ("layer", "already exists")),
    f"{LOAD}/world_invalid_E": ("world.yaml", 12, ("turtlebot", "already exists")),
    f"{LOAD}/world_invalid_F": ("world.yaml", 14, ("16", "3", "14")),
    f"{LOAD}/map_invalid_A": ("map.yaml", 1, ("origin", "missing")),
    f"{LOAD}/map_invalid_B": ("map.yaml", 1, ("random_map.png",)),
    f"{LOAD}/map_invalid_C": ("map_lines.yaml", 2, ("random_file.dat",)),
    f"{LOAD}/map_invalid_D": ("map_lines.dat", 6, ("segment",)),
    f"{LOAD}/map_invalid_E": ("map_lines.yaml", 1, ("scale", "missing")),
    f"{LOAD}/model_invalid_A": ("turtlebot.model.yaml", 5, ("bodies", "list")),
    f"{LOAD}/model_invalid_B": ("turtlebot.model.yaml", 14, ("points", "3")),
    f"{LOAD}/model_invalid_C": ("turtlebot.model.yaml", 54, ("anchor", "2")),
    f"{LOAD}/model_invalid_D": ("turtlebot.model.yaml", 45, ("left_wheel_123",)),
    f"{LOAD}/model_invalid_E": ("turtlebot.model.yaml", 26, ("random_layer",)),
    f"{LOAD}/model_invalid_F": ("turtlebot.model.yaml", 13, ("unknown", "random_paramter")),
    f"{LOAD}/model_invalid_G": ("turtlebot.model.yaml", 8, ("unknown", "random_paramter")),
    f"{LOAD}/model_invalid_H": ("turtlebot.model.yaml", 13, ("base", "already exists")),
    f"{LOAD}/model_invalid_I": ("turtlebot.model.yaml", 38, ("wheel_weld", "already exists")),
    f"{LOAD}/model_invalid_J": ("turtlebot.model.yaml", 13, ("points", "8")),
    f"{MANAGER}/invalid_plugin_yaml": ("turtlebot.model.yaml", 16, ("name", "missing")),
    f"{MANAGER}/duplicate_plugin": ("turtlebot.model.yaml", 23, ("dummy_test_plugin", "already exists")),
    f"{MANAGER}/nonexistent_plugin": ("turtlebot.model.yaml", 16, ("RandomPlugin",)),
    f"{MANAGER}/plugin_throws_exception": (
        "turtlebot.model.yaml",
        20,
        ("dummy_test_123456", "wrong_message"),
    ),
    f"{PLUGINS}/laser_tests/invalid_A": ("robot.model.yaml", 14, ("range", "missing")),
    f"{PLUGINS}/laser_tests/invalid_B": ("robot.model.yaml", 19, ("max", "min")),
    f"{PLUGINS}/bumper_tests/invalid_A": ("robot.model.yaml", 23, ("random_body",)),
    f"{PLUGINS}/model_tf_publisher_tests/invalid_A": ("robot.model.yaml", 16, ("random_body",)),
    f"{PLUGINS}/model_tf_publisher_tests/invalid_B": ("robot.model.yaml", 16, ("random_body_1",)),
}


@pytest.fixture
def all_devices() -> Mapping[str, PluginReader]:
    """The kit's own plugins, and the one that only Flatland's tests have."""
    from kit.sim.plugins import plugin_readers

    return {**plugin_readers, "DummyModelPlugin": _read_dummy}


def _read_dummy(section: Section, scope: ModelScope) -> str:
    """A plugin that takes one value only of each of its parameters."""
    section.number("dummy_param_float")
    section.integer("dummy_param_int")
    return section.text("dummy_param_string", choices=["dummy_test_123456"])


@pytest.mark.parametrize("world", GOOD)
def test_good_world_has_its_known_numbers(world: str, all_devices: Mapping[str, PluginReader]) -> None:
    loaded = load_world(FLATLAND / world, root=FLATLAND, plugin_readers=all_devices)
    assert _numbers(loaded) == GOOD[world]


def _numbers(world: World) -> Numbers:
    return Numbers(
        tuple(
            (layer.names, None if layer.walls is None else len(layer.walls.local_segments))
            for layer in world.layers
        ),
        tuple(
            (model.name, len(model.bodies), len(model.joints), tuple(plugin.type for plugin in model.plugins))
            for model in world.models
        ),
    )


@every_case("world", BAD)
def test_bad_world_is_refused_for_its_cause(world: str, all_devices: Mapping[str, PluginReader]) -> None:
    file, line, words = BAD[world]
    folder = FLATLAND / world
    with pytest.raises(WorldError) as caught:
        load_world(folder / "world.yaml", root=FLATLAND, plugin_readers=all_devices)
    here = [
        p.message
        for p in caught.value.problems
        if (p.location.file, p.location.line) == (folder / file, line)
    ]
    assert any(all(word in message for word in words) for message in here), str(caught.value)


def test_every_world_there_is_tested() -> None:
    worlds = {path.relative_to(FLATLAND).as_posix() for path in FLATLAND.rglob("*world*.yaml")}
    assert worlds == {*GOOD, *(f"{folder}/world.yaml" for folder in BAD)} - {f"{LOAD}/random_path/world.yaml"}


def test_where_models_and_maps_stand() -> None:
    simple = load_world(FLATLAND / LOAD / "simple_test_A/world.yaml")
    assert (simple.velocity_iterations, simple.position_iterations) == (11, 12)
    assert [(model.namespace, model.pose) for model in simple.models] == [
        ("", Pose()),
        ("robot2", Pose(3, 4.5, 3.14159)),
        ("", Pose(1.2, 3.5, 2.123)),
        ("", Pose(0, 1, 2)),
    ]
    tf = load_world(
        FLATLAND / PLUGINS / "model_tf_publisher_tests/tf_publish_test_A/world.yaml", root=FLATLAND
    )
    assert tf.models[0].namespace == "my_robot"
    assert tf.models[0].pose == Pose(8, 6, -0.575958653)
    dummy = load_world(FLATLAND / MANAGER / "load_dummy_test/world.yaml")
    assert dummy.models[0].plugins[0].params == {
        "dummy_param_float": 0.123456,
        "dummy_param_int": 123456,
        "dummy_param_string": "dummy_test_123456",
    }


def test_the_walls_and_footprints_that_flatlands_test_lists() -> None:
    world = load_world(FLATLAND / LOAD / "simple_test_A/world.yaml")
    assert dict(world.layer_bits) == {"2d": 1, "3d": 2, "4d": 4, "5d": 8, "lines": 16, "robot": 32}
    assert [layer.bits for layer in world.layers] == [0b1, 0b1110, 0b10000, 0b100000]
    assert [layer.walls and layer.walls.origin for layer in world.layers] == [
        Pose(0.05, -0.05, 1.57),
        Pose(),
        Pose(-1.2, -5, 1.23),
        None,
    ]
    lying = [
        (7.5, 0, 1.5),
        (6, 1.5, 6),
        (4.5, 0, 4.5),
        (3, 3, 6),
        (1.5, 1.5, 4.5),
        (1.5, 6, 7.5),
        (0, 1.5, 3),
        (0, 6, 7.5),
    ]
    upright = [
        (0, 4.5, 7.5),
        (1.5, 6, 7.5),
        (1.5, 0, 1.5),
        (3, 0, 3),
        (4.5, 1.5, 4.5),
        (6, 3, 6),
        (6, 0, 1.5),
        (7.5, 0, 1.5),
    ]
    assert _walls(world, 1) == {(a, y, b, y) for y, a, b in lying} | {(x, a, x, b) for x, a, b in upright}
    assert _walls(world, 2) == {(0.1, 0.2, 0.3, 0.4), (-0.1, -0.2, -0.3, -0.4), (0.01, 0.02, 0.03, 0.04)}
    base, left, right, tail, antenna = world.models[0].bodies
    assert [f.category for body in (base, left, right, tail, antenna) for f in body.footprints] == [
        *(0xFFFF, 0xFFFF),
        *(0b01, 0xFFFF, 0b10, 0),
    ]
    assert left.footprints[0].sensor
    assert (tail.pose, antenna.pose) == (Pose(0, 0, 0.52), Pose(0, 0.5, 0))
    weld, rigid, free, limited = world.models[0].joints
    assert (weld.angle, weld.frequency, weld.damping, weld.collide_connected) == (1.57079633, 10, 0.5, True)
    assert (rigid.angle, rigid.frequency, rigid.damping, rigid.collide_connected) == (0, 0, 0, False)
    assert (free.limits, limited.limits) == (None, (-0.002, 3.735))
    chair, person = world.models[2].bodies[0], world.models[3].bodies[0]
    assert (chair.kind, [f.category for f in chair.footprints], person.kind) == (
        "static",
        [0b1100, 0xFFFF],
        "kinematic",
    )


def _walls(world: World, layer: int) -> set[tuple[float, ...]]:
    walls = world.layers[layer].walls
    assert walls is not None
    return {tuple(float(number) for number in wall) for wall in walls.local_segments.round(9)}


PREPROCESSOR = "flatland_server/test/yaml_preprocessor/yaml"


def test_includes_give_what_flatlands_test_expects(tmp_path: Path) -> None:
    shutil.copytree(FLATLAND / PREPROCESSOR, tmp_path, dirs_exist_ok=True)
    parent = tmp_path / "include.parent.yaml"
    absolute = tmp_path / "absolute.yaml"
    absolute.write_text("contents of absolute file\n")
    parent.write_text(re.sub(r"\$include /\S+", f"$include {absolute}", parent.read_text()))
    assert _read(parent) == _read(tmp_path / "include.parent.out.yaml")


def test_variables_give_what_flatlands_test_expects(tmp_path: Path) -> None:
    """Of the test of ``$eval`` the part that runs no code: environment variables."""
    for name in ("eval.strings.yaml", "eval.strings.out.yaml"):
        text = (FLATLAND / PREPROCESSOR / name).read_text()
        (tmp_path / name).write_text(text[text.index("testEnv:") : text.index("testParam:")])
    variables = {"VALIDSTRING": "Bar", "VALIDNUMBER": "123.4"}
    assert _read(tmp_path / "eval.strings.yaml", variables) == _read(tmp_path / "eval.strings.out.yaml")


def test_code_is_refused_where_it_stands() -> None:
    with pytest.raises(WorldError) as caught:
        _read(FLATLAND / PREPROCESSOR / "eval.strings.yaml")
    lines = {problem.location.line for problem in caught.value.problems}
    assert lines == {1, 2, 3, 4, 6, 9, 11, *range(28, 37)}


def _read(file: Path, environment: Mapping[str, str] | None = None) -> Mapping[str, object]:
    problems = ProblemCollector()
    section = WorldDocuments(AllowedRoot.containing(file), environment or {}, problems).section(
        file, SourceLocation(file)
    )
    problems.raise_if_any()
    assert section is not None
    return section.remaining_values()
