"""The summary of a world: true, aligned, and short however many models there are."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Mapping
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from kit.plain_text import WIDTH, grouped_table, join_names, table
from kit.world.loading import load_world
from kit.world.plugin_reader import PluginReader
from kit.world.report import world_report, world_report_data

WriteFiles = Callable[[Mapping[str, str | bytes]], Path]

ROBOT = """\
bodies:
  - name: base
    footprints: [{type: circle, radius: 0.1, density: 1, layers: [solid]}]
  - name: flag
    footprints: [{type: circle, radius: 0.1, density: 1, layers: [seen], sensor: true}]
joints:
  - {name: mast, type: weld, bodies: [{name: base, anchor: [0, 0]}, {name: flag, anchor: [0, 0]}]}
plugins:
  - {type: Laser, name: eye, body: base, range: 5, layers: [solid]}
"""
LAYERS = "properties: {}\nlayers:\n  - {name: solid, map: map.yaml}\n  - name: seen\nmodels:\n"


def many(write: WriteFiles, count: int) -> Path:
    models = "".join(f"  - {{name: robot{i:02}, model: robot.model.yaml}}\n" for i in range(count))
    return write({"world.yaml": LAYERS + models, "robot.model.yaml": ROBOT})


def test_it_tells_what_is_there_and_who_meets_whom(
    write: WriteFiles, devices: Mapping[str, PluginReader]
) -> None:
    text = world_report(load_world(many(write, 2), plugin_readers=devices))
    words = " ".join(text.split())
    for fact in (
        "4.00 m x 3.00 m",
        "2 of 16",
        "2 wall segments",
        "2 bodies, 1 joint",
        "Laser",
        "robot00/base, robot01/base collides with one another, walls of solid",
        "robot00/eye, robot01/eye",
        "mast",
    ):
        assert fact in words, f"{fact} in\n{text}"


def test_fifty_models_are_as_readable_as_two(write: WriteFiles, devices: Mapping[str, PluginReader]) -> None:
    few = world_report(load_world(many(write, 3), plugin_readers=devices))
    world = load_world(many(write, 50), plugin_readers=devices)
    start = time.process_time()
    text = world_report(world)
    assert time.process_time() - start < 1.0
    assert len(text.splitlines()) <= len(few.splitlines()) + 5
    assert "robot49" not in text
    assert "47 more" in text


def test_no_line_is_wider_than_a_terminal(write: WriteFiles, devices: Mapping[str, PluginReader]) -> None:
    world = many(write, 50)
    world.write_text(world.read_text().replace("robot", "r" * 60).replace("r" * 60 + ".model", "robot.model"))
    lines = world_report(load_world(world, plugin_readers=devices)).splitlines()
    assert all(len(line) <= WIDTH or str(world) in line for line in lines)


def test_details_are_data(write: WriteFiles, devices: Mapping[str, PluginReader]) -> None:
    data = json.loads(json.dumps(world_report_data(load_world(many(write, 2), plugin_readers=devices))))
    assert data["size"] == [4, 3]
    assert [layer["segments"] for layer in data["layers"]] == [2, None]
    assert [model["name"] for model in data["models"]] == ["robot00", "robot01"]
    assert data["models"][0]["plugins"] == [{"name": "eye", "type": "Laser"}]
    assert len(data["meetings"]) == 5 * 4 // 2
    touches = {(m["a"], m["b"]): m["touch"] for m in data["meetings"]}
    assert touches["robot00/base", "robot01/base"] == "collides"
    assert touches["robot00/base", "robot01/flag"] == "passes"
    assert {(v["laser"], v["body"]) for v in data["views"] if v["sees"]} == {
        ("robot00/eye", "walls of solid"),
        ("robot00/eye", "robot01/base"),
        ("robot01/eye", "walls of solid"),
        ("robot01/eye", "robot00/base"),
    }


def test_an_empty_world_has_little_to_say(write: WriteFiles) -> None:
    world = load_world(write({"world.yaml": "properties: {}\nlayers: []\n"}))
    assert "no walls" in world_report(world)
    assert world_report_data(world)["size"] is None


words = st.text("abc de", max_size=60)


@given(
    st.integers(1, 4).flatmap(lambda columns: st.lists(st.lists(words, min_size=columns, max_size=columns)))
)
def test_tables_keep_every_word_and_their_width(rows: list[list[str]]) -> None:
    lines = table(rows, 60)
    assert all(len(line) <= 60 for line in lines)
    assert sorted("".join(lines).replace(" ", "")) == sorted(
        "".join("".join(row) for row in rows).replace(" ", "")
    )


@given(st.lists(st.tuples(words, words, words)))
def test_blocks_keep_their_width(rows: list[tuple[str, str, str]]) -> None:
    assert all(len(line) <= 60 for line in grouped_table(rows, 60))


def test_columns_are_aligned() -> None:
    assert table([("a", "b"), ("long", "c")]) == ["a     b", "long  c"]
    assert grouped_table([("who", "a", "b"), ("he", "c", "d"), ("who", "long", "e")]) == [
        "who",
        "  a     b",
        "  long  e",
        "he",
        "  c     d",
    ]


def test_many_names_are_cut() -> None:
    assert join_names(["a", "b"]) == "a, b"
    assert join_names([str(i) for i in range(10)], at_most=3) == "0, 1 and 8 more"
