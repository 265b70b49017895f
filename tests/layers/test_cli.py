"""``kit layers``: what it prints, what it exits with, and what it leaves alone."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from kit.cli import main
from kit.layers.examples import EXAMPLES
from kit.layers.flatland.layer_lists import read_world_layers
from tests.cases import every_case
from tests.layers.conftest import YARD, WriteFiles


def kit(*arguments: object) -> Result:
    result = CliRunner().invoke(main, ["layers", *map(str, arguments)])
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    return result


@pytest.mark.parametrize(
    ("target", "code", "words"),
    [
        ("slides", 0, "6 layers, and no plan has fewer"),
        ("slides-lasers", 0, "No two of these 10 fit one layer"),
        ("greedy-trap", 0, "4 layers; 1 more than needed"),
        ("unseen", 0, "leaves 1 thing unseen"),
        ("too-many", 1, "Flatland has 16 layers and this plan needs 20"),
        ("maze", 0, "as few as can be"),
    ],
)
def test_plan(target: str, code: int, words: str) -> None:
    result = kit("plan", target)
    assert result.exit_code == code
    assert words in " ".join(result.stdout.split())
    assert result.stderr == ""


def test_plan_as_data() -> None:
    facts = json.loads(kit("plan", "slides-lasers", "--json").stdout)
    assert (facts["size"], facts["bound"], facts["optimal"], facts["fits_flatland"]) == (10, 10, True, True)
    assert len(facts["layers"]) == len(facts["certificate"]["apart"]) == 10
    assert facts["certificate"]["bound"] == 10
    assert facts["slides_method"] == {"size": 10, "unseen": []}
    assert {laser["name"]: len(laser["watches"]) for laser in facts["lasers"]} == {
        "Ls1": 2,
        "Ls2": 2,
        "Ls3": 2,
    }


def test_too_many_layers_as_data_name_both_ways_out() -> None:
    result = kit("plan", "too-many", "--json")
    facts = json.loads(result.stdout)
    assert (result.exit_code, facts["size"], facts["fits_flatland"]) == (1, 20, False)
    assert (len(facts["give_up"]["what"]), facts["give_up"]["at_least"], facts["give_up"]["size"]) == (
        4,
        4,
        16,
    )
    assert (len(facts["tolerate"]["what"]), facts["tolerate"]["at_least"]) == (1, 0)


def test_the_slides_switch() -> None:
    facts = json.loads(kit("plan", "slides-lasers", "--json", "--one-model-never-collides").stdout)
    assert facts["size"] == 9


@pytest.mark.parametrize("option", ["--dot", "--mermaid"])
@pytest.mark.parametrize("method", ["exact", "greedy"])
def test_graphs_are_printed_alone(option: str, method: str) -> None:
    result = kit("plan", "slides", option, "--method", method)
    assert result.exit_code == 0
    assert result.stdout.startswith("graph")


def test_the_slides_method_alone() -> None:
    assert "ends with 4 layers" in kit("plan", "greedy-trap", "--method", "greedy").stdout
    facts = json.loads(kit("plan", "unseen", "--method", "greedy", "--json").stdout)
    assert (facts["size"], facts["unseen"]) == (2, [{"laser": "eye", "sees": "lamp"}])


@pytest.mark.parametrize("name", EXAMPLES)
def test_explain_goes_through_every_example(name: str) -> None:
    result = kit("explain", name, "--pictures", "--glyphs", "ascii")
    assert result.exit_code == 0
    assert result.stdout.isascii()
    assert max(map(len, result.stdout.splitlines())) <= 80
    assert "THE SLIDES' METHOD" in result.stdout
    assert "THE FEWEST LAYERS" in result.stdout


def test_examples_are_listed_and_printed_as_files_that_plan_takes(tmp_path: Path) -> None:
    listed = kit("example").stdout
    assert all(f"\n{name} " in f"\n{listed}" for name in EXAMPLES)
    file = tmp_path / "s.yaml"
    file.write_text(kit("example", "slides").stdout)
    assert "6 layers" in kit("plan", file).stdout
    wrong = kit("example", "slide")
    assert (wrong.exit_code, 'did you mean "slides"' in wrong.stderr) == (2, True)


def test_a_patch_is_shown_and_nothing_is_written(yard: Path) -> None:
    before = {file: file.read_bytes() for file in yard.parent.iterdir()}
    result = kit("plan", yard, "--patch")
    assert result.exit_code == 0
    assert "-  - name: spare\n" in result.stdout
    assert {file: file.read_bytes() for file in yard.parent.iterdir()} == before
    facts = json.loads(kit("plan", yard, "--patch", "--json").stdout)
    assert facts["patch"]["diff"] in result.stdout
    assert facts["patch"]["left_alone"] == []


def test_apply_writes_checks_and_then_there_is_nothing_to_do(yard: Path) -> None:
    result = kit("plan", yard, "--apply")
    assert result.exit_code == 0
    assert "Written: 3 files" in result.stdout
    assert len(read_world_layers(yard).layer_bits) == 4
    assert "nothing to change" in kit("plan", yard, "--patch").stdout.lower()
    assert kit("check", yard).exit_code == 0


def test_apply_refuses_what_it_would_have_to_guess(write: WriteFiles) -> None:
    world = write({"chair.model.yaml": YARD["chair.model.yaml"].replace("layers: [", "layers: &l [")})
    before = {file: file.read_bytes() for file in world.parent.iterdir()}
    result = kit("plan", world, "--apply")
    assert result.exit_code == 2
    assert "Nothing was written" in result.stderr
    assert "By hand" in result.stdout
    assert {file: file.read_bytes() for file in world.parent.iterdir()} == before


def test_check_exits_with_what_ci_needs(yard: Path, tmp_path: Path) -> None:
    asked = tmp_path / "asked.yaml"
    asked.write_text(kit("plan", yard, "--requirements").stdout)
    assert kit("check", yard).exit_code == 3
    assert kit("check", yard, "--lenient").exit_code == 0
    assert kit("check", yard, asked).exit_code == 3
    assert kit("plan", yard, "--apply").exit_code == 0
    assert kit("check", yard, asked).exit_code == 0
    asked.write_text(asked.read_text().replace("solid: [robot, chair]", "solid: [chair]"))
    broken = kit("check", yard, asked, "--lenient")
    assert broken.exit_code == 1
    assert "solid and robot must not collide" in broken.stdout
    facts = json.loads(kit("check", yard, asked, "--json").stdout)
    assert facts["exit"] == 1
    assert facts["breaches"][0]["collide"] == ["solid", "robot"]


@every_case(
    ("arguments", "words"),
    [
        (("plan",), "Missing argument"),
        (("plan", "slidse"), 'did you mean "slides"'),
        (("plan", "slides", "--patch"), "no files to patch"),
        (("plan", "maze", "--patch", "--method", "greedy"), "exact plan"),
        (("plan", "slides", "--time-limit", "0"), "time-limit"),
        (("plan", "slides", "--env", "SURELY_NOT_SET"), "SURELY_NOT_SET"),
        (("check", "slides"), "not a Flatland world"),
        (("explain", "no/such/file.yaml"), "no file"),
        (("check", "maze", "no/such/file.yaml"), "no such file"),
    ],
)
def test_a_mistake_ends_in_words_and_exit_code_two(arguments: tuple[str, ...], words: str) -> None:
    result = kit(*arguments)
    assert result.exit_code == 2
    assert words in result.stderr
    assert "Traceback" not in result.output


def test_mistakes_in_files_are_all_listed_with_their_places(tmp_path: Path) -> None:
    file = tmp_path / "a.yaml"
    file.write_text("models: [a, b]\ncollide: {a: [b, c]}\napart: {b: [a]}\n")
    result = kit("plan", file)
    assert result.exit_code == 2
    assert f"{file}:2:" in result.stderr
    assert f"{file}:3:" in result.stderr


def test_more_than_sixteen_layers_cannot_be_patched(tmp_path: Path, write: WriteFiles) -> None:
    """Seventeen robots that all meet the walls and nobody else."""
    count = 17
    body = "bodies:\n  - name: x\n    footprints: [{type: circle, radius: 1, density: 1, layers: [a]}]\n"
    files = {f"m{i}.yaml": body for i in range(count)}
    models = "".join(f"  - {{name: r{i}, model: m{i}.yaml}}\n" for i in range(count))
    world = write(
        {
            **files,
            "world.yaml": f"properties: {{}}\nlayers:\n  - {{name: a, map: map.yaml}}\nmodels:\n{models}",
        }
    )
    asked = world.with_name("asked.yaml")
    names = ", ".join(f"r{i}" for i in range(count))
    asked.write_text(f"world: world.yaml\nmaps: [a]\nmodels: [{names}]\ncollide: {{a: [{names}]}}\n")
    assert kit("plan", asked).exit_code == 1
    refused = kit("plan", asked, "--apply")
    assert (refused.exit_code, "do not fit" in refused.stderr) == (2, True)
    assert kit("check", world, asked).exit_code == 1


@pytest.mark.long
def test_the_planner_stands_alone() -> None:
    """Neither the simulator, nor a learner, nor an interface; help needs not even the solver."""
    code = (
        "import sys\nfrom kit.cli import main\n"
        "try:\n    main(['layers', *sys.argv[1:]])\nexcept SystemExit:\n    pass\n"
        "heavy = ('numba', 'pymunk', 'torch', 'stable_baselines3', 'gymnasium', 'textual', 'kit.sim', 'kit.ros')\n"
        "lazy = ('networkx', 'highspy')\n"
        "print('LOADED', *[name for name in (*heavy, *lazy) if name in sys.modules])\n"
    )

    def loaded(*arguments: str) -> list[str]:
        run = subprocess.run(
            [sys.executable, "-c", code, *arguments], capture_output=True, text=True, check=True
        )
        return run.stdout.rsplit("LOADED", 1)[1].split()

    assert loaded("--help") == []
    assert loaded("example", "slides") == []
    assert loaded("plan", "maze") == ["networkx"]
