"""YAML files become trees with places, within limits, with other files and variables put in."""

from __future__ import annotations

import json
import os
import socket
import time
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
import yaml
from hypothesis import example, given, settings
from hypothesis import strategies as st

from kit.world.documents import MAX_INCLUDES, MAX_YAML_BYTES, open_document
from kit.world.loading import load_world
from kit.world.problems import WorldError

WriteFiles = Callable[[Mapping[str, str | bytes]], Path]

EMPTY = "properties: {}\nlayers: []\n"
SECONDS = 10.0
"""Far more than any of these needs, far less than reading without a limit would take."""


def refusal(world: Path, **options: object) -> str:
    """What is said against the world, which must be said soon."""
    start = time.process_time()
    with pytest.raises(WorldError) as caught:
        load_world(world, **options)  # type: ignore[arg-type]  # a test may pass any of the options
    assert time.process_time() - start < SECONDS
    return str(caught.value)


def test_a_problem_is_named_by_file_line_and_column(write: WriteFiles) -> None:
    world = write({"world.yaml": "properties: {}\nlayers:\n  - name: walls\n    colour: 1\n"})
    assert refusal(world).startswith(f"{world}:4:5: ")


def test_columns_count_characters(write: WriteFiles) -> None:
    world = write({"world.yaml": "properties: {}\nlayers: [{name: Wände und Türme, colour: 1}]\n"})
    assert ":2:34: " in refusal(world)


def test_a_byte_order_mark_is_no_part_of_the_text(write: WriteFiles) -> None:
    assert load_world(write({"world.yaml": "\ufeff" + EMPTY})).layers == ()


def test_the_merge_key_is_an_ordinary_key(write: WriteFiles) -> None:
    assert "<<" in refusal(write({"world.yaml": EMPTY + "<<: {models: []}\n"}))


def test_an_alias_repeats_what_it_names(write: WriteFiles) -> None:
    world = write(
        {
            "world.yaml": "properties: {}\nlayers:\n  - {name: a, color: &c [0, 0, 1, 1]}\n  - {name: b, color: *c}\n"
        }
    )
    assert load_world(world).layers[1].color == (0, 0, 1, 1)


def test_an_include_is_put_in_relative_to_the_file_that_names_it(write: WriteFiles) -> None:
    world = write(
        {
            "world.yaml": "properties: $include parts/solver.yaml\nlayers: $include parts/layers.yaml\n",
            "parts/solver.yaml": "velocity_iterations: 3\n",
            "parts/layers.yaml": "- name: $include name.yaml\n  map: map.yaml\n",
            "parts/name.yaml": "walls\n",
            "parts/map.yaml": "type: line_segments\ndata: ../lines.dat\nscale: 2\norigin: [0, 0, 0]\n",
        }
    )
    loaded = load_world(world)
    assert loaded.velocity_iterations == 3
    assert loaded.layers[0].names == ("walls",)
    walls = loaded.layers[0].walls
    assert walls is not None
    assert walls.file == world.parent / "parts" / "map.yaml"
    assert walls.drawing_file == world.parent / "lines.dat"
    assert walls.local_segments.max() == 8


def test_a_list_takes_every_document_of_an_include(write: WriteFiles) -> None:
    world = write(
        {
            "world.yaml": "properties: {}\nlayers:\n  - name: first\n  - $[include] more.yaml\n  - name: last\n",
            "more.yaml": "name: second\n---\nname: third\n",
        }
    )
    assert [layer.name for layer in load_world(world).layers] == ["first", "second", "third", "last"]


def test_a_mistake_in_an_included_file_is_named_there(write: WriteFiles) -> None:
    world = write(
        {"world.yaml": "properties: {}\nlayers: $include layers.yaml\n", "layers.yaml": "\n- nam: walls\n"}
    )
    said = refusal(world)
    assert all(line.startswith(f"{world.parent / 'layers.yaml'}:2:3: ") for line in said.splitlines())


def test_includes_have_a_depth(write: WriteFiles) -> None:
    chain = {f"{i}.yaml": f"$include {i + 1}.yaml\n" for i in range(MAX_INCLUDES + 5)}
    world = write({"world.yaml": "properties: $include 0.yaml\nlayers: []\n", **chain})
    assert f"{MAX_INCLUDES} levels deep" in refusal(world)


def test_includes_do_not_multiply_without_end(write: WriteFiles) -> None:
    files = {f"{i}.yaml": "[" + ", ".join([f"$include {i + 1}.yaml"] * 12) + "]" for i in range(8)}
    world = write({"world.yaml": EMPTY + "models: $include 0.yaml\n", **files, "8.yaml": "[]"})
    assert "too much to read" in refusal(world)


@pytest.mark.long
def test_one_model_file_used_very_often_has_an_end(write: WriteFiles) -> None:
    bodies = "bodies:\n" + "".join(f"  - {{name: b{i}, footprints: []}}\n" for i in range(3000))
    models = "".join(f"  - {{name: m{i}, model: robot.model.yaml}}\n" for i in range(1000))
    said = refusal(write({"world.yaml": f"{EMPTY}models:\n{models}", "robot.model.yaml": bodies}))
    assert "too much to read" in said


def test_of_too_many_maps_not_all_are_opened(write: WriteFiles) -> None:
    layers = "".join(f"  - {{name: layer{i}, map: map{i}.yaml}}\n" for i in range(60))
    maps = {
        f"map{i}.yaml": f"image: {i}.png\nresolution: 1\norigin: [0, 0, 0]\noccupied_thresh: 1\n"
        for i in range(60)
    }
    said = refusal(write({"world.yaml": f"properties: {{}}\nlayers:\n{layers}", **maps}))
    assert said.count(".png") == 16
    assert said.count("at most 16 layer names") == 44


@pytest.mark.parametrize(
    ("value", "iterations"),
    [
        ('env("SPEED")', 30),
        ("env(SPEED)", 30),
        ("env('SPEED', 5)", 30),
        ('env("NOBODY", 5)', 5),
        ('$eval env("NOBODY", "7")', 7),
        ("$eval return env(NOBODY, 7)", 7),
    ],
)
def test_a_variable_takes_its_place_or_its_default_does(
    write: WriteFiles, value: str, iterations: int
) -> None:
    world = write({"world.yaml": f"properties: {{velocity_iterations: {json.dumps(value)}}}\nlayers: []\n"})
    assert load_world(world, environment={"SPEED": "30"}).velocity_iterations == iterations


def test_a_world_reads_no_variable_unless_allowed_to(
    write: WriteFiles, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TOKEN", "hunter2")
    world = write({"world.yaml": "properties: {}\nlayers:\n  - {name: 'env(TOKEN, none)'}\n"})
    assert load_world(world).layers[0].name == "none"


@pytest.mark.parametrize(
    "text", ["$eval 1 + 1", "$eval", '$eval env("A")..env("B")', "env(A, B, C)", "param(x)"]
)
def test_code_is_refused(write: WriteFiles, text: str) -> None:
    world = write({"world.yaml": f"properties: {{}}\nlayers:\n  - {{name: {json.dumps(text)}}}\n"})
    assert f"{world}:3:" in refusal(world)


@pytest.mark.parametrize(
    "text", ["environment", "env", "my env(A)", "$evaluate", "include x.yaml", "params(x)"]
)
def test_what_only_looks_like_a_directive_is_text(write: WriteFiles, text: str) -> None:
    world = write({"world.yaml": f"properties: {{}}\nlayers:\n  - {{name: {json.dumps(text)}}}\n"})
    assert load_world(world).layers[0].name == text


@pytest.mark.parametrize(
    "text",
    [
        "env(" + " " * 300_000 + "x",
        "env(" + "'" * 300_000,
        "$eval" + " " * 300_000 + "1",
        "$include" + " " * 300_000,
        '"' + "a" * 300_000,
    ],
)
def test_no_directive_takes_long_to_see_through(write: WriteFiles, text: str) -> None:
    quoted = "'" + text.replace("'", "''") + "'"
    refusal(write({"world.yaml": f"properties: {quoted}\nlayers: []\n"}))


HOSTILE_TEXTS = {
    "deep flow lists": "[" * 300_000,
    "deep flow maps": "{a: " * 200_000,
    "deep block lists": "- " * 300_000,
    "deep keys": "? " * 300_000,
    "many anchors": "".join(f"- &a{i} x\n" for i in range(60_000)),
    "many values": "[" + "0, " * 300_000 + "]",
    "many documents": "--- x\n" * 150_000,
    "many directives": "%YAML 1.1\n" * 10_000,
    "one long key": "a" * 900_000 + ": 1\n",
    "many similar keys": "".join(f"propertie{i}: 1\n" for i in range(20_000)),
    "a very long line of quotes": "'" * 900_000,
    "a very long number": "properties: {velocity_iterations: " + "9" * 900_000 + "}\nlayers: []\n",
    "an escape beyond Unicode": 'properties: "\\UFFFFFFFF"\nlayers: []\n',
    "half a surrogate": 'properties: {}\nlayers: [{name: "\\ud800"}]\n',
    "a zero byte": "properties: {}\0\nlayers: []\n",
    "an alias as a key": "properties: &a {}\n*a : 1\n",
}


@pytest.mark.long_cases("many anchors", "many documents", "many values")
@pytest.mark.parametrize("text", HOSTILE_TEXTS.values(), ids=HOSTILE_TEXTS.keys())
def test_a_hostile_text_is_given_up_soon(write: WriteFiles, text: str) -> None:
    assert "world.yaml:" in refusal(write({"world.yaml": text}))


@pytest.mark.parametrize("text", HOSTILE_TEXTS.values(), ids=HOSTILE_TEXTS.keys())
def test_a_hostile_text_is_given_up_without_libyaml_too(
    write: WriteFiles, text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("kit.world.yaml_reader._LOADER", yaml.SafeLoader)
    refusal(write({"world.yaml": text[:20_000]}))


@pytest.mark.parametrize("name", ["world.yaml", "map.yaml", "lines.dat", "robot.model.yaml"])
@pytest.mark.parametrize("kind", ["pipe", "folder", "device", "socket", "huge", "absent", "unreadable loop"])
def test_what_is_no_file_is_not_waited_for(
    write: WriteFiles, name: str, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = write({})
    file = world.parent / name
    file.unlink()
    match kind:
        case "pipe":
            os.mkfifo(file)
        case "folder":
            file.mkdir()
        case "device":
            file.symlink_to("/dev/zero")
        case "socket":
            monkeypatch.chdir(file.parent)  # a socket's path must be short
            with socket.socket(socket.AF_UNIX) as server:
                server.bind(name)
        case "huge":
            with file.open("wb") as sparse:
                sparse.truncate(1 << 30)
        case "unreadable loop":
            file.symlink_to(name)
    said = refusal(world)
    assert name in said or "/dev/zero" in said


@pytest.mark.parametrize("inside", [True, False])
def test_a_symbolic_link_leads_no_further_than_the_folder(write: WriteFiles, inside: bool) -> None:
    world = write({})
    lines = world.parent / "lines.dat"
    target = world.parent / "real.dat" if inside else world.parent.parent / "outside.dat"
    lines.rename(target)
    lines.symlink_to(target)
    if inside:
        assert load_world(world).layers[0].walls is not None
    else:
        assert "outside" in refusal(world)
        assert load_world(world, root=world.parent.parent).layers[0].walls is not None


def test_a_world_that_is_itself_a_link_is_at_home_where_it_lies(write: WriteFiles, tmp_path: Path) -> None:
    link = tmp_path / "link.yaml"
    link.symlink_to(write({}))
    assert load_world(link).models[0].name == "robot"


def test_an_absolute_path_is_fine_inside_the_root_only(write: WriteFiles, tmp_path: Path) -> None:
    world = write({})
    world.write_text(f"properties: {{}}\nlayers: [{{name: walls, map: {world.parent / 'map.yaml'}}}]\n")
    assert load_world(world).layers[0].walls is not None
    elsewhere = tmp_path / "other" / "world.yaml"
    elsewhere.parent.mkdir()
    elsewhere.write_text(world.read_text())
    assert "outside" in refusal(elsewhere)
    assert load_world(elsewhere, root=tmp_path).layers[0].walls is not None
    assert "outside" in refusal(elsewhere, root=world.parent)


def test_files_are_named_as_the_user_names_the_world(
    write: WriteFiles, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = write({})
    monkeypatch.chdir(world.parent.parent)
    loaded = load_world(Path("world/world.yaml"))
    assert loaded.models[0].file == Path("world/robot.model.yaml")
    assert load_world(Path("world/../world/world.yaml"), root=Path("world")).file == Path("world/world.yaml")


def test_a_large_file_is_not_read(write: WriteFiles) -> None:
    assert "1 MB" in refusal(write({"world.yaml": EMPTY + "# " + "x" * MAX_YAML_BYTES}))


@pytest.mark.long
@settings(max_examples=200, deadline=None)
@given(st.text(max_size=80))
@example("? |")
@example("%TAG ! tag:x,2000:\n---\n!a b")
def test_any_text_is_read_as_pyyaml_reads_it_or_refused(
    tmp_path_factory: pytest.TempPathFactory, text: str
) -> None:
    world = tmp_path_factory.mktemp("any") / "world.yaml"
    world.write_bytes(text.encode("utf-8", "surrogatepass"))
    with pytest.raises(WorldError):
        load_world(world)


def test_an_opened_document_tells_all_its_mistakes_when_its_block_ends(write: WriteFiles) -> None:
    file = write({"world.yaml": "title: 3\nminutes: -1\nminuts: 2\ntitle: 4\n"})
    read = []
    with pytest.raises(WorldError) as caught, open_document(file) as section:
        read += [section.text("title"), section.number("minutes", minimum=0)]
    assert len(read) == 2
    places = [(each.location.line, each.message.split(":")[0]) for each in caught.value.problems]
    assert [line for line, _ in places] == [2, 3, 4]
    assert places[1] == (3, 'unknown key "minuts"')


def test_a_document_without_mistakes_is_read(write: WriteFiles) -> None:
    with open_document(write({"world.yaml": "title: 3\n"})) as section:
        title = section.text("title")
    assert title == "3"


@pytest.mark.parametrize("text", ["", "- 1\n", "3\n", "a: [\n"])
def test_the_block_is_not_entered_for_a_file_that_holds_no_mapping(write: WriteFiles, text: str) -> None:
    entered = False
    with pytest.raises(WorldError), open_document(write({"world.yaml": text})):
        entered = True
    assert not entered


def test_a_partial_reader_asks_for_some_keys_and_has_its_mistakes_told(write: WriteFiles) -> None:
    with open_document(write({"world.yaml": "a: 1\nb: 2\n"}), is_partial=True) as section:
        assert section.number("a") == 1
    with (
        pytest.raises(WorldError, match="must be a number"),
        open_document(write({"world.yaml": "a: x\nb: 2\n"}), is_partial=True) as section,
    ):
        section.number("a")


def test_an_error_in_the_block_is_not_replaced_by_the_files_mistakes(write: WriteFiles) -> None:
    with pytest.raises(ZeroDivisionError), open_document(write({"world.yaml": "a: 1\n"})):
        _ = 1 / 0


def test_a_document_that_cannot_be_a_file_is_refused_before_the_block(tmp_path: Path) -> None:
    loop = tmp_path / "loop.yaml"
    loop.symlink_to(loop)
    for file in (loop, tmp_path / "missing.yaml"):
        with pytest.raises(WorldError, match=file.name), open_document(file):
            pytest.fail("the block was entered")
