"""Plans as plain data: JSON, with the same facts as the objects."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

from kit.layers.examples import EXAMPLES
from kit.layers.flatland.layer_lists import find_layer_lists, read_world_layers
from kit.layers.flatland.world_case import current_case
from kit.layers.flatland.world_patch import build_patch
from kit.layers.flatland.world_planning import plan_world
from kit.layers.greedy import run_greedy
from kit.layers.plan_data import certificate_data, check_data, greedy_data, patch_data, plan_data, world_data
from kit.layers.planning import BoundCertificate, solve_layers
from kit.layers.requirements import ContactRequirement, Requirement, SightRequirement


def test_a_plan_comes_back_from_json_as_it_went() -> None:
    case = EXAMPLES["slides-lasers"]
    plan, run = solve_layers(case), run_greedy(case)
    facts = json.loads(json.dumps(plan_data(plan, run)))
    assert {layer["name"]: set(layer["holds"]) for layer in facts["layers"]} == {
        layer.name: set(layer.members) for layer in plan.assignment.layers
    }
    assert {entity["name"]: tuple(entity["layers"]) for entity in facts["entities"]} == {
        name: plan.assignment.layers_of(name) for name in case.names
    }
    watched = {laser["name"]: tuple(laser["watches"]) for laser in facts["lasers"]}
    assert watched == dict(plan.assignment.watches)
    assert {(layer["name"], laser) for layer in facts["layers"] for laser in layer["watched_by"]} == {
        (layer, laser) for laser, layers in watched.items() for layer in layers
    }


def test_weights_are_exact() -> None:
    weights: dict[Requirement, Fraction] = {
        ContactRequirement("a", "b"): Fraction(1, 3),
        SightRequirement("l", "a"): Fraction(2, 3),
    }
    assert certificate_data(BoundCertificate((), (weights,))) == {
        "bound": 1,
        "apart": [],
        "weighted": [
            [{"collide": ["a", "b"], "weight": [1, 3]}, {"laser": "l", "sees": "a", "weight": [2, 3]}]
        ],
    }


def test_the_slides_method_says_what_it_leaves_unseen() -> None:
    facts = greedy_data(run_greedy(EXAMPLES["unseen"]))
    assert facts["unseen"] == [{"laser": "eye", "sees": "lamp"}]


def test_a_world_and_its_patch(yard: Path) -> None:
    plan = plan_world(current_case(find_layer_lists(read_world_layers(yard))))
    facts = json.loads(
        json.dumps({**world_data(plan), **check_data(plan), "patch": patch_data(build_patch(plan))})
    )
    assert (facts["names_today"], facts["size"], facts["needed"], facts["breaches"]) == (6, 4, 4, [])
    assert [Path(file).name for file in facts["patch"]["files"]] == [
        "chair.model.yaml",
        "robot.model.yaml",
        "world.yaml",
    ]
