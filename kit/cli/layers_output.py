"""Output of the verbs of ``kit layers``: as text, as data, as a graph."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from kit.layers.assignment import LayerAssignment
    from kit.layers.drawing import GlyphStyle
    from kit.layers.flatland.world_patch import WorldPatch
    from kit.layers.flatland.world_planning import WorldPlan
    from kit.layers.greedy import GreedyRun
    from kit.layers.planning import LayerPlan
    from kit.layers.relaxation import Relaxation
    from kit.layers.requirements import LayerCase


def show_plan(case: LayerCase, found: LayerPlan, world_plan: WorldPlan | None, time_limit: float) -> None:
    """Prints the plan as tables, its proof, the slides' method beside it, and relaxations where it is too large."""
    from kit.layers import explain as words
    from kit.layers.drawing import draw_assignment
    from kit.layers.greedy import run_greedy
    from kit.world.records import MAX_LAYERS

    if world_plan is None:
        echo_lines(words.wrap(case.title))
        echo_lines(words.plan_text(found))
        assignment, kept = found.assignment, 0
    else:
        echo_lines(words.world_plan_text(world_plan))
        assignment, kept = world_plan.assignment, len(world_plan.world_case.layer_lists.kept_layers)
    echo_lines(["", *draw_assignment(case, assignment), ""])
    echo_lines(words.proof_text(found))
    echo_lines(words.comparison_text(run_greedy(found.case), found))
    if found.size + kept > MAX_LAYERS:
        echo_lines(["", *words.too_many_text(found, *_find_relaxations(found, kept, time_limit))])


def _find_relaxations(
    found: LayerPlan, kept: int, time_limit: float
) -> tuple[Relaxation | None, Relaxation | None]:
    """Finds requirements to give up, or contacts to tolerate, so that at most sixteen layers are needed."""
    from kit.layers.relaxation import allow_unwanted, drop_requirements
    from kit.world.records import MAX_LAYERS

    limit = MAX_LAYERS - kept
    return (
        drop_requirements(found.case, limit=limit, time_limit=time_limit),
        allow_unwanted(found, limit=limit, time_limit=time_limit),
    )


def plan_data(
    found: LayerPlan, world_plan: WorldPlan | None, patch: WorldPatch | None, time_limit: float
) -> dict[str, Any]:
    """The content of ``show_plan`` and the patch as JSON-able data."""
    from kit.layers.greedy import run_greedy
    from kit.layers.plan_data import patch_data, plan_data, sacrifice_data, world_data
    from kit.world.records import MAX_LAYERS

    facts = plan_data(found, run_greedy(found.case))
    kept = 0 if world_plan is None else len(world_plan.world_case.layer_lists.kept_layers)
    if world_plan is not None:
        facts |= world_data(world_plan)
    if found.size + kept > MAX_LAYERS:
        given_up, tolerated = _find_relaxations(found, kept, time_limit)
        facts["give_up"] = None if given_up is None else sacrifice_data(given_up)
        facts["tolerate"] = None if tolerated is None else sacrifice_data(tolerated)
    if patch is not None:
        facts["patch"] = patch_data(patch)
    return facts


def show_greedy(case: LayerCase, *, as_json: bool, graph: str | None) -> None:
    from kit.layers.drawing import draw_assignment
    from kit.layers.explain import greedy_end_text
    from kit.layers.greedy import run_greedy
    from kit.layers.plan_data import greedy_data

    run = run_greedy(case)
    if as_json:
        click.echo(json.dumps(greedy_data(run), indent=2))
    elif graph:
        show_graph(case, run.assignment, graph)
    else:
        echo_lines([*greedy_end_text(run), "", *draw_assignment(case, run.assignment)])


def show_graph(case: LayerCase, assignment: LayerAssignment, language: str) -> None:
    from kit.layers.graph_export import graphviz_text, mermaid_text

    click.echo({"dot": graphviz_text, "mermaid": mermaid_text}[language](case, assignment), nl=False)


def show_patch(patch: WorldPatch) -> None:
    from kit.layers.explain import patch_text

    echo_lines(["", *patch_text(patch)])


def step_pictures(run: GreedyRun, glyphs: GlyphStyle) -> Callable[[int], list[str]]:
    """Draws the graph at a step: what is struck already, and the group just made."""
    from kit.layers.drawing import draw_case, to_plain_lines

    def draw(step: int) -> list[str]:
        members = run.collision_steps[step].layer.members
        return to_plain_lines(
            draw_case(run.case, struck=run.covered_before(step), group=members, glyphs=glyphs)
        )

    return draw


def choose_glyphs(asked: str) -> GlyphStyle:
    """Returns the glyphs asked for, or those that this terminal can show."""
    if asked == "auto":
        encoding = (getattr(sys.stdout, "encoding", None) or "").lower().replace("-", "")
        return (
            "braille" if encoding == "utf8" and os.environ.get("TERM") not in ("dumb", "linux") else "ascii"
        )
    return "braille" if asked == "braille" else "ascii"


def echo_lines(lines: Iterable[str]) -> None:
    for line in lines:
        click.echo(line)
