"""A task of one's own as a level: found by file and name, driven as any level, without medals; refused with the reasons."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.controllers import find_controller
from kit.learning.environment.episode_start import first_start
from kit.learning.tasks.catalogue import find_task, task_names
from kit.mapmaking.map_drawing import read_drawing
from kit.mapmaking.new_map import write_map
from kit.run.recording import load_recording
from kit.school.game.daily import find_playable_level
from kit.school.game.drive_records import record_drive
from kit.school.game.ghosts import load_ghosts
from kit.school.game.levels import UnknownLevel, find_level
from kit.school.game.medal import Medal
from kit.school.game.player_progress import DriverFacts
from kit.school.game.race import DriverKind, judge_recording, race_controller
from kit.school.game.task_levels import MAX_ROBOTS, TaskLevel, task_level
from kit.school.progress import ProgressJournal
from kit.sim.plugins.diff_drive import DiffDriveParams
from kit.workspace import open_workspace
from kit.world.problems import WorldError
from tests.driving_program import driving_program
from tests.learning.tasks.test_many_robots import written as task_of_many_robots


@pytest.fixture
def own_task() -> Path:
    """A task on a straight hall in the workspace."""
    folder = open_workspace().worlds / "hall"
    write_map(folder, read_drawing("########\n#S    T#\n########"), title="Hall", source="drawn")
    result = CliRunner().invoke(main, ["task", "new", "dash", "--from", "hall"])
    assert result.exit_code == 0, result.output
    return folder / "dash.yaml"


def test_a_task_is_a_level_by_file_and_by_name(own_task: Path) -> None:
    level = find_playable_level(str(own_task))
    assert isinstance(level, TaskLevel)
    assert find_playable_level("dash") == level
    assert not level.has_medals
    task = find_task(str(own_task))
    assert level.time_limit == pytest.approx(task.max_steps * task.step_time)
    scenario = level.find_scenario()
    _, case = task.map_cases()[0]
    assert scenario.case is not None
    assert (scenario.starts, scenario.case.target) == ((case.start,), case.target)
    assert scenario.case.target_radius == task.target_radius
    with pytest.raises(UnknownLevel, match="first-drive"):
        find_playable_level("first-drve")


def test_the_motors_give_what_the_actions_ask_for(own_task: Path) -> None:
    scenario = task_level(own_task).find_scenario()
    assert scenario.driven is not None
    (drive,) = [each.params for each in scenario.driven.plugins if isinstance(each.params, DiffDriveParams)]
    limits = drive.linear.speed, drive.angular.speed
    assert limits == pytest.approx(find_task(str(own_task)).actions.largest)


@pytest.mark.parametrize("robots", [MAX_ROBOTS, MAX_ROBOTS + 1])
def test_so_many_robots_are_driven_as_one(robots: int, tmp_path: Path) -> None:
    file = task_of_many_robots(tmp_path, robots)
    if robots <= MAX_ROBOTS:
        assert len(task_level(file).find_scenario().partners) == robots
        return
    with pytest.raises(WorldError, match=f"{robots} robots, only {MAX_ROBOTS}"):
        task_level(file)


@pytest.mark.sampled(5)
@pytest.mark.parametrize("name", task_names())
def test_the_kit_s_tasks_are_levels(name: str) -> None:
    with pytest.raises(UnknownLevel):  # no name means two things
        find_level(name)
    task = find_task(name)
    card, case = task.map_cases()[0]
    scenario = find_playable_level(name).find_scenario()
    assert set(scenario.partners) == set(task.robots_on(card))
    start = first_start(task)
    assert scenario.starts == start.robots
    assert case.starts[0].is_area or scenario.start == case.start
    again = find_playable_level(name).find_scenario()
    assert (again.starts, again.case) == (scenario.starts, scenario.case), "the same for every driver"


@pytest.mark.long
def test_a_program_races_on_a_task_for_its_own_best_and_no_medal(own_task: Path, tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text(driving_program(0.4))
    level, workspace = task_level(own_task), open_workspace()
    finish, recording = race_controller(level, find_controller(str(file)))
    assert finish.reached
    with ProgressJournal(workspace.folder) as journal:
        first, second = (
            record_drive(journal, workspace, level, DriverKind.PROGRAM, [(finish, recording)], DriverFacts())
            for _ in range(2)
        )
    assert (first.medal, first.rules, first.is_best) == (Medal.NONE, (), True)
    assert (second.is_best, second.previous_best) == (False, pytest.approx(finish.seconds, abs=0.001))
    assert [each.name for each in load_ghosts(workspace, level)] == ["program"]
    assert first.recording is not None
    saved = load_recording(first.recording)
    assert judge_recording(level, saved) == judge_recording(level, recording)
    assert saved.level is not None
    assert find_playable_level(saved.level) == level
    own_task.write_text(own_task.read_text() + "# another version\n")
    assert load_ghosts(workspace, task_level(own_task)) == ()


@pytest.mark.long
def test_the_verb_races_a_task_and_speaks_of_no_medal(own_task: Path, tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text(driving_program(0.4))
    result = CliRunner().invoke(main, ["game", "race", "dash", "--controller", str(file)])
    assert result.exit_code == 0, result.output
    assert "Finished after" in result.output
    assert "medal" not in result.output
    result = CliRunner().invoke(main, ["game", "race", "dash", "--agent", "nobody"])
    assert result.exit_code == 2
    assert "nobody" in result.output
