"""Plans as data: JSON with the same facts as the objects, and the collision graph for Graphviz and Mermaid."""

from __future__ import annotations

import json
import re
from fractions import Fraction
from pathlib import Path

from kit.layers.bound_certificates import BoundCertificate
from kit.layers.examples import EXAMPLES
from kit.layers.flatland.layer_lists import find_layer_lists, read_world_layers
from kit.layers.flatland.world_case import current_case
from kit.layers.flatland.world_patch import build_patch
from kit.layers.flatland.world_planning import plan_world
from kit.layers.greedy import run_greedy
from kit.layers.plan_data import (
    certificate_data,
    check_data,
    graphviz_text,
    greedy_data,
    mermaid_text,
    patch_data,
    plan_data,
    world_data,
)
from kit.layers.planning import solve_layers
from kit.layers.requirements import ContactRequirement, LayerCase, LayerEntity, Requirement, SightRequirement
from tests.cases import every_case
from tests.layers.cases import graph


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


SLIDES = EXAMPLES["slides-lasers"]


def test_graphviz_has_every_vertex_edge_and_beam() -> None:
    text = graphviz_text(SLIDES, solve_layers(SLIDES).assignment)
    assert text.startswith("graph ")
    assert text.count("{") == text.count("}") == 1
    assert len(re.findall(r"shape=(box|ellipse)", text)) == 8
    assert len(re.findall(r"style=solid", text)) == 12
    assert len(re.findall(r"dir=forward", text)) == 3 + 3 + 4
    assert '"Map1" -- "M4.B1" [style=solid, label="C1"]' in text


def test_mermaid_has_every_vertex_edge_and_beam() -> None:
    text = mermaid_text(SLIDES, solve_layers(SLIDES).assignment)
    assert text.startswith("graph LR\n")
    assert len(re.findall(r"^  e\d+[\[(]", text, re.MULTILINE)) == 8
    assert len(re.findall(r"^  e\d+ ---\|[CL, \d]+\| e\d+$", text, re.MULTILINE)) == 12
    assert len(re.findall(r"==>", text)) == 10


def test_pairs_left_open_are_dashed_and_no_plan_means_no_labels() -> None:
    case = graph("a-b", either="b-c")
    assert "style=dashed" in graphviz_text(case)
    assert "-.-" in mermaid_text(case)
    assert "label" not in graphviz_text(case)
    assert "|" not in mermaid_text(case)


@every_case("name", ['a"b', "a\\", "a\nb", "end", "a[b]", "a|b", "ä", "a;b", "a#b", "]"])
def test_odd_names_do_not_break_out(name: str) -> None:
    case = LayerCase((LayerEntity(name), LayerEntity("b")), (ContactRequirement(name, "b"),))
    dot = graphviz_text(case)
    assert len(dot.splitlines()) == len(graphviz_text(graph("a-b")).splitlines())
    assert re.sub(r'"(\\.|[^"\\])*"', "", dot).count('"') == 0
    drawn = mermaid_text(case, solve_layers(case).assignment)
    assert len(drawn.splitlines()) == 4
    assert all(re.fullmatch(r'  e\d\(\["[\w .,:#;-]*"\]\)', line) for line in drawn.splitlines()[1:3])
