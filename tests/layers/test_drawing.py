"""Pictures in characters: everything is there, nothing is too wide, and no meaning hangs on colour."""

from __future__ import annotations

import random
import re

import pytest

from kit.document.layout import lines_of
from kit.layers.assignment import LayerAssignment, NamedLayer
from kit.layers.assignment_tables import assignment_tables
from kit.layers.drawing.case import draw_case
from kit.layers.drawing.graph import MAX_ENTITIES_IN_PICTURE, draw_graph
from kit.layers.drawing.layer_grid import draw_layer_grid
from kit.layers.drawing.matrix import draw_matrix
from kit.layers.drawing.spans import DrawingLine, DrawingSpan, GlyphStyle, to_plain_lines
from kit.layers.examples import EXAMPLES
from kit.layers.greedy import run_greedy
from kit.layers.planning import solve_layers
from kit.layers.requirements import ContactRequirement
from tests.cases import every_case
from tests.layers.cases import graph, random_graph

SLIDES = EXAMPLES["slides-lasers"]


def styles(lines: list[DrawingLine]) -> set[str]:
    return {span.style for line in lines for span in line}


def ink(lines: list[DrawingLine], style: str) -> int:
    return sum(len(span.text) for line in lines for span in line if span.style == style)


@every_case("glyphs", ["braille", "ascii"])
@every_case("name", EXAMPLES)
def test_every_name_is_in_the_picture_and_the_picture_fits(name: str, glyphs: GlyphStyle) -> None:
    case = EXAMPLES[name]
    text = to_plain_lines(draw_graph(case, glyphs=glyphs))
    assert len(text) == 17
    assert max(map(len, text)) <= 80
    assert all(any(entity in line for line in text) for entity in case.names)
    assert glyphs != "ascii" or all(line.isascii() for line in text)


@pytest.mark.parametrize(("width", "height"), [(40, 10), (78, 20), (1, 1)])
def test_it_fits_any_size(width: int, height: int) -> None:
    lines = draw_graph(SLIDES, width=width, height=height)
    assert len(lines) == height
    assert all(sum(len(span.text) for span in line) == width for line in lines)


@pytest.mark.parametrize("glyphs", ["braille", "ascii"])
def test_a_struck_edge_is_fainter_and_one_in_the_group_is_thicker_without_any_colour(
    glyphs: GlyphStyle,
) -> None:
    case = graph("a-b")
    ways = [
        to_plain_lines(draw_graph(case, glyphs=glyphs, **marks))
        for marks in ({}, {"struck": {ContactRequirement("a", "b")}}, {"group": {"a", "b"}})
    ]
    assert len({"\n".join(way) for way in ways}) == 3

    def marks_in(way: list[str]) -> int:
        text = "".join(way).translate({ord(c): None for c in " ab[]"})
        return sum(bin(ord(c) - 0x2800).count("1") if ord(c) >= 0x2800 else 1 for c in text)

    open_, struck, group = map(marks_in, ways)
    assert struck < open_ <= group
    assert any("[a]" in line for line in ways[2])


def test_a_step_of_the_slides_method_shows_all_three_kinds_of_edge() -> None:
    run = run_greedy(SLIDES)
    lines = draw_graph(SLIDES, struck=run.covered_before(2), group=run.collision_steps[2].layer.members)
    assert styles(lines) >= {"edge", "struck", "group edge", "group", "map", "body"}


def test_a_laser_sends_beams() -> None:
    lines = draw_graph(SLIDES, laser="Ls3")
    assert {"beam", "laser"} <= styles(lines)
    assert any("<Ls3>" in line for line in to_plain_lines(lines))


def test_few_lines_cross() -> None:
    """A ring that is listed in a bad order is drawn as a ring: no line through the middle."""
    case = graph("a-d d-b b-e e-c c-f f-a")
    middle = to_plain_lines(draw_graph(case, height=17))[8]
    assert middle[30:50].strip() == ""


def test_the_spans_are_the_text() -> None:
    for lines in (draw_graph(SLIDES), draw_matrix(SLIDES)):
        assert to_plain_lines(lines) == ["".join(span.text for span in line).rstrip() for line in lines]


def test_the_matrix_has_a_mark_for_every_pair_and_laser() -> None:
    case = graph("a-b b-c", either="a-c", lasers={"eye": "a"})
    assert to_plain_lines(draw_matrix(case, struck={ContactRequirement("a", "b")}, group={"b", "c"})) == [
        "       1 2 3",
        "1 a    \\",
        "2*b    x \\",
        "3*c    ~ # \\",
        " >eye  # . .",
    ]


@pytest.mark.parametrize("count", [9, 10, 30, 60])
def test_a_matrix_of_up_to_sixty_fits_eighty_columns(count: int) -> None:
    lines = to_plain_lines(draw_matrix(random_graph(random.Random(1), count, 0.3)))
    assert max(map(len, lines)) <= 80
    assert len(lines) == count + len(str(count))


def test_too_many_for_a_picture_become_a_matrix() -> None:
    few, many = (random_graph(random.Random(1), MAX_ENTITIES_IN_PICTURE + more, 0.1) for more in (0, 1))
    assert draw_case(few) == draw_graph(few)
    assert draw_case(many) == draw_matrix(many)
    assert draw_case(SLIDES) == draw_graph(SLIDES)


def test_the_tables_name_every_layer_entity_and_laser_within_eighty_columns() -> None:
    plan = solve_layers(SLIDES)
    lines = lines_of(assignment_tables(SLIDES, plan.assignment))
    assert max(map(len, lines)) <= 80
    text = "\n".join(lines)
    assert all(layer.name in text for layer in plan.assignment.layers)
    assert all(f"\n{name} " in text for name in (*SLIDES.names, *SLIDES.laser))


def test_who_is_in_no_layer_is_told_what_to_write() -> None:
    case = graph("a-b", lasers={"eye": ""})
    lines = lines_of(assignment_tables(case, LayerAssignment((NamedLayer("x", frozenset("a")),), {})))
    assert any(line.startswith("b") and "layers: []" in line for line in lines)
    assert any(line.startswith("eye") and "layers: []" in line for line in lines)


def test_the_cursor_stands_out_on_one_mark_and_changes_no_character() -> None:
    rows, columns = len(SLIDES.names), len(SLIDES.names)
    for at in ((0, 0), (3, 1), (rows - 1, columns - 1), (rows, 0), (rows + 2, columns - 1)):
        lines = draw_matrix(SLIDES, cursor=at)
        assert to_plain_lines(lines) == to_plain_lines(draw_matrix(SLIDES))
        head = len(lines) - rows - len(SLIDES.lasers)
        marked = [number for number, line in enumerate(lines) if ink([line], "cursor")]
        assert marked == [head + at[0]]
        assert ink(lines, "cursor") == 1
    assert draw_matrix(graph("a-b"), cursor=(1, 0))[2][1:3] == (
        DrawingSpan("", "edge"),
        DrawingSpan("#", "cursor"),
    )


@every_case("glyphs", ["braille", "ascii"])
@every_case("name", EXAMPLES)
def test_in_a_large_picture_each_name_stands_in_a_box_that_is_not_crossed(
    name: str, glyphs: GlyphStyle
) -> None:
    case = EXAMPLES[name]
    for laser in (None, *case.laser):
        lines = draw_graph(case, laser=laser, width=112, height=47, glyphs=glyphs, boxes=True)
        assert [sum(len(span.text) for span in line) for line in lines] == [112] * 47
        text = to_plain_lines(lines)
        sides = "|" if glyphs == "ascii" else "│║"
        for entity in (*case.names, *([laser] if laser else [])):
            [found] = [
                line
                for line in text
                if re.search(rf"[{sides}] [ #<]*{re.escape(entity)}[ #>]* [{sides}]", line)
            ]
            assert found


@every_case("glyphs", ["braille", "ascii"])
@every_case("boxes", [True, False])
def test_each_edge_bears_the_layers_that_hold_both_its_ends(boxes: bool, glyphs: GlyphStyle) -> None:
    layers = [NamedLayer("L7", frozenset({"a", "b"})), NamedLayer("L8", frozenset({"a", "b", "c"}))]
    case = graph("a-b b-c c-d")
    lines = draw_graph(case, layers=layers, width=112, height=47, glyphs=glyphs, boxes=boxes)
    named = [span.text.split() for line in lines for span in line if span.style == "layer"]
    assert sorted(named) == [["L7", "L8"], ["L8"]]


def test_boxes_that_would_touch_are_left_out() -> None:
    assert draw_graph(SLIDES, width=40, height=12, boxes=True) == draw_graph(SLIDES, width=40, height=12)


def test_the_grid_of_layers_says_who_is_in_which_and_is_as_high_with_none() -> None:
    case = EXAMPLES["blind-spot"]
    layers = [NamedLayer("C1", frozenset({"walls", "robot"})), NamedLayer("L1", frozenset({"walls"}))]
    text = to_plain_lines(draw_layer_grid(case, layers, {"lidar": ("L1",)}, glyphs="ascii"))
    assert text[:4] == ["       C1  L1", "walls  #   #", "robot  #   .", "lidar  .   o"]
    assert len(draw_layer_grid(case, (), {})) == len(text)
    assert draw_layer_grid(case, layers, {}, width=12) == []
