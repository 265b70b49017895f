"""What a name on the command line stands for."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit.layers.case_sources import UnknownPlanningTask, open_task, solve_task
from kit.layers.examples import EXAMPLES
from kit.layers.requirements_file import read_requirements, requirements_text
from kit.world.problems import WorldError
from tests.cases import every_case
from tests.layers.conftest import WriteFiles


@pytest.mark.long
def test_an_example_a_map_a_world_its_folder_and_requirements(yard: Path, tmp_path: Path) -> None:
    asked = tmp_path / "slides.yaml"
    asked.write_text(requirements_text(EXAMPLES["slides"]))
    assert open_task("slides").case == EXAMPLES["slides"]
    assert open_task(str(asked)).case == EXAMPLES["slides"]
    assert open_task("maze").world is not None
    assert open_task(str(yard)).case == open_task(str(yard.parent)).case


def test_requirements_that_name_a_world_are_planned_for_it(yard: Path, tmp_path: Path) -> None:
    asked = tmp_path / "asked.yaml"
    asked.write_text(open_task(str(yard)).as_requirements().replace(str(yard), "yard/world.yaml"))
    assert read_requirements(asked).world == yard
    task = open_task(str(asked))
    assert task.world is not None
    plan, world_plan = solve_task(task)
    assert world_plan is not None
    assert (plan.size, world_plan.size) == (4, 4)
    assert task.source is not None
    assert task.source.read().file == yard


def test_the_slides_switch_reaches_everything(yard: Path) -> None:
    assert solve_task(open_task("slides-lasers", one_model_never_collides=True))[0].size == 9
    assert open_task(str(yard), one_model_never_collides=True).world is not None


def test_env_in_a_world_reads_only_what_is_given(write: WriteFiles) -> None:
    files = {"world.yaml": 'properties: {}\nlayers:\n  - {name: \'env("L", "a")\', map: map.yaml}\n'}
    world = write(files)
    assert open_task(str(world)).case.names == ("a",)
    assert open_task(str(world), environment={"L": "b"}).case.names == ("b",)


@every_case(
    ("name", "words"),
    [
        ("slidse", 'did you mean "slides"'),
        ("maez", "maze"),
        ("no/such.yaml", "no file"),
        ("x\0", "opened|no file"),
        ("x" * 5000, "opened|no file"),
    ],
)
def test_a_name_that_means_nothing_offers_the_nearest(name: str, words: str) -> None:
    with pytest.raises(UnknownPlanningTask, match=words):
        open_task(name)


def test_a_file_that_is_neither_says_what_is_wrong(tmp_path: Path) -> None:
    odd = tmp_path / "odd.yaml"
    odd.write_text("shopping: [milk]\n")
    with pytest.raises(WorldError, match="shopping"):
        open_task(str(odd))
