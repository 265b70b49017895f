"""The plan of a world: the fewest names, called what they were called, and no more changed than must be."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from kit.layers import explain
from kit.layers.assignment import find_breaches
from kit.layers.flatland.layer_lists import find_layer_lists, read_world_layers
from kit.layers.flatland.requirement_binding import bind_requirements
from kit.layers.flatland.world_case import current_case
from kit.layers.flatland.world_planning import WorldPlan, plan_world
from kit.layers.requirements_file import read_requirements
from kit.world.catalogue import MapCard
from kit.world.problems import WorldError
from tests.cases import every_case
from tests.kit_content import kit_maps
from tests.layers.conftest import YARD, WriteFiles
from tests.layers.worlds import random_world

FLATLAND = Path(__file__).parents[4] / "shared" / "flatland_worlds" / "avidbots-flatland"


def planned(world: Path, root: Path | None = None) -> WorldPlan:
    return plan_world(current_case(find_layer_lists(read_world_layers(world, root=root))))


def test_the_yard_needs_four_of_its_six_names(yard: Path) -> None:
    plan = planned(yard)
    assert (plan.current_name_count, plan.size, plan.bound, plan.is_optimal) == (6, 4, 4, True)
    assert [layer.name for layer in plan.assignment.layers] == ["solid", "seen", "fence", "tracked"]
    assert plan.assignment.layers_of("robot") == ("solid", "tracked")
    assert plan.assignment.layers_of("chair") == ("solid", "fence")
    assert plan.assignment.watches == {"robot.lidar": ("seen",), "beacon.eye": ("tracked",)}


def test_what_is_as_good_as_can_be_stays_as_it_is(write: WriteFiles) -> None:
    world = YARD["world.yaml"].replace(", both", "").replace("  - name: spare\n", "")
    files = {
        name: text.replace("solid, both", "solid").replace('"both"', "solid") for name, text in YARD.items()
    }
    plan = planned(write({**files, "world.yaml": world}))
    assert plan.is_unchanged
    assert plan.assignment is plan.world_case.current_assignment


def test_who_is_in_all_layers_and_may_be_stays_there(write: WriteFiles) -> None:
    """The person is in "all": it goes on to be, though three of the four layers would do."""
    person = (
        "bodies:\n  - name: x\n    type: kinematic\n    footprints: [{type: circle, radius: 1, density: 1}]\n"
    )
    files = {
        "world.yaml": "properties: {}\nlayers:\n  - {name: [a, b], map: map.yaml}\nmodels:\n"
        "  - {name: p, model: p.yaml}\n  - {name: q, model: q.yaml}\n",
        "p.yaml": person,
        "q.yaml": person.replace("kinematic", "dynamic"),
    }
    plan = planned(write(files))
    assert plan.size == 1
    assert plan.assignment.layers_of("p") == plan.assignment.layers_of("q") == ("a",)


def test_the_first_name_of_a_map_and_a_name_a_plugin_speaks_of_go_on_to_exist(write: WriteFiles) -> None:
    world = YARD["world.yaml"] + "plugins:\n  - {name: w, type: RandomWall, layer: both, robot_name: robot}\n"
    plan = planned(write({"world.yaml": world}))
    names = [layer.name for layer in plan.assignment.layers if "solid" in layer.members]
    assert names == ["solid", "both"]
    assert plan.size == 4


def test_the_reflectance_layer_stays_what_it_is(write: WriteFiles) -> None:
    """Nothing else uses it, and the same contacts could be had without it; but what is in it shines."""
    world = YARD["world.yaml"].replace("name: spare", "name: [reflectance, spare]")
    robot = YARD["robot.model.yaml"].replace(
        "[solid, both, tracked]}  # in front", "[solid, both, tracked, reflectance]}"
    )
    plan = planned(write({"world.yaml": world, "robot.model.yaml": robot}))
    assert plan.size == 5
    shining = next(layer for layer in plan.assignment.layers if layer.name == "reflectance")
    assert shining.members == {"robot.bumper"}
    assert find_breaches(plan.world_case.case, plan.assignment) == ()


def test_a_kept_layer_that_does_what_must_not_be_is_named(write: WriteFiles) -> None:
    world = write(
        {
            "world.yaml": YARD["world.yaml"].replace(
                "name: [solid, seen, both]", "name: [solid, seen, both, reflectance]"
            )
        }
    )
    chair = world.with_name("chair.model.yaml")
    chair.write_text(chair.read_text().replace('"both"', '"both", reflectance'))
    asked = world.with_name("asked.yaml")
    asked.write_text(
        "maps: [solid, fence]\nmodels: [robot, chair, beacon]\ncopies: {chair: [chair1, chair2]}\n"
        "collide: {chair: [chair, fence]}\nlasers: {lidar: [], eye: []}\n"
    )
    bound = bind_requirements(read_requirements(asked), find_layer_lists(read_world_layers(world)))
    with pytest.raises(WorldError, match="reflectance"):
        plan_world(bound)


def test_new_requirements_get_new_names(write: WriteFiles, monkeypatch: pytest.MonkeyPatch) -> None:
    """One layer today; robot and drone are to keep apart, which takes two under the same map."""
    body = "bodies:\n  - name: x\n    footprints: [{type: circle, radius: 1, density: 1}]\n"
    world = write(
        {
            "world.yaml": "properties: {}\nlayers:\n  - {name: hall, map: map.yaml}\nmodels:\n"
            "  - {name: robot, model: r.yaml}\n  - {name: drone, model: d.yaml}\n  - {name: gull, model: g.yaml}\n",
            "r.yaml": body,
            "d.yaml": body,
            "g.yaml": body,
        }
    )
    asked = world.with_name("asked.yaml")
    asked.write_text(
        "maps: [hall]\nmodels: [robot, drone, gull]\ncollide: {hall: [robot, drone], drone: [gull]}\n"
    )
    plan = plan_world(bind_requirements(read_requirements(asked), find_layer_lists(read_world_layers(world))))
    assert [breach.is_missing for breach in plan.current_breaches] == [False, False, False]
    for most, is_cut in ((3, False), (2, True)):
        monkeypatch.setattr(explain, "MAX_LISTED_BREACHES", most)
        lines = explain.world_plan_text(plan)
        assert sum(line.startswith("  - ") for line in lines) == most
        assert ("  ... and 1 more" in lines) == is_cut
    assert [layer.name for layer in plan.assignment.layers] == ["hall", "hall_2", "free_1"]
    assert find_breaches(plan.world_case.case, plan.assignment) == ()


@every_case("seed", range(60))
def test_a_worlds_plan_does_what_the_world_does_with_no_more_names(write: WriteFiles, seed: int) -> None:
    plan = planned(write(random_world(random.Random(seed))))
    assert plan.is_optimal
    assert plan.size <= plan.current_name_count
    assert find_breaches(plan.world_case.case, plan.assignment) == ()


@every_case("card", kit_maps(), ids=lambda card: card.name)
def test_no_map_of_the_kit_could_do_with_fewer_layers(card: MapCard) -> None:
    plan = planned(card.world_file, card.root)
    assert plan.is_optimal
    assert plan.is_unchanged


@pytest.mark.parametrize(
    ("world", "today", "needed"),
    [
        ("flatland_server/test/load_world_tests/simple_test_A/world.yaml", 6, 3),
        ("flatland_server/test/plugin_manager_tests/load_dummy_test/world.yaml", 1, 1),
        ("flatland_server/test/plugin_manager_tests/collision_test/world.yaml", 1, 1),
        ("flatland_plugins/test/laser_tests/range_test/world.yaml", 2, 2),
        ("flatland_plugins/test/laser_tests/range_test/world.cw.asymmetrical.yaml", 2, 2),
        ("flatland_plugins/test/laser_tests/intensity_test/world.yaml", 3, 3),
        ("flatland_plugins/test/bumper_tests/collision_test/world.yaml", 1, 1),
        ("flatland_plugins/test/model_tf_publisher_tests/tf_publish_test_A/world.yaml", 1, 1),
        ("flatland_plugins/test/tween_tests/loop.world.yaml", 1, 1),
    ],
)
def test_flatlands_own_worlds(world: str, today: int, needed: int) -> None:
    if not FLATLAND.is_dir():
        pytest.skip(f"Flatland's own worlds are not here: {FLATLAND}")
    plan = planned(FLATLAND / world, FLATLAND)
    assert (plan.current_name_count, plan.size, plan.is_optimal) == (today, needed, True)
