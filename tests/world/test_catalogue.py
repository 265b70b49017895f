"""The catalogue of maps: cards are read, checked, and found by name."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.geometry import Pose
from kit.sim import simulation
from kit.world.catalogue import (
    UnknownMap,
    all_maps,
    allowed_root_of,
    find_map,
    map_names,
    maps_folder,
    own_card,
)
from kit.world.loading import load_world
from kit.world.problems import WorldError
from tests.cases import every_case

CARD = """\
title: A hall
summary: To and fro
source: drawn for a test
cases:
  - {name: there, start: [0, 0, 1.57], target: [1, 2]}
"""


def card(folder: Path, name: str, text: str = CARD) -> None:
    (folder / name).mkdir()
    (folder / name / "about.yaml").write_text(text)


def test_a_card_and_its_defaults(tmp_path: Path) -> None:
    card(tmp_path, "hall")
    (found,) = all_maps(tmp_path)
    assert (found.name, found.title, found.source, found.robot) == (
        "hall",
        "A hall",
        "drawn for a test",
        "serp",
    )
    assert (found.world_file, found.root, found.partner) == (tmp_path / "hall" / "world.yaml", tmp_path, None)
    (case,) = found.cases
    assert (case.name, case.start, case.target, case.target_radius) == (
        "there",
        Pose(0, 0, 1.57),
        (1, 2),
        0.2,
    )
    assert (case.start_shift, case.target_shift, case.is_heading_random) == ((0, 0), (0, 0), False)
    assert (case.group, case.partner_start) == ("", None)


def test_a_card_with_every_key(tmp_path: Path) -> None:
    card(
        tmp_path,
        "hall",
        CARD.replace("cases", "robot: left\npartner: right\ncases")
        + "  - {name: back, start: [1, 2, 0], target: [0, 0], target_radius: 0.3, start_shift: [0.3, 0],\n"
        "     target_shift: [0, 0.3], any_heading: true, group: turns, partner_start: [1, 1, 0]}\n",
    )
    found = find_map("hall", tmp_path)
    assert (found.robot, found.partner) == ("left", "right")
    case = found.cases[1]
    assert (case.target_radius, case.start_shift, case.target_shift) == (0.3, (0.3, 0), (0, 0.3))
    assert (case.is_heading_random, case.group, case.partner_start) == (True, "turns", Pose(1, 1, 0))


def test_a_card_needs_only_its_cases(tmp_path: Path) -> None:
    card(tmp_path, "hall", CARD[CARD.index("cases") :])
    found = find_map("hall", tmp_path)
    assert (found.title, found.summary, found.source, len(found.cases)) == ("hall", "", "", 1)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("title", "titel", ["title", "titel"]),
        ("  - {name", "  - {nmae", ["name"]),
        ("[1, 2]", "[1, 2, 3]", ["target", "2"]),
        ("cases:", "cases: []\nnone:", ["cases", "at least 1"]),
        ("target: [1, 2]}", "target: [1, 2], target_radius: 0}", ["target_radius"]),
        ("[1, 2]}\n", "[1, 2]}\n  - {name: there, start: [0, 0, 0], target: [1, 1]}\n", ["there", "already"]),
    ],
)
def test_a_wrong_card_says_where(tmp_path: Path, old: str, new: str, words: list[str]) -> None:
    card(tmp_path, "hall", CARD.replace(old, new))
    with pytest.raises(WorldError) as caught:
        find_map("hall", tmp_path)
    assert all(word in str(caught.value) for word in words), caught.value
    assert caught.value.problems[0].location.file == tmp_path / "hall" / "about.yaml"


def test_folders_without_a_card_are_no_maps(tmp_path: Path) -> None:
    (tmp_path / "robots").mkdir()
    card(tmp_path, "b")
    card(tmp_path, "a")
    assert map_names(tmp_path) == ("a", "b")


@every_case("name", ["mzae", "robots", "../maps/maze", ".", ""])
def test_an_unknown_name_is_refused(name: str) -> None:
    with pytest.raises(UnknownMap):
        find_map(name)


def test_the_nearest_name_is_offered() -> None:
    with pytest.raises(UnknownMap):
        find_map("x" * 1000)  # longer than a file's name can be
    with pytest.raises(UnknownMap, match='"maze"'):
        find_map("mzae")


def test_the_kits_own_maps_are_found_and_may_share_their_robots() -> None:
    maze = find_map("maze")
    assert maze.root == maps_folder()
    assert allowed_root_of(maze.world_file) == maps_folder()
    assert load_world(maze.world_file, root=maze.root).models[0].name == maze.robot
    assert maze.name in map_names()


def test_other_worlds_keep_to_their_own_folder(tmp_path: Path) -> None:
    assert allowed_root_of(tmp_path / "world.yaml") is None


def package(folder: Path) -> Path:
    """A world whose robot lies in a folder beside its own, as in packages of ROS; its folder."""
    maps = maps_folder()
    worlds, models = folder / "package" / "worlds", folder / "package" / "models"
    shutil.copytree(maps / "simple", worlds)
    shutil.copytree(maps / "robots", models)
    text = (worlds / "world.yaml").read_text()
    (worlds / "world.yaml").write_text(text.replace("../robots/", "../models/"))
    return worlds


def test_a_world_of_a_package_reads_the_packages_models(tmp_path: Path) -> None:
    worlds = package(tmp_path)
    assert allowed_root_of(worlds / "world.yaml") == tmp_path / "package"
    assert [model.name for model in simulation.load_world(worlds / "world.yaml").models] == ["serp"]
    card = own_card(worlds / "world.yaml")
    assert card is not None
    assert card.root == tmp_path / "package"
    nested = tmp_path / "package" / "share" / "arena"
    shutil.move(worlds, nested)
    world = nested / "world.yaml"
    world.write_text(world.read_text().replace("../models/", "../../models/"))
    assert allowed_root_of(world) is None
    with pytest.raises(WorldError, match="--root to allow a wider folder"):
        simulation.load_world(world)
    (tmp_path / "package" / "package.xml").write_text("<package/>")
    assert simulation.load_world(world).models


def test_a_package_is_looked_for_in_five_folders(tmp_path: Path) -> None:
    (tmp_path / "package.xml").write_text("<package/>")
    world = tmp_path / "a" / "b" / "c" / "d" / "world.yaml"
    assert allowed_root_of(world) == tmp_path
    assert allowed_root_of(tmp_path / "a" / "b" / "c" / "d" / "e" / "world.yaml") is None


def test_a_package_is_never_the_home_or_the_whole_disk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = package(tmp_path) / "world.yaml"
    monkeypatch.setenv("HOME", str(tmp_path / "package"))
    (tmp_path / "package" / "package.xml").write_text("<package/>")
    assert allowed_root_of(world) is None
    with pytest.raises(WorldError, match="outside the folder"):
        simulation.load_world(world)


@pytest.mark.long
def test_every_verb_opens_a_world_of_a_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    worlds = package(tmp_path)
    monkeypatch.chdir(tmp_path)
    own = ["--workspace", str(tmp_path / "kit")]
    for words in (
        ["world", "check", str(worlds)],
        ["maps", str(worlds)],
        ["run", str(worlds), "--controller", "forward", "--steps", "20"],
        ["layers", "plan", str(worlds / "world.yaml")],
        ["task", "new", "mine", "--from", str(worlds)],
        ["task", "show", str(worlds / "mine.yaml")],
        ["train", str(worlds / "mine.yaml"), "--algo", "q-learning", "--steps", "2000", "--plain", *own],
    ):
        result = CliRunner().invoke(main, words)
        assert result.exit_code == 0, (words, result.output)
