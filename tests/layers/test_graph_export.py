"""The graph for Graphviz and for Mermaid."""

from __future__ import annotations

import re

from kit.layers.examples import EXAMPLES
from kit.layers.graph_export import graphviz_text, mermaid_text
from kit.layers.planning import solve_layers
from kit.layers.requirements import ContactRequirement, LayerCase, LayerEntity
from tests.cases import every_case
from tests.layers.cases import graph

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
