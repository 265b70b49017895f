"""Page by page through a case: nothing is left out, the picture follows, another edge leads elsewhere."""

from __future__ import annotations

from itertools import pairwise

from kit.layers.case_sources import open_task, solve_task
from kit.layers.examples import EXAMPLES
from kit.layers.guided_tour import GreedyTour, TourPage, case_page, method_pages, plan_pages
from kit.layers.planning import solve_layers
from kit.layers.requirements import LayerCase
from tests.cases import every_case

WIDTH = 34


def pages(case: LayerCase, width: int = WIDTH) -> list[TourPage]:
    plan = solve_layers(case)
    run = GreedyTour(case).run
    return [
        case_page(case, width),
        *method_pages(run, width),
        *plan_pages(case, plan, None, run, width),
    ]


@every_case("name", EXAMPLES)
def test_every_example_has_its_four_parts_in_order(name: str) -> None:
    case = EXAMPLES[name]
    walked = pages(case)
    parts = [page.part for page in walked]
    assert list(dict.fromkeys(parts)) == ["case", "method", "fewest", "proof"]
    run = GreedyTour(case).run
    assert parts.count("method") == len(run.collision_steps) + len(run.laser_steps) + 1
    assert parts.count("fewest") == 1 + solve_layers(case).size
    assert all(page.lines and page.title for page in walked)
    longest = max(len(word) for page in walked for line in page.lines for word in line.split())
    assert max(len(line) for page in walked for line in page.lines) <= max(WIDTH, longest + 6)


def test_struck_edges_grow_clique_by_clique_until_all_are_struck() -> None:
    case = EXAMPLES["slides"]
    steps = [page for page in pages(case) if page.step is not None]
    assert [page.step for page in steps] == list(range(6))
    for one, then in pairwise(steps):
        inside = {edge for edge in case.edges() if one.group.issuperset((edge.a, edge.b))}
        assert then.covered_edges == one.covered_edges | inside
    ending = next(page for page in pages(case) if page.title.startswith("Where"))
    assert ending.covered_edges == set(case.edges())


def test_lasers_have_their_pages() -> None:
    walked = pages(EXAMPLES["slides-lasers"])
    assert [page.laser for page in walked if page.laser] == ["Ls1", "Ls2", "Ls3"]


def test_every_requirement_is_brought_about_by_some_page_of_the_plan() -> None:
    case = EXAMPLES["slides-lasers"]
    said = "\n".join("\n".join(page.lines) for page in pages(case, 80) if page.part == "fewest")
    for contact in case.collide:
        assert f"{contact.a} and {contact.b} collide" in said
    for laser in case.lasers:
        for name in laser.sees:
            assert f"{laser.name} sees {name}" in said


def test_the_proofs_picture_keeps_the_edges_it_counts() -> None:
    case = EXAMPLES["slides"]
    proof = pages(case)[-1]
    assert len(set(case.edges()) - proof.covered_edges) == 6


def test_another_edge_leads_elsewhere_and_what_came_before_stays() -> None:
    method = GreedyTour(EXAMPLES["greedy-trap"])
    assert method.run.size == 4
    sizes = set()
    for edge in method.edges(0):
        other = method.with_edge(0, edge)
        assert other.run.collision_steps[0].edge == edge
        sizes.add(other.run.size)
    assert 4 in sizes
    third = method.edges(2)[-1]
    changed = method.with_edge(2, third)
    assert changed.run.collision_steps[:2] == method.run.collision_steps[:2]
    assert changed.run.collision_steps[2].edge == third
    again = changed.with_edge(1, method.edges(1)[-1])
    assert again.run.collision_steps[0] == method.run.collision_steps[0]
    assert 2 not in again.chosen_edges or again.run.collision_steps[1].edge == method.edges(1)[-1]


def test_a_world_is_planned_in_its_own_names() -> None:
    task = open_task("crossing")
    plan, world_plan = solve_task(task)
    assert world_plan is not None
    first, *others = plan_pages(task.case, plan, world_plan, GreedyTour(task.case).run, 80)
    assert first.lines[0].startswith("Today the world names ")
    for layer in world_plan.assignment.layers:
        assert any(line.startswith(f"{layer.name} = ") for line in first.lines)
    assert [page.group for page in others if page.part == "fewest"] == [
        layer.members for layer in world_plan.assignment.layers
    ]
