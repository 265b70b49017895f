"""``kit fields`` as a user calls it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from kit.cli import main
from kit.world.catalogue import maps_folder


def kit(*words: str) -> Result:
    return CliRunner().invoke(main, ["fields", *words])


def test_a_field_in_characters_and_in_words() -> None:
    found = kit("show", "pair_turn_180", "--plain")
    assert found.exit_code == 0
    assert {"}", "A", "V", "{", "!"} <= set(found.output)
    assert "trap (!) at (0.94, 0.64): 46% of the floor leads there" in found.output
    assert "do not lead to the target" in found.output
    assert "the planner's ride takes" in found.output


@pytest.mark.long
def test_where_a_drawn_layout_and_the_walls_differ_is_said() -> None:
    drawn = kit("show", "pair_turn", "--plain").output
    assert "unlike the walls: the line (1.82, 2.01)-(-0.42, 2.01) is 0.010 m off" in drawn
    derived = kit("show", "pair_turn", "--plain", "--derived").output
    assert "unlike" not in derived
    assert "derived from the walls" in derived


@pytest.mark.long
def test_runs_are_counted_and_failures_explained() -> None:
    found = kit("test", "pair_turn_180", "--case", "pair_turn_left_180", "--runs", "1", "--seed", "3")
    assert found.exit_code == 1  # not all reached the target
    header, fields, reason, abreast = found.output.splitlines()
    assert header.split() == [
        "case",
        "controller",
        "runs",
        "acc",
        "adj",
        "rays",
        "graded",
        "path",
        "m",
        "time",
        "s",
        "wall",
        "m",
        "jerk",
    ]
    assert fields.split()[:4] == ["pair_turn_left_180", "fields", "1", "0.00"]
    assert "1 of 1 stuck: no progress" in reason
    assert abreast.split()[:4] == ["pair_turn_left_180", "abreast", "1", "1.00"]


@pytest.mark.long
def test_for_machines() -> None:
    found = kit("test", "pair_straight", "--runs", "1", "--controller", "abreast", "--json")
    assert found.exit_code == 0
    (summary,) = json.loads(found.output)
    assert summary["accuracy"] == 1.0
    assert summary["controller"] == "abreast"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("show", "pair_tern", "--plain"), 'did you mean "pair_turn'),
        (("show", "pair_turn", "--case", "up", "--plain"), "has no case up"),
        (("show", "depot", "--plain"), "no DiffDrive"),
        (("test", "pair_turn", "--controller", "abreats"), 'did you mean "abreast'),
    ],
)
def test_mistakes_end_with_one_message(words: tuple[str, ...], message: str) -> None:
    found = kit(*words)
    assert found.exit_code == 2
    assert message in found.output
    assert "Traceback" not in found.output


def test_a_world_of_ones_own_has_no_target(tmp_path: Path) -> None:
    (tmp_path / "world.yaml").write_text("properties: {}\nlayers: []\n")
    found = kit("show", str(tmp_path / "world.yaml"), "--plain")
    assert found.exit_code == 2
    assert "has no target" in found.output


def test_drive_is_play() -> None:
    found = CliRunner().invoke(main, ["drive", "--help"])
    assert "--controller" in found.output


BARE = """\
properties: {}
layers: [{name: [seen, felt], map: map.yaml}, {name: tracked}]
models:
  - {name: left, model: left.model.yaml, pose: [0, 0, 1.5708]}
  - {name: beacon, model: beacon.model.yaml, pose: [1.6, 1.6, 0]}
"""


def test_a_bare_world_with_robot_and_beacon_has_a_field(tmp_path: Path) -> None:
    maps = maps_folder()
    for name in ("left.model.yaml", "beacon.model.yaml"):
        (tmp_path / name).write_text((maps / "robots" / name).read_text())
    for file in (maps / "turn").iterdir():
        if file.name not in ("world.yaml", "about.yaml"):
            (tmp_path / file.name).write_bytes(file.read_bytes())
    (tmp_path / "world.yaml").write_text(BARE)
    found = CliRunner().invoke(main, ["fields", "show", str(tmp_path / "world.yaml"), "--plain"])
    assert found.exit_code == 0, found.output
    assert "derived from the walls" in found.output
    (tmp_path / "world.yaml").write_text("\n".join(BARE.splitlines()[:-1]) + "\n")
    found = CliRunner().invoke(main, ["fields", "show", str(tmp_path / "world.yaml"), "--plain"])
    assert "a model named beacon" in " ".join(found.output.split())
    card = found.output[found.output.index("    robot:") : found.output.index("Or choose")]
    card = card.replace("[1, 1, 0]", "[0, 0, 1.57]").replace("[3, 2]", "[1.6, 1.6]").replace("serp", "left")
    (tmp_path / "about.yaml").write_text(card)  # as it is told, with places of this world
    found = CliRunner().invoke(main, ["fields", "show", str(tmp_path / "world.yaml"), "--plain"])
    assert found.exit_code == 0, found.output
