"""Words: every fact is in them, in lines that fit a terminal."""

from __future__ import annotations

import random
from fractions import Fraction
from itertools import combinations

import pytest

from kit.layers import explain as words
from kit.layers.bound_certificates import BoundCertificate
from kit.layers.examples import EXAMPLES
from kit.layers.flatland.layer_lists import find_layer_lists, read_world_layers
from kit.layers.flatland.world_case import current_case
from kit.layers.flatland.world_planning import plan_world
from kit.layers.greedy import run_greedy
from kit.layers.planning import LayerPlan, solve_layers
from kit.layers.relaxations import allow_unwanted, drop_requirements
from kit.layers.requirements import ContactRequirement, Requirement
from tests.cases import every_case
from tests.layers.cases import random_case, random_graph
from tests.layers.conftest import YARD, WriteFiles


@every_case("name", EXAMPLES)
def test_an_example_explained_fits_a_terminal_and_names_every_layer(name: str) -> None:
    run, plan = run_greedy(EXAMPLES[name]), solve_layers(EXAMPLES[name])
    lines = [
        *words.greedy_text(run),
        *words.layer_count_text(plan),
        *words.proof_text(plan, every_pair=True),
        *words.comparison_text(run, plan),
        *words.case_text(EXAMPLES[name]),
    ]
    assert max(map(len, lines)) <= words.WIDTH
    text = " ".join(" ".join(lines).split())
    assert all(f"Layer {step.layer.name} =" in text for step in run.collision_steps)
    assert all(f"Laser {laser}." in text for laser in run.case.laser)
    assert all(words.requirement_text(r, plan.case) in text for r in plan.certificate.conflicting)


def test_every_pair_of_the_slides_proof_has_its_reason() -> None:
    plan = solve_layers(EXAMPLES["slides-lasers"])
    lines = words.proof_text(plan, every_pair=True)
    for i, j in combinations(range(1, 11), 2):
        assert any(line.split(":")[0].split() == [str(i), "and", str(j)] for line in lines)


def test_a_picture_goes_with_each_step() -> None:
    run = run_greedy(EXAMPLES["slides"])
    lines = list(words.greedy_text(run, draw=lambda step: [f"<{step}>"]))
    assert [line for line in lines if line.startswith("<")] == [f"<{i}>" for i in range(6)]


def test_weights_are_written_as_a_person_would() -> None:
    plan = solve_layers(EXAMPLES["three"])
    half = Fraction(1, 2)
    weights: dict[Requirement, Fraction] = {
        ContactRequirement("walls", "robot"): half,
        ContactRequirement("walls", "person"): 3 * half,
    }
    shown = LayerPlan(plan.case, plan.assignment, 2, BoundCertificate((), (weights,)), 1, 0.0)
    text = "\n".join(words.proof_text(shown))
    assert "1/2  walls and robot collide" in text
    assert "1 1/2  walls and person collide" in text
    assert "they weigh 2" in " ".join(text.split())


@pytest.mark.long
def test_a_proof_by_search_alone_says_so() -> None:
    for seed in range(400):
        plan = solve_layers(random_case(random.Random(seed), 10, 2, 0.6, either=0.0, odd=False))
        if plan.certificate.bound < plan.bound:
            text = " ".join(" ".join(words.proof_text(plan)).split())
            assert f"proves {plan.certificate.bound}" in text
            assert f"fewer than {plan.bound}" in text
            return
    pytest.fail("no such case among the seeds")


def test_an_unfinished_plan_says_what_is_proved() -> None:
    plan = solve_layers(random_graph(random.Random(1), 45, 0.5), time_limit=0.2)
    text = " ".join(" ".join(words.layer_count_text(plan)).split())
    assert f"at least {plan.bound}" in text
    assert f"up to {plan.gap} fewer" in text


def test_both_ways_out_are_told_the_shorter_first() -> None:
    plan = solve_layers(EXAMPLES["too-many"])
    text = " ".join(words.too_many_text(plan, drop_requirements(plan.case), allow_unwanted(plan)))
    assert 0 < text.index("Allow") < text.index("Give up")
    assert "None was found" in " ".join(words.too_many_text(plan, None, None))


def test_nothing_asked_needs_nothing() -> None:
    plan = solve_layers(EXAMPLES["two"].without_entity("robot"))
    assert "no layer is needed" in " ".join(words.proof_text(plan))


@pytest.mark.parametrize(
    ("world", "fragments"),
    [
        (YARD["world.yaml"], ("names 6 layers", "4 would do")),
        (YARD["world.yaml"].replace("name: spare", "name: reflectance"), ("reflectance stays",)),
    ],
)
def test_a_world_is_told_how_many_it_has_and_needs(
    write: WriteFiles, world: str, fragments: tuple[str, ...]
) -> None:
    plan = plan_world(current_case(find_layer_lists(read_world_layers(write({"world.yaml": world})))))
    text = " ".join(" ".join(words.world_verdict_text(plan)).split())
    assert all(fragment in text for fragment in fragments)
