"""Parts of other packages: one of each is found and used, and what is wrong with one is said and harms nothing else."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

from kit import extensions as extensions_module
from kit.extensions import (
    GROUPS,
    PACKAGES_VARIABLE,
    ExtensionError,
    admitting,
    checked,
    extensions,
    installed_extensions,
    load,
    name_conflicts,
)
from tests.extensions.installed_package import EXAMPLE, environment, install_example, write_distribution
from tests.grader.conftest import QUICK

PACKAGE = "example-parts"


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder of packages that this process sees too."""
    folder = tmp_path / "site"
    folder.mkdir()
    monkeypatch.syspath_prepend(str(folder))
    monkeypatch.delenv(PACKAGES_VARIABLE, raising=False)
    installed_extensions.cache_clear()
    yield folder
    installed_extensions.cache_clear()
    for name in [each for each in sys.modules if each.split(".")[0] in ("example_parts", "broken", "hangs")]:
        del sys.modules[name]


@pytest.fixture
def example(site: Path) -> Path:
    install_example(site)
    return site


def run(site: Path, program: str, *arguments: str, code: int = 0, text: str = "") -> str:
    ended = subprocess.run(
        [sys.executable, "-m", program, *arguments],
        cwd=site.parent,
        env=environment(site, site.parent / "workspace"),
        input=text,
        capture_output=True,
        text=True,
        check=False,
        timeout=240,
    )
    assert ended.returncode == code, ended.stdout + ended.stderr
    assert "Traceback" not in ended.stderr
    return ended.stdout + ended.stderr


def test_the_example_brings_one_of_each() -> None:
    project = tomllib.loads((EXAMPLE / "pyproject.toml").read_text())["project"]
    groups = [name.rpartition(".")[2] for name in project["entry-points"]]
    assert sorted(groups) == sorted(GROUPS)


@pytest.mark.long
def test_pip_installs_and_removes_it_without_a_trace(tmp_path: Path) -> None:
    place = tmp_path / "venv"
    subprocess.run([sys.executable, "-m", "venv", str(place)], check=True, capture_output=True)
    pip = [place / "bin" / "python", "-m", "pip", "--quiet"]
    before = sorted(place.rglob("*"))
    subprocess.run([*pip, "install", "--no-deps", EXAMPLE], check=True, capture_output=True)
    assert any(each.name == "example_parts" for each in place.rglob("*"))
    subprocess.run([*pip, "uninstall", "-y", PACKAGE], check=True, capture_output=True)
    assert [each for each in sorted(place.rglob("*")) if "__pycache__" not in each.parts] == [
        each for each in before if "__pycache__" not in each.parts
    ]


def test_looking_imports_nothing(example: Path) -> None:
    found = {each.group for each in installed_extensions() if each.package == PACKAGE}
    assert found == set(GROUPS)
    assert not [name for name in sys.modules if name.startswith("example_parts")]


def test_doctor_lists_every_part_and_where_it_is_from(example: Path) -> None:
    listed = json.loads(run(example, "kit", "doctor", "--json"))["Parts of other packages"]
    assert len(listed) == len(GROUPS)
    assert {entry["value"] for entry in listed.values()} == {"example-parts 1.0"}
    assert {entry["meaning"] for entry in listed.values()} == {"Works."}


def test_without_packages_nothing_is_listed(site: Path) -> None:
    assert "Parts of other packages" not in run(site, "kit", "doctor")


def test_a_verb_and_a_dialogue_are_commands(example: Path) -> None:
    assert run(example, "kit", "bearing", "1", "1").strip() == "0.785"
    assert "green it is." in run(example, "kit", "ask-me", "--plain", text="red\ngreen\n")
    listed = run(example, "kit", "--help")
    assert "Commands of other packages" in listed
    assert "From example-parts 1.0." in listed


@pytest.mark.long
def test_a_map_with_a_device_and_a_controller_run(example: Path) -> None:
    assert "shed" in run(example, "kit", "maps")
    said = run(example, "kit", "run", "shed", "--controller", "spinner", "--steps", "100")
    assert "100 steps" in said


@pytest.mark.long
def test_a_task_and_a_lesson_open(example: Path) -> None:
    assert "Drive through the shed" in run(example, "kit", "task", "show", "shed-run")
    assert "50-green" in run(example, "kit", "lesson", "--plain")
    assert "Green" in run(example, "kit", "lesson", "50-green", "--plain", text="q\n")


SHEET = QUICK.replace("level: 0", "level: 1").replace("checks:", "checks:\n  - {check: turns, points: 2}")


def assignment(folder: Path, text: str) -> Path:
    folder.mkdir()
    (folder / "assignment.yaml").write_text(text)
    return folder


@pytest.mark.long
def test_a_grader_loads_what_the_sheet_names(example: Path) -> None:
    work = example / "example_parts" / "controllers" / "spinner.py"
    named = assignment(example.parent / "named", f"packages: [{PACKAGE}]\n{SHEET}")
    result = json.loads(
        run(example, "grader", "check", str(work), "--assignment", str(named), "--json", code=1)
    )
    points = {each["id"]: each["points"] for each in result["tests"]}
    assert points["turns"] == 2
    unnamed = assignment(example.parent / "unnamed", SHEET)
    said = run(example, "grader", "check", str(work), "--assignment", str(unnamed), code=2)
    assert '"turns"' in said


@pytest.mark.long
def test_a_kind_of_a_package_is_graded(example: Path) -> None:
    sheet = "title: Note\nkind: note\nsubmit: note.txt\nchecks:\n  - {check: words, points: 4}\n"
    folder = assignment(example.parent / "note", f"packages: [{PACKAGE}]\n{sheet}")
    (example.parent / "note.txt").write_text("one two three four five")
    said = run(
        example, "grader", "check", "note.txt", "--assignment", str(folder), "--json", "--level", "0", code=1
    )
    assert json.loads(said)["tests"][0]["points"] == 1


WORLD_SHEET = """\
title: A compass
kind: world
submit: world.yaml
level: 1
checks:
  - {check: loads, points: 1}
  - {check: publishes, points: 1, with: {topics: [/compass]}}
"""


@pytest.mark.long
def test_a_confined_reader_and_a_worker_know_the_device(example: Path) -> None:
    """A world with the device is read in a confined process, from a queue that another process works on."""
    folder = assignment(example.parent / "compass", f"packages: [{PACKAGE}]\n{WORLD_SHEET}")
    handed_in = example.parent / "handed_in"
    handed_in.mkdir()
    (example / "example_parts" / "maps" / "shed").rename(handed_in / "ada")
    (handed_in / "ada" / "about.yaml").unlink()
    run(example, "grader", "cohort", "handed_in", "--assignment", str(folder), "--queue", "queue")
    (row,) = [line for line in run(example, "grader", "gradebook", "queue").splitlines() if "ada" in line]
    assert row.startswith('"ada","pass","2","2"')


def test_a_package_that_is_not_installed_is_named(site: Path) -> None:
    folder = assignment(site.parent / "missing", f"packages: [{PACKAGE}]\n{QUICK}")
    (site.parent / "work.py").write_text("")
    said = run(site, "grader", "check", "work.py", "--assignment", str(folder), code=2)
    assert "assignment.yaml:1" in said
    assert PACKAGE in said


def test_admitting_ends_with_its_block(example: Path) -> None:
    with admitting([]):
        assert not extensions("devices")
        with admitting(["Example_Parts"]):
            assert list(extensions("devices")) == ["Compass"]
        assert not extensions("devices")
    assert list(extensions("devices")) == ["Compass"]
    assert PACKAGES_VARIABLE not in os.environ


BROKEN = {
    "raises": "raise RuntimeError('no')",
    "exits": "raise SystemExit(3)",
    "syntax": "def :",
    "absent": "",
}


@pytest.mark.parametrize("case", BROKEN)
def test_a_broken_one_is_named_and_skipped(site: Path, case: str) -> None:
    write_distribution(site, "broken", "1", {"verbs": {"bad": "broken:command"}}, {"broken": BROKEN[case]})
    (part,) = extensions("verbs").values()
    with pytest.raises(ExtensionError, match="verb bad of broken 1 cannot be used"):
        load(part)
    assert checked(part)
    assert "broken 1" in run(site, "kit", "bad", code=2)
    assert "Start" not in run(site, "kit", "maps", "maze")


def test_one_that_hangs_at_import_is_named_and_skipped(site: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(extensions_module, "IMPORT_LIMIT_S", 0.3)
    text = "import threading\nthreading.Event().wait(30)"
    write_distribution(site, "hangs", "1", {"devices": {"Late": "hangs:PLUGIN_TYPE"}}, {"hangs": text})
    (part,) = extensions("devices").values()
    assert "its import takes more than 0.3 s" in checked(part)


def test_two_of_one_name_are_both_left_out(site: Path) -> None:
    for name in ("one", "two"):
        write_distribution(site, name, "1", {"verbs": {"same": "json:dumps"}}, {})
    assert not extensions("verbs")
    assert {each.package: why for each, why in name_conflicts("verbs")} == {
        "one": "two brings one of this name too",
        "two": "one brings one of this name too",
    }
    listed = json.loads(run(site, "kit", "doctor", "--json"))["Parts of other packages"]
    assert listed["verb same"]["meaning"].startswith("Left out: ")


@pytest.mark.long
def test_the_kits_own_names_win(site: Path) -> None:
    parts = {"verbs": {"run": "json:dumps"}, "devices": {"Laser": "json:dumps"}}
    write_distribution(site, "greedy", "1", parts, {})
    listed = json.loads(run(site, "kit", "doctor", "--json"))["Parts of other packages"]
    assert {entry["meaning"] for entry in listed.values()} == {"Left out: the kit has one of this name."}
    assert "100 steps" in run(site, "kit", "run", "maze", "--steps", "100")
