"""``kit world check``: the errors of a world, or what is in it."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from kit.cli.world import command
from kit.world.catalogue import maps_folder

WriteFiles = Callable[[Mapping[str, str | bytes]], Path]


def check(*arguments: str | Path) -> Result:
    result = CliRunner().invoke(command, ["check", *map(str, arguments)])
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result


def test_a_sound_world_is_described(write: WriteFiles) -> None:
    result = check(write({}))
    assert result.exit_code == 0
    assert "2 wall segments" in result.output
    assert "robot/base" in result.output


def test_every_error_is_printed_with_its_place(write: WriteFiles) -> None:
    world = write({"world.yaml": "properties: {}\nlayers:\n  - nmae: walls\nmodles: []\n"})
    result = check(world)
    assert result.exit_code == 1
    lines = result.stdout.splitlines()
    assert [line.split(": ")[0] for line in lines if line] == [f"{world}:3:5", f"{world}:3:5", f"{world}:4:1"]
    assert "3 problems" in result.stderr


def test_a_map_is_found_by_name_by_folder_and_by_file() -> None:
    maze = maps_folder() / "maze"
    outputs = {check(name).output for name in ("maze", maze, maze / "world.yaml")}
    assert len(outputs) == 1
    assert "serp/base_link" in outputs.pop()


@pytest.mark.parametrize("name", ["mzae", "nowhere/world.yaml", "world.yml", "x" * 300, "a/" + "x" * 300])
def test_what_is_not_there_is_a_wrong_use(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    result = check(name)
    assert result.exit_code == 2
    assert "Error" in result.output
    assert ('"maze"' in result.output) == (name == "mzae")


def test_a_folder_without_a_world_is_a_wrong_use(tmp_path: Path) -> None:
    assert check(tmp_path).exit_code == 2


def test_a_wider_root_is_allowed_by_request(write: WriteFiles) -> None:
    world = write({})
    (world.parent / "lines.dat").rename(world.parent.parent / "lines.dat")
    (world.parent / "map.yaml").write_text(
        "type: line_segments\ndata: ../lines.dat\nscale: 1\norigin: [0, 0, 0]\n"
    )
    assert check(world).exit_code == 1
    assert check(world, "--root", world.parent.parent).exit_code == 0
    assert check(world, "--root", world.parent / "nowhere").exit_code == 2


def test_variables_are_passed_on_by_request(write: WriteFiles, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LAYER", "hall")
    world = write({"world.yaml": "properties: {}\nlayers: [{name: 'env(LAYER, none)'}]\n"})
    assert "none" in check(world).output
    assert "hall" in check(world, "--env", "LAYER").output
    assert "room" in check(world, "--env", "LAYER=room").output
    assert check(world, "--env", "NOBODY").exit_code == 2


def test_a_program_gets_data(write: WriteFiles) -> None:
    sound = json.loads(check(write({}), "--json").stdout)
    assert sound["ok"] is True
    assert sound["models"][0]["name"] == "robot"
    world = write({"world.yaml": "properties: {}\nlayers: 1\n"})
    bad = check(world, "--json")
    assert bad.exit_code == 1
    (problem,) = json.loads(bad.stdout)["problems"]
    assert (problem["file"], problem["line"], problem["column"]) == (str(world), 2, 9)


def test_plugins_are_checked(write: WriteFiles) -> None:
    world = write({})
    with (world.parent / "robot.model.yaml").open("a") as file:
        file.write(
            "plugins:\n  - {type: Laser, name: eye, body: bsae, range: 1, angle: {min: 0, max: 1, increment: 1}}\n"
        )
    result = check(world)
    assert result.exit_code == 1
    assert '"base"' in result.output
