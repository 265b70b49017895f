"""A world as a case: what happens today, in as few entities as a person would draw."""

from __future__ import annotations

import random
from pathlib import Path

from kit.layers.assignment import find_breaches
from kit.layers.flatland.layer_lists import find_layer_lists, read_world_layers
from kit.layers.flatland.world_case import current_case, to_requirements_file
from kit.layers.planning import solve_layers
from kit.layers.requirements import ContactRequirement
from kit.layers.requirements_file import read_requirements, requirements_text
from kit.world.collision_rules import CollisionRules, ContactKind
from tests.cases import every_case
from tests.layers.cases import fewest_layers
from tests.layers.conftest import YARD, WriteFiles
from tests.layers.worlds import random_world


def test_the_yards_entities_are_those_a_person_would_draw(yard: Path) -> None:
    world_case = current_case(find_layer_lists(read_world_layers(yard)))
    case = world_case.case
    assert case.names == ("solid", "fence", "robot", "chair", "beacon")
    assert [(e.kind, e.copies) for e in case.entities] == [("map", 1)] * 2 + [
        ("bodies", n) for n in (1, 2, 1)
    ]
    assert set(case.edges()) == {
        ContactRequirement("solid", "robot"),
        ContactRequirement("solid", "chair"),
        ContactRequirement("fence", "chair"),
        ContactRequirement("robot", "chair"),
    }
    assert ContactRequirement("chair", "chair") in case.required_contacts
    assert case.laser["robot.lidar"].sees == {"solid"}
    assert case.laser["beacon.eye"].sees == {"robot"}
    assert case.laser["beacon.eye"].either == {"beacon"}
    assert world_case.current_breaches == ()


def test_a_hull_around_the_laser_asks_less_than_what_sticks_out_and_goes_with_it(yard: Path) -> None:
    """Base and bumper are one entity, though only the bumper can be seen by the robot's own laser."""
    world_case = current_case(find_layer_lists(read_world_layers(yard)))
    addresses = [use.address for layer_list in world_case.entities["robot"] for use in layer_list.uses]
    assert addresses == ["robot/bumper[0]", "robot/base[0]"]


def test_bodies_with_different_needs_stay_apart(write: WriteFiles) -> None:
    robot = YARD["robot.model.yaml"].replace(
        "layers: [solid, both, tracked]}  # in front", "layers: [solid, both]}"
    )
    case = current_case(find_layer_lists(read_world_layers(write({"robot.model.yaml": robot})))).case
    assert {"robot.base", "robot.bumper"} <= set(case.names)
    assert case.laser["beacon.eye"].sees == {"robot.base"}


def test_copies_named_like_a_model_or_a_map_keep_names_of_their_own(write: WriteFiles) -> None:
    world = YARD["world.yaml"].replace("name: chair1", "name: chair").replace("name: fence", "name: beacon")
    chair = YARD["chair.model.yaml"].replace("fence", "beacon")
    case = current_case(
        find_layer_lists(read_world_layers(write({"world.yaml": world, "chair.model.yaml": chair})))
    ).case
    assert case.names == ("solid", "beacon", "robot", "chair+", "beacon.all")


@every_case("name", ["yard", *range(40)])
def test_the_case_says_what_touching_says(write: WriteFiles, name: str | int) -> None:
    """Body by body: an entity's relation is what ``kit.world.collision_rules`` tells of the bodies it stands for."""
    files = {} if name == "yard" else random_world(random.Random(name))
    world = read_world_layers(write(files))
    world_case = (
        current_case(find_layer_lists(world), grouped=False)
        if name != "yard"
        else current_case(find_layer_lists(world))
    )
    bodies = {
        entity: {(use.model, use.body.body) for layer_list in lists for use in layer_list.uses}
        for entity, lists in world_case.entities.items()
    }
    touching = CollisionRules(world)
    for a, b, verdict in touching.contact_rules():
        if a.model is None and b.model is None:
            continue
        ours = {
            world_case.case.relation(one, other)
            for one, mine in bodies.items()
            for other, its in bodies.items()
            if (a.model or "", a.body) in mine and (b.model or "", b.body) in its
        }
        if verdict.kind is not ContactKind.PASSES:
            assert "collide" in ours, (a.name, b.name, verdict)
        elif a.model != b.model:  # of one model, a copy may do what this one does not
            assert "collide" not in ours, (a.name, b.name, verdict)
    assert find_breaches(world_case.case, world_case.current_assignment) == ()


@every_case("seed", range(60))
def test_putting_lists_together_costs_no_layer(write: WriteFiles, seed: int) -> None:
    layer_lists = find_layer_lists(read_world_layers(write(random_world(random.Random(seed)))))
    grouped, single = current_case(layer_lists), current_case(layer_lists, grouped=False)
    assert solve_layers(grouped.case).size == solve_layers(single.case).size
    if len(single.case.names) <= 7:
        assert solve_layers(grouped.case).size == fewest_layers(single.case)


@every_case("seed", range(30))
def test_written_down_and_laid_over_the_world_again_it_asks_the_same(write: WriteFiles, seed: int) -> None:
    from kit.layers.flatland.requirement_binding import bind_requirements

    file = write(random_world(random.Random(seed)))
    world_case = current_case(find_layer_lists(read_world_layers(file)))
    text = file.with_name("asked.yaml")
    text.write_text(requirements_text(world_case.case, requirements=to_requirements_file(world_case)))
    bound = bind_requirements(read_requirements(text), world_case.layer_lists)
    assert bound.current_breaches == ()
    assert solve_layers(bound.case).size == solve_layers(world_case.case).size


def test_a_world_without_layers_meets_in_all_of_them(write: WriteFiles) -> None:
    world = (
        "properties: {}\nlayers: []\nmodels:\n  - {name: a, model: m.yaml}\n  - {name: b, model: m.yaml}\n"
    )
    model = "bodies:\n  - name: x\n    footprints: [{type: circle, radius: 1, density: 1}]\n"
    world_case = current_case(
        find_layer_lists(read_world_layers(write({"world.yaml": world, "m.yaml": model})))
    )
    assert [layer.name for layer in world_case.current_assignment.layers] == ["all"]
    assert find_breaches(world_case.case, world_case.current_assignment) == ()
